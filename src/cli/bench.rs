//! `termtrace bench`: measures how fast a scene is traced.

mod generated;

use super::json;
use super::outcome::{CommandResult, Failure, usage, write_stdout};
use super::picture::{check_pixel_count, parse_size};
use super::scene_args::CameraArgs;
use super::scene_source::SceneSource;
use super::threads::on_threads;
use clap::{Args, ValueEnum};
use generated::Generated;
use serde_json::{Value, json};
use std::fmt::Write;
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use termtrace::internals::hit::Kernel;
use termtrace::internals::rasterize::rasterize;
use termtrace::internals::render::{Counts, count_rays_and_hits};
use termtrace::internals::text::visible;
use termtrace::{Resolution, Scene, render, tone};

const FIGURES: &str = "\
A round traces the eye rays of a picture and a shadow ray from each hit to each
light. It prints the number of hits, the time and the rays per second; then the
time of a whole frame, up to its 8-bit picture, and a hash of its light. With
--algorithm rasterize a round draws the scene object by object instead, on one
thread: which object each pixel shows, as the eye rays find it.";

const EXAMPLES: &str = "\
Examples:
  termtrace bench                             three spheres on a plane
  termtrace bench --scene s100k --threads 1   100,000 spheres, one thread
  termtrace bench my.ron --pixels 200x120 --samples 16
  termtrace bench --scene s1k --algorithm rasterize   object by object";

#[derive(Args)]
#[command(after_long_help = format!("{FIGURES}\n\n{EXAMPLES}"))]
pub(super) struct BenchArgs {
    /// The scene file [default: --scene three]
    #[arg(value_name = "SCENE", conflicts_with = "generated")]
    scene: Option<PathBuf>,
    /// A generated scene instead of a file
    #[arg(long = "scene", value_name = "NAME")]
    generated: Option<Generated>,
    /// The picture's size in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse_size)]
    pixels: (u32, u32),
    /// Rays per pixel
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..=65_536))]
    samples: u32,
    /// Number of threads that trace [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// How rays are traced through the scene; affects the time only
    #[arg(long, value_name = "HOW", default_value = "auto")]
    kernel: KernelArg,
    /// Image order or object order
    #[arg(long, value_name = "ORDER", default_value = "raytrace")]
    algorithm: Algorithm,
    /// Number of rounds
    #[arg(long, value_name = "N", default_value = "5", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: u32,
    /// Trace no shadow rays
    #[arg(long)]
    no_shadow: bool,
    /// Print JSON
    ///
    /// The fields are "scene", "build_seconds", "tree_bytes" and "rounds". Each round has "rays",
    /// "hits", "lit" (pairs of a hit and a light that reaches it), "depths" (the sum of the hits'
    /// depths), "trace_seconds", "frame_seconds" and "hash". With --algorithm rasterize each round has
    /// "hits", "depths" and "draw_seconds".
    #[allow(clippy::doc_markdown, reason = "the help shows these texts as they are")]
    #[arg(long)]
    json: bool,
}

/// The values of `--algorithm`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Algorithm {
    /// Image order: the closest hit of the ray through each pixel
    Raytrace,
    /// Object order: projection of each object, and a depth buffer
    Rasterize,
}

/// The values of `--kernel`: a [`Kernel`] with help for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum KernelArg {
    /// As packets, while that is cheaper than single rays
    Auto,
    /// Single rays, each against eight boxes or primitives at once
    Single,
    /// Always as packets
    Packet,
    /// Single rays, without SIMD instructions
    Scalar,
}

impl KernelArg {
    fn kernel(self) -> Kernel {
        match self {
            Self::Auto => Kernel::Auto,
            Self::Single => Kernel::Single,
            Self::Packet => Kernel::Packet,
            Self::Scalar => Kernel::Scalar,
        }
    }
}

impl BenchArgs {
    /// Returns the scene's name and the scene.
    fn load_scene(&self) -> Result<(String, Scene), Failure> {
        let camera_args = CameraArgs { threads: self.threads, ..CameraArgs::default() };
        let (name, scene) = if let Some(path) = &self.scene {
            (visible(&path.display().to_string()), camera_args.load_scene(&SceneSource::from_path(path, None)?)?)
        } else {
            let generated = self.generated.unwrap_or(Generated::Three);
            (format!("{generated:?}").to_lowercase(), generated.scene().map_err(usage)?)
        };
        let shadows = scene.shadows() && !self.no_shadow;
        Ok((name, scene.with_shadows(shadows)))
    }

    /// Refuses `--samples` with `--algorithm rasterize`, which draws one sample per pixel.
    fn check_algorithm(&self) -> CommandResult {
        if self.algorithm == Algorithm::Rasterize && self.samples > 1 {
            let message = "--algorithm rasterize draws one sample per pixel; --samples is for --algorithm raytrace";
            return Err(Failure::Usage(message.to_owned()));
        }
        Ok(())
    }

    fn round(&self, scene: &Scene, resolution: Resolution) -> Round {
        match self.algorithm {
            Algorithm::Raytrace => {
                let samples = NonZeroU32::new(self.samples).unwrap_or(NonZeroU32::MIN);
                Round::Traced(TracedRound::measured(self.kernel.kernel(), scene, resolution, samples))
            }
            Algorithm::Rasterize => Round::Rasterized(RasterizedRound::measured(scene, resolution)),
        }
    }

