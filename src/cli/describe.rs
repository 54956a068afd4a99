//! `termtrace describe`: describes a picture in words, for people who cannot see it.

use super::json;
use super::outcome::{CommandResult, write_stdout};
use super::picture::{check_pixel_count, parse_size};
use super::scene_args::SceneArgs;
use clap::Args;
use serde_json::{Value, json};
use termtrace::internals::describe::{Facts, ObjectFacts, facts};
use termtrace::internals::text::visible;
use termtrace::{Camera, Resolution, describe};

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
    /// The fields are "scene", "camera" (eye, target, up), "objects", "lights" (color, direction,
    /// position) and "background" (color, share). An object has number, kind, color, name, visible,
    /// whether the eye is inside it, the numbers of objects behind and in front of it, and either
    /// position, share, nearest and farthest, or the reason why it cannot be seen.
    #[arg(long, help_heading = None)]
    json: bool,
}

pub(super) fn run(args: &DescribeArgs) -> CommandResult {
    let (columns, rows) = args.size;
    // Two by four pixels per cell, one for each part of the finest glyphs (octants, braille), so that nothing visible
    // is left out.
    let [width, height] = [columns.saturating_mul(2), rows.saturating_mul(4)];
    check_pixel_count(width.into(), height.into())?;
    let resolution = Resolution::square(width, height);
    let scene = args.scene.load_scene()?;
    let name = visible(&args.scene.name());
    if args.json {
        let facts = args.scene.on_threads(|| facts(&scene, scene.camera(), resolution))?;
        return json::print(&as_json(&name, scene.camera(), &facts));
    }
    let text = args.scene.on_threads(|| describe(&name, &scene, scene.camera(), resolution))?;
    write_stdout(text.as_bytes())
}

fn as_json(name: &str, camera: &Camera, facts: &Facts) -> Value {
    let lights = facts.lights.iter().map(|light| {
        let position = light.position.map(json::vector);
        json!({ "color": light.color, "direction": light.direction, "position": position })
    });
    json!({
        "scene": name,
        "camera": json::camera(camera),
        "objects": facts.objects.iter().map(object_as_json).collect::<Vec<_>>(),
        "lights": lights.collect::<Vec<_>>(),
        "background": { "color": facts.background, "share": json::number(facts.background_share) },
    })
}

fn object_as_json(object: &ObjectFacts) -> Value {
    let mut fields = json!({
        "number": object.number,
        "kind": object.kind,
        "color": object.color,
        "name": object.name,
        "visible": object.seen.is_ok(),
        "in_front_of": object.in_front_of,
        "behind": object.behind,
        "eye_is_inside": object.eye_is_inside,
    });
    match &object.seen {
        Ok(seen) => {
            fields["position"] = seen.position.into();
            fields["share"] = json::number(seen.share);
            fields["nearest"] = json::number(seen.nearest);
            fields["farthest"] = json::number(seen.farthest);
        }
        Err(reason) => fields["reason"] = reason.as_str().into(),
    }
    fields
}
