//! Single-ray traversal: one ray against eight boxes or primitives at a time.

use super::instances::{self, InstanceSearchOn};
use super::observer::{Observation, PrimitiveTest, Unobserved};
use crate::accel::{Accelerator, Instances, List, ListVisitor, PrimitiveId, Tree};
use crate::bvh::{Child, LeafVisitor, Prefetch, RayStack};
use crate::lanes::{F32x8, LaneMask, Lanes, SimdKernel, set_bits};
use crate::ray::{Interval, Rays};
use crate::shape::{Crossable, Endless, SoaLeaf};
use std::ops::ControlFlow;

// The values of the const parameter `ANY`. It is a parameter, not a field, so that each traversal is compiled without
// the other's branches: the one for any hit needs no sorting, no culling by edge functions and no t.
/// The value for closest hits.
pub(super) const CLOSEST: bool = false;
/// The value for any hit.
pub(super) const ANY: bool = true;

/// A single ray in traversal, and its hit so far.
pub(super) struct SingleRay<'p, N: Lanes, const ANY: bool, W = Unobserved> {
    accel: &'p Accelerator,
    /// The group of eight rays that the ray belongs to.
    // The ray is stored as a lane of its group: a test spreads its values over a register by shuffles. Loaded from
    // memory instead, single rays of three_spheres ran at 45 instead of 58 Mrays/s.
    rays: &'p Rays<N>,
    /// The lane of the ray in the group.
    lane: usize,
    /// The interval of t. For closest hits `max` is the closest hit so far or the interval's end.
    within: Interval,
    /// The index of the primitive hit so far.
    primitive: Option<u32>,
    observer: W,
}

impl<'p, N: Lanes, const ANY: bool> SingleRay<'p, N, ANY> {
    /// Returns a single ray, the ray of lane `lane`, whose tests are not observed.
    #[inline(always)]
    pub(super) fn new(accel: &'p Accelerator, rays: &'p Rays<N>, lane: usize, within: Interval) -> Self {
        Self::observed(accel, rays, lane, within, Unobserved)
    }
}

impl<'p, N: Lanes, const ANY: bool, W: Observation> SingleRay<'p, N, ANY, W> {
    /// Returns a single ray, the ray of lane `lane`, whose tests are reported to `observer`.
    #[inline(always)]
    pub(super) fn observed(
        accel: &'p Accelerator,
        rays: &'p Rays<N>,
        lane: usize,
        within: Interval,
        observer: W,
    ) -> Self {
        Self { accel, rays, lane, within, primitive: None, observer }
    }

    /// Returns the ray with `primitive` as its hit so far, found by its packet at `within.max`.
    #[inline(always)]
    pub(super) fn with_known_hit(self, primitive: Option<u32>) -> Self {
        Self { primitive, ..self }
    }

    /// Returns the t and the primitive of the hit.
    #[inline(always)]
    pub(super) fn t_and_primitive(&self) -> (f32, Option<u32>) {
        (self.within.max, self.primitive)
    }

    /// Finds the hit among all primitives.
    #[inline(always)]
    pub(super) fn trace(&mut self, stack: &mut RayStack) {
        self.accel.visit(&mut AllPrimitives { ray: self, stack });
    }

    /// Finds the hit among the unbounded primitives of a list.
    // Tests the whole group and takes one lane of the result: the group's values are in registers already, which gave
    // three_spheres 65.1 instead of 60.3 Mrays/s.
    #[inline(always)]
    fn trace_list<S: Endless>(&mut self, list: &List<S>) {
        for (primitive, (id, surface)) in list.iter() {
            let crossing = surface
                .splat()
                .first_crossing(self.rays, N::splat(self.within.min))
                .and_then(|(crosses, t)| (crosses.bits() >> self.lane & 1 == 1).then(|| t.lane(self.lane)));
            if W::ENABLED {
                self.observer.primitive_tested(PrimitiveTest::from_crossing(*id, crossing));
            }
            if let Some(t) = crossing {
                self.record_if_closest(t, primitive);
            }
        }
    }

    /// Finds the hit among the primitives of a tree.
    #[inline(always)]
    fn trace_tree<S: SoaLeaf>(&mut self, tree: &Tree<S>, stack: &mut RayStack) {
        match tree.bvh.root() {
            Some(root) if tree.has_nodes() => self.trace_from(root, tree, stack),
            // A single leaf is tested without a traversal, whose set-up would take most of the time: this makes single
            // rays of three_spheres a third faster.
            Some(_) if !(ANY && self.primitive.is_some()) => self.test_leaf(&self.rays.splat_lane(self.lane), 0, tree),
            _ => {}
        }
    }

    /// Finds the hit among the instances of meshes.
    #[inline(always)]
    pub(super) fn trace_instances(&mut self, instances: &'p Instances, stack: &mut RayStack) {
        if ANY && self.primitive.is_some() {
            return;
        }
        let (rays, Self { accel, within, primitive, .. }) = (&self.rays.splat_lane(self.lane), &*self);
        let (accel, within, primitive) = (*accel, *within, *primitive);
        let search =
            instances::InstanceSearch { accel, instances, rays, within, primitive, observer: &mut self.observer };
        (self.within.max, self.primitive) = N::call_no_inline(InstanceSearchOn::<N, ANY, W> { search, stack });
    }

