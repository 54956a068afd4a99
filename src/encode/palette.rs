//! Reduction of the number of colours in a lossy frame, within the tolerance.
//!
//! A palette is chosen by greedy set cover (Johnson 1974): first the colour that most half cells can take, then the one
//! that most of the remaining half cells can take, and so on. Pairs of palette colours are then chosen in the same way,
//! because all cells of one pair are written without a change of the pen.

use super::halves::{Halves, Tolerance, squared_difference};
use crate::color::{Oklab, Srgb8};
use crate::grid::{HalfBlocks, PackedInk};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::mem;

/// Replaces the cells' colours by palette colours within the tolerance.
///
/// With [`HalfBlocks::Either`] a pair of colours counts as the same pair in either order. The pen's colours are also
/// candidates for the palette.
pub(super) fn snap_to_palette(
    cells: &mut [&mut Halves],
    pen: [PackedInk; 2],
    tolerance: Tolerance,
    half_blocks: HalfBlocks,
) {
    let table = ColorTable::from_cells_and_pen(cells, pen);
    let choices = table.choices_by_color(tolerance);
    let wanted: Vec<[usize; 2]> = cells.iter().map(|cell| cell.map(|color| table.index(color))).collect();
    let pairs = choose_pairs(&wanted, &choices, half_blocks);
    for ((cell, wanted), pair) in cells.iter_mut().zip(wanted).zip(pairs) {
        let [a, b] = pair.map(|index| table.colors[index]);
        let fits = |pair: [usize; 2]| (0..2).all(|half| choices[wanted[half]].contains(&pair[half]));
        let error = |halves: Halves| squared_difference(halves[0], cell[0]) + squared_difference(halves[1], cell[1]);
        let flipped = half_blocks == HalfBlocks::Either
            && fits([pair[1], pair[0]])
            && (!fits(pair) || error([b, a]) < error([a, b]));
        **cell = if flipped { [b, a] } else { [a, b] };
    }
}

/// The distinct colours of some cells and of the pen.
struct ColorTable {
    /// The colours, sorted.
    colors: Vec<Srgb8>,
    /// The number of halves that want each colour.
    halves: Vec<usize>,
    oklab: Vec<Oklab>,
}

/// Largest number of palette colours that are considered for a half cell.
// More would hardly save bytes, and the number of possible pairs grows with the square.
const MAX_CHOICES: usize = 4;

/// Number of colours, nearest in lightness on either side, with which each colour is compared.
// In pictures the colours within the tolerance are among them. In noise they are not: it took 192 times ratatui's time
// before this limit and two others, and takes 21 times with them.
const LIGHTNESS_NEIGHBOURS: usize = 24;

impl ColorTable {
    fn from_cells_and_pen(cells: &[&mut Halves], pen: [PackedInk; 2]) -> Self {
        let of_pen = pen.into_iter().filter_map(|ink| Some((ink.color()?, 0)));
        let of_cells = cells.iter().flat_map(|cell| cell.map(|color| (color, 1)));
        let mut all: Vec<(Srgb8, usize)> = of_cells.chain(of_pen).collect();
        all.sort_unstable();
        let same = || all.chunk_by(|a, b| a.0 == b.0);
        let colors: Vec<Srgb8> = same().map(|same| same[0].0).collect();
        let halves = same().map(|same| same.iter().map(|&(_, halves)| halves).sum()).collect();
        let oklab = colors.iter().map(|&color| Oklab::from_srgb8(color)).collect();
        Self { colors, halves, oklab }
    }

    fn index(&self, color: Srgb8) -> usize {
        self.colors.binary_search(&color).expect("the cells' colours are all here")
    }

    /// Returns for each colour the palette colours that may replace it, those that replace the most
    /// half cells first.
    fn choices_by_color(&self, tolerance: Tolerance) -> Vec<Vec<usize>> {
        let exchangeable = self.exchangeable_by_color(tolerance);
        let mut choices: Vec<Vec<usize>> = vec![Vec::new(); self.colors.len()];
        for color in greedy_cover(&exchangeable, &self.halves) {
            for &half in &exchangeable[color] {
                if choices[half].len() < MAX_CHOICES {
                    choices[half].push(color);
                }
            }
        }
        choices
    }

