//! Shadow rays in scenes with transparent objects, which let a part of the light through.

use super::{EightLights, EightPoints, count};
use crate::accel::PrimitiveId;
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::{F32x8, LANES, set_bits};
use crate::light::Light;
use crate::ray::{EightRays, Interval};
use crate::scene::Scene;

/// The most surfaces that a shadow ray passes; those behind them are left out.
// A ray through opacities of 1/4 has less than 1/1024 of its light left behind 25 surfaces.
const MAX_SURFACES: u32 = 32;

/// The part of the way that a ray skips which starts on a surface.
const FIRST_STEP: f32 = 1e-6;

/// The least part of the light that is followed; a ray with less is blocked.
const MIN_PART: f32 = 1.0 / 1024.0;

/// Shadow rays that are traced from surface to surface, and the buffers of their steps.
#[derive(Default)]
pub(super) struct TransparentShadows {
    rays: Vec<EightRays>,
    hits: Vec<EightHits>,
    points: Vec<EightPoints>,
    /// The part of the light that each ray still has.
    parts: Vec<F32x8>,
}

impl TransparentShadows {
    /// Finds the blocked rays, and weakens the `lights` of the others by what they pass.
    ///
    /// Returns the number of traced rays.
    pub(super) fn trace(
        &mut self,
        scene: &Scene,
        light: &Light,
        rays: &[EightRays],
        lights: &mut [EightLights],
        blocked: &mut Vec<u32>,
    ) -> u64 {
        let interval = light.blocking_interval();
        self.rays.clear();
        self.rays.extend_from_slice(rays);
        self.parts.clear();
        self.parts.resize(rays.len(), F32x8([1.0; LANES]));
        blocked.clear();
        blocked.resize(rays.len(), 0);
        let mut traced = 0;
        for _ in 0..MAX_SURFACES {
            traced += count(&self.rays);
            hit::closest_hits(Kernel::Auto, scene, &self.rays, &mut self.hits);
            super::surface_points(scene, &self.rays, &self.hits, &mut self.points);
            for (group, blocked) in blocked.iter_mut().enumerate() {
                *blocked |= self.pass(scene, group, interval);
            }
            if self.rays.iter().all(|rays| rays.active == 0) {
                break;
            }
        }
        for (lights, parts) in lights.iter_mut().zip(&self.parts) {
            for channel in lights {
                *channel = *channel * *parts;
            }
        }
        traced
    }

    /// Returns the parts of the light that the rays of a group still had at the end of the last
    /// trace.
    pub(super) fn parts(&self, group: usize) -> &F32x8 {
        &self.parts[group]
    }

    /// Moves the rays of a group behind the surfaces that they have met, and returns the mask of
    /// those that are blocked.
    ///
    /// Only the moved rays stay active.
    fn pass(&mut self, scene: &Scene, group: usize, Interval { min, max }: Interval) -> u32 {
        let (rays, hits, points) = (&mut self.rays[group], &self.hits[group], &self.points[group]);
        let (mut passed, mut blocked) = (0, 0);
        for lane in set_bits(rays.active & hits.hit_mask) {
            if hits.t.0[lane] > max {
                continue;
            }
            if hits.t.0[lane] < min {
                // At the origin of the world a ray starts on its surface, which does not block it.
                rays.origin.put(lane, rays.ray(lane).at(FIRST_STEP));
                passed |= 1 << lane;
                continue;
            }
            let part = &mut self.parts[group].0[lane];
            let PrimitiveId { object, index } = points.ids.id(lane);
            *part *= 1.0 - scene.objects()[object as usize].opacity_at(index, &points.own_point(lane));
            if *part < MIN_PART {
                blocked |= 1 << lane;
                continue;
            }
            let (ray, normal) = (rays.ray(lane), points.geometric_normal.of_lane(lane));
            let (position, met) = (points.position.of_lane(lane), ray.at(hits.t.0[lane]));
            let origin = super::origin_behind(position, normal, points.clearance.0[lane], met);
            // The end of a ray to a light at a finite distance stays where it is.
            let direction = if max.is_finite() { ray.at(1.0) - origin } else { ray.direction };
            // The last surface may be so close to the light that the ray is behind it now.
            if direction.dot(ray.direction) > 0.0 {
                rays.origin.put(lane, origin);
                rays.direction.put(lane, direction);
                passed |= 1 << lane;
            }
        }
        rays.active = passed;
        if passed != 0 {
            repeat_active_lane(rays);
        }
        blocked
    }
}

/// Makes inactive lanes repeat an active ray, so that they do not widen the bounds of the group.
fn repeat_active_lane(rays: &mut EightRays) {
    let one = rays.ray(rays.active.trailing_zeros() as usize % LANES);
    for lane in (0..LANES).filter(|lane| rays.active >> lane & 1 == 0) {
        rays.origin.put(lane, one.origin);
        rays.direction.put(lane, one.direction);
    }
}
