//! A ray: the half line { origin + t * direction | t >= 0 } of the lecture.

use crate::lanes::{ALL, F32x8, LANES, LaneMask, Lanes, Mask, Number, Vector};
use glam::{DVec3, Vec3};
use std::array::from_fn;

mod projection_center;

pub use projection_center::ProjectionCenter;

/// The half line `origin + t * direction`.
///
/// `t` is measured in lengths of the direction, which need not be 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The start of the ray: the lecture's **o** (or **p**).
    pub origin: Vec3,
    /// The direction: the lecture's **d**; not zero.
    pub direction: Vec3,
}

impl Ray {
    /// Returns the point at `t`: `origin + t * direction`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// One ray or eight rays, with values that tests against all shapes share, computed once per ray.
#[derive(Clone, Copy, Debug)]
pub struct Rays<N: Number> {
    /// The origins of the rays.
    pub origin: Vector<N>,
    /// The directions of the rays; none is zero.
    pub direction: Vector<N>,
    /// The reciprocal of each coordinate of the direction; infinite where that is zero.
    pub inverse: Vector<N>,
    /// The squared length of each direction.
    pub squared_length: N,
    /// The reciprocal of `squared_length`.
    pub inverse_squared_length: N,
    /// The shear that maps the direction to (0, 0, 1), for triangles.
    pub shear: Shear<N>,
}

impl<N: Number> Rays<N> {
    #[inline(always)]
    fn new(origin: Vector<N>, direction: Vector<N>) -> Self {
        Self { shear: Shear::of(direction), ..Self::without_shear(origin, direction) }
    }

    #[inline(always)]
    fn without_shear(origin: Vector<N>, direction: Vector<N>) -> Self {
        let Vector { x, y, z } = direction;
        let one = N::splat(1.0);
        let squared_length = direction.dot(direction);
        Self {
            origin,
            direction,
            // The reciprocal of a zero coordinate is infinite, on purpose: for a ray parallel to the planes of a box,
            // the slab test then depends only on the sides on which the origin lies (`culling.md`, 2).
            inverse: Vector { x: one / x, y: one / y, z: one / z },
            squared_length,
            inverse_squared_length: one / squared_length,
            // The callers set the shear afterwards; scenes without triangles save its division.
            shear: Shear::placeholder(),
        }
    }
}

impl<N: Lanes> Rays<N> {
    /// Loads eight rays.
    // The shear costs a division per ray, so it is omitted for scenes without triangles.
    #[inline(always)]
    pub fn load(rays: &EightRays, needs_shear: bool) -> Self {
        let direction = rays.direction.load();
        let shear = if needs_shear { Shear::of(direction) } else { Shear::placeholder() };
        Self { shear, ..Self::without_shear(rays.origin.load(), direction) }
    }

    /// Returns the ray of `lane` in all lanes.
    // A number is copied to all lanes by a shuffle within a register. With a copy through memory, single rays in
    // three_spheres were 22 % slower.
    #[inline(always)]
    pub(crate) fn splat_lane(&self, lane: usize) -> Self {
        Self {
            origin: self.origin.splat_lane(lane),
            direction: self.direction.splat_lane(lane),
            inverse: self.inverse.splat_lane(lane),
            squared_length: self.squared_length.splat_lane(lane),
            inverse_squared_length: self.inverse_squared_length.splat_lane(lane),
            shear: Shear {
                axis: self.shear.axis.of_lane(lane),
                factor: self.shear.factor.splat_lane(lane),
                length: self.shear.length.splat_lane(lane),
            },
        }
    }
}

/// Up to eight rays in SoA layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EightRays {
    /// The origins of the rays.
    pub origin: Vector<F32x8>,
    /// The directions of the rays; none is zero.
    pub direction: Vector<F32x8>,
    /// The active mask: bit 0 is lane 0.
    ///
    /// Inactive lanes repeat an active ray, so that they widen no bounds of a packet; if no lane is active, they hold
    /// any numbers.
    pub active: u32,
}

