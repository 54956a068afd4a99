//! Rays through one point.

use super::{DominantAxis, Rays, Shear};
use crate::lanes::{LANES, Lanes, Mask, Vector};

/// Groups of eight rays whose lines pass through one point, the origin: the eye, or a light. Seen from there, each ray is a
/// point of a picture, and what it may meet can be told from the place of that point.
#[derive(Clone, Copy, Debug)]
pub struct CommonOrigin<N: Lanes> {
    origin: Vector<N>,
    /// How far the lines miss the origin, along any axis, at most: a length, times 2^24.
    pub origin_error: N,
    axis: DominantAxis<N::Mask>,
    /// How far the ray in the picture's middle goes along x and y, while it goes one unit along its longest axis.
    slope: [N; 2],
    /// A ray's place in the picture is how far it goes along x and y, while it goes one unit along that axis, less the
    /// slope. The middle of each group's places:
    pub centers: [N; 2],
    /// and how far from it one of them is, at most.
    pub half_extents: [N; 2],
    /// How far a place is from zero, along either axis, at most: up to 1.
    pub max_offset: N,
    /// Between where along z, from the origin on, the rays' origins lie, if that is the axis which is longest for all of them
    /// and nothing on their way is too long or too short for f32; else without an end.
    pub depth_range: [N; 2],
}

/// Lengths that a direction usually has: what is divided by one and multiplied by it again is off by no more than 2^-117,
/// and not too great for f32 unless it was more than 2^95 before.
const SAFE_LENGTHS: [f32; 2] = [1.0 / 4_294_967_296.0, 4_294_967_296.0];

impl<N: Lanes> CommonOrigin<N> {
    /// Of these rays, if all begin in one point, or have one at t = 1 but for rounding, and are not too wide apart.
    #[inline(always)]
    pub fn of(groups: &[Rays<N>; LANES]) -> Option<Self> {
        let zero = N::splat(0.0);
        let middle = &groups[LANES / 2];
        let start = middle.origin.splat_lane(0);
        if max_distance(groups, zero, start).le(zero).all() {
            return Self::around(start, zero, groups);
        }
        let direction = middle.direction.splat_lane(0);
        let end = middle.origin.splat_lane(0) + direction;
        let off = max_distance(groups, N::splat(1.0), end);
        // What is far off tells nothing.
        if !(off * N::splat(4096.0)).le(direction.largest()).all() {
            return None;
        }
        // As far as was found, where each end is rounded by a unit itself, twice over.
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
            xs[at] = direction.x * inverse.z - slope[0];
            ys[at] = direction.y * inverse.z - slope[1];
            // No for NaN as well.
            are_near = are_near & xs[at].abs().le(one) & ys[at].abs().le(one);
            let depth = axis.rotate_to_z(rays.origin - origin).z;
            // In this order, so that NaN is left out.
            depth_range = [depth.min(depth_range[0]), depth.max(depth_range[1])];
            share_axis &= rays.shear.axis.is_same_for_all(axis);
            let length = rays.shear.length;
            are_usual = are_usual & N::splat(SAFE_LENGTHS[0]).le(length) & length.le(N::splat(SAFE_LENGTHS[1]));
        }
        let (x0, x1) = (N::min_of_each(&xs), N::max_of_each(&xs));
        let (y0, y1) = (N::min_of_each(&ys), N::max_of_each(&ys));
        let half = N::splat(0.5);
        let centers = [(x0 + x1) * half, (y0 + y1) * half];
        // So much that no rounding makes it too little.
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

    /// A point in coordinates around the origin, in which the ray in the middle runs along z. (Rounding of the slope is no
    /// error: the picture is that of the slope as it is.) To first order, in units of 2^-24, its x and y are off by 2 |x| + 3
    /// |z| at most and its z by |z|; for a line that misses the origin, by twice the origin_error and by the origin_error more.
    #[inline(always)]
    pub fn apply(&self, point: Vector<N>) -> Vector<N> {
        let Vector { x, y, z } = self.axis.rotate_to_z(point - self.origin);
        Vector { x: x - self.slope[0] * z, y: y - self.slope[1] * z, z }
    }
}

/// How far from that point the rays are at t, along any axis, at most.
#[inline(always)]
fn max_distance<N: Lanes>(groups: &[Rays<N>; LANES], t: N, point: Vector<N>) -> N {
    let mut distance = N::splat(0.0);
    for rays in groups {
        // In this order, so that NaN is left out: what is not finite meets nothing, whoever goes with it.
        distance = (rays.origin + rays.direction * t - point).largest().max(distance);
    }
    N::splat(distance.reduce_max())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::F32x8;
    use crate::ray::{EightRays, Ray};
    use glam::Vec3;
    use std::array::from_fn;

    /// A packet of rays from one point, but for some.
    fn packet(others: &[(usize, usize, Ray)]) -> Option<CommonOrigin<F32x8>> {
        let mut rays = [[Ray { origin: Vec3::ZERO, direction: Vec3::new(0.1, 0.1, 1.0) }; LANES]; LANES];
        for &(group, lane, ray) in others {
            rays[group][lane] = ray;
        }
        let groups: [Rays<F32x8>; LANES] = from_fn(|group| Rays::load(&EightRays::of(&rays[group]), true));
        CommonOrigin::of(&groups)
    }

    #[test]
    fn a_ray_beside_the_point_is_noticed() {
        let beside = Ray { origin: Vec3::X * 5.0, direction: Vec3::new(0.1, 0.1, 1.0) };
        let endless = Ray { origin: Vec3::ZERO, direction: Vec3::new(0.1, 0.1, f32::INFINITY) };
        let across = Ray { origin: Vec3::ZERO, direction: Vec3::new(1.0, 0.0, 0.0) };
        assert!(packet(&[]).is_some());
        for others in [vec![(1, 3, beside)], vec![(1, 3, beside), (2, 3, endless)], vec![(7, 0, across)]] {
            assert!(packet(&others).is_none(), "{others:?}");
        }
    }
}
