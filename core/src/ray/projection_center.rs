//! Packets whose rays all meet in one point.

use super::{DominantAxis, Rays, Shear};
use crate::lanes::{LANES, Lanes, Mask, Vector};

/// The projection center of a packet: the eye, or a light.
///
/// Seen from the projection center, each ray is a point of an image plane, its *offset*, and culling compares offsets.
///
/// The numbered statements on error bounds are in `culling.md`.
#[derive(Clone, Copy, Debug)]
pub struct ProjectionCenter<N: Lanes> {
    origin: Vector<N>,
    /// An upper bound of the distance of a ray's line from `origin` along any axis, times 2^24
    /// (statement 9 of `culling.md`).
    pub origin_error: N,
    axis: DominantAxis<N::Mask>,
    /// The slopes in x and y, per unit of the dominant axis, of a ray in the middle of the packet.
    slope: [N; 2],
    /// The center of each group's offsets in x and y.
    ///
    /// A ray's offset is the ray's slope minus `slope`.
    pub centers: [N; 2],
    /// Half of the width and height of each group's offsets, which lie around `centers`.
    pub half_extents: [N; 2],
    /// The largest absolute x or y of the offset of a ray, at most 1.
    pub max_offset: N,
    /// The range of the rays' origins along z, relative to the projection center.
    ///
    /// Infinite unless all rays have the dominant axis `axis`, and lengths along it within `SAFE_LENGTHS`.
    pub depth_range: [N; 2],
}

/// The least and the greatest length by which a depth can be divided and multiplied again
/// (`culling.md`, 14).
///
/// Between them, the underflow is at most 2^-117, and depths below 2^95 do not overflow.
// If a ray's length is outside these limits, `depth_range` and with it the packet's error bound are infinite, and each
// ray's own error bound decides the signs of its edge functions.
// Without the limits, a packet with directions of length 2^120 was culled wrongly.
const SAFE_LENGTHS: [f32; 2] = [1.0 / 4_294_967_296.0, 4_294_967_296.0];

impl<N: Lanes> ProjectionCenter<N> {
    /// Finds the projection center of eye rays or shadow rays.
    ///
    /// Eye rays start at the projection center (the eye); shadow rays reach it (the light) at t = 1, up to rounding.
    /// Returns `None` for other rays, and if an offset exceeds 1.
    #[inline(always)]
    pub fn find(groups: &[Rays<N>; LANES]) -> Option<Self> {
        let zero = N::splat(0.0);
        // Offsets are measured from a ray near the middle of the tile, so that they and all bounds are small.
        let middle = &groups[LANES / 2];
        let start = middle.origin.splat_lane(0);
        // Eye rays start at the same point, bit for bit: `origin_error` is zero, and their ends need no comparison.
        if max_axis_distance(groups, zero, start).le(zero).all() {
            return Self::with_origin(start, zero, groups);
        }
        let direction = middle.direction.splat_lane(0);
        let end = middle.origin.splat_lane(0) + direction;
        let off = max_axis_distance(groups, N::splat(1.0), end);
        // If the ends of the rays are farther apart than 1/4096 of the direction's largest coordinate, the error bounds
        // would be too wide to cull anything. No statement of `culling.md` depends on the exact number 4096.
        if !(off * N::splat(4096.0)).le(direction.max_abs_coordinate()).all() {
            return None;
        }
        // In units of 2^-24, `origin_error` is twice the distance `off` plus twice the rounding error of `end`
        // (statement 9 of `culling.md`).
        Self::with_origin(end, off * N::splat(33_554_432.0) + end.max_abs_coordinate() * N::splat(2.0), groups)
    }

