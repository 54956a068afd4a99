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

    /// What brings the direction to (0, 0, 1).
    pub fn shear(&self) -> &Shear {
        self.shear.get_or_init(|| Shear::of(self.ray.direction))
    }
}

/// The change of coordinates in which a ray runs along the z axis, one unit for each t: first the axes are exchanged, so
/// that z is the one along which the direction is longest, then x and y are sheared (Woop, Benthin and Wald, Watertight
/// Ray/Triangle Intersection, JCGT 2013).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shear {
    longest: Axis,
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
        let Vec3 { x, y, z } = longest.last(direction);
        Self { longest, factor: Vec3::new(x / z, y / z, 1.0 / z) }
    }

    /// A vector from the ray's origin in those coordinates. Equal points become equal points, to the bit, which is why
    /// triangles that share an edge leave no gap.
    pub fn apply(&self, from_origin: Vec3) -> Vec3 {
        let Vec3 { x, y, z } = self.longest.last(from_origin);
        Vec3::new(x - self.factor.x * z, y - self.factor.y * z, self.factor.z * z)
    }
}

impl Axis {
    /// The coordinates turned about so that this one is z. A right-handed basis stays one.
    fn last(self, Vec3 { x, y, z }: Vec3) -> Vec3 {
        match self {
            Self::X => Vec3::new(y, z, x),
            Self::Y => Vec3::new(z, x, y),
            Self::Z => Vec3::new(x, y, z),
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
