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

use super::halves::{LOWER_HALF, SPACE, UPPER_HALF};
use super::moves::{CellPosition, KnownCursor, Move, cheapest_len};
use super::numbering::Numbering;
use super::pen::{Pen, rgb_parameters_len};
use super::strokes::cursor_after;
use crate::grid::{Attributes, Grid, HalfBlocks, PackedCell, PackedInk};
use std::ops::Range;

/// The working memory of [`order`].
#[derive(Default)]
pub(super) struct OrderScratch {
    /// The cells of the picture, in reading order, with the colours of glyph and background.
    picture: Vec<(CellPosition, [PackedInk; 2])>,
    /// The index of the pair of each cell in `picture`.
    pair_of_cell: Vec<u32>,
    /// The pairs' colours, in reading order of their first cells.
    pair_keys: Numbering<[PackedInk; 2]>,
    inks: Numbering<PackedInk>,
    positions: Vec<CellPosition>,
    pairs: Vec<Pair>,
    colors: Vec<Color>,
    links: Vec<[Link; 2]>,
}

/// Lists the changed cells in the order of writing: text row by row, then the picture's tour.
pub(super) fn order(
    wanted: &Grid,
    changed: &[CellPosition],
    half_blocks: HalfBlocks,
    pen: Pen,
    scratch: &mut OrderScratch,
    order: &mut Vec<CellPosition>,
) {
    order.clear();
    scratch.picture.clear();
    for &position in changed {
        match picture_inks(wanted.packed_cell(position.column, position.row)) {
            Some(inks) => scratch.picture.push((position, inks)),
            None => order.push(position),
        }
    }
    let last = order.last().copied();
    let pen = last.map_or(pen, |position| pen.pen_for(wanted.packed_cell(position.column, position.row)));
    scratch.list_pairs(half_blocks);
    scratch.list_positions();
    scratch.link_pairs();
    let cursor = last.map_or(KnownCursor::Unknown, |position| cursor_after(wanted, position));
    Tour::new(half_blocks, pen, cursor, scratch).visit_all(wanted, order);
}

/// Returns the glyph and background colours of a picture cell, equal for a space; `None` for text.
fn picture_inks(cell: PackedCell) -> Option<[PackedInk; 2]> {
    let inks = match cell.glyph_and_attributes() {
        LOWER_HALF | UPPER_HALF => [cell.fg, cell.bg],
        SPACE => [cell.bg; 2],
        _ => return None,
    };
    inks.iter().all(|ink| ink.is_rgb()).then_some(inks)
}

/// A pair of colours, and all cells that have it.
struct Pair {
    /// The indices in `Tour::colors` of the glyph's and the background's colour; both are equal
    /// for spaces.
    colors: [u32; 2],
    /// The number of bytes that set each of the two colours.
    lens: [u8; 2],
    /// The number of bytes of an absolute move to the first cell.
    move_len: u8,
    /// Whether the tour has written the pair's cells.
    visited: bool,
    /// The first of the pair's cells.
    first: CellPosition,
    /// The range of the pair's cells in `Tour::positions`, in reading order.
    positions: Range<u32>,
}

/// A greedy tour over the pairs of colours.
struct Tour<'a> {
    place: PlacedCell,
    /// The colours whose pairs are tried next: those of the pen, if the picture has them.
    near: [Option<u32>; 2],
    /// The number of unvisited pairs whose costs may still be computed.
    lookups: usize,
    /// The cells of all pairs, one pair after another.
    positions: &'a [CellPosition],
    /// The pairs in reading order of their first cells.
    pairs: &'a mut [Pair],
    /// The colours of the picture.
    colors: &'a mut [Color],
    /// For each pair, its links in the lists of its two colours.
    links: &'a mut [[Link; 2]],
}

/// The place where a tour has arrived: its pen, which has no attributes, and its cursor.
#[derive(Clone, Copy)]
struct PlacedCell {
    half_blocks: HalfBlocks,
    /// The indices in `Tour::colors` of the pen's colours, for glyphs and for the background;
    /// `u32::MAX` for one that no cell of the picture has.
    pen: [u32; 2],
    /// The number of bytes of the codes at the start of the next sequence that end the
    /// attributes of text.
    code_len: u32,
    cursor: KnownCursor,
}

/// A colour of the picture, and the list of the pairs that contain it and are not visited.
#[derive(Clone)]
struct Color {
    /// The first pair in reading order.
    first: PairOfColor,
    /// The number of pairs.
    unvisited: u32,
}

