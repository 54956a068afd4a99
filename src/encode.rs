//! Grid -> bytes: what to write so that a terminal that shows one grid shows another.
//!
//! Only cells that changed are sent, only the colour that differs, and the pen (the colours the terminal would write
//! with now) is kept from cell to cell and from frame to frame. What is left to choose is the order of the cells, the
//! glyph of each, and the way of the cursor from one to the next:
//!
//! - [`Order::Raster`] goes row by row. What a compressing link (`ssh -C`) sends after it is smallest, because its
//!   neighbourhoods are those of the frame before.
//! - [`Order::Color`] goes from cell to cell by the colours they share: about a fifth less on a raw link.
//!
//! The escape sequences used are the safe core that every terminal and multiplexer understands: CUP, CUF, CHA, CR, BS,
//! LF and SGR with `38;2`/`48;2`; and `58:2`, the colour of an underline, which others pass over. Nothing that repeats,
//! erases or scrolls. A terminal in raw mode is taken for granted: a line feed keeps the column.

use crate::grid::{Cell, Glyph, Grid, Size};

mod by_color;
mod moves;
mod pen;
mod strokes;

use moves::Place;
pub(crate) use pen::Pen;
use unicode_width::UnicodeWidthChar;

/// The order in which cells are sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// Row by row from the top: for links that compress.
    #[default]
    Raster,
    /// So that colours are reused: for links that do not.
    Color,
}

/// Turns wanted grids into bytes, and remembers what the terminal shows.
#[derive(Clone, Debug, Default)]
pub struct Encoder {
    order: Order,
    upper_half: bool,
    /// What the terminal shows; nothing is known at first and after a resize.
    shown: Option<Grid>,
    pen: Pen,
}

impl Encoder {
    /// For a terminal of which nothing is known: row by row, every cell with the character that it has in the grid.
    pub fn new() -> Self {
        Self::default()
    }

    /// In that order.
    pub fn with_order(self, order: Order) -> Self {
        Self { order, ..self }
    }

    /// Whether a half-block cell may be written with either half, whichever saves a change of colour: right where a cell
    /// has an even number of pixel rows. At odd heights some terminals split the two glyphs a pixel row apart, and their
    /// mix would show.
    pub fn with_upper_half(self, upper_half: bool) -> Self {
        Self { upper_half, ..self }
    }

    /// From here on nothing is known of the screen: the next frame is drawn whole.
    pub fn forget(&mut self) {
        self.shown = None;
    }

    /// Appends the bytes that make the terminal show `wanted`; none if it does already.
    pub fn encode(&mut self, wanted: &Grid, bytes: &mut Vec<u8>) {
        let mut shown = self.shown.take().filter(|shown| shown.size() == wanted.size()).unwrap_or_else(|| {
            // Whatever the pen was, it is known from here on.
            self.pen.reset(bytes);
            unknown(wanted.size())
        });
        let changed = update(&mut shown, wanted);
        let strokes = match self.order {
            Order::Raster => strokes::choose(wanted, &changed, self.upper_half, self.pen),
            Order::Color => {
                let order = by_color::order(wanted, &changed, self.upper_half, self.pen);
                let mut strokes = strokes::choose(wanted, &order, self.upper_half, self.pen);
                // Not row by row: a compressor finds fewer repetitions then, which costs more than this saves.
                strokes::look_ahead(wanted, &mut strokes);
                strokes
            }
        };
        strokes::write(wanted, &strokes, &mut self.pen, bytes);
        self.shown = Some(shown);
    }
}

/// A screen of which nothing is known: every cell is another than any that can be wanted.
fn unknown(size: Size) -> Grid {
    let mut grid = Grid::new(size);
    grid.cells_mut().fill(Cell { glyph: Glyph::Covered, ..Cell::BLANK });
    grid
}

/// Makes the grid show what is wanted; the places that are to be written for it, row by row. A covered cell is never one.
fn update(shown: &mut Grid, wanted: &Grid) -> Vec<Place> {
    let mut changed = Vec::new();
    for (row, (shown, wanted)) in (0..).zip(shown.rows_mut().zip(wanted.rows())) {
        update_row(shown, wanted, |column| changed.push(Place { column, row }));
    }
    changed
}

/// What stands behind a cluster is written again with it: a terminal that takes the cluster apart has written over it.
fn update_row(shown: &mut [Cell], wanted: &[Cell], mut write: impl FnMut(u16)) {
    let mut safe_from = 0;
    let mut column = 0;
    while column < wanted.len() {
        let end = column + columns(&wanted[column..]);
        let (shown, wanted) = (&mut shown[column..end], &wanted[column..end]);
        let differs = !shown.iter().zip(wanted).all(|(shown, wanted)| pen::look_alike(shown, wanted));
        if wanted[0].glyph != Glyph::Covered && (differs || column < safe_from) {
            shown.clone_from_slice(wanted);
            write(column as u16);
            if let Glyph::Cluster(text) = &wanted[0].glyph {
                safe_from = safe_from.max(column + columns_apart(text));
            }
        }
        column = end;
    }
}

/// How many columns the first of these cells takes: its own, and those that it covers.
fn columns(cells: &[Cell]) -> usize {
    1 + cells.iter().skip(1).take_while(|cell| cell.glyph == Glyph::Covered).count()
}

/// How many columns a cluster takes at most: each of its characters on its own, and no mark without a column.
fn columns_apart(text: &str) -> usize {
    text.chars().map(|c| c.width().unwrap_or(0).max(1)).sum()
}

/// How many columns are written with the one at that place.
fn width(grid: &Grid, column: u16, row: u16) -> u16 {
    columns(grid.row_from(column, row)) as u16
}
