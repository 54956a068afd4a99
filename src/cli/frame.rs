//! `termtrace frame`: prints one frame, or writes it to a file.
//!
//! Only a frame on a terminal depends on the environment and on the window's size.

mod golden;
mod screen;

use super::cells::CellArgs;
use super::help::capitalized;
use super::map::MapArgs;
use super::outcome::{CommandResult, Failure, write_stdout};
use super::outputs;
use super::picture::{FrameKind, PictureArgs};
use super::scene_args::SceneArgs;
use super::scene_source::warn_of_invisibility;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use screen::Screen;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use termtrace::export::Format;
use termtrace::internals::export::FileEncoder;
use termtrace::internals::maps;
use termtrace::internals::text::{any_of, listed};
use termtrace::{CellMode, Colors};

/// The format if neither `--format` nor the extension of a file name decides.
const DEFAULT: Format = Format::Text;

const FILES: &str = "\
On a terminal a frame without --format fills the window, in the colours that the
environment allows. Elsewhere it depends on neither: auto means ascii without colours
for text, and truecolor half blocks for ANSI, SVG and HTML.
A golden frame (--check) of any format has 80x24 cells and one sample per pixel,
unless flags say otherwise.";

const EXAMPLES: &str = "\
Examples:
  termtrace frame my.ron                              text, 80x24 cells
  termtrace frame my.ron --format ansi --size 120x40  truecolor half blocks
  termtrace frame my.ron --glyphs shape               characters by shape
  termtrace frame my.ron -o my.png                    1280x800 pixels, smooth edges
  termtrace frame my.ron -o my.svg --size 120x40      a drawing for a web page
  termtrace frame my.ron --check my.txt --bless       write the golden frame
  termtrace frame my.ron --check my.txt               compare with it";

#[derive(Args)]
#[command(after_long_help = format!("{FILES}\n\n{EXAMPLES}"))]
pub(super) struct FrameArgs {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    picture: PictureArgs,
    #[command(flatten)]
    map: MapArgs,
    #[command(flatten)]
    cells: CellArgs,
    /// Format to write [default: by the file name's extension, or text]
    #[arg(long, help_heading = "Output", value_name = "FORMAT", value_parser = format_parser())]
    format: Option<Format>,
    /// Write to a file; - is standard output [default: -]
    #[arg(short, long, help_heading = "Output", value_name = "FILE", conflicts_with = "check")]
    output: Option<PathBuf>,
    /// Compare with the frame in a file, and print a diff
    ///
    /// The exit code is 1 if they differ; of PNG files, NAME.diff.png then shows where.
    #[arg(long, help_heading = "Output", value_name = "GOLDEN")]
    check: Option<PathBuf>,
    /// With --check: write the golden frame instead of comparing
    #[arg(long, help_heading = "Output", requires = "check", hide_short_help = true)]
    bless: bool,
}

/// Returns all formats in the order of the help: the default, then other formats of cells, then
/// formats of pixels.
fn formats() -> Vec<Format> {
    let mut formats = Format::ALL.to_vec();
    // The sort is stable, so the formats of cells and those of pixels each keep the order of `Format::ALL`.
    formats.sort_by_key(|&format| (format != DEFAULT, format.has_pixels()));
    formats
}

fn format_parser() -> impl TypedValueParser<Value = Format> {
    let values = formats().into_iter().map(|format| PossibleValue::new(format.name()).help(capitalized(format.help())));
    PossibleValuesParser::new(values).map(|name| Format::from_name(&name).unwrap_or(DEFAULT))
}

impl FrameArgs {
    /// Returns the terminal to print on, unless `--format`, `--output` or `--check` is given.
    fn target_screen(&self) -> Option<Screen> {
        let is_plain = self.format.is_none() && self.output.is_none() && self.check.is_none();
        Screen::of_stdout(&self.cells).filter(|_| is_plain)
    }

    /// Returns the format: from `--format` or the extension of the file's name, or else ANSI on a
    /// terminal and `DEFAULT` elsewhere.
    fn format(&self) -> Result<Format, Failure> {
        match (self.format, self.output().or(self.check.as_deref())) {
            (Some(format), _) => Ok(format),
            (None, Some(path)) => format_by_ending(path),
            (None, None) => Ok(self.target_screen().map_or(DEFAULT, |_| Format::Ansi)),
        }
    }

    /// Returns the file to write to; `None` for standard output.
    fn output(&self) -> Option<&Path> {
        self.output.as_deref().filter(|&path| path != Path::new("-"))
    }

