//! Packets: many rays on their way through the tree together.
//!
//! A packet knows between what its rays' origins and inverse directions lie, and reckons with these intervals as
//! [`Bounds::crossed`](crate::bounds::Bounds::crossed) does with one ray: as each step of that is monotone, in IEEE
//! arithmetic as on paper, no ray of the packet enters a box before the packet does, or leaves it later, bit for bit. (Boulos,
//! Wald and Shirley, Geometric and Arithmetic Culling Methods for Entire Ray Packets, 2006.)

use super::{Bvh, Child, PacketStack, Prefetch, StackEntry, in_any_order, nearest_first};
use crate::lanes::{LANES, LaneMask, Lanes, Mask, Vector, set_bits};
use crate::ray::Rays;

/// So many groups of eight rays are a packet.
pub const GROUPS: usize = LANES;

/// What encloses the rays of a packet.
#[derive(Clone, Copy, Debug)]
pub struct Packet<N> {
    signs: [DirectionSign; 3],
    /// All of its rays, the same in every place.
    all: [AxisRanges<N>; 3],
    /// Group by group.
    groups: [AxisRanges<N>; 3],
}

/// Which way rays go along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DirectionSign {
    Forward,
    Backward,
    /// This way and that, or not at all.
    Mixed,
}

/// Between what rays lie along an axis, of those that go one way: what bounds where they enter boxes, and what bounds where
/// they leave them. Of mixed rays, what bounds where those enter that go forward, and where those that go backward.
#[derive(Clone, Copy, Debug)]
struct AxisRanges<N> {
    origin: [N; 2],
    inverse: [N; 2],
}

/// How much wider the interval of inverse directions is made, relatively, at both ends: 128 units of 2^-24.
/// [`Bounds::crossed`](crate::bounds::Bounds::crossed) lengthens a ray's way by 16 units, after two roundings; widened
/// beforehand, there is nothing to lengthen in each test.
const PACKET_SLACK: f32 = 128.0 / 16_777_216.0;

/// The least inverse, without its sign, that can be widened: below, f32 has fewer digits.
const MIN_INVERSE: f32 = 4.0 * f32::MIN_POSITIVE;

/// How many times as great as the least the greatest inverse of rays that go one way is, at most: 2^40.
const MAX_INVERSE_RATIO: f32 = 1_099_511_627_776.0;

/// How much later a packet leaves boxes than its rays: 2^-100. A product of a ray may be rounded to zero that is less than
/// zero for its packet. Those of a ray are less than 2^-150, so those of its packet less than 2^-150 times [`MAX_INVERSE_RATIO`].
const EXIT_SLACK: f32 = 1.0 / (MAX_INVERSE_RATIO * MAX_INVERSE_RATIO * 1_048_576.0);

/// Between what the numbers of each group lie.
#[inline(always)]
fn group_ranges<N: Lanes>(groups: [N; GROUPS]) -> [N; 2] {
    [N::min_of_each(&groups), N::max_of_each(&groups)]
}

/// The least of the first and the greatest of the second.
#[inline(always)]
fn total_range<N: Lanes>([low, high]: [N; 2]) -> [N; 2] {
    [N::splat(low.store().reduce_min()), N::splat(high.store().reduce_max())]
}

impl<N: Lanes> AxisRanges<N> {
    /// The hull of each group and that of all.
    #[inline(always)]
    fn of(origin: [N; GROUPS], inverse: [N; GROUPS]) -> (DirectionSign, [Self; 2]) {
        let origin = group_ranges(origin);
        let [low, high] = group_ranges(inverse);
        let (all_origin, all_inverse) = (total_range(origin), total_range([low, high]));
        let sign = DirectionSign::of(all_inverse);
        if sign == DirectionSign::Mixed {
            let (plus, minus) = (N::splat(f32::INFINITY), N::splat(f32::NEG_INFINITY));
            let zero = N::splat(0.0);
            let (mut above, mut below) = (inverse, inverse);
            for (above, below) in above.iter_mut().zip(&mut below) {
                *above = N::select(zero.lt(*above), *above, plus);
                *below = N::select(below.lt(zero), *below, minus);
            }
            let (above, below) = (group_ranges(above)[0], group_ranges(below)[1]);
            let [least, _] = total_range([above, above]);
            let [_, greatest] = total_range([below, below]);
            return (
                sign,
                [Self::of_mixed_signs(origin, [above, below]), Self::of_mixed_signs(all_origin, [least, greatest])],
            );
        }
        (sign, [Self::of_one_sign(sign, origin, [low, high]), Self::of_one_sign(sign, all_origin, all_inverse)])
    }

