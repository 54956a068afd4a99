//! Single-ray traversal of instances: the tree over their boxes, then the tree of a mesh.

use super::observer::{Observation, PrimitiveTest};
use crate::accel::{Accelerator, Instance, Instances, Tree};
use crate::bounds::crossed;
use crate::bvh::{LeafVisitor, Prefetch, RayStack};
use crate::lanes::{F32x8, LaneMask, Lanes, SimdKernel, set_bits};
use crate::ray::{EightRays, Interval, Ray, Rays};
use crate::shape::{Crossable, Passage, SoaLeaf, TriangleN};
use std::ops::ControlFlow;

/// The search for a ray's hit among instances: the SIMD kernel of `SingleRay::trace_instances`.
pub(super) struct InstanceSearch<'a, N: Lanes, const ANY: bool, W> {
    pub(super) accel: &'a Accelerator,
    pub(super) instances: &'a Instances,
    /// The ray in all lanes.
    pub(super) rays: &'a Rays<N>,
    /// The interval of t, which ends at the closest hit so far.
    pub(super) within: Interval,
    /// The index of the primitive hit so far.
    pub(super) primitive: Option<u32>,
    pub(super) observer: &'a mut W,
}

/// A search, and the stack on which it runs.
pub(super) struct InstanceSearchOn<'a, N: Lanes, const ANY: bool, W> {
    pub(super) search: InstanceSearch<'a, N, ANY, W>,
    pub(super) stack: &'a mut RayStack,
}

impl<N: Lanes, const ANY: bool, W: Observation> SimdKernel for InstanceSearchOn<'_, N, ANY, W> {
    /// The end of the interval and the primitive, as they are after the search.
    type Output = (f32, Option<u32>);

    // `Same` is the type `N`, as in `single::InstanceSearch`.
    #[inline(always)]
    fn run<Same: Lanes>(self) -> Self::Output {
        let Self { search, stack } = self;
        let (bvh, rays, within) = (&search.instances.bvh, search.rays, search.within);
        let mut visitor = InInstances { stack: stack.take_inner(), search };
        if let Some(root) = bvh.root() {
            bvh.visit_by_single_ray(root, rays, within, stack, &mut visitor);
        }
        stack.put_back(visitor.stack);
        (visitor.search.within.max, visitor.search.primitive)
    }
}

/// The traversal of the tree over the boxes of instances.
struct InInstances<'a, N: Lanes, const ANY: bool, W> {
    search: InstanceSearch<'a, N, ANY, W>,
    /// The stack for the trees of meshes.
    stack: RayStack,
}

impl<N: Lanes, const ANY: bool, W> Prefetch for InInstances<'_, N, ANY, W> {
    #[inline(always)]
    fn prefetch(&self, leaf: usize) {
        self.search.instances.prefetch(leaf);
    }
}

impl<N: Lanes, const ANY: bool, W: Observation> LeafVisitor for InInstances<'_, N, ANY, W> {
    #[inline(always)]
    fn node_tested(&mut self) {
        self.search.observer.node_tested();
    }

    #[inline(always)]
    fn visit(&mut self, leaf: usize) -> ControlFlow<(), f32> {
        let [min, max] = &self.search.instances.leaves[leaf].boxes;
        let [enters, leaves] = crossed([min.load::<N>(), max.load::<N>()], self.search.rays);
        let hit_mask = enters.le(leaves).bits();
        let (enters, leaves) = (enters.store(), leaves.store());
        for lane in set_bits(hit_mask) {
            if let Some(passage) = Passage::new([enters.0[lane], leaves.0[lane]], self.search.within) {
                self.search.visit(self.search.instances.in_leaf(leaf, lane), passage, &mut self.stack);
                if ANY && self.search.primitive.is_some() {
                    return ControlFlow::Break(());
                }
            }
        }
        ControlFlow::Continue(self.search.within.max)
    }
}

