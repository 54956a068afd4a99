//! A ray by itself, against eight boxes or parts at a time.

use super::witness::{Nobody, Test, Witness};
use crate::accel::{Accelerator, List, PartId, Tree, Visitor};
use crate::bvh::{Child, LeafVisitor, Prefetch, Queue};
use crate::lanes::{Answers, Eight, Lanes, Work, set_bits};
use crate::ray::{Interval, Rays};
use crate::shape::{Crossable, Endless, SideBySide};
use std::ops::ControlFlow;

/// A ray, and what it has met.
pub(super) struct SingleRay<'p, N: Lanes, const ANY: bool, W = Nobody> {
    accel: &'p Accelerator,
    /// It is one of these.
    rays: &'p Rays<N>,
    lane: usize,
    /// `max` is where the closest was met, or where the interval ends.
    within: Interval,
    /// What was met.
    place: Option<u32>,
    witness: W,
}

impl<'p, N: Lanes, const ANY: bool> SingleRay<'p, N, ANY> {
    #[inline(always)]
    pub(super) fn new(accel: &'p Accelerator, rays: &'p Rays<N>, lane: usize, within: Interval) -> Self {
        Self::watched(accel, rays, lane, within, Nobody)
    }
}

impl<'p, N: Lanes, const ANY: bool, W: Witness> SingleRay<'p, N, ANY, W> {
    #[inline(always)]
    pub(super) fn watched(
        accel: &'p Accelerator,
        rays: &'p Rays<N>,
        lane: usize,
        within: Interval,
        witness: W,
    ) -> Self {
        Self { accel, rays, lane, within, place: None, witness }
    }

    /// A ray that has met this already.
    #[inline(always)]
    pub(super) fn going_on(self, place: Option<u32>) -> Self {
        Self { place, ..self }
    }

    /// Where it met what.
    #[inline(always)]
    pub(super) fn found(&self) -> (f32, Option<u32>) {
        (self.within.max, self.place)
    }

    /// Searches through everything.
    #[inline(always)]
    pub(super) fn trace(&mut self, queue: &mut Queue) {
        self.accel.visit(&mut Everything { ray: self, queue });
    }

    #[inline(always)]
    fn trace_list<S: Endless>(&mut self, list: &List<S>) {
        for (place, (id, surface)) in list.parts() {
            let crossing = surface
                .splat()
                .first_crossing(self.rays, N::splat(self.within.min))
                .and_then(|(crosses, t)| (crosses.bits() >> self.lane & 1 == 1).then(|| t.lane(self.lane)));
            if W::IS_THERE {
                self.witness.part(Test::of(*id, crossing));
            }
            if let Some(t) = crossing {
                self.meet(t, place);
            }
        }
    }

    #[inline(always)]
    fn trace_tree<S: SideBySide>(&mut self, tree: &Tree<S>, queue: &mut Queue) {
        match tree.bvh.root() {
            Some(root) if tree.has_tree() => self.trace_from(root, tree, queue),
            // The only leaf: what a tree takes to begin with would be most of the time.
            Some(_) if !(ANY && self.place.is_some()) => self.test(&self.rays.splat_lane(self.lane), 0, tree),
            _ => {}
        }
    }

    /// Searches through a part of a tree.
    #[inline(always)]
    pub(super) fn trace_from<S: SideBySide>(&mut self, from: Child, tree: &Tree<S>, queue: &mut Queue) {
        if ANY && self.place.is_some() {
            return;
        }
        N::apart(Search { ray: self, from, tree, queue });
    }

    #[inline(always)]
    fn test<S: SideBySide>(&mut self, rays: &Rays<N>, leaf: usize, tree: &Tree<S>) {
        let shapes = tree.leaves[leaf].load::<N>();
        let crossing = shapes.first_crossing(rays, N::splat(self.within.min));
        if W::IS_THERE {
            self.tell(tree.parts(leaf), crossing);
        }
        let Some((crosses, t)) = crossing else { return };
        let met = (crosses & t.le(N::splat(self.within.max))).bits();
        if met == 0 {
            return;
        }
        let t = t.store();
        for lane in set_bits(met) {
            self.meet(t.0[lane], tree.place(leaf, lane));
        }
    }

