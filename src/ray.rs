//! A ray: the half line { origin + t * direction | t >= 0 } of the lecture.

use crate::lanes::{Eight, Number, Vector};
use glam::Vec3;
use std::array::from_fn;
use std::cell::OnceCell;

/// `origin + t * direction`. The direction need not have unit length: t is counted in lengths of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray begins: the lecture's **o** (or **p**).
    pub origin: Vec3,
    /// Where it goes: the lecture's **d**; not zero.
    pub direction: Vec3,
}

impl Ray {
    /// The point at `t`: `origin + t * direction`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// A ray or several, with what tests against many shapes have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rays<N> {
    /// Where each begins.
    pub origin: Vector<N>,
    /// Where it goes; not zero.
    pub direction: Vector<N>,
    /// One over the direction, coordinate by coordinate; infinite where that is zero.
    pub inverse: Vector<N>,
    /// The direction's length, squared.
    pub squared_length: N,
}

impl<N: Number> Rays<N> {
    #[inline(always)]
    fn new(origin: Vector<N>, direction: Vector<N>) -> Self {
        let Vector { x, y, z } = direction;
        let one = N::splat(1.0);
        let inverse = Vector { x: one / x, y: one / y, z: one / z };
        Self { origin, direction, inverse, squared_length: direction.dot(direction) }
    }
}

impl Rays<Eight> {
    /// Of eight rays, or of fewer: the last of them then stands for those that are lacking.
    ///
    /// # Panics
    /// If there is none.
    #[inline(always)]
    pub fn of(rays: &[Ray]) -> Self {
        let ray = |lane: usize| &rays[lane.min(rays.len() - 1)];
        Self::new(Vector::of(from_fn(|lane| ray(lane).origin)), Vector::of(from_fn(|lane| ray(lane).direction)))
    }

    /// One of the eight.
    pub fn ray(&self, lane: usize) -> Ray {
        let at = |Vector { x, y, z }: &Vector<Eight>| Vec3::new(x.0[lane], y.0[lane], z.0[lane]);
        Ray { origin: at(&self.origin), direction: at(&self.direction) }
    }
}

/// A ray by itself, with what tests against many shapes have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// The ray.
    pub ray: Ray,
    /// The same for formulas that may be asked for several.
    pub rays: Rays<f32>,
    /// Made when the first triangle asks for it.
    shear: OnceCell<Shear>,
}

impl Probe {
    /// Of that ray.
    #[inline]
    pub fn new(ray: Ray) -> Self {
        let rays = Rays::new(Vector::splat(ray.origin), Vector::splat(ray.direction));
        Self { ray, rays, shear: OnceCell::new() }
    }

    /// What brings the direction onto the z axis.
    #[inline]
    pub fn shear(&self) -> &Shear {
        self.shear.get_or_init(|| Shear::of(self.ray.direction))
    }

    /// A point in the ray's own [coordinates](Shear).
    #[inline]
    pub fn sheared(&self, point: Vec3) -> Vector<f32> {
        self.shear().apply(Vector::splat(point) - self.rays.origin)
    }

    /// The same in f64, but for a factor: [`Shear::apply_exactly`].
    pub fn sheared_exactly(&self, point: Vec3) -> Vector<f64> {
        self.shear().apply_exactly(Vector::splat(point) - Vector::splat(self.ray.origin))
    }
}

/// The change of coordinates in which a ray runs along the z axis, one unit for each t: first the axes are turned about, so
/// that z is the one along which the direction is longest, then x and y are sheared (Woop, Benthin and Wald, Watertight
/// Ray/Triangle Intersection, JCGT 2013).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shear {
    longest: Axis,
    /// The direction, with the axes turned about.
    direction: Vec3,
    /// How far it goes along x and y, and how much t grows, while it goes one unit along its longest axis.
    factor: Vec3,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axis {
    X,
    Y,
    Z,
}

impl Shear {
    fn of(direction: Vec3) -> Self {
        let length = direction.abs();
        let longest = if length.x > length.y && length.x > length.z {
            Axis::X
        } else if length.y > length.z {
            Axis::Y
        } else {
            Axis::Z
        };
        let Vector { x, y, z } = longest.last(Vector { x: direction.x, y: direction.y, z: direction.z });
        Self { longest, direction: Vec3::new(x, y, z), factor: Vec3::new(x / z, y / z, 1.0 / z) }
    }

    /// How far the direction goes along its longest axis.
    pub fn length(&self) -> f32 {
        self.direction.z.abs()
    }

    /// A vector from the ray's origin in those coordinates. Its x and y are off by 2 |x| + 4 |z| [`length`](Self::length)
    /// units of 2^-24, at most and to first order: no factor of theirs is more than 1.
    #[inline]
    pub fn apply(&self, from_origin: Vector<f32>) -> Vector<f32> {
        let Vector { x, y, z } = self.longest.last(from_origin);
        Vector { x: x - self.factor.x * z, y: y - self.factor.y * z, z: self.factor.z * z }
    }

    /// The same in f64, with x and y multiplied by the direction along its longest axis. So they need no division, and as
    /// f64 holds the product of two f32 whole, they are exact, or where f64 does not reach so far down, off by 2^-53 of
    /// themselves.
    pub fn apply_exactly(&self, from_origin: Vector<f64>) -> Vector<f64> {
        let Vector { x, y, z } = self.longest.last(from_origin);
        let d = self.direction.as_dvec3();
        Vector { x: x * d.z - d.x * z, y: y * d.z - d.y * z, z: z / d.z }
    }
}

impl Axis {
    /// The coordinates turned about so that this one is z. A right-handed basis stays one.
    #[inline]
    fn last<N>(self, Vector { x, y, z }: Vector<N>) -> Vector<N> {
        match self {
            Self::X => Vector { x: y, y: z, z: x },
            Self::Y => Vector { x: z, y: x, z: y },
            Self::Z => Vector { x, y, z },
        }
    }
}

/// A closed interval of t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least t.
    pub min: f32,
    /// The greatest t.
    pub max: f32,
}

impl Interval {
    /// All that lies in front of the ray's origin: [0, infinity).
    pub const IN_FRONT: Self = Self { min: 0.0, max: f32::MAX };

    /// The `t` inside that is nearest to this one; none if there is nothing inside. (NaN stays NaN.)
    pub fn nearest(self, t: f32) -> Option<f32> {
        (self.min <= self.max).then_some(nearest_in(self.min, self.max, t))
    }

    /// Whether `t` lies inside. NaN does not, nor does infinity.
    pub fn contains(self, t: f32) -> bool {
        self.min <= t && t <= self.max
    }
}

/// Of all from `min` to `max`, what is nearest to `t`. (NaN stays NaN.)
#[inline(always)]
pub fn nearest_in<N: Number>(min: N, max: N, t: N) -> N {
    N::select(t.lt(min), min, N::select(max.lt(t), max, t))
}
