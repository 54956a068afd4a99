//! Up to 64 rays, eight at a time.

use super::single::SingleRay;
use super::{Stacks, split};
use crate::accel::{self, Accelerator, List, Tree};
use crate::bounds::crossed;
use crate::bvh::{Child, GROUPS, Packet, Prefetch, Queue, Visitor};
use crate::hit::{EightHits, Kernel};
use crate::lanes::{Answers, Eight, LANES, Lanes, Mask, Vector, set_bits};
use crate::ray::{EightRays, Interval, Pencil, Rays};
use crate::shape::{Crossable, Endless, SideBySide};
use std::ops::Range;

/// Rays in groups of eight, and what they have met.
pub(super) struct PacketRays<'p, N: Lanes, const ANY: bool> {
    kernel: Kernel,
    accel: &'p Accelerator,
    rays: &'p [EightRays],
    groups: [Rays<N>; GROUPS],
    within: Interval,
    /// Where the closest was met, or where the interval ends; of who has enough, before all.
    t: [N; GROUPS],
    /// The bits of its place.
    place: [N; GROUPS],
    /// The greatest t of each group.
    reach: Eight,
    /// The greatest t of all, or one that was; kept, as it is asked for at each node and leaf.
    farthest: f32,
    /// How often one of the rays has left the packet at a node.
    left: u32,
    /// How many leaves the packet has met.
    leaves: u32,
}

/// No part's place.
const NOTHING: u32 = EightHits::NOTHING;

/// Nothing is met so early.
const DONE: f32 = f32::NEG_INFINITY;

#[inline(always)]
fn place_as_number(place: u32) -> f32 {
    f32::from_bits(place)
}

impl<'p, N: Lanes, const ANY: bool> PacketRays<'p, N, ANY> {
    /// No rays yet. A packet is some kilobytes: it stays where it is, and takes one lot of rays after the other.
    #[inline(always)]
    pub(super) fn new(kernel: Kernel, accel: &'p Accelerator, within: Interval) -> Self {
        let zeros = EightRays { origin: Vector::ZERO, direction: Vector::ZERO, asked: 0 };
        Self {
            kernel,
            accel,
            rays: &[],
            groups: [Rays::load(&zeros, false); GROUPS],
            within,
            t: [N::splat(DONE); GROUPS],
            place: [N::splat(place_as_number(NOTHING)); GROUPS],
            reach: Eight([DONE; LANES]),
            farthest: DONE,
            left: 0,
            leaves: 0,
        }
    }

    /// Whether the last rays had better been traced one by one from the start. Those of the packets that follow are likely
    /// to do the same.
    #[inline(always)]
    pub(super) fn was_useless(&self) -> bool {
        let active = self.rays.iter().map(|rays| rays.asked.count_ones()).sum();
        split::is_useless(self.leaves, self.left, active)
    }

    /// Takes these rays, at most as many as a packet has, and finds what they meet.
    #[inline(always)]
    pub(super) fn trace(&mut self, rays: &'p [EightRays], stacks: &mut Stacks) {
        (self.rays, self.left, self.leaves) = (rays, 0, 0);
        // Who is not asked about does not widen the packet.
        let Some(one) = rays.iter().find(|rays| rays.asked != 0) else { return self.reset(0..GROUPS) };
        let accel = self.accel;
        let (has_trees, needs_shear) = (accel.has_trees(), accel.needs_shear());
        for (group, of_group) in rays.iter().enumerate() {
            let asked = of_group.asked;
            let rays = Rays::load(if asked == 0 { one } else { of_group }, needs_shear);
            let met = self.test_few(&rays, asked);
            (self.t[group], self.place[group]) = (met.t, met.place);
            if has_trees {
                self.groups[group] = rays;
            }
        }
        if has_trees {
            self.reset(rays.len()..GROUPS);
            self.reach = N::greatest_of_each(&self.t).store();
            for group in rays.len()..GROUPS {
                self.groups[group] = self.groups[0];
            }
            accel.visit(&mut Trees { rays: self, packet: None, stacks });
        }
    }

    /// Has no rays in these groups.
    #[inline(always)]
    fn reset(&mut self, groups: Range<usize>) {
        for group in groups {
            self.t[group] = N::splat(DONE);
            self.place[group] = N::splat(place_as_number(NOTHING));
            self.reach.0[group] = DONE;
        }
    }

