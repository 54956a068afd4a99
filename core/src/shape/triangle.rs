//! Watertight ray-triangle intersection: no ray passes between triangles that share an edge.
//!
//! The numbered statements on error bounds are in `culling.md`.

use super::described::size_in_words;
use super::equation::finite_quotient;
use super::placement::{Placeable, Placement};
use super::{
    AtCrossing, CheckedShape, Crossable, Described, Equation, EquationStep, Meshes, Points, Shape, SoaLeaf, Surface,
    SurfacePoint,
};
use crate::bounds::{Bounds, crossed};
use crate::checks::{self, SceneFault};
use crate::lanes::{F32x8, Lanes, Mask, Number, Vector};
use crate::ray::{Interval, Probe, ProjectionCenter, Ray, Rays, clamp_keeping_nan, sheared_in_f64};
use crate::scene_text::{Span, SyntaxNode};
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenVector};
use glam::{DVec3, Vec3};
use std::array::from_fn;

mod edge_functions;

pub use edge_functions::EdgeFunctions;

/// A triangle: all points between three corners.
///
/// It is visible from both sides; its front is the side from which the corners are in counterclockwise order.
///
/// ```
/// use glam::Vec3;
/// use termtrace::Triangle;
///
/// let triangle = Triangle::new([Vec3::ZERO, Vec3::X, Vec3::Y])?;
/// assert!(Triangle::new([Vec3::ZERO, Vec3::X, 2.0 * Vec3::X]).is_err(), "the corners lie on a line");
/// # let _ = triangle;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    corners: [Vec3; 3],
}

/// The corners of one triangle, or of eight in SoA layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleN<N>([Vector<N>; 3]);

/// The crossing of a ray's line and a triangle's plane, not yet divided by the sum of the weights.
///
/// Rays that miss thus need no division.
#[derive(Clone, Copy)]
struct UnnormalizedCrossing<N> {
    /// The unnormalized barycentric weights of the corners; all have one sign.
    weights: Vector<N>,
    sum: N,
    /// The product of t and `sum`.
    t: N,
}

impl<N: Number> UnnormalizedCrossing<N> {
    #[inline(always)]
    fn from_weights(sheared_corners: [Vector<N>; 3], weights: Vector<N>) -> Self {
        let [a, b, c] = sheared_corners;
        let sum = weights.x + weights.y + weights.z;
        Self { weights, sum, t: weights.dot(Vector { x: a.z, y: b.z, z: c.z }) }
    }
}

impl<N: Number> TriangleN<N> {
    /// Returns the mask of rays whose lines hit, and their crossings, by the method of Woop,
    /// Benthin and Wald.
    ///
    /// (Watertight Ray/Triangle Intersection, JCGT 2013.)
    ///
    /// In sheared coordinates the ray runs along z. It hits if the origin of the xy plane lies on the same side of all
    /// three edges, or on them. If a weight is within its error bound, so that its sign is uncertain, f64 decides.
    // With the signs of f32 alone, one of a million rays hit a triangle of the dragon that it misses by 1.4e-6 of the
    // triangle's size.
    #[inline(always)]
    fn crossing(&self, rays: &Rays<N>) -> Option<(N::Mask, UnnormalizedCrossing<N>)> {
        let corners = self.sheared_corners(rays);
        self.crossing_from_weights(corners, weights(corners), rays)
    }

    /// Computes [`crossing`](Self::crossing) for rays whose [`weight_error_bound`] is at most
    /// `error_bound`.
    // If `error_bound` is enough to decide all lanes, the rays' own bounds, a third of the work of a test, are not
    // computed: the bunny takes 0.95 times as long.
    #[inline(always)]
    fn crossing_with_bound(&self, rays: &Rays<N>, error_bound: N) -> Option<(N::Mask, UnnormalizedCrossing<N>)> {
        let corners = self.sheared_corners(rays);
        let weights = weights(corners);
        let [agree, differ] = certain_hits_and_misses(weights, error_bound);
        // If `error_bound` leaves a sign uncertain in any lane, each ray's own bound is computed, in all lanes: a
        // branch cannot be taken by one lane alone.
        if !(agree | differ).all() {
            return self.crossing_from_weights(corners, weights, rays);
        }
        agree.any().then(|| (agree, UnnormalizedCrossing::from_weights(corners, weights)))
    }

