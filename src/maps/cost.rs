//! The tests of a pixel's rays, each traced singly: the eye ray, and the shadow rays from its hit.

use crate::hit::{Test, Witness, any_hit_witnessed, closest_hit_witnessed};
use crate::render::GBufferSample;
use crate::scene::Scene;
use crate::shade;

/// The number of tests: of surfaces, and of nodes of the tree, whose boxes are tested together.
#[derive(Default)]
struct Count(u32);

impl Witness for Count {
    fn boxes(&mut self) {
        self.0 = self.0.saturating_add(1);
    }

    fn part(&mut self, _: Test) {
        self.0 = self.0.saturating_add(1);
    }
}

pub(super) fn tests(scene: &Scene, sample: &GBufferSample) -> u32 {
    let mut count = Count::default();
    closest_hit_witnessed(scene, &sample.ray, &mut count);
    if let Some(surface) = sample.surface(scene).filter(|_| scene.shadows()) {
        for light in scene.lights().iter().filter(|light| shade::incidence(light, &surface).is_some()) {
            any_hit_witnessed(scene, &shade::shadow_ray(light, &surface), light.in_the_way(), &mut count);
        }
    }
    count.0
}
