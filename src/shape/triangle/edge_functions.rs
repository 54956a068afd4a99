//! Triangles as they are seen from a pencil's apex.

use super::TriangleN;
use crate::lanes::{F32x8, LaneMask, Lanes, Vector};
use crate::ray::CommonOrigin;

/// What tells of eight triangles beforehand which rays of a pencil pass them by, and how much doubt there is of the others.
///
/// In the picture that is seen from the apex, the weight of each corner is a linear function of the place, zero along the
/// edge between the other two (Pineda, A Parallel Algorithm for Polygon Rasterization, 1988). So it is worked out once for
/// all rays, and its least and greatest value for a group takes a few steps. Where the weights of two corners differ in
/// sign for the whole group, beyond all doubt, no ray of it crosses the triangle, neither in f32 nor in f64.
pub struct EdgeFunctions {
    /// What stands before the place's x and y, and what is added, for each corner.
    weights: [Vector<F32x8>; 3],
    /// By how much they may be off, at most.
    error_bound: F32x8,
    /// By how much the weights of any ray of the pencil may be off in the test itself, at most: no less than its own doubt.
    pub packet_error_bound: F32x8,
}

impl EdgeFunctions {
    /// Which groups of the pencil pass by that triangle with all their rays: a bit for each.
    #[inline(always)]
    pub fn culled_groups<N: Lanes>(&self, lane: usize, common_origin: &CommonOrigin<N>) -> u32 {
        let [a, b, c] = &self.weights;
        let [a0, a1] = range(a, lane, common_origin);
        let [b0, b1] = range(b, lane, common_origin);
        let [c0, c1] = range(c, lane, common_origin);
        let error_bound = N::splat(self.error_bound.0[lane]);
        let (negative, positive) = (a1.min(b1.min(c1)), a0.max(b0.max(c0)));
        (negative.lt(-error_bound) & error_bound.lt(positive)).bits()
    }
}

/// Between what a weight lies for the rays of each group.
#[inline(always)]
fn range<N: Lanes>(weight: &Vector<F32x8>, lane: usize, common_origin: &CommonOrigin<N>) -> [N; 2] {
    let Vector { x, y, z } = Vector::<N>::splat(weight.of_lane(lane));
    let middle = common_origin.centers[0] * x + common_origin.centers[1] * y + z;
    let reach = common_origin.half_extents[0] * x.abs() + common_origin.half_extents[1] * y.abs();
    [middle - reach, middle + reach]
}

