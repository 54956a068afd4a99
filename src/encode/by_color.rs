//! The order of cells by colour, in which consecutive cells share colours.
//!
//! A picture cell has a pair of colours, glyph and background. All cells of a pair are written one after another, with
//! only cursor moves between them. Pairs that share a colour are neighbours, and a greedy tour goes from neighbour to
//! neighbour, so that mostly one colour changes at a time. The next pair is the neighbour with the lowest cost; pairs
//! with few unvisited neighbours are preferred, because they would be left over. If no neighbour is left, or the next
//! pair in reading order costs less, the tour continues there.
//!
//! With the pairs `ab`, `bc`, `ac` and `dd` in reading order and a pen of `ab`, the tour is `ab` (no change), then
//! `bc` and `ac` in either order (one colour each), then `dd`.

use super::moves::{CellPosition, cheapest_move};
use super::numbering::Numbering;
use super::pen::Pen;
use super::strokes::cursor_after;
use crate::grid::{Attributes, Grid, HalfBlocks, PackedCell, PackedInk};
use std::ops::Range;

/// The working memory of the order.
#[derive(Default)]
pub(super) struct Scratch {
    /// The cells of the picture, in reading order.
    picture: Vec<CellPosition>,
    /// The index of the pair of each cell in `picture`.
    pair_of_cell: Vec<u32>,
    /// The pairs' colours, in reading order of their first cells.
    pair_keys: Numbering,
    inks: Numbering,
    positions: Vec<CellPosition>,
    pairs: Vec<Pair>,
    colors: Vec<Color>,
    pairs_by_color: Vec<usize>,
    tried: Vec<usize>,
}

/// Lists the changed cells in the order of writing: text row by row, then the picture's tour.
pub(super) fn order(
    wanted: &Grid,
    changed: &[CellPosition],
    half_blocks: HalfBlocks,
    pen: Pen,
    scratch: &mut Scratch,
    order: &mut Vec<CellPosition>,
) {
    order.clear();
    scratch.picture.clear();
    for &position in changed {
        let is_picture = picture_inks(wanted.packed_cell(position.column, position.row)).is_some();
        let list = if is_picture { &mut scratch.picture } else { &mut *order };
        list.push(position);
    }
    let last = order.last().copied();
    let pen = last.map_or(pen, |position| pen.pen_for(wanted.packed_cell(position.column, position.row)));
    let mut tour = Tour::new(wanted, half_blocks, pen, scratch);
    tour.cursor = last.and_then(|position| cursor_after(wanted, position));
    tour.visit_all(order);
}

/// Returns the glyph and background colours of a picture cell, equal for a space; `None` for text.
fn picture_inks(cell: PackedCell) -> Option<(PackedInk, PackedInk)> {
    if !cell.attributes().is_empty() || !cell.bg.is_rgb() {
        return None;
    }
    match cell.character()? {
        '▄' | '▀' if cell.fg.is_rgb() => Some((cell.fg, cell.bg)),
        ' ' => Some((cell.bg, cell.bg)),
        _ => None,
    }
}

/// A pair of colours, and all cells that have it.
struct Pair {
    fg: PackedInk,
    bg: PackedInk,
    /// The range of the pair's cells in `Tour::positions`, in reading order.
    positions: Range<usize>,
    /// The indices of the pair's colours in `Tour::colors`; both are equal for spaces.
    colors: [usize; 2],
    /// Whether the tour has written the pair's cells.
    visited: bool,
}

/// A greedy tour over the pairs of colours, with the pen and cursor where it has arrived.
struct Tour<'a> {
    wanted: &'a Grid,
    half_blocks: HalfBlocks,
    pen: Pen,
    /// The indices in `colors` of the pen's glyph and background colours, if the picture has them.
    pen_colors: [Option<usize>; 2],
    cursor: Option<CellPosition>,
    /// The number of neighbours whose costs may still be computed.
    lookups: usize,
    /// The cells of all pairs, one pair after another.
    positions: &'a [CellPosition],
    /// The pairs in reading order of their first cells.
    pairs: &'a mut [Pair],
    /// The colours of the picture.
    colors: &'a mut [Color],
    /// The indices of the pairs that contain each colour: a range for each (see [`Color::pairs`]).
    // A single list, because one list per colour would take an allocation for each.
    pairs_by_color: &'a mut [usize],
    /// The neighbours whose costs are compared.
    tried: &'a mut Vec<usize>,
}

