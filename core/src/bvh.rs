//! A bounding volume hierarchy with eight boxes in each node.
//!
//! Culling never loses a hit: a box contains the boxes below it, and the interval that [`Bounds::crossed`] computes for
//! it contains theirs, bit for bit (`culling.md`, 2). So hits depend neither on the build nor on the order of
//! traversal.

use crate::bounds::Bounds;
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Mask, Number, Vector, set_bits};
use crate::ray::{Interval, Rays};
use crate::simd;
use crate::threads;
use glam::Vec3;
use std::convert::Infallible;
use std::ops::{ControlFlow, Range};

mod cut;
mod wide;
mod build;
mod packet;

pub use build::MIN_TASK_ITEMS;
pub use packet::{GROUPS, Packet, PacketVisitor};

/// A bounding volume hierarchy over boxes, which are identified by their indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    nodes: Vec<Node>,
    root: Option<Child>,
    bounds: Option<Bounds>,
}

/// The indices of a tree's boxes, leaf by leaf.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Leaves {
    order: Vec<u32>,
    ranges: Vec<Range<u32>>,
}

impl Leaves {
    /// Returns the number of leaves.
    pub fn leaf_count(&self) -> usize {
        self.ranges.len()
    }

    /// Returns the indices of a leaf's boxes: one to eight.
    ///
    /// # Panics
    /// If there is no such leaf.
    pub fn boxes(&self, leaf: usize) -> &[u32] {
        let Range { start, end } = self.ranges[leaf];
        &self.order[start as usize..end as usize]
    }
}

/// Eight boxes in SoA layout, and their children.
// The children share a cache line with the first bounds, so they are loaded by the time the hit mask is known. Together
// with the shortcut for a single hit child this makes single rays 4 to 6 % faster.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
struct Node {
    children: [Child; LANES],
    /// The minima and maxima along each axis.
    ///
    /// An unused lane has an inverted infinite box, which no ray hits.
    bounds: [[F32x8; 2]; 3],
}

impl Node {
    const EMPTY: Self = Self {
        bounds: [[F32x8([f32::INFINITY; LANES]), F32x8([f32::NEG_INFINITY; LANES])]; 3],
        children: [Child::node(0); LANES],
    };

    /// Returns the minima and maxima of all boxes.
    #[inline(always)]
    fn boxes<N: Lanes>(&self) -> [Vector<N>; 2] {
        let [x, y, z] = &self.bounds;
        let min = Vector { x: N::load(&x[0]), y: N::load(&y[0]), z: N::load(&z[0]) };
        let max = Vector { x: N::load(&x[1]), y: N::load(&y[1]), z: N::load(&z[1]) };
        [min, max]
    }

    /// Returns the box of one lane in all lanes.
    #[inline(always)]
    fn child_box<N: Number>(&self, lane: usize) -> [Vector<N>; 2] {
        let [x, y, z] = &self.bounds;
        let min = Vec3::new(x[0].0[lane], y[0].0[lane], z[0].0[lane]);
        let max = Vec3::new(x[1].0[lane], y[1].0[lane], z[1].0[lane]);
        [Vector::splat(min), Vector::splat(max)]
    }

    /// Intersects one ray with all boxes.
    ///
    /// Returns the t at which it enters each box, and the hit mask.
    #[inline(always)]
    fn intersect<N: Lanes>(&self, slabs: &Slabs<N>, within: Interval) -> (N, u32) {
        let (mut start, mut end) = (N::splat(within.min), N::splat(within.max));
        // Any order of the axes gives the same mask, because `max` and `min` take the same numbers and skip NaN.
        for axis in [2, 1, 0] {
            // The near plane is chosen by an index instead of a select, because the direction's sign is the same in all
            // lanes.
            let (bounds, near) = (&self.bounds[axis], usize::from(slabs.is_backward[axis]));
            let origin = slabs.origin[axis];
            // With the operands in this order, `max` and `min` skip NaN, as in `bounds::crossed`.
            start = ((origin - N::load(&bounds[near])) * slabs.near[axis]).max(start);
            end = ((origin - N::load(&bounds[1 - near])) * slabs.far[axis]).min(end);
        }
        (start, start.le(end).bits())
    }
}

