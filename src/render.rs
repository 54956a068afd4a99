//! Scene -> framebuffer, tile by tile: eye rays -> hits -> shadow rays -> shade.
//!
//! What crosses a tile goes together: each step is a function over arrays of its rays, 256 at most, so that tracing them
//! as packets, looking at a tile's edges or explaining one ray is a choice inside a step.
//!
//! A frame is a pure function of scene, camera, resolution and [`Sampling`]. Tiles run on the threads of the current
//! rayon pool; as no pixel's light depends on another's, neither their number nor their order shows. Which pixels get
//! more samples does depend on others: that is decided after a first pass over the whole picture.

use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::{Eight, LANES};
use crate::progress::{Cancellation, Cancelled};
use crate::ray::EightRays;
use crate::scene::Scene;
use crate::shade::{self, EightArriving, EightLights, EightPoints, ShadowRays};
use pixel::{First, Watched};
use rayon::prelude::*;
use sampling::{MOST_RAYS, PASSES, Run, Runs};
use std::num::NonZeroU32;
use std::ops::{AddAssign, Range};
use std::time::{Duration, Instant};
use tiles::{ALL_PIXELS, PIXELS, Tiles};

mod count;
mod one;
mod pixel;
mod sampling;
mod sights;
mod tiles;

pub use count::{Counts, count};
pub use one::{Steps, trace_pixel};
pub use sampling::Sampling;
pub(crate) use sights::all_sights;
pub use sights::{Reach, Sight, Sighted, sights};

/// The picture of `scene` that `camera` sees. The first ray of a pixel goes through its centre.
pub fn render(scene: &Scene, camera: &Camera, resolution: Resolution, sampling: impl Into<Sampling>) -> Framebuffer {
    render_all(Crew::Pool, scene, camera, resolution, sampling.into()).framebuffer
}

/// A frame, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The picture.
    pub framebuffer: Framebuffer,
    /// What it took. Nothing in the picture depends on it.
    pub cost: Cost,
}

/// What tracing took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// How many rays were traced: eye rays and shadow rays.
    pub rays: u64,
    /// How long that took, all threads together.
    pub work: Duration,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, more: Self) {
        self.rays += more.rays;
        self.work += more.work;
    }
}

/// The threads that trace.
#[derive(Clone, Copy, Debug)]
pub enum Crew<'a> {
    /// The calling thread alone: to wake others for a frame of less than about a millisecond takes longer than they save.
    Alone,
    /// The threads of the current rayon pool.
    Pool,
    /// The same, until the token is cancelled.
    Cancellable(&'a Cancellation),
}

impl Crew<'_> {
    fn is_cancelled(self) -> bool {
        matches!(self, Self::Cancellable(token) if token.is_cancelled())
    }

    /// Returns what was traced. A crew that is cancelled passes over what is left, so this is asked when it is through: a
    /// token that is not cancelled then never was.
    pub(crate) fn finish<T>(self, traced: T) -> Result<T, Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(traced) }
    }
}

/// [`render`] by that crew.
///
/// # Errors
/// [`Cancelled`], if the crew's token is.
pub fn render_by(
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: impl Into<Sampling>,
) -> Result<Rendered, Cancelled> {
    crew.finish(render_all(crew, scene, camera, resolution, sampling.into()))
}

