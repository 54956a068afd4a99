//! The shaded picture: tone-mapped light.

use super::TracedMap;
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::{Executor, Sampling, render_partial};
use crate::scene::Scene;
use crate::tone::tone;

/// Renders the light, and returns its tone-mapped picture.
pub(super) fn trace(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> TracedMap {
    let rendered = render_partial(executor, scene, camera, resolution, sampling);
    TracedMap { picture: tone(&rendered.framebuffer, scene), cost: rendered.cost }
}