impl EightRays {
    /// Packs one to eight rays; unused lanes repeat the last ray.
    ///
    /// # Panics
    /// If `rays` is empty.
    pub fn of(rays: &[Ray]) -> Self {
        // The last ray is repeated, because zeros would widen the bounds of a packet.
        let ray = |lane: usize| &rays[lane.min(rays.len() - 1)];
        Self {
            origin: Vector::of(from_fn(|lane| ray(lane).origin)),
            direction: Vector::of(from_fn(|lane| ray(lane).direction)),
            active: ALL >> LANES.saturating_sub(rays.len()),
        }
    }

    /// Returns the ray of `lane`.
    ///
    /// # Panics
    /// If `lane` is 8 or more.
    #[inline(always)]
    pub fn ray(&self, lane: usize) -> Ray {
        Ray { origin: self.origin.of_lane(lane), direction: self.direction.of_lane(lane) }
    }
}

/// A single ray, also as [`Rays`] of one lane.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// The ray.
    pub ray: Ray,
    /// The ray in the form that formulas over [`Number`] take.
    pub rays: Rays<f32>,
}

impl Probe {
    /// Computes the values of a ray that tests against all shapes share.
    #[inline]
    pub fn new(ray: Ray) -> Self {
        Self { ray, rays: Rays::new(Vector::splat(ray.origin), Vector::splat(ray.direction)) }
    }
}

/// The transform to coordinates in which a ray runs along z, one unit per unit of t.
///
/// The axes are rotated so that z is the dominant axis of the direction, then x and y are sheared (Woop, Benthin and
/// Wald, Watertight Ray/Triangle Intersection, JCGT 2013).
#[derive(Clone, Copy, Debug)]
pub struct Shear<N: Number> {
    axis: DominantAxis<N::Mask>,
    /// The slopes of the ray in x and y, and the increase of t, per unit of the dominant axis.
    factor: Vector<N>,
    /// The magnitude of the direction's component along its dominant axis.
    pub length: N,
}

/// The dominant axis of one direction or several.
#[derive(Clone, Copy, Debug)]
enum DominantAxis<M> {
    X,
    Y,
    Z,
    /// Different axes: the masks of the lanes with x and with y; the others have z.
    PerLane {
        x: M,
        y: M,
    },
}

impl<N: Number> Shear<N> {
    /// Returns a placeholder, a shear of zeros, for rays that are not tested against triangles.
    #[inline(always)]
    fn placeholder() -> Self {
        let zero = N::splat(0.0);
        Self { axis: DominantAxis::Z, factor: Vector { x: zero, y: zero, z: zero }, length: zero }
    }

    #[inline(always)]
    fn of(direction: Vector<N>) -> Self {
        let length = Vector { x: direction.x.abs(), y: direction.y.abs(), z: direction.z.abs() };
        // Strict comparisons, so that ties choose the same axis for one ray, for eight and in f64.
        let is_x = length.y.lt(length.x) & length.z.lt(length.x);
        let is_y = length.z.lt(length.y) & !is_x;
        // A common axis for all lanes, as in most packets, saves six selects per corner.
        let axis = if is_x.all() {
            DominantAxis::X
        } else if is_y.all() {
            DominantAxis::Y
        } else if (is_x | is_y).any() {
            DominantAxis::PerLane { x: is_x, y: is_y }
        } else {
            DominantAxis::Z
        };
        let Vector { x, y, z } = axis.rotate_to_z(direction);
        // Divisions instead of products with 1 / z, because statement 6 of `culling.md` counts one rounding per factor.
        Self { axis, factor: Vector { x: x / z, y: y / z, z: N::splat(1.0) / z }, length: z.abs() }
    }

