//! Text and panels over the picture: any ratatui buffer laid over the grid.

use crate::color::Srgb8;
use crate::grid::{Cell, Grid, Ink};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use unicode_width::UnicodeWidthChar;

/// Puts the buffer's cells over the grid's, where both have them.
pub fn lay_over(grid: &mut Grid, buffer: &Buffer) {
    let area = buffer.area.intersection(Rect::new(0, 0, grid.size().columns, grid.size().rows));
    if area.is_empty() {
        return;
    }
    for row in area.rows() {
        cut_wide_characters(grid, row);
        lay_row(grid, buffer, row);
    }
}

/// Half a wide character is none: where the row will begin or end in its middle, the other half becomes a blank.
fn cut_wide_characters(grid: &mut Grid, row: Rect) {
    let is_covered = |grid: &Grid, column| grid.cell(column, row.y).glyph == Cell::COVERED;
    if row.left() > 0 && is_covered(grid, row.left()) {
        grid.cell_mut(row.left() - 1, row.y).glyph = ' ';
    }
    if row.right() < grid.size().columns && is_covered(grid, row.right()) {
        grid.cell_mut(row.right(), row.y).glyph = ' ';
    }
}

fn lay_row(grid: &mut Grid, buffer: &Buffer, row: Rect) {
    let mut column = row.left();
    while column < row.right() {
        let mut cell = cell_from_ratatui(&buffer[(column, row.y)]);
        let columns = cell.glyph.width().unwrap_or(1) as u16;
        if columns > row.right() - column {
            cell.glyph = ' '; // a wide character with half of it outside
        }
        *grid.cell_mut(column, row.y) = cell;
        for covered in column + 1..(column + columns).min(row.right()) {
            *grid.cell_mut(covered, row.y) = Cell { glyph: Cell::COVERED, ..cell };
        }
        column += columns;
    }
}

fn cell_from_ratatui(cell: &ratatui::buffer::Cell) -> Cell {
    Cell {
        // Of a character with combining marks the grid keeps the character; what takes no cell is a blank.
        glyph: cell.symbol().chars().next().filter(|c| c.width() > Some(0)).unwrap_or(' '),
        fg: ink_from_ratatui(cell.fg),
        bg: ink_from_ratatui(cell.bg),
        modifier: cell.modifier,
    }
}

/// The 16 named colours are the first of the indexed ones, in the order of SGR's codes.
fn ink_from_ratatui(color: Color) -> Ink {
    match color {
        Color::Reset => Ink::Default,
        Color::Rgb(r, g, b) => Ink::Rgb(Srgb8::new(r, g, b)),
        Color::Indexed(index) => Ink::Indexed(index),
        Color::Black => Ink::Indexed(0),
        Color::Red => Ink::Indexed(1),
        Color::Green => Ink::Indexed(2),
        Color::Yellow => Ink::Indexed(3),
        Color::Blue => Ink::Indexed(4),
        Color::Magenta => Ink::Indexed(5),
        Color::Cyan => Ink::Indexed(6),
        Color::Gray => Ink::Indexed(7),
        Color::DarkGray => Ink::Indexed(8),
        Color::LightRed => Ink::Indexed(9),
        Color::LightGreen => Ink::Indexed(10),
        Color::LightYellow => Ink::Indexed(11),
        Color::LightBlue => Ink::Indexed(12),
        Color::LightMagenta => Ink::Indexed(13),
        Color::LightCyan => Ink::Indexed(14),
        Color::White => Ink::Indexed(15),
    }
}