    /// Returns the corners in the rays' sheared coordinates.
    #[inline(always)]
    fn sheared_corners(&self, Rays { origin, shear, .. }: &Rays<N>) -> [Vector<N>; 3] {
        let [a, b, c] = self.0;
        [shear.apply(a - *origin), shear.apply(b - *origin), shear.apply(c - *origin)]
    }

    /// Computes the crossing from sheared corners and their weights.
    #[inline(always)]
    fn crossing_from_weights(
        &self,
        corners: [Vector<N>; 3],
        weights: Vector<N>,
        rays: &Rays<N>,
    ) -> Option<(N::Mask, UnnormalizedCrossing<N>)> {
        let [agree, differ] = certain_hits_and_misses(weights, weight_error_bound(corners, rays.shear.length));
        // Unused lanes have infinite corners, and must not count as uncertain.
        let is_uncertain = !(agree | differ) & self.0[0].x.le(N::splat(f32::MAX));
        if !(agree | is_uncertain).any() {
            return None;
        }
        let crossing = UnnormalizedCrossing::from_weights(corners, weights);
        if is_uncertain.any() {
            Some(self.resolve_in_f64(agree, is_uncertain, crossing, rays))
        } else {
            Some((agree, crossing))
        }
    }

    /// Divides the crossing, clamps its t to the triangle's box, and rejects t below `min_t`.
    ///
    /// Returns the result of [`first_crossing`](Crossable::first_crossing).
    #[inline(always)]
    fn normalized_clamped_crossing(
        &self,
        min_t: N,
        rays: &Rays<N>,
        (crosses, crossing): (N::Mask, UnnormalizedCrossing<N>),
    ) -> Option<(N::Mask, N)> {
        // The test divides here for the first time; most tests end before.
        let t = crossing.t / crossing.sum;
        // Crossings before `min_t` are rejected before the box test, because a shadow ray always crosses the plane of
        // the triangle that it starts on: pictures with shadows are 1.3 to 1.9 % faster.
        let crosses = crosses & min_t.le(t);
        if !crosses.any() {
            return None;
        }
        // The clamp makes hits independent of the tree (`culling.md`, 2).
        let [start, end] = crossed(self.boxes(), rays);
        let t = clamp_keeping_nan(start, end, t);
        Some((crosses & start.le(end) & min_t.le(t), t))
    }

    /// Replaces the results of uncertain lanes by those of [`crossing_in_f64`]; `agree` is the mask
    /// of certain hits.
    #[inline(always)]
    fn resolve_in_f64(
        &self,
        agree: N::Mask,
        is_uncertain: N::Mask,
        UnnormalizedCrossing { weights, sum, t }: UnnormalizedCrossing<N>,
        rays: &Rays<N>,
    ) -> (N::Mask, UnnormalizedCrossing<N>) {
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        let ([a, b, c], o, d) = (self.0, rays.origin, rays.direction);
        // `crossing_in_f64` returns at once for lanes that are certain.
        let is_active = N::select(is_uncertain, one, zero);
        let numbers = [is_active, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, o.x, o.y, o.z, d.x, d.y, d.z];
        let [crosses, x, y, z, exact_t] = N::map_lanes(numbers, crossing_in_f64);
        let weights = Vector::select(is_uncertain, Vector { x, y, z }, weights);
        let crossing = UnnormalizedCrossing {
            weights,
            sum: N::select(is_uncertain, one, sum),
            t: N::select(is_uncertain, exact_t, t),
        };
        (agree | (is_uncertain & zero.lt(crosses)), crossing)
    }
}

