//! Vectors of three coordinates, for one point or eight.

use super::{F32x8, LANES, Lanes, Number};
use glam::Vec3;
use std::ops::{Add, Mul, Sub};

/// A vector of three coordinates, each a [`Number`]: one vector, or eight in SoA layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<N> {
    /// The x coordinate.
    pub x: N,
    /// The y coordinate.
    pub y: N,
    /// The z coordinate.
    pub z: N,
}

// All methods are `inline(always)`, like those of `Number`, because kernels are made of them (see `simd`).
impl<N: Number> Vector<N> {
    /// Returns `v` in all lanes.
    #[inline(always)]
    pub fn splat(v: Vec3) -> Self {
        Self { x: N::splat(v.x), y: N::splat(v.y), z: N::splat(v.z) }
    }

    /// Returns the smaller of both vectors' numbers for each coordinate.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self { x: self.x.min(other.x), y: self.y.min(other.y), z: self.z.min(other.z) }
    }

    /// Returns the larger of both vectors' numbers for each coordinate.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self { x: self.x.max(other.x), y: self.y.max(other.y), z: self.z.max(other.z) }
    }

    /// Returns the largest absolute coordinate.
    #[inline(always)]
    pub fn max_abs_coordinate(self) -> N {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }

    /// Returns `yes` where the mask is set, else `no`.
    #[inline(always)]
    pub fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        Self { x: N::select(mask, yes.x, no.x), y: N::select(mask, yes.y, no.y), z: N::select(mask, yes.z, no.z) }
    }

    /// Returns two unit vectors perpendicular to this unit vector and to each other.
    ///
    /// They change abruptly only at -y (Frisvad, Building an Orthonormal Basis from a 3D Unit Vector Without
    /// Normalization, 2012).
    #[inline(always)]
    pub fn perpendicular_pair(self) -> [Self; 2] {
        let Self { x, y, z } = self;
        let one = N::splat(1.0);
        let fall = one / (one + y).max(N::splat(1e-6));
        let across = -(x * z) * fall;
        [Self { x: one - x * x * fall, y: -x, z: across }, Self { x: across, y: -z, z: one - z * z * fall }]
    }

    /// Returns the cross product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - other.y * self.z,
            y: self.z * other.x - other.z * self.x,
            z: self.x * other.y - other.x * self.y,
        }
    }

    /// Returns the dot product, summed in the order x, y, z on every CPU.
    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        // No FMA and no horizontal add: their rounding differs between CPUs.
        self.x * other.x + self.y * other.y + self.z * other.z
    }
}

impl Vector<F32x8> {
    /// Zero in all lanes.
    pub const ZERO: Self = Self { x: F32x8::ZERO, y: F32x8::ZERO, z: F32x8::ZERO };

    /// Transposes eight vectors into SoA layout.
    #[inline(always)]
    pub fn of(vectors: [Vec3; LANES]) -> Self {
        Self { x: F32x8(vectors.map(|v| v.x)), y: F32x8(vectors.map(|v| v.y)), z: F32x8(vectors.map(|v| v.z)) }
    }

    /// Loads the coordinates into vectors of type `N`.
    #[inline(always)]
    pub fn load<N: Lanes>(&self) -> Vector<N> {
        Vector { x: N::load(&self.x), y: N::load(&self.y), z: N::load(&self.z) }
    }

    /// Sets the vector of `lane`.
    #[inline(always)]
    pub fn put(&mut self, lane: usize, v: Vec3) {
        (self.x.0[lane], self.y.0[lane], self.z.0[lane]) = (v.x, v.y, v.z);
    }

    /// Returns the vector of `lane`.
    #[inline(always)]
    pub fn of_lane(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x.0[lane], self.y.0[lane], self.z.0[lane])
    }
}

impl<N: Lanes> Vector<N> {
    /// Gathers lanes of each coordinate, as [`Lanes::gather`] does.
    #[inline(always)]
    pub(crate) fn gather(self, lanes: N) -> Self {
        Self { x: self.x.gather(lanes), y: self.y.gather(lanes), z: self.z.gather(lanes) }
    }

    /// Returns the vector of `lane` in all lanes.
    #[inline(always)]
    pub(crate) fn splat_lane(self, lane: usize) -> Self {
        Self { x: self.x.splat_lane(lane), y: self.y.splat_lane(lane), z: self.z.splat_lane(lane) }
    }

    /// Stores the coordinates to memory.
    #[inline(always)]
    pub fn store(self) -> Vector<F32x8> {
        Vector { x: self.x.store(), y: self.y.store(), z: self.z.store() }
    }
}

impl From<Vector<f32>> for Vec3 {
    fn from(Vector { x, y, z }: Vector<f32>) -> Self {
        Self::new(x, y, z)
    }
}

impl<N: Number> Add for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<N: Number> Sub for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<N: Number> Mul<N> for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: N) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<N: Number> Mul for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }
}
