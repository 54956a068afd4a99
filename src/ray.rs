//! A ray: the half line { origin + t * direction | t >= 0 } of the lecture.

use crate::lanes::{ALL, F32x8, LANES, LaneMask, Lanes, Mask, Number, Vector};
use glam::{DVec3, Vec3};
use std::array::from_fn;

mod common_origin;

pub use common_origin::CommonOrigin;

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
#[derive(Clone, Copy, Debug)]
pub struct Rays<N: Number> {
    /// Where each begins.
    pub origin: Vector<N>,
    /// Where it goes; not zero.
    pub direction: Vector<N>,
    /// One over the direction, coordinate by coordinate; infinite where that is zero.
    pub inverse: Vector<N>,
    /// The direction's length, squared.
    pub squared_length: N,
    /// One over that.
    pub inverse_squared_length: N,
    /// What brings the direction to (0, 0, 1).
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
            inverse: Vector { x: one / x, y: one / y, z: one / z },
            squared_length,
            inverse_squared_length: one / squared_length,
            shear: Shear::none(),
        }
    }
}

impl<N: Lanes> Rays<N> {
    /// Of eight. The shear is left out where no surface asks for it.
    #[inline(always)]
    pub fn load(rays: &EightRays, needs_shear: bool) -> Self {
        let direction = rays.direction.load();
        let shear = if needs_shear { Shear::of(direction) } else { Shear::none() };
        Self { shear, ..Self::without_shear(rays.origin.load(), direction) }
    }

    /// One of them, in every place.
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

/// Eight rays side by side, or fewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EightRays {
    /// Where each begins.
    pub origin: Vector<F32x8>,
    /// Where it goes; not zero.
    pub direction: Vector<F32x8>,
    /// Which of them are asked about, a bit for each, the first the lowest. In the place of the others stands one of
    /// these; if there are none, anything.
    pub active: u32,
}

impl EightRays {
    /// Of eight rays, or of fewer.
    ///
    /// # Panics
    /// If there is none.
    pub fn of(rays: &[Ray]) -> Self {
        let ray = |lane: usize| &rays[lane.min(rays.len() - 1)];
        Self {
            origin: Vector::of(from_fn(|lane| ray(lane).origin)),
            direction: Vector::of(from_fn(|lane| ray(lane).direction)),
            active: ALL >> LANES.saturating_sub(rays.len()),
        }
    }

    /// One of them.
    ///
    /// # Panics
    /// If there is none in that place.
    #[inline(always)]
    pub fn ray(&self, lane: usize) -> Ray {
        Ray { origin: self.origin.of_lane(lane), direction: self.direction.of_lane(lane) }
    }
}

/// A ray by itself, with what tests against many shapes have in common.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// The ray.
    pub ray: Ray,
    /// The same for formulas that may be asked for several.
    pub rays: Rays<f32>,
}

impl Probe {
    /// Of that ray.
    #[inline]
    pub fn new(ray: Ray) -> Self {
        Self { ray, rays: Rays::new(Vector::splat(ray.origin), Vector::splat(ray.direction)) }
    }
}

/// The change of coordinates in which a ray runs along the z axis, one unit for each t: first the axes are exchanged, so
/// that z is the one along which the direction is longest, then x and y are sheared (Woop, Benthin and Wald, Watertight
/// Ray/Triangle Intersection, JCGT 2013).
#[derive(Clone, Copy, Debug)]
pub struct Shear<N: Number> {
    axis: DominantAxis<N::Mask>,
    /// How far it goes along x and y, and how much t grows, while it goes one unit along its longest axis.
    factor: Vector<N>,
    /// How far the direction goes along its longest axis.
    pub length: N,
}

/// Along which axis a direction is longest.
#[derive(Clone, Copy, Debug)]
enum DominantAxis<M> {
    X,
    Y,
    Z,
    /// Not the same for all: where it is x, and where y.
    PerLane {
        x: M,
        y: M,
    },
}

impl<N: Number> Shear<N> {
    /// Of rays that no triangle asks for it.
    #[inline(always)]
    fn none() -> Self {
        let zero = N::splat(0.0);
        Self { axis: DominantAxis::Z, factor: Vector { x: zero, y: zero, z: zero }, length: zero }
    }

    #[inline(always)]
    fn of(direction: Vector<N>) -> Self {
        let length = Vector { x: direction.x.abs(), y: direction.y.abs(), z: direction.z.abs() };
        let is_x = length.y.lt(length.x) & length.z.lt(length.x);
        let is_y = length.z.lt(length.y) & !is_x;
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
        Self { axis, factor: Vector { x: x / z, y: y / z, z: N::splat(1.0) / z }, length: z.abs() }
    }

    /// A vector from the ray's origin in those coordinates. Its x and y are off by 2 |x| + 4 |z| [`length`](Self::length)
    /// units of 2^-24, at most and to first order: no factor of theirs is more than 1.
    #[inline(always)]
    pub fn apply(&self, from_origin: Vector<N>) -> Vector<N> {
        let Vector { x, y, z } = self.axis.rotate_to_z(from_origin);
        Vector { x: x - self.factor.x * z, y: y - self.factor.y * z, z: self.factor.z * z }
    }
}

/// A vector from the ray's origin in the coordinates of [`Shear`], in f64, with x and y multiplied by the direction along
/// its longest axis. So they need no division, and as f64 holds the product of two f32 whole, they are exact, or where f64
/// does not reach so far down, off by 2^-53 of themselves.
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
    /// Whether both say of all that it is along the same axis.
    #[inline(always)]
    fn is_same_for_all<O>(self, other: DominantAxis<O>) -> bool {
        matches!((self, other), (Self::X, DominantAxis::X) | (Self::Y, DominantAxis::Y) | (Self::Z, DominantAxis::Z))
    }

    /// The coordinates turned about so that the longest is z. A right-handed basis stays one.
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
    /// Of one of them: never `Each`.
    #[inline(always)]
    fn of_lane(self, lane: usize) -> Self {
        match self {
            Self::PerLane { x, y } => {
                // Nobody can guess it: a table does not ask the CPU to.
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
