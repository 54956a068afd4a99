use super::*;
use crate::grid::Size;

/// Checks that converting a grid to a buffer, and laying that over a blank grid, restores the grid.
#[test]
fn a_grid_survives_conversion_to_a_buffer_and_back() {
    let mut grid = Grid::new(Size::new(6, 2));
    let cell = Cell::new('a', Ink::Rgb(Srgb8::new(1, 2, 3)), Ink::Indexed(200));
    let underline = if cfg!(feature = "underline-color") { Ink::Indexed(3) } else { Ink::Default };
    grid.put(0, 0, &Cell { attributes: Attributes::BOLD, underline, ..cell.clone() }, 1);
    grid.put(1, 0, &Cell { glyph: Glyph::Char('\u{6f22}'), ..cell.clone() }, 2);
    grid.put(3, 0, &Cell { glyph: Glyph::Cluster("e\u{301}".into()), ..cell.clone() }, 1);
    grid.put(4, 1, &Cell { glyph: Glyph::Cluster("\u{1f1e9}\u{1f1ea}".into()), ..cell }, 2);
    *grid.cell_mut(5, 0) = Cell::FOREIGN;
    let buffer = Buffer::from(&grid);
    assert_eq!((buffer.area, buffer[(1, 0)].symbol()), (Rect::new(0, 0, 6, 2), "\u{6f22}"));
    let mut again = Grid::foreign(grid.size());
    lay_over(&mut again, &buffer);
    assert_eq!(again, grid);
}

#[test]
fn an_ink_survives_conversion_to_a_colour_and_back() {
    let all = [Ink::Default, Ink::Rgb(Srgb8::new(9, 8, 7))].into_iter().chain((0..=255).map(Ink::Indexed));
    for ink in all {
        assert_eq!(ink_from_ratatui(ink.into()), ink);
    }
}