/// The neighbours of a pair in the list of a colour.
#[derive(Clone, Copy)]
struct Link {
    before: PairOfColor,
    next: PairOfColor,
}

/// Twice the index of a pair, plus the place of a colour in the pair; `u32::MAX` at the end of a
/// list.
type PairOfColor = u32;

const END: PairOfColor = u32::MAX;

/// Largest number of unvisited pairs whose costs are compared, for each colour of the pen.
// Without a limit, a frame in which thousands of pairs share a colour takes quadratic time. With a limit of 64, 80,000
// pairs that share a colour took 15 times ratatui's time; with the limit on the mean as well, 3.9 times.
const MAX_NEIGHBOURS_PER_COLOR: usize = 64;

/// Largest mean number of unvisited pairs whose costs are compared, per step of the tour.
// Few pairs share a colour with many others, unless the picture is noise. The limit reduces the time for noise of
// 80,000 cells from 10 to 3.4 times ratatui's, and adds at most 0.0012 of ratatui's bytes (orbit, 200x60).
const MEAN_LOOKUPS_PER_PAIR: usize = 8;

impl<'a> Tour<'a> {
    fn new(half_blocks: HalfBlocks, pen: Pen, cursor: KnownCursor, scratch: &'a mut OrderScratch) -> Self {
        let OrderScratch { inks, positions, pairs, colors, links, .. } = scratch;
        let color_of = |ink: PackedInk| inks.get(ink).map(|color| color as u32);
        let plain = pen.after_attributes(Attributes::empty());
        let place = PlacedCell {
            half_blocks,
            pen: [plain.fg, plain.bg].map(|ink| color_of(ink).unwrap_or(u32::MAX)),
            code_len: pen.attributes_len(Attributes::empty()) as u32,
            cursor,
        };
        Self { place, near: [pen.fg, pen.bg].map(color_of), lookups: 0, positions, pairs, colors, links }
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
        let Self { place, pairs, colors, links, .. } = self;
        let mut best = place.cheaper((u32::MAX, next), next, &pairs[next as usize], colors);
        self.lookups += MEAN_LOOKUPS_PER_PAIR;
        for color in self.near.into_iter().flatten() {
            let most = self.lookups.min(MAX_NEIGHBOURS_PER_COLOR);
            let (mut tried, mut pair_of_color) = (0, colors[color as usize].first);
            while tried < most && pair_of_color != END {
                let index = pair_of_color / 2;
                best = place.cheaper(best, index, &pairs[index as usize], colors);
                pair_of_color = links[index as usize][(pair_of_color % 2) as usize].next;
                tried += 1;
            }
            self.lookups -= tried;
        }
        best.1
    }

    /// Appends the cells of a pair to `order`, and updates pen and cursor.
    fn visit_pair(&mut self, index: u32, wanted: &Grid, order: &mut Vec<CellPosition>) {
        let pair = &mut self.pairs[index as usize];
        pair.visited = true;
        let (_, pen) = self.place.cheaper_pen_change(pair);
        self.near = [if pair.colors[0] == pair.colors[1] { self.near[0] } else { Some(pen[0]) }, Some(pen[1])];
        let colors = pair.colors;
        let positions = &self.positions[pair.positions.start as usize..pair.positions.end as usize];
        for (place, &color) in distinct_colors(&colors).iter().enumerate() {
            self.unlink(index, place, color);
        }
        match positions {
            // Most pairs have one cell, for which copying a slice takes several times as long.
            &[position] => order.push(position),
            _ => order.extend_from_slice(positions),
        }
        let cursor = positions.last().map_or(KnownCursor::Unknown, |last| cursor_after(wanted, *last));
        self.place = PlacedCell { pen, code_len: 0, cursor, ..self.place };
    }

    /// Removes a pair from the list of a colour, which has this place in the pair.
    fn unlink(&mut self, index: u32, place: usize, color: u32) {
        let Link { before, next } = self.links[index as usize][place];
        let link = |of: PairOfColor| ((of / 2) as usize, (of % 2) as usize);
        if before == END {
            self.colors[color as usize].first = next;
        } else {
            let (pair, place) = link(before);
            self.links[pair][place].next = next;
        }
        if next != END {
            let (pair, place) = link(next);
            self.links[pair][place].before = before;
        }
        self.colors[color as usize].unvisited -= 1;
    }
}

