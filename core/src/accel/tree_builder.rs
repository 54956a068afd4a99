//! The primitives of a tree before it is built.

use super::{PrimitiveId, PrimitiveIds, Tree};
use crate::bounds::Bounds;
use crate::bvh::Bvh;
use crate::lanes::LANES;
use crate::shape::{Mesh, SoaLeaf, Surface, Triangle};
use crate::threads;
use std::array::from_fn;

/// The number of leaves from which on a tree's leaves are filled in parallel.
// For fewer leaves the start of rayon's pool is not worth its time: it would add 0.15 ms to the first picture of four
// spheres, which are one leaf.
const MIN_PARALLEL_LEAVES: usize = 1024;

/// The bounded primitives of one kind, in the order of the scene, before the build.
// The triangles of a mesh are read from it when they are needed: copies with their boxes and ids would take 68 bytes
// for each triangle, which was a third of the memory at the peak.
pub(super) struct TreeBuilder<'s, T> {
    runs: Vec<Run<'s, T>>,
    /// The primitives that belong to no mesh, and their ids and boxes.
    shapes: Vec<T>,
    ids: Vec<PrimitiveId>,
    boxes: Vec<Bounds>,
}

/// Primitives that follow each other in the scene.
struct Run<'s, T> {
    /// The number of primitives before this run, and including it.
    first: usize,
    end: usize,
    source: RunSource<'s, T>,
}

/// Where the primitives of a run are stored.
enum RunSource<'s, T> {
    /// In the lists of the builder, from this index on.
    Lists(usize),
    /// In a mesh.
    Mesh { object: u32, mesh: &'s Mesh, triangle: fn(&Mesh, u32) -> T },
}

impl<T> Default for TreeBuilder<'_, T> {
    fn default() -> Self {
        Self { runs: Vec::new(), shapes: Vec::new(), ids: Vec::new(), boxes: Vec::new() }
    }
}

impl<'s> TreeBuilder<'s, Triangle> {
    /// Adds the triangles of a mesh, as they are in its file.
    pub(super) fn push_mesh(&mut self, object: u32, mesh: &'s Mesh) {
        let triangle = |mesh: &Mesh, index| Triangle::unchecked(mesh.file_corners(index));
        let (first, count) = (self.len(), mesh.triangle_count() as usize);
        self.runs.push(Run { first, end: first + count, source: RunSource::Mesh { object, mesh, triangle } });
    }
}

impl<'s, T> TreeBuilder<'s, T> {
    /// Returns the number of primitives.
    pub(super) fn len(&self) -> usize {
        self.runs.last().map_or(0, |run| run.end)
    }

    /// Returns the run of the primitive with this number, and its index in the run.
    #[inline]
    fn run_of(&self, number: usize) -> (&Run<'s, T>, usize) {
        let run = &self.runs[self.runs.partition_point(|run| run.end <= number)];
        (run, number - run.first)
    }

    fn id(&self, number: usize) -> PrimitiveId {
        match self.run_of(number) {
            (Run { source: RunSource::Lists(start), .. }, at) => self.ids[start + at],
            // A mesh has fewer than 2^32 triangles.
            (Run { source: RunSource::Mesh { object, .. }, .. }, at) => {
                PrimitiveId { object: *object, index: at as u32 }
            }
        }
    }
}

impl<T: Surface + Clone + Sync> TreeBuilder<'_, T> {
    /// Adds a primitive, unless it has no bounds.
    pub(super) fn push(&mut self, id: PrimitiveId, shape: T) {
        let Some(bounds) = shape.bounds() else { return };
        let first = self.len();
        if let Some(Run { end, source: RunSource::Lists(_), .. }) = self.runs.last_mut() {
            *end += 1;
        } else {
            self.runs.push(Run { first, end: first + 1, source: RunSource::Lists(self.shapes.len()) });
        }
        self.ids.push(id);
        self.boxes.push(bounds);
        self.shapes.push(shape);
    }

    fn shape(&self, number: usize) -> T {
        match self.run_of(number) {
            (Run { source: RunSource::Lists(start), .. }, at) => self.shapes[start + at].clone(),
            (Run { source: RunSource::Mesh { mesh, triangle, .. }, .. }, at) => triangle(mesh, at as u32),
        }
    }

    fn bounds(&self, number: usize) -> Bounds {
        match self.run_of(number) {
            (Run { source: RunSource::Lists(start), .. }, at) => self.boxes[start + at],
            (Run { source: RunSource::Mesh { mesh, triangle, .. }, .. }, at) => {
                // Triangles have bounds.
                triangle(mesh, at as u32).bounds().unwrap_or(Bounds::EMPTY)
            }
        }
    }

    /// Builds the tree. `first` is the index of its first primitive in the scene.
    pub(super) fn build<S: SoaLeaf<Shape = T> + Send, E: Send>(
        self,
        first: u32,
        report: &(dyn Fn(usize) -> Result<(), E> + Sync),
    ) -> Result<Tree<S>, E> {
        let (bvh, places) = Bvh::of_boxes(self.len(), |number| self.bounds(number), report)?;
        let leaf = |leaf: usize| {
            let numbers = places.boxes(leaf);
            // Unused lanes repeat the last primitive's id.
            let number = |lane: usize| numbers[lane.min(numbers.len() - 1)] as usize;
            let shapes: [T; LANES] = from_fn(|lane| self.shape(number(lane)));
            (S::of(&shapes[..numbers.len()]), PrimitiveIds::of(from_fn(|lane| self.id(number(lane)))))
        };
        let single_leaf_count = if bvh.is_leaf() { self.len() } else { 0 };
        let count = places.leaf_count();
        let (leaves, ids) =
            if count < MIN_PARALLEL_LEAVES { (0..count).map(leaf).unzip() } else { threads::unzip(count, leaf) };
        Ok(Tree { bvh, leaves, ids, first, single_leaf_count })
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
