//! `termtrace record`: a film along a camera path. The film does not depend on the environment.

mod numbered;
mod progress;

use super::cells::glyph_parser;
use super::encoding::EncodingArgs;
use super::map::MapArgs;
use super::outcome::{CommandResult, Failure, print_error, reason};
use super::outputs::{Output, Outputs};
use super::picture::{FrameKind, PictureArgs, check_pixel_count};
use super::scene_args::SceneArgs;
use clap::Args;
use numbered::NumberedFiles;
use std::fs;
use std::io::{self, BufWriter, IsTerminal};
use std::path::{Path, PathBuf};
use termtrace::internals::capabilities::GlyphChoice;
use termtrace::internals::grid::HalfBlocks;
use termtrace::internals::maps;
use termtrace::internals::text::visible;
use termtrace::{
    Camera, CameraPath, Cast, CellMode, Encoder, Gif, Map, Order, Painter, Quality, Resolution, Sampling, Scene, Size,
    export,
};

const EXAMPLES: &str = "\
Camera paths:
  orbit       once around the scene's target at constant height, in --seconds
              (8), starting at the scene's own view
  FILE.ron    through keyframes:
              (keyframes: [(time: 0, eye: (0, 1, 5), target: (0, 0, 0)), ...])
              A keyframe may also have up and vertical_fov. The film ends at the
              last keyframe, or after --seconds.

Examples:
  termtrace record my.ron -o my.cast      an orbit; asciinema play my.cast
  termtrace record my.ron -o my.gif       480x300 pixels, 25 frames per second
  termtrace record my.ron --path flight.ron --pixels 640x360 --samples 4 -o frame-%04d.png
  termtrace record my.ron --compressed-link | gzip >my.cast.gz";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct RecordArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The orbit, or a file of keyframes
    #[arg(long, help_heading = "Film", value_name = "orbit|FILE", default_value = "orbit")]
    path: PathBuf,
    /// Length in seconds [default: 8, or the path's]
    #[arg(long, help_heading = "Film", value_name = "S", value_parser = parse_seconds)]
    seconds: Option<f64>,
    /// Frames per second [default: 30; GIF: 25]
    #[arg(long, help_heading = "Film", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=120))]
    fps: Option<u32>,
    #[command(flatten)]
    picture: PictureArgs,
    #[command(flatten)]
    map: MapArgs,
    /// Characters of an asciicast: as for frame [default: half]
    #[arg(long, help_heading = "Film", value_name = "KIND", value_parser = glyph_parser(), hide_short_help = true)]
    glyphs: Option<GlyphChoice>,
    #[command(flatten)]
    encoding: EncodingArgs,
    /// FILE.cast (asciicast), FILE.gif, or FILE-%04d.png
    ///
    /// PNG files are numbered from 1. - writes an asciicast to standard output, which is the default.
    #[arg(short, long, help_heading = "Film", value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Limit on the frames of a film: more than an hour at 25 per second. It bounds the memory of the
/// cameras, which are all computed before the first frame.
const MAX_FRAMES: usize = 100_000;
/// Limit on the frame rate of a GIF. Delays between frames are in hundredths of a second, and
/// viewers treat a delay of 1 as 10.
const MAX_GIF_FPS: u32 = 50;
/// Default frame rate of a GIF. The delay, 4 hundredths of a second, is a whole number, so that all
/// are equal.
const GIF_FPS: u32 = 25;
/// Default frame rate of an asciicast and of numbered PNG files.
const CAST_FPS: u32 = 30;
/// Default length of an orbit in seconds.
const ORBIT_SECONDS: f64 = 8.0;

/// The format of a film, with the files to write.
enum FilmFormat {
    /// An asciicast, on standard output if there is no file.
    Cast(Option<PathBuf>),
    Gif(PathBuf),
    Png(NumberedFiles),
}

impl FilmFormat {
    /// Returns the kind of the film's frames.
    fn kind(&self) -> FrameKind {
        match self {
            Self::Cast(_) => FrameKind::Cells,
            Self::Gif(_) => FrameKind::Gif,
            Self::Png(_) => FrameKind::Picture,
        }
    }
}

/// A film whose arguments have been checked.
struct Film {
    scene: Scene,
    cameras: Vec<Camera>,
    /// The time of the first frame in seconds.
    start: f64,
    fps: u32,
    resolution: Resolution,
    mode: CellMode,
    samples: Sampling,
    format: FilmFormat,
}

