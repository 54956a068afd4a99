//! The encoder's bytes, against those of ratatui's own backend in the same run. By hand:
//!
//! - `cargo bench --bench bytes` makes four sequences of 120 frames at two sizes;
//! - `cargo bench --bench bytes -- --seed N` adds two that are drawn from the seed;
//! - `cargo bench --bench bytes -- FOLDER` takes the folder's sequences in place of the four. They are raw frames in
//!   files named `NAME_COLSxROWS.rgb`: all frames one after another, COLS x 2 ROWS sRGB pixels each, 3 bytes a pixel,
//!   row by row from the top;
//! - `cargo bench --bench bytes -- --programs` runs two programs of ratatui on both backends, which otherwise come
//!   last;
//! - `cargo bench --bench bytes -- --capped` only sends frames at the motions of a camera, most with a limit of bytes,
//!   which otherwise come after the programs: four motions, and those drawn from the seeds, 1 to 3 by default;
//! - `cargo bench --bench bytes -- --capped --before REVISION` then builds another revision, and runs the same of its
//!   bench;
//! - `cargo bench --bench bytes -- --test` only sees whether it runs.
//!
//! Bytes are the mean of all frames after the first. Times are CPU time, the best of five, cells filled included.

mod capped;
mod motions;
mod programs;
mod scenes;
mod seen;
mod send;
mod table;

use scenes::{FRAMES, Kind, Sequence};
use seen::{Outcome, outcome};
use send::{Sent, Way, sent, times};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use termtrace::{Order, Picture, Quality, Size, Srgb8};

const SIZES: [Size; 2] = [Size::new(80, 24), Size::new(200, 60)];

/// The options of a run.
#[derive(Default)]
struct Options {
    folder: Option<PathBuf>,
    seeds: Vec<u64>,
    is_test: bool,
    only_programs: bool,
    only_capped: bool,
    before: Option<String>,
}

impl Options {
    fn from_arguments() -> Self {
        let mut options = Self::default();
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                // Cargo's own.
                "--bench" => {}
                "--test" => options.is_test = true,
                "--programs" => options.only_programs = true,
                "--capped" => options.only_capped = true,
                "--before" => options.before = Some(arguments.next().expect("--before takes a revision")),
                "--seed" => {
                    let number = arguments.next().and_then(|number| number.parse().ok());
                    options.seeds.push(number.expect("--seed takes a number"));
                }
                option if option.starts_with('-') => panic!("no such option: {option}"),
                folder => options.folder = Some(folder.into()),
            }
        }
        options
    }

    fn sizes(&self) -> &'static [Size] {
        if self.is_test { &SIZES[..1] } else { &SIZES }
    }

    fn frame_count(&self) -> usize {
        if self.is_test { 3 } else { FRAMES }
    }

    fn rounds(&self) -> usize {
        if self.is_test { 1 } else { 5 }
    }
}

/// The frames of a sequence, and what they are like.
struct Frames {
    name: String,
    kind: Option<Kind>,
    is_drawn: bool,
    size: Size,
    pictures: Vec<Picture>,
}

impl Frames {
    fn made(sequence: &Sequence, name: String, is_drawn: bool, size: Size, count: usize) -> Self {
        let pictures = (0..count).map(|k| sequence.frame(k, size)).collect();
        Self { name, kind: Some(sequence.kind), is_drawn, size, pictures }
    }

    /// Reads a sequence from a file, with the size in its name.
    fn read(path: &Path, most: usize) -> Option<Self> {
        let (name, size) = path.file_name()?.to_str()?.strip_suffix(".rgb")?.rsplit_once('_')?;
        let (columns, rows) = size.split_once('x')?;
        let size = Size::new(columns.parse().ok()?, rows.parse().ok()?);
        let (width, height) = (usize::from(size.columns), 2 * usize::from(size.rows));
        let bytes = fs::read(path).expect("a file of frames can be read");
        let picture = |frame: &[u8]| {
            let pixels = frame.chunks_exact(3).map(|p| Srgb8::new(p[0], p[1], p[2])).collect();
            Picture::from_pixels(width as u32, height as u32, pixels).expect("all its pixels")
        };
        let pictures = bytes.chunks_exact(3 * width * height).take(most).map(picture).collect();
        let kind = Kind::ALL.into_iter().find(|kind| kind.name() == name);
        Some(Self { name: name.to_owned(), kind, is_drawn: false, size, pictures })
    }

