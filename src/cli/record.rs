//! `termtrace record`: a film along a camera path. Nothing is read from the environment.

mod numbered;
mod progress;

use super::encoding::{self, EncodingArgs};
use super::map::{self, MapArgs};
use super::outcome::{CommandResult, Failure, reason};
use super::outputs::{Output, Outputs};
use super::picture::{PictureArgs, check_pixel_count};
use super::scene_args::SceneArgs;
use clap::Args;
use numbered::NumberedFiles;
use std::io::{self, BufWriter, IsTerminal};
use std::path::{Path, PathBuf};
use termtrace::internals::cell;
use termtrace::internals::grid::HalfBlocks;
use termtrace::internals::record::gif_size;
use termtrace::{Camera, CameraPath, Cast, CellMode, Encoder, Gif, Order, Picture, Resolution, Scene, Size, export};

const EXAMPLES: &str = "\
Camera paths:
  orbit       once around the scene's target at constant height, in --seconds (8), beginning with the scene's own view
  FILE.ron    through keyframes: (keyframes: [(time: 0, eye: (0, 1, 5), target: (0, 0, 0)), ...]); a keyframe may also
              say up and vertical_fov; the film ends with the last one, or after --seconds

Examples:
  termtrace record my.ron -o my.cast                          an orbit, 80x24 cells; asciinema play my.cast
  termtrace record my.ron --seconds 4 --fps 20 --scale 6 -o my.gif
  termtrace record my.ron --path flight.ron --pixels 640x360 --samples 4 -o frame-%04d.png
  termtrace record my.ron --compressed-link | gzip >my.cast.gz";

#[derive(Args)]
#[command(after_help = format!("{}\n{}\n\n{EXAMPLES}", map::MAP_HELP, encoding::ENCODING_HELP))]
pub(super) struct RecordArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// How the camera moves: orbit, or a file of keyframes
    #[arg(long, value_name = "orbit|FILE", default_value = "orbit")]
    path: PathBuf,
    /// How long the film is [default: 8, or as long as the path file]
    #[arg(long, value_name = "S", value_parser = parse_seconds)]
    seconds: Option<f64>,
    /// Frames per second
    #[arg(long, value_name = "N", default_value = "30", value_parser = clap::value_parser!(u32).range(1..=120))]
    fps: u32,
    #[command(flatten)]
    picture: PictureArgs,
    #[command(flatten)]
    map: MapArgs,
    #[command(flatten)]
    encoding: EncodingArgs,
    /// Write to FILE.cast (asciicast), FILE.gif, or numbered from 1 to FILE-%04d.png; - is an asciicast to standard
    /// output [default: -]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// An hour at 25 frames per second, and more than anybody waits for.
const MAX_FRAMES: usize = 100_000;
/// Viewers show a delay of one hundredth of a second as ten.
const MAX_GIF_FPS: u32 = 50;
const ORBIT_SECONDS: f64 = 8.0;

/// What the film becomes.
enum FilmFormat {
    /// An asciicast, on standard output if there is no file.
    Cast(Option<PathBuf>),
    Gif(PathBuf),
    Png(NumberedFiles),
}

/// All that has been asked for, found to be possible.
struct Film {
    scene: Scene,
    cameras: Vec<Camera>,
    resolution: Resolution,
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
        let resolution = self.picture.resolution(CellMode::HALF_BLOCK)?;
        self.check_flags(&format, resolution)?;
        let scene = self.scene.load()?;
        let cameras = self.cameras(scene.camera())?;
        Ok(Film { scene, cameras, resolution, format })
    }

    /// Turns away what the format cannot be, or makes no use of.
    fn check_flags(&self, format: &FilmFormat, resolution: Resolution) -> CommandResult {
        let wrong = |why: &str| Err(Failure::Usage(why.to_owned()));
        self.map.check_samples(self.picture.samples())?;
        let is_cast = matches!(format, FilmFormat::Cast(_));
        if matches!(format, FilmFormat::Cast(None)) && io::stdout().is_terminal() {
            return wrong("an asciicast would garble the terminal; name a file with -o, or pipe it");
        }
        if is_cast && self.picture.has_scale() {
            return wrong("--scale is for GIF and PNG; an asciicast takes its size from --size");
        }
        if !is_cast && self.encoding.is_given() {
            return wrong(
                "--order, --compressed-link, --quality and --max-rate are for an asciicast; other films have no bytes to save",
            );
        }
        let (width, height) = gif_size(resolution, self.picture.scale());
        match format {
            FilmFormat::Cast(_) => Ok(()),
            FilmFormat::Png(_) => self.picture.check_scaled_pixel_count(resolution),
            FilmFormat::Gif(_) if self.fps > MAX_GIF_FPS => {
                wrong("a GIF has at most 50 frames per second: viewers slow down one that has more")
            }
            FilmFormat::Gif(_) if width.max(height) > u16::MAX.into() => {
                Err(Failure::Usage(format!("a GIF of {width}x{height} pixels is too large; at most 65535 each way")))
            }
            FilmFormat::Gif(_) => check_pixel_count(width, height),
        }
    }

    /// The camera of each frame.
    fn cameras(&self, camera: &Camera) -> Result<Vec<Camera>, Failure> {
        let path = self.camera_path(camera)?;
        let name = self.path.display();
        let seconds = self.seconds.unwrap_or(path.seconds());
        if seconds == 0.0 {
            return Err(Failure::Usage(format!("{name}: the path ends at 0 seconds; say --seconds for a longer film")));
        }
        // At most 120 million.
        let frames = ((seconds * f64::from(self.fps)).round() as usize).max(1);
        if frames > MAX_FRAMES {
            return Err(Failure::Usage(format!("a film of {frames} frames is too long; at most {MAX_FRAMES}")));
        }
        path.cameras(frames, self.fps).map_err(|error| Failure::Usage(format!("{name}: {error}")))
    }

    fn camera_path(&self, camera: &Camera) -> Result<CameraPath, Failure> {
        if self.path == Path::new("orbit") {
            return Ok(CameraPath::orbit(*camera, self.seconds.unwrap_or(ORBIT_SECONDS)));
        }
        if self.scene.camera_args.eye.is_some() || self.scene.camera_args.target.is_some() {
            return Err(Failure::Usage(
                "--eye and --target are for the orbit; a path file says both itself".to_owned(),
            ));
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
                let (across, down) = CellMode::HALF_BLOCK.pixels_per_cell();
                // A resolution is checked to have no more cells.
                let size = Size::new((resolution.width() / across) as u16, resolution.height().div_ceil(down) as u16);
                // Players draw the two halves of a cell alike.
                let encoder = Encoder::new()
                    .with_order(self.encoding.order().unwrap_or(Order::Color))
                    .with_half_blocks(HalfBlocks::Either);
                let cast = Cast::begin(BufWriter::new(out), size, encoder, self.fps)?;
                Sink::Cast(
                    cast.with_quality(self.encoding.loss.quality().unwrap_or_default())
                        .with_max_rate(self.encoding.loss.max_rate()),
                )
            }
            FilmFormat::Gif(path) => {
                let out = BufWriter::new(outputs.begin(path)?);
                Sink::Gif(Gif::begin(out, resolution, self.picture.scale(), self.fps)?)
            }
            FilmFormat::Png(_) => Sink::Png { pixel_aspect: resolution.pixel_aspect(), scale: self.picture.scale() },
        })
    }
}