/// [`render`] by that crew; one that is cancelled passes over what is left.
pub(crate) fn render_all(
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Rendered {
    match sampling {
        Sampling::Coarse => alike(crew, scene, &Tiles::new(camera, resolution, 2), 1),
        Sampling::Each(samples) => alike(crew, scene, &Tiles::new(camera, resolution, 1), samples.get()),
        Sampling::UpTo(samples) => {
            let mut picture = Refining::new(camera, resolution);
            let cost = picture.refine(crew, scene, samples);
            Rendered { framebuffer: picture.framebuffer(), cost }
        }
    }
}

/// The picture with so many samples of each pixel.
fn alike(crew: Crew<'_>, scene: &Scene, tiles: &Tiles, samples: u32) -> Rendered {
    let mut framebuffer = Framebuffer::new(tiles.resolution);
    let parts = tiles.split(&mut framebuffer.pixels);
    let (runs, share) = (Runs::of(0..samples), 1.0 / samples as f32);
    let cost = crew.trace(parts, |buffers, (tile, mut part)| {
        let mut sums = [[Eight::ZERO; 3]; PIXELS / LANES];
        tiles.inside(tile, &mut buffers.wanted);
        let cost = buffers.trace_tile(crew, scene, tiles, tile, &runs, |buffers, run, lot| {
            add_lights(&mut sums, &buffers.lights, run.each(), lot);
        });
        tiles.show(&buffers.wanted, |at| shade::light_of(&sums[at / LANES], at % LANES) * share, &mut part);
        cost
    });
    Rendered { framebuffer, cost }
}

/// Adds the light of so many rays each to that of these pixels: of each pixel in the order of its samples.
fn add_lights(sums: &mut [EightLights], lights: &[EightLights], each: usize, pixels: Range<usize>) {
    if each == 1 {
        const { assert!(PIXELS <= MOST_RAYS, "one sample of each pixel is one lot") };
        for (sums, lights) in sums.iter_mut().zip(lights) {
            for (sum, &light) in sums.iter_mut().zip(lights) {
                *sum = *sum + light;
            }
        }
        return;
    }
    for (band, in_row) in in_rows(lights).iter().enumerate() {
        for (pixel, lights) in pixels.clone().zip(in_row.chunks_exact(each)) {
            let sum = &mut sums[pixel / LANES][band].0[pixel % LANES];
            *sum = lights.iter().fold(*sum, |sum, light| sum + light);
        }
    }
}

/// The light of all rays of a lot, band by band.
fn in_rows(lights: &[EightLights]) -> [[f32; MOST_RAYS]; 3] {
    let mut rows = [[0.0; MOST_RAYS]; 3];
    for (band, row) in rows.iter_mut().enumerate() {
        for (eight, light) in row.as_chunks_mut().0.iter_mut().zip(lights) {
            *eight = light[band].0;
        }
    }
    rows
}

impl Crew<'_> {
    /// Traces each tile on one of the threads. Returns what all took.
    fn trace<T: Send>(self, tiles: Vec<T>, trace: impl Fn(&mut Buffers, (usize, T)) -> Cost + Send + Sync) -> Cost {
        let mut sum = Cost::default();
        for cost in self.share(tiles, trace) {
            sum += cost;
        }
        sum
    }

    /// Does the work of each tile on one of the threads, each of which keeps its buffers from tile to tile. Returns the
    /// results, in no order.
    fn share<T: Send, B: Default, R: Send>(
        self,
        tiles: Vec<T>,
        work: impl Fn(&mut B, (usize, T)) -> R + Send + Sync,
    ) -> Vec<R> {
        let (start, count) = (Instant::now(), tiles.len() as u32);
        let is_short = |done: u32| start.elapsed() * count < SHORT * done;
        let mut is_alone = matches!(self, Self::Alone);
        let mut tiles = tiles.into_iter().enumerate();
        let (mut buffers, mut all) = (B::default(), Vec::with_capacity(tiles.len()));
        for (done, tile) in (1..).zip(tiles.by_ref()) {
            all.push(work(&mut buffers, tile));
            if !is_alone && !is_short(done) {
                // Not asked before: it may start rayon's own threads.
                is_alone = rayon::current_num_threads() == 1;
                if !is_alone {
                    break;
                }
            }
        }
        if tiles.len() > 0 {
            // One by one: a thread that has had the easy ones takes more.
            all.par_extend(tiles.par_bridge().map_init(B::default, work));
        }
        all
    }
}

/// What takes no longer, going by the tiles so far, is traced by the calling thread alone: to wake another one takes 16 us,
/// and 80 after a pause.
const SHORT: Duration = Duration::from_micros(300);

