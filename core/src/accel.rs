//! The primitives of a scene: bounded ones in trees, unbounded ones in lists.
//!
//! An `Accelerator` is built once, from shapes alone, and shared by all copies of a scene, also by those with another
//! camera and other lights or materials.

use crate::bounds::Bounds;
use crate::bvh::Bvh;
use crate::lanes::{F32x8, LANES, LaneMask, Lanes};
use crate::progress::{Cancelled, Progress, Reporter, Work};
use crate::shape::{Endless, Mesh, Scalar, ScalarLeaf, Shape, SoaLeaf, surfaces_in_parts};
use crate::simd;
use std::convert::Infallible;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

#[cfg(all(test, unit_tests))]
mod builds;
mod instances;
mod tree_builder;

pub(crate) use instances::{Instance, Instances};
use tree_builder::TreeBuilder;

/// The id of a primitive of a scene.
///
/// Ids are ordered as the primitives are in the scene: of two hits at the same t, the one with the smaller id counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PrimitiveId {
    /// The index of the object in the scene.
    pub(crate) object: u32,
    /// The index of the primitive in the object's shape.
    pub(crate) index: u32,
}

/// The ids of eight primitives, stored as the bits of f32.
///
/// So the operations that gather and select lanes of floats work on ids too.
// No arithmetic is done on these floats, so ids whose bits happen to be a NaN stay unchanged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PrimitiveIds<N> {
    object: N,
    index: N,
}

// The methods are `inline(always)` because kernels call them for each group of rays (see `simd`); so are those of the
// lists and trees below.
impl PrimitiveIds<F32x8> {
    /// The id of the first primitive of the first object, in all lanes.
    pub(crate) const ZERO: Self = Self { object: F32x8::ZERO, index: F32x8::ZERO };

    pub(crate) fn of(ids: [PrimitiveId; LANES]) -> Self {
        Self {
            object: F32x8(ids.map(|id| f32::from_bits(id.object))),
            index: F32x8(ids.map(|id| f32::from_bits(id.index))),
        }
    }

    /// Returns the id of `lane`.
    #[inline(always)]
    pub(crate) fn id(&self, lane: usize) -> PrimitiveId {
        PrimitiveId { object: self.object.0[lane].to_bits(), index: self.index.0[lane].to_bits() }
    }

    /// Loads from memory.
    #[inline(always)]
    pub(crate) fn load<N: Lanes>(&self) -> PrimitiveIds<N> {
        PrimitiveIds { object: N::load(&self.object), index: N::load(&self.index) }
    }

    /// Returns the mask of the lanes whose primitive is part of the object with this index.
    #[inline(always)]
    pub(crate) fn mask_of_object<N: Lanes>(&self, object: u32) -> u32 {
        N::load(&self.object).eq_bits(object).bits()
    }

    /// Gathers an id for each lane, as [`Lanes::gather`] does.
    #[inline(always)]
    pub(crate) fn gather<N: Lanes>(&self, lanes: N) -> PrimitiveIds<N> {
        PrimitiveIds { object: N::load(&self.object).gather(lanes), index: N::load(&self.index).gather(lanes) }
    }
}

impl<N: Lanes> PrimitiveIds<N> {
    /// Returns the id in all lanes.
    #[inline(always)]
    pub(crate) fn splat(PrimitiveId { object, index }: PrimitiveId) -> Self {
        Self { object: N::splat(f32::from_bits(object)), index: N::splat(f32::from_bits(index)) }
    }

    /// Returns `yes` in the lanes that the mask has set, and `no` in the others.
    #[inline(always)]
    pub(crate) fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        Self { object: N::select(mask, yes.object, no.object), index: N::select(mask, yes.index, no.index) }
    }

    /// Stores to memory.
    #[inline(always)]
    pub(crate) fn store(self) -> PrimitiveIds<F32x8> {
        PrimitiveIds { object: self.object.store(), index: self.index.store() }
    }
}

