//! What a scene's rays are tested against: the parts of all its shapes, in trees where they have bounds.
//!
//! An [`Accelerator`] is built once, from shapes alone, and shared by all copies of a scene: lights, materials and cameras
//! change without it.

use crate::bounds::Bounds;
use crate::bvh::Bvh;
use crate::lanes::{Answers, Eight, LANES, Lanes};
use crate::progress::{Cancelled, Progress, Watcher, Work};
use crate::shape::{Balls, Corners, Part, Plane, Shape, SideBySide, Surface};
use crate::simd;
use rayon::prelude::*;
use std::array::from_fn;
use std::convert::Infallible;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};

#[cfg(test)]
mod builds;

/// A part of an object. They are ordered as they stand in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PartId {
    /// Which of the scene's objects.
    pub(crate) object: u32,
    /// Which of its shape's parts.
    pub(crate) part: u32,
}

/// Whose parts eight are: the bits of these numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PartIds<N> {
    object: N,
    part: N,
}

impl PartIds<Eight> {
    /// Eight times the first part of the first object.
    pub(crate) const ZERO: Self = Self { object: Eight::ZERO, part: Eight::ZERO };

    fn of(ids: [PartId; LANES]) -> Self {
        Self {
            object: Eight(ids.map(|id| f32::from_bits(id.object))),
            part: Eight(ids.map(|id| f32::from_bits(id.part))),
        }
    }

    /// One of them.
    #[inline(always)]
    pub(crate) fn id(&self, lane: usize) -> PartId {
        PartId { object: self.object.0[lane].to_bits(), part: self.part.0[lane].to_bits() }
    }

    /// Which are of that object, a bit for each.
    #[inline(always)]
    pub(crate) fn are_of<N: Lanes>(&self, object: u32) -> u32 {
        N::load(&self.object).has_bits(object).bits()
    }

    /// One of them in each place, as [`Lanes::pick`] has it.
    #[inline(always)]
    pub(crate) fn pick<N: Lanes>(&self, lanes: N) -> PartIds<N> {
        PartIds { object: N::load(&self.object).pick(lanes), part: N::load(&self.part).pick(lanes) }
    }
}

impl<N: Lanes> PartIds<N> {
    /// The same everywhere.
    #[inline(always)]
    pub(crate) fn splat(PartId { object, part }: PartId) -> Self {
        Self { object: N::splat(f32::from_bits(object)), part: N::splat(f32::from_bits(part)) }
    }

    /// `yes` where the answer was yes, else `no`.
    #[inline(always)]
    pub(crate) fn select(answer: N::Mask, yes: Self, no: Self) -> Self {
        Self { object: N::select(answer, yes.object, no.object), part: N::select(answer, yes.part, no.part) }
    }

    /// To memory.
    #[inline(always)]
    pub(crate) fn store(self) -> PartIds<Eight> {
        PartIds { object: self.object.store(), part: self.part.store() }
    }
}

/// The parts of some shapes. Each part has a place: first the planes', then those of the trees, each leaf's eight from a
/// multiple of eight on.
#[derive(Clone, Default, PartialEq)]
pub(crate) struct Accelerator {
    /// Those that have no end.
    pub(crate) planes: Vec<(PartId, Plane)>,
    pub(crate) balls: Tree<Balls<Eight>>,
    pub(crate) triangles: Tree<Corners<Eight>>,
    /// Whether any triangles stand for a smooth surface.
    pub(crate) has_smooth: bool,
    bounds: Option<Bounds>,
}

/// Parts of one kind, and a tree over them.
#[derive(Clone, PartialEq)]
pub(crate) struct Tree<S> {
    pub(crate) bvh: Bvh,
    /// What is in each leaf: up to eight parts.
    pub(crate) leaves: Vec<S>,
    /// Whose they are, apart: that is asked only of what is met. (The last one's stands in the places that are left over,
    /// too.)
    ids: Vec<PartIds<Eight>>,
    /// The place of the first of them.
    pub(crate) first: u32,
    /// How many there are, where the tree is but one leaf and leaves nothing out; else 0.
    pub(crate) few: usize,
}

impl<S> Default for Tree<S> {
    fn default() -> Self {
        Self { bvh: Bvh::default(), leaves: Vec::new(), ids: Vec::new(), first: 0, few: 0 }
    }
}