/// A picture in work, which gets more samples where it has edges, as long as that is wanted. Whatever the steps in which
/// it is made, its light is the same to the bit as if it had been made in one.
#[derive(Clone, Debug)]
pub struct Refining {
    tiles: Tiles,
    /// What the first sample of each pixel saw, tile by tile.
    first: Vec<Vec<First>>,
    /// All samples of each pixel, once there are more.
    watched: Vec<Vec<Watched>>,
    /// How many of the passes are done.
    passes: usize,
}

impl Refining {
    /// Nothing of it is traced yet.
    pub fn new(camera: &Camera, resolution: Resolution) -> Self {
        let tiles = Tiles::new(camera, resolution, 1);
        Self { tiles, first: vec![Vec::new(); tiles.count()], watched: vec![Vec::new(); tiles.count()], passes: 0 }
    }

    /// Traces what is lacking to [`Sampling::UpTo`] so many samples of that scene, which has to be the same each time.
    /// Returns what that took.
    ///
    /// # Errors
    /// [`Cancelled`], if the token is; then the picture cannot be refined any further.
    pub fn refine_or_cancel(
        &mut self,
        token: &Cancellation,
        scene: &Scene,
        samples: NonZeroU32,
    ) -> Result<Cost, Cancelled> {
        let crew = Crew::Cancellable(token);
        crew.finish(self.refine(crew, scene, samples))
    }

    fn refine(&mut self, crew: Crew<'_>, scene: &Scene, samples: NonZeroU32) -> Cost {
        let wanted = PASSES.iter().filter(|pass| pass.end <= samples.get()).count();
        let mut cost = Cost::default();
        // Where edges are is seen in the whole picture of the first pass. Then each pixel by itself tells whether it needs
        // more, and nobody waits for another tile.
        if self.passes == 0 && wanted > 0 {
            cost += self.trace_first(crew, scene);
            self.passes = 1;
        }
        if self.passes < wanted {
            cost += self.trace_more(crew, scene, self.passes..wanted);
            self.passes = wanted;
        }
        cost
    }

    fn trace_first(&mut self, crew: Crew<'_>, scene: &Scene) -> Cost {
        let (tiles, runs) = (self.tiles, Runs::of(PASSES[0].clone()));
        crew.trace(self.first.iter_mut().collect(), |buffers, (tile, first)| {
            tiles.inside(tile, &mut buffers.wanted);
            first.resize(PIXELS, First::default());
            buffers.trace_tile(crew, scene, &tiles, tile, &runs, |buffers, _, _| buffers.see_first(first))
        })
    }

    /// The next passes.
    fn trace_more(&mut self, crew: Crew<'_>, scene: &Scene, passes: Range<usize>) -> Cost {
        let white = 1.0 / scene.exposure();
        let runs: Vec<_> = passes.map(|pass| (pass, Runs::of(PASSES[pass].clone()))).collect();
        let Self { tiles, first, watched, .. } = self;
        let (tiles, first) = (&*tiles, &*first);
        crew.trace(watched.iter_mut().collect(), |buffers, (tile, watched)| {
            if watched.is_empty() {
                watched.extend(first[tile].iter().map(Watched::new));
            }
            tiles.inside(tile, &mut buffers.wanted);
            let mut cost = Cost::default();
            for &(pass, ref runs) in &runs {
                buffers.wanted.retain(|&pixel| match (pass, &watched[usize::from(pixel)]) {
                    (1, _) => is_at_edge(tiles, first, tile, pixel.into(), white),
                    (2, watched) => watched.is_at_edge(),
                    (_, watched) => watched.is_rough(white),
                });
                let add = |buffers: &Buffers, run: &Run, _| buffers.add_to(watched, run.each());
                cost += buffers.trace_tile(crew, scene, tiles, tile, runs, add);
            }
            cost
        })
    }

    /// Whether no more samples will be taken anywhere.
    pub fn is_final(&self) -> bool {
        self.passes == PASSES.len()
    }

