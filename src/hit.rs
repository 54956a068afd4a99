//! What a ray meets: the closest hit for eye rays, any hit for shadow rays.
//!
//! Both are asked for many rays at a time, so that the way in which they are traced together is this stage's choice.

use crate::ray::{Interval, Probe, Ray};
use crate::scene::{PartId, Scene};
use crate::shape::{Part, Surface};
use std::ops::ControlFlow;

/// The closest crossing in front of a ray's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where on the ray.
    pub t: f32,
    /// Which of the scene's objects, by its place in [`Scene::objects`].
    pub object: u32,
    /// Which of its shape's [parts](crate::shape::Shape::part).
    pub part: u32,
}

impl Hit {
    /// What was hit.
    pub fn surface(self, scene: &Scene) -> Part<'_> {
        surface(scene, PartId { object: self.object, part: self.part })
    }
}

/// The closest hit of each ray, on its half line; of two at the same t, what comes first in the scene.
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
    let probe = Probe::new(*ray);
    let parts = scene.parts();
    let mut closest: Option<(f32, PartId)> = None;
    let mut test = |id: PartId, within: Interval| {
        if let Some(t) = surface(scene, id).closest_crossing(&probe, within)
            && closest.is_none_or(|closest| (t, id) < closest)
        {
            closest = Some((t, id));
        }
        Interval { max: closest.map_or(within.max, |(t, _)| t), ..within }
    };
    let within = parts.unbounded.iter().fold(Interval::IN_FRONT, |within, &id| test(id, within));
    let _ = parts.bvh.visit(&probe, within, |leaf, within| {
        ControlFlow::Continue(parts.bounded[leaf].iter().fold(within, |within, &id| test(id, within)).max)
    });
    closest.map(|(t, PartId { object, part })| Hit { t, object, part })
}

/// Whether one ray meets anything inside the interval.
pub fn any_hit(scene: &Scene, ray: &Ray, within: Interval) -> bool {
    let probe = Probe::new(*ray);
    let parts = scene.parts();
    let is_met = |&id: &PartId| surface(scene, id).closest_crossing(&probe, within).is_some();
    parts.unbounded.iter().any(is_met)
        || parts
            .bvh
            .visit(&probe, within, |leaf, within| {
                if parts.bounded[leaf].iter().any(is_met) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(within.max)
                }
            })
            .is_break()
}

fn surface(scene: &Scene, PartId { object, part }: PartId) -> Part<'_> {
    scene.objects()[object as usize].shape.part(part)
}
