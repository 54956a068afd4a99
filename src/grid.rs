//! The cell grid: what a terminal's screen is to show, cell by cell.
//!
//! It stands between the picture and the bytes: [`cell`](crate::cell) makes it from pixels, [`overlay`](crate::overlay)
//! lays text over it, [`encode`](crate::encode) and [`export`](crate::export) write it out.

use crate::color::Srgb8;
use std::fmt;
#[cfg(feature = "backend")]
use std::ops::Range;
use std::sync::Arc;

mod attributes;

pub use attributes::Attributes;

/// A screen's size in cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Size {
    /// Cells in a row.
    pub columns: u16,
    /// Rows of cells.
    pub rows: u16,
}

/// Columns and rows.
impl From<(u16, u16)> for Size {
    fn from((columns, rows): (u16, u16)) -> Self {
        Self { columns, rows }
    }
}

impl Size {
    /// That many columns and rows.
    pub const fn new(columns: u16, rows: u16) -> Self {
        Self { columns, rows }
    }

    /// How many cells there are.
    #[doc(hidden)]
    pub const fn cell_count(self) -> usize {
        self.columns as usize * self.rows as usize
    }
}

/// What the window's size in pixels tells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CellShape {
    /// A cell's height over its width, if the terminal says how large it is in pixels.
    pub aspect: Option<f32>,
    /// Whether the upper and the lower half block are known to meet in the same line.
    pub halves_meet: bool,
}

/// A terminal's window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// In cells.
    pub size: Size,
    /// The shape of a cell, as far as the window's size in pixels tells it.
    pub cell: CellShape,
    /// A cell's width and height in pixels, where they are known.
    pub cell_pixels: Option<(u16, u16)>,
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

/// What stands in a cell. Something wide is followed by [`Glyph::Covered`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Glyph {
    /// A character that takes as many cells in every terminal: one, or two.
    Char(char),
    /// A grapheme of which terminals may think otherwise: a letter with its marks, a family, a flag.
    Cluster(Arc<str>),
    /// Nothing of its own: what stands to the left takes this cell too.
    Covered,
    /// Whatever else is there: wanted, it is left alone; shown, it is unknown.
    Foreign,
}

impl From<char> for Glyph {
    fn from(character: char) -> Self {
        Self::Char(character)
    }
}

impl PartialEq<char> for Glyph {
    fn eq(&self, character: &char) -> bool {
        matches!(self, Self::Char(own) if own == character)
    }
}

/// Its text: none where it is covered, a blank where it is foreign.
impl fmt::Display for Glyph {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Char(character) => write!(f, "{character}"),
            Self::Cluster(text) => f.write_str(text),
            Self::Covered => Ok(()),
            Self::Foreign => f.write_str(" "),
        }
    }
}

/// One cell.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    /// What stands in it.
    pub glyph: Glyph,
    /// The glyph's colour.
    pub fg: Ink,
    /// The colour behind it.
    pub bg: Ink,
    /// The colour of the line below, where the cell is underlined; by default it is the glyph's.
    pub underline: Ink,
    /// Bold, underlined and so on; none in a picture.
    #[doc(hidden)]
    pub attributes: Attributes,
}

impl Cell {
    /// A space in the terminal's own colours.
    #[doc(hidden)]
    pub const BLANK: Self = Self::new(' ', Ink::Default, Ink::Default);

    /// What is not ours.
    pub(crate) const FOREIGN: Self = Self::with_glyph(Glyph::Foreign, Ink::Default, Ink::Default);

    /// A character in these colours, without attributes.
    pub const fn new(character: char, fg: Ink, bg: Ink) -> Self {
        Self::with_glyph(Glyph::Char(character), fg, bg)
    }

    const fn with_glyph(glyph: Glyph, fg: Ink, bg: Ink) -> Self {
        Self { glyph, fg, bg, underline: Ink::Default, attributes: Attributes::empty() }
    }
}

/// A screenful of cells, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Grid {
    size: Size,
    cells: Vec<Cell>,
}

impl Grid {
    /// The most cells of a grid, 16,777,216: 700 MB. A 4K screen has 100,000 cells of 8 by 10 pixels.
    #[doc(hidden)]
    pub const MAX_CELLS: usize = 1 << 24;

    /// Returns a grid of that size, all blank.
    ///
    /// # Panics
    /// If it has more than 16,777,216 cells.
    pub fn new(size: Size) -> Self {
        Self { size, cells: vec![Cell::BLANK; Self::checked_cell_count(size)] }
    }

    /// Makes all of it blank, at that size.
    ///
    /// # Panics
    /// If it has more than 16,777,216 cells.
    #[doc(hidden)]
    pub fn clear(&mut self, size: Size) {
        let count = Self::checked_cell_count(size);
        self.size = size;
        self.cells.clear();
        self.cells.resize(count, Cell::BLANK);
    }

    /// Returns a grid of that size, all foreign: of a screen of which nothing is known, or on which nothing is wanted.
    ///
    /// # Panics
    /// If it has more than 16,777,216 cells.
    #[doc(hidden)]
    pub fn foreign(size: Size) -> Self {
        Self { size, cells: vec![Cell::FOREIGN; Self::checked_cell_count(size)] }
    }

    fn checked_cell_count(size: Size) -> usize {
        let count = size.cell_count();
        assert!(count <= Self::MAX_CELLS, "a grid of {count} cells is too large; it may have {}", Self::MAX_CELLS);
        count
    }

