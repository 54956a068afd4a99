//! The trace stage alone, for those who time it: eye rays -> closest hits -> a shadow ray from each.

use super::Crew;
use super::sampling::Runs;
use super::tiles::Tiles;
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::{Eight, Lanes, Number};
use crate::ray::EightRays;
use crate::scene::Scene;
use crate::shade::{self, EightPoints, TO_THE_LIGHT};
use std::num::NonZeroU32;
use std::ops::Add;

/// What a picture's rays met.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// How many rays were traced: eye rays and shadow rays.
    pub rays: u64,
    /// How many eye rays met an object.
    pub hits: u64,
    /// How many of the points that they met nothing keeps from a light, counted for each light. Light that comes from
    /// behind the surface counts: nothing but the tracing is looked at here.
    pub lit: u64,
    /// The sum of the depths of all hits: t, as an eye ray's direction has the length 1 along the view.
    pub depths: f64,
}

impl Add for Counts {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            hits: self.hits + other.hits,
            lit: self.lit + other.lit,
            depths: self.depths + other.depths,
        }
    }
}

/// Traces the eye rays of [`render`](super::render) in that way with so many samples of each pixel, and, if the scene has
/// shadows, one ray from each hit to each light, also where the surface faces away from it; on the threads of the current
/// rayon pool.
pub fn count(kernel: Kernel, scene: &Scene, camera: &Camera, resolution: Resolution, samples: NonZeroU32) -> Counts {
    let tiles = Tiles::new(camera, resolution, 1);
    let runs = Runs::of(0..samples.get());
    let count = |buffers: &mut Buffers, (tile, ())| (tile, buffers.count_tile(kernel, scene, &tiles, tile, &runs));
    let mut counts = Crew::Pool.share(vec![(); tiles.count()], count);
    // In the tiles' order: a sum of floats depends on it.
    counts.sort_unstable_by_key(|&(tile, _)| tile);
    counts.into_iter().fold(Counts::default(), |sum, (_, counts)| sum + counts)
}

#[derive(Default)]
struct Buffers {
    wanted: Vec<u8>,
    pixels: Vec<u8>,
    rays: Vec<EightRays>,
    hits: Vec<EightHits>,
    points: Vec<EightPoints>,
    shadow_rays: Vec<EightRays>,
    blocked: Vec<u32>,
}

impl Buffers {
    fn count_tile(&mut self, kernel: Kernel, scene: &Scene, tiles: &Tiles, tile: usize, runs: &Runs) -> Counts {
        tiles.inside(tile, &mut self.wanted);
        let mut counts = Counts::default();
        for run in runs.iter() {
            for lot in run.lots(self.wanted.len()) {
                run.spread(&self.wanted[lot], &mut self.pixels);
                tiles.make_eye_rays(tile, &self.pixels, &run, &mut self.rays);
                hit::closest_hits(kernel, scene, &self.rays, &mut self.hits);
                counts = counts + self.count(kernel, scene);
            }
        }
        counts
    }

    /// The rays and their hits, and the shadow rays that begin there.
    fn count(&mut self, kernel: Kernel, scene: &Scene) -> Counts {
        let Self { rays, hits, points, shadow_rays, blocked, .. } = self;
        let mut counts = Counts { rays: shade::count(rays), ..Counts::default() };
        for hits in hits.iter() {
            counts.hits += u64::from(hits.met.count_ones());
            // Nothing for those without a hit: a sum without branches.
            let depths = Eight::select(Eight::answers(hits.met), hits.t, Eight::ZERO);
            counts.depths += depths.0.into_iter().map(f64::from).sum::<f64>();
        }
        if scene.shadows() {
            shade::surface_points(scene, rays, hits, points);
        }
        for light in scene.lights().iter().filter(|_| scene.shadows()) {
            shade::shadow_rays(light, points, shadow_rays);
            hit::any_hits(kernel, scene, shadow_rays, TO_THE_LIGHT, blocked);
            let (traced, blocked) = (shade::count(shadow_rays), blocked.iter().map(|met| u64::from(met.count_ones())));
            counts.rays += traced;
            counts.lit += traced - blocked.sum::<u64>();
        }
        counts
    }
}