    #[inline(always)]
    fn of_one_sign(sign: DirectionSign, [first, last]: [N; 2], [low, high]: [N; 2]) -> Self {
        let (less, more) = (N::splat(1.0 - PACKET_SLACK), N::splat(1.0 + PACKET_SLACK));
        match sign {
            DirectionSign::Backward => Self { origin: [first, last], inverse: [high * less, low * more] },
            _ => Self { origin: [last, first], inverse: [low * less, high * more] },
        }
    }

    #[inline(always)]
    fn of_mixed_signs([first, last]: [N; 2], [above, below]: [N; 2]) -> Self {
        let (less, half) = (N::splat(1.0 - PACKET_SLACK), N::splat(0.5));
        // Where there are too few digits for a little, by half. That is not zero: no direction's inverse is less than 2^-128.
        let above = N::select(above.lt(N::splat(MIN_INVERSE)), above * half, above * less);
        let below = N::select(N::splat(-MIN_INVERSE).lt(below), below * half, below * less);
        Self { origin: [last, first], inverse: [above, below] }
    }

    /// Not after the first ray enters, not before the last one leaves; of those that do so at t >= 0.
    ///
    /// Rays of one way enter ahead at the product of the least distance and the least inverse, and leave at that of the
    /// greatest ones. Of what is behind, a distance is negative, and so is the product, whichever inverse that is.
    #[inline(always)]
    fn slab_range(&self, sign: DirectionSign, min: N, max: N) -> [N; 2] {
        let Self { origin, inverse } = *self;
        let (near, far) = match sign {
            DirectionSign::Forward => (min, max),
            DirectionSign::Backward => (max, min),
            // Who goes forward enters at the least coordinates, who goes backward at the greatest; the other way, the box
            // is behind it.
            DirectionSign::Mixed => {
                let (forward, backward) = ((min - origin[0]) * inverse[0], (max - origin[1]) * inverse[1]);
                return [forward.max(backward.max(N::splat(f32::NEG_INFINITY))), N::splat(f32::INFINITY)];
            }
        };
        [(near - origin[0]) * inverse[0], (far - origin[1]) * inverse[1]]
    }
}

impl DirectionSign {
    /// Of inverses between these.
    #[inline(always)]
    fn of<N: Lanes>([low, high]: [N; 2]) -> Self {
        let (least, ratio, greatest) = (N::splat(MIN_INVERSE), N::splat(MAX_INVERSE_RATIO), N::splat(f32::MAX / 2.0));
        if (least.le(low) & high.le(low * ratio) & high.le(greatest)).all() {
            Self::Forward
        } else if (least.le(-high) & (-low).le(-high * ratio) & (-low).le(greatest)).all() {
            Self::Backward
        } else {
            Self::Mixed
        }
    }
}

impl<N: Lanes> Packet<N> {
    /// Of the rays in these groups.
    #[inline(always)]
    pub fn of(groups: &[Rays<N>; GROUPS]) -> Self {
        let mut columns = [[N::splat(0.0); GROUPS]; 6];
        for (at, rays) in groups.iter().enumerate() {
            let (o, i) = (rays.origin, rays.inverse);
            for (column, number) in columns.iter_mut().zip([o.x, o.y, o.z, i.x, i.y, i.z]) {
                column[at] = number;
            }
        }
        let [ox, oy, oz, ix, iy, iz] = columns;
        let (x, [groups_x, all_x]) = AxisRanges::of(ox, ix);
        let (y, [groups_y, all_y]) = AxisRanges::of(oy, iy);
        let (z, [groups_z, all_z]) = AxisRanges::of(oz, iz);
        Self { signs: [x, y, z], groups: [groups_x, groups_y, groups_z], all: [all_x, all_y, all_z] }
    }

    /// Whether its rays go this way and that along most axes: then it keeps hardly any box from them.
    #[inline(always)]
    pub fn is_incoherent(&self) -> bool {
        self.signs.iter().filter(|&&sign| sign == DirectionSign::Mixed).count() > 1
    }

    /// Between what its rays cross each of eight boxes, within these bounds, the first 0 or more.
    #[inline(always)]
    pub fn crossed(&self, boxes: [Vector<N>; 2], within: [N; 2]) -> [N; 2] {
        crossed(&self.all, self.signs, boxes, within)
    }

    /// Between what the rays of each group cross one box, within these bounds.
    #[inline(always)]
    pub fn crossed_by_groups(&self, one: [Vector<N>; 2], within: [N; 2]) -> [N; 2] {
        crossed(&self.groups, self.signs, one, within)
    }
}

