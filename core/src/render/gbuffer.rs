//! G-buffers: the hit of the eye ray through each pixel of a picture, for maps and descriptions.

use super::sampling::SampleBatches;
use super::steps::{Buffers, RenderJob, Stage};
use super::tiles::Tiles;
use super::{Cost, Executor, Sampling};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::Hit;
use crate::lanes::LANES;
use crate::progress::Cancelled;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shape::{Surface, SurfacePoint};

/// The rays that are traced for a G-buffer: eye rays only, or shadow rays too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceDepth {
    /// Closest hits only.
    Surfaces,
    /// Closest hits, and shadow rays from them to all lights.
    Lights,
}

/// The G-buffer sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GBufferSample {
    /// The eye ray.
    pub ray: Ray,
    /// The closest hit.
    pub hit: Option<Hit>,
    /// The mask of lights that reach the hit, or 0 if shadow rays were not traced.
    ///
    /// Light 32 shares its bit with light 0, and so on.
    pub lit_by: u32,
}

impl GBufferSample {
    /// Returns the surface point of the hit.
    pub fn surface(&self, scene: &Scene) -> Option<SurfacePoint> {
        self.hit.map(|hit| hit.surface(scene).at_crossing(&self.ray, hit.t))
    }
}

/// The values of all pixels, and their cost.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelValues<T> {
    /// One value per pixel, row by row from the top.
    pub pixels: Vec<T>,
    /// The cost of tracing the rays of all pixels.
    pub cost: Cost,
}

/// Traces a G-buffer and returns, for each pixel, the value that `see` makes of its sample.
///
/// The eye rays are the first ones of [`render`](super::render): one per pixel, or one for two by two pixels if the
/// sampling is [`Coarse`](Sampling::Coarse).
///
/// # Errors
/// [`Cancelled`], if the executor's token is cancelled.
pub fn trace_g_buffer<T: Copy + Default + Send>(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
    depth: TraceDepth,
    see: impl Fn(&GBufferSample) -> T + Sync,
) -> Result<PixelValues<T>, Cancelled> {
    executor.unless_cancelled(trace_g_buffer_partial(executor, scene, camera, resolution, sampling, depth, see))
}

/// Traces as [`trace_g_buffer`] does.
///
/// If `executor` is cancelled, the returned values are incomplete.
// `see` is called after each batch, while its hits are in the cache, so the G-buffer of the whole picture is never
// stored.
pub(crate) fn trace_g_buffer_partial<T: Copy + Default + Send>(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
    depth: TraceDepth,
    see: impl Fn(&GBufferSample) -> T + Sync,
) -> PixelValues<T> {
    let pixel_side = if sampling == Sampling::Coarse { 2 } else { 1 };
    let tiles = Tiles::new(camera, resolution, pixel_side);
    let last_stage = if depth == TraceDepth::Lights { Stage::Arriving } else { Stage::Hits };
    let batches = SampleBatches::of(0..1);
    let mut pixels = vec![T::default(); resolution.pixel_count()];
    let cost =
        executor.trace(&RenderJob::new(scene, &tiles, last_stage), tiles.split(&mut pixels), |tile, mut part| {
            tile.trace(&batches, |Buffers { pixels, rays, hits, arriving, .. }, _, _| {
                for (group, pixels) in pixels.chunks(LANES).enumerate() {
                    for (lane, &pixel) in pixels.iter().enumerate() {
                        let lit_by = arriving.get(group).map_or(0, |arriving| arriving.lit_by[lane]);
                        let sample =
                            GBufferSample { ray: rays[group].ray(lane), hit: hits[group].hit(scene, lane), lit_by };
                        tiles.fill_traced_pixel(pixel, see(&sample), &mut part);
                    }
                }
            });
        });
    PixelValues { pixels, cost }
}
