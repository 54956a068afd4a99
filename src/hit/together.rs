//! Up to 64 rays, eight at a time.

use super::{Stacks, alone::Alone};
use crate::bounds::crossed;
use crate::bvh::{Child, GROUPS, Packet, Stack, Visitor};
use crate::hit::{EightHits, Kernel};
use crate::lanes::{Answers, Eight, LANES, Lanes, Mask, Vector};
use crate::ray::{EightRays, Interval, Rays};
use crate::scene::{Grove, Parts};
use crate::shape::{Crossable, SideBySide};

/// Rays in groups of eight, and what they have met.
pub(super) struct Together<'p, N: Lanes, const ANY: bool> {
    kernel: Kernel,
    parts: &'p Parts,
    rays: &'p [EightRays],
    groups: [Rays<N>; GROUPS],
    min: f32,
    /// Where the closest was met, or where the interval ends; of who has enough, before all.
    t: [N; GROUPS],
    /// The bits of its place.
    place: [N; GROUPS],
    /// The greatest t of each group.
    reach: Eight,
}

/// No part's place.
const NOTHING: u32 = EightHits::NOTHING;

/// If no more rays than these meet a node, they go on by themselves;
const SOME: u32 = 8;

/// or if no more than these of each group do.
const A_FEW: u32 = 2;

/// Nothing is met so early.
const DONE: f32 = f32::NEG_INFINITY;

#[inline(always)]
fn place_as_number(place: u32) -> f32 {
    f32::from_bits(place)
}

impl<'p, N: Lanes, const ANY: bool> Together<'p, N, ANY> {
    /// These are at most as many as a packet has, and at least one.
    #[inline(always)]
    pub(super) fn new(kernel: Kernel, parts: &'p Parts, rays: &'p [EightRays], within: Interval) -> Self {
        // Who is not asked about does not widen the packet.
        let one = rays.iter().find(|rays| rays.asked != 0).unwrap_or(&rays[0]);
        let mut packet = Self {
            kernel,
            parts,
            rays,
            groups: [Rays::load(one); GROUPS],
            min: within.min,
            t: [N::splat(DONE); GROUPS],
            place: [N::splat(place_as_number(NOTHING)); GROUPS],
            reach: Eight([DONE; LANES]),
        };
        for (group, rays) in rays.iter().enumerate().filter(|(_, rays)| rays.asked != 0) {
            packet.groups[group] = Rays::load(rays);
            packet.t[group] = N::select(N::answers(rays.asked), N::splat(within.max), N::splat(DONE));
            packet.reach.0[group] = within.max;
        }
        packet
    }

    /// Tells where each ray met what.
    #[inline(always)]
    pub(super) fn tell_hits(&self, hits: &mut Vec<EightHits>) {
        for group in 0..self.rays.len() {
            let (t, place) = (self.t[group].store(), self.place[group].store());
            hits.push(EightHits { t, places: place.0.map(f32::to_bits) });
        }
    }

    /// Tells which rays met anything, a bit for each.
    #[inline(always)]
    pub(super) fn tell_met(&self, met: &mut Vec<u32>) {
        for (group, rays) in self.rays.iter().enumerate() {
            met.push(self.t[group].le(N::splat(DONE)).bits() & rays.asked);
        }
    }

    /// Searches through everything.
    #[inline(always)]
    pub(super) fn trace(&mut self, stacks: &mut Stacks) {
        let parts = self.parts;
        for (place, (_, plane)) in (0..).zip(&parts.planes) {
            self.test_all(plane, place);
        }
        let mut packet = None;
        self.trace_grove(&parts.balls, &mut packet, stacks);
        self.trace_grove(&parts.triangles, &mut packet, stacks);
    }

    #[inline(always)]
    fn trace_grove<S: SideBySide>(&mut self, grove: &'p Grove<S>, packet: &mut Option<Packet<N>>, stacks: &mut Stacks) {
        if let Some(few) = grove.few {
            for lane in 0..few {
                self.test_all(&grove.leaves[0].shapes.splat(lane), grove.place(0, lane));
            }
        } else if self.reach.greatest() >= self.min {
            let packet = match packet {
                Some(packet) => packet,
                None => packet.insert(Packet::of(&self.groups)),
            };
            let Stacks { together, alone } = stacks;
            grove.bvh.visit_together(packet, together, &mut InGrove { rays: self, grove, packet, stack: alone });
        }
    }

    #[inline(always)]
    fn test_all<C: Crossable<N>>(&mut self, shape: &C, place: u32) {
        for group in 0..self.rays.len() {
            if self.reach.0[group] > DONE {
                self.test(group, shape, place);
            }
        }
    }