impl RecordArgs {
    fn format(&self) -> Result<FilmFormat, Failure> {
        let Some(path) = self.output.as_deref().filter(|&path| path != Path::new("-")) else {
            return Ok(FilmFormat::Cast(None));
        };
        match path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("cast") => Ok(FilmFormat::Cast(Some(path.to_owned()))),
            Some("gif") => Ok(FilmFormat::Gif(path.to_owned())),
            Some("png") => NumberedFiles::parse(path).map(FilmFormat::Png),
            _ => Err(Failure::Usage(format!("{}: the name does not end in .cast, .gif or .png", path.display()))),
        }
    }

    fn film(&self) -> Result<Film, Failure> {
        let format = self.format()?;
        if let Some(output) = &self.output {
            self.scene.refuse_overwriting(&[&self.path], output)?;
        }
        let kind = format.kind();
        let mode = self.cell_mode();
        let resolution = self.picture.resolution(mode, kind, None)?;
        let fps = self.fps.unwrap_or(if kind == FrameKind::Gif { GIF_FPS } else { CAST_FPS });
        self.check_flags(&format, resolution, fps)?;
        let scene = self.scene.load_scene()?;
        let cameras = self.cameras(scene.camera(), fps)?;
        let (start, samples) = (self.scene.time, self.picture.samples(kind, mode));
        Ok(Film { scene, cameras, start, fps, resolution, mode, samples, format })
    }

    /// Returns the cell mode of an asciicast; a GIF or PNG has the pixels of half blocks.
    fn cell_mode(&self) -> CellMode {
        let half = CellMode::HALF_BLOCK;
        CellMode { glyphs: self.glyphs.flatten().unwrap_or(half.glyphs), ..half }
    }

    /// Refuses sizes and frame rates that the format cannot represent, and flags that have no
    /// effect on it.
    fn check_flags(&self, format: &FilmFormat, resolution: Resolution, fps: u32) -> CommandResult {
        let wrong = |why: &str| Err(Failure::Usage(why.to_owned()));
        self.map.check_samples(self.picture.given_samples())?;
        let is_cast = matches!(format, FilmFormat::Cast(_));
        if matches!(format, FilmFormat::Cast(None)) && io::stdout().is_terminal() {
            return wrong("an asciicast would garble the terminal; name a file with -o, or pipe it");
        }
        if is_cast && self.picture.has_scale() {
            return wrong("--scale is for GIF and PNG; an asciicast takes its size from --size");
        }
        if !is_cast && self.glyphs.is_some() {
            return wrong(
                "--glyphs is for an asciicast; GIF and PNG consist of pixels; name a file that ends in .cast",
            );
        }
        if !is_cast && self.encoding.is_given() {
            return wrong(
                "--order, --compressed-link, --quality and --max-rate are for an asciicast; other films send no cells",
            );
        }
        // A file has square pixels, so its size differs from the resolution of the frames.
        let [width, height] = resolution.size_in_square_pixels(self.picture.scale());
        match format {
            FilmFormat::Cast(_) => Ok(()),
            FilmFormat::Gif(_) if fps > MAX_GIF_FPS => {
                wrong("a GIF has at most 50 frames per second: viewers slow down one that has more")
            }
            FilmFormat::Gif(_) if width.max(height) > u16::MAX.into() => Err(Failure::Usage(format!(
                "a GIF of {width}x{height} pixels is too large; at most 65535 in each direction"
            ))),
            FilmFormat::Gif(_) | FilmFormat::Png(_) => check_pixel_count(width, height),
        }
    }

    /// Returns the camera of each frame.
    fn cameras(&self, camera: &Camera, fps: u32) -> Result<Vec<Camera>, Failure> {
        let path = self.camera_path(camera)?;
        let name = self.path.display();
        let seconds = self.seconds.unwrap_or(path.seconds());
        if seconds == 0.0 {
            return Err(Failure::Usage(format!("{name}: the path ends at 0 seconds; set a length with --seconds")));
        }
        // The cast to usize does not saturate: `--seconds` is at most 1e6 and `--fps` 120, which makes 120 million
        // frames.
        let frames = ((seconds * f64::from(fps)).round() as usize).max(1);
        if frames > MAX_FRAMES {
            return Err(Failure::Usage(format!("a film of {frames} frames is too long; at most {MAX_FRAMES}")));
        }
        path.cameras(frames, fps).map_err(|error| Failure::Usage(format!("{name}: {error}")))
    }

    fn camera_path(&self, camera: &Camera) -> Result<CameraPath, Failure> {
        if self.path == Path::new("orbit") {
            return Ok(CameraPath::orbit(*camera, self.seconds.unwrap_or(ORBIT_SECONDS)));
        }
        if self.scene.camera_args.eye.is_some() || self.scene.camera_args.target.is_some() {
            return Err(Failure::Usage("--eye and --target are for the orbit; a path file contains both".to_owned()));
        }
        CameraPath::load(&self.path, camera).map_err(|error| Failure::Usage(error.to_string()))
    }

    fn sink(&self, film: &Film, outputs: &mut Outputs) -> io::Result<Sink> {
        let resolution = film.resolution;
        Ok(match &film.format {
            FilmFormat::Cast(path) => {
                let out = match path {
                    Some(path) => outputs.begin(path)?,
                    None => Output::Stdout(io::stdout()),
                };
                // Players draw both half blocks without a seam, so the encoder may choose between them.
                let encoder = Encoder::new()
                    .with_order(self.encoding.cell_order().unwrap_or(Order::Color))
                    .with_half_blocks(HalfBlocks::Either);
                // Buffered, because `Cast` writes a frame in many small pieces.
                let cast = Cast::begin(BufWriter::new(out), film.cells(), encoder, film.fps)?;
                Sink::Cast(
                    Box::new(Painter::new(film.mode)),
                    cast.with_quality(self.encoding.loss.given_quality().unwrap_or(Quality::Equal))
                        .with_max_rate(self.encoding.loss.given_max_rate()),
                )
            }
            FilmFormat::Gif(path) => {
                let out = BufWriter::new(outputs.begin(path)?);
                Sink::Gif(Gif::begin(out, resolution, self.picture.scale(), film.fps)?)
            }
            FilmFormat::Png(_) => Sink::Png { pixel_aspect: resolution.pixel_aspect(), scale: self.picture.scale() },
        })
    }
}

