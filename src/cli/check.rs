//! `termtrace check`: reports every fault of a scene file.

use super::outcome::{CommandResult, write_stdout};
use super::scene_args::CameraArgs;
use super::scene_source::SceneSource;
use clap::Args;
use std::path::PathBuf;
use termtrace::internals::text::visible;

const EXAMPLES: &str = "\
Examples:
  termtrace check my.ron
  termtrace check my.ron --eye 0,0,0      check the scene with this eye point";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct CheckArgs {
    /// The scene file or mesh; - is standard input
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    #[command(flatten)]
    camera_args: CameraArgs,
}

/// Loads the scene and prints that it has no faults; otherwise the error lists every fault.
pub(super) fn run(args: &CheckArgs) -> CommandResult {
    // `check` fails on a missing texture, of which the other commands only warn.
    let strict = CameraArgs { strict: true, ..args.camera_args.clone() };
    let scene = strict.load_scene(&SceneSource::from_path(&args.scene, strict.mesh_format)?)?;
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let objects = count(scene.objects().len(), "object");
    let lights = count(scene.lights().len(), "light");
    let path = args.scene.display().to_string();
    let faults = scene.darkness_warning().map(str::to_owned).into_iter().chain(scene.invisible_formula_warnings());
    let faults = faults.chain(scene.flat_mesh_warnings());
    let warnings: String = faults.flat_map(|warning| [", but ".to_owned(), warning]).collect();
    write_stdout(format!("{}: OK ({objects}, {lights}){warnings}\n", visible(&path)).as_bytes())
}
