//! Scene -> framebuffer, tile by tile: eye rays -> hits -> shadow rays -> shade.
//!
//! What crosses a tile goes together: each step is a function over arrays of the tile's rays, so that tracing them
//! as packets, looking at a tile's edges or explaining one ray is a choice inside a step.
//!
//! A frame is a pure function of scene, camera, resolution and number of samples. Tiles run on the threads of the
//! current rayon pool; as no pixel depends on another, neither their number nor their order shows.

use crate::camera::{Camera, EyeRays};
use crate::color::LinearRgb;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::hit::{self, Hit};
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shade::{self, ShadowRays};
use crate::shape::SurfacePoint;
use rayon::prelude::*;
use std::num::NonZeroU32;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The picture of `scene` that `camera` sees, with so many rays per pixel. One ray goes through the pixel's centre.
pub fn render(scene: &Scene, camera: &Camera, resolution: Resolution, samples: NonZeroU32) -> Framebuffer {
    let never = AtomicBool::new(false);
    render_unless(&never, scene, camera, resolution, samples)
        .map_or_else(|| unreachable!("nobody else can set the flag"), |rendered| rendered.framebuffer)
}

/// A frame, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The picture.
    pub framebuffer: Framebuffer,
    /// How many rays were traced: eye rays and shadow rays.
    pub rays: u64,
    /// How long tracing took all threads together. Nothing in the picture depends on it.
    pub work: Duration,
}

/// [`render`] on the calling thread alone: to wake others for a frame of less than about a millisecond takes longer than
/// they save.
pub fn render_alone(scene: &Scene, camera: &Camera, resolution: Resolution, samples: NonZeroU32) -> Rendered {
    let frame = Frame::new(scene, camera, resolution, samples);
    let mut buffers = Buffers::default();
    let traced: Vec<_> = frame.tiles.iter().map(|tile| frame.trace(tile, &mut buffers)).collect();
    frame.rendered(&traced)
}

/// [`render`], given up as soon as `cancelled` is true.
pub fn render_unless(
    cancelled: &AtomicBool,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    samples: NonZeroU32,
) -> Option<Rendered> {
    let frame = Frame::new(scene, camera, resolution, samples);
    let traced: Option<Vec<_>> = frame
        .tiles
        .par_iter()
        .map_init(Buffers::default, |buffers, tile| {
            (!cancelled.load(Ordering::Relaxed)).then(|| frame.trace(tile, buffers))
        })
        .collect();
    traced.map(|traced| frame.rendered(&traced))
}

/// A tile's side in pixels.
const TILE: u32 = 16;

/// A rectangle of pixels.
struct Tile {
    columns: Range<u32>,
    rows: Range<u32>,
}

/// A tile's mean light per pixel, row by row, and what it took.
struct TracedTile {
    light: Vec<LinearRgb>,
    rays: u64,
    work: Duration,
}

/// All tiles of a picture; those at the right and lower edge may be smaller.
fn tiles(resolution: Resolution) -> Vec<Tile> {
    let spans = |length: u32| (0..length).step_by(TILE as usize).map(move |at| at..length.min(at + TILE));
    spans(resolution.height)
        .flat_map(|rows| spans(resolution.width).map(move |columns| Tile { columns, rows: rows.clone() }))
        .collect()
}

/// A frame's tiles, and what they have in common.
struct Frame<'a> {
    scene: &'a Scene,
    eye_rays: EyeRays,
    resolution: Resolution,
    samples: NonZeroU32,
    tiles: Vec<Tile>,
}

/// The arrays between the steps, kept from tile to tile.
#[derive(Default)]
struct Buffers {
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
    points: Vec<Option<SurfacePoint>>,
    light: Vec<LinearRgb>,
    shadows: ShadowRays,
}

impl<'a> Frame<'a> {
    fn new(scene: &'a Scene, camera: &Camera, resolution: Resolution, samples: NonZeroU32) -> Self {
        let eye_rays = camera.eye_rays(resolution.aspect_ratio());
        Self { scene, eye_rays, resolution, samples, tiles: tiles(resolution) }
    }

    /// The mean light of each pixel's samples.
    fn trace(&self, tile: &Tile, buffers: &mut Buffers) -> TracedTile {
        let start = Instant::now();
        let mut sum = vec![LinearRgb::BLACK; tile.columns.len() * tile.rows.len()];
        let mut rays = 0;
        for sample in 0..self.samples.get() {
            self.make_eye_rays(tile, sample, &mut buffers.rays);
            let Buffers { rays: eye_rays, hits, points, light, shadows } = buffers;
            hit::closest_hits(self.scene, eye_rays, hits);
            shade::surface_points(self.scene, eye_rays, hits, points);
            let shadow_rays = shade::arriving_light(self.scene, points, shadows, light);
            shade::reflect(self.scene, eye_rays, hits, points, light);
            sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += *light);
            rays += (eye_rays.len() + shadow_rays) as u64;
        }
        let share = 1.0 / self.samples.get() as f32;
        TracedTile { light: sum.into_iter().map(|light| light * share).collect(), rays, work: start.elapsed() }
    }

    /// The tiles' light, put where it belongs.
    fn rendered(&self, traced: &[TracedTile]) -> Rendered {
        let mut framebuffer = Framebuffer::new(self.resolution);
        let width = self.resolution.width as usize;
        for (tile, TracedTile { light, .. }) in self.tiles.iter().zip(traced) {
            let columns = tile.columns.start as usize..tile.columns.end as usize;
            for (y, row) in tile.rows.clone().zip(light.chunks_exact(columns.len())) {
                framebuffer.pixels[y as usize * width..][columns.clone()].copy_from_slice(row);
            }
        }
        let rays = traced.iter().map(|tile| tile.rays).sum();
        let work = traced.iter().map(|tile| tile.work).sum();
        Rendered { framebuffer, rays, work }
    }

    /// One eye ray for each pixel.
    fn make_eye_rays(&self, tile: &Tile, sample: u32, rays: &mut Vec<Ray>) {
        let (sx, sy) = sample_position(sample);
        let (width, height) = (self.resolution.width as f32, self.resolution.height as f32);
        rays.clear();
        for j in tile.rows.clone() {
            // Rows are counted from the top, the lecture's q_v from the bottom.
            let qv = (height - (j as f32 + sy)) / height;
            rays.extend(tile.columns.clone().map(|i| self.eye_rays.through((i as f32 + sx) / width, qv)));
        }
    }
}

/// Where in the pixel a sample lies, as parts of its width and height from the top left corner: the centre first, then
/// on through Roberts' R2 sequence (multiples of the inverses of the plastic number and its square, modulo 1), whose
/// every beginning covers the pixel evenly. Counted in integers, so that it is exact.
fn sample_position(sample: u32) -> (f32, f32) {
    let part = |step: u32| {
        let position = 0x8000_0000_u32.wrapping_add(sample.wrapping_mul(step));
        (position >> 8) as f32 / 16_777_216.0
    };
    (part(3_242_174_889), part(2_447_445_414))
}
