//! Axis-aligned boxes and their intersection with rays.

use crate::lanes::{Number, Vector};
use crate::ray::{Interval, Probe, Rays};
use glam::Vec3;

/// An axis-aligned box: all points from `min` to `max`. Its extent may be zero along any axis.
///
/// ```
/// use glam::Vec3;
/// use termtrace::{Camera, Scene, Sphere};
///
/// let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO)?;
/// let scene = Scene::builder(camera).object(Sphere::new(Vec3::ZERO, 1.0)?, termtrace::Material::default()).build()?;
/// let bounds = scene.bounds().ok_or("only planes")?;
/// assert!(bounds.min.x <= -1.0 && bounds.max.x >= 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinates. Finite.
    pub min: Vec3,
    /// The greatest coordinates. Finite.
    pub max: Vec3,
}

/// The relative widening of a ray's interval in a box at both ends: 16 units of 2^-24.
// Of the 16 units, three cover the rounding of an end, one the rounding of the widening, and twelve the error of the t
// that a surface computes (`culling.md`, 3).
const CROSSING_SLACK: f32 = 16.0 / 16_777_216.0;

impl Bounds {
    /// The empty box: the neutral element of [`union`](Self::union).
    pub(crate) const EMPTY: Self = Self { min: Vec3::splat(f32::INFINITY), max: Vec3::splat(f32::NEG_INFINITY) };

    /// Returns the smallest box around the points.
    #[doc(hidden)]
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| bounds.union(&Self { min: point, max: point }))
    }

    /// Returns the smallest box around both boxes.
    #[doc(hidden)]
    pub fn union(&self, other: &Self) -> Self {
        // glam's `min` and `max` may treat NaN and -0 differently on each CPU. No coordinate is NaN, and no later
        // comparison or product depends on the sign of a zero.
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns the size along each axis.
    #[doc(hidden)]
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Returns half the surface area.
    ///
    /// Under the surface area heuristic the probability that a ray meets the box is proportional to it.
    pub(crate) fn half_area(&self) -> f32 {
        let Vec3 { x, y, z } = self.extent();
        x * y + y * z + z * x
    }

    /// Returns the interval of t in which the ray's line is inside the box.
    ///
    /// It is empty (`min > max`) if the line misses the box.
    ///
    /// The interval is widened by 16 units of 2^-24 (`culling.md`, 3). It contains the interval of each box inside this
    /// one, bit for bit (`culling.md`, 2), so that a box above a shape in the tree never culls a hit of the shape.
    #[doc(hidden)]
    pub fn crossed(&self, probe: &Probe) -> Interval {
        let [min, max] = crossed([Vector::splat(self.min), Vector::splat(self.max)], &probe.rays);
        Interval { min, max }
    }

    /// Returns the box whose faces lie one step of f32 farther out.
    pub(crate) fn one_step_larger(self) -> Self {
        let [min, max] = [self.min.to_array().map(f32::next_down), self.max.to_array().map(f32::next_up)];
        Self { min: min.into(), max: max.into() }
    }

    /// Returns whether the line of a ray, in both directions, may pass through the box.
    pub(crate) fn is_crossed(&self, probe: &Probe) -> bool {
        let Interval { min, max } = self.crossed(probe);
        min <= max
    }
}

/// Computes [`Bounds::crossed`] for one ray or eight and one box or eight.
#[inline(always)]
pub fn crossed<N: Number>([min, max]: [Vector<N>; 2], rays: &Rays<N>) -> [N; 2] {
    let slab = |min: N, max: N, origin: N, inverse: N| {
        let is_backward = inverse.lt(N::splat(0.0));
        // The sign of the inverse chooses the near plane. Choosing it by `min` and `max` of both products instead would
        // break the order of nested boxes where a product is NaN (`culling.md`, 2).
        let near = N::select(is_backward, max, min);
        let far = N::select(is_backward, min, max);
        [(near - origin) * inverse, (far - origin) * inverse]
    };
    let x = slab(min.x, max.x, rays.origin.x, rays.inverse.x);
    let y = slab(min.y, max.y, rays.origin.y, rays.inverse.y);
    let z = slab(min.z, max.z, rays.origin.z, rays.inverse.z);
    intersect_slabs([x, y, z])
}

/// Returns the widened interval of t in which rays are in a box, from the intervals of its slabs.
#[inline(always)]
pub fn intersect_slabs<N: Number>([x, y, z]: [[N; 2]; 3]) -> [N; 2] {
    // A ray in the plane of a face has NaN there, 0 times infinity, and that face must not bound its interval: if the
    // first operand is NaN, `max` and `min` return the second, which is never NaN.
    let enters = x[0].max(y[0].max(z[0].max(N::splat(f32::NEG_INFINITY))));
    let leaves = x[1].min(y[1].min(z[1].min(N::splat(f32::INFINITY))));
    // Which factor widens the interval depends on the sign of t. Taking the outer one of both products is cheaper than
    // a comparison with zero and a select.
    let (less, more) = (N::splat(1.0 - CROSSING_SLACK), N::splat(1.0 + CROSSING_SLACK));
    [(enters * less).min(enters * more), (leaves * less).max(leaves * more)]
}
