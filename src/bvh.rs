//! Which of many boxes a ray may meet: a tree of boxes around boxes (a bounding volume hierarchy).
//!
//! It only leaves out what cannot be met: a box contains those below it, and [`Bounds::crossed`] keeps to that bit for
//! bit. So what is found does not depend on how the tree was built.

use crate::bounds::Bounds;
use crate::ray::{Interval, Probe};
use std::ops::{ControlFlow, Range};

mod build;

/// A tree over boxes that are known by their number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    /// Depth first: a node's first child follows it.
    nodes: Vec<Node>,
    /// The numbers of the boxes, leaf by leaf.
    order: Vec<u32>,
}

/// A box around all that is below it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    bounds: Bounds,
    /// How many boxes a leaf has; 0 for an inner node.
    count: u32,
    /// Of a leaf, its first place in the order; of an inner node, how far behind it the second child stands.
    at: u32,
}

/// No path in a tree is longer.
const MAX_DEPTH: usize = 96;

impl Bvh {
    /// The tree over these boxes, built on all threads of the current rayon pool. Their coordinates are finite.
    ///
    /// # Panics
    /// If there are 2^32 of them or more.
    pub fn new(boxes: &[Bounds]) -> Self {
        Self::new_unless(boxes, &|_| ControlFlow::Continue(())).unwrap_or_default()
    }

    /// [`new`](Self::new), given up where a report is answered by `Break`. Every now and then, from any thread, it is
    /// reported how many more boxes have come to their leaves, perhaps none.
    ///
    /// # Panics
    /// If there are 2^32 boxes or more.
    pub fn new_unless(boxes: &[Bounds], report: &(dyn Fn(usize) -> ControlFlow<()> + Sync)) -> Option<Self> {
        build::build(boxes, report)
    }

    /// The numbers of the boxes, leaf by leaf.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Whether it leaves nothing out: there are next to no boxes.
    pub fn is_leaf(&self) -> bool {
        self.nodes.len() <= 1
    }

    /// How much memory it takes, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.order[..])
    }

    /// Visits the leaves that the ray meets in the interval, the nearer of two first. For each, `visit` is given its
    /// places in the [order](Self::order), and answers how far the ray is of interest from then on, or `Break`.
    pub fn visit(
        &self,
        probe: &Probe,
        mut within: Interval,
        mut visit: impl FnMut(Range<usize>, Interval) -> ControlFlow<(), f32>,
    ) -> ControlFlow<()> {
        let Some(root) = self.nodes.first() else { return ControlFlow::Continue(()) };
        // A few boxes are one leaf, and need neither a box around them nor the space of a stack.
        if let Some(leaf) = root.leaf() {
            return visit(leaf, within).map_continue(|_| ());
        }
        let mut waiting = [(0_u32, 0.0); MAX_DEPTH];
        let mut count = 0;
        let mut next = enters(root, probe, within).map(|start| (0, start));
        while let Some((at, start)) = next.take().or_else(|| pop(&waiting, &mut count)) {
            // Something nearer may have been found since; what is as near may come first in the scene.
            if start > within.max {
                continue;
            }
            let node = &self.nodes[at as usize];
            if let Some(leaf) = node.leaf() {
                within.max = visit(leaf, within)?;
                continue;
            }
            let entered = |child: u32| enters(&self.nodes[child as usize], probe, within).map(|start| (child, start));
            next = match (entered(at + 1), entered(at + node.at)) {
                (Some(first), Some(second)) => {
                    let (near, far) = if second.1 < first.1 { (second, first) } else { (first, second) };
                    waiting[count] = far;
                    count += 1;
                    Some(near)
                }
                (first, second) => first.or(second),
            };
        }
        ControlFlow::Continue(())
    }
}

impl Node {
    /// The places of a leaf's boxes in the order.
    fn leaf(&self) -> Option<Range<usize>> {
        let first = self.at as usize;
        (self.count > 0).then(|| first..first + self.count as usize)
    }
}

fn pop(waiting: &[(u32, f32)], count: &mut usize) -> Option<(u32, f32)> {
    *count = count.checked_sub(1)?;
    Some(waiting[*count])
}

/// Where the ray enters the node's box, if that and the interval have something in common.
fn enters(node: &Node, probe: &Probe, within: Interval) -> Option<f32> {
    let inside = node.bounds.crossed(probe);
    let start = inside.min.max(within.min);
    (start <= inside.max.min(within.max)).then_some(start)
}