/// Tests one lane in f64.
///
/// Returns 1 for a hit, else 0, then the three weights and t, all divided by the sum of the weights to fit in f32.
///
/// The sign of each weight is that of the exact weight or zero, and triangles that share an edge get the same sign for
/// it (`culling.md`, 8).
// The function is cold, because only one ray of thousands needs it.
#[cold]
fn crossing_in_f64([is_active, ax, ay, az, bx, by, bz, cx, cy, cz, ox, oy, oz, dx, dy, dz]: [f32; 16]) -> [f32; 5] {
    if is_active == 0.0 {
        return [0.0; 5];
    }
    let point = |x, y, z| {
        let from_origin = Vec3::new(x, y, z).as_dvec3() - Vec3::new(ox, oy, oz).as_dvec3();
        sheared_in_f64(from_origin, Vec3::new(dx, dy, dz))
    };
    let [a, b, c] = [point(ax, ay, az), point(bx, by, bz), point(cx, cy, cz)];
    let area = |from: DVec3, to: DVec3| from.x * to.y - from.y * to.x;
    let weights = DVec3::new(area(c, b), area(a, c), area(b, a));
    let differ = weights.min_element() < 0.0 && weights.max_element() > 0.0;
    let sum = weights.x + weights.y + weights.z;
    // The sum is zero for triangles that are seen edge-on or have no area; these are not hit.
    if differ || sum == 0.0 {
        return [0.0; 5];
    }
    let Vec3 { x, y, z } = (weights / sum).as_vec3();
    [1.0, x, y, z, (weights.dot(DVec3::new(a.z, b.z, c.z)) / sum) as f32]
}

/// Returns the weight of each corner: the edge function of the opposite edge.
///
/// It is twice the signed area of the triangle of the other two corners and the origin of the xy plane. A neighbouring
/// triangle computes the same number for a shared edge, negated.
#[inline(always)]
fn weights<N: Number>([a, b, c]: [Vector<N>; 3]) -> Vector<N> {
    Vector { x: doubled_signed_area(c, b), y: doubled_signed_area(a, c), z: doubled_signed_area(b, a) }
}

/// Returns twice the signed area of the triangle of two points and the origin of the xy plane.
#[inline(always)]
fn doubled_signed_area<N: Number>(from: Vector<N>, to: Vector<N>) -> N {
    from.x * to.y - from.y * to.x
}

/// Returns an upper bound of the error of the weights in f32 (`culling.md`, 7).
///
/// It is 24 s (s + r) units of 2^-24, plus the least normal number for underflow. s is the largest x or y, and r the
/// largest z times `length`, the length of the ray's direction along its dominant axis.
#[inline(always)]
fn weight_error_bound<N: Number>([a, b, c]: [Vector<N>; 3], length: N) -> N {
    let across = a.x.abs().max(a.y.abs()).max(b.x.abs().max(b.y.abs())).max(c.x.abs().max(c.y.abs()));
    let along = a.z.abs().max(b.z.abs()).max(c.z.abs());
    across * (across + along * length) * N::splat(24.0 / 16_777_216.0) + N::splat(f32::MIN_POSITIVE)
}

/// Returns the mask of lanes whose weights certainly have one sign, and the mask of lanes in which
/// two weights certainly differ in sign.
///
/// Only weights beyond the error bound have a certain sign.
#[inline(always)]
fn certain_hits_and_misses<N: Number>(Vector { x, y, z }: Vector<N>, error_bound: N) -> [N::Mask; 2] {
    // Both masks follow from the minimum and the maximum. Sign bits alone could not be compared with the error bound.
    let (least, greatest) = (x.min(y.min(z)), x.max(y.max(z)));
    let agree = error_bound.lt(least) | greatest.lt(-error_bound);
    [agree, least.lt(-error_bound) & error_bound.lt(greatest)]
}

impl<N: Number> Crossable<N> for TriangleN<N> {
    #[inline(always)]
    fn first_crossing(&self, rays: &Rays<N>, min: N) -> Option<(N::Mask, N)> {
        self.normalized_clamped_crossing(min, rays, self.crossing(rays)?)
    }

    #[inline(always)]
    fn first_crossing_in_packet(&self, rays: &Rays<N>, [min, _]: [N; 2], error_bound: N) -> Option<(N::Mask, N)> {
        self.normalized_clamped_crossing(min, rays, self.crossing_with_bound(rays, error_bound)?)
    }

    #[inline(always)]
    fn boxes(&self) -> [Vector<N>; 2] {
        let [a, b, c] = self.0;
        [a.min(b).min(c), a.max(b).max(c)]
    }
}

impl SoaLeaf for TriangleN<F32x8> {
    type Shape = Triangle;
    type Of<'l, N: Lanes> = TriangleN<N>;

    const NEED_SHEAR: bool = true;

    const HAVE_EDGE_FUNCTIONS: bool = true;

    #[inline(always)]
    fn edge_functions<N: Lanes>(&self, projection_center: &ProjectionCenter<N>) -> Option<EdgeFunctions> {
        Some(self.one_per_lane::<N>().edge_functions(projection_center))
    }

