//! How the tree is built: from the root down, each time by the cut that the surface area heuristic expects to be
//! cheapest (Goldsmith and Salmon 1987), among the cuts between a few bins along each axis (Wald, On fast Construction of
//! SAH-based Bounding Volume Hierarchies, 2007).

use super::{Bvh, Child, Leaves, Node};
use crate::bounds::Bounds;
use crate::lanes::LANES;
use crate::threads;
use glam::Vec3;
use std::array::from_fn;
use std::ops::Range;

/// A box around all that is below it, of a tree with two in each node. A node's first child follows it.
#[derive(Clone, Copy)]
struct Pair {
    bounds: Bounds,
    /// How many boxes a leaf has; 0 for an inner node.
    count: u32,
    /// Of a leaf, its first place in the order; of an inner node, how far behind it the second child stands.
    at: u32,
}

/// A box, as two rows of four, which fit the CPU's registers.
#[derive(Clone, Copy)]
#[repr(align(16))]
struct Rows {
    min: [f32; 4],
    max: [f32; 4],
}

impl Rows {
    const EMPTY: Self = Self { min: [f32::INFINITY; 4], max: [f32::NEG_INFINITY; 4] };

    #[inline(always)]
    fn grow(&mut self, other: &Self) {
        for at in 0..4 {
            self.min[at] = if other.min[at] < self.min[at] { other.min[at] } else { self.min[at] };
            self.max[at] = if other.max[at] > self.max[at] { other.max[at] } else { self.max[at] };
        }
    }

    /// Twice the middle.
    #[inline(always)]
    fn middle(&self) -> [f32; 4] {
        from_fn(|at| self.min[at] + self.max[at])
    }

    fn bounds(&self) -> Bounds {
        let [x, y, z, _] = self.min;
        let [to_x, to_y, to_z, _] = self.max;
        Bounds { min: Vec3::new(x, y, z), max: Vec3::new(to_x, to_y, to_z) }
    }
}

/// A box, and where it came: its number is the bits of the fourth minimum, with which nothing is reckoned.
type Item = Rows;

fn item((number, bounds): (u32, &Bounds)) -> Item {
    let [x, y, z] = bounds.min.to_array();
    let [to_x, to_y, to_z] = bounds.max.to_array();
    Rows { min: [x, y, z, f32::from_bits(number)], max: [to_x, to_y, to_z, 0.0] }
}

/// Fewer are not worth a thread of their own.
const FEW: usize = 8192;

/// So many are a leaf: they are tested at once.
const LEAF: usize = LANES;

/// No path in a tree is longer.
const MAX_DEPTH: usize = 96;

/// Below this depth a cut may go where it likes; beyond, it halves, so that no path is longer than `MAX_DEPTH`: 2^32 is
/// halved 32 times.
const FREE_DEPTH: usize = MAX_DEPTH - 34;

type Report<'r, E> = &'r (dyn Fn(usize) -> Result<(), E> + Sync);

pub(super) fn build<E: Send>(boxes: &[Bounds], report: Report<'_, E>) -> Result<(Bvh, Leaves), E> {
    assert!(boxes.len() < 1 << 31, "there are fewer than 2^31 boxes");
    if boxes.is_empty() {
        return Ok((Bvh::default(), Leaves::default()));
    }
    let mut items: Vec<Item> = (0..).zip(boxes).map(item).collect();
    let around = Around::of(&items);
    let pairs = subtree(&mut items, &around, Place { first: 0, depth: 0 }, report)?;
    let mut wide = Wide::of(&pairs);
    let root = Some(wide.append(0));
    let order = items.iter().map(|item| item.min[3].to_bits()).collect();
    Ok((Bvh { nodes: wide.nodes, root }, Leaves { order, places: wide.leaves }))
}

/// The same tree with eight boxes in each node.
struct Wide<'p> {
    pairs: &'p [Pair],
    fillings: Vec<Filling>,
    nodes: Vec<Node>,
    leaves: Vec<Range<u32>>,
}

impl<'p> Wide<'p> {
    fn of(pairs: &'p [Pair]) -> Self {
        Self { pairs, fillings: fillings(pairs), nodes: Vec::new(), leaves: Vec::new() }
    }