impl PlacedCell {
    /// Returns the cheaper pair, with its cost in bytes: the `best` one so far or another.
    ///
    /// The cost of continuing the tour with a pair consists of the change of pen and the move to the pair's first cell.
    /// Up to eight bytes are added for unvisited pairs that share a colour with this one, because a pair with few such
    /// neighbours is better visited early.
    #[inline]
    fn cheaper(&self, best: (u32, u32), index: u32, pair: &Pair, colors: &[Color]) -> (u32, u32) {
        let unvisited = pair.colors.map(|color| colors[color as usize].unvisited);
        let cost = self.cheaper_pen_change(pair).0 + unvisited[0].min(unvisited[1]).min(8);
        if cost > best.0 {
            return best;
        }
        best.min((cost + cheapest_len(self.cursor, pair.first, pair.move_len.into()) as u32, index))
    }

    /// Returns the number of bytes of the cheaper pen change for a pair, and the pen's new colours.
    ///
    /// These are the pair's colours as they are or, where allowed, exchanged.
    #[inline]
    fn cheaper_pen_change(&self, pair: &Pair) -> (u32, [u32; 2]) {
        let ([pen_fg, pen_bg], [fg, bg]) = (self.pen, pair.colors);
        let [fg_len, bg_len] = pair.lens.map(u32::from);
        let needed = |len: u32, is_set: bool| if is_set { 0 } else { len };
        let sequence_len = |len: u32| if len == 0 { 0 } else { 2 + len };
        if fg == bg {
            return (sequence_len(self.code_len + needed(bg_len, bg == pen_bg)), [pen_fg, bg]);
        }
        let plain = self.code_len + needed(fg_len, fg == pen_fg) + needed(bg_len, bg == pen_bg);
        let flipped = self.code_len + needed(fg_len, fg == pen_bg) + needed(bg_len, bg == pen_fg);
        if self.half_blocks == HalfBlocks::Either && flipped < plain {
            (sequence_len(flipped), [bg, fg])
        } else {
            (sequence_len(plain), [fg, bg])
        }
    }
}

impl OrderScratch {
    /// Lists the pairs of the picture's cells and their colours.
    fn list_pairs(&mut self, half_blocks: HalfBlocks) {
        let count = self.picture.len();
        self.pair_keys.clear(count);
        self.inks.clear(2 * count);
        self.pair_of_cell.clear();
        self.pairs.clear();
        for &(position, [fg, bg]) in &self.picture {
            // If a cell may use either half block, (fg, bg) and (bg, fg) are the same pair.
            let key = if half_blocks == HalfBlocks::Either && bg < fg { [bg, fg] } else { [fg, bg] };
            let pair = self.pair_keys.add(key);
            if pair == self.pairs.len() {
                self.pairs.push(Pair {
                    colors: [fg, bg].map(|ink| self.inks.add(ink) as u32),
                    lens: [fg, bg].map(|ink| rgb_parameters_len(ink.channels()) as u8),
                    move_len: Move::To(position).len() as u8,
                    visited: false,
                    first: position,
                    positions: 0..0,
                });
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
        for (&(position, _), &pair) in self.picture.iter().zip(&self.pair_of_cell) {
            let end = &mut self.pairs[pair as usize].positions.end;
            self.positions[*end as usize] = position;
            *end += 1;
        }
    }

    /// Lists the colours, and links the pairs that contain each of them.
    fn link_pairs(&mut self) {
        let Self { inks, pairs, colors, links, .. } = self;
        colors.clear();
        colors.resize(inks.keys().len(), Color { first: END, unvisited: 0 });
        links.clear();
        links.resize(pairs.len(), [Link { before: END, next: END }; 2]);
        // In reverse, so that the first pair in reading order is the first of each list.
        for (at, pair) in pairs.iter().enumerate().rev() {
            for (place, &color) in distinct_colors(&pair.colors).iter().enumerate() {
                let Color { first, unvisited } = &mut colors[color as usize];
                let (own, next) = ((2 * at + place) as PairOfColor, *first);
                links[at][place].next = next;
                if next != END {
                    links[(next / 2) as usize][(next % 2) as usize].before = own;
                }
                *first = own;
                *unvisited += 1;
            }
        }
    }
}

/// Returns the two colours of a pair, or one if they are equal.
fn distinct_colors(colors: &[u32; 2]) -> &[u32] {
    if colors[0] == colors[1] { &colors[..1] } else { colors }
}