    /// Finds the hit below a node or leaf of a tree.
    // The search itself is not inlined: inside the packet's function, the single ray's values were in memory instead of
    // in registers. A separate function saved 14 to 16 % of the instructions of incoherent rays.
    #[inline(always)]
    pub(super) fn trace_from<S: SoaLeaf>(&mut self, from: Child, tree: &Tree<S>, stack: &mut RayStack) {
        if ANY && self.primitive.is_some() {
            return;
        }
        N::call_no_inline(SingleRaySearch { ray: self, from, tree, stack });
    }

    /// Tests the primitives of a leaf.
    #[inline(always)]
    fn test_leaf<S: SoaLeaf>(&mut self, rays: &Rays<N>, leaf: usize, tree: &Tree<S>) {
        let shapes = tree.leaves[leaf].one_per_lane::<N>();
        let crossing = shapes.first_crossing_with_hint(rays, [N::splat(self.within.min), N::splat(self.within.max)]);
        if W::ENABLED {
            self.report_tests(tree.primitives(leaf), crossing);
        }
        let Some((crosses, t)) = crossing else { return };
        let hit_mask = (crosses & t.le(N::splat(self.within.max))).bits();
        if hit_mask == 0 {
            return;
        }
        let t = t.store();
        for lane in set_bits(hit_mask) {
            self.record_if_closest(t.0[lane], tree.primitive_index(leaf, lane));
        }
    }

    /// Reports the tests of a leaf's primitives to the observer.
    fn report_tests(&mut self, primitives: impl Iterator<Item = PrimitiveId>, crossing: Option<(N::Mask, N)>) {
        let (crosses, t) = crossing.map_or((0, F32x8::ZERO), |(crosses, t)| (crosses.bits(), t.store()));
        for (lane, id) in primitives.enumerate() {
            self.observer
                .primitive_tested(PrimitiveTest::from_crossing(id, (crosses >> lane & 1 == 1).then_some(t.0[lane])));
        }
    }

    /// Records a crossing at `t` if it is closer than the hit so far, or as close and earlier in
    /// the scene.
    #[inline(always)]
    fn record_if_closest(&mut self, t: f32, primitive: u32) {
        let is_first = |other: u32| self.accel.id(primitive) < self.accel.id(other);
        if t < self.within.max || t == self.within.max && self.primitive.is_none_or(is_first) {
            self.primitive = Some(primitive);
            if !ANY {
                self.within.max = t;
            }
        }
    }
}

/// The visitor that tests a ray against all primitives.
struct AllPrimitives<'a, 'p, N: Lanes, const ANY: bool, W> {
    ray: &'a mut SingleRay<'p, N, ANY, W>,
    stack: &'a mut RayStack,
}

impl<'p, N: Lanes, const ANY: bool, W: Observation> ListVisitor<'p> for AllPrimitives<'_, 'p, N, ANY, W> {
    #[inline(always)]
    fn visit_list<S: Endless>(&mut self, list: &'p List<S>) {
        self.ray.trace_list(list);
    }

    #[inline(always)]
    fn visit_tree<S: SoaLeaf>(&mut self, tree: &'p Tree<S>) {
        self.ray.trace_tree(tree, self.stack);
    }

    #[inline(always)]
    fn visit_instances(&mut self, instances: &'p Instances) {
        self.ray.trace_instances(instances, self.stack);
    }
}

/// The SIMD kernel of [`SingleRay::trace_from`].
struct SingleRaySearch<'a, 'p, N: Lanes, S, const ANY: bool, W> {
    ray: &'a mut SingleRay<'p, N, ANY, W>,
    from: Child,
    tree: &'a Tree<S>,
    stack: &'a mut RayStack,
}

impl<N: Lanes, S: SoaLeaf, const ANY: bool, W: Observation> SimdKernel for SingleRaySearch<'_, '_, N, S, ANY, W> {
    type Output = ();

    // `Same` is the type `N`: `call_no_inline` of `N` runs a kernel with vectors of type `N`.
    #[inline(always)]
    fn run<Same: Lanes>(self) {
        let Self { ray, from, tree, stack } = self;
        let (rays, within) = (ray.rays.splat_lane(ray.lane), ray.within);
        let mut there = InTree { ray, rays: &rays, tree };
        tree.bvh.visit_by_single_ray(from, &rays, within, stack, &mut there);
    }
}

/// The traversal of a tree by a single ray.
struct InTree<'a, 'p, N: Lanes, S, const ANY: bool, W> {
    ray: &'a mut SingleRay<'p, N, ANY, W>,
    /// The ray in all lanes.
    rays: &'a Rays<N>,
    tree: &'a Tree<S>,
}

impl<N: Lanes, S, const ANY: bool, W> Prefetch for InTree<'_, '_, N, S, ANY, W> {
    #[inline(always)]
    fn prefetch(&self, leaf: usize) {
        self.tree.prefetch(leaf);
    }
}

impl<N: Lanes, S: SoaLeaf, const ANY: bool, W: Observation> LeafVisitor for InTree<'_, '_, N, S, ANY, W> {
    #[inline(always)]
    fn node_tested(&mut self) {
        self.ray.observer.node_tested();
    }

    #[inline(always)]
    fn visit(&mut self, leaf: usize) -> ControlFlow<(), f32> {
        self.ray.test_leaf(self.rays, leaf, self.tree);
        if ANY && self.ray.primitive.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(self.ray.within.max)
        }
    }
}
