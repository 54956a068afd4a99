//! The order by colour: cells are visited so that the colours of one serve the next.
//!
//! A cell of the picture has a pair of colours. All cells of one pair are written in a row, with nothing but moves
//! between them. Pairs that share a colour are neighbours, and the way goes from neighbour to neighbour, so that mostly
//! one colour changes at a time: always to the one that costs least from here, those with few other neighbours first,
//! because they would be left over. Where no neighbour is left, or the next pair in reading order costs less, it goes
//! on there.

use super::moves::{Place, cheapest};
use super::pen::Pen;
use super::strokes::after;
use crate::grid::{Attributes, Cell, Glyph, Grid, Ink};
use std::ops::Range;

/// The places in the order in which they are to be written: first what is no picture, row by row.
pub(super) fn order(wanted: &Grid, changed: &[Place], upper_half: bool, pen: Pen) -> Vec<Place> {
    let is_picture = |place: &&Place| inks(wanted.cell(place.column, place.row)).is_some();
    let picture: Vec<Place> = changed.iter().filter(is_picture).copied().collect();
    let mut order: Vec<Place> = changed.iter().filter(|place| !is_picture(place)).copied().collect();
    let last = order.last().copied();
    let pen = last.map_or(pen, |place| pen.wanted_by(wanted.cell(place.column, place.row)));
    let mut tour = Tour::new(wanted, &picture, upper_half, pen);
    tour.cursor = last.and_then(|place| after(wanted, place));
    tour.walk(&mut order);
    order
}

/// The two colours of a picture's cell: of the character and behind it. A space has one, twice.
fn inks(cell: &Cell) -> Option<(Ink, Ink)> {
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
fn number(ink: Ink) -> u32 {
    match ink {
        Ink::Rgb(c) => u32::from_be_bytes([0, c.r, c.g, c.b]),
        Ink::Default | Ink::Indexed(_) => u32::MAX,
    }
}

/// All cells of one pair of colours.
struct Pair {
    fg: Ink,
    bg: Ink,
    /// The places of its cells in `Tour::places`, in reading order.
    places: Range<usize>,
    /// The numbers of its colours in `Tour::colors`: one twice if it is flat.
    colors: [usize; 2],
    visited: bool,
}

struct Tour<'a> {
    wanted: &'a Grid,
    upper_half: bool,
    pen: Pen,
    /// The numbers of its two colours in `colors`, for glyphs and behind them, if the picture has them.
    pen_colors: [Option<usize>; 2],
    cursor: Option<Place>,
    /// How many neighbours may still be looked at.
    looks: usize,
    places: Vec<Place>,
    /// In reading order of their first cells.
    pairs: Vec<Pair>,
    /// All colours, sorted by number.
    colors: Vec<Color>,
    /// The pairs of each colour.
    neighbours: Vec<usize>,
}

struct Color {
    number: u32,
    /// The pairs that have it, in `Tour::neighbours`, the first in reading order last; those visited are dropped when they
    /// are met.
    pairs: Range<usize>,
    /// How many of them are not visited.
    left: usize,
}

/// How many neighbours over one colour are looked at, at most: with all of them, a frame in which thousands of pairs share
/// a colour would take the square of that.
const NEIGHBOURS: usize = 64;

/// How many neighbours are looked at for each pair in the mean, at most: few have many, unless the picture is noise.
const LOOKS: usize = 8;

