//! `termtrace frame`: one frame without a terminal. Nothing is read from the environment.

mod golden;

use super::cells::{self, CellArgs};
use super::outcome::{Done, Failure, write_stdout};
use super::outputs;
use super::picture::PictureArgs;
use super::scene_args::SceneArgs;
use super::view::{self, ViewArgs};
use clap::{Args, ValueEnum};
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use termtrace::capabilities::{CellMode, Colors};
use termtrace::cell;
use termtrace::export;

const FILES: &str = "\
A frame does not depend on the terminal or the environment: auto is the ramp without colour for text, and half blocks in
truecolor for ANSI, SVG and HTML.";

const EXAMPLES: &str = "\
Examples:
  termtrace frame my.ron                                      text, 80x24 cells, to standard output
  termtrace frame my.ron --format ansi --size 120x40          truecolor half blocks
  termtrace frame my.ron --glyphs shape                       text whose characters follow the shapes
  termtrace frame my.ron -o my.png --pixels 800x600 --samples 16
  termtrace frame my.ron -o my.svg --size 120x40              a drawing for a web page; .html is a page
  termtrace frame my.ron --check my.txt --bless               write the golden frame
  termtrace frame my.ron --check my.txt                       compare with it";

#[derive(Args)]
#[command(after_help = format!("{}\n{}\n{FILES}\n\n{EXAMPLES}", cells::EXPLAINED, view::EXPLAINED))]
pub(super) struct FrameArgs {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    picture: PictureArgs,
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    cells: CellArgs,
    /// What to write [default: as the file name's ending says, or text]
    #[arg(long)]
    format: Option<Format>,
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
    /// Characters without colour
    Text,
    /// Cells in colour
    Ansi,
    /// Cells as a drawing, one rectangle per half cell
    Svg,
    /// Cells as a web page
    Html,
    /// A picture file, one pixel per half cell
    Png,
}

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

    /// What the frame's cells are made of; a picture file has the pixels of half blocks.
    fn cell_mode(&self, format: Format) -> CellMode {
        match format {
            Format::Text => self.cells.in_file(Colors::None),
            Format::Ansi | Format::Svg | Format::Html => self.cells.in_file(Colors::Truecolor),
            Format::Png => CellMode::HALF_BLOCK,
        }
    }

    /// Turns away what the format makes no use of.
    fn check_flags(&self, format: Format) -> Done {
        let wrong = |why: &str| Err(Failure::Usage(why.to_owned()));
        self.view.check_samples(self.picture.samples())?;
        match format {
            Format::Png if self.cells.is_given() => wrong("--color and --glyphs are for cells; a PNG has pixels"),
            Format::Png if self.output().is_none() && self.check.is_none() && io::stdout().is_terminal() => {
                wrong("a PNG would garble the terminal; name a file with -o, or pipe it")
            }
            Format::Png => Ok(()),
            _ if self.picture.has_scale() => wrong("--scale is for PNG; frames of cells take their size from --size"),
            Format::Text if self.cells.wants_color() => wrong("text has no colours; say --format ansi"),
            _ => Ok(()),
        }
    }

    /// The frame in a format.
    fn contents(&self, format: Format) -> Result<Vec<u8>, Failure> {
        let scene = self.scene.load()?;
        let mode = self.cell_mode(format);
        let resolution = self.picture.resolution(mode)?;
        self.picture.fits_scaled(resolution)?;
        let samples = self.picture.samples();
        let view = self.view.view();
        let picture =
            self.scene.on_threads(|| termtrace::view::picture(view, &scene, scene.camera(), resolution, samples))?;
        if format == Format::Png {
            let png = export::png(&picture, resolution.pixel_aspect, self.picture.scale());
            return png.map_err(|error| Failure::runtime("PNG", error));
        }
        let grid = cell::grid_from_picture(mode, &picture);
        let cell_aspect = self.picture.cell_aspect();
        Ok(match format {
            Format::Ansi if mode.colors != Colors::None => export::ansi(&grid),
            Format::Svg => export::svg(&grid, cell_aspect).into_bytes(),
            Format::Html => export::html(&grid, cell_aspect).into_bytes(),
            _ => export::text(&grid).into_bytes(),
        })
    }
}

pub(super) fn run(args: &FrameArgs) -> Done {
    let format = args.format()?;
    args.check_flags(format)?;
    if let Some(file) = args.output().or(args.check.as_deref().filter(|_| args.bless)) {
        args.scene.keeps(&[], file)?;
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
    match path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("txt" | "text") => Ok(Format::Text),
        Some("ans" | "ansi") => Ok(Format::Ansi),
        Some("svg") => Ok(Format::Svg),
        Some("html" | "htm") => Ok(Format::Html),
        Some("png") => Ok(Format::Png),
        _ => Err(Failure::Usage(format!(
            "{}: the name does not end in .txt, .ansi, .svg, .html or .png; say --format text, ansi, svg, html or png",
            path.display()
        ))),
    }
}