    /// Transforms a vector that starts at the ray's origin.
    ///
    /// For the error of x and y see `culling.md`, 6.
    #[inline(always)]
    pub fn apply(&self, from_origin: Vector<N>) -> Vector<N> {
        let Vector { x, y, z } = self.axis.rotate_to_z(from_origin);
        Vector { x: x - self.factor.x * z, y: y - self.factor.y * z, z: self.factor.z * z }
    }
}

/// Transforms a vector from the ray's origin as [`Shear`] does, in f64.
///
/// x and y are scaled by the dominant coordinate of the direction.
// The scale avoids a division, whose rounding would move the corners. `culling.md`, 8 states which results are exact.
pub fn sheared_in_f64(from_origin: DVec3, direction: Vec3) -> DVec3 {
    let [x, y, z] = match Shear::of(Vector::<f32>::splat(direction)).axis {
        DominantAxis::X => [1, 2, 0],
        DominantAxis::Y => [2, 0, 1],
        DominantAxis::Z | DominantAxis::PerLane { .. } => [0, 1, 2],
    };
    let (d, v) = (direction.as_dvec3(), from_origin);
    DVec3::new(v[x] * d[z] - d[x] * v[z], v[y] * d[z] - d[y] * v[z], v[z] / d[z])
}

impl<M: Mask> DominantAxis<M> {
    /// Returns whether all lanes of `self` and `other` have the same dominant axis.
    #[inline(always)]
    fn is_same_for_all<O>(self, other: DominantAxis<O>) -> bool {
        matches!((self, other), (Self::X, DominantAxis::X) | (Self::Y, DominantAxis::Y) | (Self::Z, DominantAxis::Z))
    }

    /// Rotates the coordinates so that the dominant one is z.
    ///
    /// The rotation keeps a right-handed basis right-handed.
    #[inline(always)]
    fn rotate_to_z<N: Number<Mask = M>>(self, Vector { x, y, z }: Vector<N>) -> Vector<N> {
        match self {
            Self::X => Vector { x: y, y: z, z: x },
            Self::Y => Vector { x: z, y: x, z: y },
            Self::Z => Vector { x, y, z },
            Self::PerLane { x: is_x, y: is_y } => {
                let choose = |of_x: N, of_y: N, of_z: N| N::select(is_x, of_x, N::select(is_y, of_y, of_z));
                Vector { x: choose(y, z, x), y: choose(z, x, y), z: choose(x, y, z) }
            }
        }
    }
}

impl<M: LaneMask> DominantAxis<M> {
    /// Returns the axis of one lane; never `PerLane`.
    #[inline(always)]
    fn of_lane(self, lane: usize) -> Self {
        match self {
            Self::PerLane { x, y } => {
                // A table instead of branches: the axis of an incoherent ray cannot be predicted.
                let at = (x.bits() >> lane & 1) + 2 * (y.bits() >> lane & 1);
                [Self::Z, Self::X, Self::Y, Self::Y][at as usize % 4]
            }
            of_all => of_all,
        }
    }
}

/// A closed interval of t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower end of the interval.
    pub min: f32,
    /// The upper end of the interval.
    pub max: f32,
}

impl Interval {
    /// Everything in front of the ray's origin: [0, `f32::MAX`].
    pub const IN_FRONT: Self = Self { min: 0.0, max: f32::MAX };

    /// Clamps `t` to the interval, or returns `None` if the interval is empty. NaN stays NaN.
    pub fn clamp(self, t: f32) -> Option<f32> {
        (self.min <= self.max).then_some(clamp_keeping_nan(self.min, self.max, t))
    }

    /// Returns whether `t` lies inside; false for NaN and infinity.
    pub fn contains(self, t: f32) -> bool {
        self.min <= t && t <= self.max
    }
}

/// Clamps `t` to `min..=max`. NaN stays NaN, unlike with `Number::max` and `Number::min`.
#[inline(always)]
pub fn clamp_keeping_nan<N: Number>(min: N, max: N, t: N) -> N {
    N::select(t.lt(min), min, N::select(max.lt(t), max, t))
}
