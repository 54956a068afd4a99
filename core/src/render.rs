//! Rendering of a scene to a framebuffer, tile by tile: eye rays, hits, shadow rays, shading.
//!
//! Each step is a function over arrays of up to 256 rays of a tile. All drivers (uniform and adaptive sampling,
//! G-buffers, counts, a single pixel) share these functions and the `schedule`; they differ in the last step, and in
//! the callback that receives each batch. Rejected: a separate loop in each driver, which saved less than 0.2 % of the
//! instructions.
//!
//! A frame is a pure function of scene, camera, resolution and [`Sampling`]. Tiles run on the threads of the current
//! rayon pool. The light of a pixel does not depend on other pixels, so neither the number of threads nor the order of
//! tiles matters. Which pixels get more samples does depend on their neighbours, and is decided after a first pass over
//! the whole picture.

use crate::camera::Camera;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::progress::Cancelled;
use crate::scene::Scene;
use std::ops::AddAssign;
use std::time::Duration;
use tiles::Tiles;

mod tiles;
mod sampling;
mod steps;
mod report;
mod schedule;
mod uniform;
mod accumulator;
mod adaptive;
mod gbuffer;
mod geometry;
mod count;
mod single_pixel;
mod split;
mod builder;

pub use adaptive::ProgressiveRender;
pub use builder::Render;
pub use count::{Counts, count_rays_and_hits};
pub(crate) use gbuffer::trace_g_buffer_partial;
pub use gbuffer::{GBufferSample, PixelValues, TraceDepth, trace_g_buffer};
pub use geometry::Geometry;
pub use geometry::{Extent, Facet, are_across_crease, render_with_geometry, trace_geometry};
pub use sampling::Sampling;
pub use schedule::Executor;
pub use single_pixel::{PixelTrace, trace_pixel};

/// Returns the picture of `scene` seen by `camera`.
///
/// The first ray of a pixel goes through its centre.
///
/// ```
/// use std::num::NonZeroU32;
/// use termtrace::{Resolution, Scene, render};
///
/// let scene = Scene::from_ron("empty.ron", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))")?;
/// let light = render(&scene, scene.camera(), Resolution::new(4, 3)?, NonZeroU32::MIN);
/// assert_eq!(light.pixels().len(), 12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(hidden)]
pub fn render(scene: &Scene, camera: &Camera, resolution: Resolution, sampling: impl Into<Sampling>) -> Framebuffer {
    render_partial(Executor::Pool, scene, camera, resolution, sampling.into()).framebuffer
}

/// A frame and its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The picture.
    pub framebuffer: Framebuffer,
    /// The cost of tracing the picture.
    pub cost: Cost,
}

/// The cost of tracing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// The number of rays traced: eye rays and shadow rays.
    pub rays: u64,
    /// The time spent on tracing, summed over all threads.
    pub work: Duration,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, more: Self) {
        self.rays += more.rays;
        self.work += more.work;
    }
}

/// Renders as [`render`] does on the threads of `executor`.
///
/// # Errors
/// [`Cancelled`], if the executor's token is cancelled.
pub fn render_by(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: impl Into<Sampling>,
) -> Result<Rendered, Cancelled> {
    executor.unless_cancelled(render_partial(executor, scene, camera, resolution, sampling.into()))
}

/// Returns the total number of [progress units](steps::ProgressUnit) of a picture.
fn progress_units(resolution: Resolution, sampling: Sampling) -> u64 {
    let pixels = resolution.pixel_count() as u64;
    match sampling.capped_at_max_samples() {
        Sampling::Coarse => u64::from(resolution.width().div_ceil(2)) * u64::from(resolution.height().div_ceil(2)),
        Sampling::Split => split::units(resolution),
        Sampling::Each(samples) => pixels * u64::from(samples.get()),
        Sampling::UpTo(samples) => pixels + adaptive::refinement_units(resolution, samples),
    }
}

/// Renders on the threads of `executor`. If it is cancelled, the returned picture is incomplete.
pub(crate) fn render_partial(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Rendered {
    match sampling.capped_at_max_samples() {
        Sampling::Coarse => uniform::render(executor, scene, &Tiles::new(camera, resolution, 2), 1),
        Sampling::Split => split::render(executor, scene, camera, resolution),
        Sampling::Each(samples) => uniform::render(executor, scene, &Tiles::new(camera, resolution, 1), samples.get()),
        Sampling::UpTo(samples) => {
            let mut picture = ProgressiveRender::new(camera, resolution);
            let cost = picture.refine(executor, scene, samples);
            // The caller drops the picture of a cancelled render, so the framebuffer is not filled: with a filled one
            // of 3840x2160 pixels, a cancelled render ended after 238 to 449 ms instead of 4 to 18 ms.
            let is_lost = executor.is_cancelled();
            let framebuffer = if is_lost { Framebuffer::new(Resolution::square(0, 0)) } else { picture.framebuffer() };
            Rendered { framebuffer, cost }
        }
    }
}
