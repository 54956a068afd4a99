//! The order by colour, in which the colours of one cell serve the next.
//!
//! A cell of the picture has a pair of colours. All cells of a pair are written one after another, with only moves
//! between them. Pairs that share a colour are neighbours, and a greedy tour goes from neighbour to neighbour, so that
//! mostly one colour changes at a time. The next pair is the neighbour with the lowest cost; pairs with few unvisited
//! neighbours are preferred, because they would be left over. If no neighbour is left, or the next pair in reading
//! order costs less, the tour continues there.
//!
//! With the pairs `ab`, `bc`, `ac` and `dd` in reading order and a pen of `ab`, the tour is `ab` (no change), `bc` or
//! `ac` (one colour), the other of them (one colour), `dd`.

use super::moves::{CellPosition, cheapest_move};
use super::pen::Pen;
use super::strokes::cursor_after;
use crate::grid::{Attributes, Cell, Glyph, Grid, HalfBlocks, Ink};
use std::ops::Range;

/// Returns the changed cells in writing order: text row by row, then the tour of the picture.
pub(super) fn order(wanted: &Grid, changed: &[CellPosition], half_blocks: HalfBlocks, pen: Pen) -> Vec<CellPosition> {
    let is_picture = |position: &&CellPosition| picture_inks(wanted.cell(position.column, position.row)).is_some();
    let picture: Vec<CellPosition> = changed.iter().filter(is_picture).copied().collect();
    let mut order: Vec<CellPosition> = changed.iter().filter(|position| !is_picture(position)).copied().collect();
    let last = order.last().copied();
    let pen = last.map_or(pen, |position| pen.pen_for(wanted.cell(position.column, position.row)));
    let mut tour = Tour::new(wanted, &picture, half_blocks, pen);
    tour.cursor = last.and_then(|position| cursor_after(wanted, position));
    tour.walk(&mut order);
    order
}

/// Returns the glyph's and the background's colour of a picture's cell; both are equal for a space.
fn picture_inks(cell: &Cell) -> Option<(Ink, Ink)> {
    let is_rgb = |ink| matches!(ink, Ink::Rgb(_));
    match cell.glyph {
        Glyph::Char('▄' | '▀') if cell.attributes.is_empty() && is_rgb(cell.fg) && is_rgb(cell.bg) => {
            Some((cell.fg, cell.bg))
        }
        Glyph::Char(' ') if cell.attributes.is_empty() && is_rgb(cell.bg) => Some((cell.bg, cell.bg)),
        _ => None,
    }
}

/// Returns a colour as a number to sort by.
fn sort_key(ink: Ink) -> u32 {
    match ink {
        Ink::Rgb(c) => u32::from_be_bytes([0, c.r, c.g, c.b]),
        Ink::Default | Ink::Indexed(_) => u32::MAX,
    }
}

/// All cells of one pair of colours.
struct Pair {
    fg: Ink,
    bg: Ink,
    /// The range of its cells in `Tour::positions`, in reading order.
    positions: Range<usize>,
    /// The indices of its colours in `Tour::colors`; both are equal for spaces.
    colors: [usize; 2],
    /// Whether the tour has visited the pair.
    visited: bool,
}

/// A greedy tour over the pairs.
struct Tour<'a> {
    wanted: &'a Grid,
    half_blocks: HalfBlocks,
    pen: Pen,
    /// The indices in `colors` of the pen's glyph and background colours, if the picture has them.
    pen_colors: [Option<usize>; 2],
    cursor: Option<CellPosition>,
    /// The number of neighbours that may still be looked up.
    lookups: usize,
    positions: Vec<CellPosition>,
    /// The pairs in reading order of their first cells.
    pairs: Vec<Pair>,
    /// The colours of the picture, sorted by key.
    colors: Vec<Color>,
    /// For each colour, one after another, the indices of the pairs that contain it.
    // One list instead of one per colour, without an allocation for each.
    pairs_by_color: Vec<usize>,
}

/// A colour of the picture and its pairs.
struct Color {
    sort_key: u32,
    /// The range of its pairs in `Tour::pairs_by_color`: a stack in reverse reading order.
    // A visited pair is dropped when it is found on top, which is cheaper than finding it when it is visited.
    pairs: Range<usize>,
    /// The number of its unvisited pairs.
    unvisited: usize,
}

/// Largest number of neighbours looked up by one colour.
// With all of them, a frame in which thousands of pairs share a colour takes the square of their number. With 64,
// 80,000 pairs over one colour took 15 times ratatui's time, and with the limit on the mean 3.9 times.
const MAX_NEIGHBOURS_PER_COLOR: usize = 64;

/// Mean number of neighbours looked up per pair, at most.
// Few pairs have many neighbours, unless the picture is noise. The limit takes noise of 80,000 cells from 10 to 3.4
// times ratatui's time and costs at most 0.0012 of ratatui's bytes (orbit, 200x60).
const MEAN_LOOKUPS_PER_PAIR: usize = 8;