/// A colour of the picture, and the pairs that contain it.
struct Color {
    /// The bits of the colour.
    key: u64,
    /// The range of the colour's pairs in `Tour::pairs_by_color`, used as a stack with the first
    /// pair in reading order on top.
    // A visited pair is dropped once it is on top, which is cheaper than searching for it when it is visited.
    pairs: Range<usize>,
    /// The number of the colour's pairs that the tour has not visited.
    unvisited: usize,
}

/// Largest number of neighbours whose costs are compared, for each colour of the pen.
// Without a limit, a frame in which thousands of pairs share a colour takes quadratic time. With a limit of 64, 80,000
// pairs that share a colour took 15 times ratatui's time; with the limit on the mean as well, 3.9 times.
const MAX_NEIGHBOURS_PER_COLOR: usize = 64;

/// Largest mean number of neighbours whose costs are compared, per pair of the tour.
// Few pairs have many neighbours, unless the picture is noise. The limit reduces the time for noise of 80,000 cells
// from 10 to 3.4 times ratatui's, and adds at most 0.0012 of ratatui's bytes (orbit, 200x60).
const MEAN_LOOKUPS_PER_PAIR: usize = 8;

impl<'a> Tour<'a> {
    fn new(wanted: &'a Grid, half_blocks: HalfBlocks, pen: Pen, scratch: &'a mut Scratch) -> Self {
        scratch.list_pairs(wanted, half_blocks);
        scratch.list_positions();
        scratch.list_pairs_by_color();
        let Scratch { inks, positions, pairs, colors, pairs_by_color, tried, .. } = scratch;
        let pen_colors = [pen.fg, pen.bg].map(|ink| inks.get(ink.bits().into()));
        Self {
            wanted,
            half_blocks,
            pen,
            pen_colors,
            cursor: None,
            lookups: 0,
            positions,
            pairs,
            colors,
            pairs_by_color,
            tried,
        }
    }

    /// Visits all pairs, and appends the positions of their cells to `order`.
    fn visit_all(&mut self, order: &mut Vec<CellPosition>) {
        for next in 0..self.pairs.len() {
            // Reading order is the fallback, so the tour visits every pair.
            while !self.pairs[next].visited {
                let pair = self.cheapest_pair(next);
                self.visit_pair(pair, order);
            }
        }
    }

    /// Returns the index of the cheapest pair among `next` and unvisited pairs that share a colour
    /// with the pen.
    fn cheapest_pair(&mut self, next: usize) -> usize {
        let mut best = (self.cost(next), next);
        self.lookups += MEAN_LOOKUPS_PER_PAIR;
        for color in self.pen_colors.into_iter().flatten() {
            self.tried.clear();
            while self.tried.len() < MAX_NEIGHBOURS_PER_COLOR.min(self.lookups)
                && let Some(at) = self.colors[color].pairs.next_back()
            {
                let pair = self.pairs_by_color[at];
                if !self.pairs[pair].visited {
                    best = best.min((self.cost(pair), pair));
                    self.tried.push(pair);
                }
            }
            self.lookups -= self.tried.len();
            // The pairs are pushed back in reverse, so that the first one in reading order is on top of the stack
            // again.
            for &pair in self.tried.iter().rev() {
                let end = &mut self.colors[color].pairs.end;
                self.pairs_by_color[*end] = pair;
                *end += 1;
            }
        }
        best.1
    }

    /// Returns the cost in bytes of continuing the tour with the pair at an index.
    ///
    /// The cost consists of the change of pen and the move to the pair's first cell. Up to eight bytes are added for
    /// unvisited pairs that share a colour with this one, because a pair with few such neighbours is better visited
    /// early.
    fn cost(&self, pair: usize) -> usize {
        let pair = &self.pairs[pair];
        let change = self.pen.switch_cost(&self.pair_pen(pair));
        let move_len = cheapest_move(self.cursor, self.positions[pair.positions.start]).len();
        let unvisited = pair.colors.map(|color| self.colors[color].unvisited);
        change + move_len + unvisited[0].min(unvisited[1]).min(8)
    }

