//! Scene -> framebuffer, tile by tile: eye rays -> hits -> shadow rays -> shade.
//!
//! What crosses a tile goes together: each step is a function over arrays of the tile's rays, so that tracing them
//! as packets, looking at a tile's edges or explaining one ray is a choice inside a step.
//!
//! A frame is a pure function of scene, camera, resolution and [`Sampling`]. Tiles run on the threads of the current
//! rayon pool; as no pixel's light depends on another's, neither their number nor their order shows. Which pixels get
//! more samples does depend on others: that is decided between two passes over the whole picture.

use crate::camera::{Camera, EyeRays};
use crate::framebuffer::{Framebuffer, Resolution};
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::{ALL, Eight, LANES, Lanes, Vector};
use crate::ray::EightRays;
use crate::scene::Scene;
use crate::shade::{self, EightArriving, EightLights, EightPoints, ShadowRays};
use crate::simd::{self, Work};
use glam::Vec3;
use pixel::{Pixel, Seen, Sum, Watched};
use rayon::prelude::*;
use sampling::{PASSES, footprint_share, sample_position};
use std::num::NonZeroU32;
use std::ops::{AddAssign, Range};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

mod count;
mod pixel;
mod sampling;

pub use count::{Counts, count};
pub use sampling::Sampling;

/// The picture of `scene` that `camera` sees. The first ray of a pixel goes through its centre.
pub fn render(scene: &Scene, camera: &Camera, resolution: Resolution, sampling: impl Into<Sampling>) -> Framebuffer {
    let never = AtomicBool::new(false);
    finished(rendered(Crew::Pool(&never), scene, camera, resolution, sampling.into())).framebuffer
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

/// [`render`] on the calling thread alone: to wake others for a frame of less than about a millisecond takes longer than
/// they save.
pub fn render_alone(scene: &Scene, camera: &Camera, resolution: Resolution, sampling: impl Into<Sampling>) -> Rendered {
    finished(rendered(Crew::Alone, scene, camera, resolution, sampling.into()))
}

/// [`render`], given up as soon as `cancelled` is true.
pub fn render_unless(
    cancelled: &AtomicBool,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: impl Into<Sampling>,
) -> Option<Rendered> {
    rendered(Crew::Pool(cancelled), scene, camera, resolution, sampling.into())
}

/// Who traces.
#[derive(Clone, Copy)]
enum Crew<'a> {
    /// The calling thread alone.
    Alone,
    /// The threads of the current rayon pool, until this becomes true.
    Pool(&'a AtomicBool),
}

impl Crew<'_> {
    fn is_cancelled(self) -> bool {
        matches!(self, Self::Pool(cancelled) if cancelled.load(Ordering::Relaxed))
    }
}

/// What a crew has done that nobody else can cancel.
fn finished<T>(done: Option<T>) -> T {
    done.unwrap_or_else(|| unreachable!("nobody else can set the flag"))
}

