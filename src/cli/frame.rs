//! `termtrace frame`: one frame without a terminal. Nothing is read from the environment.

mod golden;

use super::{Done, Failure, SceneArgs, reason, write_stdout};
use clap::{Args, ValueEnum};
use std::fs;
use std::io::{self, IsTerminal};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use termtrace::capabilities::{CellMode, USUAL_CELL_ASPECT};
use termtrace::cell;
use termtrace::export;
use termtrace::framebuffer::Resolution;
use termtrace::render::render;
use termtrace::scene::Scene;
use termtrace::tone::{Picture, tone};

const EXAMPLES: &str = "\
Examples:
  termtrace frame my.ron                                      text, 80x24 cells, to standard output
  termtrace frame my.ron --format ansi --size 120x40          truecolor half blocks
  termtrace frame my.ron -o my.png --pixels 800x600 --samples 16
  termtrace frame my.ron --check my.txt --bless               write the golden frame
  termtrace frame my.ron --check my.txt                       compare with it";

#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct FrameArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The frame's size in cells [default: 80x24]
    #[arg(long, value_name = "COLSxROWS", value_parser = parse_size, conflicts_with = "pixels")]
    size: Option<(u32, u32)>,
    /// The frame's size in pixels; a cell has two of them, one above the other
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pixels: Option<(u32, u32)>,
    /// What to write [default: as the file name's ending says, or text]
    #[arg(long)]
    format: Option<Format>,
    /// Rays per pixel; one goes through the pixel's centre
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..=65_536))]
    samples: u32,
    /// A cell's height over its width
    #[arg(long, value_name = "A", default_value_t = USUAL_CELL_ASPECT, value_parser = parse_cell_aspect)]
    cell_aspect: f32,
    /// PNG: make each pixel N by N of the file's [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256))]
    scale: Option<u32>,
    /// Write to a file; - is standard output [default: -]
    #[arg(short, long, value_name = "FILE", conflicts_with = "check")]
    output: Option<PathBuf>,
    /// Compare with the frame in a file instead of writing one; exit code 1 and a diff if they differ
    #[arg(long, value_name = "GOLDEN")]
    check: Option<PathBuf>,
    /// With --check: write the file
    #[arg(long, requires = "check")]
    bless: bool,
}

/// What a frame can be written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Plain characters by lightness
    Text,
    /// Truecolor half blocks
    Ansi,
    /// A picture file, one pixel per half cell
    Png,
}

/// The most pixels that a frame may have, and a scaled PNG: some 900 MB while it is traced.
const MAX_PIXELS: u64 = 1 << 25;

impl FrameArgs {
    /// What is to be written, by the flag, or by the file's name.
    fn format(&self) -> Result<Format, Failure> {
        match (self.format, self.output().or(self.check.as_deref())) {
            (Some(format), _) => Ok(format),
            (None, Some(path)) => format_by_ending(path),
            (None, None) => Ok(Format::Text),
        }
    }

    /// The file to write to, if it is not standard output.
    fn output(&self) -> Option<&Path> {
        self.output.as_deref().filter(|&path| path != Path::new("-"))
    }

    fn resolution(&self) -> Result<Resolution, Failure> {
        let (across, down) = CellMode::HalfBlock.pixels_per_cell();
        let (columns, rows) = self.size.unwrap_or((80, 24));
        let (width, height) = self.pixels.unwrap_or((columns.saturating_mul(across), rows.saturating_mul(down)));
        let limit = u32::from(u16::MAX);
        if width > limit || height > 2 * limit || u64::from(width) * u64::from(height) > MAX_PIXELS {
            return Err(too_large(width.into(), height.into()));
        }
        Ok(Resolution { width, height, pixel_aspect: self.cell_aspect * across as f32 / down as f32 })
    }

    fn picture(&self, scene: &Scene, resolution: Resolution) -> Result<Picture, Failure> {
        let samples = NonZeroU32::new(self.samples).unwrap_or(NonZeroU32::MIN);
        self.scene.on_threads(|| tone(&render(scene, &scene.camera, resolution, samples), scene))
    }

    /// The frame in a format.
    fn contents(&self, format: Format) -> Result<Vec<u8>, Failure> {
        let scene = self.scene.load()?;
        let resolution = self.resolution()?;
        let scale = self.scale.unwrap_or(1);
        let [width, height] = [resolution.width, resolution.height].map(|side| u64::from(side) * u64::from(scale));
        if width * height > MAX_PIXELS {
            return Err(too_large(width, height));
        }
        let picture = self.picture(&scene, resolution)?;
        Ok(match format {
            Format::Text => export::text(&cell::grid_from_picture(CellMode::Ramp, &picture)).into_bytes(),
            Format::Ansi => export::ansi(&cell::grid_from_picture(CellMode::HalfBlock, &picture)),
            Format::Png => {
                export::png(&picture, resolution.pixel_aspect, scale).map_err(|error| Failure::runtime("PNG", error))?
            }
        })
    }
}

pub(super) fn run(args: &FrameArgs) -> Done {
    let format = args.format()?;
    if format != Format::Png && args.scale.is_some() {
        return Err(Failure::Usage("--scale is for PNG; text and ANSI frames take their size from --size".to_owned()));
    }
    if format == Format::Png && args.output().is_none() && args.check.is_none() && io::stdout().is_terminal() {
        return Err(Failure::Usage("a PNG would garble the terminal; name a file with -o, or pipe it".to_owned()));
    }
    let frame = args.contents(format)?;
    match (&args.check, args.output()) {
        (Some(golden), _) if args.bless => write_file(golden, &frame),
        (Some(golden), _) => golden::check(golden, format, &frame),
        (None, Some(output)) => write_file(output, &frame),
        (None, None) => write_stdout(&frame),
    }
}

/// The whole frame is there before the file is touched.
fn write_file(path: &Path, bytes: &[u8]) -> Done {
    fs::write(path, bytes).map_err(|error| Failure::runtime(path.display(), reason(&error)))
}

fn format_by_ending(path: &Path) -> Result<Format, Failure> {
    match path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("txt" | "text") => Ok(Format::Text),
        Some("ans" | "ansi") => Ok(Format::Ansi),
        Some("png") => Ok(Format::Png),
        _ => Err(Failure::Usage(format!(
            "{}: the name does not end in .txt, .ansi or .png; say --format text, ansi or png",
            path.display()
        ))),
    }
}

fn too_large(width: u64, height: u64) -> Failure {
    Failure::Usage(format!(
        "a frame of {width}x{height} pixels is too large; at most 65535 across, 131070 down and {MAX_PIXELS} in all"
    ))
}

/// `80x24`, both at least 1.
fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X']).and_then(|(across, down)| Some((across.parse().ok()?, down.parse().ok()?)));
    sides
        .filter(|&(across, down)| across > 0 && down > 0)
        .ok_or_else(|| "expected two whole numbers from 1 on with an x between them, such as 80x24".to_owned())
}

/// A cell that anybody could read in.
pub(super) fn parse_cell_aspect(text: &str) -> Result<f32, String> {
    let aspect = text.parse().ok().filter(|aspect| (0.1..=10.0).contains(aspect));
    aspect.ok_or_else(|| "expected a number from 0.1 to 10, such as 2".to_owned())
}