    /// The mean light of each pixel's samples.
    pub fn framebuffer(&self) -> Framebuffer {
        let mut framebuffer = Framebuffer::new(self.tiles.resolution);
        let parts = self.tiles.split(&mut framebuffer.pixels);
        for ((first, watched), mut part) in self.first.iter().zip(&self.watched).zip(parts) {
            if !watched.is_empty() {
                self.tiles.show(&ALL_PIXELS, |pixel| watched[pixel].mean(), &mut part);
            } else if !first.is_empty() {
                self.tiles.show(&ALL_PIXELS, |pixel| first[pixel].light, &mut part);
            }
        }
        framebuffer
    }
}

/// Whether an edge may run beside that pixel of a tile; `white` is the light that is shown as white.
fn is_at_edge(tiles: &Tiles, first: &[Vec<First>], tile: usize, pixel: usize, white: f32) -> bool {
    let own = &first[tile][pixel];
    let [columns, rows] = tiles.around(tile, pixel);
    for y in rows {
        for x in columns.clone() {
            let (tile, pixel) = tiles.at([x, y]);
            if own.is_edge_to(&first[tile][pixel], white) {
                return true;
            }
        }
    }
    false
}

/// The arrays between the steps, kept from tile to tile.
#[derive(Default)]
struct Buffers {
    wanted: Vec<u8>,
    /// Of each ray of the lot, its own.
    pixels: Vec<u8>,
    rays: Vec<EightRays>,
    hits: Vec<EightHits>,
    points: Vec<EightPoints>,
    shadows: ShadowRays,
    arriving: Vec<EightArriving>,
    lights: Vec<EightLights>,
}

impl Buffers {
    /// Traces samples of the wanted pixels, and hands them to `take` lot by lot, until the crew is cancelled.
    fn trace_tile(
        &mut self,
        crew: Crew<'_>,
        scene: &Scene,
        tiles: &Tiles,
        tile: usize,
        runs: &Runs,
        mut take: impl FnMut(&Self, &Run, Range<usize>),
    ) -> Cost {
        let start = Instant::now();
        let mut traced = 0;
        'runs: for run in runs.iter() {
            for lot in run.lots(self.wanted.len()) {
                if crew.is_cancelled() {
                    break 'runs;
                }
                traced += self.trace_lot(scene, tiles, tile, &run, lot.clone());
                take(self, &run, lot);
            }
        }
        Cost { rays: traced, work: start.elapsed() }
    }

    /// Puts down what the lot's rays, one through each pixel, saw.
    fn see_first(&self, first: &mut [First]) {
        for (ray, &pixel) in self.pixels.iter().enumerate() {
            let (group, lane) = (ray / LANES, ray % LANES);
            // As a sum of one, which is never -0.
            let light = LinearRgb::BLACK + shade::light_of(&self.lights[group], lane);
            let lit_by = self.arriving[group].lit_by[lane];
            first[usize::from(pixel)] = First::new(light, self.points[group].seen(lane), lit_by);
        }
    }

    /// Adds the lot's samples, so many each, to those of the tile's pixels that they are of.
    fn add_to(&self, watched: &mut [Watched], each: usize) {
        let lights = in_rows(&self.lights);
        for (first, &pixel) in self.pixels.iter().enumerate().step_by(each) {
            watched[usize::from(pixel)].add(lights.each_ref().map(|band| &band[first..first + each]));
        }
    }

    /// All steps for a lot. Returns the number of rays that this took.
    fn trace_lot(&mut self, scene: &Scene, tiles: &Tiles, tile: usize, run: &Run, lot: Range<usize>) -> u64 {
        let Self { wanted, pixels, rays, hits, points, shadows, arriving, lights } = self;
        run.spread(&wanted[lot], pixels);
        tiles.make_eye_rays(tile, pixels, run, rays);
        hit::closest_hits(Kernel::Auto, scene, rays, hits);
        shade::surface_points(scene, rays, hits, points);
        let shadow_rays = shade::arriving_light(scene, points, shadows, arriving);
        shade::reflect(scene, rays, tiles.steps(run.samples.start), hits, points, arriving, lights);
        pixels.len() as u64 + shadow_rays
    }
}
