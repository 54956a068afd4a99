//! The shaded picture: tone-mapped light.

use super::Seen;
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::{Crew, Sampling, render_all};
use crate::scene::Scene;
use crate::tone::tone;

pub(super) fn seen(crew: Crew<'_>, scene: &Scene, camera: &Camera, resolution: Resolution, sampling: Sampling) -> Seen {
    let rendered = render_all(crew, scene, camera, resolution, sampling);
    Seen { picture: tone(&rendered.framebuffer, scene), cost: rendered.cost }
}
