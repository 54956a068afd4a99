//! `termtrace explain`: explains how the colour of one pixel is computed.

use super::json;
use super::outcome::{CommandResult, usage, write_stdout};
use super::picture::SizeArgs;
use super::scene_args::SceneArgs;
use clap::Args;
use serde_json::{Value, json};
use termtrace::internals::cell::cell_of_pixel;
use termtrace::internals::explain::ShadedHit;
use termtrace::{CellMode, Explanation, explain};

const MEANING: &str = "\
The explanation uses the symbols of the lecture: the eye ray o + t d through the
point (q_u, q_v) of the view rectangle, t for every surface that the ray was
tested against, the equation of the closest one, the point p and its normal n,
the direction l and n.l of each light and the object that blocks it, and the
light from there to the bytes of the frame. Surfaces and lights are numbered
from 1, in the order of the scene file. The ray is that through the centre of
the pixel, which is the only one unless a command is given --samples.";

const EXAMPLES: &str = "\
Examples:
  termtrace explain my.ron --pixel 40,24    in the frame of 80x24 cells
  termtrace explain my.ron --pixel 0,0 --pixels 800x600";

#[derive(Args)]
#[command(after_long_help = format!("{MEANING}\n\n{EXAMPLES}"))]
pub(super) struct ExplainArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The pixel's column and row, from (0, 0) at the top left
    #[arg(long, help_heading = "Picture", value_name = "X,Y", value_parser = parse_pixel, allow_hyphen_values = true)]
    pixel: [u32; 2],
    #[command(flatten)]
    size: SizeArgs,
    /// Print JSON
    ///
    /// The fields are "pixel", "cell", "resolution", "camera", "q", "origin" and "direction" of the
    /// ray, "tested" (name, t), "hit" (name, t, point, normal, lights, ambient, arriving,
    /// reflectance; null for the background), "light" (linear) and "color" (8 bits).
    #[arg(long, help_heading = None)]
    json: bool,
}

pub(super) fn run(args: &ExplainArgs) -> CommandResult {
    // The live view's default mode, so that a pixel has the same column and row in both.
    let mode = CellMode::HALF_BLOCK;
    let resolution = args.size.resolution(mode)?;
    let [width, height] = [resolution.width(), resolution.height()];
    let [x, y] = args.pixel;
    if x >= width || y >= height {
        return Err(usage(format!("there is no pixel {x},{y} in a frame of {width}x{height} pixels")));
    }
    let scene = args.scene.load_scene()?;
    let explanation = explain(&scene, scene.camera(), resolution, args.pixel);
    if args.json {
        return json::print(&as_json(&explanation, mode));
    }
    let lines = explanation.lines().into_iter().chain([cell_of_pixel(args.pixel, mode)]);
    write_stdout(lines.map(|line| line + "\n").collect::<String>().as_bytes())
}

fn as_json(explanation: &Explanation, mode: CellMode) -> Value {
    let (ray, bytes) = (&explanation.ray, explanation.bytes);
    let tested = explanation.tested.iter().map(|surface| {
        let t = surface.t.map(json::number);
        json!({ "name": surface.name.to_string(), "t": t })
    });
    json!({
        "pixel": explanation.pixel,
        "cell": cell_of_pixel(explanation.pixel, mode),
        "resolution": [explanation.resolution.width(), explanation.resolution.height()],
        "camera": json::camera(&explanation.camera),
        "q": explanation.q.to_array().map(json::number),
        "origin": json::vector(ray.origin),
        "direction": json::vector(ray.direction),
        "tested": tested.collect::<Vec<_>>(),
        "hit": explanation.hit.as_ref().map(hit_as_json),
        "light": json::light(explanation.light),
        "color": [bytes.r, bytes.g, bytes.b],
    })
}

fn hit_as_json(shaded: &ShadedHit) -> Value {
    let lights = shaded.lights.iter().map(|light| {
        json!({
            "direction": json::vector(light.incidence.l),
            "cosine": json::number(light.incidence.cosine),
            "blocker": light.blocker.map(|(name, _)| name.to_string()),
            "arriving": json::light(light.arriving()),
        })
    });
    json!({
        "name": shaded.name.to_string(),
        "t": json::number(shaded.hit.t),
        "point": json::vector(shaded.point.position),
        "normal": json::vector(shaded.point.shading_normal),
        "lights": lights.collect::<Vec<_>>(),
        "ambient": json::light(shaded.ambient),
        "arriving": json::light(shaded.arriving),
        "reflectance": json::light(shaded.reflectance),
    })
}

/// Parses a pixel's column and row, such as `40,24`.
fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let numbers = text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    numbers.ok_or_else(|| "expected two whole numbers with a comma between them, such as 40,24".to_owned())
}
