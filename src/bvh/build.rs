//! How the tree is built: from the root down, each time by the cut that the surface area heuristic expects to be
//! cheapest (Goldsmith and Salmon 1987), among the cuts between a few bins along each axis (Wald, On fast Construction of
//! SAH-based Bounding Volume Hierarchies, 2007).

use super::{Bvh, Child, Leaves, Node};
use crate::bounds::Bounds;
use crate::lanes::LANES;
use glam::Vec3;
use std::ops::{ControlFlow, Range};

/// A box around all that is below it, of a tree with two in each node. A node's first child follows it.
#[derive(Clone, Copy)]
struct Pair {
    bounds: Bounds,
    /// How many boxes a leaf has; 0 for an inner node.
    count: u32,
    /// Of a leaf, its first place in the order; of an inner node, how far behind it the second child stands.
    at: u32,
}

/// A box, and where it came.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    number: u32,
}

impl Item {
    /// Twice the middle.
    fn middle(&self) -> Vec3 {
        self.bounds.min + self.bounds.max
    }
}

/// Fewer are not worth a thread of their own.
const FEW: usize = 8192;

/// A leaf has no more.
const MAX_LEAF: usize = LANES;

/// So few are not worth another node.
const MIN_LEAF: usize = 4;

/// No path in a tree is longer.
const MAX_DEPTH: usize = 96;

/// What it costs to visit a node, where a box's content costs 1.
const VISIT: f32 = 1.0;

/// Below this depth a cut may go where it likes; beyond, it halves, so that no path is longer than `MAX_DEPTH`: 2^32 is
/// halved 32 times.
const FREE_DEPTH: usize = MAX_DEPTH - 34;

type Report<'r> = &'r (dyn Fn(usize) -> ControlFlow<()> + Sync);

pub(super) fn build(boxes: &[Bounds], report: Report<'_>) -> Option<(Bvh, Leaves)> {
    assert!(boxes.len() < 1 << 31, "there are fewer than 2^31 boxes");
    if boxes.is_empty() {
        return Some((Bvh::default(), Leaves::default()));
    }
    let mut items: Vec<Item> = (0..).zip(boxes).map(|(number, &bounds)| Item { bounds, number }).collect();
    let pairs = subtree(&mut items, 0, 0, report)?;
    let mut wide = Wide { pairs: &pairs, nodes: Vec::new(), leaves: Vec::new() };
    let root = Some(wide.append(0));
    let order = items.iter().map(|item| item.number).collect();
    Some((Bvh { nodes: wide.nodes, root }, Leaves { order, places: wide.leaves }))
}

/// The same tree with eight boxes in each node.
struct Wide<'p> {
    pairs: &'p [Pair],
    nodes: Vec<Node>,
    leaves: Vec<Range<u32>>,
}

