//! Packet traversal: 64 rays go through the tree together.
//!
//! A packet keeps the ranges of its rays' origins and inverse directions, and computes with these intervals as
//! [`Bounds::crossed`](crate::bounds::Bounds::crossed) does with one ray (Boulos, Wald and Shirley, Geometric and
//! Arithmetic Culling Methods for Entire Ray Packets, 2006). No ray enters a box before the start of the packet's
//! interval, or leaves it after the end (`culling.md`, 5). The rays of a packet need no projection center: shadow rays
//! start at surface points, as in single-ray traversal.

use super::{Bvh, Child, PacketStack, Prefetch, StackEntry, push_all_but_last, push_all_but_nearest};
use crate::lanes::{LANES, LaneMask, Lanes, Mask, Vector, set_bits};
use crate::ray::Rays;

/// The number of groups of eight rays in a packet.
pub const GROUPS: usize = LANES;

/// The ranges of the origins and inverse directions of a packet's rays.
#[derive(Clone, Copy, Debug)]
pub struct Packet<N> {
    signs: [DirectionSign; 3],
    /// The ranges over all rays, for each axis; the same in every lane.
    all: [AxisRanges<N>; 3],
    /// The ranges over the eight rays of each group, for each axis; one group per lane.
    groups: [AxisRanges<N>; 3],
}

/// The signs of the directions along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DirectionSign {
    Forward,
    Backward,
    /// Both signs, or zero, or magnitudes too far apart for the bounds of one sign.
    Mixed,
}

/// The ranges of origins and inverse directions along an axis.
///
/// For directions of one sign, index 0 bounds entries into boxes and index 1 exits; for mixed signs, index 0 bounds
/// entries of forward rays and index 1 those of backward rays.
#[derive(Clone, Copy, Debug)]
struct AxisRanges<N> {
    origin: [N; 2],
    inverse: [N; 2],
}

/// The relative widening of inverse directions at both ends: 128 units of 2^-24 (`culling.md`, 5).
// The inverses are widened once per packet, which saves widening t in each test: 19 operations per box instead of 38.
const PACKET_SLACK: f32 = 128.0 / 16_777_216.0;

/// The least magnitude of an inverse that can be widened by a relative amount: 2^-124.
///
/// From this magnitude on, the widened inverse is a normal (not a subnormal) number (`culling.md`, 5).
const MIN_INVERSE: f32 = 4.0 * f32::MIN_POSITIVE;

/// The largest ratio between inverses of a packet whose directions have one sign: 2^40.
// The t at which a ray leaves a box behind its origin may round to zero. The packet computes that t from another ray's
// inverse, and the ratio limits how far below zero its result may lie (`culling.md`, 5).
const MAX_INVERSE_RATIO: f32 = 1_099_511_627_776.0;

/// The amount that is added to the t at which a packet leaves a box: 2^-100.
// The t at which a ray leaves a box behind its origin rounds to zero if it is above -2^-150. The packet's t may be
// about `MAX_INVERSE_RATIO` times as far below zero, and this amount lifts it above zero (`culling.md`, 5).
const EXIT_SLACK: f32 = 1.0 / (MAX_INVERSE_RATIO * MAX_INVERSE_RATIO * 1_048_576.0);

/// Returns the minimum and the maximum of each group, one group per lane.
// `min_of_each` and `max_of_each` take three rounds of shuffles over eight registers. When the values were compared one
// by one in memory, a frame of 100,000 spheres took 1.18 times as long.
#[inline(always)]
fn group_ranges<N: Lanes>(groups: [N; GROUPS]) -> [N; 2] {
    [N::min_of_each(&groups), N::max_of_each(&groups)]
}

/// Returns the range of all groups from the range of each.
#[inline(always)]
fn total_range<N: Lanes>([low, high]: [N; 2]) -> [N; 2] {
    [N::splat(low.store().reduce_min()), N::splat(high.store().reduce_max())]
}

