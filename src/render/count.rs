//! The trace stage alone, for those who time it: eye rays -> closest hits -> a shadow ray from each.

use super::sampling::Runs;
use super::steps::{Buffers, Goal, Shot};
use super::tiles::Tiles;
use super::{Crew, Sampling};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::{self, Kernel};
use crate::lanes::{Eight, Lanes, Number};
use crate::scene::Scene;
use crate::shade::{self, ShadowRays};
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

/// Traces the eye rays of [`render`](super::render) by that kernel with that number of samples of each pixel ([`Sampling::MAX_SAMPLES`] at
/// most), and, if the scene has
/// shadows, one ray from each hit to each light, also where the surface faces away from it; on the threads of the current
/// rayon pool.
pub fn count(kernel: Kernel, scene: &Scene, camera: &Camera, resolution: Resolution, samples: NonZeroU32) -> Counts {
    let tiles = Tiles::new(camera, resolution, 1);
    let goal = if scene.shadows() { Goal::Points } else { Goal::Hits };
    let shot = Shot { kernel, ..Shot::new(scene, &tiles, goal) };
    let runs = Runs::of(0..samples.min(Sampling::MAX_SAMPLES).get());
    let mut counts = vec![Counts::default(); tiles.count()];
    Crew::Pool.trace(&shot, counts.iter_mut().collect(), |tile, counts| {
        tile.trace(&runs, |buffers, _, _| *counts = *counts + count_batch(kernel, scene, buffers));
    });
    // Tile by tile: a sum of floats depends on the order.
    counts.into_iter().fold(Counts::default(), Add::add)
}

/// Counts a batch's rays and their hits, and the shadow rays that begin there, which it traces.
fn count_batch(kernel: Kernel, scene: &Scene, buffers: &mut Buffers) -> Counts {
    let Buffers { rays, hits, points, shadows: ShadowRays { rays: shadow_rays, blocked, .. }, .. } = buffers;
    let mut counts = Counts { rays: shade::count(rays), ..Counts::default() };
    for hits in hits.iter() {
        counts.hits += u64::from(hits.met.count_ones());
        // Nothing for those without a hit: a sum without branches.
        let depths = Eight::select(Eight::answers(hits.met), hits.t, Eight::ZERO);
        counts.depths += depths.0.into_iter().map(f64::from).sum::<f64>();
    }
    for light in scene.lights().iter().filter(|_| scene.shadows()) {
        shade::shadow_rays(light, points, shadow_rays);
        hit::any_hits(kernel, scene, shadow_rays, light.in_the_way(), blocked);
        let (traced, blocked) = (shade::count(shadow_rays), blocked.iter().map(|met| u64::from(met.count_ones())));
        counts.rays += traced;
        counts.lit += traced - blocked.sum::<u64>();
    }
    counts
}
