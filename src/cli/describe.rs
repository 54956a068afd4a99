//! `termtrace describe`: what a picture shows, as text for those who cannot see it.

use super::outcome::{CommandResult, write_stdout};
use super::picture::{check_pixel_count, parse_size};
use super::scene_args::SceneArgs;
use clap::Args;
use termtrace::internals::text::visible;
use termtrace::{Resolution, describe};

const EXAMPLES: &str = "\
It tells of the objects that are seen, the largest first: kind, colour and size, where in the picture, how much of it, how
far away, and what hides what; of those that are not seen, and why; of the background and the lights. Objects have the
numbers of their places in the scene file.

Examples:
  termtrace describe my.ron
  termtrace describe my.ron --eye 0,5,0.1      what is seen from above";

#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct DescribeArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The size of the screen whose picture is told, in cells
    #[arg(long, value_name = "COLSxROWS", default_value = "80x24", value_parser = parse_size)]
    size: (u32, u32),
}

pub(super) fn run(args: &DescribeArgs) -> CommandResult {
    let (columns, rows) = args.size;
    // Eight points in each cell of the usual shape, two by four: as fine as characters show a picture.
    let [width, height] = [columns.saturating_mul(2), rows.saturating_mul(4)];
    check_pixel_count(width.into(), height.into())?;
    let resolution = Resolution::square(width, height);
    let scene = args.scene.load()?;
    let name = visible(&args.scene.path().display().to_string());
    let text = args.scene.on_threads(|| describe(&name, &scene, scene.camera(), resolution))?;
    write_stdout(text.as_bytes())
}