    fn of(shapes: &[Triangle]) -> Self {
        // Unused lanes get infinite corners: their weights are NaN, and `crossing_from_weights` excludes them from f64.
        let corners = |lane: usize| shapes.get(lane).map_or([Vec3::INFINITY; 3], Triangle::corners);
        Self(from_fn(|corner| Vector::of(from_fn(|lane| corners(lane)[corner]))))
    }

    #[inline(always)]
    fn one_per_lane<N: Lanes>(&self) -> TriangleN<N> {
        TriangleN([self.0[0].load(), self.0[1].load(), self.0[2].load()])
    }

    #[inline(always)]
    fn splat<N: Lanes>(&self, lane: usize) -> TriangleN<N> {
        let [a, b, c] = &self.0;
        TriangleN([Vector::splat(a.of_lane(lane)), Vector::splat(b.of_lane(lane)), Vector::splat(c.of_lane(lane))])
    }

    #[inline(always)]
    fn gather<N: Lanes>(&self, lanes: N) -> TriangleN<N> {
        let [a, b, c] = self.one_per_lane::<N>().0;
        TriangleN([a.gather(lanes), b.gather(lanes), c.gather(lanes)])
    }

    #[inline(always)]
    fn select<'l, N: Lanes>(
        mask: N::Mask,
        TriangleN([a, b, c]): TriangleN<N>,
        TriangleN(no): TriangleN<N>,
    ) -> TriangleN<N>
    where
        Self: 'l,
    {
        let of_two = |yes, no| Vector::select(mask, yes, no);
        TriangleN([of_two(a, no[0]), of_two(b, no[1]), of_two(c, no[2])])
    }
}

impl Triangle {
    /// Returns the triangle with these corners.
    ///
    /// # Errors
    /// Unless all coordinates lie within ±1e9, and the corners not on one line.
    pub fn new(corners: [Vec3; 3]) -> Result<Self, SceneFault> {
        for (name, corner) in ["corners[0]", "corners[1]", "corners[2]"].into_iter().zip(corners) {
            checks::checked_point(name, corner)?;
        }
        let corners = checks::corners(corners).map_err(|message| SceneFault::new("corners", message))?;
        Ok(Self { corners })
    }

    /// Returns the triangle without checking the corners.
    ///
    /// If they lie on one line, as they may in a mesh, no ray hits the triangle.
    #[doc(hidden)]
    #[inline]
    pub fn unchecked(corners: [Vec3; 3]) -> Self {
        Self { corners }
    }

    /// Returns the corners.
    #[doc(hidden)]
    pub fn corners(&self) -> [Vec3; 3] {
        self.corners
    }

    fn as_one_lane(&self) -> TriangleN<f32> {
        let [a, b, c] = self.corners;
        TriangleN([Vector::splat(a), Vector::splat(b), Vector::splat(c)])
    }
}

/// Returns the unit normal of the front, given the edges from corner a to b and c.
///
/// For a triangle without area it is any unit vector.
#[inline(always)]
fn front_normal<N: Number>(to_b: Vector<N>, to_c: Vector<N>) -> Vector<N> {
    // The edges are first scaled by their largest coordinate, because the squared length of the normal is a fourth
    // power of theirs, which underflows for edges below 1e-9.
    let scale = N::splat(1.0) / to_b.max_abs_coordinate().max(to_c.max_abs_coordinate());
    let normal = (to_b * scale).cross(to_c * scale);
    let factor = N::splat(1.0) / normal.dot(normal).sqrt();
    let is_direction = N::splat(0.0).lt(factor) & factor.le(N::splat(f32::MAX));
    Vector::select(is_direction, normal * factor, Vector::splat(Vec3::Y))
}

impl<N: Number> AtCrossing<N> for TriangleN<N> {
    #[inline(always)]
    fn points_at(&self, rays: &Rays<N>, _: N) -> Points<N> {
        let [a, b, c] = self.0;
        let (to_b, to_c) = (b - a, c - a);
        let zero = N::splat(0.0);
        // The crossing is computed again for its weights, as hits store only t and the primitive.
        let uv = match self.crossing(rays) {
            Some((crosses, UnnormalizedCrossing { weights, sum, .. })) => {
                [N::select(crosses, weights.y / sum, zero), N::select(crosses, weights.z / sum, zero)]
            }
            None => [zero; 2],
        };
        let position = a + to_b * uv[0] + to_c * uv[1];
        let largest = zero.max(a.max_abs_coordinate()).max(b.max_abs_coordinate()).max(c.max_abs_coordinate());
        Points::seen_by(rays, position, front_normal(to_b, to_c), largest, uv)
    }
}