    #[inline(always)]
    fn test<C: Crossable<N>>(&mut self, group: usize, shape: &C, place: u32) {
        let Some((crosses, t)) = shape.first_crossing(&self.groups[group], N::splat(self.min)) else { return };
        let until = self.t[group];
        if ANY {
            let is_met = crosses & t.le(until);
            if is_met.any() {
                self.meet(group, is_met, N::splat(DONE), place);
            }
            return;
        }
        let mut is_closest = crosses & t.lt(until);
        let is_as_close = crosses & t.same(until);
        if is_as_close.any() {
            let mut first = Eight([0.0; LANES]);
            self.comes_before(place, &self.place[group].store(), &mut first);
            is_closest = is_closest | (is_as_close & N::splat(0.0).lt(N::load(&first)));
        }
        if is_closest.any() {
            self.meet(group, is_closest, t, place);
        }
    }

    #[inline(always)]
    fn meet(&mut self, group: usize, is_met: N::Mask, t: N, place: u32) {
        self.t[group] = N::select(is_met, t, self.t[group]);
        self.place[group] = N::select(is_met, N::splat(place_as_number(place)), self.place[group]);
        self.reach.0[group] = self.t[group].store().greatest();
    }

    /// 1 where that stands before the others in the scene.
    #[cold]
    fn comes_before(&self, place: u32, others: &Eight, first: &mut Eight) {
        for (first, other) in first.0.iter_mut().zip(others.0) {
            let other = other.to_bits();
            let is_first = other == NOTHING || self.parts.id(place) < self.parts.id(other);
            *first = f32::from(u8::from(is_first));
        }
    }
}

/// A packet in a tree.
struct InGrove<'a, 'p, N: Lanes, S, const ANY: bool> {
    rays: &'a mut Together<'p, N, ANY>,
    grove: &'p Grove<S>,
    packet: &'a Packet<N>,
    stack: &'a mut Stack,
}

impl<N: Lanes, S: SideBySide, const ANY: bool> Visitor<N> for InGrove<'_, '_, N, S, ANY> {
    #[inline(always)]
    fn min(&self) -> f32 {
        self.rays.min
    }

    #[inline(always)]
    fn reach(&self) -> N {
        N::load(&self.rays.reach)
    }

    #[inline(always)]
    fn farthest(&self) -> f32 {
        self.rays.reach.greatest()
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: usize) {
        let shapes = &self.grove.leaves[leaf].shapes;
        let min = N::splat(self.rays.min);
        let [enters, leaves] = self.packet.crossed(shapes.load::<N>().boxes());
        let mut is_met = enters.max(min).le(leaves.min(N::splat(self.farthest()))).bits();
        while is_met != 0 {
            let lane = is_met.trailing_zeros() as usize % LANES;
            is_met &= is_met - 1;
            let shape = shapes.splat::<N>(lane);
            let [enters, leaves] = self.packet.crossed_by_groups(shape.boxes());
            let mut groups = enters.max(min).le(leaves.min(self.reach())).bits();
            while groups != 0 {
                let group = groups.trailing_zeros() as usize % GROUPS;
                groups &= groups - 1;
                self.rays.test(group, &shape, self.grove.place(leaf, lane));
            }
        }
    }

    #[inline(always)]
    fn alone(&mut self, from: Child, one: [Vector<N>; 2], groups: u32) -> bool {
        if self.rays.kernel == Kernel::Packet {
            return groups == 0;
        }
        let min = N::splat(self.rays.min);
        let mut of_group = [0; GROUPS];
        let (mut left, mut count) = (groups, 0);
        while left != 0 {
            let group = left.trailing_zeros() as usize % GROUPS;
            left &= left - 1;
            let [enters, leaves] = crossed(one, &self.rays.groups[group]);
            of_group[group] = enters.max(min).le(leaves.min(self.rays.t[group])).bits();
            count += of_group[group].count_ones();
        }
        if count > SOME.max(groups.count_ones() * A_FEW) {
            return false;
        }
        left = groups;
        while left != 0 {
            let group = left.trailing_zeros() as usize % GROUPS;
            left &= left - 1;
            self.rays_alone(from, group, of_group[group]);
        }
        true
    }
}

impl<N: Lanes, S: SideBySide, const ANY: bool> InGrove<'_, '_, N, S, ANY> {
    /// Goes on with these rays of a group, a bit for each.
    #[inline(always)]
    fn rays_alone(&mut self, from: Child, group: usize, mut rays: u32) {
        if rays == 0 {
            return;
        }
        let (mut t, mut place) = (self.rays.t[group].store(), self.rays.place[group].store());
        while rays != 0 {
            let lane = rays.trailing_zeros() as usize % LANES;
            rays &= rays - 1;
            let within = Interval { min: self.rays.min, max: t.0[lane] };
            let known = place.0[lane].to_bits();
            let ray = Alone::<N, ANY>::new(self.rays.parts, &self.rays.rays[group].ray(lane), within);
            let mut ray = ray.going_on((known != NOTHING).then_some(known));
            ray.trace_from(from, self.grove, self.stack);
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