impl<'a> Tour<'a> {
    fn new(wanted: &'a Grid, picture: &[CellPosition], half_blocks: HalfBlocks, pen: Pen) -> Self {
        let mut cells: Vec<(u32, u32, CellPosition)> =
            picture.iter().map(|&position| with_sort_keys(wanted, position, half_blocks)).collect();
        // The sort is stable, so the cells of a pair stay in reading order.
        cells.sort_by_key(|&(a, b, _)| u64::from(a) << 32 | u64::from(b));
        let mut sort_keys: Vec<u32> = cells.iter().flat_map(|&(a, b, _)| [a, b]).collect();
        sort_keys.sort_unstable();
        sort_keys.dedup();
        let mut pairs: Vec<Pair> = Vec::new();
        let mut start = 0;
        for group in cells.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let (a, b, position) = group[0];
            let (fg, bg) = picture_inks(wanted.cell(position.column, position.row)).unwrap_or_default();
            let colors = [a, b].map(|key| sort_keys.binary_search(&key).unwrap_or(0));
            pairs.push(Pair { fg, bg, positions: start..start + group.len(), colors, visited: false });
            start += group.len();
        }
        pairs.sort_by_cached_key(|pair| {
            let first = cells[pair.positions.start].2;
            (first.row, first.column)
        });
        let (colors, pairs_by_color) = pairs_by_color(&sort_keys, &pairs);
        let positions = cells.into_iter().map(|(_, _, position)| position).collect();
        let pen_colors = [pen.fg, pen.bg].map(|ink| sort_keys.binary_search(&sort_key(ink)).ok());
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

    /// Appends the positions in the order of the tour.
    fn walk(&mut self, order: &mut Vec<CellPosition>) {
        for next in 0..self.pairs.len() {
            while !self.pairs[next].visited {
                let pair = self.cheapest_pair(next);
                self.visit(pair, order);
            }
        }
    }

    /// Returns the cheapest pair among `next` and the pairs that share a colour with the pen.
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
            for pair in tried.into_iter().rev() {
                let end = &mut self.colors[color].pairs.end;
                self.pairs_by_color[*end] = pair;
                *end += 1;
            }
        }
        best.1
    }

    /// Returns the cost in bytes of continuing with a pair of colours.
    ///
    /// The cost is that of the change of pen and of the move to the first cell. Up to eight bytes are added for the
    /// unvisited pairs that share a colour with this one: a pair that leads to few others is better visited early.
    fn cost(&self, pair: usize) -> usize {
        let pair = &self.pairs[pair];
        let change = self.pen.switch_cost(&self.pair_pen(pair));
        let move_len = cheapest_move(self.cursor, self.positions[pair.positions.start]).len();
        let unvisited = pair.colors.map(|color| self.colors[color].unvisited);
        change + move_len + unvisited[0].min(unvisited[1]).min(8)
    }

    /// Returns the cheaper of the pens that can write the pair.
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

    /// Appends the cells of a pair, and moves pen and cursor behind them.
    fn visit(&mut self, at: usize, order: &mut Vec<CellPosition>) {
        self.pen = self.pair_pen(&self.pairs[at]);
        let pair = &mut self.pairs[at];
        pair.visited = true;
        let [a, b] = pair.colors;
        self.pen_colors = if a == b {
            [self.pen_colors[0], Some(a)]
        } else if self.colors[a].sort_key == sort_key(self.pen.fg) {
            [Some(a), Some(b)]
        } else {
            [Some(b), Some(a)]
        };
        for &color in distinct(&pair.colors) {
            self.colors[color].unvisited -= 1;
        }
        let positions = &self.positions[pair.positions.clone()];
        order.extend_from_slice(positions);
        self.cursor = positions.last().and_then(|last| cursor_after(self.wanted, *last));
    }
}

/// Returns the colours, and the pairs of each.
fn pairs_by_color(sort_keys: &[u32], pairs: &[Pair]) -> (Vec<Color>, Vec<usize>) {
    let mut colors: Vec<Color> =
        sort_keys.iter().map(|&sort_key| Color { sort_key, pairs: 0..0, unvisited: 0 }).collect();
    for color in pairs.iter().flat_map(|pair| distinct(&pair.colors)) {
        colors[*color].unvisited += 1;
    }
    let mut end = 0;
    for color in &mut colors {
        color.pairs = end..end;
        end += color.unvisited;
    }
    let mut neighbours = vec![0; end];
    for (at, pair) in pairs.iter().enumerate().rev() {
        for &color in distinct(&pair.colors) {
            let end = &mut colors[color].pairs.end;
            neighbours[*end] = at;
            *end += 1;
        }
    }
    (colors, neighbours)
}

/// Returns both colours, or one if they are equal.
fn distinct(colors: &[usize; 2]) -> &[usize] {
    if colors[0] == colors[1] { &colors[..1] } else { colors }
}

/// Returns a cell with the sort keys of its colours, the smaller first if the cell may be flipped.
fn with_sort_keys(wanted: &Grid, position: CellPosition, half_blocks: HalfBlocks) -> (u32, u32, CellPosition) {
    let (fg, bg) = picture_inks(wanted.cell(position.column, position.row)).unwrap_or_default();
    let (a, b) = (sort_key(fg), sort_key(bg));
    if half_blocks == HalfBlocks::Either && b < a { (b, a, position) } else { (a, b, position) }
}