impl Wide<'_> {
    fn append(&mut self, at: usize) -> Child {
        let Pair { count, at: first, .. } = self.pairs[at];
        if count > 0 {
            self.leaves.push(first..first + count);
            return Child::leaf(self.leaves.len() as u32 - 1);
        }
        let number = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let (below, count) = self.eight_below(at);
        for (lane, &pair) in below[..count].iter().enumerate() {
            let child = self.append(pair);
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

    /// Up to eight nodes that are together what is below this one: the largest is opened until there are so many.
    fn eight_below(&self, at: usize) -> ([usize; LANES], usize) {
        let children = |at: usize| [at + 1, at + self.pairs[at].at as usize];
        let mut below = [0; LANES];
        [below[0], below[1]] = children(at);
        let mut count = 2;
        while count < LANES {
            let area = |at: usize| self.pairs[at].bounds.half_area();
            let inner = (0..count).filter(|&lane| self.pairs[below[lane]].count == 0);
            let Some(largest) = inner.max_by(|&a, &b| area(below[a]).total_cmp(&area(below[b]))) else { break };
            [below[largest], below[count]] = children(below[largest]);
            count += 1;
        }
        (below, count)
    }
}

/// The nodes over these items, of which the first stands at that place in the order. Large halves are built at the same
/// time; as nodes find their children by distance, those of a subtree are the same wherever it comes to stand.
fn subtree(items: &mut [Item], first: usize, depth: usize, report: Report<'_>) -> Option<Vec<Pair>> {
    if items.len() < FEW {
        let mut nodes = Vec::with_capacity(items.len());
        append(items, first, depth, &mut nodes);
        return report(items.len()).is_continue().then_some(nodes);
    }
    if report(0).is_break() {
        return None;
    }
    let bounds = around(items);
    let cut = cut(items, &bounds, depth).unwrap_or(items.len() / 2);
    let (left, right) = items.split_at_mut(cut);
    let (left, right) =
        rayon::join(|| subtree(left, first, depth + 1, report), || subtree(right, first + cut, depth + 1, report));
    let (left, right) = (left?, right?);
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.push(Pair { bounds, count: 0, at: 1 + left.len() as u32 });
    nodes.extend(left);
    nodes.extend(right);
    Some(nodes)
}

/// The same on one thread, at the end of other nodes.
fn append(items: &mut [Item], first: usize, depth: usize, nodes: &mut Vec<Pair>) {
    let bounds = around(items);
    let Some(cut) = cut(items, &bounds, depth) else {
        nodes.push(Pair { bounds, count: items.len() as u32, at: first as u32 });
        return;
    };
    let at = nodes.len();
    nodes.push(Pair { bounds, count: 0, at: 0 });
    let (left, right) = items.split_at_mut(cut);
    append(left, first, depth + 1, nodes);
    nodes[at].at = (nodes.len() - at) as u32;
    append(right, first + cut, depth + 1, nodes);
}

fn around(items: &[Item]) -> Bounds {
    items.iter().fold(Bounds::EMPTY, |bounds, item| bounds.union(&item.bounds))
}

/// Puts the items on either side of a cut, and answers how many come before it; nothing where a leaf is as good.
fn cut(items: &mut [Item], bounds: &Bounds, depth: usize) -> Option<usize> {
    if items.len() <= MIN_LEAF {
        return None;
    }
    let middles = Bounds::of(items.iter().map(Item::middle));
    let plane = if depth < FREE_DEPTH { Cut::cheapest(items, &middles) } else { None };
    let leaf_cost = items.len() as f32 * bounds.half_area();
    match plane {
        Some(plane) if items.len() > MAX_LEAF || plane.cost + VISIT * bounds.half_area() < leaf_cost => {
            Some(partition(items, |item| plane.bin.of(item) < plane.before))
        }
        // All in one place, or too deep: any half is as good.
        None if items.len() > MAX_LEAF => Some(items.len() / 2),
        _ => None,
    }
}

/// Those for which it is true come first. How many they are.
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> usize {
    let (mut start, mut end) = (0, items.len());
    while start < end {
        if is_first(&items[start]) {
            start += 1;
        } else {
            end -= 1;
            items.swap(start, end);
        }
    }
    start
}

const BINS: usize = 16;

/// Equal parts along one axis.
#[derive(Clone, Copy)]
struct Bin {
    axis: usize,
    start: f32,
    scale: f32,
}

impl Bin {
    fn along(axis: usize, middles: &Bounds) -> Option<Self> {
        let extent = middles.extent()[axis];
        let scale = BINS as f32 * 0.999 / extent;
        (extent > 0.0 && scale.is_finite()).then_some(Self { axis, start: middles.min[axis], scale })
    }

    fn of(&self, item: &Item) -> usize {
        (((item.middle()[self.axis] - self.start) * self.scale) as usize).min(BINS - 1)
    }
}

/// A cut between two bins.
struct Cut {
    bin: Bin,
    /// The first bin behind it.
    before: usize,
    /// What is expected to be tested on both sides.
    cost: f32,
}

impl Cut {
    fn cheapest(items: &[Item], middles: &Bounds) -> Option<Self> {
        let planes = (0..3).filter_map(|axis| Self::cheapest_along(Bin::along(axis, middles)?, items));
        planes.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    fn cheapest_along(bin: Bin, items: &[Item]) -> Option<Self> {
        let mut bins = [(Bounds::EMPTY, 0_u32); BINS];
        for item in items {
            let (bounds, count) = &mut bins[bin.of(item)];
            *bounds = bounds.union(&item.bounds);
            *count += 1;
        }
        let mut behind = [0.0; BINS];
        let mut sum = (Bounds::EMPTY, 0);
        for at in (1..BINS).rev() {
            sum = (sum.0.union(&bins[at].0), sum.1 + bins[at].1);
            behind[at] = cost(sum);
        }
        let mut sum = (Bounds::EMPTY, 0);
        let costs = (1..BINS).filter_map(|before| {
            sum = (sum.0.union(&bins[before - 1].0), sum.1 + bins[before - 1].1);
            let is_between = 0 < sum.1 && (sum.1 as usize) < items.len();
            is_between.then(|| Self { bin, before, cost: cost(sum) + behind[before] })
        });
        costs.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

fn cost((bounds, count): (Bounds, u32)) -> f32 {
    if count == 0 { 0.0 } else { count as f32 * bounds.half_area() }
}