fn rendered(
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Option<Rendered> {
    match sampling {
        Sampling::Coarse => Raster::<Sum>::new(camera, resolution, 2).rendered(crew, scene, 1),
        Sampling::Each(samples) => Raster::<Sum>::new(camera, resolution, 1).rendered(crew, scene, samples.get()),
        Sampling::UpTo(samples) => {
            let mut picture = Refining::new(camera, resolution);
            let cost = picture.refine(crew, scene, samples)?;
            Some(Rendered { framebuffer: picture.framebuffer(), cost })
        }
    }
}

/// A picture in work, which gets more samples where it has edges, as long as that is wanted. Whatever the steps in which
/// it is made, its light is the same to the bit as if it had been made in one.
#[derive(Clone, Debug)]
pub struct Refining {
    raster: Raster<Watched>,
    /// How many of the passes are done.
    passes: usize,
}

impl Refining {
    /// Nothing of it is traced yet.
    pub fn new(camera: &Camera, resolution: Resolution) -> Self {
        Self { raster: Raster::new(camera, resolution, 1), passes: 0 }
    }

    /// Traces what is lacking to [`Sampling::UpTo`] so many samples of that scene, which has to be the same each time.
    /// Returns what that took. `None`: given up, because `cancelled` was true; then it cannot be gone on with.
    pub fn refine_unless(&mut self, cancelled: &AtomicBool, scene: &Scene, samples: NonZeroU32) -> Option<Cost> {
        self.refine(Crew::Pool(cancelled), scene, samples)
    }

    fn refine(&mut self, crew: Crew<'_>, scene: &Scene, samples: NonZeroU32) -> Option<Cost> {
        let mut cost = Cost::default();
        while let Some(pass) = PASSES.get(self.passes).filter(|pass| pass.end <= samples.get()) {
            let needs_more = self.raster.unsettled(crew, scene, self.passes);
            let columns = self.raster.columns;
            cost += self.raster.trace(crew, scene, pass.clone(), |x, y| needs_more[(y * columns + x) as usize])?;
            self.passes += 1;
        }
        Some(cost)
    }

    /// Whether no more samples will be taken anywhere.
    pub fn is_final(&self) -> bool {
        self.passes == PASSES.len()
    }

    /// The mean light of each pixel's samples.
    pub fn framebuffer(&self) -> Framebuffer {
        self.raster.framebuffer()
    }
}

/// A tile's side in pixels.
const TILE: u32 = 16;

/// A rectangle of pixels.
struct Tile {
    columns: Range<u32>,
    rows: Range<u32>,
}

/// The pixels of a picture, or of one of larger ones.
#[derive(Clone, Debug)]
struct Raster<P> {
    /// Of the picture.
    resolution: Resolution,
    /// How many pixels of the picture each of these covers in either direction.
    scale: u32,
    columns: u32,
    rows: u32,
    eye_rays: EyeRays,
    pixels: Vec<P>,
}

/// The arrays between the steps, kept from tile to tile.
#[derive(Default)]
struct Buffers {
    rays: Vec<EightRays>,
    hits: Vec<EightHits>,
    points: Vec<EightPoints>,
    shadows: ShadowRays,
    arriving: Vec<EightArriving>,
    lights: Vec<EightLights>,
}

impl<P: Pixel> Raster<P> {
    fn new(camera: &Camera, resolution: Resolution, scale: u32) -> Self {
        let (columns, rows) = (resolution.width.div_ceil(scale), resolution.height.div_ceil(scale));
        let eye_rays = camera.eye_rays(resolution.aspect_ratio());
        let pixels = vec![P::default(); columns as usize * rows as usize];
        Self { resolution, scale, columns, rows, eye_rays, pixels }
    }

    /// The picture with so many samples of each pixel.
    fn rendered(mut self, crew: Crew<'_>, scene: &Scene, samples: u32) -> Option<Rendered> {
        let cost = self.trace(crew, scene, 0..samples, |_, _| true)?;
        Some(Rendered { framebuffer: self.framebuffer(), cost })
    }

    /// Adds these samples to the pixels that are wanted, tile by tile.
    fn trace(
        &mut self,
        crew: Crew<'_>,
        scene: &Scene,
        samples: Range<u32>,
        is_wanted: impl Fn(u32, u32) -> bool + Sync,
    ) -> Option<Cost> {
        let trace = |buffers: &mut Buffers, tile: &Tile| {
            let places: Vec<_> = tile.places().filter(|&(x, y)| is_wanted(x, y)).collect();
            self.trace_tile(crew, scene, samples.clone(), places, buffers)
        };
        let traced: Option<Vec<_>> = match crew {
            Crew::Alone => {
                let mut buffers = Buffers::default();
                self.tiles().iter().map(|tile| trace(&mut buffers, tile)).collect()
            }
            Crew::Pool(_) => self.tiles().par_iter().map_init(Buffers::default, trace).collect(),
        };
        let mut sum = Cost::default();
        for TracedTile { places, pixels, cost } in traced? {
            for ((x, y), pixel) in places.into_iter().zip(pixels) {
                *self.pixel_mut(x, y) = pixel;
            }
            sum += cost;
        }
        Some(sum)
    }

    /// These pixels with more samples. `None`: given up, between one sample of them and the next.
    fn trace_tile(
        &self,
        crew: Crew<'_>,
        scene: &Scene,
        samples: Range<u32>,
        places: Vec<(u32, u32)>,
        buffers: &mut Buffers,
    ) -> Option<TracedTile<P>> {
        let start = Instant::now();
        let mut pixels: Vec<P> = places.iter().map(|&(x, y)| *self.pixel(x, y)).collect();
        let mut rays = 0;
        for sample in samples {
            if crew.is_cancelled() {
                return None;
            }
            let Buffers { rays: eye_rays, hits, points, shadows, arriving, lights } = buffers;
            self.make_eye_rays(&places, sample, eye_rays);
            hit::closest_hits(Kernel::Auto, scene, eye_rays, hits);
            shade::surface_points(scene, eye_rays, hits, points);
            let shadow_rays = shade::arriving_light(scene, points, shadows, arriving);
            shade::reflect(scene, eye_rays, self.steps(sample), hits, points, arriving, lights);
            for (at, pixel) in pixels.iter_mut().enumerate() {
                let (group, lane) = (at / LANES, at % LANES);
                let seen = || Seen::of(points[group].seen(lane), arriving[group].lit_by[lane]);
                pixel.add(shade::light_of(&lights[group], lane), seen);
            }
            rays += pixels.len() as u64 + shadow_rays;
        }
        Some(TracedTile { places, pixels, cost: Cost { rays, work: start.elapsed() } })
    }

    /// One eye ray for each pixel.
    fn make_eye_rays(&self, places: &[(u32, u32)], sample: u32, rays: &mut Vec<EightRays>) {
        rays.clear();
        simd::run(MakeEyeRays { raster: self, places, sample, rays });
    }

    /// By how much the direction changes from an eye ray to those beside it.
    fn steps(&self, sample: u32) -> [Vec3; 2] {
        let share = self.scale as f32 * footprint_share(sample);
        self.eye_rays.steps(self.resolution.width, self.resolution.height).map(|step| step * share)
    }

    /// All tiles; those at the right and lower edge may be smaller.
    fn tiles(&self) -> Vec<Tile> {
        let spans = |length: u32| (0..length).step_by(TILE as usize).map(move |at| at..length.min(at + TILE));
        spans(self.rows)
            .flat_map(|rows| spans(self.columns).map(move |columns| Tile { columns, rows: rows.clone() }))
            .collect()
    }

    fn pixel(&self, x: u32, y: u32) -> &P {
        &self.pixels[(y * self.columns + x) as usize]
    }

    fn pixel_mut(&mut self, x: u32, y: u32) -> &mut P {
        &mut self.pixels[(y * self.columns + x) as usize]
    }

    fn framebuffer(&self) -> Framebuffer {
        let Resolution { width, height, .. } = self.resolution;
        let rows = (0..height).map(|y| y / self.scale);
        let pixels = rows.flat_map(|y| (0..width).map(move |x| self.pixel(x / self.scale, y).mean()));
        Framebuffer { resolution: self.resolution, pixels: pixels.collect() }
    }
}

struct MakeEyeRays<'w, P> {
    raster: &'w Raster<P>,
    places: &'w [(u32, u32)],
    sample: u32,
    rays: &'w mut Vec<EightRays>,
}