    /// Tells the witness of a leaf's parts.
    fn tell(&mut self, parts: impl Iterator<Item = PartId>, crossing: Option<(N::Mask, N)>) {
        let (crosses, t) = crossing.map_or((0, Eight::ZERO), |(crosses, t)| (crosses.bits(), t.store()));
        for (lane, id) in parts.enumerate() {
            self.witness.part(Test::of(id, (crosses >> lane & 1 == 1).then_some(t.0[lane])));
        }
    }

    /// Something at t.
    #[inline(always)]
    fn meet(&mut self, t: f32, place: u32) {
        let is_first = |other: u32| self.accel.id(place) < self.accel.id(other);
        if t < self.within.max || t == self.within.max && self.place.is_none_or(is_first) {
            self.place = Some(place);
            if !ANY {
                self.within.max = t;
            }
        }
    }
}

/// A ray's way through all parts.
struct Everything<'a, 'p, N: Lanes, const ANY: bool, W> {
    ray: &'a mut SingleRay<'p, N, ANY, W>,
    queue: &'a mut Queue,
}

impl<'p, N: Lanes, const ANY: bool, W: Witness> Visitor<'p> for Everything<'_, 'p, N, ANY, W> {
    #[inline(always)]
    fn list<S: Endless>(&mut self, list: &'p List<S>) {
        self.ray.trace_list(list);
    }

    #[inline(always)]
    fn tree<S: SideBySide>(&mut self, tree: &'p Tree<S>) {
        self.ray.trace_tree(tree, self.queue);
    }
}

/// A ray's way through a part of a tree.
struct Search<'a, 'p, N: Lanes, S, const ANY: bool, W> {
    ray: &'a mut SingleRay<'p, N, ANY, W>,
    from: Child,
    tree: &'a Tree<S>,
    queue: &'a mut Queue,
}

impl<N: Lanes, S: SideBySide, const ANY: bool, W: Witness> Work for Search<'_, '_, N, S, ANY, W> {
    type Output = ();

    /// The numbers are those that the ray has.
    #[inline(always)]
    fn run<Same: Lanes>(self) {
        let Self { ray, from, tree, queue } = self;
        let (rays, within) = (ray.rays.splat_lane(ray.lane), ray.within);
        let mut there = InTree { ray, rays: &rays, tree };
        if within.min >= 0.0 {
            tree.bvh.visit(from, &rays, within, queue, &mut there);
        } else {
            // The tree knows of nothing behind an origin; that is asked for too rarely for one that does.
            let _ = (0..tree.leaves.len()).try_for_each(|leaf| there.visit(leaf).map_continue(|_| ()));
        }
    }
}

/// A ray in a tree.
struct InTree<'a, 'p, N: Lanes, S, const ANY: bool, W> {
    ray: &'a mut SingleRay<'p, N, ANY, W>,
    /// The same in every place.
    rays: &'a Rays<N>,
    tree: &'a Tree<S>,
}

impl<N: Lanes, S, const ANY: bool, W> Prefetch for InTree<'_, '_, N, S, ANY, W> {
    #[inline(always)]
    fn prefetch(&self, leaf: usize) {
        self.tree.prefetch(leaf);
    }
}

impl<N: Lanes, S: SideBySide, const ANY: bool, W: Witness> LeafVisitor for InTree<'_, '_, N, S, ANY, W> {
    #[inline(always)]
    fn boxes(&mut self) {
        self.ray.witness.boxes();
    }

    #[inline(always)]
    fn visit(&mut self, leaf: usize) -> ControlFlow<(), f32> {
        self.ray.test(self.rays, leaf, self.tree);
        if ANY && self.ray.place.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(self.ray.within.max)
        }
    }
}