    /// Its size.
    pub fn size(&self) -> Size {
        self.size
    }

    /// All cells, row by row from the top.
    #[doc(hidden)]
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// All cells to change.
    #[doc(hidden)]
    pub fn cells_mut(&mut self) -> &mut [Cell] {
        &mut self.cells
    }

    /// The rows from the top.
    pub fn rows(&self) -> impl Iterator<Item = &[Cell]> {
        // No columns: no rows either, and no chunks of length 0.
        self.cells.chunks_exact(usize::from(self.size.columns).max(1))
    }

    /// The rows to change.
    #[doc(hidden)]
    pub fn rows_mut(&mut self) -> impl Iterator<Item = &mut [Cell]> {
        self.cells.chunks_exact_mut(usize::from(self.size.columns).max(1))
    }

    /// A row's cells from that one on.
    ///
    /// # Panics
    /// Outside the grid.
    #[doc(hidden)]
    pub fn row_from(&self, column: u16, row: u16) -> &[Cell] {
        let left = usize::from(self.size.columns - column);
        &self.cells[self.index(column, row)..][..left]
    }

    /// Returns the cell in that column and row, counted from 0 at the top left; `None` outside the grid.
    ///
    /// ```
    /// use termtrace::{Grid, Size};
    ///
    /// let grid = Grid::new(Size::new(80, 24));
    /// assert!(grid.get(79, 23).is_some_and(|cell| cell.glyph == ' '));
    /// assert!(grid.get(80, 0).is_none());
    /// ```
    pub fn get(&self, column: u16, row: u16) -> Option<&Cell> {
        let is_inside = column < self.size.columns && row < self.size.rows;
        is_inside.then(|| self.cell(column, row))
    }

    /// Returns the cell in that column and row to change; `None` outside the grid.
    pub fn get_mut(&mut self, column: u16, row: u16) -> Option<&mut Cell> {
        let is_inside = column < self.size.columns && row < self.size.rows;
        is_inside.then(|| self.cell_mut(column, row))
    }

    /// One cell, counted from the top left.
    ///
    /// # Panics
    /// Outside the grid.
    #[doc(hidden)]
    pub fn cell(&self, column: u16, row: u16) -> &Cell {
        &self.cells[self.index(column, row)]
    }

    /// One cell to change.
    ///
    /// # Panics
    /// Outside the grid.
    #[doc(hidden)]
    pub fn cell_mut(&mut self, column: u16, row: u16) -> &mut Cell {
        let index = self.index(column, row);
        &mut self.cells[index]
    }

    /// Puts a cell there whose glyph takes so many columns. Half of something wide is nothing: what it cuts becomes
    /// blanks.
    ///
    /// # Panics
    /// Outside the grid.
    #[doc(hidden)]
    pub fn put(&mut self, column: u16, row: u16, cell: &Cell, columns: u16) {
        let end = column.saturating_add(columns.max(1));
        self.split_wide_glyph(column, row);
        self.split_wide_glyph(end, row);
        for covered in column + 1..end {
            *self.cell_mut(covered, row) = Cell { glyph: Glyph::Covered, ..cell.clone() };
        }
        self.cell_mut(column, row).clone_from(cell);
    }

    /// If something stands on both sides of that column's left edge, it becomes blanks in its colours.
    fn split_wide_glyph(&mut self, column: u16, row: u16) {
        if column >= self.size.columns || self.cell(column, row).glyph != Glyph::Covered {
            return;
        }
        let is_covered = |grid: &Self, column| grid.cell(column, row).glyph == Glyph::Covered;
        let start = (0..column).rev().find(|&column| !is_covered(self, column)).unwrap_or(0);
        let end = (column..self.size.columns).find(|&column| !is_covered(self, column)).unwrap_or(self.size.columns);
        for column in start..end {
            self.cell_mut(column, row).glyph = Glyph::Char(' ');
        }
    }

    /// Moves the content of these rows up by `by` rows; blank rows come in below it. Rows outside the grid are ignored.
    #[cfg(feature = "backend")]
    pub(crate) fn scroll_up(&mut self, region: Range<u16>, by: u16) {
        let (cells, shift) = self.region(region, by);
        cells.rotate_left(shift);
        let kept = cells.len() - shift;
        cells[kept..].fill(Cell::BLANK);
    }

    /// Moves the content of these rows down by `by` rows; blank rows come in above it. Rows outside the grid are
    /// ignored.
    #[cfg(feature = "scrolling-regions")]
    pub(crate) fn scroll_down(&mut self, region: Range<u16>, by: u16) {
        let (cells, shift) = self.region(region, by);
        cells.rotate_right(shift);
        cells[..shift].fill(Cell::BLANK);
    }

    /// Returns the cells of these rows, and how many cells `by` of the rows have.
    #[cfg(feature = "backend")]
    fn region(&mut self, region: Range<u16>, by: u16) -> (&mut [Cell], usize) {
        let end = region.end.min(self.size.rows);
        let start = region.start.min(end);
        let cells_of = |rows: u16| Size { rows, ..self.size }.cell_count();
        let (cells, shift) = (cells_of(start)..cells_of(end), cells_of(by.min(end - start)));
        (&mut self.cells[cells], shift)
    }

    fn index(&self, column: u16, row: u16) -> usize {
        let Size { columns, rows } = self.size;
        assert!(column < columns && row < rows, "cell ({column}, {row}) is outside the grid");
        usize::from(row) * usize::from(columns) + usize::from(column)
    }
}