#[inline(always)]
fn crossed<N: Lanes>(
    [x, y, z]: &[AxisRanges<N>; 3],
    signs: [DirectionSign; 3],
    [min, max]: [Vector<N>; 2],
    [from, to]: [N; 2],
) -> [N; 2] {
    let x = x.slab_range(signs[0], min.x, max.x);
    let y = y.slab_range(signs[1], min.y, max.y);
    let z = z.slab_range(signs[2], min.z, max.z);
    let end = x[1].min(y[1].min(z[1])) + N::splat(EXIT_SLACK);
    [x[0].max(y[0].max(z[0].max(from))), end.min(to)]
}

/// What becomes of a packet in a tree.
pub trait Visitor<N>: Prefetch {
    /// Whether nearer boxes are visited before farther ones: what is found there may end the rays before those. Where any
    /// hit will do, sorting takes longer than it saves: without it shadow rays are 6 % faster on the dragon's 871 k
    /// triangles.
    const NEAREST_FIRST: bool;

    /// The number of boxes in a node from which on, if the packet meets that many, [`split`](Self::split) is asked.
    const MIN_CHILDREN_TO_SPLIT: u32;

    /// From where on rays are of interest: 0 or more.
    fn t_min(&self) -> f32;

    /// Up to where the rays of each group are.
    fn t_max(&self) -> N;

    /// Up to where any of them is.
    fn max_t_max(&self) -> f32;

    /// Tests what is in a leaf.
    fn visit_leaf(&mut self, leaf: usize);

    /// Returns the mask of rays of each group that go on as single rays from a node that these groups may meet, a bit for
    /// each, or nothing if the packet goes on. The box is that around the node. Some group may meet it.
    fn split(&self, one: [Vector<N>; 2], groups: u32) -> Option<[u32; GROUPS]>;

    /// Traces single rays of these groups from a node on.
    fn trace_singles(&mut self, from: Child, rays: [u32; GROUPS], groups: u32);
}

impl Bvh {
    /// The box in that place, as [`StackEntry`] counts them.
    #[inline(always)]
    fn slot_box<N: Lanes>(&self, slot: u32) -> [Vector<N>; 2] {
        self.nodes[slot as usize / LANES].child_box(slot as usize % LANES)
    }

