//! Grid -> bytes: what to write so that a terminal that shows one grid shows another.
//!
//! Only cells that changed are sent, only the colour that differs, and the pen (the colours the terminal would write
//! with now) is kept from frame to frame. The escape sequences used are the safe core that every terminal and
//! multiplexer understands: CUP, SGR with `38;2`/`48;2`, and nothing that repeats, erases or scrolls.

use crate::grid::{Cell, Grid, Ink, Size};
use ratatui::style::Modifier;
use std::io::Write;

/// Turns wanted grids into bytes, and remembers what the terminal shows.
#[derive(Clone, Debug, Default)]
pub struct Encoder {
    /// What the terminal shows; nothing is known at first and after a resize.
    shown: Option<Grid>,
    pen: Pen,
}

impl Encoder {
    /// For a terminal of which nothing is known.
    pub fn new() -> Self {
        Self::default()
    }

    /// From here on nothing is known of the screen: the next frame is drawn whole.
    pub fn forget(&mut self) {
        *self = Self::new();
    }

    /// Appends the bytes that make the terminal show `wanted`; none if it does already.
    pub fn encode(&mut self, wanted: &Grid, bytes: &mut Vec<u8>) {
        let shown = self.shown.take().filter(|shown| shown.size() == wanted.size());
        if shown.is_none() {
            // Whatever the pen was, it is known from here on.
            self.pen.reset(bytes);
        }
        let Size { columns, rows } = wanted.size();
        for row in 0..rows {
            let mut cursor = None;
            for column in changed_columns(shown.as_ref(), wanted, row) {
                if cursor != Some(column) {
                    move_to(column, row, bytes);
                }
                self.pen.write_cell(wanted.cell(column, row), bytes);
                cursor = Some(column + width(wanted, column, row)).filter(|&next| next < columns);
            }
        }
        self.shown = Some(wanted.clone());
    }
}

/// The columns of a row that are to be written, in order. The second half of a wide character is never one.
fn changed_columns<'a>(shown: Option<&'a Grid>, wanted: &'a Grid, row: u16) -> impl Iterator<Item = u16> + 'a {
    (0..wanted.size().columns).filter(move |&column| {
        let covered = wanted.cell(column, row).glyph == Cell::COVERED;
        !covered && shown.is_none_or(|shown| differs(shown, wanted, column, row))
    })
}

/// Whether a character is to be written again: it, or the half of it that another one stood in, has changed.
fn differs(shown: &Grid, wanted: &Grid, column: u16, row: u16) -> bool {
    (column..column + width(wanted, column, row)).any(|c| shown.cell(c, row) != wanted.cell(c, row))
}

/// How many columns the character takes.
fn width(grid: &Grid, column: u16, row: u16) -> u16 {
    let covers_next = column + 1 < grid.size().columns && grid.cell(column + 1, row).glyph == Cell::COVERED;
    if covers_next { 2 } else { 1 }
}

/// CUP: rows and columns are counted from 1.
fn move_to(column: u16, row: u16, bytes: &mut Vec<u8>) {
    sequence(bytes, format_args!("\x1b[{};{}H", u32::from(row) + 1, u32::from(column) + 1));
}

/// The colours and modifiers that the terminal would write with now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pen {
    fg: Ink,
    bg: Ink,
    modifier: Modifier,
}

impl Pen {
    /// Back to the terminal's own colours, said even if they hold already.
    pub(crate) fn reset(&mut self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(b"\x1b[0m");
        *self = Self::default();
    }

    /// The cell's character in its colours; only what differs from the pen is said.
    pub(crate) fn write_cell(&mut self, cell: &Cell, bytes: &mut Vec<u8>) {
        self.take_up(cell, bytes);
        let mut utf8 = [0; 4];
        bytes.extend_from_slice(cell.glyph.encode_utf8(&mut utf8).as_bytes());
    }

    fn take_up(&mut self, cell: &Cell, bytes: &mut Vec<u8>) {
        if self.modifier != cell.modifier {
            // Terminals disagree on how to switch single ones off; all off is understood everywhere.
            self.reset(bytes);
            write_modifiers(cell.modifier, bytes);
            self.modifier = cell.modifier;
        }
        if self.bg != cell.bg {
            write_ink(cell.bg, 40, bytes);
            self.bg = cell.bg;
        }
        // The colour of a space is not seen, unless it is underlined, crossed out or reversed.
        let is_seen = cell.glyph != ' ' || !cell.modifier.is_empty();
        if is_seen && self.fg != cell.fg {
            write_ink(cell.fg, 30, bytes);
            self.fg = cell.fg;
        }
    }
}

/// SGR of one colour; `base` is 30 for the character's, 40 for the one behind it.
fn write_ink(ink: Ink, base: u8, bytes: &mut Vec<u8>) {
    match ink {
        Ink::Default => sequence(bytes, format_args!("\x1b[{}m", base + 9)),
        Ink::Indexed(index) => sequence(bytes, format_args!("\x1b[{};5;{index}m", base + 8)),
        Ink::Rgb(c) => sequence(bytes, format_args!("\x1b[{};2;{};{};{}m", base + 8, c.r, c.g, c.b)),
    }
}

/// SGR of each modifier that is on, after a reset.
fn write_modifiers(modifier: Modifier, bytes: &mut Vec<u8>) {
    const CODES: [(Modifier, u8); 9] = [
        (Modifier::BOLD, 1),
        (Modifier::DIM, 2),
        (Modifier::ITALIC, 3),
        (Modifier::UNDERLINED, 4),
        (Modifier::SLOW_BLINK, 5),
        (Modifier::RAPID_BLINK, 6),
        (Modifier::REVERSED, 7),
        (Modifier::HIDDEN, 8),
        (Modifier::CROSSED_OUT, 9),
    ];
    for (_, code) in CODES.iter().filter(|(flag, _)| modifier.contains(*flag)) {
        sequence(bytes, format_args!("\x1b[{code}m"));
    }
}

fn sequence(bytes: &mut Vec<u8>, sequence: std::fmt::Arguments<'_>) {
    bytes.write_fmt(sequence).expect("writing to memory does not fail");
}
