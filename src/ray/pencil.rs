//! Rays through one point.

use super::{Longest, Rays, Shear};
use crate::lanes::{LANES, Lanes, Mask, Vector};

/// Groups of eight rays whose lines pass through one point, the apex: the eye, or a light. Seen from there, each ray is a
/// point of a picture, and what it may meet can be told from the place of that point.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<N: Lanes> {
    apex: Vector<N>,
    /// Along no axis do the lines miss the apex by more than so many units of 2^-24.
    pub blur: N,
    longest: Longest<N::Mask>,
    /// How far the ray in the picture's middle goes along x and y, while it goes one unit along its longest axis.
    slope: [N; 2],
    /// Where the rays are in the picture, which is how much farther they go than that one: the middle of each group, along
    /// x and y.
    pub middles: [N; 2],
    /// How far from the middle of its group a ray is at most.
    pub reaches: [N; 2],
    /// How far from the picture's middle a ray is at most, along either axis: up to 1.
    pub width: N,
}

impl<N: Lanes> Pencil<N> {
    /// Of these rays, if all begin in one point, or have one at t = 1 but for rounding, and are not too wide apart.
    #[inline(always)]
    pub fn of(groups: &[Rays<N>; LANES]) -> Option<Self> {
        let zero = N::splat(0.0);
        let middle = &groups[LANES / 2];
        let start = middle.origin.splat_lane(0);
        if farthest(groups, zero, start).le(zero).all() {
            return Self::around(start, zero, groups);
        }
        let direction = middle.direction.splat_lane(0);
        let end = middle.origin.splat_lane(0) + direction;
        let off = farthest(groups, N::splat(1.0), end);
        // What is far off tells nothing.
        if !(off * N::splat(4096.0)).le(direction.largest()).all() {
            return None;
        }
        // As far as was found, where each end is rounded by a unit itself, twice over.
        Self::around(end, off * N::splat(33_554_432.0) + end.largest() * N::splat(2.0), groups)
    }

    #[inline(always)]
    fn around(apex: Vector<N>, blur: N, groups: &[Rays<N>; LANES]) -> Option<Self> {
        let Shear { longest, factor, .. } = Shear::of(groups[LANES / 2].direction.splat_lane(0));
        let slope = [factor.x, factor.y];
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        let (mut xs, mut ys) = ([zero; LANES], [zero; LANES]);
        let mut are_near = zero.le(one);
        for (at, rays) in groups.iter().enumerate() {
            let (direction, inverse) = (longest.last(rays.direction), longest.last(rays.inverse));
            xs[at] = direction.x * inverse.z - slope[0];
            ys[at] = direction.y * inverse.z - slope[1];
            // No for NaN as well.
            are_near = are_near & xs[at].abs().le(one) & ys[at].abs().le(one);
        }
        let (x0, x1) = (N::least_of_each(&xs), N::greatest_of_each(&xs));
        let (y0, y1) = (N::least_of_each(&ys), N::greatest_of_each(&ys));
        let half = N::splat(0.5);
        let middles = [(x0 + x1) * half, (y0 + y1) * half];
        // So much that no rounding makes it too little.
        let more = N::splat(1.0 + 1.0 / 4_194_304.0);
        let reaches = [(x1 - middles[0]).max(middles[0] - x0) * more, (y1 - middles[1]).max(middles[1] - y0) * more];
        let width = x0.abs().max(x1.abs()).max(y0.abs().max(y1.abs()));
        let width = N::splat(width.greatest());
        are_near.all().then_some(Self { apex, blur, longest, slope, middles, reaches, width })
    }

    /// A point in coordinates around the apex, in which the ray in the middle runs along z. Its x and y are off by 2 |x| + 4
    /// |z| units of 2^-24 at most, as in [`Shear::apply`]; for lines that miss the apex, by twice the blur more.
    #[inline(always)]
    pub fn apply(&self, point: Vector<N>) -> Vector<N> {
        let Vector { x, y, z } = self.longest.last(point - self.apex);
        Vector { x: x - self.slope[0] * z, y: y - self.slope[1] * z, z }
    }
}

/// How far from that point the rays are at t, along any axis, at most.
#[inline(always)]
fn farthest<N: Lanes>(groups: &[Rays<N>; LANES], t: N, point: Vector<N>) -> N {
    let mut farthest = N::splat(0.0);
    for rays in groups {
        farthest = farthest.max((rays.origin + rays.direction * t - point).largest());
    }
    N::splat(farthest.greatest())
}
