//! `termtrace check`: what is wrong with a scene file.

use super::{Done, SceneArgs, write_stdout};
use clap::Args;

#[derive(Args)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    scene: SceneArgs,
}

/// Every fault was said by `load`; a scene that loads is fine.
pub(super) fn run(args: &CheckArgs) -> Done {
    let scene = args.scene.load()?;
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let objects = count(scene.objects().len(), "object");
    let lights = count(scene.lights.len(), "light");
    write_stdout(format!("{}: fine ({objects}, {lights})\n", args.scene.path().display()).as_bytes())
}
