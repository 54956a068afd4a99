//! The shaded picture: tone-mapped light.

use super::TracedMap;
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::{Executor, Sampling, render_partial, render_with_geometry};
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
    TracedMap::new(tone(&rendered.framebuffer, scene), rendered.cost)
}

/// Renders the light as [`trace`] does, and adds the picture's geometry: its pixels' surfaces.
pub(super) fn trace_with_geometry(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> TracedMap {
    let (rendered, geometry) = render_with_geometry(executor, scene, camera, resolution, sampling);
    TracedMap::new(tone(&rendered.framebuffer, scene), rendered.cost).with_geometry(geometry)
}