    #[inline(always)]
    fn with_origin(origin: Vector<N>, origin_error: N, groups: &[Rays<N>; LANES]) -> Option<Self> {
        let Shear { axis, factor, .. } = Shear::of(groups[LANES / 2].direction.splat_lane(0));
        let slope = [factor.x, factor.y];
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        let (mut xs, mut ys) = ([zero; LANES], [zero; LANES]);
        let (mut are_near, mut are_usual) = (zero.le(one), zero.le(one));
        let (mut depth_range, mut share_axis) = ([N::splat(f32::INFINITY), N::splat(f32::NEG_INFINITY)], true);
        for (at, rays) in groups.iter().enumerate() {
            let (direction, inverse) = (axis.rotate_to_z(rays.direction), axis.rotate_to_z(rays.inverse));
            // A product with the known inverse is cheaper than a division, but is off by two units instead of one
            // (statement 11 of `culling.md`).
            xs[at] = direction.x * inverse.z - slope[0];
            ys[at] = direction.y * inverse.z - slope[1];
            // Comparisons with NaN are false, so an offset of NaN leads to `None`, as an offset above 1 does.
            are_near = are_near & xs[at].abs().le(one) & ys[at].abs().le(one);
            let depth = axis.rotate_to_z(rays.origin - origin).z;
            // With `depth` as the first operand, `min` and `max` ignore a `depth` of NaN.
            depth_range = [depth.min(depth_range[0]), depth.max(depth_range[1])];
            share_axis &= rays.shear.axis.is_same_for_all(axis);
            let length = rays.shear.length;
            are_usual = are_usual & N::splat(SAFE_LENGTHS[0]).le(length) & length.le(N::splat(SAFE_LENGTHS[1]));
        }
        let (x0, x1) = (N::min_of_each(&xs), N::max_of_each(&xs));
        let (y0, y1) = (N::min_of_each(&ys), N::max_of_each(&ys));
        let half = N::splat(0.5);
        let centers = [(x0 + x1) * half, (y0 + y1) * half];
        // Half extents are widened by 4 units of 2^-24, for the rounding of `centers` and their own (statement 12 of
        // `culling.md`).
        let more = N::splat(1.0 + 1.0 / 4_194_304.0);
        let half_extents =
            [(x1 - centers[0]).max(centers[0] - x0) * more, (y1 - centers[1]).max(centers[1] - y0) * more];
        let max_offset = x0.abs().max(x1.abs()).max(y0.abs().max(y1.abs()));
        let max_offset = N::splat(max_offset.reduce_max());
        let depth_range = if share_axis && are_usual.all() {
            [N::splat(depth_range[0].store().reduce_min()), N::splat(depth_range[1].reduce_max())]
        } else {
            [N::splat(f32::NEG_INFINITY), N::splat(f32::INFINITY)]
        };
        are_near.all().then_some(Self {
            origin,
            origin_error,
            axis,
            slope,
            centers,
            half_extents,
            max_offset,
            depth_range,
        })
    }

    /// Transforms a point to coordinates in which the ray with `slope` runs along z.
    ///
    /// The coordinates are relative to the projection center. For their errors see statement 10 of `culling.md`; the
    /// rounding of `slope` adds none, as offsets are relative to the rounded slope.
    #[inline(always)]
    pub fn to_shear_space(&self, point: Vector<N>) -> Vector<N> {
        let Vector { x, y, z } = self.axis.rotate_to_z(point - self.origin);
        Vector { x: x - self.slope[0] * z, y: y - self.slope[1] * z, z }
    }
}

/// Returns the largest distance of the rays at `t` from `point`, along any axis.
#[inline(always)]
fn max_axis_distance<N: Lanes>(groups: &[Rays<N>; LANES], t: N, point: Vector<N>) -> N {
    let mut distance = N::splat(0.0);
    for rays in groups {
        // In this order `max` skips NaN: a ray with a coordinate that is not finite hits nothing, and must not hide the
        // distance of another ray.
        distance = (rays.origin + rays.direction * t - point).max_abs_coordinate().max(distance);
    }
    N::splat(distance.reduce_max())
}

#[cfg(all(test, unit_tests))]
mod tests;