/// A ray in all lanes, prepared for slab tests.
///
/// For t >= 0 the interval computed with it contains that of [`Bounds::crossed`] (`culling.md`, 4).
struct Slabs<N> {
    origin: [N; 3],
    /// The negated inverse direction, widened so that the ray enters each slab earlier.
    ///
    /// `far` is widened so that the ray leaves each slab later.
    // The inverse direction is negated, so that `origin - plane` can replace `plane - origin`: the CPU subtracts the
    // plane straight from memory. Together with the ids stored apart from the leaves (see `accel::Tree`), this makes
    // incoherent rays 1 to 5 % faster.
    near: [N; 3],
    far: [N; 3],
    is_backward: [bool; 3],
}

/// The relative widening of both ends of a slab interval: 128 units of 2^-24 (`culling.md`, 4).
// The inverse direction is widened once per ray, instead of both ends of the interval in each test: a node takes 36
// instructions instead of 60.
const SLAB_SLACK: f32 = 128.0 / 16_777_216.0;

impl<N: Lanes> Slabs<N> {
    #[inline(always)]
    fn from_rays(rays: &Rays<N>) -> Self {
        let (origin, inverse) = (rays.origin, rays.inverse);
        let (less, more, zero) = (N::splat(SLAB_SLACK - 1.0), N::splat(-1.0 - SLAB_SLACK), N::splat(0.0));
        // Written out for each axis, because closures are compiled without the caller's target features.
        Self {
            origin: [origin.x, origin.y, origin.z],
            near: [inverse.x * less, inverse.y * less, inverse.z * less],
            far: [inverse.x * more, inverse.y * more, inverse.z * more],
            is_backward: [inverse.x.lt(zero).any(), inverse.y.lt(zero).any(), inverse.z.lt(zero).any()],
        }
    }
}

/// A child of a node: a node or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(u32);

impl Child {
    // The highest bit marks a leaf. It is free, as nodes and leaves are numbered separately, and `build` accepts fewer
    // than 2^31 boxes.
    const LEAF: u32 = 1 << 31;

    const fn node(at: u32) -> Self {
        Self(at)
    }

    const fn leaf(number: u32) -> Self {
        Self(number | Self::LEAF)
    }

    #[inline(always)]
    fn as_leaf(self) -> Option<usize> {
        (self.0 & Self::LEAF != 0).then_some((self.0 & !Self::LEAF) as usize)
    }
}

/// A child that a packet has yet to visit.
#[derive(Clone, Copy, Debug)]
struct StackEntry {
    child: Child,
    /// The position of the child's box: eight times the index of its parent node, plus the lane.
    slot: u32,
    /// A lower bound of the t at which the packet's rays enter the child's box.
    start: f32,
}

/// The traversal stack of packets, reused from packet to packet.
#[derive(Clone, Debug, Default)]
pub struct PacketStack(Vec<StackEntry>);

impl Bvh {
    /// Builds the tree over boxes with finite coordinates, on the current rayon pool.
    ///
    /// # Panics
    /// If there are 2^31 boxes or more.
    pub fn new(boxes: &[Bounds]) -> (Self, Leaves) {
        let Ok(built) = Self::new_or_cancel(boxes, &|_| Ok::<_, Infallible>(()));
        built
    }

    /// Builds as [`new`](Self::new) does, and stops when `report` returns an error.
    ///
    /// `report` is called from any thread, with the number of boxes that have been put into leaves since the last call.
    /// The number may be 0.
    ///
    /// # Errors
    /// The error that `report` returned.
    ///
    /// # Panics
    /// If there are 2^31 boxes or more.
    pub fn new_or_cancel<E: Send>(
        boxes: &[Bounds],
        report: &(dyn Fn(usize) -> Result<(), E> + Sync),
    ) -> Result<(Self, Leaves), E> {
        Self::of_boxes(boxes.len(), |number| boxes[number], report)
    }

    /// Builds as [`new_or_cancel`](Self::new_or_cancel) does, over boxes that are computed by their
    /// indices.
    pub(crate) fn of_boxes<E: Send>(
        count: usize,
        box_of: impl Fn(usize) -> Bounds + Send + Sync,
        report: &(dyn Fn(usize) -> Result<(), E> + Sync),
    ) -> Result<(Self, Leaves), E> {
        assert!(count < 1 << 31, "there are fewer than 2^31 boxes");
        let item = |number: usize| build::item((number as u32, &box_of(number)));
        let items = if count < MIN_TASK_ITEMS { (0..count).map(item).collect() } else { threads::map(count, item) };
        build::build(items, report)
    }

