//! What a ray meets: the closest hit for eye rays, any hit for shadow rays.
//!
//! Both are asked for many rays at a time, so that the way in which they are traced together is this stage's choice.

use crate::ray::{Interval, Ray};
use crate::scene::Scene;
use crate::shape::Surface;

/// The closest crossing in front of a ray's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where on the ray.
    pub t: f32,
    /// Which of the scene's objects, by its place in [`Scene::objects`].
    pub object: u32,
}

/// The closest hit of each ray, on its half line; of two at the same t, the object that comes first in the scene.
pub fn closest_hits(scene: &Scene, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
    hits.clear();
    hits.extend(rays.iter().map(|ray| closest_hit(scene, ray)));
}

/// Whether each ray meets anything inside the interval.
pub fn any_hits(scene: &Scene, rays: &[Ray], within: Interval, found: &mut Vec<bool>) {
    found.clear();
    found.extend(rays.iter().map(|ray| any_hit(scene, ray, within)));
}

/// The closest hit of one ray.
pub fn closest_hit(scene: &Scene, ray: &Ray) -> Option<Hit> {
    let mut closest: Option<Hit> = None;
    for (object, candidate) in (0..).zip(scene.objects()) {
        let Some(t) = candidate.shape.closest_crossing(ray, Interval::IN_FRONT) else {
            continue;
        };
        if closest.is_none_or(|hit| t < hit.t) {
            closest = Some(Hit { t, object });
        }
    }
    closest
}

/// Whether one ray meets anything inside the interval.
pub fn any_hit(scene: &Scene, ray: &Ray, within: Interval) -> bool {
    scene.objects().iter().any(|object| object.shape.closest_crossing(ray, within).is_some())
}
