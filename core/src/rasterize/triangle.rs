//! Triangles in front of the eye, which are filled by their edge functions.

use super::depth_buffer::DepthBuffer;
use super::projection::{Projection, Rectangle, middles};
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Mask, Vector, set_bits};
use crate::simd::SimdKernel;
use glam::Vec3;
use std::array::from_fn;

/// The SIMD kernel that draws up to eight triangles.
///
/// Returns the number of tests, and the mask of triangles that it has not drawn, because they reach behind the eye or
/// far beyond the picture.
pub(super) struct DrawTriangles<'b> {
    pub(super) projection: &'b Projection,
    pub(super) triangles: &'b [([Vec3; 3], u32)],
    pub(super) buffer: &'b mut DepthBuffer,
}

/// The largest coordinate of a corner, in pixels, up to which f32 resolves a thousandth of a pixel.
const MAX_COORDINATE: f32 = 16_384.0;

/// A linear function a x + b y + c of the position for each of eight triangles.
struct Linear {
    a: F32x8,
    b: F32x8,
    c: F32x8,
}

/// The values that are computed once for eight triangles, and from which they are filled.
struct SetUp {
    /// The first columns, the columns after the last, the first rows, and the rows after the last.
    rectangles: [F32x8; 4],
    edges: [Linear; 3],
    /// 1 / t as a function of the offset from the first corner.
    inverse: Linear,
    first: [F32x8; 2],
    /// The least and greatest depth of the corners.
    depths: [F32x8; 2],
}

impl SimdKernel for DrawTriangles<'_> {
    type Output = (u64, u32);

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let Self { projection, triangles, buffer } = self;
        let used = (1 << triangles.len()) - 1;
        // Unused lanes have corners at infinity, whose bounds contain no pixel.
        let corner = |lane: usize, at: usize| triangles.get(lane).map_or(Vec3::INFINITY, |(corners, _)| corners[at]);
        let corners: [Vector<N>; 3] = from_fn(|at| {
            projection.in_camera_space(Vector::of(from_fn::<_, LANES, _>(|lane| corner(lane, at))).load())
        });
        let [(a, in_front_a), (b, in_front_b), (c, in_front_c)] = corners.map(|corner| placed(projection, corner));
        let drawable = (in_front_a & in_front_b & in_front_c).bits();
        let (set_up, visible) = set_up::<N>(projection, [a, b, c]);
        let mut tests = triangles.len() as u64;
        for lane in set_bits(visible & drawable & used) {
            tests += set_up.fill::<N>(lane, triangles[lane].1, buffer);
        }
        (tests, used & !drawable)
    }
}

/// Returns the positions of corners in pixels with their depths as z, and the mask of those that
/// are in front of the eye and not far from the picture.
#[inline(always)]
fn placed<N: Lanes>(projection: &Projection, corner: Vector<N>) -> (Vector<N>, N::Mask) {
    let inverse = N::splat(1.0) / corner.z;
    let place = |along: N, scale: f64, principal_point: f64| {
        along * inverse * N::splat(scale as f32) + N::splat(principal_point as f32)
    };
    let x = place(corner.x, projection.scale.x, projection.principal_point.x);
    let y = place(corner.y, projection.scale.y, projection.principal_point.y);
    let is_near = x.abs().max(y.abs()).le(N::splat(MAX_COORDINATE));
    (Vector { x, y, z: corner.z }, N::splat(0.0).lt(corner.z) & is_near)
}