/// Expands to code for a surface's group: `list` (unbounded surfaces) or `tree` (bounded ones).
///
/// `group of T` is the type that stores the surface's primitives, `group from S` the type that collects them for the
/// build. `group in other_group code` is `code` if both groups are the same, else nothing.
macro_rules! by_group {
    (list of $kept:ty) => { List<$kept> };
    (tree of $kept:ty) => { Tree<$kept> };
    (list from $surface:ident) => { Vec<(PrimitiveId, crate::shape::$surface)> };
    (tree from $surface:ident) => { TreeBuilder<'s, crate::shape::$surface> };
    (list in list $($then:tt)*) => { $($then)* };
    (tree in tree $($then:tt)*) => { $($then)* };
    ($one:ident in $other:ident $($then:tt)*) => {};
}

/// Defines the accelerator from the table of [`surfaces`](crate::shape).
macro_rules! accelerator {
    (
        own {$($(#[$on:meta])* $group:ident $name:ident: $surface:ident as $kept:ty, $of:meta;)*}
        shared {$($(#[$also_on:meta])* $shared:ident, $also_of:meta;)*}
    ) => {
        /// The primitives of all shapes of a scene.
        ///
        /// Every primitive has an index; those in the lists come first, then those in the leaves of the trees. A leaf
        /// takes eight indices, of which the first is a multiple of eight, so that the lowest three bits of an index
        /// are the lane.
        #[derive(Clone, Default, PartialEq)]
        pub(crate) struct Accelerator {
            $($(#[$on])* $name: by_group!($group of $kept),)*
            /// The tree shared by all bounded surfaces whose kind has no tree of its own.
            scalars: Tree<ScalarLeaf<Scalar>>,
            /// The instances of meshes.
            instances: Instances,
            /// Whether any mesh has interpolated normals.
            pub(crate) has_smooth: bool,
            /// Whether any surface depends on the time.
            depends_on_time: bool,
            /// The box around all bounded primitives.
            bounds: Option<Bounds>,
            /// The box around those that are no instances, which may move.
            tree_bounds: Option<Bounds>,
        }

        impl Accelerator {
            /// Visits all lists, then all trees, each in the order of the table of surfaces.
            ///
            /// Instances are last, if there are any.
            #[inline(always)]
            pub(crate) fn visit<'a>(&'a self, visitor: &mut impl ListVisitor<'a>) {
                $($(#[$on])* { by_group! { list in $group visitor.visit_list(&self.$name); } })*
                $($(#[$on])* { by_group! { tree in $group visitor.visit_tree(&self.$name); } })*
                visitor.visit_tree(&self.scalars);
                if !self.instances.is_empty() {
                    visitor.visit_instances(&self.instances);
                }
            }

            /// Returns whether any tree has nodes, or there are instances.
            #[inline(always)]
            pub(crate) fn has_tree_nodes(&self) -> bool {
                let mut has_tree_nodes = self.scalars.has_nodes() || !self.instances.is_empty();
                $($(#[$on])* { by_group! { tree in $group has_tree_nodes |= self.$name.has_nodes(); } })*
                has_tree_nodes
            }

            /// Returns whether any tree needs the [shear](crate::ray::Rays::shear) of rays for its
            /// primitives.
            #[inline(always)]
            pub(crate) fn needs_shear(&self) -> bool {
                let mut needs_shear = self.scalars.needs_shear();
                $($(#[$on])* { by_group! { tree in $group needs_shear |= self.$name.needs_shear(); } })*
                needs_shear
            }
        }

        /// The primitives of all shapes, by kind and in the order of the scene, before the build.
        #[derive(Default)]
        struct PrimitiveLists<'s> {
            $($(#[$on])* $name: by_group!($group from $surface),)*
            scalars: TreeBuilder<'s, Scalar>,
            /// The instances of meshes, with the indices of their objects.
            instances: Vec<(u32, Arc<Mesh>)>,
        }

        impl<'s> PrimitiveLists<'s> {
            fn push(&mut self, object: u32, shape: &'s Shape) {
                let id = PrimitiveId { object, index: 0 };
                match shape {
                    $($(#[$on])* Shape::$surface(surface) => {
                        by_group! { list in $group self.$name.push((id, *surface)); }
                        by_group! { tree in $group self.$name.push(id, surface.clone()); }
                    })*
                    $($(#[$also_on])* Shape::$shared(surface) => self.scalars.push(id, surface.clone().into()),)*
                    Shape::Mesh(mesh) if mesh.is_instance() => self.instances.push((object, Arc::clone(mesh))),
                    Shape::Mesh(mesh) => self.triangles.push_mesh(object, mesh),
                }
            }

            /// Returns the number of all bounded primitives except those of instances.
            fn bounded_count(&self) -> usize {
                let mut count = self.scalars.len();
                $($(#[$on])* { by_group! { tree in $group count += self.$name.len(); } })*
                count
            }

            fn build<E: Send>(self, report: &(dyn Fn(usize) -> Result<(), E> + Sync)) -> Result<Accelerator, E> {
                let (mut built, mut end) = (Accelerator::default(), 0);
                $($(#[$on])* { by_group! { list in $group
                    built.$name = List { first: end, primitives: self.$name };
                    end = built.$name.end_index();
                } })*
                // The indices of a leaf start at a multiple of eight, so that index % 8 is the lane.
                end = end.next_multiple_of(LANES as u32);
                $($(#[$on])* { by_group! { tree in $group
                    built.$name = self.$name.build(end, report)?;
                    end = built.$name.end_index();
                    built.add_bounds(built.$name.bvh.bounds());
                } })*
                built.scalars = self.scalars.build(end, report)?;
                built.add_bounds(built.scalars.bvh.bounds());
                built.tree_bounds = built.bounds;
                built.instances = Instances::build(self.instances, built.scalars.end_index(), report)?;
                built.add_bounds(built.instances.bvh.bounds());
                Ok(built)
            }
        }
    };
}

surfaces_in_parts! { accelerator }

/// A visitor of all lists and trees.
pub(crate) trait ListVisitor<'a> {
    /// Visits the unbounded primitives of one kind.
    fn visit_list<S: Endless>(&mut self, list: &'a List<S>);

    /// Visits the tree of the bounded primitives of one kind.
    fn visit_tree<S: SoaLeaf>(&mut self, tree: &'a Tree<S>);

    /// Visits the instances of meshes, if there are any.
    fn visit_instances(&mut self, instances: &'a Instances);
}

/// The unbounded primitives of one kind.
#[derive(Clone, PartialEq)]
pub(crate) struct List<S> {
    primitives: Vec<(PrimitiveId, S)>,
    /// The index of the list's first primitive in the scene.
    first: u32,
}

impl<S> Default for List<S> {
    fn default() -> Self {
        Self { primitives: Vec::new(), first: 0 }
    }
}

impl<S> List<S> {
    /// Returns the index after the last primitive.
    fn end_index(&self) -> u32 {
        self.first + self.primitives.len() as u32
    }

    /// Returns whether the primitive with this index belongs to this list.
    #[inline(always)]
    pub(crate) fn contains(&self, primitive: u32) -> bool {
        (self.first..self.end_index()).contains(&primitive)
    }

    /// Returns a primitive by its index.
    ///
    /// # Panics
    /// If it is not in the list.
    #[inline(always)]
    pub(crate) fn get(&self, primitive: u32) -> &(PrimitiveId, S) {
        &self.primitives[(primitive - self.first) as usize]
    }

    /// Returns the primitives with their indices.
    #[inline(always)]
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, &(PrimitiveId, S))> {
        (self.first..).zip(&self.primitives)
    }
}

/// The bounded primitives of one kind, and the tree over them.
#[derive(Clone, PartialEq)]
pub(crate) struct Tree<S> {
    pub(crate) bvh: Bvh,
    /// The leaves, with up to eight primitives each.
    pub(crate) leaves: Vec<S>,
    /// The ids of the primitives of each leaf; unused lanes repeat the last one.
    // Stored apart from the leaves, because only hits need the ids: so a leaf of triangles has 288 bytes instead of
    // 352, and incoherent rays are 1 to 5 % faster.
    pub(crate) ids: Vec<PrimitiveIds<F32x8>>,
    /// The index of the tree's first primitive in the scene; 0 in a tree that instances share.
    pub(crate) first: u32,
    /// The number of primitives to test without traversal if the tree is a single leaf; else 0.
    pub(crate) single_leaf_count: usize,
}

impl<S> Default for Tree<S> {
    fn default() -> Self {
        Self { bvh: Bvh::default(), leaves: Vec::new(), ids: Vec::new(), first: 0, single_leaf_count: 0 }
    }
}

impl Accelerator {
    /// Builds the trees over the primitives of some shapes.
    pub(crate) fn new<'s>(shapes: impl Iterator<Item = &'s Shape>) -> Self {
        let Ok(built) = Self::build_reporting(shapes, &|_| Ok::<_, Infallible>(()));
        built
    }

    /// Builds as [`new`](Self::new) does, reports progress, and stops if the reporter cancels the
    /// build.
    pub(crate) fn new_or_cancel<'s>(
        shapes: impl Iterator<Item = &'s Shape>,
        reporter: &Reporter<'_>,
    ) -> Result<Self, Cancelled> {
        Self::build_reporting(shapes, &|progress| reporter.report(progress))
    }

    fn build_reporting<'s, E: Send>(
        shapes: impl Iterator<Item = &'s Shape>,
        report: &(dyn Fn(Progress) -> Result<(), E> + Sync),
    ) -> Result<Self, E> {
        #[cfg(all(test, unit_tests))]
        builds::count_build();
        let (mut lists, mut has_smooth, mut depends_on_time) = (PrimitiveLists::default(), false, false);
        for (object, shape) in (0..).zip(shapes) {
            has_smooth |= match shape {
                Shape::Mesh(mesh) => mesh.is_smooth(),
                Shape::Solid(solid) => solid.is_smooth(),
                _ => false,
            };
            depends_on_time |= shape.moves();
            lists.push(object, shape);
        }
        // Primitives are counted over all trees, as the user sees one progress for the scene.
        let (done, total) =
            (AtomicUsize::new(0), lists.bounded_count() + Instances::distinct_triangle_count(&lists.instances));
        let report_more = |more| {
            let done = done.fetch_add(more, Ordering::Relaxed) + more;
            report(Progress { work: Work::Building, done, total })
        };
        Ok(Self { has_smooth, depends_on_time, ..lists.build(&report_more)? })
    }

    /// Returns whether any surface depends on the time.
    pub(crate) fn depends_on_time(&self) -> bool {
        self.depends_on_time
    }

    /// Returns the accelerator with the surfaces as they are at a time in seconds.
    ///
    /// `shape` returns the shape of an object at that time.
    // The bounds of formulas do not move, so the trees stay as they are. Triangles that are no instances are copied:
    // 100,000 take about a millisecond. The boxes of instances move, so the tree over them is built again.
    pub(crate) fn at_time<'s>(&self, seconds: f64, shape: impl Fn(u32) -> &'s Shape) -> Self {
        let mut moved = self.clone();
        moved.scalars.leaves.iter_mut().for_each(|leaf| leaf.replace(|surface| surface.at_time(seconds)));
        moved.instances = moved.instances.with_meshes(|object| match shape(object) {
            Shape::Mesh(mesh) => Some(Arc::clone(mesh)),
            _ => None,
        });
        moved.bounds = moved.tree_bounds;
        moved.add_bounds(moved.instances.bvh.bounds());
        moved
    }

    /// Includes a box in the bounds.
    fn add_bounds(&mut self, bounds: Option<Bounds>) {
        self.bounds = [self.bounds, bounds].into_iter().flatten().reduce(|a, b| a.union(&b));
    }

    /// Returns the smallest box around all bounded primitives, if there are any.
    pub(crate) fn finite_bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// Returns the size of the trees and lists in bytes.
    pub(crate) fn bytes(&self) -> usize {
        struct Sum(usize);
        impl<'a> ListVisitor<'a> for Sum {
            fn visit_list<S: Endless>(&mut self, list: &'a List<S>) {
                self.0 += size_of_val(&list.primitives[..]);
            }

            fn visit_tree<S: SoaLeaf>(&mut self, tree: &'a Tree<S>) {
                self.0 += tree.bytes();
            }

            fn visit_instances(&mut self, instances: &'a Instances) {
                self.0 += instances.bytes();
            }
        }
        let mut sum = Sum(0);
        self.visit(&mut sum);
        sum.0
    }

    /// Returns the id of the primitive with this index.
    ///
    /// If there is none, returns the id of the first primitive of the first object.
    #[inline(always)]
    pub(crate) fn id(&self, primitive: u32) -> PrimitiveId {
        struct Find(u32, PrimitiveId);
        impl<'a> ListVisitor<'a> for Find {
            #[inline(always)]
            fn visit_list<S: Endless>(&mut self, list: &'a List<S>) {
                if list.contains(self.0) {
                    self.1 = list.get(self.0).0;
                }
            }

            #[inline(always)]
            fn visit_tree<S: SoaLeaf>(&mut self, tree: &'a Tree<S>) {
                if tree.contains(self.0) {
                    self.1 = tree.id(self.0);
                }
            }

            #[inline(always)]
            fn visit_instances(&mut self, instances: &'a Instances) {
                if let Some((id, _)) = instances.primitive(self.0) {
                    self.1 = id;
                }
            }
        }
        let mut find = Find(primitive, PrimitiveId { object: 0, index: 0 });
        self.visit(&mut find);
        find.1
    }
}

/// Shows only the bounds and the size, because the primitives could take millions of lines.
impl fmt::Debug for Accelerator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Accelerator")
            .field("bounds", &self.bounds)
            .field("bytes", &self.bytes())
            .finish_non_exhaustive()
    }
}

impl<S: SoaLeaf> Tree<S> {
    /// Returns whether the tree has primitives whose formula needs the shear of rays.
    #[inline(always)]
    fn needs_shear(&self) -> bool {
        S::NEED_SHEAR && !self.leaves.is_empty()
    }
}

impl<S> Tree<S> {
    fn bytes(&self) -> usize {
        self.bvh.bytes() + size_of_val(&self.leaves[..]) + size_of_val(&self.ids[..])
    }

    /// Returns the index of the primitive in a lane of a leaf.
    #[inline(always)]
    pub(crate) fn primitive_index(&self, leaf: usize, lane: usize) -> u32 {
        self.first + (leaf * LANES + lane) as u32
    }

    /// Returns the index after that of the last leaf's last lane.
    #[inline(always)]
    pub(crate) fn end_index(&self) -> u32 {
        self.first + (self.leaves.len() * LANES) as u32
    }

    /// Returns whether the primitive with this index belongs to this tree.
    #[inline(always)]
    pub(crate) fn contains(&self, primitive: u32) -> bool {
        (self.first..self.end_index()).contains(&primitive)
    }

    /// Returns whether the tree has nodes, and so can cull. Without nodes, it is one leaf or empty.
    #[inline(always)]
    pub(crate) fn has_nodes(&self) -> bool {
        !self.bvh.is_leaf()
    }

    /// Returns the leaf of the primitive with this index, and the ids of the leaf's primitives.
    #[inline(always)]
    pub(crate) fn leaf(&self, primitive: u32) -> (&S, &PrimitiveIds<F32x8>) {
        let leaf = (primitive - self.first) as usize / LANES;
        (&self.leaves[leaf], &self.ids[leaf])
    }

    /// Prefetches the primitives of a leaf.
    #[inline(always)]
    pub(crate) fn prefetch(&self, leaf: usize) {
        simd::prefetch(&self.leaves[leaf]);
    }

    /// Returns the id of the primitive with this index.
    #[inline(always)]
    pub(crate) fn id(&self, primitive: u32) -> PrimitiveId {
        let at = (primitive - self.first) as usize;
        self.ids[at / LANES].id(at % LANES)
    }

    /// Returns the ids of the primitives in a leaf.
    pub(crate) fn primitives(&self, leaf: usize) -> impl Iterator<Item = PrimitiveId> {
        let id = move |lane| self.ids[leaf].id(lane);
        let end = (1..LANES).find(|&at| id(at) == id(at - 1));
        (0..end.unwrap_or(LANES)).map(id)
    }
}
