//! Which of many boxes a ray may meet: a tree of boxes around boxes (a bounding volume hierarchy), eight in each node.
//!
//! It only leaves out what cannot be met: a box contains those below it, and [`Bounds::crossed`] keeps to that bit for
//! bit. So what is found does not depend on how the tree was built, nor on the way in which it is gone through.

use crate::bounds::{Bounds, common};
use crate::lanes::{Answers, Eight, LANES, Lanes, Mask, Number, Vector};
use crate::ray::{Interval, Rays};
use glam::Vec3;
use std::ops::{ControlFlow, Range};

mod build;
mod packet;

pub use packet::{GROUPS, Packet, Visitor};

/// A tree over boxes that are known by their number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    nodes: Vec<Node>,
    root: Option<Child>,
}

/// The boxes of a tree, leaf by leaf.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Leaves {
    order: Vec<u32>,
    places: Vec<Range<u32>>,
}

impl Leaves {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// The numbers of a leaf's boxes: at least one, at most eight.
    ///
    /// # Panics
    /// If there are fewer leaves.
    pub fn boxes(&self, leaf: usize) -> &[u32] {
        let Range { start, end } = self.places[leaf];
        &self.order[start as usize..end as usize]
    }
}

/// Eight boxes side by side, and what is in them.
#[derive(Clone, Debug, PartialEq)]
#[repr(align(64))]
struct Node {
    /// Along each axis from where to where. Of what is lacking, from beyond all to before all: no ray meets it.
    bounds: [[Eight; 2]; 3],
    children: [Child; LANES],
}

impl Node {
    const EMPTY: Self = Self {
        bounds: [[Eight([f32::INFINITY; LANES]), Eight([f32::NEG_INFINITY; LANES])]; 3],
        children: [Child::node(0); LANES],
    };

    /// All the boxes.
    #[inline(always)]
    fn boxes<N: Lanes>(&self) -> [Vector<N>; 2] {
        let [x, y, z] = &self.bounds;
        let min = Vector { x: N::load(&x[0]), y: N::load(&y[0]), z: N::load(&z[0]) };
        let max = Vector { x: N::load(&x[1]), y: N::load(&y[1]), z: N::load(&z[1]) };
        [min, max]
    }

    /// One of the boxes, the same in every place.
    #[inline(always)]
    fn one<N: Number>(&self, lane: usize) -> [Vector<N>; 2] {
        let [x, y, z] = &self.bounds;
        let min = Vec3::new(x[0].0[lane], y[0].0[lane], z[0].0[lane]);
        let max = Vec3::new(x[1].0[lane], y[1].0[lane], z[1].0[lane]);
        [Vector::splat(min), Vector::splat(max)]
    }

    /// [`Bounds::crossed`] by one ray, which goes backward along these axes.
    #[inline(always)]
    fn crossed<N: Lanes>(&self, rays: &Rays<N>, is_backward: [bool; 3]) -> [N; 2] {
        let (origin, inverse) = (rays.origin, rays.inverse);
        let (mut near, mut far) = ([inverse.x, inverse.y, inverse.z], [inverse.x, inverse.y, inverse.z]);
        for (axis, origin) in [origin.x, origin.y, origin.z].into_iter().enumerate() {
            let is_backward = usize::from(is_backward[axis]);
            near[axis] = (N::load(&self.bounds[axis][is_backward]) - origin) * near[axis];
            far[axis] = (N::load(&self.bounds[axis][1 - is_backward]) - origin) * far[axis];
        }
        common([[near[0], far[0]], [near[1], far[1]], [near[2], far[2]]])
    }
}

/// What is in a box: another node, or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    const fn node(at: u32) -> Self {
        Self(at)
    }

    const fn leaf(number: u32) -> Self {
        Self(number | Self::LEAF)
    }

    fn as_leaf(self) -> Option<usize> {
        (self.0 & Self::LEAF != 0).then_some((self.0 & !Self::LEAF) as usize)
    }
}

