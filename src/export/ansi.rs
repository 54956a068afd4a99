//! Grid -> ANSI: text with the escape sequences of its colours.

use super::difference;
use super::format_row::{Contents, FormatRow};
use super::text::text;
use crate::capabilities::Colors;
use crate::encode::Pen;
use crate::grid::{Glyph, Grid};

pub(super) const KIND: FormatRow = FormatRow {
    name: "ansi",
    help: "Cells in colour",
    extensions: &["ansi", "ans"],
    key: 'a',
    command: "WriteAnsi",
    title: "ANSI text in colour",
    contents: Contents::Cells { has_colors: true, write: |grid, colors, _| ansi_or_text(grid, colors) },
    difference: difference::by_rows,
};

/// The grid as a terminal with those colours is to be sent it: without any, no escape sequence says anything of them.
pub fn ansi_or_text(grid: &Grid, colors: Colors) -> Vec<u8> {
    match colors {
        Colors::None => text(grid).into_bytes(),
        _ => ansi(grid),
    }
}

/// The grid in colour, as lines that any program may print: no movement, and the terminal's own colours restored
/// at the end of each line.
pub fn ansi(grid: &Grid) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut pen = Pen::default();
    for row in grid.rows() {
        for cell in row.iter().filter(|cell| cell.glyph != Glyph::Covered) {
            pen.write_cell(cell, &mut bytes);
        }
        pen.reset(&mut bytes);
        bytes.push(b'\n');
    }
    bytes
}