    /// Returns for each colour the colours within the tolerance, including itself.
    // OKLab distance is at least the difference in lightness, so only neighbours in an order by lightness are compared.
    fn exchangeable_by_color(&self, tolerance: Tolerance) -> Vec<Vec<usize>> {
        let mut order: Vec<usize> = (0..self.colors.len()).collect();
        order.sort_unstable_by(|&a, &b| self.oklab[a].l.total_cmp(&self.oklab[b].l));
        let mut exchangeable: Vec<Vec<usize>> = (0..order.len()).map(|color| vec![color]).collect();
        for (at, &a) in order.iter().enumerate() {
            let lightest = self.oklab[a].l + tolerance.distance;
            for &b in order[at + 1..].iter().take(LIGHTNESS_NEIGHBOURS).take_while(|&&b| self.oklab[b].l <= lightest) {
                if squared_difference(self.colors[a], self.colors[b]) <= tolerance.square
                    && self.oklab[a].distance(self.oklab[b]) <= tolerance.distance
                {
                    exchangeable[a].push(b);
                    exchangeable[b].push(a);
                }
            }
        }
        exchangeable
    }
}

/// Returns for each cell a pair out of the `choices` for its two `wanted` colours, using few
/// distinct pairs.
fn choose_pairs(wanted: &[[usize; 2]], choices: &[Vec<usize>], half_blocks: HalfBlocks) -> Vec<[usize; 2]> {
    let mut possible: Vec<([usize; 2], usize)> = Vec::new();
    for (cell, &[upper, lower]) in wanted.iter().enumerate() {
        for &a in &choices[upper] {
            for &b in &choices[lower] {
                possible.push((if half_blocks == HalfBlocks::Either { [a.min(b), a.max(b)] } else { [a, b] }, cell));
            }
        }
    }
    possible.sort_unstable();
    possible.dedup();
    let (pairs, cells): (Vec<[usize; 2]>, Vec<usize>) = possible.into_iter().unzip();
    let mut groups = Vec::new();
    let mut start = 0;
    for same in pairs.chunk_by(|a, b| a == b) {
        // A pair that only one cell can show saves nothing.
        if same.len() > 1 {
            groups.push((same[0], &cells[start..start + same.len()]));
        }
        start += same.len();
    }
    let sets: Vec<&[usize]> = groups.iter().map(|group| group.1).collect();
    // A cell without a shared pair takes, for each half, the colour that the most halves can take.
    let mut chosen: Vec<[usize; 2]> = wanted.iter().map(|cell| cell.map(|color| choices[color][0])).collect();
    let mut is_chosen = vec![false; wanted.len()];
    for group in greedy_cover(&sets, &vec![1; wanted.len()]) {
        let (pair, cells) = groups[group];
        for &cell in cells {
            if !mem::replace(&mut is_chosen[cell], true) {
                chosen[cell] = pair;
            }
        }
    }
    chosen
}

/// Returns indices of sets that together cover all members, chosen greedily by the weight of
/// members not yet covered.
fn greedy_cover(sets: &[impl AsRef<[usize]>], weights: &[usize]) -> Vec<usize> {
    let mut left = weights.to_vec();
    // Lazy evaluation: gains only shrink, so a set whose gain still equals that of its heap entry is the best (Minoux
    // 1978).
    let mut heap: BinaryHeap<(usize, Reverse<usize>)> =
        sets.iter().enumerate().map(|(at, set)| (remaining_weight(set.as_ref(), &left), Reverse(at))).collect();
    let mut chosen = Vec::new();
    while let Some((promised, Reverse(at))) = heap.pop() {
        let added = remaining_weight(sets[at].as_ref(), &left);
        if added == 0 {
            continue;
        }
        if added < promised {
            heap.push((added, Reverse(at)));
            continue;
        }
        chosen.push(at);
        for &member in sets[at].as_ref() {
            left[member] = 0;
        }
    }
    chosen
}

fn remaining_weight(set: &[usize], weights: &[usize]) -> usize {
    set.iter().map(|&member| weights[member]).sum()
}
