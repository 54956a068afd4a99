//! Spheres: their exact bounds in the picture, and their intersection with the eye rays there.

use super::depth_buffer::DepthBuffer;
use super::projection::{Projection, Rectangle};
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Mask, Vector, set_bits};
use crate::shape::Sphere;
use crate::simd::SimdKernel;
use glam::Vec3;
use std::array::from_fn;

/// The SIMD kernel that draws up to eight spheres and returns the number of tests.
pub(super) struct DrawSpheres<'b> {
    pub(super) projection: &'b Projection,
    pub(super) spheres: &'b [(Sphere, u32)],
    pub(super) buffer: &'b mut DepthBuffer,
}

/// The least depth of a sphere's centre, in radii, at which its projection is bounded.
// The projection of a sphere that reaches behind the eye is unbounded.
const LEAST_DEPTH: f32 = 1.001;

/// The widening of bounds, in pixels, for the rounding of rays and bounds.
const MARGIN: f32 = 1.0 / 64.0;

/// The widening of bounds relative to the coordinates of pixels: eight units of 2^-24.
const RELATIVE_MARGIN: f32 = 8.0 / 16_777_216.0;

/// The factor on the least depth of a sphere, which rounding may have made too large.
const NEARER: f32 = 1.0 - RELATIVE_MARGIN;

impl SimdKernel for DrawSpheres<'_> {
    type Output = u64;

    #[inline(always)]
    fn run<N: Lanes>(self) -> u64 {
        let Self { projection, spheres, buffer } = self;
        // Unused lanes have spheres at infinity, whose bounds are NaN and contain no pixel.
        let center = |lane: usize| spheres.get(lane).map_or(Vec3::INFINITY, |(sphere, _)| sphere.center());
        let radius = |lane: usize| spheres.get(lane).map_or(1.0, |(sphere, _)| sphere.radius());
        let (centers, radii) = (Vector::of(from_fn::<_, LANES, _>(center)), F32x8(from_fn(radius)));
        let (rectangles, visible) = rectangles::<N>(projection, centers.load(), N::load(&radii));
        let mut tests = spheres.len() as u64;
        for lane in set_bits(visible).filter(|&lane| lane < spheres.len()) {
            let rectangle = Rectangle {
                x: [rectangles[0].0[lane] as u32, rectangles[1].0[lane] as u32],
                y: [rectangles[2].0[lane] as u32, rectangles[3].0[lane] as u32],
            };
            tests += rectangle.primitive_and_pixel_tests() - 1;
            let (sphere, object) = &spheres[lane];
            draw::<N>(projection, rectangle, sphere, *object, buffer);
        }
        tests
    }
}

/// Returns the bounds of spheres in pixels, and the mask of spheres that may cover the middle of a
/// pixel.
///
/// The bounds are the first columns, the columns after the last, the first rows, and the rows after the last.
///
/// In the plane of x and z, the lines through the eye that touch a sphere with the centre (x, z) have the slopes s with
/// (x - s z)^2 = r^2 (1 + s^2).
#[inline(always)]
fn rectangles<N: Lanes>(projection: &Projection, centers: Vector<N>, r: N) -> ([F32x8; 4], u32) {
    let Vector { x, y, z } = projection.in_camera_space(centers);
    let (is_ahead, is_behind) = ((r * N::splat(LEAST_DEPTH)).lt(z), z.le(-r));
    // z^2 - r^2, written as a product to avoid cancellation.
    let squared = (z - r) * (z + r);
    let [width, height] = projection.size;
    let Projection { scale, principal_point, .. } = projection;
    let across = extent(x, z, r, squared, [scale.x as f32, principal_point.x as f32]);
    let down = extent(y, z, r, squared, [scale.y as f32, principal_point.y as f32]);
    let [left, right] = range_or_whole(is_ahead, Projection::pixel_range(across[0], across[1], width), width);
    let [top, bottom] = range_or_whole(is_ahead, Projection::pixel_range(down[0], down[1], height), height);
    let visible = left.lt(right) & top.lt(bottom) & !is_behind;
    ([left.store(), right.store(), top.store(), bottom.store()], visible.bits())
}

/// Returns the bounds of spheres along an axis of the picture, in pixels, widened for rounding.
#[inline(always)]
fn extent<N: Lanes>(along: N, z: N, r: N, squared: N, [scale, principal_point]: [f32; 2]) -> [N; 2] {
    let reach = r * (along * along + squared).sqrt();
    let (scale, principal_in_lanes) = (N::splat(scale) / squared, N::splat(principal_point));
    let (a, b) = ((along * z - reach) * scale + principal_in_lanes, (along * z + reach) * scale + principal_in_lanes);
    let (min, max) = (a.min(b), a.max(b));
    let margin = N::splat(MARGIN + RELATIVE_MARGIN * principal_point.abs())
        + N::splat(RELATIVE_MARGIN) * min.abs().max(max.abs());
    [min - margin, max + margin]
}

/// Returns the given range in the lanes of the mask, and the whole range 0 to `size` in the others.
#[inline(always)]
fn range_or_whole<N: Lanes>(is_bounded: N::Mask, [first, end]: [N; 2], size: u32) -> [N; 2] {
    [N::select(is_bounded, first, N::splat(0.0)), N::select(is_bounded, end, N::splat(size as f32))]
}

/// Draws a sphere at the pixels of a rectangle whose rays cross it, as `shape::sphere` does.
// All rays start at the eye, so the parts of the formula of `shape::sphere` without the direction are computed once.
#[inline(always)]
fn draw<N: Lanes>(
    projection: &Projection,
    rectangle: Rectangle,
    sphere: &Sphere,
    object: u32,
    buffer: &mut DepthBuffer,
) {
    let (center, r) = (sphere.center() - projection.eye, sphere.radius());
    let (to_center, zero) = (Vector::<N>::splat(center), N::splat(0.0));
    let (squared_radius, power) = (N::splat(r * r), N::splat(center.dot(center) - r * r));
    let object = N::splat(f32::from_bits(object));
    let nearest = N::splat((projection.in_camera_space(Vector::<f32>::splat(sphere.center())).z - r) * NEARER);
    for y in rectangle.rows() {
        for group in rectangle.groups() {
            let index = buffer.group(group, y);
            // Nearer objects hide the sphere in all eight pixels.
            if !nearest.lt(buffer.depths(index)).any() {
                continue;
            }
            let direction = projection.directions::<N>(group, y);
            let (squared_length, along) = (direction.dot(direction), direction.dot(to_center));
            let inverse = N::splat(1.0) / squared_length;
            let to_line = direction * (along * inverse) - to_center;
            let under_root = squared_radius - to_line.dot(to_line);
            let crosses = zero.le(under_root);
            if !crosses.any() {
                continue;
            }
            let root = (squared_length * under_root).sqrt();
            // Adds two terms of the same sign, so that they do not cancel.
            let q = N::select(along.lt(zero), along - root, along + root);
            let (t0, t1) = (power / q, q * inverse);
            let (first, second) = (t0.min(t1), t0.max(t1));
            let t = N::select(zero.le(first), first, second);
            buffer.draw_group(index, crosses & zero.le(t), t, object);
        }
    }
}
