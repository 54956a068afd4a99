//! Grids made of cells.

use termtrace::{Cell, Grid, Size};
use unicode_width::UnicodeWidthStr;

/// Puts a glyph into a cell if it has room.
pub(crate) fn put(grid: &mut Grid, column: u16, row: u16, cell: &Cell) {
    let columns = cell.glyph.to_string().width() as u16;
    if column + columns <= grid.size().columns {
        grid.put(column, row, cell, columns);
    }
}

/// Returns a grid of these cells, row by row.
pub(crate) fn filled(size: Size, cells: &[Cell]) -> Grid {
    let mut grid = Grid::new(size);
    for (place, cell) in (0..size.cell_count()).zip(cells) {
        put_at(&mut grid, place, cell);
    }
    grid
}

/// Puts a glyph into a cell, counted row by row, if it has room.
pub(crate) fn put_at(grid: &mut Grid, place: usize, cell: &Cell) {
    let columns = usize::from(grid.size().columns);
    put(grid, (place % columns) as u16, (place / columns) as u16, cell);
}
