//! Holes: the parts of surfaces that rays pass, because a picture or a mesh's file leaves them out.
//!
//! Rays are traced as if there were no holes. Those that meet one are then traced again, singly, from behind the hole.
//! So scenes without holes cost nothing, and all kernels find the same hits.

use super::single::{CLOSEST, SingleRay};
use super::{EightHits, Hit};
use crate::accel::PrimitiveId;
use crate::bvh::RayStack;
use crate::lanes::{Lanes, set_bits};
use crate::ray::{EightRays, Interval, Ray, Rays};
use crate::scene::{OwnPoint, Scene};
use crate::shape::Surface;
use crate::simd::SimdKernel;

/// The most holes that a ray passes; the next surface counts as whole.
const MAX_HOLES: u32 = 256;

/// The part of t that a ray skips behind a hole.
// The root of an equation that is solved again may differ by a few units of 2^-24, for a small sphere by more.
const SKIPPED: f32 = 1.0 / (1 << 19) as f32;

/// Returns the interval of t behind a hole.
pub(super) fn behind(t: f32, within: Interval) -> Interval {
    Interval { min: (t + t * SKIPPED).max(t.next_up()), ..within }
}

/// Returns whether a ray meets a hole at a hit.
pub(crate) fn is_hole(scene: &Scene, ray: &Ray, hit: Hit) -> bool {
    let object = &scene.objects()[hit.object as usize];
    object.has_holes() && object.has_hole(hit.primitive, &OwnPoint::from(&hit.surface(scene).at_crossing(ray, hit.t)))
}

/// A counter of the holes on the way of a ray.
pub(super) struct HolesLeft(u32);

impl HolesLeft {
    pub(super) const ALL: Self = Self(MAX_HOLES);

    /// Counts a hole; returns false if the ray has passed as many as it may.
    pub(super) fn count(&mut self) -> bool {
        let may_pass = self.0 > 0;
        self.0 = self.0.saturating_sub(1);
        may_pass
    }
}

/// The SIMD kernel that replaces hits in holes by those behind them.
pub(super) struct PassHoles<'w> {
    pub(super) scene: &'w Scene,
    pub(super) rays: &'w [EightRays],
    pub(super) within: Interval,
    pub(super) hits: &'w mut [EightHits],
}

impl SimdKernel for PassHoles<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { scene, rays, within, hits } = self;
        let (accel, mut stack) = (scene.accelerator(), RayStack::default());
        for (rays, hits) in rays.iter().zip(hits) {
            for lane in set_bits(hits.hit_mask) {
                let (ray, mut left) = (rays.ray(lane), HolesLeft::ALL);
                while let Some(hit) = hits.hit(scene, lane)
                    && is_hole(scene, &ray, hit)
                    && left.count()
                {
                    let eight = Rays::<N>::load(rays, accel.needs_shear());
                    let mut single = SingleRay::<N, CLOSEST>::new(accel, &eight, lane, behind(hit.t, within));
                    single.trace(&mut stack);
                    hits.put(lane, single.t_and_primitive());
                }
            }
        }
    }
}

/// Returns the first hit that is in no hole, among those that `closest` finds in intervals of t.
pub(super) fn first_whole(
    scene: &Scene,
    ray: &Ray,
    mut within: Interval,
    mut closest: impl FnMut(Interval) -> (f32, Option<u32>),
) -> Option<Hit> {
    let mut left = HolesLeft::ALL;
    loop {
        let (t, primitive) = closest(within);
        let PrimitiveId { object, index } = scene.accelerator().id(primitive?);
        let hit = Hit { t, object, primitive: index };
        if !(scene.has_holes() && is_hole(scene, ray, hit) && left.count()) {
            return Some(hit);
        }
        within = behind(t, within);
    }
}
