//! The collapse of the binary tree into one with eight children in each node.

use super::{Child, Node};
use crate::bounds::Bounds;
use crate::lanes::LANES;
use std::ops::Range;

/// A node of the binary tree. Its first child follows it in the array.
#[derive(Clone, Copy)]
pub(super) struct BinaryNode {
    pub(super) bounds: Bounds,
    /// The number of boxes of a leaf; 0 for an inner node.
    pub(super) count: u32,
    /// The index of a leaf's first box in the order of the leaves, or an inner node's distance to
    /// its second child.
    pub(super) at: u32,
}

/// The wide tree under construction.
pub(super) struct WideBuilder<'p> {
    pairs: &'p [BinaryNode],
    slot_divisions: Vec<SlotDivision>,
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: Vec<Range<u32>>,
}

impl<'p> WideBuilder<'p> {
    pub(super) fn from_binary(pairs: &'p [BinaryNode]) -> Self {
        Self { pairs, slot_divisions: slot_divisions(pairs), nodes: Vec::new(), leaves: Vec::new() }
    }

    pub(super) fn append_node(&mut self, index: usize) -> Child {
        let BinaryNode { count, at: first, .. } = self.pairs[index];
        if count > 0 {
            self.leaves.push(first..first + count);
            return Child::leaf(self.leaves.len() as u32 - 1);
        }
        let number = self.nodes.len();
        // The empty node is pushed first, so that its number comes before those of its children.
        self.nodes.push(Node::EMPTY);
        let mut children = Children::default();
        self.gather_children(index, LANES, &mut children);
        for (lane, &pair) in children.pairs[..children.count].iter().enumerate() {
            let child = self.append_node(pair);
            let bounds = &self.pairs[pair].bounds;
            let node = &mut self.nodes[number];
            node.children[lane] = child;
            for axis in 0..3 {
                node.bounds[axis][0].0[lane] = bounds.min[axis];
                node.bounds[axis][1].0[lane] = bounds.max[axis];
            }
        }
        Child::node(number as u32)
    }

    /// Adds to `children` the binary nodes that represent node `index` in at most `slots` slots.
    fn gather_children(&self, index: usize, slots: usize, children: &mut Children) {
        let left = usize::from(self.slot_divisions[index][slots - 1]);
        if left == NODE_ITSELF {
            children.pairs[children.count] = index;
            children.count += 1;
        } else {
            self.gather_children(index + 1, left, children);
            self.gather_children(index + self.pairs[index].at as usize, slots - left, children);
        }
    }
}

/// The nodes of the binary tree that become the children of a wide node.
#[derive(Default)]
struct Children {
    pairs: [usize; LANES],
    count: usize,
}

/// The best ways to represent a binary node in 1 to 8 slots for children of a wide node.
///
/// For each number of slots: how many of them represent the node's first child, or [`NODE_ITSELF`] if the node itself
/// takes one slot.
type SlotDivision = [u8; LANES];

/// The entry of a [`SlotDivision`] for a node that takes one slot by itself.
const NODE_ITSELF: usize = 0;

/// Returns the division of each binary node for which a ray is expected to visit the fewest wide
/// nodes.
///
/// By dynamic programming over the binary tree (Ylitie, Karras and Laine, Efficient Incoherent Ray Traversal on GPUs
/// Through Compressed Wide BVHs, 2017).
// The simpler way, to replace the child with the largest box by its own children until there are eight, left a third of
// the nodes with two children. Dynamic programming makes 28 % fewer nodes for the dragon's 871 k triangles.
fn slot_divisions(pairs: &[BinaryNode]) -> Vec<SlotDivision> {
    let mut slot_divisions = vec![[NODE_ITSELF as u8; LANES]; pairs.len()];
    // A stack of costs. From the last node to the first, both children come before their parent, with the cost of the
    // first child on top.
    let mut costs: Vec<[f32; LANES]> = Vec::new();
    for (pair, division) in pairs.iter().zip(&mut slot_divisions).rev() {
        let cost = match pair.count {
            0 => costs
                .pop()
                .zip(costs.pop())
                .map(|(left, right)| cheapest_division(pair.bounds.half_area(), left, right, division)),
            // A leaf costs the same in all wide trees, so it counts as 0.
            _ => None,
        };
        costs.push(cost.unwrap_or([0.0; LANES]));
    }
    slot_divisions
}

/// Divides each number of slots between the two children of an inner node as cheaply as possible,
/// and returns the costs.
///
/// The cost is the sum of the half areas of all wide nodes. `area` is the half area of the node, `left` and `right` are
/// the costs of its children.
fn cheapest_division(area: f32, left: [f32; LANES], right: [f32; LANES], division: &mut SlotDivision) -> [f32; LANES] {
    let mut cost = [f32::INFINITY; LANES];
    for slots in 2..=LANES {
        for of_left in 1..slots {
            let both = left[of_left - 1] + right[slots - of_left - 1];
            // The first division is taken in any case, also where both sums are infinite because areas overflow f32.
            if both < cost[slots - 1] || of_left == 1 {
                (cost[slots - 1], division[slots - 1]) = (both, of_left as u8);
            }
        }
    }
    // In a single slot the node becomes a wide node, with eight slots of its own.
    cost[0] = area + cost[LANES - 1];
    for slots in 2..LANES {
        if cost[0] < cost[slots - 1] {
            (cost[slots - 1], division[slots - 1]) = (cost[0], NODE_ITSELF as u8);
        }
    }
    cost
}

#[cfg(all(test, unit_tests))]
mod tests;
