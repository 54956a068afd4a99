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

use super::moves::{CellPosition, cheapest_len};
use super::numbering::Numbering;
use super::pen::{Pen, rgb_len};
use super::strokes::cursor_after;
use crate::grid::{Attributes, Grid, HalfBlocks, PackedCell, PackedInk};
use std::ops::Range;

/// The working memory of [`order`].
#[derive(Default)]
pub(super) struct Scratch {
    /// The cells of the picture, in reading order.
    picture: Vec<CellPosition>,
    /// The index of the pair of each cell in `picture`.
    pair_of_cell: Vec<u32>,
    /// The pairs' colours, in reading order of their first cells.
    pair_keys: Numbering<[PackedInk; 2]>,
    inks: Numbering<PackedInk>,
    positions: Vec<CellPosition>,
    pairs: Vec<Pair>,
    colors: Vec<Color>,
    pairs_by_color: Vec<u32>,
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
    scratch.list_pairs(wanted, half_blocks);
    scratch.list_positions();
    scratch.list_pairs_by_color();
    let mut tour = Tour::new(half_blocks, pen, scratch);
    tour.cursor = last.and_then(|position| cursor_after(wanted, position));
    tour.visit_all(wanted, order);
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
    /// The indices in `Tour::colors` of the glyph's and the background's colour; both are equal
    /// for spaces.
    colors: [u32; 2],
    /// The first of the pair's cells.
    first: CellPosition,
    /// The range of the pair's cells in `Tour::positions`, in reading order.
    positions: Range<u32>,
    /// Whether the tour has written the pair's cells.
    visited: bool,
}

/// A greedy tour over the pairs of colours, with the pen and cursor where it has arrived.
struct Tour<'a> {
    half_blocks: HalfBlocks,
    pen: PenColors,
    /// The colours whose pairs are tried next: those of the pen, if the picture has them.
    near: [Option<u32>; 2],
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
    pairs_by_color: &'a mut [u32],
}

/// A colour of the picture, and the pairs that contain it.
#[derive(Clone)]
struct Color {
    /// The range of the colour's pairs in `Tour::pairs_by_color`, used as a stack with the first
    /// pair in reading order on top.
    // A visited pair is dropped once it is near the top, which is cheaper than searching for it when it is visited.
    pairs: Range<u32>,
    /// The number of the colour's pairs that the tour has not visited.
    unvisited: u32,
    /// The bytes that make it the glyph's or the background's colour.
    len: u8,
}

/// The colours of a pen without attributes.
#[derive(Clone, Copy)]
struct PenColors {
    /// The indices in `Tour::colors` of the pen's colours, for glyphs and for the background;
    /// `u32::MAX` for one that no cell of the picture has.
    colors: [u32; 2],
    /// The bytes of the codes that the next sequence begins with, which end the attributes of text.
    code_len: u32,
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
    fn new(half_blocks: HalfBlocks, pen: Pen, scratch: &'a mut Scratch) -> Self {
        let Scratch { inks, positions, pairs, colors, pairs_by_color, .. } = scratch;
        let color_of = |ink: PackedInk| inks.get(ink).map(|color| color as u32);
        let plain = pen.after_attributes(Attributes::empty());
        let pen_colors = PenColors {
            colors: [plain.fg, plain.bg].map(|ink| color_of(ink).unwrap_or(u32::MAX)),
            code_len: pen.attributes_len(Attributes::empty()) as u32,
        };
        Self {
            half_blocks,
            pen: pen_colors,
            near: [pen.fg, pen.bg].map(color_of),
            cursor: None,
            lookups: 0,
            positions,
            pairs,
            colors,
            pairs_by_color,
        }
    }

    /// Visits all pairs, and appends the positions of their cells to `order`.
    fn visit_all(&mut self, wanted: &Grid, order: &mut Vec<CellPosition>) {
        for next in 0..self.pairs.len() {
            // Reading order is the fallback, so the tour visits every pair.
            while !self.pairs[next].visited {
                let pair = self.cheapest_pair(next as u32);
                self.visit_pair(pair, wanted, order);
            }
        }
    }

    /// Returns the index of the cheapest pair among `next` and unvisited pairs that share a colour
    /// with the pen.
    fn cheapest_pair(&mut self, next: u32) -> u32 {
        let mut best = self.cheaper((u32::MAX, next), next);
        self.lookups += MEAN_LOOKUPS_PER_PAIR;
        for color in self.near.into_iter().flatten() {
            let Range { start, end } = self.colors[color as usize].pairs;
            let (mut rest, mut kept) = (end, end);
            while ((end - kept) as usize) < MAX_NEIGHBOURS_PER_COLOR.min(self.lookups) && rest > start {
                rest -= 1;
                let pair = self.pairs_by_color[rest as usize];
                if !self.pairs[pair as usize].visited {
                    best = self.cheaper(best, pair);
                    kept -= 1;
                    self.pairs_by_color[kept as usize] = pair;
                }
            }
            self.lookups -= (end - kept) as usize;
            if rest < kept {
                self.pairs_by_color.copy_within(kept as usize..end as usize, rest as usize);
                self.colors[color as usize].pairs.end -= kept - rest;
            }
        }
        best.1
    }

