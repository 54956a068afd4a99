//! A ray: the half line { origin + t * direction | t >= 0 } of the lecture.

use glam::Vec3;

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

    /// Whether `t` lies inside. NaN does not, nor does infinity.
    pub fn contains(self, t: f32) -> bool {
        self.min <= t && t <= self.max
    }
}
