//! A ray: the half line { origin + t * direction | t >= 0 } of the lecture.

use glam::Vec3;
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

/// A ray, with what tests against many shapes have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// The ray.
    pub ray: Ray,
    /// One over the direction, coordinate by coordinate; infinite where that is zero.
    pub inverse: Vec3,
    /// Made when the first triangle asks for it.
    shear: OnceCell<Shear>,
}

impl Probe {
    /// Of that ray.
    pub fn new(ray: Ray) -> Self {
        Self { ray, inverse: 1.0 / ray.direction, shear: OnceCell::new() }
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
        let inside = if t < self.min {
            self.min
        } else if t > self.max {
            self.max
        } else {
            t
        };
        (self.min <= self.max).then_some(inside)
    }

    /// Whether `t` lies inside. NaN does not, nor does infinity.
    pub fn contains(self, t: f32) -> bool {
        self.min <= t && t <= self.max
    }
}