impl<P> Work for MakeEyeRays<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { raster: Raster { resolution, scale, eye_rays, .. }, places, sample, rays } = self;
        let (sx, sy) = sample_position(sample);
        let (width, height) = (N::splat(resolution.width as f32), N::splat(resolution.height as f32));
        let scale = N::splat(*scale as f32);
        for places in places.chunks(LANES) {
            let [mut xs, mut ys] = [Eight::ZERO; 2];
            for lane in 0..LANES {
                let (x, y) = places[lane.min(places.len() - 1)];
                (xs.0[lane], ys.0[lane]) = (x as f32, y as f32);
            }
            // Rows are counted from the top, the lecture's q_v from the bottom.
            let (x, y) = ((N::load(&xs) + N::splat(sx)) * scale, (N::load(&ys) + N::splat(sy)) * scale);
            let direction = eye_rays.direction(x / width, (height - y) / height).store();
            let asked = ALL >> (LANES - places.len());
            rays.push(EightRays { origin: Vector::splat(eye_rays.eye()), direction, asked });
        }
    }
}

impl Raster<Watched> {
    /// Which pixels the pass after so many is for.
    fn unsettled(&self, crew: Crew<'_>, scene: &Scene, passes: usize) -> Vec<bool> {
        let white = 1.0 / scene.exposure;
        let is_unsettled = |at: usize| {
            let (x, y) = (at as u32 % self.columns, at as u32 / self.columns);
            match passes {
                0 => true,
                1 => self.neighbours(x, y).any(|neighbour| self.pixel(x, y).is_edge_to(neighbour, white)),
                2 => self.pixel(x, y).count() > 1,
                _ => self.pixel(x, y).is_rough(white),
            }
        };
        match crew {
            Crew::Alone => (0..self.pixels.len()).map(is_unsettled).collect(),
            Crew::Pool(_) => (0..self.pixels.len()).into_par_iter().map(is_unsettled).collect(),
        }
    }

    /// The pixel and those around it.
    fn neighbours(&self, x: u32, y: u32) -> impl Iterator<Item = &Watched> {
        let around = |at: u32, end: u32| at.saturating_sub(1)..(at + 2).min(end);
        around(y, self.rows).flat_map(move |y| around(x, self.columns).map(move |x| self.pixel(x, y)))
    }
}

/// Pixels of a tile, where they are, and what they took.
struct TracedTile<P> {
    places: Vec<(u32, u32)>,
    pixels: Vec<P>,
    cost: Cost,
}

impl Tile {
    /// Its pixels, square by square of 8 by 8 and in these by groups of 4 by 2: rays that stand side by side go side by
    /// side.
    fn places(&self) -> impl Iterator<Item = (u32, u32)> {
        let corners = |span: &Range<u32>| span.clone().step_by(8);
        let squares = corners(&self.rows).flat_map(move |y| corners(&self.columns).map(move |x| (x, y)));
        let in_square = |at: u32| (at % 4 + at / 8 % 2 * 4, at / 4 % 2 + at / 16 * 2);
        let places =
            squares.flat_map(move |(x, y)| (0..64).map(in_square).map(move |(right, down)| (x + right, y + down)));
        places.filter(|(x, y)| self.columns.contains(x) && self.rows.contains(y))
    }
}
