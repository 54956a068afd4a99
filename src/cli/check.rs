//! `termtrace check`: what is wrong with a scene file.

use super::outcome::{CommandResult, write_stdout};
use super::scene_args::SceneArgs;
use clap::Args;
use termtrace::internals::text::visible;

const EXAMPLES: &str = "\
Examples:
  termtrace check my.ron
  termtrace check my.ron --eye 0,0,0      whether the scene can be looked at from there";

#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    scene: SceneArgs,
}

/// Every fault was said by `load`; a scene that loads is fine.
pub(super) fn run(args: &CheckArgs) -> CommandResult {
    let scene = args.scene.load()?;
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let objects = count(scene.objects().len(), "object");
    let lights = count(scene.lights().len(), "light");
    let path = args.scene.path().display().to_string();
    write_stdout(format!("{}: fine ({objects}, {lights})\n", visible(&path)).as_bytes())
}
