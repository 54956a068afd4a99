//! Conversion between grids and ratatui's buffers.
//!
//! Buffers with panels are laid over the grid of a picture, and a grid can be converted to a buffer.

use crate::color::Srgb8;
use crate::grid::{Attributes, Cell, Glyph, Grid, Ink};
use ratatui_core::buffer::{Buffer, CellDiffOption, CellWidth};
use ratatui_core::layout::{Position, Rect};
use ratatui_core::style::{Color, Modifier};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// Copies a buffer's cells over those of a grid, where their areas overlap.
///
/// ```
/// use ratatui::{buffer::Buffer, layout::Rect, widgets::Widget};
/// use termtrace::{Grid, Size, lay_over};
///
/// let mut buffer = Buffer::empty(Rect::new(2, 0, 4, 1));
/// "text".render(buffer.area, &mut buffer);
/// let mut grid = Grid::new(Size::new(80, 24));
/// lay_over(&mut grid, &buffer);
/// assert!(grid.get(2, 0).is_some_and(|cell| cell.glyph == 't'));
/// ```
pub fn lay_over(grid: &mut Grid, buffer: &Buffer) {
    let area = buffer.area.intersection(Rect::new(0, 0, grid.size().columns, grid.size().rows));
    if area.is_empty() {
        return;
    }
    for row in area.rows() {
        let mut column = row.left();
        while column < row.right() {
            column += put_cell(grid, Position::new(column, row.y), &buffer[(column, row.y)], row.right() - column);
        }
    }
}

/// Writes a ratatui cell into the grid, in at most `room` columns. Returns its width in columns.
// A skipped cell leaves the grid unchanged: ratatui programs skip cells that an image of the terminal covers.
pub(crate) fn put_cell(grid: &mut Grid, place: Position, cell: &ratatui_core::buffer::Cell, room: u16) -> u16 {
    if is_skipped(cell) {
        return 1;
    }
    let (glyph, columns) = glyph_from_ratatui(cell);
    // A wide glyph that does not fit into `room` is replaced by a blank.
    let (glyph, columns) = if columns <= room { (glyph, columns) } else { (Glyph::Char(' '), 1) };
    let cell = Cell {
        glyph,
        fg: ink_from_ratatui(cell.fg),
        bg: ink_from_ratatui(cell.bg),
        underline: underline(cell),
        attributes: attributes_from_ratatui(cell.modifier),
    };
    grid.put(place.x, place.y, &cell, columns);
    columns
}

/// Returns whether a ratatui cell is marked as one to skip.
#[expect(deprecated, reason = "programs still set the older one of the two ways to say it")]
fn is_skipped(cell: &ratatui_core::buffer::Cell) -> bool {
    match cell.diff_option {
        CellDiffOption::Skip => true,
        CellDiffOption::None => cell.skip,
        CellDiffOption::AlwaysUpdate | CellDiffOption::ForcedWidth(_) => false,
    }
}

/// Returns the glyph of a ratatui cell, and its width in columns by ratatui's measure.
// Control characters, whose effects the encoder does not track, and glyphs without width, which would be shown in
// another cell, become blanks.
fn glyph_from_ratatui(cell: &ratatui_core::buffer::Cell) -> (Glyph, u16) {
    let symbol = cell.symbol();
    if symbol.contains(char::is_control) || symbol.width() == 0 {
        return (Glyph::Char(' '), 1);
    }
    let columns = cell.cell_width();
    let mut characters = symbol.chars();
    let glyph = match (characters.next(), characters.next()) {
        // The common case, without an allocation: one character, whose width is the same for ratatui and
        // `unicode-width`.
        (Some(c), None) if c.width() == Some(columns.into()) && !is_regional_indicator(c) => Glyph::Char(c),
        _ => Glyph::Cluster(symbol.into()),
    };
    (glyph, columns)
}

/// Returns whether a character is a regional indicator, two of which form a flag.
// Terminals disagree on the width of a single regional indicator, so it is stored as a cluster.
fn is_regional_indicator(character: char) -> bool {
    matches!(character, '\u{1f1e6}'..='\u{1f1ff}')
}

/// Returns the colour of a ratatui cell's underline.
#[cfg(feature = "underline-color")]
fn underline(cell: &ratatui_core::buffer::Cell) -> Ink {
    ink_from_ratatui(cell.underline_color)
}