impl Surface for Triangle {
    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds::of(self.corners))
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let (crosses, t) = self.as_one_lane().first_crossing(&probe.rays, within.min)?;
        (crosses && t <= within.max).then_some(t)
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        AtCrossing::points_at(&self.as_one_lane(), &Probe::new(*ray).rays, t).point()
    }
}

impl Described for Triangle {
    const KIND: &'static str = "triangle";

    fn described(&self, color: &str) -> String {
        format!("a {color} triangle, {}", size_in_words(&Bounds::of(self.corners)))
    }

    /// Solves for the crossing with the triangle's plane, and computes its barycentric shares.
    ///
    /// A negative share means that the crossing lies outside the triangle.
    fn equation(&self, ray: &Ray) -> Equation {
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let [a, b, c] = self.corners.map(Vec3::as_dvec3);
        let n = (b - a).cross(c - a);
        let t = finite_quotient((a - o).dot(n), d.dot(n));
        let p = o + d * t.unwrap_or(0.0);
        // The share of a corner: the area of the triangle of p and the opposite edge, as a fraction of the whole.
        let share =
            |from: DVec3, to: DVec3| finite_quotient((to - from).cross(p - from).dot(n), n.dot(n)).unwrap_or(0.0);
        let shares = vec![share(b, c), share(c, a), share(a, b)];
        Equation {
            is_outside: shares.iter().any(|&share| share < 0.0),
            steps: vec![
                EquationStep::Text("(o + t d - a).n = 0"),
                EquationStep::Value("t = (a-o).n / d.n", t.unwrap_or_default()),
                EquationStep::Text("p = sum of share * corner, with"),
                EquationStep::Values("    ", "", shares),
            ],
            roots: t.into_iter().collect(),
            without_root: "parallel",
        }
    }
}

/// A triangle as written: `Triangle(corners: [..., ..., ...])`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenTriangle {
    /// The three corners.
    pub corners: Option<[WrittenVector; 3]>,
}

impl InSceneFile for Triangle {
    type Written = WrittenTriangle;

    const NAME: &'static str = "Triangle";
    const OWNER: &'static str = "a Triangle";
    const FORM: &'static str = "Triangle(corners: [(x, y, z), (x, y, z), (x, y, z)])";
    const FIELDS: &'static [&'static str] = &["corners"];
    const SUMMARY: &'static str = "A triangle, seen from both sides.";
    const MEANINGS: &'static [&'static str] = &["three points"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenTriangle {
        WrittenTriangle { corners: reader.required(fields, "corners", read_corners) }
    }
}

impl CheckedShape for Triangle {
    const HAS_INSIDE: bool = false;

    fn check(written: &WrittenTriangle, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let all = written.corners?;
        let [a, b, c] = all.map(|corner| validator.point(corner));
        let whole = Span { start: all[0].span.start, end: all[2].span.end };
        let corners = validator.accept(whole, checks::corners([a?, b?, c?]))?;
        Some(Self { corners }.into())
    }
}

impl Placeable for Triangle {
    /// Maps the corners, in the opposite order if mirrored, so that the front stays in front.
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let (map, is_mirrored) = (placement.map(), placement.scale.element_product() < 0.0);
        let [a, b, c] = self.corners.map(|corner| map.point(corner.as_dvec3()).as_vec3());
        let corners = checks::corners(if is_mirrored { [a, c, b] } else { [a, b, c] });
        Some(Self { corners: corners.ok()? }.into())
    }
}

fn read_corners(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<[WrittenVector; 3]> {
    const FORM: &str = "three corners [(x, y, z), (x, y, z), (x, y, z)]";
    let [a, b, c] = reader.list(node, FORM)? else {
        reader.mismatch(node, FORM);
        return None;
    };
    let corners = [a, b, c].map(|corner| reader.point(corner));
    let [Some(a), Some(b), Some(c)] = corners else { return None };
    Some([a, b, c])
}

#[cfg(all(test, unit_tests))]
mod tests;