/// The writer of a film's frames, by format.
enum Sink {
    Cast(Box<Painter>, Cast<BufWriter<Output>>),
    Gif(Gif<BufWriter<Output>>),
    Png { pixel_aspect: f32, scale: u32 },
}

impl Sink {
    /// Traces and writes frame number `frame`, counted from 0.
    fn write_frame(&mut self, film: &Film, map: Map, frame: usize, outputs: &mut Outputs) -> io::Result<()> {
        let &Film { resolution, samples, .. } = film;
        let (scene, camera) = (&film.scene_at_frame_time(frame), &film.cameras[frame]);
        let picture = || maps::picture(map, scene, camera, resolution, samples);
        match self {
            Self::Cast(painter, cast) => cast.frame(painter.trace(map, scene, camera, resolution, samples)),
            Self::Gif(gif) => gif.frame(&picture()),
            Self::Png { pixel_aspect, scale } => {
                let bytes = export::png(&picture(), *pixel_aspect, *scale).map_err(io::Error::other)?;
                outputs.write(&film.file(frame), &bytes)
            }
        }
    }

    fn end(self) -> io::Result<()> {
        match self {
            Self::Cast(_, cast) => finish(cast.end()?),
            Self::Gif(gif) => finish(gif.end()?),
            Self::Png { .. } => Ok(()),
        }
    }
}

fn finish(out: BufWriter<Output>) -> io::Result<()> {
    out.into_inner()?.finish()
}

impl Film {
    /// Returns the scene at the time of frame number `frame`, counted from 0.
    fn scene_at_frame_time(&self, frame: usize) -> Scene {
        self.scene.clone().at_time(self.start + frame as f64 / f64::from(self.fps))
    }

    /// Returns the file that frame number `frame`, counted from 0, is written to, for messages too.
    fn file(&self, frame: usize) -> PathBuf {
        match &self.format {
            FilmFormat::Cast(None) => "standard output".into(),
            FilmFormat::Cast(Some(path)) | FilmFormat::Gif(path) => path.clone(),
            FilmFormat::Png(numbered) => numbered.file(frame + 1),
        }
    }

