//! Packets whose rays share an origin.

use super::{DominantAxis, Rays, Shear};
use crate::lanes::{LANES, Lanes, Mask, Vector};

/// The common origin of a packet: the eye, or a light.
///
/// Seen from there each ray is a point of an image plane, its *offset*, and culling becomes a test of offsets.
///
/// Bounds of errors are numbered statements in `culling.md`.
#[derive(Clone, Copy, Debug)]
pub struct CommonOrigin<N: Lanes> {
    origin: Vector<N>,
    /// Upper bound of a line's distance from the origin along any axis, times 2^24 (statement 9).
    pub origin_error: N,
    axis: DominantAxis<N::Mask>,
    /// The slopes in x and y of a ray in the middle of the packet, per unit of its dominant axis.
    slope: [N; 2],
    /// The center of each group's offsets in x and y. A ray's offset is its slope less `slope`.
    pub centers: [N; 2],
    /// The half extents of each group's offsets around `centers`.
    pub half_extents: [N; 2],
    /// The largest absolute coordinate of an offset, at most 1.
    pub max_offset: N,
    /// The range of the rays' origins along z, relative to the common origin.
    ///
    /// Infinite unless all rays have this dominant axis and a length in `SAFE_LENGTHS`.
    pub depth_range: [N; 2],
}

/// Lengths by which a depth can be divided and multiplied again (`culling.md`, 14).
///
/// With an underflow of 2^-117 at most, and no overflow below 2^95.
// Without the limit, a review found, directions of 2^120 decided wrongly for their packet.
const SAFE_LENGTHS: [f32; 2] = [1.0 / 4_294_967_296.0, 4_294_967_296.0];

impl<N: Lanes> CommonOrigin<N> {
    /// Finds the common origin of eye rays or shadow rays.
    ///
    /// They start in one point, or have one at t = 1 up to rounding. Returns `None` for others, and for rays with
    /// offsets over 1.
    #[inline(always)]
    pub fn of(groups: &[Rays<N>; LANES]) -> Option<Self> {
        let zero = N::splat(0.0);
        // Offsets are measured from a ray near the middle of the tile, so that they and all bounds are small.
        let middle = &groups[LANES / 2];
        let start = middle.origin.splat_lane(0);
        // Eye rays share their origin bit for bit: no error, and no second search.
        if max_distance(groups, zero, start).le(zero).all() {
            return Self::around(start, zero, groups);
        }
        let direction = middle.direction.splat_lane(0);
        let end = middle.origin.splat_lane(0) + direction;
        let off = max_distance(groups, N::splat(1.0), end);
        // With a larger origin error the bounds cull nothing: no statement depends on the 4096.
        if !(off * N::splat(4096.0)).le(direction.largest()).all() {
            return None;
        }
        // Statement 9: twice the distance found, in units of 2^-24, and twice the rounding of each end.
        Self::around(end, off * N::splat(33_554_432.0) + end.largest() * N::splat(2.0), groups)
    }

    #[inline(always)]
    fn around(origin: Vector<N>, origin_error: N, groups: &[Rays<N>; LANES]) -> Option<Self> {
        let Shear { axis, factor, .. } = Shear::of(groups[LANES / 2].direction.splat_lane(0));
        let slope = [factor.x, factor.y];
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        let (mut xs, mut ys) = ([zero; LANES], [zero; LANES]);
        let (mut are_near, mut are_usual) = (zero.le(one), zero.le(one));
        let (mut depth_range, mut share_axis) = ([N::splat(f32::INFINITY), N::splat(f32::NEG_INFINITY)], true);
        for (at, rays) in groups.iter().enumerate() {
            let (direction, inverse) = (axis.rotate_to_z(rays.direction), axis.rotate_to_z(rays.inverse));
            // A product with the inverse, which the ray has, not a division: two units of error instead of one
            // (statement 11).
            xs[at] = direction.x * inverse.z - slope[0];
            ys[at] = direction.y * inverse.z - slope[1];
            // Compared this way round, NaN is not near.
            are_near = are_near & xs[at].abs().le(one) & ys[at].abs().le(one);
            let depth = axis.rotate_to_z(rays.origin - origin).z;
            // In this order `min` and `max` skip NaN.
            depth_range = [depth.min(depth_range[0]), depth.max(depth_range[1])];
            share_axis &= rays.shear.axis.is_same_for_all(axis);
            let length = rays.shear.length;
            are_usual = are_usual & N::splat(SAFE_LENGTHS[0]).le(length) & length.le(N::splat(SAFE_LENGTHS[1]));
        }
        let (x0, x1) = (N::min_of_each(&xs), N::max_of_each(&xs));
        let (y0, y1) = (N::min_of_each(&ys), N::max_of_each(&ys));
        let half = N::splat(0.5);
        let centers = [(x0 + x1) * half, (y0 + y1) * half];
        // 4 units for the two roundings here (statement 12).
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
    /// They are relative to the common origin. For the errors see statement 10; rounding of `slope` is none, as offsets
    /// are relative to the rounded one.
    #[inline(always)]
    pub fn apply(&self, point: Vector<N>) -> Vector<N> {
        let Vector { x, y, z } = self.axis.rotate_to_z(point - self.origin);
        Vector { x: x - self.slope[0] * z, y: y - self.slope[1] * z, z }
    }
}

/// Returns the largest distance of the rays at `t` from `point`, along any axis.
#[inline(always)]
fn max_distance<N: Lanes>(groups: &[Rays<N>; LANES], t: N, point: Vector<N>) -> N {
    let mut distance = N::splat(0.0);
    for rays in groups {
        // In this order `max` skips NaN: a ray that is not finite hits nothing, and must not hide the distance of
        // another.
        distance = (rays.origin + rays.direction * t - point).largest().max(distance);
    }
    N::splat(distance.reduce_max())
}

#[cfg(all(test, unit_tests))]
mod tests;