impl<N: Lanes, const ANY: bool, W: Observation> InstanceSearch<'_, N, ANY, W> {
    /// Finds the hit among the triangles of an instance.
    #[inline(always)]
    fn visit(&mut self, instance: &Instance, passage: Passage, stack: &mut RayStack) {
        let ray =
            Ray { origin: self.rays.origin.store().of_lane(0), direction: self.rays.direction.store().of_lane(0) };
        let rays = Rays::<N>::load(&EightRays::of(&[instance.mesh.file_ray(&ray)]), true);
        let (tree, within) = (&*instance.triangles, passage.search());
        let observer = &mut *self.observer;
        let mut visitor = InMesh::<N, ANY, W> { rays: &rays, tree, within, found: None, instance, passage, observer };
        if let Some(root) = tree.bvh.root() {
            tree.bvh.visit_by_single_ray(root, &rays, within, stack, &mut visitor);
        }
        let Some((t, triangle)) = visitor.found else { return };
        let (t, primitive) = (passage.clamp_to_box(t), instance.first + triangle);
        let is_first = |other: u32| self.accel.id(primitive) < self.accel.id(other);
        if t < self.within.max || t == self.within.max && self.primitive.is_none_or(is_first) {
            self.primitive = Some(primitive);
            if !ANY {
                self.within.max = t;
            }
        }
    }
}

/// The traversal of the tree of a mesh, in the coordinates of its file.
struct InMesh<'a, N: Lanes, const ANY: bool, W> {
    rays: &'a Rays<N>,
    tree: &'a Tree<TriangleN<F32x8>>,
    /// The interval in which a crossing counts.
    within: Interval,
    /// The t and the triangle of the closest crossing so far.
    found: Option<(f32, u32)>,
    instance: &'a Instance,
    passage: Passage,
    observer: &'a mut W,
}

impl<N: Lanes, const ANY: bool, W> Prefetch for InMesh<'_, N, ANY, W> {
    #[inline(always)]
    fn prefetch(&self, leaf: usize) {
        self.tree.prefetch(leaf);
    }
}

impl<N: Lanes, const ANY: bool, W: Observation> LeafVisitor for InMesh<'_, N, ANY, W> {
    #[inline(always)]
    fn node_tested(&mut self) {
        self.observer.node_tested();
    }

    #[inline(always)]
    fn visit(&mut self, leaf: usize) -> ControlFlow<(), f32> {
        let shapes = self.tree.leaves[leaf].one_per_lane::<N>();
        let crossing =
            shapes.first_crossing_with_hint(self.rays, [N::splat(self.within.min), N::splat(self.within.max)]);
        if W::ENABLED {
            self.report_tests(leaf, crossing);
        }
        let Some((crosses, t)) = crossing else { return ControlFlow::Continue(self.within.max) };
        let (hit_mask, t) = ((crosses & t.le(N::splat(self.within.max))).bits(), t.store());
        for lane in set_bits(hit_mask) {
            let (t, triangle) = (t.0[lane], self.tree.ids[leaf].id(lane).index);
            // Of crossings at the same t, that of the first triangle counts.
            if self.found.is_none_or(|(closest, other)| t < closest || t == closest && triangle < other) {
                self.found = Some((t, triangle));
                self.within.max = t;
            }
        }
        if ANY && self.found.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(self.within.max) }
    }
}

impl<N: Lanes, const ANY: bool, W: Observation> InMesh<'_, N, ANY, W> {
    /// Reports the tests of a leaf's triangles to the observer.
    fn report_tests(&mut self, leaf: usize, crossing: Option<(N::Mask, N)>) {
        let (crosses, t) = crossing.map_or((0, F32x8::ZERO), |(crosses, t)| (crosses.bits(), t.store()));
        for (lane, id) in self.tree.primitives(leaf).enumerate() {
            let crossing = (crosses >> lane & 1 == 1).then(|| self.passage.clamp_to_box(t.0[lane]));
            let test = PrimitiveTest::from_crossing(self.instance.id(id.index), crossing);
            self.observer.primitive_tested(test);
        }
    }
}