#[cfg(not(feature = "underline-color"))]
fn underline(_: &ratatui_core::buffer::Cell) -> Ink {
    Ink::Default
}

/// ratatui's modifiers, each with the grid attribute of the same meaning.
const ATTRIBUTES: [(Modifier, Attributes); 9] = [
    (Modifier::BOLD, Attributes::BOLD),
    (Modifier::DIM, Attributes::DIM),
    (Modifier::ITALIC, Attributes::ITALIC),
    (Modifier::UNDERLINED, Attributes::UNDERLINED),
    (Modifier::SLOW_BLINK, Attributes::SLOW_BLINK),
    (Modifier::RAPID_BLINK, Attributes::RAPID_BLINK),
    (Modifier::REVERSED, Attributes::REVERSED),
    (Modifier::HIDDEN, Attributes::HIDDEN),
    (Modifier::CROSSED_OUT, Attributes::CROSSED_OUT),
];

fn attributes_from_ratatui(modifier: Modifier) -> Attributes {
    // Most cells have no modifiers, and the nine tests below take time.
    if modifier.is_empty() {
        return Attributes::empty();
    }
    let those = ATTRIBUTES.into_iter().filter(|&(of_ratatui, _)| modifier.contains(of_ratatui));
    those.map(|(_, one)| one).collect()
}

/// Converts a ratatui colour to an ink.
// ratatui's 16 named colours are the first 16 palette colours, in the order of their SGR codes.
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

/// Returns a buffer with the grid's cells. A cell with [`Glyph::Foreign`] becomes a skipped cell.
///
/// ```
/// use ratatui::buffer::Buffer;
/// use termtrace::{CellMode, Scene, Size, frame_grid};
///
/// let scene = Scene::load("scenes/three_spheres.ron".as_ref())?;
/// let buffer = Buffer::from(&frame_grid(&scene, CellMode::HALF_BLOCK, Size::new(80, 24), 2.0));
/// assert_eq!((buffer.area.width, buffer.area.height), (80, 24));
/// # Ok::<(), termtrace::LoadError>(())
/// ```
impl From<&Grid> for Buffer {
    fn from(grid: &Grid) -> Self {
        let content = grid.cells().map(|cell| ratatui_from_cell(&cell)).collect();
        Self { area: Rect::new(0, 0, grid.size().columns, grid.size().rows), content }
    }
}

fn ratatui_from_cell(cell: &Cell) -> ratatui_core::buffer::Cell {
    let mut to = ratatui_core::buffer::Cell::EMPTY;
    match &cell.glyph {
        Glyph::Char(' ') => {}
        Glyph::Char(character) => {
            to.set_char(*character);
        }
        Glyph::Cluster(text) => {
            to.set_symbol(text);
        }
        // This cell is covered by the wide character before it. ratatui keeps such cells empty and without colours.
        Glyph::Covered => return to,
        Glyph::Foreign => {
            to.set_diff_option(CellDiffOption::Skip);
        }
    }
    (to.fg, to.bg) = (cell.fg.into(), cell.bg.into());
    set_underline(&mut to, cell.underline);
    to.modifier = modifier_from_attributes(cell.attributes);
    to
}

/// Sets the colour of a ratatui cell's underline.
#[cfg(feature = "underline-color")]
fn set_underline(cell: &mut ratatui_core::buffer::Cell, underline: Ink) {
    cell.underline_color = underline.into();
}

#[cfg(not(feature = "underline-color"))]
fn set_underline(_: &mut ratatui_core::buffer::Cell, _: Ink) {}

fn modifier_from_attributes(attributes: Attributes) -> Modifier {
    if attributes.is_empty() {
        return Modifier::empty();
    }
    let those = ATTRIBUTES.into_iter().filter(|&(_, of_grid)| attributes.contains(of_grid));
    those.map(|(one, _)| one).collect()
}

/// Converts an ink to a ratatui colour; the default ink becomes [`Color::Reset`].
impl From<Ink> for Color {
    fn from(ink: Ink) -> Self {
        match ink {
            Ink::Default => Self::Reset,
            Ink::Indexed(index) => Self::Indexed(index),
            Ink::Rgb(Srgb8 { r, g, b }) => Self::Rgb(r, g, b),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