    /// Returns the cheaper pen for a pair: its colours as they are or, where allowed, exchanged.
    fn pair_pen(&self, pair: &Pair) -> Pen {
        let pen = |fg, bg| Pen { fg, bg, ..self.pen.after_attributes(Attributes::empty()) };
        if pair.fg == pair.bg {
            return pen(self.pen.fg, pair.bg);
        }
        let (plain, flipped) = (pen(pair.fg, pair.bg), pen(pair.bg, pair.fg));
        let flip =
            self.half_blocks == HalfBlocks::Either && self.pen.switch_cost(&flipped) < self.pen.switch_cost(&plain);
        if flip { flipped } else { plain }
    }

    /// Appends the cells of pair `index` to `order`, and updates pen and cursor.
    fn visit_pair(&mut self, index: usize, order: &mut Vec<CellPosition>) {
        self.pen = self.pair_pen(&self.pairs[index]);
        let pair = &mut self.pairs[index];
        pair.visited = true;
        let [a, b] = pair.colors;
        self.pen_colors = if a == b {
            [self.pen_colors[0], Some(a)]
        } else if self.colors[a].key == u64::from(self.pen.fg.bits()) {
            [Some(a), Some(b)]
        } else {
            [Some(b), Some(a)]
        };
        for &color in distinct_colors(&pair.colors) {
            self.colors[color].unvisited -= 1;
        }
        let positions = &self.positions[pair.positions.clone()];
        order.extend_from_slice(positions);
        self.cursor = positions.last().and_then(|last| cursor_after(self.wanted, *last));
    }
}

impl Scratch {
    /// Lists the pairs of the picture's cells and their colours.
    fn list_pairs(&mut self, wanted: &Grid, half_blocks: HalfBlocks) {
        let count = self.picture.len();
        self.pair_keys.clear(count);
        self.inks.clear(2 * count);
        self.pair_of_cell.clear();
        self.pairs.clear();
        for &CellPosition { column, row } in &self.picture {
            let (fg, bg) = picture_inks(wanted.packed_cell(column, row)).unwrap_or_default();
            // If a cell may use either half block, (fg, bg) and (bg, fg) are the same pair.
            let (a, b) = if half_blocks == HalfBlocks::Either && bg < fg { (bg, fg) } else { (fg, bg) };
            let pair = self.pair_keys.add(u64::from(a.bits()) << 32 | u64::from(b.bits()));
            if pair == self.pairs.len() {
                let colors = [a, b].map(|ink| self.inks.add(ink.bits().into()));
                self.pairs.push(Pair { fg, bg, positions: 0..0, colors, visited: false });
            }
            self.pairs[pair].positions.end += 1;
            self.pair_of_cell.push(pair as u32);
        }
    }

    /// Lists the cells by pair, each pair's in reading order.
    fn list_positions(&mut self) {
        let mut start = 0;
        for Pair { positions, .. } in &mut self.pairs {
            let count = positions.end;
            *positions = start..start;
            start += count;
        }
        self.positions.clear();
        self.positions.resize(start, CellPosition { column: 0, row: 0 });
        for (&position, &pair) in self.picture.iter().zip(&self.pair_of_cell) {
            let end = &mut self.pairs[pair as usize].positions.end;
            self.positions[*end] = position;
            *end += 1;
        }
    }

    /// Lists the colours, and in `pairs_by_color` the pairs that contain each of them.
    fn list_pairs_by_color(&mut self) {
        let Self { inks, pairs, colors, pairs_by_color, .. } = self;
        colors.clear();
        colors.extend(inks.keys().iter().map(|&key| Color { key, pairs: 0..0, unvisited: 0 }));
        for &color in pairs.iter().flat_map(|pair| distinct_colors(&pair.colors)) {
            colors[color].unvisited += 1;
        }
        let mut end = 0;
        for color in colors.iter_mut() {
            color.pairs = end..end;
            end += color.unvisited;
        }
        pairs_by_color.clear();
        pairs_by_color.resize(end, 0);
        // In reverse, so that the first pair in reading order is on top of each colour's stack.
        for (at, pair) in pairs.iter().enumerate().rev() {
            for &color in distinct_colors(&pair.colors) {
                let end = &mut colors[color].pairs.end;
                pairs_by_color[*end] = at;
                *end += 1;
            }
        }
    }
}

/// Returns the two colours of a pair, or one if they are equal.
fn distinct_colors(colors: &[usize; 2]) -> &[usize] {
    if colors[0] == colors[1] { &colors[..1] } else { colors }
}
