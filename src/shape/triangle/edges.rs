//! Triangles as they are seen from a pencil's apex.

use super::Corners;
use crate::lanes::{Answers, Eight, Lanes, Vector};
use crate::ray::Pencil;

/// What tells of eight triangles beforehand which rays of a pencil pass them by.
///
/// In the picture that is seen from the apex, the weight of each corner is a linear function of the place, zero along the
/// edge between the other two (Pineda, A Parallel Algorithm for Polygon Rasterization, 1988). So it is worked out once for
/// all rays, and its least and greatest value for a group takes a few steps. Where the weights of two corners differ in
/// sign for the whole group, beyond all doubt, no ray of it crosses the triangle, neither in f32 nor in f64.
pub struct Edges {
    /// What stands before the place's x and y, and what is added, for each corner.
    weights: [Vector<Eight>; 3],
    /// By how much they may be off, at most.
    doubt: Eight,
}

impl Edges {
    /// Which groups of the pencil pass by that triangle with all their rays: a bit for each.
    #[inline(always)]
    pub fn passed_by<N: Lanes>(&self, lane: usize, pencil: &Pencil<N>) -> u32 {
        let [a, b, c] = &self.weights;
        let [a0, a1] = range(a, lane, pencil);
        let [b0, b1] = range(b, lane, pencil);
        let [c0, c1] = range(c, lane, pencil);
        let doubt = N::splat(self.doubt.0[lane]);
        let (negative, positive) = (a1.min(b1.min(c1)), a0.max(b0.max(c0)));
        (negative.lt(-doubt) & doubt.lt(positive)).bits()
    }
}

/// Between what a weight lies for the rays of each group.
#[inline(always)]
fn range<N: Lanes>(weight: &Vector<Eight>, lane: usize, pencil: &Pencil<N>) -> [N; 2] {
    let Vector { x, y, z } = Vector::<N>::splat(weight.of_lane(lane));
    let middle = pencil.middles[0] * x + pencil.middles[1] * y + z;
    let reach = pencil.reaches[0] * x.abs() + pencil.reaches[1] * y.abs();
    [middle - reach, middle + reach]
}

impl<N: Lanes> Corners<N> {
    /// The edges as they are seen from the apex.
    ///
    /// Let s be the largest x or y of a corner, r the largest z or the blur, and u the width, in units of 2^-24. A place is
    /// off by 2 + 3 u, an x or y by 2 s + 8 r, a z by 2 r. Then what stands before x and y is off by 12 s r + 16 r r, what is
    /// added by 12 s s + 32 s r, and a weight by no more than 32 u r r + (40 + 36 u) s r + 12 s s. To work out its range takes
    /// 40 u s r + 10 s s more. All that is less than 96 (s + u r) (s + r). Products of two errors add less than 8 s r where s
    /// is more than 16 units of r; where it is not, no weight is so great. The factor 4 comes first, so that what is too
    /// great for f32 is so here before it is elsewhere: beyond an infinite doubt is nothing.
    #[inline(always)]
    pub(super) fn edges(&self, pencil: &Pencil<N>) -> Edges {
        let [a, b, c] = self.0;
        let [a, b, c] = [pencil.apply(a), pencil.apply(b), pencil.apply(c)];
        let across = a.x.abs().max(a.y.abs()).max(b.x.abs().max(b.y.abs())).max(c.x.abs().max(c.y.abs()));
        let along = a.z.abs().max(b.z.abs()).max(c.z.abs().max(pencil.blur));
        let doubt = (across + pencil.width * along) * N::splat(4.0) * (across + along) * N::splat(24.0 / 16_777_216.0);
        Edges {
            weights: [c.cross(b).store(), a.cross(c).store(), b.cross(a).store()],
            doubt: (doubt + N::splat(f32::MIN_POSITIVE)).store(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Triangle;
    use crate::lanes::{Answers, Eight, LANES, Number};
    use crate::ray::{EightRays, Pencil, Ray, Rays};
    use crate::shape::triangle::Corners;
    use crate::shape::{Crossable, SideBySide};
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
    /// beside it; small triangles and large ones, and those without an area.
    fn story(numbers: &mut Numbers, seed: u64) -> (Vec<Triangle>, [EightRays; LANES]) {
        let scale = two_to((seed % 41) as i32 * 2 - 40);
        let (apex, middle) = (numbers.point() * 3.0, numbers.point());
        let size = two_to(-((seed / 41 % 12) as i32));
        let mut triangles = Vec::new();
        for at in 0..LANES {
            let first = middle + numbers.point() * size;
            let mut corners = [first, first + numbers.point() * size, first + numbers.point() * size];
            if at == 7 {
                corners[2] = corners[0].midpoint(corners[1]);
            }
            triangles.push(Triangle::new(corners.map(|corner| corner * scale)));
        }
        let is_backward = seed % 2 == 1;
        let mut aim = |group: usize| {
            let corners = triangles[(group + seed as usize) % LANES].corners();
            from_fn::<Ray, LANES, _>(|lane| {
                // Every other group is as narrow as rays can be.
                let lane = if group.is_multiple_of(2) { lane } else { group / 2 * 2 };
                let share =
                    if lane < 6 { [0.0, 0.25, 0.5, 1.0][(lane + seed as usize / 2) % 4] } else { numbers.next().abs() };
                let on_edge = corners[lane % 3].lerp(corners[(lane + 1) % 3], share);
                let hair = numbers.point() * scale * size * two_to(-3 * (seed % 9) as i32);
                let (apex, point) =
                    (apex * scale, if lane % 2 == 0 && (group + lane) % 4 != 3 { on_edge } else { on_edge + hair });
                let (from, to) = if is_backward { (point + (point - apex) * 0.1, apex) } else { (apex, point) };
                Ray { origin: from, direction: to - from }
            })
        };
        let rays = from_fn(|group| EightRays::of(&aim(group)));
        (triangles, rays)
    }

    /// Whom the edges let off would not have crossed the triangle; and most of those who do not cross it are let off.
    #[test]
    fn who_passes_by_does_not_cross() {
        let (mut passing, mut missing, mut pencils) = (0, 0, 0);
        for seed in 0..4_000 {
            let mut numbers = Numbers(seed);
            let (triangles, rays) = story(&mut numbers, seed);
            let groups: [Rays<Eight>; LANES] = from_fn(|group| Rays::load(&rays[group], true));
            let shapes = Corners::<Eight>::of(&triangles);
            let Some(pencil) = Pencil::of(&groups) else { continue };
            let edges = shapes.edges(&pencil);
            pencils += 1;
            for lane in 0..LANES {
                let passed_by = edges.passed_by(lane, &pencil);
                for (group, rays) in groups.iter().enumerate() {
                    let crossing = shapes.splat::<Eight>(lane).first_crossing(rays, Eight::splat(f32::MIN));
                    let crosses = crossing.map_or(0, |(crosses, _)| crosses.bits());
                    let is_passed_by = passed_by >> group & 1 == 1;
                    assert!(!is_passed_by || crosses == 0, "seed {seed}: triangle {lane}, group {group}: {crosses:b}");
                    missing += u32::from(crosses == 0);
                    passing += u32::from(is_passed_by);
                }
            }
        }
        assert!(pencils > 1_000, "{pencils} pencils");
        assert!(passing > missing / 4, "{passing} of {missing} are let off");
    }
}