    /// Returns the smallest box around all boxes, if there are any.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// Returns whether the tree has no nodes: it is one leaf, or empty, and culls nothing.
    pub fn is_leaf(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns the size of the nodes in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
    }

    /// Returns the root, unless the tree is empty.
    #[inline(always)]
    pub fn root(&self) -> Option<Child> {
        self.root
    }

    /// Visits the leaves below `from` that a single ray hits in the interval, nearer ones first.
    ///
    /// The ray is repeated in all lanes. `within.min` is at least 0 (`culling.md`, 4).
    #[inline(always)]
    pub fn visit_by_single_ray<N: Lanes>(
        &self,
        from: Child,
        rays: &Rays<N>,
        mut within: Interval,
        stack: &mut RayStack,
        visitor: &mut impl LeafVisitor,
    ) {
        let slabs = Slabs::from_rays(rays);
        stack.len = 0;
        let mut child = from;
        loop {
            if let Some(leaf) = child.as_leaf() {
                match visitor.visit(leaf) {
                    ControlFlow::Continue(max) => within.max = max,
                    ControlFlow::Break(()) => return,
                }
            } else {
                let node = &self.nodes[child.0 as usize];
                visitor.node_tested();
                let (starts, hit_mask) = node.intersect(&slabs, within);
                if hit_mask != 0 {
                    // A single hit child is visited at once: prefetching it, too, made rays 2.5 % slower.
                    if hit_mask & hit_mask.wrapping_sub(1) != 0 {
                        for lane in set_bits(hit_mask) {
                            self.prefetch(node.children[lane], visitor);
                        }
                    }
                    child = stack.push_all_but_nearest(node, hit_mask, starts);
                    continue;
                }
            }
            // A nearer hit may have been found since the push. At equal t the child is visited: its primitive may come
            // first in the scene, which decides ties.
            child = loop {
                let Some(waiting) = stack.pop() else { return };
                if waiting.start() <= within.max {
                    break waiting.child();
                }
            };
        }
    }

    /// Prefetches a child whose box is hit: a node or the primitives of a leaf.
    // Prefetching makes packets of eye rays 10 % faster, and single rays 5 %, on the dragon's 871 k triangles, whose
    // tree exceeds the L2 cache. Scenes that fit the cache take the same time as without.
    #[inline(always)]
    fn prefetch(&self, child: Child, leaves: &impl Prefetch) {
        match child.as_leaf() {
            Some(leaf) => leaves.prefetch(leaf),
            None => simd::prefetch(&self.nodes[child.0 as usize]),
        }
    }
}

/// A child that a single ray has yet to visit, ordered by the t at which the ray enters its box.
///
/// The high 32 bits are those of t, the low ones are the child.
// Packed into one number, so that a step of the sort takes one comparison and one move instead of two each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct RayStackEntry(u64);

impl RayStackEntry {
    #[inline(always)]
    fn new(Child(child): Child, start: f32) -> Self {
        // The bits of floats that are not negative are ordered as the floats are.
        Self(u64::from(start.to_bits()) << 32 | u64::from(child))
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }

    #[inline(always)]
    fn start(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }
}

/// The traversal stack of single rays, reused from ray to ray.
#[derive(Clone, Debug, Default)]
pub struct RayStack {
    entries: Vec<RayStackEntry>,
    /// The number of entries in use.
    ///
    /// The rest of the vector is spare room, so that a push needs no check.
    len: usize,
    /// The entries of the stack for trees inside the leaves of a tree.
    inner: Vec<RayStackEntry>,
}

impl RayStack {
    /// Returns the stack for trees inside the leaves of a tree, until [`put_back`](Self::put_back).
    pub fn take_inner(&mut self) -> Self {
        Self { entries: std::mem::take(&mut self.inner), ..Self::default() }
    }

    /// Keeps the memory of the stack for trees inside the leaves of a tree.
    pub fn put_back(&mut self, inner: Self) {
        self.inner = inner.entries;
    }

