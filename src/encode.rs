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
//! LF and SGR with `38;2`/`48;2`; nothing that repeats, erases or scrolls. A terminal in raw mode is taken for granted: a
//! line feed keeps the column.

use crate::grid::{Cell, Grid, Size};

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
        let shown = self.shown.take().filter(|shown| shown.size() == wanted.size());
        if shown.is_none() {
            // Whatever the pen was, it is known from here on.
            self.pen.reset(bytes);
        }
        let changed = changed(shown.as_ref(), wanted);
        let strokes = match self.order {
            Order::Raster => strokes::choose(wanted, &changed, self.upper_half, self.pen),
            Order::Color => {
                let order = by_color::order(wanted, &changed, self.upper_half, self.pen);
                let mut strokes = strokes::choose(wanted, &order, self.upper_half, self.pen);
                // Not row by row: a compressor finds fewer repetitions then, which costs more than this saves.
                strokes::look_ahead(&mut strokes);
                strokes
            }
        };
        strokes::write(wanted, &strokes, &mut self.pen, bytes);
        self.shown = Some(wanted.clone());
    }
}

/// The places that are to be written, row by row. The second half of a wide character is never one.
fn changed(shown: Option<&Grid>, wanted: &Grid) -> Vec<Place> {
    let Size { columns, rows } = wanted.size();
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| Place { column, row }));
    places
        .filter(|&Place { column, row }| {
            let covered = wanted.cell(column, row).glyph == Cell::COVERED;
            !covered && shown.is_none_or(|shown| differs(shown, wanted, column, row))
        })
        .collect()
}

/// Whether a character is to be written again: it, or the half of it that another one stood in, looks different.
fn differs(shown: &Grid, wanted: &Grid, column: u16, row: u16) -> bool {
    (column..column + width(wanted, column, row)).any(|column| {
        let (shown, wanted) = (shown.cell(column, row), wanted.cell(column, row));
        let same_space = pen::is_plain_space(shown) && pen::is_plain_space(wanted) && shown.bg == wanted.bg;
        shown != wanted && !same_space
    })
}

/// How many columns the character takes: two only if the grid has left it the second.
fn width(grid: &Grid, column: u16, row: u16) -> u16 {
    let covers_next = column + 1 < grid.size().columns && grid.cell(column + 1, row).glyph == Cell::COVERED;
    if covers_next && grid.cell(column, row).glyph.width() == Some(2) { 2 } else { 1 }
}
