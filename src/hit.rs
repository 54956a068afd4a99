//! What a ray meets: the closest hit for eye rays, any hit for shadow rays.
//!
//! Both are asked for many rays at a time, so that the way in which they are traced together is this stage's choice.

use crate::lanes::{Eight, EightAnswers, LANES, Number};
use crate::ray::{Interval, Probe, Ray, Rays};
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
    match &scene.parts().few {
        Some(few) => rays.chunks(LANES).for_each(|rays| hits.extend(closest_of_few(scene, few, rays))),
        None => hits.extend(rays.iter().map(|ray| closest_hit(scene, ray))),
    }
}

/// Whether each ray meets anything inside the interval.
pub fn any_hits(scene: &Scene, rays: &[Ray], within: Interval, found: &mut Vec<bool>) {
    found.clear();
    match &scene.parts().few {
        Some(few) => rays.chunks(LANES).for_each(|rays| found.extend(any_of_few(scene, few, rays, within))),
        None => found.extend(rays.iter().map(|ray| any_hit(scene, ray, within))),
    }
}

/// The closest hits of eight rays or less, among few parts: all are tested, in the scene's order.
#[inline]
fn closest_of_few(scene: &Scene, few: &[PartId], rays: &[Ray]) -> impl Iterator<Item = Option<Hit>> {
    let count = rays.len();
    let rays = Rays::of(rays);
    let mut closest = Eight::splat(f32::INFINITY);
    let mut ids = [None; LANES];
    for &id in few {
        let Some((crosses, t)) = surface(scene, id).eight_crossings(&rays, Eight::splat(0.0)) else { continue };
        let is_closer = crosses & t.lt(closest);
        closest = Number::select(is_closer, t, closest);
        for (lane, closest) in ids.iter_mut().enumerate() {
            if is_closer.of(lane) {
                *closest = Some(id);
            }
        }
    }
    let hit = move |lane: usize| ids[lane].map(|PartId { object, part }| Hit { t: closest.0[lane], object, part });
    (0..count).map(hit)
}

/// The same for any hits.
#[inline]
fn any_of_few(scene: &Scene, few: &[PartId], rays: &[Ray], within: Interval) -> impl Iterator<Item = bool> {
    let count = rays.len();
    let rays = Rays::of(rays);
    let (min, max) = (Eight::splat(within.min), Eight::splat(within.max));
    let mut found = EightAnswers::NONE;
    for &id in few {
        if let Some((crosses, t)) = surface(scene, id).eight_crossings(&rays, min) {
            found = found | (crosses & t.le(max));
        }
        if found.all() {
            break;
        }
    }
    (0..count).map(move |lane| found.of(lane))
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
