//! Ray-plane intersection (lecture, "Ray intersection").

use super::{CLEARANCE, Crossable, Side, Surface, SurfacePoint, largest_coordinate};
use crate::bounds::Bounds;
use crate::lanes::{Number, Vector};
use crate::ray::{Interval, Probe, Ray, Rays};
use glam::{Vec2, Vec3};

/// All points x with (x - a).n = 0. It has no end, and is seen from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: Vec3,
    normal: Vec3,
    /// The axes of patterns on the plane: u, normal, v is a right-handed orthonormal basis.
    u: Vec3,
    v: Vec3,
}

impl Plane {
    /// The plane through `point`, perpendicular to `normal`.
    ///
    /// # Panics
    /// In debug builds, unless the point is finite and the normal has unit length.
    pub fn new(point: Vec3, normal: Vec3) -> Self {
        debug_assert!(point.is_finite(), "a plane's point is finite");
        debug_assert!(normal.is_normalized(), "a plane's normal has unit length");
        let u = pattern_axis(normal);
        // On a floor (normal +y) u is +x and v is +z.
        Self { point, normal, u, v: u.cross(normal) }
    }

    /// A point of the plane; patterns begin there.
    pub fn point(&self) -> Vec3 {
        self.point
    }

    /// Unit length.
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// (p + t d - a).n = 0 gives t = (a - p).n / d.n; a ray along the plane never crosses it.
    #[inline(always)]
    fn crossing<N: Number>(&self, rays: &Rays<N>) -> N {
        let normal = Vector::splat(self.normal);
        (Vector::splat(self.point) - rays.origin).dot(normal) / rays.direction.dot(normal)
    }
}

/// The x axis laid into the plane; where that is (nearly) the normal itself, the z axis.
fn pattern_axis(normal: Vec3) -> Vec3 {
    let axis = if normal.x.abs() < 0.9 { Vec3::X } else { Vec3::Z };
    (axis - normal * axis.dot(normal)).normalize()
}

impl<N: Number> Crossable<N> for Plane {
    #[inline(always)]
    fn first_crossing(&self, rays: &Rays<N>, min: N) -> Option<(N::Mask, N)> {
        let t = self.crossing(rays);
        // A ray along the plane divides by zero: infinite or NaN, and so not inside.
        Some((min.le(t) & t.le(N::splat(f32::MAX)), t))
    }

    #[inline(always)]
    fn boxes(&self) -> [Vector<N>; 2] {
        [Vector::splat(Vec3::NEG_INFINITY), Vector::splat(Vec3::INFINITY)]
    }
}

impl Surface for Plane {
    fn bounds(&self) -> Option<Bounds> {
        None
    }

    #[inline]
    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let t = self.crossing(&probe.rays);
        within.contains(t).then_some(t)
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let hit = ray.at(t);
        let off = (hit - self.point).dot(self.normal);
        let position = hit - self.normal * off;
        let seen_from_front = ray.direction.dot(self.normal) < 0.0;
        let (normal, side) = if seen_from_front { (self.normal, Side::Front) } else { (-self.normal, Side::Back) };
        let clearance = CLEARANCE * (largest_coordinate(position) + largest_coordinate(self.point));
        let from_point = position - self.point;
        let uv = Vec2::new(from_point.dot(self.u), from_point.dot(self.v));
        SurfacePoint {
            position,
            normal,
            facing: normal,
            side,
            clearance,
            uv,
            footprint: Vec2::ZERO,
            own_reflectance: None,
        }
    }

    /// A neighbour's ray p + t (d + e) reaches the plane where t changes by -t e.n / d.n, to first order (Igehy, Tracing
    /// Ray Differentials, 1999).
    fn footprint(&self, ray: &Ray, t: f32, steps: [Vec3; 2]) -> Vec2 {
        let d = ray.direction;
        let reach = |e: Vec3| {
            let moved = (e - d * (e.dot(self.normal) / d.dot(self.normal))) * t;
            Vec2::new(moved.dot(self.u), moved.dot(self.v)).abs()
        };
        reach(steps[0]) + reach(steps[1])
    }
}
