use super::*;
use crate::bvh::cut::{Item, ItemBounds, item};
use glam::Vec3;

/// Returns a binary tree over pseudo-random boxes, whose leaves have one box each.
fn binary_tree(boxes: usize, seed: u32) -> Vec<BinaryNode> {
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
    append_single_boxes(&mut items, 0, &mut nodes);
    nodes
}

/// Appends a binary tree whose leaves have one box each; `build::append_subtree` stops at leaves of
/// eight.
fn append_single_boxes(items: &mut [Item], first: usize, nodes: &mut Vec<BinaryNode>) {
    let bounds = ItemBounds::of(items).boxes.bounds();
    let at = nodes.len();
    if items.len() == 1 {
        return nodes.push(BinaryNode { bounds, count: 1, at: first as u32 });
    }
    nodes.push(BinaryNode { bounds, count: 0, at: 0 });
    let cut = 1 + (items.len() * 3 + first) % (items.len() - 1);
    let (left, right) = items.split_at_mut(cut);
    append_single_boxes(left, first, nodes);
    nodes[at].at = (nodes.len() - at) as u32;
    append_single_boxes(right, first + cut, nodes);
}

/// Returns the least possible sum of half areas of wide nodes, found by trying all divisions.
fn least_cost(pairs: &[BinaryNode], at: usize, slots: usize) -> f64 {
    let pair = &pairs[at];
    if pair.count > 0 {
        return 0.0;
    }
    let right = at + pair.at as usize;
    let split = |slots: usize| {
        let of_left = 1..slots;
        let both = of_left.map(|left| least_cost(pairs, at + 1, left) + least_cost(pairs, right, slots - left));
        both.fold(f64::INFINITY, f64::min)
    };
    let whole = || f64::from(pair.bounds.half_area()) + split(LANES);
    if slots == 1 { whole() } else { split(slots).min(whole()) }
}

/// Returns the sum of the half areas of all wide nodes, and the number of leaves below them.
fn cost_and_boxes(wide: &WideBuilder<'_>, at: usize) -> (f64, usize) {
    if wide.pairs[at].count > 0 {
        return (0.0, 1);
    }
    let mut children = Children::default();
    wide.gather_children(at, LANES, &mut children);
    let below = children.pairs[..children.count].iter().map(|&child| cost_and_boxes(wide, child));
    let own = f64::from(wide.pairs[at].bounds.half_area());
    below.fold((own, 0), |(cost, boxes), (more, others)| (cost + more, boxes + others))
}

#[test]
fn wide_nodes_are_the_cheapest_of_all_distributions() {
    for seed in 0..6 {
        let pairs = binary_tree(14, seed);
        let (cost, boxes) = cost_and_boxes(&WideBuilder::from_binary(&pairs), 0);
        let least = least_cost(&pairs, 0, 1);
        assert_eq!(boxes, 14, "seed {seed}");
        assert!((cost - least).abs() < 1e-4 * least, "seed {seed}: {cost}, but {least} is possible");
    }
}
