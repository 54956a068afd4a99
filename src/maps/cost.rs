//! The tests of a pixel's rays, each traced singly: the eye ray, and the shadow rays from its hit.

use crate::hit::{Observer, PrimitiveTest, any_hit_observed, closest_hit_observed};
use crate::render::GBufferSample;
use crate::scene::Scene;
use crate::shade;

/// The number of tests: of surfaces, and of nodes of the tree, whose boxes are tested together.
#[derive(Default)]
struct Count(u32);

impl Observer for Count {
    fn node_tested(&mut self) {
        self.0 = self.0.saturating_add(1);
    }

    fn primitive_tested(&mut self, _: PrimitiveTest) {
        self.0 = self.0.saturating_add(1);
    }
}

pub(super) fn tests(scene: &Scene, sample: &GBufferSample) -> u32 {
    let mut count = Count::default();
    closest_hit_observed(scene, &sample.ray, &mut count);
    if let Some(surface) = sample.surface(scene).filter(|_| scene.shadows()) {
        for light in scene.lights().iter().filter(|light| shade::incidence(light, &surface).is_some()) {
            any_hit_observed(scene, &shade::shadow_ray(light, &surface), light.in_the_way(), &mut count);
        }
    }
    count.0
}
