//! The widths of glyphs in columns.

use crate::grid::{Grid, PackedCell};
use unicode_width::UnicodeWidthChar;

/// Returns the width of the first cell in columns: one, and one for each covered cell directly
/// after it.
pub(super) fn leading_width(cells: &[PackedCell]) -> usize {
    1 + cells.iter().skip(1).take_while(|cell| cell.is_covered()).count()
}

/// Returns the largest number of columns that a grapheme cluster takes in any terminal.
///
/// It is the sum of the widths of the characters, each at least one column.
// Terminals without support for clusters show the characters one by one, some even combining marks.
pub(super) fn max_cluster_width(text: &str) -> usize {
    text.chars().map(|c| c.width().unwrap_or(0).max(1)).sum()
}

/// Returns the width of the glyph in this column and row.
pub(super) fn width_at(grid: &Grid, column: u16, row: u16) -> u16 {
    leading_width(grid.packed_row_from(column, row)) as u16
}
