//! The build of the tree: a binary tree from the root down, which is then collapsed into nodes with
//! eight children.

pub(super) use super::cut::item;
use super::cut::{CutSides, Item, ItemBounds, cut};
use super::wide::{BinaryNode, WideBuilder};
use super::{Bvh, Leaves};
use crate::threads;

/// The number of items below which a subtree is built on one thread.
// The dragon's 871 k triangles still make over 100 tasks, enough to balance the threads.
pub const MIN_TASK_ITEMS: usize = 8192;

type ProgressReport<'r, E> = &'r (dyn Fn(usize) -> Result<(), E> + Sync);

pub(super) fn build<E: Send>(mut items: Vec<Item>, report: ProgressReport<'_, E>) -> Result<(Bvh, Leaves), E> {
    if items.is_empty() {
        return Ok((Bvh::default(), Leaves::default()));
    }
    let bounds = ItemBounds::of(&items);
    let pairs = build_subtree(&mut items, &bounds, NodePosition { first: 0, depth: 0 }, report)?;
    // The items were partitioned in place, so they are in the order of the leaves.
    let order = items.iter().map(|item| item.min[3].to_bits()).collect();
    drop(items);
    let mut wide = WideBuilder::from_binary(&pairs);
    let root = Some(wide.append_node(0));
    let bvh = Bvh { nodes: wide.nodes, root, bounds: Some(bounds.boxes.bounds()) };
    Ok((bvh, Leaves { order, ranges: wide.leaves }))
}

/// The position of a binary node: the index of its first item, and the number of nodes above it.
#[derive(Clone, Copy)]
struct NodePosition {
    first: usize,
    depth: usize,
}

impl NodePosition {
    /// Returns the positions of both children, of which the first has `cut` items.
    fn children(self, cut: usize) -> [Self; 2] {
        let depth = self.depth + 1;
        [Self { depth, ..self }, Self { first: self.first + cut, depth }]
    }
}

/// Returns the binary tree over `items`, whose bounds are `bounds`.
// Large sides are built in parallel. They can be joined unchanged, as a node stores the distance to its second child,
// not the child's index.
fn build_subtree<E: Send>(
    items: &mut [Item],
    bounds: &ItemBounds,
    position: NodePosition,
    report: ProgressReport<'_, E>,
) -> Result<Vec<BinaryNode>, E> {
    if items.len() < MIN_TASK_ITEMS {
        let mut nodes = Vec::with_capacity(items.len());
        append_subtree(items, bounds, position, &mut nodes);
        return report(items.len()).map(|()| nodes);
    }
    // A report without progress, so that a large build can be cancelled between subtrees.
    report(0)?;
    let node_bounds = bounds.boxes.bounds();
    let CutSides { cut, bounds } =
        cut(items, bounds, position.depth).unwrap_or_else(|| CutSides::cut_at(items.len() / 2, items));
    let (left, right) = items.split_at_mut(cut);
    let [at_left, at_right] = position.children(cut);
    let (left, right) = threads::join(
        || build_subtree(left, &bounds[0], at_left, report),
        || build_subtree(right, &bounds[1], at_right, report),
    );
    let (left, right) = (left?, right?);
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.push(BinaryNode { bounds: node_bounds, count: 0, at: 1 + left.len() as u32 });
    nodes.extend(left);
    nodes.extend(right);
    Ok(nodes)
}

/// Appends the binary tree over `items` to `nodes`, on one thread.
fn append_subtree(items: &mut [Item], bounds: &ItemBounds, position: NodePosition, nodes: &mut Vec<BinaryNode>) {
    let node_bounds = bounds.boxes.bounds();
    let Some(CutSides { cut, bounds }) = cut(items, bounds, position.depth) else {
        nodes.push(BinaryNode { bounds: node_bounds, count: items.len() as u32, at: position.first as u32 });
        return;
    };
    let number = nodes.len();
    nodes.push(BinaryNode { bounds: node_bounds, count: 0, at: 0 });
    let (left, right) = items.split_at_mut(cut);
    let [at_left, at_right] = position.children(cut);
    append_subtree(left, &bounds[0], at_left, nodes);
    nodes[number].at = (nodes.len() - number) as u32;
    append_subtree(right, &bounds[1], at_right, nodes);
}

#[cfg(all(test, unit_tests))]
mod tests;
