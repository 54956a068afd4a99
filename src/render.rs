//! Rendering of a scene to a framebuffer, tile by tile: eye rays, hits, shadow rays, shading.
//!
//! Each step is a function over arrays of up to 256 rays of a tile, so that tracing packets, looking for edges in a
//! tile, or explaining one ray is a choice inside a step.
//!
//! A frame is a pure function of scene, camera, resolution and [`Sampling`]. Tiles run on the threads of the current
//! rayon pool; as no pixel's light depends on another's, neither their number nor their order matters. Which pixels get
//! more samples does depend on other pixels, and is decided after a first pass over the whole picture.

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
mod count;
mod single_pixel;
mod builder;

pub use adaptive::ProgressiveRender;
pub use builder::Render;
pub use count::{Counts, count};
pub(crate) use gbuffer::trace_g_buffer_partial;
pub use gbuffer::{GBufferSample, PixelValues, TraceDepth, trace_g_buffer};
pub use sampling::Sampling;
pub use schedule::Executor;
pub use single_pixel::{PixelTrace, trace_pixel};

/// Returns the picture of `scene` seen by `camera`. The first ray of a pixel goes through its centre.
pub fn render(scene: &Scene, camera: &Camera, resolution: Resolution, sampling: impl Into<Sampling>) -> Framebuffer {
    render_partial(Executor::Pool, scene, camera, resolution, sampling.into()).framebuffer
}

/// A frame and its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The picture.
    pub framebuffer: Framebuffer,
    /// The cost of tracing it, which has no influence on the picture.
    pub cost: Cost,
}

/// The cost of tracing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// The number of rays traced: eye rays and shadow rays.
    pub rays: u64,
    /// The time spent, all threads together.
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
    executor.finish(render_partial(executor, scene, camera, resolution, sampling.into()))
}

/// Returns the total in which a [`Report`](report::Report) counts such a render: the sum of [`ProgressUnit`](steps::ProgressUnit) over
/// all of its tiles.
fn units(resolution: Resolution, sampling: Sampling) -> u64 {
    let pixels = resolution.pixel_count() as u64;
    match sampling.bounded() {
        Sampling::Coarse => u64::from(resolution.width().div_ceil(2)) * u64::from(resolution.height().div_ceil(2)),
        Sampling::Each(samples) => pixels * u64::from(samples.get()),
        Sampling::UpTo(samples) => pixels + adaptive::refinement_units(resolution, samples),
    }
}

/// Renders as [`render`] does on the threads of `executor`; after a cancel the rest is skipped.
pub(crate) fn render_partial(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Rendered {
    match sampling.bounded() {
        Sampling::Coarse => uniform::render(executor, scene, &Tiles::new(camera, resolution, 2), 1),
        Sampling::Each(samples) => uniform::render(executor, scene, &Tiles::new(camera, resolution, 1), samples.get()),
        Sampling::UpTo(samples) => {
            let mut picture = ProgressiveRender::new(camera, resolution);
            let cost = picture.refine(executor, scene, samples);
            // The picture of a cancelled render is dropped: filling millions of pixels would exceed the limit for the
            // answer to a cancel.
            let is_lost = executor.is_cancelled();
            let framebuffer = if is_lost { Framebuffer::new(Resolution::square(0, 0)) } else { picture.framebuffer() };
            Rendered { framebuffer, cost }
        }
    }
}