    /// Visits the leaves that a packet meets.
    #[inline(always)]
    pub fn visit_packet<N: Lanes, V: Visitor<N>>(
        &self,
        packet: &Packet<N>,
        PacketStack(waiting): &mut PacketStack,
        visitor: &mut V,
    ) {
        let Some(root) = self.root() else { return };
        waiting.clear();
        let min = N::splat(visitor.t_min());
        let mut next = Some(StackEntry { child: root, slot: u32::MAX, start: visitor.t_min() });
        while let Some(StackEntry { child, slot, start }) = next.take().or_else(|| waiting.pop()) {
            if start > visitor.max_t_max() {
                continue;
            }
            if let Some(leaf) = child.as_leaf() {
                visitor.visit_leaf(leaf);
                continue;
            }
            let is_root = slot == u32::MAX;
            let mut groups = 0;
            if !is_root {
                let [starts, ends] = packet.crossed_by_groups(self.slot_box(slot), [min, visitor.t_max()]);
                groups = starts.le(ends).bits();
                if groups == 0 {
                    continue;
                }
            }
            let node = &self.nodes[child.0 as usize];
            let [starts, ends] = packet.crossed(node.boxes(), [min, N::splat(visitor.max_t_max())]);
            let hit_mask = starts.le(ends).bits();
            // The box is loaded again: kept in registers over the other test, it makes shadow rays 5 % slower.
            if !is_root
                && hit_mask.count_ones() >= V::MIN_CHILDREN_TO_SPLIT
                && let Some(rays) = visitor.split(self.slot_box(slot), groups)
            {
                visitor.trace_singles(child, rays, groups);
                continue;
            }
            for lane in set_bits(hit_mask) {
                self.prefetch(node.children[lane], visitor);
            }
            next = if V::NEAREST_FIRST {
                nearest_first(node, child, hit_mask, &starts.store(), waiting)
            } else {
                in_any_order(node, child, hit_mask, &starts.store(), waiting)
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Node;
    use super::*;
    use crate::bounds::crossed;
    use crate::lanes::{F32x8, Number};
    use crate::ray::{EightRays, Ray};
    use glam::Vec3;
    use std::array::from_fn;

    /// Numbers from -1 to 1, the same each time.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f32 / 8_388_608.0 - 1.0
        }

        fn vector(&mut self) -> Vec3 {
            Vec3::new(self.next(), self.next(), self.next())
        }
    }

    fn two_to(power: i32) -> f32 {
        f32::from_bits(((127 + power) as u32) << 23)
    }

    /// How long directions are, and how far origins are off zero.
    fn sizes(seed: u64) -> (f32, f32) {
        let length = two_to([-120, -60, -8, 0, 0, 8, 60, 117, 123][seed as usize % 9]);
        (length, two_to([0, 0, -30, 30, -100, 100][seed as usize / 9 % 6]))
    }

    /// Rays in a narrow or a wide packet, with directions and distances of all sizes, and boxes ahead of them, behind them,
    /// flat ones, and those that touch an origin.
    fn story(seed: u64) -> ([EightRays; GROUPS], [[Vector<F32x8>; 2]; 2]) {
        let (mut numbers, (length, scale)) = (Numbers(seed), sizes(seed));
        let width = two_to(-((seed / 54 % 14) as i32));
        let (origin, direction) = (numbers.vector(), numbers.vector());
        let mut ray = || {
            let mut direction = direction + numbers.vector() * width;
            if seed.is_multiple_of(5) {
                direction[seed as usize % 3] = 0.0;
            }
            Ray { origin: (origin + numbers.vector() * width) * scale, direction: direction * length }
        };
        let rays: [[Ray; LANES]; GROUPS] = from_fn(|_| from_fn(|_| ray()));
        let mut some_box = |lane: usize| {
            let through = &rays[lane][lane];
            let t = [0.0, 1.0, -1.0, 3.0][lane % 4] * scale / length;
            let at = through.origin + if t.is_finite() { through.direction * t } else { Vec3::ZERO };
            let [from, to] = [0, 1].map(|_| at + numbers.vector() * scale * width * [0.0, 1e-3, 1.0][lane % 3]);
            [from.min(to), from.max(to)]
        };
        let boxes = from_fn(|_| {
            let boxes: [[Vec3; 2]; LANES] = from_fn(&mut some_box);
            [Vector::of(boxes.map(|[min, _]| min)), Vector::of(boxes.map(|[_, max]| max))]
        });
        (rays.map(|rays| EightRays::of(&rays)), boxes)
    }

    /// No box that one of its rays meets is kept from a packet, or from that ray's group; and many others are.
    #[test]
    fn a_packet_meets_what_its_rays_meet() {
        let (mut met, mut missed, mut kept) = (0, 0, 0);
        for seed in 0..20_000 {
            let (rays, boxes) = story(seed);
            let groups: [Rays<F32x8>; GROUPS] = from_fn(|group| Rays::load(&rays[group], false));
            let packet = Packet::of(&groups);
            // Rays this way and that, whose products f32 rounds to zero, may be said to meet what is behind them.
            let (length, scale) = sizes(seed);
            if scale / length < two_to(-60) && packet.signs.contains(&DirectionSign::Mixed) {
                continue;
            }
            let within = [F32x8::ZERO, <F32x8 as Number>::splat(f32::MAX)];
            let [starts, ends] = packet.crossed(Node::EMPTY.boxes(), within);
            assert_eq!(starts.le(ends).bits(), 0, "seed {seed}: a box that is lacking is met");
            for boxes in boxes {
                let [starts, ends] = packet.crossed(boxes, within);
                let by_all = starts.le(ends).bits();
                for lane in 0..LANES {
                    let one = boxes.map(|corner| Vector::splat(corner.of_lane(lane)));
                    let [by_starts, by_ends] = packet.crossed_by_groups(one, within);
                    let by_groups = by_starts.le(by_ends).bits();
                    for (group, rays) in groups.iter().enumerate() {
                        let [enters, leaves] = crossed(one, rays);
                        let by_rays = enters.max(F32x8::ZERO).le(leaves.min(<F32x8 as Number>::splat(f32::MAX))).bits();
                        let may_meet = by_all >> lane & by_groups >> group & 1 == 1;
                        assert!(by_rays == 0 || may_meet, "seed {seed}: box {lane}, group {group}");
                        let first = set_bits(by_rays).map(|ray| enters.0[ray].max(0.0)).fold(f32::MAX, f32::min);
                        let start = starts.0[lane].max(by_starts.0[group]);
                        assert!(by_rays == 0 || start <= first, "seed {seed}: box {lane}, group {group}: {start}");
                        met += u32::from(by_rays != 0);
                        missed += u32::from(by_rays == 0);
                        kept += u32::from(!may_meet);
                    }
                }
            }
        }
        assert!(met > 100_000 && kept > missed / 3, "{met} are met, {kept} of {missed} kept away");
    }
}