    /// Returns a line about the finished film: its name, length and size.
    ///
    /// `None` for standard output.
    fn summary(&self, pattern: Option<&Path>, scale: u32) -> Option<String> {
        let name = pattern.filter(|_| !matches!(self.format, FilmFormat::Cast(None)))?.display();
        let frames = self.cameras.len();
        let files = if matches!(self.format, FilmFormat::Png(_)) { frames } else { 1 };
        let bytes: u64 = (0..files).filter_map(|frame| Some(fs::metadata(self.file(frame)).ok()?.len())).sum();
        let (size, unit) = match self.format {
            FilmFormat::Cast(_) => {
                let Size { columns, rows } = self.cells();
                ([columns, rows].map(u64::from), " cells")
            }
            FilmFormat::Gif(_) | FilmFormat::Png(_) => (self.resolution.size_in_square_pixels(scale), ""),
        };
        let [width, height] = size;
        let plural = if frames == 1 { "" } else { "s" };
        Some(format!("{name}: {frames} frame{plural}, {width}x{height}{unit}, {}", file_size(bytes)))
    }

    /// Returns the size of the film in cells.
    fn cells(&self) -> Size {
        let (across, down) = self.mode.pixels_per_cell();
        // `SizeArgs::resolution` refuses more than 65535 cells in either direction.
        Size::new(self.resolution.width().div_ceil(across) as u16, self.resolution.height().div_ceil(down) as u16)
    }

    /// Adds the frame's file name to an error of writing it. A closed pipe, as after `| head`,
    /// becomes [`Stop::NoReader`].
    fn with_named_error<T>(&self, frame: usize, result: io::Result<T>) -> Result<T, Stop> {
        result.map_err(|error| match self.format {
            FilmFormat::Cast(None) if error.kind() == io::ErrorKind::BrokenPipe => Stop::NoReader,
            _ => Stop::Failure(Failure::runtime(self.file(frame).display(), reason(&error))),
        })
    }
}

/// The reason why a film ends before its last frame.
enum Stop {
    /// The reader of standard output has closed the pipe.
    NoReader,
    Failure(Failure),
}

pub(super) fn run(args: &RecordArgs) -> CommandResult {
    let film = args.film()?;
    let written = args.scene.on_threads(|| write(args, &film))?;
    match written {
        Ok(()) | Err(Stop::NoReader) => Ok(()),
        Err(Stop::Failure(failure)) => Err(failure),
    }
}

/// Traces and writes the film frame by frame, so that memory does not grow with its length.
fn write(args: &RecordArgs, film: &Film) -> Result<(), Stop> {
    let mut outputs = Outputs::default();
    let bar = progress::bar(film.cameras.len() as u64);
    let shown = bar.downgrade();
    outputs.remove_on_signals(move || {
        // If a signal ends the program, the bar is erased first; otherwise the shell's prompt would follow it on its
        // line.
        if let Some(bar) = shown.upgrade() {
            bar.finish_and_clear();
        }
    });
    // The bar is first drawn after the signal handler is installed: before, a signal would leave it on the screen.
    bar.tick();
    let mut sink = film.with_named_error(0, args.sink(film, &mut outputs))?;
    for frame in 0..film.cameras.len() {
        film.with_named_error(frame, sink.write_frame(film, args.map.map(), frame, &mut outputs))?;
        bar.inc(1);
    }
    // `end` gives an asciicast or GIF its name, so an interrupted film leaves no file.
    film.with_named_error(0, sink.end())?;
    if let Some(summary) = film.summary(args.output.as_deref(), args.picture.scale()) {
        // Without a terminal, where the progress bar is hidden, a successful command prints nothing.
        let is_shown = !bar.is_hidden();
        bar.finish_and_clear();
        if is_shown {
            print_error(&format!("{}\n", visible(&summary)));
        }
    }
    Ok(())
}

/// Formats the size of a file in bytes with two or three digits, such as `6.6 MB`.
fn file_size(bytes: u64) -> String {
    // A unit begins where the number in the unit before it would be rounded to four digits.
    let (value, unit) = match bytes as f64 {
        v if v >= 999.5e6 => (v / 1e9, "GB"),
        v if v >= 999.5e3 => (v / 1e6, "MB"),
        v => (v / 1e3, "kB"),
    };
    if value < 9.95 { format!("{value:.1} {unit}") } else { format!("{value:.0} {unit}") }
}

/// Parses a length in seconds: greater than 0, and at most the largest time of a path file.
fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|&seconds| seconds > 0.0 && seconds <= 1e6);
    seconds.ok_or_else(|| "expected a number of seconds greater than 0 and at most 1e6, such as 8".to_owned())
}
