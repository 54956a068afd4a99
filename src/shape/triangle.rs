//! Ray-triangle intersection, without gaps between triangles that share an edge.

use super::{CLEARANCE, Side, Surface, SurfacePoint, largest_coordinate};
use crate::bounds::Bounds;
use crate::ray::{Interval, Probe, Ray};
use glam::{Vec2, Vec3};

/// All points of the plane through three corners that lie between them. It is seen from both sides; the front is the
/// one from which the corners go round counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    corners: [Vec3; 3],
}

/// Where a line crosses a triangle's plane: how much of each corner is in that point, all of them or none with a sign.
/// Not divided by their sum.
struct Crossing {
    weights: Vec3,
    sum: f32,
    /// t times the sum.
    t: f32,
}

impl Triangle {
    /// The triangle between these corners. If they lie on one line, no ray meets it.
    ///
    /// # Panics
    /// In debug builds, unless the corners are finite.
    pub fn new(corners: [Vec3; 3]) -> Self {
        debug_assert!(corners.iter().all(|corner| corner.is_finite()), "a triangle's corners are finite");
        Self { corners }
    }

    /// The corners.
    pub fn corners(&self) -> [Vec3; 3] {
        self.corners
    }

    /// The test of Woop, Benthin and Wald (Watertight Ray/Triangle Intersection, JCGT 2013). In the ray's own coordinates
    /// it runs along z, and it is inside if the origin of the xy plane lies on the same side of all three edges, or on
    /// them. On which side is decided exactly: rounding may turn neither of two products past the other, and where they
    /// come out equal, f64 holds them whole. As the neighbour comes to the same answer with the sign turned, no ray slips
    /// through between them.
    fn crossing(&self, probe: &Probe) -> Option<Crossing> {
        let [a, b, c] = self.corners.map(|corner| probe.shear().apply(corner - probe.ray.origin));
        let weights = Vec3::new(side(c, b), side(a, c), side(b, a));
        if weights.cmplt(Vec3::ZERO).any() && weights.cmpgt(Vec3::ZERO).any() {
            return None;
        }
        let sum = weights.x + weights.y + weights.z;
        // Seen edge on, or without an area.
        if sum == 0.0 {
            return None;
        }
        Some(Crossing { weights, sum, t: weights.dot(Vec3::new(a.z, b.z, c.z)) })
    }

    /// Where on the triangle the line meets it: the shares of the second and the third corner.
    pub(super) fn shares(&self, ray: &Ray) -> Vec2 {
        self.crossing(&Probe::new(*ray)).map_or(Vec2::ZERO, |crossing| {
            let Vec3 { y, z, .. } = crossing.weights / crossing.sum;
            Vec2::new(y, z)
        })
    }

    /// The unit normal of the front; of a triangle without an area, any.
    pub(super) fn front_normal(&self) -> Vec3 {
        let [a, b, c] = self.corners;
        let (to_b, to_c) = (b - a, c - a);
        // Not too small to be squared.
        let scale = 1.0 / largest_coordinate(to_b).max(largest_coordinate(to_c));
        (to_b * scale).cross(to_c * scale).normalize_or(Vec3::Y)
    }
}

/// Twice the area of the triangle between the origin and two points of the xy plane, by whose sign one sees on which side
/// of the edge the origin is.
fn side(from: Vec3, to: Vec3) -> f32 {
    let side = from.x * to.y - from.y * to.x;
    if side == 0.0 { exact_side(from, to) } else { side }
}

/// The same where f32 cannot tell.
#[cold]
fn exact_side(from: Vec3, to: Vec3) -> f32 {
    (f64::from(from.x) * f64::from(to.y) - f64::from(from.y) * f64::from(to.x)) as f32
}

impl Surface for Triangle {
    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds::of(self.corners))
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let Crossing { sum, t, .. } = self.crossing(probe)?;
        Bounds::of(self.corners).crossed(probe).nearest(t / sum).filter(|&t| within.contains(t))
    }

    fn at_crossing(&self, ray: &Ray, _: f32) -> SurfacePoint {
        let [a, b, c] = self.corners;
        let shares = self.shares(ray);
        let position = a + (b - a) * shares.x + (c - a) * shares.y;
        let front = self.front_normal();
        let seen_from_front = ray.direction.dot(front) < 0.0;
        let (normal, side) = if seen_from_front { (front, Side::Front) } else { (-front, Side::Back) };
        let largest = self.corners.into_iter().map(largest_coordinate).fold(0.0, f32::max);
        SurfacePoint {
            position,
            normal,
            facing: normal,
            side,
            clearance: CLEARANCE * largest,
            uv: shares,
            footprint: Vec2::ZERO,
            own_reflectance: None,
        }
    }
}
