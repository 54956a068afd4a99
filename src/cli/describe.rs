//! `termtrace describe`: describes a picture in words, for people who cannot see it.

use super::json;
use super::outcome::{CommandResult, write_stdout};
use super::picture::{check_pixel_count, parse_size};
use super::scene_args::SceneArgs;
use clap::Args;
use serde_json::json;
use termtrace::internals::text::visible;
use termtrace::{Resolution, describe};

const EXAMPLES: &str = "\
The text lists the visible objects, the largest first: kind, colour and size,
position and share of the picture, distance, and what hides what; then the
objects that are not visible, and why; the background and the lights. Objects
are numbered in the order of the scene file.

Examples:
  termtrace describe my.ron
  termtrace describe my.ron --eye 0,5,0.1      the view from above";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct DescribeArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The size of the screen, in cells
    #[arg(long, help_heading = "Picture", value_name = "COLSxROWS", default_value = "80x24", value_parser = parse_size)]
    size: (u32, u32),
    /// Print JSON
    ///
    /// The fields are "scene", "camera" (eye, target, up), "objects" and "lights" (their numbers),
    /// and "lines", the description.
    #[arg(long, help_heading = None)]
    json: bool,
}

pub(super) fn run(args: &DescribeArgs) -> CommandResult {
    let (columns, rows) = args.size;
    // Two by four pixels per cell, the resolution of the finest glyphs (`shape`), so that nothing visible is left out.
    let [width, height] = [columns.saturating_mul(2), rows.saturating_mul(4)];
    check_pixel_count(width.into(), height.into())?;
    let resolution = Resolution::square(width, height);
    let scene = args.scene.load()?;
    let name = visible(&args.scene.name());
    let text = args.scene.on_threads(|| describe(&name, &scene, scene.camera(), resolution))?;
    if args.json {
        let lines: Vec<_> = text.lines().collect();
        let (objects, lights) = (scene.objects().len(), scene.lights().len());
        let camera = json::camera(scene.camera());
        return json::print(
            &json!({ "scene": name, "camera": camera, "objects": objects, "lights": lights, "lines": lines }),
        );
    }
    write_stdout(text.as_bytes())
}
