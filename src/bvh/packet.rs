//! Packets: many rays on their way through the tree together.
//!
//! A packet knows between what its rays' origins and inverse directions lie, and reckons with these intervals as
//! [`Bounds::crossed`](crate::bounds::Bounds::crossed) does with one ray: as each step of that is monotone, in IEEE
//! arithmetic as on paper, no ray of the packet enters a box before the packet does, or leaves it later, bit for bit. (Boulos,
//! Wald and Shirley, Geometric and Arithmetic Culling Methods for Entire Ray Packets, 2006.)

use super::{Bvh, Child, Prefetch, Stack, Waiting, in_any_order, nearest_first};
use crate::bounds::common;
use crate::lanes::{Answers, LANES, Lanes, Mask, Vector, set_bits};
use crate::ray::Rays;

/// So many groups of eight rays are a packet.
pub const GROUPS: usize = LANES;

/// What encloses the rays of a packet.
#[derive(Clone, Copy, Debug)]
pub struct Packet<N> {
    senses: [Sense; 3],
    /// All of its rays, the same in every place.
    all: [Hull<N>; 3],
    /// Group by group.
    groups: [Hull<N>; 3],
}

/// Which way rays go along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sense {
    Forward,
    Backward,
    /// This way and that, or not at all.
    Mixed,
}

/// Between what rays lie along an axis.
#[derive(Clone, Copy, Debug)]
struct Hull<N> {
    origin: [N; 2],
    /// Of mixed rays, the greatest below zero and the least above it.
    inverse: [N; 2],
}

/// Between what the numbers of each group lie.
#[inline(always)]
fn extremes<N: Lanes>(groups: [N; GROUPS]) -> [N; 2] {
    [N::least_of_each(&groups), N::greatest_of_each(&groups)]
}

/// The least of the first and the greatest of the second.
#[inline(always)]
fn extreme<N: Lanes>([low, high]: [N; 2]) -> [N; 2] {
    [N::splat(low.store().least()), N::splat(high.store().greatest())]
}

impl<N: Lanes> Hull<N> {
    /// The hull of each group and that of all.
    #[inline(always)]
    fn of(origin: [N; GROUPS], inverse: [N; GROUPS]) -> (Sense, [Self; 2]) {
        let origin = extremes(origin);
        let [low, high] = extremes(inverse);
        let zero = N::splat(0.0);
        let sense = if (zero.lt(low) & high.le(N::splat(f32::MAX))).all() {
            Sense::Forward
        } else if (high.lt(zero) & N::splat(f32::MIN).le(low)).all() {
            Sense::Backward
        } else {
            Sense::Mixed
        };
        if sense == Sense::Mixed {
            let (plus, minus) = (N::splat(f32::INFINITY), N::splat(f32::NEG_INFINITY));
            let (mut above, mut below) = (inverse, inverse);
            for (above, below) in above.iter_mut().zip(&mut below) {
                *above = N::select(zero.lt(*above), *above, plus);
                *below = N::select(below.lt(zero), *below, minus);
            }
            let (above, below) = (extremes(above)[0], extremes(below)[1]);
            let [least, _] = extreme([above, above]);
            let [_, greatest] = extreme([below, below]);
            let all = Self { origin: extreme(origin), inverse: [greatest, least] };
            (sense, [Self { origin, inverse: [below, above] }, all])
        } else {
            let all = Self { origin: extreme(origin), inverse: extreme([low, high]) };
            (sense, [Self { origin, inverse: [low, high] }, all])
        }
    }

    /// Not after the first ray enters, not before the last one leaves; of those that do so at t >= 0.
    #[inline(always)]
    fn way(&self, sense: Sense, min: N, max: N) -> [N; 2] {
        let Self { origin: [first, last], inverse: [low, high] } = *self;
        let (near, far) = match sense {
            Sense::Forward => (min - last, max - first),
            Sense::Backward => (max - first, min - last),
            // Who goes forward enters at the least coordinates, who goes backward at the greatest; the other way, the box
            // is behind it.
            Sense::Mixed => {
                let (forward, backward) = ((min - last) * high, (max - first) * low);
                return [forward.max(backward.max(N::splat(f32::NEG_INFINITY))), N::splat(f32::INFINITY)];
            }
        };
        [(near * low).min(near * high), (far * low).max(far * high)]
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
        let (x, [groups_x, all_x]) = Hull::of(ox, ix);
        let (y, [groups_y, all_y]) = Hull::of(oy, iy);
        let (z, [groups_z, all_z]) = Hull::of(oz, iz);
        Self { senses: [x, y, z], groups: [groups_x, groups_y, groups_z], all: [all_x, all_y, all_z] }
    }

