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
use super::pen::Pen;
use super::strokes::cursor_after;
use crate::grid::{Attributes, Grid, HalfBlocks, PackedCell, PackedInk};
use std::ops::Range;

/// Returns the changed cells in the order of writing: text row by row, then picture cells by the
/// tour.
pub(super) fn order(wanted: &Grid, changed: &[CellPosition], half_blocks: HalfBlocks, pen: Pen) -> Vec<CellPosition> {
    let is_picture =
        |position: &&CellPosition| picture_inks(wanted.packed_cell(position.column, position.row)).is_some();
    let picture: Vec<CellPosition> = changed.iter().filter(is_picture).copied().collect();
    let mut order: Vec<CellPosition> = changed.iter().filter(|position| !is_picture(position)).copied().collect();
    let last = order.last().copied();
    let pen = last.map_or(pen, |position| pen.pen_for(wanted.packed_cell(position.column, position.row)));
    let mut tour = Tour::new(wanted, &picture, half_blocks, pen);
    tour.cursor = last.and_then(|position| cursor_after(wanted, position));
    tour.visit_all(&mut order);
    order
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
    /// Whether the tour has visited the pair.
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
    positions: Vec<CellPosition>,
    /// The pairs in reading order of their first cells.
    pairs: Vec<Pair>,
    /// The colours of the picture, sorted.
    colors: Vec<Color>,
    /// The indices of the pairs that contain each colour: a range for each (see [`Color::pairs`]).
    // A single list, because one list per colour would take an allocation for each.
    pairs_by_color: Vec<usize>,
}

/// A colour of the picture, and the pairs that contain it.
struct Color {
    ink: PackedInk,
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
    fn new(wanted: &'a Grid, picture: &[CellPosition], half_blocks: HalfBlocks, pen: Pen) -> Self {
        let mut cells: Vec<(PackedInk, PackedInk, CellPosition)> =
            picture.iter().map(|&position| with_colors(wanted, position, half_blocks)).collect();
        // The sort is stable, so the cells of a pair stay in reading order.
        cells.sort_by_key(|&(a, b, _)| (a, b));
        let mut inks: Vec<PackedInk> = cells.iter().flat_map(|&(a, b, _)| [a, b]).collect();
        inks.sort_unstable();
        inks.dedup();
        let mut pairs: Vec<Pair> = Vec::new();
        let mut start = 0;
        for group in cells.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let (a, b, position) = group[0];
            let (fg, bg) = picture_inks(wanted.packed_cell(position.column, position.row)).unwrap_or_default();
            let colors = [a, b].map(|key| inks.binary_search(&key).unwrap_or(0));
            pairs.push(Pair { fg, bg, positions: start..start + group.len(), colors, visited: false });
            start += group.len();
        }
        pairs.sort_by_cached_key(|pair| {
            let first = cells[pair.positions.start].2;
            (first.row, first.column)
        });
        let (colors, pairs_by_color) = pairs_by_color(&inks, &pairs);
        let positions = cells.into_iter().map(|(_, _, position)| position).collect();
        let pen_colors = [pen.fg, pen.bg].map(|ink| inks.binary_search(&ink).ok());
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
            let mut tried = Vec::new();
            while tried.len() < MAX_NEIGHBOURS_PER_COLOR.min(self.lookups)
                && let Some(at) = self.colors[color].pairs.next_back()
            {
                let pair = self.pairs_by_color[at];
                if !self.pairs[pair].visited {
                    best = best.min((self.cost(pair), pair));
                    tried.push(pair);
                }
            }
            self.lookups -= tried.len();
            // In reverse, so that the first pair in reading order is on top again.
            for pair in tried.into_iter().rev() {
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

    /// Appends the cells of pair `index` to `order`, and sets pen and cursor to those after them.
    fn visit_pair(&mut self, index: usize, order: &mut Vec<CellPosition>) {
        self.pen = self.pair_pen(&self.pairs[index]);
        let pair = &mut self.pairs[index];
        pair.visited = true;
        let [a, b] = pair.colors;
        self.pen_colors = if a == b {
            [self.pen_colors[0], Some(a)]
        } else if self.colors[a].ink == self.pen.fg {
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

/// Returns the colours, and for all of them the list of pairs that their ranges refer to.
fn pairs_by_color(inks: &[PackedInk], pairs: &[Pair]) -> (Vec<Color>, Vec<usize>) {
    let mut colors: Vec<Color> = inks.iter().map(|&ink| Color { ink, pairs: 0..0, unvisited: 0 }).collect();
    for color in pairs.iter().flat_map(|pair| distinct_colors(&pair.colors)) {
        colors[*color].unvisited += 1;
    }
    let mut end = 0;
    for color in &mut colors {
        color.pairs = end..end;
        end += color.unvisited;
    }
    let mut neighbours = vec![0; end];
    // In reverse for the same reason: the first pair in reading order is on top.
    for (at, pair) in pairs.iter().enumerate().rev() {
        for &color in distinct_colors(&pair.colors) {
            let end = &mut colors[color].pairs.end;
            neighbours[*end] = at;
            *end += 1;
        }
    }
    (colors, neighbours)
}

/// Returns the two colours of a pair, or one if they are equal.
fn distinct_colors(colors: &[usize; 2]) -> &[usize] {
    if colors[0] == colors[1] { &colors[..1] } else { colors }
}

/// Returns a cell's two colours, the smaller first if the cell may be flipped, and
/// its position.
fn with_colors(wanted: &Grid, position: CellPosition, half_blocks: HalfBlocks) -> (PackedInk, PackedInk, CellPosition) {
    let (a, b) = picture_inks(wanted.packed_cell(position.column, position.row)).unwrap_or_default();
    if half_blocks == HalfBlocks::Either && b < a { (b, a, position) } else { (a, b, position) }
}