    /// Returns the nearest hit child, and pushes the others, nearer ones above farther ones.
    ///
    /// `hit_mask` is not 0, and `starts` has the t at which the ray enters each box.
    #[inline(always)]
    fn push_all_but_nearest<N: Lanes>(&mut self, node: &Node, mut hit_mask: u32, starts: N) -> Child {
        let lowest = |bits: u32| bits.trailing_zeros() as usize % LANES;
        // Six of ten nodes have a single hit child. It is visited next, so its t is not needed: incoherent rays are 2
        // to 6 % faster.
        if hit_mask & hit_mask.wrapping_sub(1) == 0 {
            return node.children[lowest(hit_mask)];
        }
        let starts = starts.store();
        let mut take = || {
            let lane = lowest(hit_mask);
            hit_mask &= hit_mask.wrapping_sub(1);
            (RayStackEntry::new(node.children[lane], starts.0[lane]), hit_mask != 0)
        };
        let (first, _) = take();
        let (second, mut is_more) = take();
        self.make_room();
        let (mut nearest, bottom) = (first.min(second), self.len);
        self.entries[bottom] = first.max(second);
        self.len += 1;
        while is_more {
            let entry;
            (entry, is_more) = take();
            let mut at = self.len;
            self.len += 1;
            let other = entry.max(nearest);
            nearest = entry.min(nearest);
            while at > bottom && self.entries[at - 1] < other {
                self.entries[at] = self.entries[at - 1];
                at -= 1;
            }
            self.entries[at] = other;
        }
        nearest.child()
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<RayStackEntry> {
        self.len = self.len.checked_sub(1)?;
        Some(self.entries[self.len])
    }

    /// Makes room on the stack for the children of one node.
    #[inline(always)]
    fn make_room(&mut self) {
        #[cold]
        fn grow(entries: &mut Vec<RayStackEntry>) {
            // The branch is rarely taken: the stack grows a few times per run of a kernel.
            entries.resize(2 * entries.len() + 8 * LANES, RayStackEntry(0));
        }
        if self.entries.len() < self.len + LANES {
            grow(&mut self.entries);
        }
    }
}

/// Prefetching of leaves.
pub trait Prefetch {
    /// Prefetches the primitives of a leaf.
    fn prefetch(&self, leaf: usize);
}

/// The visitor of a single ray's traversal.
pub trait LeafVisitor: Prefetch {
    /// Records that the ray was tested against the boxes of a node.
    #[inline(always)]
    fn node_tested(&mut self) {}

    /// Tests the primitives of a leaf against the ray.
    ///
    /// Returns the new upper end of the ray's interval, or `Break` to end the traversal.
    fn visit(&mut self, leaf: usize) -> ControlFlow<(), f32>;
}

/// Returns the nearest hit child of a packet, and pushes the others, nearer ones above farther
/// ones.
#[inline(always)]
fn push_all_but_nearest(
    node: &Node,
    parent: Child,
    mut hit_mask: u32,
    starts: &F32x8,
    waiting: &mut Vec<StackEntry>,
) -> Option<StackEntry> {
    let mut take = || {
        let lane = hit_mask.trailing_zeros() as usize % LANES;
        let is_any = hit_mask != 0;
        hit_mask &= hit_mask.wrapping_sub(1);
        let slot = parent.0 * LANES as u32 + lane as u32;
        is_any.then(|| StackEntry { child: node.children[lane], slot, start: starts.0[lane] })
    };
    // All hit children are sorted: moving only the nearest to the front did not make closest hits clearly faster.
    let mut nearest = take()?;
    // Sorted by insertion, because at most eight children are hit. The entries below `bottom` belong to other nodes.
    let bottom = waiting.len();
    while let Some(mut other) = take() {
        if other.start < nearest.start {
            (nearest, other) = (other, nearest);
        }
        let mut at = waiting.len();
        waiting.push(other);
        while at > bottom && waiting[at - 1].start < other.start {
            waiting[at] = waiting[at - 1];
            at -= 1;
        }
        waiting[at] = other;
    }
    Some(nearest)
}

/// Returns the last hit child of a packet, and pushes the others unsorted.
#[inline(always)]
fn push_all_but_last(
    node: &Node,
    parent: Child,
    hit_mask: u32,
    starts: &F32x8,
    waiting: &mut Vec<StackEntry>,
) -> Option<StackEntry> {
    let mut last = None;
    for lane in set_bits(hit_mask) {
        waiting.extend(last);
        let slot = parent.0 * LANES as u32 + lane as u32;
        last = Some(StackEntry { child: node.children[lane], slot, start: starts.0[lane] });
    }
    last
}