impl<N: Lanes> TriangleN<N> {
    /// The edges as they are seen from the apex.
    ///
    /// Let s be the largest x or y of a corner, r the largest z or the blur, and u the width; all errors are in units of
    /// 2^-24. A place is off by 2 + 3 u, an x or y by 2 s + 8 r, a z by 2 r. Then what stands before x and y is off by
    /// 12 s r + 16 r r, what is added by 12 s s + 32 s r, and a weight by 32 u r r + (40 + 36 u) s r + 12 s s at most. To work
    /// out its range takes 40 u s r + 10 s s more. All that is less than 96 (s + u r) (s + r).
    ///
    /// What is left of that is more than the products of two errors, (12 + 6 u) s r where s is more than 16 * 2^-24 r (where
    /// it is not, no weight is so great), and than the 3 + 3 u by which a place is off besides where a direction is so long,
    /// over 2^126, that its inverse is not whole: for u up to 1. The factor 4 comes first, so that what is too great for f32
    /// is so here before it is elsewhere: beyond an infinite doubt is nothing.
    ///
    /// A ray that is longest along the same axis has a corner, in its own coordinates, at the x and y of here less the place
    /// times z, and at a z that is counted from its origin: so no x or y is more than s + u r, and no z than f, the farthest that
    /// a corner is from an origin along z. Rounding here and there adds 4 s + 16 r + 4 f to these x and y, and less than 16 (r +
    /// f) to z; 256 (r + f) is added here. So [`weight_error_bound`](super::weight_error_bound), each step of which is monotone, is never more than the
    /// same steps make of this: with a unit in 24 for s, and for the 2^-117 by which z may be off besides; where that is more
    /// than such a part of x or y, all of it is less than the numbers that are added. Where z is too great for f32, so is this.
    #[inline(always)]
    pub(super) fn edge_functions(&self, common_origin: &CommonOrigin<N>) -> EdgeFunctions {
        let [a, b, c] = self.0;
        let [a, b, c] = [common_origin.apply(a), common_origin.apply(b), common_origin.apply(c)];
        let across = a.x.abs().max(a.y.abs()).max(b.x.abs().max(b.y.abs())).max(c.x.abs().max(c.y.abs()));
        let along = a.z.abs().max(b.z.abs()).max(c.z.abs().max(common_origin.origin_error));
        let error_bound = (across + common_origin.max_offset * along)
            * N::splat(4.0)
            * (across + along)
            * N::splat(24.0 / 16_777_216.0);
        let [first, last] = common_origin.depth_range;
        let far = (a.z.max(b.z).max(c.z) - first).max(last - a.z.min(b.z).min(c.z));
        let off = across + common_origin.max_offset * along + (along + far) * N::splat(256.0 / 16_777_216.0);
        let packet_error_bound = off * (off + far) * N::splat(25.0 / 16_777_216.0);
        EdgeFunctions {
            weights: [c.cross(b).store(), a.cross(c).store(), b.cross(a).store()],
            error_bound: (error_bound + N::splat(f32::MIN_POSITIVE)).store(),
            packet_error_bound: (packet_error_bound + N::splat(2.0 * f32::MIN_POSITIVE)).store(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Triangle;
    use crate::lanes::{F32x8, LANES, LaneMask, Number};
    use crate::ray::{CommonOrigin, EightRays, Ray, Rays};
    use crate::shape::triangle::{TriangleN, weight_error_bound};
    use crate::shape::{Crossable, SoaLeaf};
    use glam::Vec3;
    use std::array::from_fn;

    /// Numbers from -1 to 1, the same each time.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f32 / 8_388_608.0 - 1.0
        }

        fn point(&mut self) -> Vec3 {
            Vec3::new(self.next(), self.next(), self.next())
        }
    }

    fn two_to(power: i32) -> f32 {
        f32::from_bits(((127 + power) as u32) << 23)
    }

    /// Groups of rays from one point, or to one, each aimed at a corner or an edge of one of eight triangles, or a hair
    /// beside it; small triangles and large ones, and those without an area; from afar and from close by, and from behind.
    fn story(seed: u64) -> (Vec<Triangle>, [EightRays; LANES]) {
        let mut numbers = Numbers(seed);
        let scale = two_to((seed % 41) as i32 * 2 - 40);
        let size = two_to(-((seed / 41 % 12) as i32));
        let middle = numbers.point();
        let shared = if seed.is_multiple_of(3) { middle + numbers.point() * size * 4.0 } else { numbers.point() * 3.0 };
        let mut triangles = Vec::new();
        for at in 0..LANES {
            let first = middle + numbers.point() * size;
            let mut corners = [first, first + numbers.point() * size, first + numbers.point() * size];
            if at == 7 {
                corners[2] = corners[0].midpoint(corners[1]);
            }
            triangles.push(Triangle::unchecked(corners.map(|corner| corner * scale)));
        }
        let shared = shared * scale;
        let mut aim = |group: usize| {
            let corners = triangles[(group + seed as usize) % LANES].corners();
            from_fn::<Ray, LANES, _>(|lane| {
                // Every other group is as narrow as rays can be.
                let (at, is_beside) =
                    if group.is_multiple_of(2) { (lane, lane % 2 == 1) } else { (group / 2, group % 4 == 1) };
                let share = [0.0, 0.25, 0.5, 1.0][(at + seed as usize / 2) % 4];
                let on_edge = corners[at % 3].lerp(corners[(at + 1) % 3], share);
                let hair = numbers.point() * scale * size * two_to(-3 * (seed % 9) as i32);
                let point = if is_beside { on_edge + hair } else { on_edge };
                if is_backward(seed) {
                    let origin = point + (point - shared) * [0.1, 1000.0][seed as usize / 2 % 2];
                    Ray { origin, direction: shared - origin }
                } else {
                    let is_behind = seed.is_multiple_of(7) && lane.is_multiple_of(2);
                    Ray { origin: shared, direction: if is_behind { shared - point } else { point - shared } }
                }
            })
        };
        let rays = from_fn(|group| EightRays::of(&aim(group)));
        (triangles, rays)
    }

    /// Whether the rays have the apex at t = 1.
    fn is_backward(seed: u64) -> bool {
        seed % 2 == 1
    }

    /// What the test finds that goes by `rough` first: t where a ray crosses the triangle.
    fn found(shape: &TriangleN<F32x8>, rays: &Rays<F32x8>, packet_error_bound: f32) -> Option<[u32; LANES]> {
        let crossing = shape.first_crossing_with_bound(rays, F32x8::ZERO, F32x8::splat(packet_error_bound));
        crossing.map(|(crosses, t)| F32x8::select(crosses, t, F32x8::splat(-1.0)).0.map(f32::to_bits))
    }

    /// However long or short directions are, and whoever else is among the rays.
    #[test]
    fn what_f32_cannot_hold_is_not_decided_for_all() {
        let forward = Ray { origin: Vec3::ZERO, direction: Vec3::new(0.1, 0.1, 1.0) };
        let endless = Ray { direction: Vec3::new(0.1, 0.1, f32::INFINITY), ..forward };
        let across = [Vec3::new(-1.0, -1.0, 5.0), Vec3::new(3.0, -1.0, 5.0), Vec3::new(-1.0, 3.0, 5.0)];
        let along = [Vec3::new(1.0, -1.0, 1000.0), Vec3::new(-1.0, -1.0, -800.0), Vec3::new(0.0, 1.0, 0.0)];
        let close = [Vec3::new(1e-9, -1e-9, 2e-7), Vec3::new(-1e-9, -1e-9, 2e-7), Vec3::new(0.0, 1e-9, 2e-7)];
        let stories = [-126, -120, -60, -30, 0, 30, 60, 120, 127].map(|power| {
            (
                Ray { direction: Vec3::Z * two_to(power), ..forward },
                Ray { direction: forward.direction * two_to(power), ..forward },
            )
        });
        for (one, other) in stories.into_iter().chain([(forward, endless)]) {
            let mut rays = [[one; LANES]; LANES];
            rays[3][5] = other;
            let groups: [Rays<F32x8>; LANES] = from_fn(|group| Rays::load(&EightRays::of(&rays[group]), true));
            let common_origin = CommonOrigin::of(&groups).expect("all begin in one point");
            let shapes = TriangleN::<F32x8>::of(&[across, along, close].map(Triangle::unchecked));
            let edges = shapes.edge_functions(&common_origin);
            for lane in 0..3 {
                let (shape, packet_error_bound) = (shapes.splat::<F32x8>(lane), edges.packet_error_bound.0[lane]);
                for rays in &groups {
                    assert_eq!(
                        found(&shape, rays, packet_error_bound),
                        found(&shape, rays, f32::INFINITY),
                        "{one:?} {lane}"
                    );
                }
            }
        }
    }

    /// No ray has more doubt than is said of all, and that is most often not much more.
    #[test]
    fn the_doubt_of_all_is_no_less_than_that_of_each() {
        let (mut near, mut all) = (0, 0);
        for seed in 0..6_000 {
            let (triangles, rays) = story(seed);
            let groups: [Rays<F32x8>; LANES] = from_fn(|group| Rays::load(&rays[group], true));
            let Some(common_origin) = CommonOrigin::of(&groups) else { continue };
            let shapes = TriangleN::<F32x8>::of(&triangles);
            let edges = shapes.edge_functions(&common_origin);
            for lane in 0..LANES {
                let (shape, packet_error_bound) = (shapes.splat::<F32x8>(lane), edges.packet_error_bound.0[lane]);
                for (group, rays) in groups.iter().enumerate() {
                    let own = weight_error_bound(shape.sheared(rays), rays.shear.length).reduce_max();
                    assert!(
                        own <= packet_error_bound,
                        "seed {seed}: triangle {lane}, group {group}: {own} and {packet_error_bound}"
                    );
                    assert_eq!(
                        found(&shape, rays, packet_error_bound),
                        found(&shape, rays, f32::INFINITY),
                        "seed {seed}"
                    );
                    all += usize::from(packet_error_bound.is_finite());
                    near += usize::from(own * 100.0 > packet_error_bound);
                }
            }
        }
        assert!(all > 100_000 && near > all / 2, "{near} of {all}");
    }

    /// Whom the edges let off would not have crossed the triangle; and most of those who do not cross it are let off.
    #[test]
    fn who_passes_by_does_not_cross() {
        let (mut passing, mut missing, mut packets) = (0, 0, [0; 2]);
        for seed in 0..6_000 {
            let (triangles, rays) = story(seed);
            let groups: [Rays<F32x8>; LANES] = from_fn(|group| Rays::load(&rays[group], true));
            let shapes = TriangleN::<F32x8>::of(&triangles);
            let Some(common_origin) = CommonOrigin::of(&groups) else { continue };
            let edges = shapes.edge_functions(&common_origin);
            packets[usize::from(is_backward(seed))] += 1;
            for lane in 0..LANES {
                let culled_groups = edges.culled_groups(lane, &common_origin);
                for (group, rays) in groups.iter().enumerate() {
                    let crossing = shapes.splat::<F32x8>(lane).first_crossing(rays, F32x8::splat(f32::MIN));
                    let crosses = crossing.map_or(0, |(crosses, _)| crosses.bits());
                    let is_passed_by = culled_groups >> group & 1 == 1;
                    assert!(!is_passed_by || crosses == 0, "seed {seed}: triangle {lane}, group {group}: {crosses:b}");
                    missing += u32::from(crosses == 0);
                    passing += u32::from(is_passed_by);
                }
            }
        }
        assert!(packets.into_iter().all(|count| count > 1_000), "{packets:?} packets");
        assert!(passing > missing / 4, "{passing} of {missing} are let off");
    }
}