    fn resolution(&self) -> Result<Resolution, Failure> {
        let (width, height) = self.pixels;
        check_pixel_count(width.into(), height.into())?;
        Ok(Resolution::square(width, height))
    }
}

pub(super) fn run(args: &BenchArgs) -> CommandResult {
    // Checked before the scene is generated or read, which takes seconds if the scene is large.
    let resolution = args.resolution()?;
    args.check_algorithm()?;
    // The trees are built in the same pool, so that `--threads` also applies to the measured time of the build.
    on_threads(args.threads, || {
        let (name, scene) = args.load_scene()?;
        let (built, bytes) = build_seconds_and_bytes(&scene);
        if args.json {
            let rounds: Vec<_> = (0..args.rounds).map(|_| args.round(&scene, resolution).as_json()).collect();
            return json::print(
                &json!({ "scene": name, "build_seconds": built, "tree_bytes": bytes, "rounds": rounds }),
            );
        }
        write_stdout(format!("{name}: built in {built:.3} s, {bytes} bytes\n").as_bytes())?;
        for number in 1..=args.rounds {
            // Each round is printed as soon as it ends, so that an interrupted bench has shown its results so far.
            write_stdout(args.round(&scene, resolution).table_line(number).as_bytes())?;
        }
        Ok(())
    })?
}

/// Builds the scene's trees, and returns the time in seconds and their size in bytes.
fn build_seconds_and_bytes(scene: &Scene) -> (f64, usize) {
    // The trees are built a second time to be timed: loading the scene includes parsing it.
    let objects = scene.objects().to_vec();
    let start = Instant::now();
    let again = Scene::new(*scene.camera(), objects);
    (start.elapsed().as_secs_f64(), again.tree_bytes())
}

/// The results of one round of the benchmark.
enum Round {
    Traced(TracedRound),
    Rasterized(RasterizedRound),
}

impl Round {
    fn as_json(&self) -> Value {
        match self {
            Self::Traced(round) => round.as_json(),
            Self::Rasterized(RasterizedRound { hits, depths, time }) => {
                json!({ "hits": hits, "depths": depths, "draw_seconds": time.as_secs_f64() })
            }
        }
    }

    fn table_line(&self, number: u32) -> String {
        match self {
            Self::Traced(round) => round.table_line(number),
            Self::Rasterized(RasterizedRound { hits, depths, time }) => {
                format!("round {number}: {hits} hits, depths {depths:.3}, {:.6} s\n", time.as_secs_f64())
            }
        }
    }
}

/// The results of one round of drawing with a depth buffer: the number of pixels that show an
/// object, the sum of their depths, and the time.
struct RasterizedRound {
    hits: u64,
    depths: f64,
    time: Duration,
}

impl RasterizedRound {
    fn measured(scene: &Scene, resolution: Resolution) -> Self {
        let start = Instant::now();
        let buffer = rasterize(scene, scene.camera(), resolution);
        let time = start.elapsed();
        // Summed after the clock has stopped, because it is not a part of drawing.
        let (hits, depths) = buffer.hits_and_depths();
        Self { hits, depths, time }
    }
}

/// The ray counts and times of one round of tracing.
struct TracedRound {
    counts: Counts,
    trace: Duration,
    frame: Duration,
    hash: u64,
}

impl TracedRound {
    fn measured(kernel: Kernel, scene: &Scene, resolution: Resolution, samples: NonZeroU32) -> Self {
        let start = Instant::now();
        let counts = count_rays_and_hits(kernel, scene, scene.camera(), resolution, samples);
        let trace = start.elapsed();
        let start = Instant::now();
        let light = render(scene, scene.camera(), resolution, samples);
        // Without the black box the optimiser removes the tone mapping, whose result is not used.
        std::hint::black_box(tone(&light, scene));
        Self { counts, trace, frame: start.elapsed(), hash: light.hash() }
    }

    fn as_json(&self) -> Value {
        let Counts { rays, hits, lit, depths } = self.counts;
        let (trace, frame) = (self.trace.as_secs_f64(), self.frame.as_secs_f64());
        json!({
            "rays": rays, "hits": hits, "lit": lit, "depths": depths,
            // The hash is text, because many readers of JSON round numbers from 2^53 on.
            "trace_seconds": trace, "frame_seconds": frame, "hash": format!("{:016x}", self.hash),
        })
    }

    fn table_line(&self, number: u32) -> String {
        let Counts { rays, hits, lit, depths } = self.counts;
        let [trace, frame] = [self.trace, self.frame].map(|time| time.as_secs_f64());
        // Avoids a division by 0: a coarse clock may measure no time for a tiny picture.
        let rate = rays as f64 / trace.max(1e-9) / 1e6;
        let mut line = format!("round {number}: {rays} rays, {hits} hits, {lit} lit, depths {depths:.3}, ");
        let _ = writeln!(line, "{trace:.6} s, {rate:.1} Mrays/s; frame {frame:.6} s, hash {:016x}", self.hash);
        line
    }
}