    /// Whether its rays go this way and that along most axes: then it keeps hardly any box from them.
    #[inline(always)]
    pub fn is_scattered(&self) -> bool {
        self.senses.iter().filter(|&&sense| sense == Sense::Mixed).count() > 1
    }

    /// Between what its rays cross each of eight boxes.
    #[inline(always)]
    pub fn crossed(&self, boxes: [Vector<N>; 2]) -> [N; 2] {
        crossed(&self.all, self.senses, boxes)
    }

    /// Between what the rays of each group cross one box.
    #[inline(always)]
    pub fn crossed_by_groups(&self, one: [Vector<N>; 2]) -> [N; 2] {
        crossed(&self.groups, self.senses, one)
    }
}

#[inline(always)]
fn crossed<N: Lanes>([x, y, z]: &[Hull<N>; 3], senses: [Sense; 3], [min, max]: [Vector<N>; 2]) -> [N; 2] {
    common([x.way(senses[0], min.x, max.x), y.way(senses[1], min.y, max.y), z.way(senses[2], min.z, max.z)])
}

/// What becomes of a packet in a tree.
pub trait Visitor<N>: Prefetch {
    /// Whether nearer boxes are visited before farther ones: what is found there may end the rays before those. Where any
    /// hit will do, sorting takes longer than it saves: without it shadow rays are 6 % faster on the dragon's 871 k
    /// triangles.
    const NEAREST_FIRST: bool;

    /// From where on rays are of interest: 0 or more.
    fn min(&self) -> f32;

    /// Up to where the rays of each group are.
    fn reach(&self) -> N;

    /// Up to where any of them is.
    fn farthest(&self) -> f32;

    /// Tests what is in a leaf.
    fn leaf(&mut self, leaf: usize);

    /// Returns the mask of rays of each group that go on as single rays from a node that these groups may meet, a bit for
    /// each, or nothing if the packet goes on. The box is that around the node.
    fn split(&self, one: [Vector<N>; 2], groups: u32) -> Option<[u32; GROUPS]>;

    /// Traces single rays of these groups from a node on.
    fn trace_singles(&mut self, from: Child, rays: [u32; GROUPS], groups: u32);
}

impl Bvh {
    /// Visits the leaves that a packet meets.
    #[inline(always)]
    pub fn visit_packet<N: Lanes, V: Visitor<N>>(
        &self,
        packet: &Packet<N>,
        Stack(waiting): &mut Stack,
        visitor: &mut V,
    ) {
        let Some(root) = self.root() else { return };
        waiting.clear();
        let min = N::splat(visitor.min());
        let mut next = Some(Waiting { child: root, place: u32::MAX, start: visitor.min() });
        while let Some(Waiting { child, place, start }) = next.take().or_else(|| waiting.pop()) {
            if start > visitor.farthest() {
                continue;
            }
            if let Some(leaf) = child.as_leaf() {
                visitor.leaf(leaf);
                continue;
            }
            if place != u32::MAX {
                let one = self.nodes[place as usize / LANES].one(place as usize % LANES);
                let [enters, leaves] = packet.crossed_by_groups(one);
                let groups = enters.max(min).le(leaves.min(visitor.reach())).bits();
                if let Some(rays) = visitor.split(one, groups) {
                    visitor.trace_singles(child, rays, groups);
                    continue;
                }
            }
            let node = &self.nodes[child.0 as usize];
            let [enters, leaves] = packet.crossed(node.boxes());
            let starts = enters.max(min);
            let is_met = starts.le(leaves.min(N::splat(visitor.farthest()))).bits();
            for lane in set_bits(is_met) {
                self.prefetch(node.children[lane], visitor);
            }
            next = if V::NEAREST_FIRST {
                nearest_first(node, child, is_met, &starts.store(), waiting)
            } else {
                in_any_order(node, child, is_met, &starts.store(), waiting)
            };
        }
    }
}