    /// Tells where each ray met what.
    #[inline(always)]
    pub(super) fn tell_hits(&self, hits: &mut Vec<EightHits>) {
        for group in 0..self.rays.len() {
            let place = self.place[group];
            let met = (!place.has_bits(NOTHING)).bits();
            hits.push(EightHits { met, t: self.t[group].store(), places: place.store() });
        }
    }

    /// Tells which rays met anything, a bit for each.
    #[inline(always)]
    pub(super) fn tell_met(&self, met: &mut Vec<u32>) {
        for (group, rays) in self.rays.iter().enumerate() {
            met.push(self.t[group].le(N::splat(DONE)).bits() & rays.asked);
        }
    }

    #[inline(always)]
    fn trace_tree<S: SideBySide>(&mut self, tree: &'p Tree<S>, packet: &mut Option<Packet<N>>, stacks: &mut Stacks) {
        self.update_farthest();
        if tree.has_tree() && self.farthest >= self.within.min {
            let packet = match packet {
                Some(packet) => packet,
                None => packet.insert(Packet::of(&self.groups)),
            };
            let Stacks { packet: stack, single: queue } = stacks;
            let groups = self.rays.len();
            let mut in_tree = InTree { rays: self, tree, packet, pencil: Sought::NotYet, queue };
            match tree.bvh.root() {
                Some(root) if in_tree.rays.kernel == Kernel::Auto && packet.is_scattered() => {
                    for group in 0..groups {
                        let waiting = !in_tree.rays.t[group].le(N::splat(DONE));
                        in_tree.trace_singles_of(root, group, waiting.bits());
                    }
                }
                _ => tree.bvh.visit_packet(packet, stack, &mut in_tree),
            }
        }
    }

    /// Has a group meet all that no tree leaves out: planes, and kinds of which there are but a few.
    #[inline(always)]
    fn test_few(&self, rays: &Rays<N>, asked: u32) -> Met<N, ANY> {
        let accel = self.accel;
        let t = N::select(N::answers(asked), N::splat(self.within.max), N::splat(DONE));
        let mut met = Met { t, place: N::splat(place_as_number(NOTHING)) };
        accel.visit(&mut Few { met: &mut met, rays, min: N::splat(self.within.min), accel });
        met
    }

    #[inline(always)]
    fn test<C: Crossable<N>>(&mut self, group: usize, shape: &C, place: u32, rough: N) {
        let mut met = Met::<N, ANY> { t: self.t[group], place: self.place[group] };
        let (rays, min) = (&self.groups[group], N::splat(self.within.min));
        if met.take(place, shape.first_crossing_in_pencil(rays, min, rough), self.accel) {
            self.set(group, met);
        }
    }

    /// Finds how far any ray still reaches, after rays have met something.
    #[inline(always)]
    fn update_farthest(&mut self) {
        self.farthest = N::load(&self.reach).greatest();
    }

    #[inline(always)]
    fn set(&mut self, group: usize, Met { t, place }: Met<N, ANY>) {
        self.t[group] = t;
        self.place[group] = place;
        self.reach.0[group] = t.greatest();
    }
}

/// What a group's rays have met.
struct Met<N, const ANY: bool> {
    t: N,
    place: N,
}

impl<N: Lanes, const ANY: bool> Met<N, ANY> {
    /// Tests all of which there are but a few.
    #[inline(always)]
    fn test_few<S: SideBySide>(&mut self, tree: &Tree<S>, rays: &Rays<N>, min: N, accel: &Accelerator) {
        let Some(leaf) = tree.leaves.first() else { return };
        for lane in 0..tree.few {
            let shape = leaf.splat(lane);
            self.take(tree.place(0, lane), shape.first_crossing(rays, min), accel);
        }
    }

    /// Takes a part where it is met; answers whether it is.
    #[inline(always)]
    fn take(&mut self, place: u32, crossing: Option<(N::Mask, N)>, accel: &Accelerator) -> bool {
        let Some((crosses, t)) = crossing else { return false };
        if ANY {
            return self.meet(crosses & t.le(self.t), N::splat(DONE), place);
        }
        let is_as_close = crosses & t.same(self.t);
        let mut is_closest = crosses & t.lt(self.t);
        if is_as_close.any() {
            let first = comes_before(accel, place, &self.place.store());
            is_closest = is_closest | (is_as_close & N::answers(first));
        }
        self.meet(is_closest, t, place)
    }

