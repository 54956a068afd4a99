//! Export of a grid as ANSI text: its characters with escape sequences for their colours.

use super::difference;
use super::format_row::{FileEncoder, FormatRow};
use super::text::text;
use crate::capabilities::Colors;
use crate::encode::Pen;
use crate::grid::Grid;

pub(super) const KIND: FormatRow = FormatRow {
    name: "ansi",
    help: "Cells in colour",
    extensions: &["ansi", "ans"],
    key: 'a',
    command: "WriteAnsi",
    title: "ANSI text in colour",
    file_encoder: FileEncoder::Cells {
        has_colors: true,
        is_on_black: false,
        write: |grid, colors, _, _| ansi_or_text(grid, colors),
    },
    difference: difference::by_rows,
};

/// Returns the bytes that print the grid; plain text if `colors` is [`Colors::None`].
pub fn ansi_or_text(grid: &Grid, colors: Colors) -> Vec<u8> {
    match colors {
        // No sequence at all, not even a reset, because some terminals without colours would print it.
        Colors::None => text(grid).into_bytes(),
        _ => ansi(grid),
    }
}

/// Returns the grid as lines with colour sequences, which any program may print.
///
/// The cursor is not moved, and the default colours are restored at the end of each line.
///
/// ```
/// use termtrace::{Grid, Size, export::ansi};
///
/// assert_eq!(ansi(&Grid::new(Size::new(3, 1))), b"   \x1b[0m\n");
/// ```
pub fn ansi(grid: &Grid) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut pen = Pen::default();
    for row in grid.packed_rows() {
        for &cell in row.iter().filter(|cell| !cell.is_covered()) {
            pen.write_cell(grid, cell, &mut bytes);
        }
        // Reset before the line feed, because some terminals fill the rest of the line, and new lines, with the
        // background.
        pen.reset(&mut bytes);
        bytes.push(b'\n');
    }
    bytes
}