impl Accelerator {
    /// Builds the trees over these shapes.
    pub(crate) fn new<'s>(shapes: impl Iterator<Item = &'s Shape>) -> Self {
        let Ok(built) = Self::reporting(shapes, &|_| Ok::<_, Infallible>(()));
        built
    }

    /// [`new`](Self::new), until the watcher cancels it.
    pub(crate) fn new_or_cancel<'s>(
        shapes: impl Iterator<Item = &'s Shape>,
        watcher: &Watcher<'_>,
    ) -> Result<Self, Cancelled> {
        Self::reporting(shapes, &|progress| watcher.tell(progress))
    }

    fn reporting<'s, E: Send>(
        shapes: impl Iterator<Item = &'s Shape>,
        report: &(dyn Fn(Progress) -> Result<(), E> + Sync),
    ) -> Result<Self, E> {
        #[cfg(test)]
        builds::count();
        let mut planes = Vec::new();
        let (mut balls, mut triangles) = (Listed::default(), Listed::default());
        let mut has_smooth = false;
        for (object, shape) in (0..).zip(shapes) {
            has_smooth |= matches!(shape, Shape::Mesh(mesh) if mesh.is_smooth());
            for part in 0..shape.part_count() {
                let id = PartId { object, part };
                match shape.part(part) {
                    Part::Plane(plane) => planes.push((id, *plane)),
                    Part::Sphere(sphere) => balls.push(id, *sphere),
                    Part::Triangle(triangle) => triangles.push(id, *triangle),
                    Part::Facet(facet) => triangles.push(id, *facet.triangle()),
                }
            }
        }
        let boxes = || balls.boxes.iter().chain(&triangles.boxes);
        let bounds = boxes().next().map(|first| boxes().fold(*first, |all, next| all.union(next)));
        let (done, total) = (AtomicUsize::new(0), balls.boxes.len() + triangles.boxes.len());
        let report_more = |more| {
            let done = done.fetch_add(more, Ordering::Relaxed) + more;
            report(Progress { work: Work::Building, done, total })
        };
        let balls = balls.build((planes.len() as u32).next_multiple_of(LANES as u32), &report_more)?;
        let triangles = triangles.build(balls.first + (balls.leaves.len() * LANES) as u32, &report_more)?;
        Ok(Self { planes, balls, triangles, has_smooth, bounds })
    }

    /// The smallest box around all that stand in the trees; nothing if there are none.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// How much memory it takes, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.planes[..]) + self.balls.bytes() + self.triangles.bytes()
    }

    /// Whether anything stands in a tree.
    #[inline(always)]
    pub(crate) fn has_trees(&self) -> bool {
        self.balls.has_tree() || self.triangles.has_tree()
    }

    /// Whether there are triangles.
    #[inline(always)]
    pub(crate) fn has_triangles(&self) -> bool {
        !self.triangles.leaves.is_empty()
    }

    /// Which part has that place.
    #[inline(always)]
    pub(crate) fn id(&self, place: u32) -> PartId {
        if place >= self.triangles.first {
            self.triangles.id(place)
        } else if place >= self.balls.first {
            self.balls.id(place)
        } else {
            self.planes[place as usize].0
        }
    }
}

/// In short: a tree has as many lines as the scene has parts.
impl fmt::Debug for Accelerator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Accelerator")
            .field("bounds", &self.bounds)
            .field("bytes", &self.bytes())
            .finish_non_exhaustive()
    }
}

impl<S> Tree<S> {
    fn bytes(&self) -> usize {
        self.bvh.bytes() + size_of_val(&self.leaves[..]) + size_of_val(&self.ids[..])
    }

    /// The place of what stands in that leaf.
    #[inline(always)]
    pub(crate) fn place(&self, leaf: usize, lane: usize) -> u32 {
        self.first + (leaf * LANES + lane) as u32
    }

    /// Whether its tree leaves anything out.
    #[inline(always)]
    pub(crate) fn has_tree(&self) -> bool {
        !self.bvh.is_leaf()
    }

    /// The leaf in which that place is, and whose its parts are.
    #[inline(always)]
    pub(crate) fn leaf(&self, place: u32) -> (&S, &PartIds<Eight>) {
        let leaf = (place - self.first) as usize / LANES;
        (&self.leaves[leaf], &self.ids[leaf])
    }

    /// Asks the CPU for the parts of a leaf, and does not wait for them.
    #[inline(always)]
    pub(crate) fn prefetch(&self, leaf: usize) {
        simd::prefetch(&self.leaves[leaf]);
    }

    /// Whose part has that place.
    #[inline(always)]
    pub(crate) fn id(&self, place: u32) -> PartId {
        let at = (place - self.first) as usize;
        self.ids[at / LANES].id(at % LANES)
    }

    /// Whose parts are in that leaf.
    pub(crate) fn parts(&self, leaf: usize) -> impl Iterator<Item = PartId> {
        let id = move |lane| self.ids[leaf].id(lane);
        let end = (1..LANES).find(|&at| id(at) == id(at - 1));
        (0..end.unwrap_or(LANES)).map(id)
    }
}

/// Fewer leaves are not worth starting threads for.
const FEW: usize = 1024;

/// Parts of one kind in the order of the scene.
struct Listed<T> {
    ids: Vec<PartId>,
    shapes: Vec<T>,
    boxes: Vec<Bounds>,
}

impl<T> Default for Listed<T> {
    fn default() -> Self {
        Self { ids: Vec::new(), shapes: Vec::new(), boxes: Vec::new() }
    }
}

impl<T: Surface + Copy + Sync> Listed<T> {
    fn push(&mut self, id: PartId, shape: T) {
        if let Some(bounds) = shape.bounds() {
            self.ids.push(id);
            self.boxes.push(bounds);
            self.shapes.push(shape);
        }
    }

    fn build<S: SideBySide<Shape = T> + Send, E: Send>(
        self,
        first: u32,
        report: &(dyn Fn(usize) -> Result<(), E> + Sync),
    ) -> Result<Tree<S>, E> {
        let (bvh, places) = Bvh::new_or_cancel(&self.boxes, report)?;
        let leaf = |leaf: usize| {
            let numbers = places.boxes(leaf);
            let number = |lane: usize| numbers[lane.min(numbers.len() - 1)] as usize;
            let shapes: [T; LANES] = from_fn(|lane| self.shapes[number(lane)]);
            (S::of(&shapes[..numbers.len()]), PartIds::of(from_fn(|lane| self.ids[number(lane)])))
        };
        let few = if bvh.is_leaf() { self.ids.len() } else { 0 };
        let (mut leaves, mut ids) = (Vec::new(), Vec::new());
        if places.count() < FEW {
            (leaves, ids) = (0..places.count()).map(leaf).unzip();
        } else {
            (0..places.count()).into_par_iter().map(leaf).unzip_into_vecs(&mut leaves, &mut ids);
        }
        Ok(Tree { bvh, leaves, ids, first, few })
    }
}
