//! Ray-triangle intersection, without gaps between triangles that share an edge.

use super::{CLEARANCE, Side, Surface, SurfacePoint, largest_coordinate};
use crate::bounds::Bounds;
use crate::lanes::{Number, Vector};
use crate::ray::{Interval, Probe, Ray};
use glam::{Vec2, Vec3};

/// All points of the plane through three corners that lie between them. It is seen from both sides; the front is the
/// one from which the corners go round counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    corners: [Vec3; 3],
}

/// Where a line crosses a triangle's plane. Nothing here is divided by the sum of the weights.
struct Crossing<N> {
    /// How much of each corner is in that point, all of them or none with a sign.
    weights: Vector<N>,
    sum: N,
    /// t times the sum.
    t: N,
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
    /// them. Where f32 cannot tell on which, f64 does.
    #[inline]
    fn crossing(&self, probe: &Probe) -> Option<Crossing<f32>> {
        let corners = self.corners.map(|corner| probe.sheared(corner));
        let weights = weights(corners);
        let [agree, differ] = signs(weights, doubt(corners, probe.shear().length()));
        match (agree, differ) {
            (true, _) => Some(Crossing::of(weights, corners)),
            (_, true) => None,
            _ => self.close_crossing(probe),
        }
    }

    /// The same of a line that passes close to an edge. Each corner is one point for all triangles that have it; and on
    /// which side of an edge the origin lies is decided as it is for these points on paper, but that it may come out as on
    /// the edge: rounding may turn neither of two products past the other. As that is on both sides, no ray slips through
    /// between neighbours.
    #[cold]
    fn close_crossing(&self, probe: &Probe) -> Option<Crossing<f32>> {
        let corners = self.corners.map(|corner| probe.sheared_exactly(corner));
        let weights = weights(corners);
        let [_, differ] = signs(weights, 0.0);
        let Crossing { sum, t, .. } = Crossing::of(weights, corners);
        // Seen edge on, or without an area.
        if differ || sum == 0.0 {
            return None;
        }
        // Divided, they are what f32 can hold.
        let [x, y, z, t] = [weights.x, weights.y, weights.z, t].map(|value| (value / sum) as f32);
        Some(Crossing { weights: Vector { x, y, z }, sum: 1.0, t })
    }

    /// Where on the triangle the line meets it: the shares of the second and the third corner.
    pub(super) fn shares(&self, ray: &Ray) -> Vec2 {
        self.crossing(&Probe::new(*ray)).map_or(Vec2::ZERO, |crossing| {
            let Vector { y, z, .. } = crossing.weights;
            Vec2::new(y, z) / crossing.sum
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

impl<N: Number> Crossing<N> {
    #[inline(always)]
    fn of(weights: Vector<N>, [a, b, c]: [Vector<N>; 3]) -> Self {
        let Vector { x, y, z } = weights;
        Self { weights, sum: x + y + z, t: weights.dot(Vector { x: a.z, y: b.z, z: c.z }) }
    }
}

/// For each corner twice the area of the triangle between the other two and the origin of the xy plane, with the sign that
/// tells on which side of this edge the origin is. The other triangle of the edge comes to the same with the sign turned.
#[inline(always)]
fn weights<N: Number>([a, b, c]: [Vector<N>; 3]) -> Vector<N> {
    let area = |from: Vector<N>, to: Vector<N>| from.x * to.y - from.y * to.x;
    Vector { x: area(c, b), y: area(a, c), z: area(b, a) }
}

/// By how much the weights may be off in f32, at most.
///
/// With s for the largest x or y and r for the largest z, in lengths of the direction, each x and y is off by 2 s + 4 r
/// units of 2^-24 ([`Shear::apply`](crate::ray::Shear::apply)). Of a difference of two products that makes 4 s times as
/// much, and their own rounding 4 s s: 12 s s + 16 s r. The products of two such errors add a sixth at most: where they are
/// more, s is less than 12 units of r, and no weight, all of them less than 2 s s, is beyond doubt. The last term is for
/// numbers that are too small for f32 to round so.
#[inline(always)]
fn doubt<N: Number>(corners: [Vector<N>; 3], length: N) -> N {
    let [a, b, c] = corners.map(|Vector { x, y, z }| [x.abs().max(y.abs()), z.abs()]);
    let [across, along] = [0, 1].map(|axis| a[axis].max(b[axis].max(c[axis])));
    across * (across + along * length) * N::splat(24.0 / 16_777_216.0) + N::splat(f32::MIN_POSITIVE)
}

/// Whether all of them have one sign, and whether two have different ones: those that are more than `doubt` off zero.
#[inline(always)]
fn signs<N: Number>(Vector { x, y, z }: Vector<N>, doubt: N) -> [N::Mask; 2] {
    let (least, greatest) = (x.min(y.min(z)), x.max(y.max(z)));
    let agree = doubt.lt(least) | greatest.lt(-doubt);
    [agree, least.lt(-doubt) & doubt.lt(greatest)]
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
