//! Export of a grid as plain text.

use super::difference;
use super::format_row::{FileEncoder, FormatRow};
use crate::grid::Grid;

pub(super) const KIND: FormatRow = FormatRow {
    name: "text",
    help: "Characters without colour",
    extensions: &["txt", "text"],
    key: 't',
    command: "WriteText",
    title: "plain text",
    file_encoder: FileEncoder::Cells {
        has_colors: false,
        is_on_black: false,
        write: |grid, _, _, _| text(grid).into_bytes(),
    },
    difference: difference::by_rows,
};

/// Returns the grid's characters: one line per row, with trailing spaces.
///
/// ```
/// use termtrace::{Grid, Size, export::text};
///
/// assert_eq!(text(&Grid::new(Size::new(3, 2))), "   \n   \n");
/// ```
pub fn text(grid: &Grid) -> String {
    let mut text = String::with_capacity(grid.cells().len() + usize::from(grid.size().rows));
    for row in grid.rows() {
        text.extend(row.map(|cell| cell.glyph.to_string()));
        text.push('\n');
    }
    text
}