/// Returns the values for filling, and the mask of triangles that may cover the middle of a pixel.
#[inline(always)]
fn set_up<N: Lanes>(projection: &Projection, [a, b, c]: [Vector<N>; 3]) -> (SetUp, u32) {
    let (least, greatest) = (a.min(b).min(c), a.max(b).max(c));
    let [left, right] = Projection::pixel_range(least.x, greatest.x, projection.size[0]);
    let [top, bottom] = Projection::pixel_range(least.y, greatest.y, projection.size[1]);
    let (to_b, to_c) = (b - a, c - a);
    let area = to_b.x * to_c.y - to_c.x * to_b.y;
    let one = N::splat(1.0);
    let sign = N::select(area.lt(N::splat(0.0)), -one, one);
    let [of_a, of_b, of_c] = [a, b, c].map(|corner| one / corner.z);
    let (from_a_to_b, from_a_to_c) = (of_b - of_a, of_c - of_a);
    // The inverse depth is a function of the offset from the first corner. As a function of the position in the
    // picture, most digits of its terms would cancel for a small triangle.
    let inverse = Linear {
        a: ((from_a_to_b * to_c.y - from_a_to_c * to_b.y) / area).store(),
        b: ((from_a_to_c * to_b.x - from_a_to_b * to_c.x) / area).store(),
        c: of_a.store(),
    };
    let visible = left.lt(right) & top.lt(bottom) & !area.eq(N::splat(0.0));
    let set_up = SetUp {
        rectangles: [left, right, top, bottom].map(N::store),
        edges: [edge(b, c, sign), edge(c, a, sign), edge(a, b, sign)],
        inverse,
        first: [a.x.store(), a.y.store()],
        depths: [least.z.store(), greatest.z.store()],
    };
    (set_up, visible.bits())
}

/// Returns the edge function of an edge, multiplied by `sign`.
///
/// Triangles that share an edge get the same numbers for it, one of them negated, so that they leave no gap.
#[inline(always)]
fn edge<N: Lanes>(from: Vector<N>, to: Vector<N>, sign: N) -> Linear {
    // The function is computed from the same end of the edge for both triangles that share it.
    let is_swapped = to.x.lt(from.x) | (to.x.eq(from.x) & to.y.lt(from.y));
    let (first, last) = (Vector::select(is_swapped, to, from), Vector::select(is_swapped, from, to));
    let sign = N::select(is_swapped, -sign, sign);
    let (a, b) = (first.y - last.y, last.x - first.x);
    let c = -(a * first.x + b * first.y);
    Linear { a: (a * sign).store(), b: (b * sign).store(), c: (c * sign).store() }
}

impl Linear {
    /// Returns a and b y + c of the triangle in lane `lane`, each in all lanes.
    #[inline(always)]
    fn row<N: Lanes>(&self, lane: usize, y: f32) -> [N; 2] {
        [N::splat(self.a.0[lane]), N::splat(self.b.0[lane] * y + self.c.0[lane])]
    }
}

impl SetUp {
    /// Fills the triangle of a lane, and returns the number of tested pixels.
    #[inline(always)]
    fn fill<N: Lanes>(&self, lane: usize, object: u32, buffer: &mut DepthBuffer) -> u64 {
        let [left, right, top, bottom] = [0, 1, 2, 3].map(|side: usize| self.rectangles[side].0[lane] as u32);
        let rectangle = Rectangle { x: [left, right], y: [top, bottom] };
        let object = N::splat(f32::from_bits(object));
        let [nearest, farthest] = [0, 1].map(|end: usize| N::splat(self.depths[end].0[lane]));
        let (first_x, first_y) = (N::splat(self.first[0].0[lane]), self.first[1].0[lane]);
        let [e, f, g] = &self.edges;
        for row in rectangle.rows() {
            let y = row as f32 + 0.5;
            let [e_x, e] = e.row::<N>(lane, y);
            let [f_x, f] = f.row::<N>(lane, y);
            let [g_x, g] = g.row::<N>(lane, y);
            let [inverse_x, inverse] = self.inverse.row::<N>(lane, y - first_y);
            for group in rectangle.groups() {
                let x = middles::<N>(group);
                let least = (e_x * x + e).min((f_x * x + f).min(g_x * x + g));
                let is_inside = N::splat(0.0).le(least);
                if is_inside.any() {
                    let t = N::splat(1.0) / (inverse_x * (x - first_x) + inverse);
                    // Rounding must not move a depth beyond those of the corners.
                    let t = t.max(nearest).min(farthest);
                    buffer.draw_group(buffer.group(group, row), is_inside, t, object);
                }
            }
        }
        rectangle.primitive_and_pixel_tests() - 1
    }
}