    /// Returns the cheaper pair, with its cost in bytes: the `best` one so far or another.
    ///
    /// The cost of continuing the tour with a pair consists of the change of pen and the move to the pair's first cell.
    /// Up to eight bytes are added for unvisited pairs that share a colour with this one, because a pair with few such
    /// neighbours is better visited early.
    #[inline]
    fn cheaper(&self, best: (u32, u32), index: u32) -> (u32, u32) {
        let pair = &self.pairs[index as usize];
        let unvisited = pair.colors.map(|color| self.colors[color as usize].unvisited);
        let cost = self.pen_after(pair).0 + unvisited[0].min(unvisited[1]).min(8);
        if cost > best.0 {
            return best;
        }
        best.min((cost + cheapest_len(self.cursor, pair.first) as u32, index))
    }

    /// Returns the cheaper pen for a pair, with the bytes of the change: its colours as they are
    /// or, where allowed, exchanged.
    #[inline]
    fn pen_after(&self, pair: &Pair) -> (u32, [u32; 2]) {
        let PenColors { colors: [pen_fg, pen_bg], code_len } = self.pen;
        let [fg, bg] = pair.colors;
        let [fg_len, bg_len] = pair.colors.map(|color| u32::from(self.colors[color as usize].len));
        let needed = |len: u32, is_set: bool| if is_set { 0 } else { len };
        let sequence_len = |len: u32| if len == 0 { 0 } else { 2 + len };
        if fg == bg {
            return (sequence_len(code_len + needed(bg_len, bg == pen_bg)), [pen_fg, bg]);
        }
        let plain = code_len + needed(fg_len, fg == pen_fg) + needed(bg_len, bg == pen_bg);
        let flipped = code_len + needed(fg_len, fg == pen_bg) + needed(bg_len, bg == pen_fg);
        if self.half_blocks == HalfBlocks::Either && flipped < plain {
            (sequence_len(flipped), [bg, fg])
        } else {
            (sequence_len(plain), [fg, bg])
        }
    }

    /// Appends the cells of a pair to `order`, and updates pen and cursor.
    fn visit_pair(&mut self, index: u32, wanted: &Grid, order: &mut Vec<CellPosition>) {
        let (_, colors) = self.pen_after(&self.pairs[index as usize]);
        self.pen = PenColors { colors, code_len: 0 };
        let pair = &mut self.pairs[index as usize];
        pair.visited = true;
        self.near = [if pair.colors[0] == pair.colors[1] { self.near[0] } else { Some(colors[0]) }, Some(colors[1])];
        for &color in distinct_colors(&pair.colors) {
            self.colors[color as usize].unvisited -= 1;
        }
        let positions = &self.positions[pair.positions.start as usize..pair.positions.end as usize];
        order.extend_from_slice(positions);
        self.cursor = positions.last().and_then(|last| cursor_after(wanted, *last));
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
        for &position in &self.picture {
            let cell = wanted.packed_cell(position.column, position.row);
            let (fg, bg) = picture_inks(cell).unwrap_or_default();
            // If a cell may use either half block, (fg, bg) and (bg, fg) are the same pair.
            let key = if half_blocks == HalfBlocks::Either && bg < fg { [bg, fg] } else { [fg, bg] };
            let pair = self.pair_keys.add(key);
            if pair == self.pairs.len() {
                let colors = [fg, bg].map(|ink| self.inks.add(ink) as u32);
                self.pairs.push(Pair { colors, first: position, positions: 0..0, visited: false });
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
        self.positions.resize(start as usize, CellPosition { column: 0, row: 0 });
        for (&position, &pair) in self.picture.iter().zip(&self.pair_of_cell) {
            let end = &mut self.pairs[pair as usize].positions.end;
            self.positions[*end as usize] = position;
            *end += 1;
        }
    }

    /// Lists the colours, and in `pairs_by_color` the pairs that contain each of them.
    fn list_pairs_by_color(&mut self) {
        let Self { inks, pairs, colors, pairs_by_color, .. } = self;
        colors.clear();
        let color = |ink: &PackedInk| Color { pairs: 0..0, unvisited: 0, len: rgb_len(ink.channels()) as u8 };
        colors.extend(inks.keys().iter().map(color));
        for &color in pairs.iter().flat_map(|pair| distinct_colors(&pair.colors)) {
            colors[color as usize].unvisited += 1;
        }
        let mut end = 0;
        for color in colors.iter_mut() {
            color.pairs = end..end;
            end += color.unvisited;
        }
        pairs_by_color.clear();
        pairs_by_color.resize(end as usize, 0);
        // In reverse, so that the first pair in reading order is on top of each colour's stack.
        for (at, pair) in pairs.iter().enumerate().rev() {
            for &color in distinct_colors(&pair.colors) {
                let end = &mut colors[color as usize].pairs.end;
                pairs_by_color[*end as usize] = at as u32;
                *end += 1;
            }
        }
    }
}

/// Returns the two colours of a pair, or one if they are equal.
fn distinct_colors(colors: &[u32; 2]) -> &[u32] {
    if colors[0] == colors[1] { &colors[..1] } else { colors }
}
