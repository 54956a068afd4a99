//! The order by colour: cells are visited so that the colours of one serve the next.
//!
//! A cell of the picture has a pair of colours. All cells of one pair are written in a row, with nothing but moves
//! between them. Pairs that share a colour are neighbours, and the way goes from neighbour to neighbour, so that mostly
//! one colour changes at a time: always to the one that costs least from here, those with few other neighbours first,
//! because they would be left over. Where no neighbour is left, or the next pair in reading order costs less, it goes
//! on there.

use super::moves::{CellPosition, cheapest_move};
use super::pen::Pen;
use super::strokes::cursor_after;
use crate::grid::{Attributes, Cell, Glyph, Grid, HalfBlocks, Ink};
use std::ops::Range;

/// The positions in the order in which they are to be written: first what is no picture, row by row.
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

/// The two colours of a picture's cell: of the character and behind it. A space has one, twice.
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

/// A colour as a number to sort by.
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
    /// The positions of its cells in `Tour::positions`, in reading order.
    positions: Range<usize>,
    /// The numbers of its colours in `Tour::colors`: one twice if it is flat.
    colors: [usize; 2],
    visited: bool,
}

struct Tour<'a> {
    wanted: &'a Grid,
    half_blocks: HalfBlocks,
    pen: Pen,
    /// The numbers of its two colours in `colors`, for glyphs and behind them, if the picture has them.
    pen_colors: [Option<usize>; 2],
    cursor: Option<CellPosition>,
    /// How many neighbours may still be looked at.
    lookups: usize,
    positions: Vec<CellPosition>,
    /// In reading order of their first cells.
    pairs: Vec<Pair>,
    /// All colours, sorted by number.
    colors: Vec<Color>,
    /// The pairs of each colour.
    pairs_by_color: Vec<usize>,
}

struct Color {
    sort_key: u32,
    /// The pairs that have it, in `Tour::neighbours`, the first in reading order last; those visited are dropped when they
    /// are met.
    pairs: Range<usize>,
    /// How many of them are not visited.
    unvisited: usize,
}

/// How many neighbours over one colour are looked at, at most: with all of them, a frame in which thousands of pairs share
/// a colour would take the square of that.
const MAX_NEIGHBOURS_PER_COLOR: usize = 64;

/// How many neighbours are looked at for each pair in the mean, at most: few have many, unless the picture is noise.
const MEAN_LOOKUPS_PER_PAIR: usize = 8;

impl<'a> Tour<'a> {
    fn new(wanted: &'a Grid, picture: &[CellPosition], half_blocks: HalfBlocks, pen: Pen) -> Self {
        let mut cells: Vec<(u32, u32, CellPosition)> =
            picture.iter().map(|&position| with_sort_keys(wanted, position, half_blocks)).collect();
        // In reading order within a pair: the sort is stable.
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

    /// The cheapest of the pairs that share a colour with the pen, and of `next`.
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

    /// What it costs to go on with a pair, in bytes: the change of the pen, the move to its first cell, and up to eight
    /// for how well it can wait.
    fn cost(&self, pair: usize) -> usize {
        let pair = &self.pairs[pair];
        let change = self.pen.switch_cost(&self.pair_pen(pair));
        let move_len = cheapest_move(self.cursor, self.positions[pair.positions.start]).len();
        let unvisited = pair.colors.map(|color| self.colors[color].unvisited);
        change + move_len + unvisited[0].min(unvisited[1]).min(8)
    }

    /// The cheaper of the two pens that can write the pair.
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

/// All colours, and the pairs of each.
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

/// The two colours, or the one that both are.
fn distinct(colors: &[usize; 2]) -> &[usize] {
    if colors[0] == colors[1] { &colors[..1] } else { colors }
}

/// A cell's colours to sort by: as they are, or, where a cell can be turned, the smaller one first.
fn with_sort_keys(wanted: &Grid, position: CellPosition, half_blocks: HalfBlocks) -> (u32, u32, CellPosition) {
    let (fg, bg) = picture_inks(wanted.cell(position.column, position.row)).unwrap_or_default();
    let (a, b) = (sort_key(fg), sort_key(bg));
    if half_blocks == HalfBlocks::Either && b < a { (b, a, position) } else { (a, b, position) }
}