    fn append(&mut self, at: usize) -> Child {
        let Pair { count, at: first, .. } = self.pairs[at];
        if count > 0 {
            self.leaves.push(first..first + count);
            return Child::leaf(self.leaves.len() as u32 - 1);
        }
        let number = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let mut children = Children::default();
        self.gather(at, LANES, &mut children);
        for (lane, &pair) in children.pairs[..children.count].iter().enumerate() {
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

    /// Adds what stands for a node in at most `places` places.
    fn gather(&self, at: usize, places: usize, children: &mut Children) {
        let left = usize::from(self.fillings[at][places - 1]);
        if left == WHOLE {
            children.pairs[children.count] = at;
            children.count += 1;
        } else {
            self.gather(at + 1, left, children);
            self.gather(at + self.pairs[at].at as usize, places - left, children);
        }
    }
}

/// The nodes of the binary tree that become the children of a wide node.
#[derive(Default)]
struct Children {
    pairs: [usize; LANES],
    count: usize,
}

/// How the nodes below a node of the binary tree are distributed over 1 to 8 places of a wide node: for each number of
/// places, how many of them go to the first child, or [`WHOLE`] where the node itself takes one place.
type Filling = [u8; LANES];

/// The node takes one place by itself.
const WHOLE: usize = 0;

/// Chooses the wide nodes that a ray is expected to meet least often, by dynamic programming over the binary tree
/// (Ylitie, Karras and Laine, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017).
///
/// To open the largest box until there are eight left a third of the nodes with two children. This way the dragon's 871 k
/// triangles have 28 % fewer nodes.
fn fillings(pairs: &[Pair]) -> Vec<Filling> {
    let mut fillings = vec![[WHOLE as u8; LANES]; pairs.len()];
    // From the last node to the first, both children come before their parent, the first child on top.
    let mut costs: Vec<[f32; LANES]> = Vec::new();
    for (pair, filling) in pairs.iter().zip(&mut fillings).rev() {
        let cost = match pair.count {
            0 => costs.pop().zip(costs.pop()).map(|(left, right)| fill(pair.bounds.half_area(), left, right, filling)),
            // A leaf is tested wherever it stands: its cost is the same in all trees.
            _ => None,
        };
        costs.push(cost.unwrap_or([0.0; LANES]));
    }
    fillings
}

/// Finds the cheapest distribution for each number of places, and returns what each costs: the half areas of the wide
/// nodes in it.
fn fill(area: f32, left: [f32; LANES], right: [f32; LANES], filling: &mut Filling) -> [f32; LANES] {
    let mut cost = [f32::INFINITY; LANES];
    for places in 2..=LANES {
        for of_left in 1..places {
            let both = left[of_left - 1] + right[places - of_left - 1];
            // Also the first of all, where areas are too great for f32.
            if both < cost[places - 1] || of_left == 1 {
                (cost[places - 1], filling[places - 1]) = (both, of_left as u8);
            }
        }
    }
    // In one place it is a node of its own, with eight places below.
    cost[0] = area + cost[LANES - 1];
    for places in 2..LANES {
        if cost[0] < cost[places - 1] {
            (cost[places - 1], filling[places - 1]) = (cost[0], WHOLE as u8);
        }
    }
    cost
}

/// Where items stand: the place of the first of them in the order, and how many nodes are above them.
#[derive(Clone, Copy)]
struct Place {
    first: usize,
    depth: usize,
}

impl Place {
    /// The places of the items on either side of a cut.
    fn halves(self, cut: usize) -> [Self; 2] {
        let depth = self.depth + 1;
        [Self { depth, ..self }, Self { first: self.first + cut, depth }]
    }
}

/// The nodes over these items, around which that is. Large halves are built at the same time; as nodes find their children
/// by distance, those of a subtree are the same wherever it comes to stand.
fn subtree<E: Send>(items: &mut [Item], around: &Around, at: Place, report: Report<'_, E>) -> Result<Vec<Pair>, E> {
    if items.len() < FEW {
        let mut nodes = Vec::with_capacity(items.len());
        append(items, around, at, &mut nodes);
        return report(items.len()).map(|()| nodes);
    }
    report(0)?;
    let bounds = around.boxes.bounds();
    let Halves { cut, around } = cut(items, around, at.depth).unwrap_or_else(|| Halves::at(items.len() / 2, items));
    let (left, right) = items.split_at_mut(cut);
    let [at_left, at_right] = at.halves(cut);
    let (left, right) =
        threads::join(|| subtree(left, &around[0], at_left, report), || subtree(right, &around[1], at_right, report));
    let (left, right) = (left?, right?);
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.push(Pair { bounds, count: 0, at: 1 + left.len() as u32 });
    nodes.extend(left);
    nodes.extend(right);
    Ok(nodes)
}

/// The same on one thread, at the end of other nodes.
fn append(items: &mut [Item], around: &Around, at: Place, nodes: &mut Vec<Pair>) {
    let bounds = around.boxes.bounds();
    let Some(Halves { cut, around }) = cut(items, around, at.depth) else {
        nodes.push(Pair { bounds, count: items.len() as u32, at: at.first as u32 });
        return;
    };
    let number = nodes.len();
    nodes.push(Pair { bounds, count: 0, at: 0 });
    let (left, right) = items.split_at_mut(cut);
    let [at_left, at_right] = at.halves(cut);
    append(left, &around[0], at_left, nodes);
    nodes[number].at = (nodes.len() - number) as u32;
    append(right, &around[1], at_right, nodes);
}

/// What items lie in.
#[derive(Clone, Copy)]
struct Around {
    boxes: Rows,
    /// Twice their middles.
    middles: Rows,
}

impl Around {
    const NOTHING: Self = Self { boxes: Rows::EMPTY, middles: Rows::EMPTY };

    fn of(items: &[Item]) -> Self {
        let mut around = Self::NOTHING;
        for item in items {
            around.grow(item);
        }
        around
    }

    #[inline(always)]
    fn grow(&mut self, item: &Item) {
        let middle = item.middle();
        self.boxes.grow(item);
        self.middles.grow(&Rows { min: middle, max: middle });
    }
}

/// Items on either side of a cut: how many come before it, and what the items of each side lie in.
struct Halves {
    cut: usize,
    around: [Around; 2],
}

impl Halves {
    fn at(cut: usize, items: &[Item]) -> Self {
        Self { cut, around: [Around::of(&items[..cut]), Around::of(&items[cut..])] }
    }
}

/// Puts the items on either side of a cut; nothing where they are a leaf.
fn cut(items: &mut [Item], around: &Around, depth: usize) -> Option<Halves> {
    if items.len() <= LEAF {
        return None;
    }
    let plane = if depth < FREE_DEPTH { Cut::cheapest(items, &around.middles) } else { None };
    // All in one place, or too deep: any half is as good.
    let Some(Cut { bin, before, .. }) = plane else { return Some(Halves::at(items.len() / 2, items)) };
    Some(partition(items, |item| bin.of(item) < before))
}

/// Puts those first for which it is true. What lies around each side is found on the way: with a pass of its own
/// over the items of each node, the tree of the dragon's 871 k triangles took 1.01 times as long.
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> Halves {
    let (mut start, mut end) = (0, items.len());
    let [mut first, mut last] = [Around::NOTHING; 2];
    while start < end {
        let item = items[start];
        if is_first(&item) {
            first.grow(&item);
            start += 1;
        } else {
            last.grow(&item);
            end -= 1;
            items.swap(start, end);
        }
    }
    Halves { cut: start, around: [first, last] }
}

/// Into how many bins items are sorted, at most.
const BINS: usize = 16;

/// Fewer items are sorted into half as many.
const FEW_BINS: usize = 48;

/// Equal parts along one axis.
#[derive(Clone, Copy)]
struct Bin {
    axis: usize,
    start: f32,
    scale: f32,
    last: usize,
}

impl Bin {
    fn along(axis: usize, middles: &Rows, bins: usize) -> Option<Self> {
        let extent = middles.max[axis] - middles.min[axis];
        let scale = bins as f32 * 0.999 / extent;
        let start = middles.min[axis];
        (extent > 0.0 && scale.is_finite()).then_some(Self { axis, start, scale, last: bins - 1 })
    }

    #[inline(always)]
    fn of(&self, item: &Item) -> usize {
        let middle = item.min[self.axis] + item.max[self.axis];
        (((middle - self.start) * self.scale) as usize).min(self.last)
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
    fn cheapest(items: &[Item], middles: &Rows) -> Option<Self> {
        let count = if items.len() < FEW_BINS { BINS / 2 } else { BINS };
        let axes = [0, 1, 2].map(|axis| Bin::along(axis, middles, count));
        let mut bins = [[(Rows::EMPTY, 0_u32); BINS]; 3];
        for item in items {
            for (bin, bins) in axes.iter().zip(&mut bins) {
                let Some(bin) = bin else { continue };
                let (rows, count) = &mut bins[bin.of(item)];
                rows.grow(item);
                *count += 1;
            }
        }
        let planes = axes.into_iter().zip(&bins).filter_map(|(bin, bins)| Self::between(bin?, &bins[..count]));
        planes.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    fn between(bin: Bin, bins: &[(Rows, u32)]) -> Option<Self> {
        let mut behind = [(0.0, 0); BINS];
        let mut sum = (Rows::EMPTY, 0);
        for at in (1..bins.len()).rev() {
            sum.0.grow(&bins[at].0);
            sum.1 += bins[at].1;
            behind[at] = (cost(sum), sum.1);
        }
        let mut sum = (Rows::EMPTY, 0);
        let mut cheapest: Option<Self> = None;
        for before in 1..bins.len() {
            sum.0.grow(&bins[before - 1].0);
            sum.1 += bins[before - 1].1;
            if sum.1 == 0 || behind[before].1 == 0 {
                continue;
            }
            let cost = cost(sum) + behind[before].0;
            if cheapest.as_ref().is_none_or(|cheapest| cost < cheapest.cost) {
                cheapest = Some(Self { bin, before, cost });
            }
        }
        cheapest
    }
}

/// The half area of the box, times the expected number of tests below it.
///
/// A leaf's boxes are tested eight at a time, so what counts is the number of blocks of eight. A sixteenth for each box
/// tells apart cuts with as many blocks. Counting single boxes instead made 18 % more leaves of the dragon's 871 k
/// triangles, and 5 % slower rays.
#[inline(always)]
fn cost((rows, count): (Rows, u32)) -> f32 {
    let [x, y, z, _]: [f32; 4] = from_fn(|at| rows.max[at] - rows.min[at]);
    let tests = count.div_ceil(LANES as u32) as f32 + count as f32 / 16.0;
    if count == 0 { 0.0 } else { tests * (x * y + y * z + z * x) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A binary tree whose leaves have one box each, of arbitrary boxes.
    fn pairs(boxes: usize, seed: u32) -> Vec<Pair> {
        let mut state = seed;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0
        };
        let mut items: Vec<Item> = (0..boxes as u32)
            .map(|at| {
                let min = Vec3::new(number(), number(), number()) * 10.0;
                item((at, &Bounds { min, max: min + Vec3::new(number(), number(), number()) }))
            })
            .collect();
        let mut nodes = Vec::new();
        one_by_one(&mut items, 0, &mut nodes);
        nodes
    }

    /// As [`append`], down to single boxes.
    fn one_by_one(items: &mut [Item], first: usize, nodes: &mut Vec<Pair>) {
        let bounds = Around::of(items).boxes.bounds();
        let at = nodes.len();
        if items.len() == 1 {
            return nodes.push(Pair { bounds, count: 1, at: first as u32 });
        }
        nodes.push(Pair { bounds, count: 0, at: 0 });
        let cut = 1 + (items.len() * 3 + first) % (items.len() - 1);
        let (left, right) = items.split_at_mut(cut);
        one_by_one(left, first, nodes);
        nodes[at].at = (nodes.len() - at) as u32;
        one_by_one(right, first + cut, nodes);
    }

    /// The least sum of half areas of wide nodes, found by trying all distributions.
    fn least_cost(pairs: &[Pair], at: usize, places: usize) -> f64 {
        let pair = &pairs[at];
        if pair.count > 0 {
            return 0.0;
        }
        let right = at + pair.at as usize;
        let split = |places: usize| {
            let of_left = 1..places;
            let both = of_left.map(|left| least_cost(pairs, at + 1, left) + least_cost(pairs, right, places - left));
            both.fold(f64::INFINITY, f64::min)
        };
        let whole = || f64::from(pair.bounds.half_area()) + split(LANES);
        if places == 1 { whole() } else { split(places).min(whole()) }
    }

    /// The sum of half areas of the wide nodes that the fillings make, and how many boxes they reach.
    fn cost_and_boxes(wide: &Wide<'_>, at: usize) -> (f64, usize) {
        if wide.pairs[at].count > 0 {
            return (0.0, 1);
        }
        let mut children = Children::default();
        wide.gather(at, LANES, &mut children);
        let below = children.pairs[..children.count].iter().map(|&child| cost_and_boxes(wide, child));
        let own = f64::from(wide.pairs[at].bounds.half_area());
        below.fold((own, 0), |(cost, boxes), (more, others)| (cost + more, boxes + others))
    }

    #[test]
    fn wide_nodes_are_the_cheapest_of_all_distributions() {
        for seed in 0..6 {
            let pairs = pairs(14, seed);
            let (cost, boxes) = cost_and_boxes(&Wide::of(&pairs), 0);
            let least = least_cost(&pairs, 0, 1);
            assert_eq!(boxes, 14, "seed {seed}");
            assert!((cost - least).abs() < 1e-4 * least, "seed {seed}: {cost}, but {least} is possible");
        }
    }

    #[test]
    fn boxes_too_large_for_f32_areas_are_all_reached() {
        let boxes: Vec<_> = (0..200)
            .map(|at| Bounds { min: Vec3::splat(-3e38), max: Vec3::new(3e38, at as f32 * 1e36, 3e38) })
            .collect();
        let (bvh, leaves) = Bvh::new(&boxes);
        let mut reached: Vec<_> = (0..leaves.count()).flat_map(|leaf| leaves.boxes(leaf).to_vec()).collect();
        reached.sort_unstable();
        assert_eq!(reached, (0..200).collect::<Vec<_>>());
        let children = bvh.nodes.iter().flat_map(|node| node.children);
        assert_eq!(children.filter_map(Child::as_leaf).count(), leaves.count());
    }
}