    #[inline(always)]
    fn meet(&mut self, is_met: N::Mask, t: N, place: u32) -> bool {
        let is_any = is_met.any();
        if is_any {
            self.t = N::select(is_met, t, self.t);
            self.place = N::select(is_met, N::splat(place_as_number(place)), self.place);
        }
        is_any
    }
}

/// A packet's way through all trees.
struct Trees<'a, 'p, N: Lanes, const ANY: bool> {
    rays: &'a mut PacketRays<'p, N, ANY>,
    packet: Option<Packet<N>>,
    stacks: &'a mut Stacks,
}

impl<'p, N: Lanes, const ANY: bool> accel::Visitor<'p> for Trees<'_, 'p, N, ANY> {
    #[inline(always)]
    fn list<S: Endless>(&mut self, _: &'p List<S>) {}

    #[inline(always)]
    fn tree<S: SideBySide>(&mut self, tree: &'p Tree<S>) {
        self.rays.trace_tree(tree, &mut self.packet, self.stacks);
    }
}

/// A group's way through all that no tree leaves out.
struct Few<'a, N: Lanes, const ANY: bool> {
    met: &'a mut Met<N, ANY>,
    rays: &'a Rays<N>,
    min: N,
    accel: &'a Accelerator,
}

impl<'p, N: Lanes, const ANY: bool> accel::Visitor<'p> for Few<'_, N, ANY> {
    #[inline(always)]
    fn list<S: Endless>(&mut self, list: &'p List<S>) {
        for (place, (_, surface)) in list.parts() {
            self.met.take(place, surface.splat().first_crossing(self.rays, self.min), self.accel);
        }
    }

    #[inline(always)]
    fn tree<S: SideBySide>(&mut self, tree: &'p Tree<S>) {
        self.met.test_few(tree, self.rays, self.min, self.accel);
    }
}

/// Which of the others it stands before in the scene: a bit for each.
#[cold]
fn comes_before(accel: &Accelerator, place: u32, others: &Eight) -> u32 {
    let is_first = |other: u32| other == NOTHING || accel.id(place) < accel.id(other);
    others.0.iter().rev().fold(0, |first, other| first << 1 | u32::from(is_first(other.to_bits())))
}

/// A packet in a tree.
struct InTree<'a, 'p, N: Lanes, S, const ANY: bool> {
    rays: &'a mut PacketRays<'p, N, ANY>,
    tree: &'p Tree<S>,
    packet: &'a Packet<N>,
    pencil: Sought<N>,
    queue: &'a mut Queue,
}

/// The pencil of a packet, which only a leaf asks for: packets that meet none do without. That makes eye rays 1 to 2 %
/// faster where meshes cover half of the picture.
enum Sought<N: Lanes> {
    NotYet,
    Missing,
    Found(Pencil<N>),
}

impl<N: Lanes, S, const ANY: bool> Prefetch for InTree<'_, '_, N, S, ANY> {
    #[inline(always)]
    fn prefetch(&self, leaf: usize) {
        self.tree.prefetch(leaf);
    }
}

impl<N: Lanes, S: SideBySide, const ANY: bool> Visitor<N> for InTree<'_, '_, N, S, ANY> {
    const NEAREST_FIRST: bool = !ANY;

    const LEAST_SPLIT: u32 = split::least_split(ANY);

    #[inline(always)]
    fn min(&self) -> f32 {
        self.rays.within.min
    }

    #[inline(always)]
    fn reach(&self) -> N {
        N::load(&self.rays.reach)
    }

