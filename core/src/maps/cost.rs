//! The cost map: the intersection tests of a pixel's rays, each traced singly.
//!
//! One shadow ray to the middle of each light is counted, however many parts the light has. Rays are traced singly
//! because packets, with which the shaded picture is traced, share tests between pixels.

use crate::hit::{TestCount, any_hit_observed, closest_hit_observed};
use crate::render::GBufferSample;
use crate::scene::Scene;
use crate::shade;

/// Returns the number of tests of a pixel's eye ray and shadow rays.
pub(super) fn eye_and_shadow_tests(scene: &Scene, sample: &GBufferSample) -> u32 {
    let mut count = TestCount::default();
    closest_hit_observed(scene, &sample.ray, &mut count);
    if let Some(surface) = sample.surface(scene).filter(|_| scene.shadows()) {
        for light in scene.lights().iter().filter(|light| shade::incidence(light, &surface).is_some()) {
            any_hit_observed(scene, &shade::shadow_ray(light, &surface), light.blocking_interval(), &mut count);
        }
    }
    count.0.try_into().unwrap_or(u32::MAX)
}