    /// Takes some time.
    fn measured(self, rounds: usize) -> Measured {
        let (color, raster) = (Way::Exact(Order::Color), Way::Exact(Order::Raster));
        let ways = [Way::Ratatui, color, raster, Way::Lossy(Quality::Equal), Way::Lossy(Quality::Fast)];
        Measured {
            ratatui: sent(Way::Ratatui, &self.pictures),
            color: sent(color, &self.pictures),
            raster: sent(raster, &self.pictures),
            equal: outcome(Quality::Equal, &self.pictures),
            fast: outcome(Quality::Fast, &self.pictures),
            times: times(ways, &self.pictures, rounds),
            name: self.name,
            kind: self.kind,
            is_drawn: self.is_drawn,
            size: self.size,
        }
    }
}

/// The measurements of a sequence.
struct Measured {
    name: String,
    kind: Option<Kind>,
    /// Whether it is a random sequence, from a seed, and not one of the four.
    is_drawn: bool,
    size: Size,
    ratatui: Sent,
    color: Sent,
    raster: Sent,
    equal: Outcome,
    fast: Outcome,
    /// CPU time, in microseconds a frame: ratatui's, and those of `color`, `raster`, `equal` and
    /// `fast`.
    times: [f64; 5],
}

/// The sequences of a folder, or the four.
fn given(options: &Options) -> Vec<Frames> {
    if let Some(folder) = &options.folder {
        let entries = fs::read_dir(folder).expect("a folder of frames can be read");
        let paths = entries.map(|entry| entry.expect("the folder can be read").path());
        let mut all: Vec<Frames> = paths.filter_map(|path| Frames::read(&path, options.frame_count())).collect();
        let place = |kind| Kind::ALL.iter().position(|&one| Some(one) == kind).unwrap_or(Kind::ALL.len());
        all.sort_by_cached_key(|frames| (place(frames.kind), frames.name.clone()));
        return all;
    }
    let made = |size, kind: Kind| {
        Frames::made(&Sequence::of(kind), kind.name().to_owned(), false, size, options.frame_count())
    };
    options.sizes().iter().flat_map(|&size| Kind::ALL.map(|kind| made(size, kind))).collect()
}

/// Returns the random sequences of the seeds, and prints what they are.
fn drawn(options: &Options) -> Vec<Frames> {
    let mut all = Vec::new();
    for seed in &options.seeds {
        for sequence in Sequence::drawn(*seed) {
            let name = format!("{} of seed {seed}", sequence.kind.name());
            println!("{name}: {sequence}");
            let made = |&size| Frames::made(&sequence, name.clone(), true, size, options.frame_count());
            all.extend(options.sizes().iter().map(made));
        }
    }
    all
}

fn main() {
    let options = Options::from_arguments();
    if options.only_programs {
        return programs::print(options.is_test);
    }
    if options.only_capped {
        return print_capped(&options);
    }
    let mut sequences = given(&options);
    sequences.extend(drawn(&options));
    let mut sizes: Vec<Size> = sequences.iter().map(|frames| frames.size).collect();
    sizes.sort_by_key(|size| size.cell_count());
    sizes.dedup();
    for size in sizes {
        let of_size = sequences.extract_if(.., |frames| frames.size == size);
        let measured: Vec<Measured> = of_size.map(|frames| frames.measured(options.rounds())).collect();
        table::print(&format!("{}x{}", size.columns, size.rows), &measured);
    }
    if options.folder.is_none() {
        programs::print(options.is_test);
        print_capped(&options);
    }
}

fn print_capped(options: &Options) {
    let frames = options.frame_count().min(motions::FRAMES);
    let seeds: &[u64] = if options.seeds.is_empty() { &[1, 2, 3] } else { &options.seeds };
    for &size in options.sizes() {
        capped::print(size, frames, options.rounds(), seeds);
    }
    if let Some(revision) = &options.before {
        println!("\n{revision}:");
        run_before(revision, seeds);
    }
}

/// Builds the bench of another revision, and runs it with the same seeds.
fn run_before(revision: &str, seeds: &[u64]) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("before");
    let root = env!("CARGO_MANIFEST_DIR");
    fs::create_dir_all(&folder).expect("the folder for temporary files can be written");
    let script = r#"git -C "$1" archive "$2" | tar -x -C "$3" && cd "$3" && shift 3 &&
        cargo bench --locked --bench bytes -- --capped "$@""#;
    let mut shell = Command::new("sh");
    shell.args(["-c", script, "sh", root, revision]).arg(&folder);
    for seed in seeds {
        shell.arg("--seed").arg(seed.to_string());
    }
    assert!(shell.status().expect("a shell runs").success(), "the bench of {revision} failed");
}
