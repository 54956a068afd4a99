//! Tracing without shading, for benchmarks: eye rays, closest hits, and shadow rays from the hits.

use super::sampling::SampleBatches;
use super::steps::{Buffers, RenderJob, Stage};
use super::tiles::Tiles;
use super::{Executor, Sampling};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::{self, Kernel};
use crate::lanes::{F32x8, Lanes, Number};
use crate::scene::Scene;
use crate::shade::{self, ShadowRays};
use std::num::NonZeroU32;
use std::ops::Add;

/// The counts of a picture's rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// The number of rays traced: eye rays and shadow rays.
    pub rays: u64,
    /// The number of eye rays with a hit.
    pub hits: u64,
    /// The number of pairs of a hit and a light without an object between them.
    ///
    /// Lights behind the surface count as well.
    // Lights behind the surface are not excluded by its normal, because only tracing is measured, and is compared with
    // ray tracers that do not exclude them either.
    pub lit: u64,
    /// The sum of the depths (the t) of all hits, in world units along the view direction.
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

/// Traces the eye rays of [`render`](super::render) with `kernel`, and returns their counts.
///
/// Takes at most [`Sampling::MAX_SAMPLES`] samples per pixel. If the scene has shadows, also traces a ray from each hit
/// to each light, even if the surface faces away from it. Runs on the threads of the current rayon pool.
pub fn count_rays_and_hits(
    kernel: Kernel,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    samples: NonZeroU32,
) -> Counts {
    let tiles = Tiles::new(camera, resolution, 1);
    let last_stage = if scene.shadows() { Stage::Points } else { Stage::Hits };
    let job = RenderJob { kernel, ..RenderJob::new(scene, &tiles, last_stage) };
    let batches = SampleBatches::of(0..samples.min(Sampling::MAX_SAMPLES).get());
    let mut counts = vec![Counts::default(); tiles.count()];
    Executor::Pool.trace(&job, counts.iter_mut().collect(), |tile, counts| {
        tile.trace(&batches, |buffers, _, _| *counts = *counts + count_batch_and_shadows(kernel, scene, buffers));
    });
    // The sum is taken in the order of the tiles and not in the order in which they finish, because a sum of floats
    // depends on the order.
    counts.into_iter().fold(Counts::default(), Add::add)
}

/// Counts a batch's rays and hits, and traces and counts its shadow rays.
fn count_batch_and_shadows(kernel: Kernel, scene: &Scene, buffers: &mut Buffers) -> Counts {
    let Buffers { rays, hits, points, shadows: ShadowRays { rays: shadow_rays, blocked, .. }, .. } = buffers;
    let mut counts = Counts { rays: shade::count(rays), ..Counts::default() };
    for hits in hits.iter() {
        counts.hits += u64::from(hits.hit_mask.count_ones());
        // Replaces t by zero for rays without a hit, so that the sum needs no branches.
        let depths = F32x8::select(F32x8::mask_from_bits(hits.hit_mask), hits.t, F32x8::ZERO);
        counts.depths += depths.0.into_iter().map(f64::from).sum::<f64>();
    }
    for light in scene.lights().iter().filter(|_| scene.shadows()) {
        shade::shadow_rays(light, points, shadow_rays);
        hit::any_hits(kernel, scene, shadow_rays, light.blocking_interval(), blocked);
        let (traced, blocked) = (shade::count(shadow_rays), blocked.iter().map(|met| u64::from(met.count_ones())));
        counts.rays += traced;
        counts.lit += traced - blocked.sum::<u64>();
    }
    counts
}