/// What is still to be visited.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    child: Child,
    /// Which box it is in: eight times the node, and the place there.
    place: u32,
    /// From where on it may be met.
    start: f32,
}

/// Space for what is still to be visited, kept from ray to ray.
#[derive(Clone, Debug, Default)]
pub struct Stack(Vec<Waiting>);

impl Bvh {
    /// The tree over these boxes, built on all threads of the current rayon pool. Their coordinates are finite.
    ///
    /// # Panics
    /// If there are 2^31 of them or more.
    pub fn new(boxes: &[Bounds]) -> (Self, Leaves) {
        Self::new_unless(boxes, &|_| ControlFlow::Continue(())).unwrap_or_default()
    }

    /// [`new`](Self::new), given up where a report is answered by `Break`. Every now and then, from any thread, it is
    /// reported how many more boxes have come to their leaves, perhaps none.
    ///
    /// # Panics
    /// If there are 2^31 boxes or more.
    pub fn new_unless(boxes: &[Bounds], report: &(dyn Fn(usize) -> ControlFlow<()> + Sync)) -> Option<(Self, Leaves)> {
        build::build(boxes, report)
    }

    /// Whether it leaves nothing out: there are next to no boxes.
    pub fn is_leaf(&self) -> bool {
        self.nodes.is_empty()
    }

    /// How much memory it takes, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
    }

    /// All of it, if there is anything.
    #[inline(always)]
    pub fn root(&self) -> Option<Child> {
        self.root
    }

    /// Visits the leaves below that the ray, which is the same in every place, meets in the interval, the nearer of two
    /// first.
    #[inline(always)]
    pub fn visit<N: Lanes>(
        &self,
        from: Child,
        rays: &Rays<N>,
        mut within: Interval,
        Stack(waiting): &mut Stack,
        visitor: &mut impl LeafVisitor,
    ) {
        let Vector { x, y, z } = rays.inverse;
        let zero = N::splat(0.0);
        let is_backward = [x.lt(zero).any(), y.lt(zero).any(), z.lt(zero).any()];
        waiting.clear();
        let mut next = Some(Waiting { child: from, place: 0, start: within.min });
        while let Some(Waiting { child, start, .. }) = next.take().or_else(|| waiting.pop()) {
            // Something nearer may have been found since; what is as near may come first in the scene.
            if start > within.max {
                continue;
            }
            if let Some(leaf) = child.as_leaf() {
                match visitor.visit(leaf) {
                    ControlFlow::Continue(max) => within.max = max,
                    ControlFlow::Break(()) => return,
                }
                continue;
            }
            let node = &self.nodes[child.0 as usize];
            let [enters, leaves] = node.crossed(rays, is_backward);
            let starts = enters.max(N::splat(within.min));
            let is_met = starts.le(leaves.min(N::splat(within.max))).bits();
            next = nearest_first(node, child, is_met, &starts.store(), waiting);
        }
    }
}

/// Who is shown leaves.
pub trait LeafVisitor {
    /// Tests what is in a leaf; answers how far the ray is of interest from then on, or `Break`.
    fn visit(&mut self, leaf: usize) -> ControlFlow<(), f32>;
}

/// Of the children that are met, the nearest; the others wait, the nearer above the farther.
#[inline(always)]
fn nearest_first(
    node: &Node,
    parent: Child,
    mut is_met: u32,
    starts: &Eight,
    waiting: &mut Vec<Waiting>,
) -> Option<Waiting> {
    let mut take = || {
        let lane = is_met.trailing_zeros() as usize % LANES;
        let is_any = is_met != 0;
        is_met &= is_met.wrapping_sub(1);
        let place = parent.0 * LANES as u32 + lane as u32;
        is_any.then(|| Waiting { child: node.children[lane], place, start: starts.0[lane] })
    };
    let mut nearest = take()?;
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