impl<'a> Tour<'a> {
    fn new(wanted: &'a Grid, picture: &[Place], upper_half: bool, pen: Pen) -> Self {
        let mut cells: Vec<(u32, u32, Place)> = picture.iter().map(|&place| keyed(wanted, place, upper_half)).collect();
        // In reading order within a pair: the sort is stable.
        cells.sort_by_key(|&(a, b, _)| u64::from(a) << 32 | u64::from(b));
        let mut numbers: Vec<u32> = cells.iter().flat_map(|&(a, b, _)| [a, b]).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let mut pairs: Vec<Pair> = Vec::new();
        let mut start = 0;
        for group in cells.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let (a, b, place) = group[0];
            let (fg, bg) = inks(wanted.cell(place.column, place.row)).unwrap_or_default();
            let colors = [a, b].map(|number| numbers.binary_search(&number).unwrap_or(0));
            pairs.push(Pair { fg, bg, places: start..start + group.len(), colors, visited: false });
            start += group.len();
        }
        pairs.sort_by_cached_key(|pair| {
            let first = cells[pair.places.start].2;
            (first.row, first.column)
        });
        let (colors, neighbours) = neighbours(&numbers, &pairs);
        let places = cells.into_iter().map(|(_, _, place)| place).collect();
        let pen_colors = [pen.fg, pen.bg].map(|ink| numbers.binary_search(&number(ink)).ok());
        Self { wanted, upper_half, pen, pen_colors, cursor: None, looks: 0, places, pairs, colors, neighbours }
    }

    /// Appends the places in the order of the tour.
    fn walk(&mut self, order: &mut Vec<Place>) {
        for next in 0..self.pairs.len() {
            while !self.pairs[next].visited {
                let pair = self.best(next);
                self.visit(pair, order);
            }
        }
    }

    /// The cheapest of the pairs that share a colour with the pen, and of `next`.
    fn best(&mut self, next: usize) -> usize {
        let mut best = (self.price(next), next);
        self.looks += LOOKS;
        for color in self.pen_colors.into_iter().flatten() {
            let mut near = Vec::new();
            while near.len() < NEIGHBOURS.min(self.looks)
                && let Some(at) = self.colors[color].pairs.next_back()
            {
                let pair = self.neighbours[at];
                if !self.pairs[pair].visited {
                    best = best.min((self.price(pair), pair));
                    near.push(pair);
                }
            }
            self.looks -= near.len();
            for pair in near.into_iter().rev() {
                let end = &mut self.colors[color].pairs.end;
                self.neighbours[*end] = pair;
                *end += 1;
            }
        }
        best.1
    }

    /// What it costs to go on with a pair, in bytes: the change of the pen, the move to its first cell, and up to eight
    /// for how well it can wait.
    fn price(&self, pair: usize) -> usize {
        let pair = &self.pairs[pair];
        let change = self.pen.cost_of(&self.pen_for(pair));
        let way = cheapest(self.cursor, self.places[pair.places.start]).len();
        let others = pair.colors.map(|color| self.colors[color].left);
        change + way + others[0].min(others[1]).min(8)
    }

    /// The cheaper of the two pens that can write the pair.
    fn pen_for(&self, pair: &Pair) -> Pen {
        let pen = |fg, bg| Pen { fg, bg, ..self.pen.before_colors(Attributes::empty()) };
        if pair.fg == pair.bg {
            return pen(self.pen.fg, pair.bg);
        }
        let (plain, turned) = (pen(pair.fg, pair.bg), pen(pair.bg, pair.fg));
        let turn = self.upper_half && self.pen.cost_of(&turned) < self.pen.cost_of(&plain);
        if turn { turned } else { plain }
    }

    fn visit(&mut self, at: usize, order: &mut Vec<Place>) {
        self.pen = self.pen_for(&self.pairs[at]);
        let pair = &mut self.pairs[at];
        pair.visited = true;
        let [a, b] = pair.colors;
        self.pen_colors = if a == b {
            [self.pen_colors[0], Some(a)]
        } else if self.colors[a].number == number(self.pen.fg) {
            [Some(a), Some(b)]
        } else {
            [Some(b), Some(a)]
        };
        for &color in distinct(&pair.colors) {
            self.colors[color].left -= 1;
        }
        let places = &self.places[pair.places.clone()];
        order.extend_from_slice(places);
        self.cursor = places.last().and_then(|last| after(self.wanted, *last));
    }
}

/// All colours, and the pairs of each.
fn neighbours(numbers: &[u32], pairs: &[Pair]) -> (Vec<Color>, Vec<usize>) {
    let mut colors: Vec<Color> = numbers.iter().map(|&number| Color { number, pairs: 0..0, left: 0 }).collect();
    for color in pairs.iter().flat_map(|pair| distinct(&pair.colors)) {
        colors[*color].left += 1;
    }
    let mut end = 0;
    for color in &mut colors {
        color.pairs = end..end;
        end += color.left;
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
fn keyed(wanted: &Grid, place: Place, upper_half: bool) -> (u32, u32, Place) {
    let (fg, bg) = inks(wanted.cell(place.column, place.row)).unwrap_or_default();
    let (a, b) = (number(fg), number(bg));
    if upper_half && b < a { (b, a, place) } else { (a, b, place) }
}
