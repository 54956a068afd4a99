//! Boxes along the axes, and where a ray is inside one.

use crate::lanes::{Number, Vector};
use crate::ray::{Interval, Probe, Rays};
use glam::Vec3;

/// A box along the axes: all points from `min` to `max`. It may be flat, or a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinates. Finite.
    pub min: Vec3,
    /// The greatest coordinates. Finite.
    pub max: Vec3,
}

/// How far a ray's way through a box is lengthened at both ends, relatively: 16 units of 2^-24. Each end is off by
/// three units at most, and a crossing that is computed in another way by a few more.
const CROSSING_SLACK: f32 = 16.0 / 16_777_216.0;

impl Bounds {
    /// Around nothing: with it, a union is the other box.
    pub(crate) const EMPTY: Self = Self { min: Vec3::splat(f32::INFINITY), max: Vec3::splat(f32::NEG_INFINITY) };

    /// Around these points.
    #[doc(hidden)]
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| bounds.union(&Self { min: point, max: point }))
    }

    /// Around both. (No coordinate is NaN, and whether a zero is -0 makes no difference to any comparison or product
    /// that follows: so it does not matter how `min` and `max` treat them.)
    #[doc(hidden)]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// How far it reaches along each axis.
    #[doc(hidden)]
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Half its surface. A ray that meets a convex body around it meets it with a probability in proportion to this.
    pub(crate) fn half_area(&self) -> f32 {
        let Vec3 { x, y, z } = self.extent();
        x * y + y * z + z * x
    }

    /// Where the ray's line is inside; empty (`min > max`) where it misses the box.
    ///
    /// Widened a little, so that whatever lies in the box is met inside. Every step is monotone in the box's
    /// coordinates, in IEEE arithmetic as on paper: the way through a larger box contains the way through a smaller one,
    /// bit for bit. So it does not depend on the boxes around a shape's own whether the shape is tested.
    #[doc(hidden)]
    pub fn crossed(&self, probe: &Probe) -> Interval {
        let [min, max] = crossed([Vector::splat(self.min), Vector::splat(self.max)], &probe.rays);
        Interval { min, max }
    }
}

/// [`Bounds::crossed`] by one ray or several, and of one box or several: from where to where.
#[inline(always)]
pub fn crossed<N: Number>([min, max]: [Vector<N>; 2], rays: &Rays<N>) -> [N; 2] {
    let way = |min: N, max: N, origin: N, inverse: N| {
        let is_backward = inverse.lt(N::splat(0.0));
        let near = N::select(is_backward, max, min);
        let far = N::select(is_backward, min, max);
        [(near - origin) * inverse, (far - origin) * inverse]
    };
    let x = way(min.x, max.x, rays.origin.x, rays.inverse.x);
    let y = way(min.y, max.y, rays.origin.y, rays.inverse.y);
    let z = way(min.z, max.z, rays.origin.z, rays.inverse.z);
    intersect_slabs([x, y, z])
}

/// What three ways have in common, lengthened.
#[inline(always)]
pub fn intersect_slabs<N: Number>([x, y, z]: [[N; 2]; 3]) -> [N; 2] {
    // NaN is zero times infinity: a ray along a face, in its plane. That face ends nothing, and is left out: where the
    // first is NaN, `max` and `min` are the second, which never is.
    let enters = x[0].max(y[0].max(z[0].max(N::splat(f32::NEG_INFINITY))));
    let leaves = x[1].min(y[1].min(z[1].min(N::splat(f32::INFINITY))));
    // Whatever the sign, of a little less and a little more the one that lies outside.
    let (less, more) = (N::splat(1.0 - CROSSING_SLACK), N::splat(1.0 + CROSSING_SLACK));
    [(enters * less).min(enters * more), (leaves * less).max(leaves * more)]
}
