//! The cell grid: what a terminal's screen is to show, cell by cell.
//!
//! It stands between the picture and the bytes: [`cell`](crate::cell) makes it from pixels, [`overlay`](crate::overlay)
//! lays text over it, [`encode`](crate::encode) and [`export`](crate::export) write it out.

use crate::color::Srgb8;
use ratatui::style::Modifier;

/// A screen's size in cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Cells in a row.
    pub columns: u16,
    /// Rows of cells.
    pub rows: u16,
}

impl Size {
    /// That many columns and rows.
    pub const fn new(columns: u16, rows: u16) -> Self {
        Self { columns, rows }
    }

    /// How many cells there are.
    pub const fn cell_count(self) -> usize {
        self.columns as usize * self.rows as usize
    }
}

/// A colour that a cell can have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Ink {
    /// Whatever the terminal uses when nothing is said.
    #[default]
    Default,
    /// One of the terminal's 256.
    Indexed(u8),
    /// Truecolor.
    Rgb(Srgb8),
}

/// One cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// The character. A wide one is followed by a cell with [`Cell::COVERED`].
    pub glyph: char,
    /// The character's colour.
    pub fg: Ink,
    /// The colour behind it.
    pub bg: Ink,
    /// Bold, underlined and so on; none in a picture.
    pub modifier: Modifier,
}

impl Cell {
    /// The glyph of the second cell of a wide character: nothing is written there.
    pub const COVERED: char = '\0';

    /// A space in the terminal's own colours.
    pub const BLANK: Self = Self::new(' ', Ink::Default, Ink::Default);

    /// A character in these colours, without modifiers.
    pub const fn new(glyph: char, fg: Ink, bg: Ink) -> Self {
        Self { glyph, fg, bg, modifier: Modifier::empty() }
    }
}

/// A screenful of cells, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    size: Size,
    cells: Vec<Cell>,
}

impl Grid {
    /// All blank.
    pub fn new(size: Size) -> Self {
        Self { size, cells: vec![Cell::BLANK; size.cell_count()] }
    }

    /// Its size.
    pub fn size(&self) -> Size {
        self.size
    }

    /// All cells, row by row from the top.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The rows from the top.
    pub fn rows(&self) -> impl Iterator<Item = &[Cell]> {
        // No columns: no rows either, and no chunks of length 0.
        self.cells.chunks_exact(usize::from(self.size.columns).max(1))
    }

    /// One cell, counted from the top left.
    ///
    /// # Panics
    /// Outside the grid.
    pub fn cell(&self, column: u16, row: u16) -> &Cell {
        &self.cells[self.index(column, row)]
    }

    /// One cell to change.
    ///
    /// # Panics
    /// Outside the grid.
    pub fn cell_mut(&mut self, column: u16, row: u16) -> &mut Cell {
        let index = self.index(column, row);
        &mut self.cells[index]
    }

    fn index(&self, column: u16, row: u16) -> usize {
        let Size { columns, rows } = self.size;
        assert!(column < columns && row < rows, "cell ({column}, {row}) is outside the grid");
        usize::from(row) * usize::from(columns) + usize::from(column)
    }
}
