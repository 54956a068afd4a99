//! Scene -> framebuffer, tile by tile: eye rays -> hits -> shadow rays -> shade.
//!
//! What crosses a tile goes together: each step is a function over arrays of its rays, 256 at most, so that tracing them
//! as packets, looking at a tile's edges or explaining one ray is a choice inside a step.
//!
//! A frame is a pure function of scene, camera, resolution and [`Sampling`]. Tiles run on the threads of the current
//! rayon pool; as no pixel's light depends on another's, neither their number nor their order shows. Which pixels get
//! more samples does depend on others: that is decided after a first pass over the whole picture.

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
mod pixel;
mod adaptive;
mod sights;
mod count;
mod one;
mod order;

pub use adaptive::Refining;
pub use count::{Counts, count};
pub use one::{Steps, trace_pixel};
pub use order::Render;
pub use sampling::Sampling;
pub use schedule::Crew;
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

/// Returns the units in which a [`Report`](report::Report) counts such a render: those of [`Unit`](steps::Unit) for all of
/// its tiles.
fn units(resolution: Resolution, sampling: Sampling) -> u64 {
    let pixels = resolution.pixel_count() as u64;
    match sampling.bounded() {
        Sampling::Coarse => u64::from(resolution.width().div_ceil(2)) * u64::from(resolution.height().div_ceil(2)),
        Sampling::Each(samples) => pixels * u64::from(samples.get()),
        Sampling::UpTo(samples) => pixels + adaptive::units_of_more(resolution, samples),
    }
}

/// [`render`] by that crew; one that is cancelled passes over what is left.
pub(crate) fn render_all(
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Rendered {
    match sampling.bounded() {
        Sampling::Coarse => uniform::render(crew, scene, &Tiles::new(camera, resolution, 2), 1),
        Sampling::Each(samples) => uniform::render(crew, scene, &Tiles::new(camera, resolution, 1), samples.get()),
        Sampling::UpTo(samples) => {
            let mut picture = Refining::new(camera, resolution);
            let cost = picture.refine(crew, scene, samples);
            // A cancelled picture is thrown away: to fill millions of pixels takes longer than the answer to a cancel may.
            let is_lost = crew.is_cancelled();
            let framebuffer = if is_lost { Framebuffer::new(Resolution::square(0, 0)) } else { picture.framebuffer() };
            Rendered { framebuffer, cost }
        }
    }
}