impl<N: Lanes> AxisRanges<N> {
    /// Returns the sign of the directions along an axis, and the ranges over each group and over
    /// all rays.
    #[inline(always)]
    fn sign_and_ranges(origin: [N; GROUPS], inverse: [N; GROUPS]) -> (DirectionSign, [Self; 2]) {
        let origin = group_ranges(origin);
        let [low, high] = group_ranges(inverse);
        // The range of all rays follows from the groups' ranges, without another pass over the rays.
        let (all_origin, all_inverse) = (total_range(origin), total_range([low, high]));
        let sign = DirectionSign::of_range(all_inverse);
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
    fn of_one_sign(
        sign: DirectionSign,
        [least_origin, greatest_origin]: [N; 2],
        [least_inverse, greatest_inverse]: [N; 2],
    ) -> Self {
        let (less, more) = (N::splat(1.0 - PACKET_SLACK), N::splat(1.0 + PACKET_SLACK));
        match sign {
            DirectionSign::Backward => Self {
                origin: [least_origin, greatest_origin],
                inverse: [greatest_inverse * less, least_inverse * more],
            },
            _ => Self {
                origin: [greatest_origin, least_origin],
                inverse: [least_inverse * less, greatest_inverse * more],
            },
        }
    }

    #[inline(always)]
    fn of_mixed_signs([least_origin, greatest_origin]: [N; 2], [least_positive, greatest_negative]: [N; 2]) -> Self {
        let (less, half) = (N::splat(1.0 - PACKET_SLACK), N::splat(0.5));
        // A subnormal inverse has too few digits for a relative widening, so it is halved. The half is not zero, as no
        // inverse is below 2^-128.
        let (above, below) = (least_positive, greatest_negative);
        let above = N::select(above.lt(N::splat(MIN_INVERSE)), above * half, above * less);
        let below = N::select(N::splat(-MIN_INVERSE).lt(below), below * half, below * less);
        Self { origin: [greatest_origin, least_origin], inverse: [above, below] }
    }

    /// Returns a lower bound of the t at which rays enter the slab from `min` to `max`, and an
    /// upper bound of the t at which they leave it.
    ///
    /// The bounds hold for rays that are in the slab at some t >= 0.
    // With directions of one sign, the least t of an entry is the least distance times the least inverse, and the
    // greatest t of an exit is the product of the greatest ones. For planes behind the origin the distance is negative,
    // and only the sign of the product counts. So one product per side suffices. With two, one for each end of the
    // inverses, packets took up to 1.16 times as long.
    #[inline(always)]
    fn slab_range(&self, sign: DirectionSign, min: N, max: N) -> [N; 2] {
        let Self { origin, inverse } = *self;
        let (near, far) = match sign {
            DirectionSign::Forward => (min, max),
            DirectionSign::Backward => (max, min),
            // Forward rays enter at the minimum, backward rays at the maximum. The larger of both bounds is taken: for
            // a ray that hits the box at t >= 0, the bound for the other sign is at most 0. Exits are unbounded.
            DirectionSign::Mixed => {
                let (forward, backward) = ((min - origin[0]) * inverse[0], (max - origin[1]) * inverse[1]);
                return [forward.max(backward.max(N::splat(f32::NEG_INFINITY))), N::splat(f32::INFINITY)];
            }
        };
        [(near - origin[0]) * inverse[0], (far - origin[1]) * inverse[1]]
    }
}

impl DirectionSign {
    /// Classifies the range of a packet's inverse directions along an axis.
    #[inline(always)]
    fn of_range<N: Lanes>([low, high]: [N; 2]) -> Self {
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
    /// Returns the packet of the rays in `groups`: the ranges over each group and over all rays.
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
        let (x, [groups_x, all_x]) = AxisRanges::sign_and_ranges(ox, ix);
        let (y, [groups_y, all_y]) = AxisRanges::sign_and_ranges(oy, iy);
        let (z, [groups_z, all_z]) = AxisRanges::sign_and_ranges(oz, iz);
        Self { signs: [x, y, z], groups: [groups_x, groups_y, groups_z], all: [all_x, all_y, all_z] }
    }

    /// Returns whether the directions have mixed signs along two axes or more.
    // A packet with mixed signs along two axes culls hardly any box: its rays are 1.2 to 1.5 times as fast when they
    // are traced singly from the root.
    #[inline(always)]
    pub fn is_incoherent(&self) -> bool {
        self.signs.iter().filter(|&&sign| sign == DirectionSign::Mixed).count() > 1
    }

