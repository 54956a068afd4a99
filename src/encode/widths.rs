//! How many columns of the screen a cell takes.

use crate::grid::{Cell, Glyph, Grid};
use unicode_width::UnicodeWidthChar;

/// How many columns the first of these cells takes: its own, and those that it covers.
pub(super) fn leading_width(cells: &[Cell]) -> usize {
    1 + cells.iter().skip(1).take_while(|cell| cell.glyph == Glyph::Covered).count()
}

/// How many columns a cluster takes at most: each of its characters on its own, and no mark without a column.
pub(super) fn max_cluster_width(text: &str) -> usize {
    text.chars().map(|c| c.width().unwrap_or(0).max(1)).sum()
}

/// How many columns are written with the one at that place.
pub(super) fn width_at(grid: &Grid, column: u16, row: u16) -> u16 {
    leading_width(grid.row_from(column, row)) as u16
}