    /// Returns the cell mode of the frame. A picture file has as many pixels per cell as half
    /// blocks.
    fn cell_mode(&self, format: Format) -> CellMode {
        match format.file_encoder() {
            FileEncoder::Pixels(_) => CellMode::HALF_BLOCK,
            FileEncoder::Cells { has_colors: true, .. } => self.cells.mode_for_file(Colors::Truecolor),
            FileEncoder::Cells { has_colors: false, .. } => self.cells.mode_for_file(Colors::None),
        }
    }

    /// Refuses flags that have no effect on the format: ignoring one would look like a bug of the
    /// program.
    fn check_flags(&self, format: Format) -> CommandResult {
        let wrong = |why: String| Err(Failure::Usage(why));
        self.map.check_samples(self.picture.given_samples())?;
        let name = format.name();
        match format.file_encoder() {
            FileEncoder::Pixels(_) if self.cells.is_given() => {
                let of_cells = formats().into_iter().filter(|format| !format.has_pixels());
                let names = any_of(&of_cells.map(Format::name).collect::<Vec<_>>());
                let name = name.to_uppercase();
                wrong(format!(
                    "--color, --glyphs and --background are for cells ({names}); a {name} consists of pixels"
                ))
            }
            FileEncoder::Pixels(_) if self.output().is_none() && self.check.is_none() && io::stdout().is_terminal() => {
                wrong(format!("a {} would garble the terminal; name a file with -o, or pipe it", name.to_uppercase()))
            }
            FileEncoder::Cells { .. } if self.picture.has_scale() => {
                let of_pixels = formats().into_iter().filter(|format| format.has_pixels());
                let names: Vec<_> = of_pixels.map(|format| format.name().to_uppercase()).collect();
                wrong(format!("--scale is for {}; frames of cells take their size from --size", listed(&names)))
            }
            FileEncoder::Cells { has_colors: false, .. } if self.cells.wants_color() => {
                wrong(format!("{name} has no colours; use --format ansi"))
            }
            _ => Ok(()),
        }
    }

    /// Traces the frame and returns its bytes in `format`.
    fn contents(&self, format: Format) -> Result<Vec<u8>, Failure> {
        let scene = self.scene.load_scene()?;
        let screen = self.target_screen();
        let mode = screen.map_or_else(|| self.cell_mode(format), |screen| screen.mode);
        let kind = if self.check.is_some() { FrameKind::Cells } else { FrameKind::for_format(format) };
        let cells = screen.map(|screen| (screen.cells, screen.cell_aspect));
        let resolution = self.picture.resolution(mode, kind, cells)?;
        // Only picture files have a scale. A grid of cells may have more pixels on the screen than a picture may have
        // in memory.
        if format.has_pixels() {
            self.picture.check_scaled_pixel_count(resolution)?;
        }
        let samples = self.picture.samples(kind, mode);
        let map = self.map.map();
        warn_of_invisibility(map, &scene);
        // Only tracing runs in the pool of `--threads`; the file is encoded on one thread.
        match format.file_encoder() {
            FileEncoder::Pixels(write) => {
                let trace = || maps::picture(map, &scene, scene.camera(), resolution, samples);
                write(&self.scene.on_threads(trace)?, resolution.pixel_aspect(), self.picture.scale())
                    .map_err(|error| Failure::runtime(format.name().to_uppercase(), error))
            }
            FileEncoder::Cells { write, .. } => {
                let trace = || self.cells.painter(mode).trace(map, &scene, scene.camera(), resolution, samples);
                let grid = self.scene.on_threads(trace)?;
                let (aspect, name) = (self.picture.cell_aspect(), self.scene.name());
                let title = Path::new(&name).file_stem().unwrap_or_default().to_string_lossy();
                Ok(write(&grid, mode.colors, aspect, &title))
            }
        }
    }
}

pub(super) fn run(args: &FrameArgs) -> CommandResult {
    let format = args.format()?;
    // Arguments are checked before the scene is loaded, which may take seconds.
    args.check_flags(format)?;
    if let Some(file) = args.output().or(args.check.as_deref().filter(|_| args.bless)) {
        args.scene.refuse_overwriting(&[], file)?;
    }
    let frame = args.contents(format)?;
    match (&args.check, args.output()) {
        (Some(golden), _) if args.bless => outputs::write(golden, &frame),
        (Some(golden), _) => golden::check(golden, format, &frame),
        (None, Some(output)) => outputs::write(output, &frame),
        (None, None) => write_stdout(&frame),
    }
}

fn format_by_ending(path: &Path) -> Result<Format, Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    ending.and_then(|ending| Format::from_extension(&ending)).ok_or_else(|| {
        let endings: Vec<_> = formats().into_iter().map(|format| format!(".{}", format.extension())).collect();
        let names: Vec<_> = formats().into_iter().map(Format::name).collect();
        let (endings, names) = (any_of(&endings), any_of(&names));
        Failure::Usage(format!("{}: the name does not end in {endings}; choose with --format {names}", path.display()))
    })
}