/// Where frames go.
enum Sink {
    Cast(Cast<BufWriter<Output>>),
    Gif(Gif<BufWriter<Output>>),
    Png { pixel_aspect: f32, scale: u32 },
}

impl Sink {
    fn take(&mut self, picture: &Picture, file: &Path, outputs: &mut Outputs) -> io::Result<()> {
        match self {
            Self::Cast(cast) => cast.frame(cell::grid_from_picture(CellMode::HALF_BLOCK, picture)),
            Self::Gif(gif) => gif.frame(picture),
            Self::Png { pixel_aspect, scale } => {
                let bytes = export::png(picture, *pixel_aspect, *scale).map_err(io::Error::other)?;
                outputs.write(file, &bytes)
            }
        }
    }

    fn end(self) -> io::Result<()> {
        match self {
            Self::Cast(cast) => finish(cast.end()?),
            Self::Gif(gif) => finish(gif.end()?),
            Self::Png { .. } => Ok(()),
        }
    }
}

fn finish(out: BufWriter<Output>) -> io::Result<()> {
    out.into_inner()?.finish()
}

impl Film {
    /// The file that a frame, counted from 0, goes to.
    fn file(&self, frame: usize) -> PathBuf {
        match &self.format {
            FilmFormat::Cast(None) => "standard output".into(),
            FilmFormat::Cast(Some(path)) | FilmFormat::Gif(path) => path.clone(),
            FilmFormat::Png(numbered) => numbered.file(frame + 1),
        }
    }

    /// A reader that has seen enough (`| head`) is no error.
    fn written<T>(&self, frame: usize, result: io::Result<T>) -> Result<T, Stop> {
        result.map_err(|error| match self.format {
            FilmFormat::Cast(None) if error.kind() == io::ErrorKind::BrokenPipe => Stop::NoReader,
            _ => Stop::Failure(Failure::runtime(self.file(frame).display(), reason(&error))),
        })
    }
}

/// Why a film ends early.
enum Stop {
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

/// Frame by frame: no more than one is there at a time.
fn write(args: &RecordArgs, film: &Film) -> Result<(), Stop> {
    let mut outputs = Outputs::default();
    let bar = progress::bar(film.cameras.len() as u64);
    let shown = bar.downgrade();
    outputs.remove_on_signals(move || {
        // Whoever ends the recording finds a clean line.
        if let Some(bar) = shown.upgrade() {
            bar.finish_and_clear();
        }
    });
    // Not before: a signal would leave it.
    bar.tick();
    let mut sink = film.written(0, args.sink(film, &mut outputs))?;
    for (frame, camera) in film.cameras.iter().enumerate() {
        let (map, samples) = (args.map.map(), args.picture.samples());
        let picture = termtrace::internals::maps::picture(map, &film.scene, camera, film.resolution, samples);
        film.written(frame, sink.take(&picture, &film.file(frame), &mut outputs))?;
        bar.inc(1);
    }
    film.written(0, sink.end())
}

/// Greater than 0, and not beyond what a path file can say.
fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|&seconds| seconds > 0.0 && seconds <= 1e6);
    seconds.ok_or_else(|| "expected a number of seconds greater than 0 and at most 1e6, such as 8".to_owned())
}