    #[inline(always)]
    fn farthest(&self) -> f32 {
        self.rays.farthest
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: usize) {
        let shapes = &self.tree.leaves[leaf];
        let min = N::splat(self.rays.within.min);
        let boxes = shapes.load::<N>().boxes();
        let [starts, ends] = self.packet.crossed(boxes, [min, N::splat(self.farthest())]);
        let is_met = starts.le(ends).bits();
        if is_met == 0 {
            return;
        }
        self.rays.leaves += 1;
        self.seek_pencil();
        let edges = match &self.pencil {
            Sought::Found(pencil) => shapes.edges(pencil),
            _ => None,
        };
        let rough = match &edges {
            Some(edges) => edges.rough,
            None => Eight([f32::INFINITY; LANES]),
        };
        let [low, high] = [boxes[0].store(), boxes[1].store()];
        // All that are to be tested, a bit for each: a loop over them is guessed wrong once, at its end.
        let mut pairs = 0_u64;
        for lane in set_bits(is_met) {
            let one = [Vector::splat(low.of_lane(lane)), Vector::splat(high.of_lane(lane))];
            let [starts, ends] = self.packet.crossed_by_groups(one, [min, self.reach()]);
            let mut groups = starts.le(ends).bits();
            // Any blocker will do, and next to it the edges let few groups off: without them shadow rays are 5 % faster.
            if let (false, Some(edges), Sought::Found(pencil)) = (ANY, &edges, &self.pencil) {
                groups &= !edges.passed_by(lane, pencil);
            }
            pairs |= u64::from(groups) << (GROUPS * lane);
        }
        if pairs == 0 {
            return;
        }
        while pairs != 0 {
            let (lane, group) =
                (pairs.trailing_zeros() as usize / GROUPS % LANES, pairs.trailing_zeros() as usize % GROUPS);
            pairs &= pairs.wrapping_sub(1);
            self.rays.test(group, &shapes.splat(lane), self.tree.place(leaf, lane), N::splat(rough.0[lane]));
        }
        self.rays.update_farthest();
    }

    #[inline(always)]
    fn split(&self, one: [Vector<N>; 2], groups: u32) -> Option<[u32; GROUPS]> {
        if self.rays.kernel == Kernel::Packet {
            return None;
        }
        split::at_node::<ANY>(groups, &AtNode { rays: self.rays, one })
    }

    #[inline(always)]
    fn trace_singles(&mut self, from: Child, rays: [u32; GROUPS], groups: u32) {
        for group in set_bits(groups) {
            self.trace_singles_of(from, group, rays[group]);
        }
        self.rays.update_farthest();
    }
}

/// A packet before a box.
struct AtNode<'a, 'p, N: Lanes, const ANY: bool> {
    rays: &'a PacketRays<'p, N, ANY>,
    one: [Vector<N>; 2],
}

impl<N: Lanes, const ANY: bool> split::AtNode for AtNode<'_, '_, N, ANY> {
    #[inline(always)]
    fn met_by(&self, group: usize) -> u32 {
        let [enters, leaves] = crossed(self.one, &self.rays.groups[group]);
        enters.max(N::splat(self.rays.within.min)).le(leaves.min(self.rays.t[group])).bits()
    }
}

impl<N: Lanes, S: SideBySide, const ANY: bool> InTree<'_, '_, N, S, ANY> {
    /// Finds the pencil if it was not asked for before.
    #[inline(always)]
    fn seek_pencil(&mut self) {
        if let Sought::NotYet = self.pencil {
            let pencil = if S::HAVE_EDGES { Pencil::of(&self.rays.groups) } else { None };
            self.pencil = match pencil {
                Some(pencil) => Sought::Found(pencil),
                None => Sought::Missing,
            };
        }
    }

    /// Goes on with these rays of a group, a bit for each.
    #[inline(always)]
    fn trace_singles_of(&mut self, from: Child, group: usize, rays: u32) {
        if rays == 0 {
            return;
        }
        self.rays.left += rays.count_ones();
        let (mut t, mut place) = (self.rays.t[group].store(), self.rays.place[group].store());
        for lane in set_bits(rays) {
            let within = Interval { min: self.rays.within.min, max: t.0[lane] };
            let known = place.0[lane].to_bits();
            let ray = SingleRay::<N, ANY>::new(self.rays.accel, &self.rays.groups[group], lane, within);
            let mut ray = ray.going_on((known != NOTHING).then_some(known));
            ray.trace_from(from, self.tree, self.queue);
            if let (met, Some(found)) = ray.found() {
                t.0[lane] = if ANY { DONE } else { met };
                place.0[lane] = place_as_number(found);
            }
        }
        self.rays.t[group] = N::load(&t);
        self.rays.place[group] = N::load(&place);
        self.rays.reach.0[group] = t.greatest();
    }
}
