//! The shaded picture: tone-mapped light.

use super::Seen;
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::{Executor, Sampling, render_all};
use crate::scene::Scene;
use crate::tone::tone;

pub(super) fn seen(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Seen {
    let rendered = render_all(executor, scene, camera, resolution, sampling);
    Seen { picture: tone(&rendered.framebuffer, scene), cost: rendered.cost }
}