    /// Returns the range of t in which the packet crosses each of eight boxes.
    ///
    /// The range is clipped to `within`, which starts at 0 or later.
    #[inline(always)]
    pub fn crossed(&self, boxes: [Vector<N>; 2], within: [N; 2]) -> [N; 2] {
        crossed(&self.all, self.signs, boxes, within)
    }

    /// Returns the range of t in which each group of eight rays crosses the box `one`.
    ///
    /// Each lane holds the range of one group, clipped to `within`.
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

/// The visitor of a packet's traversal.
pub trait PacketVisitor<N>: Prefetch {
    /// Whether nearer boxes are visited first, so that hits in them shorten the rays early.
    // For any-hit rays sorting costs more than it saves: without it shadow rays are 6 % faster on the dragon's 871 k
    // triangles.
    const NEAREST_FIRST: bool;

    /// The least number of hit children of a node for which [`split`](Self::split) is called.
    const MIN_CHILDREN_TO_SPLIT: u32;

    /// Returns the lower end of the rays' interval: 0 or more.
    fn t_min(&self) -> f32;

    /// Returns the largest upper end of the rays' intervals in each group, one group per lane.
    fn group_t_max(&self) -> N;

    /// Returns an upper bound of the upper ends of all rays' intervals.
    fn packet_t_max(&self) -> f32;

    /// Tests the primitives of a leaf.
    fn visit_leaf(&mut self, leaf: usize);

    /// Returns the rays to trace singly from a node down, as a mask for each group.
    ///
    /// Returns `None` if the packet continues as a whole. `node_box` is the box of the node in all lanes, and `groups`
    /// the mask of groups that may hit it, which is not 0.
    fn split(&self, node_box: [Vector<N>; 2], groups: u32) -> Option<[u32; GROUPS]>;

    /// Traces the masked rays of the masked groups singly, from a node down.
    fn trace_singles(&mut self, from: Child, rays: [u32; GROUPS], groups: u32);
}

impl Bvh {
    /// Returns the box of child `slot % 8` of node `slot / 8`, in all lanes.
    #[inline(always)]
    fn box_at<N: Lanes>(&self, slot: u32) -> [Vector<N>; 2] {
        self.nodes[slot as usize / LANES].child_box(slot as usize % LANES)
    }

    /// Visits the leaves that rays of a packet may hit.
    #[inline(always)]
    pub fn visit_packet<N: Lanes, V: PacketVisitor<N>>(
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
            // Since this child was pushed, all rays may have found hits nearer than its box.
            if start > visitor.packet_t_max() {
                continue;
            }
            if let Some(leaf) = child.as_leaf() {
                visitor.visit_leaf(leaf);
                continue;
            }
            // The root has no box of its own to test.
            let is_root = slot == u32::MAX;
            let mut groups = 0;
            if !is_root {
                // The ranges of a group are narrower than those of the packet: many boxes that the packet may hit are
                // hit by none of its groups.
                let [starts, ends] = packet.crossed_by_groups(self.box_at(slot), [min, visitor.group_t_max()]);
                groups = starts.le(ends).bits();
                if groups == 0 {
                    continue;
                }
            }
            let node = &self.nodes[child.0 as usize];
            let [starts, ends] = packet.crossed(node.boxes(), [min, N::splat(visitor.packet_t_max())]);
            let hit_mask = starts.le(ends).bits();
            // Loads the box a second time: kept in registers during the test of the node, it made shadow rays 5 %
            // slower.
            if !is_root
                && hit_mask.count_ones() >= V::MIN_CHILDREN_TO_SPLIT
                && let Some(rays) = visitor.split(self.box_at(slot), groups)
            {
                visitor.trace_singles(child, rays, groups);
                continue;
            }
            // Prefetches all hit children: they will be visited, most of them soon.
            for lane in set_bits(hit_mask) {
                self.prefetch(node.children[lane], visitor);
            }
            next = if V::NEAREST_FIRST {
                push_all_but_nearest(node, child, hit_mask, &starts.store(), waiting)
            } else {
                push_all_but_last(node, child, hit_mask, &starts.store(), waiting)
            };
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
