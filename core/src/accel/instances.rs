//! The instances of meshes: a tree over their boxes, and one tree for each mesh that they share.

use super::{PrimitiveId, Tree, TreeBuilder};
use crate::bvh::{Bvh, Prefetch};
use crate::lanes::{F32x8, LANES, Vector};
use crate::shape::{Mesh, TriangleN};
use crate::simd;
use glam::Vec3;
use std::array::from_fn;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::convert::Infallible;
use std::sync::Arc;

/// The instances in a scene.
///
/// The indices of their primitives follow those of all other primitives. An instance has one primitive for each
/// triangle of its mesh.
#[derive(Clone, Default, PartialEq)]
pub(crate) struct Instances {
    /// The tree over the boxes of the instances.
    pub(crate) bvh: Bvh,
    pub(crate) leaves: Vec<InstanceLeaf>,
    /// The instances, in the order of the scene.
    all: Vec<Instance>,
}

/// Up to eight instances: their boxes and their numbers.
#[derive(Clone, PartialEq)]
pub(crate) struct InstanceLeaf {
    /// The least and the greatest coordinates.
    ///
    /// An unused lane has an inverted infinite box, which no ray hits.
    pub(crate) boxes: [Vector<F32x8>; 2],
    numbers: [u32; LANES],
}

/// An instance of a mesh.
#[derive(Clone, PartialEq)]
pub(crate) struct Instance {
    object: u32,
    pub(crate) mesh: Arc<Mesh>,
    /// The tree over the triangles of the mesh, in the coordinates of its file.
    pub(crate) triangles: Arc<Tree<TriangleN<F32x8>>>,
    /// The index of this instance's first primitive in the scene.
    pub(crate) first: u32,
}

impl Instance {
    /// Returns the id of a triangle.
    pub(crate) fn id(&self, triangle: u32) -> PrimitiveId {
        PrimitiveId { object: self.object, index: triangle }
    }
}

impl Instances {
    /// Builds the trees over instances, which are given with the indices of their objects.
    ///
    /// `first` is the index of the first primitive.
    pub(super) fn build<E: Send>(
        list: Vec<(u32, Arc<Mesh>)>,
        mut first: u32,
        report: &(dyn Fn(usize) -> Result<(), E> + Sync),
    ) -> Result<Self, E> {
        let (mut trees, mut all) = (HashMap::new(), Vec::with_capacity(list.len()));
        for (object, mesh) in list {
            let file = Arc::as_ptr(mesh.shared_file());
            let tree = match trees.entry(file) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => new.insert(Arc::new(tree_of(&mesh, report)?)),
            };
            let (triangles, end) = (Arc::clone(tree), first.saturating_add(mesh.triangle_count()));
            all.push(Instance { object, mesh, triangles, first });
            first = end;
        }
        Self::of(all, report)
    }

    /// Returns the instances with the tree over their boxes.
    fn of<E: Send>(all: Vec<Instance>, report: &(dyn Fn(usize) -> Result<(), E> + Sync)) -> Result<Self, E> {
        let seen: Vec<_> = (0..).zip(&all).filter(|(_, instance)| !instance.mesh.is_nowhere()).collect();
        let boxes: Vec<_> = seen.iter().map(|(_, instance)| *instance.mesh.bounds()).collect();
        let (bvh, places) = Bvh::new_or_cancel(&boxes, &|_| report(0))?;
        let leaf = |leaf: usize| {
            let places = places.boxes(leaf);
            let of_lane = |lane: usize| places.get(lane).map(|&place| &boxes[place as usize]);
            let min = from_fn(|lane| of_lane(lane).map_or(Vec3::INFINITY, |bounds| bounds.min));
            let max = from_fn(|lane| of_lane(lane).map_or(Vec3::NEG_INFINITY, |bounds| bounds.max));
            let numbers = from_fn(|lane| seen[places[lane.min(places.len() - 1)] as usize].0);
            InstanceLeaf { boxes: [Vector::of(min), Vector::of(max)], numbers }
        };
        let leaves = (0..places.leaf_count()).map(leaf).collect();
        Ok(Self { bvh, leaves, all })
    }

    /// Returns the instances with the meshes that `mesh` returns for their objects.
    pub(super) fn with_meshes(&self, mesh: impl Fn(u32) -> Option<Arc<Mesh>>) -> Self {
        let moved = |instance: &Instance| Instance {
            mesh: mesh(instance.object).unwrap_or_else(|| Arc::clone(&instance.mesh)),
            ..instance.clone()
        };
        if !self.all.iter().any(|instance| instance.mesh.moves()) {
            return self.clone();
        }
        let Ok(moved) = Self::of(self.all.iter().map(moved).collect(), &|_| Ok::<_, Infallible>(()));
        moved
    }

    /// Returns the number of triangles in the trees of all meshes that `instances` share.
    pub(super) fn distinct_triangle_count(instances: &[(u32, Arc<Mesh>)]) -> usize {
        let files: HashMap<_, _> = instances.iter().map(|(_, mesh)| (Arc::as_ptr(mesh.shared_file()), mesh)).collect();
        files.values().map(|mesh| mesh.triangle_count() as usize).sum()
    }

    /// Returns whether the scene has no instances.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Returns the instance in a lane of a leaf.
    pub(crate) fn in_leaf(&self, leaf: usize, lane: usize) -> &Instance {
        &self.all[self.leaves[leaf].numbers[lane] as usize]
    }

    /// Returns the index of the instances' first primitive, and the index after their last one.
    pub(crate) fn range(&self) -> [u32; 2] {
        let end = |last: &Instance| last.first.saturating_add(last.mesh.triangle_count());
        [self.all.first().map_or(u32::MAX, |instance| instance.first), self.all.last().map_or(0, end)]
    }

    /// Returns the id and the mesh of a primitive; `None` if it is not part of an instance.
    pub(crate) fn primitive(&self, primitive: u32) -> Option<(PrimitiveId, &Mesh)> {
        let number = self.all.partition_point(|instance| instance.first <= primitive).checked_sub(1)?;
        let instance = &self.all[number];
        Some((instance.id(primitive - instance.first), &instance.mesh))
    }

    /// Returns the size in bytes. A tree that instances share counts once.
    pub(super) fn bytes(&self) -> usize {
        let trees: HashMap<_, _> =
            self.all.iter().map(|instance| (Arc::as_ptr(&instance.triangles), instance.triangles.bytes())).collect();
        self.bvh.bytes() + size_of_val(&self.leaves[..]) + size_of_val(&self.all[..]) + trees.values().sum::<usize>()
    }
}

impl Prefetch for Instances {
    #[inline(always)]
    fn prefetch(&self, leaf: usize) {
        simd::prefetch(&self.leaves[leaf]);
    }
}

/// Returns the tree over the triangles of a mesh, as in its file.
fn tree_of<E: Send>(
    mesh: &Mesh,
    report: &(dyn Fn(usize) -> Result<(), E> + Sync),
) -> Result<Tree<TriangleN<F32x8>>, E> {
    let mut builder = TreeBuilder::default();
    builder.push_mesh(0, mesh);
    builder.build(0, report)
}

#[cfg(all(test, unit_tests))]
mod tests;
