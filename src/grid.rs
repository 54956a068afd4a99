//! The cell grid: the contents of a terminal's screen, cell by cell.
//!
//! A grid is the intermediate form between picture and bytes: [`cell`](crate::cell) makes it from pixels,
//! [`overlay`](crate::overlay) lays text over it, [`encode`](crate::encode) and [`export`](crate::export) write it out.

use crate::color::Srgb8;
use crate::framebuffer::{self, ResolutionError};
use packed::Clusters;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::ops::{Deref, DerefMut, Range};
use std::slice;
use std::sync::Arc;

mod attributes;
mod packed;
#[cfg(feature = "serde")]
mod serialized;
mod window;

pub use attributes::Attributes;
pub(crate) use packed::{PackedCell, PackedInk};
pub use window::{CellShape, HalfBlocks, Size, Window};

/// A colour of a cell: the terminal's default, one of its palette, or an RGB colour.
///
/// ```
/// use termtrace::{Ink, Srgb8};
///
/// let red = Ink::Rgb(Srgb8 { r: 255, g: 0, b: 0 });
/// assert_ne!(red, Ink::Indexed(1), "the theme determines palette colours");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Ink {
    /// The terminal's default colour (SGR 39, 49 and 59).
    #[default]
    Default,
    /// One of the terminal's 256 palette colours.
    Indexed(u8),
    /// A 24-bit colour (truecolor).
    Rgb(Srgb8),
}

/// The glyph of a cell.
///
/// A glyph that is two columns wide is followed by a cell with [`Glyph::Covered`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Glyph {
    /// A character whose width, one or two cells, is the same in every terminal.
    Char(char),
    /// A grapheme cluster, on whose width terminals disagree: an accented letter, a family, a flag.
    // An `Arc`, so that cloning a grid, as is done for each frame, does not copy the text.
    Cluster(Arc<str>),
    /// No glyph: the wide glyph to the left also covers this cell.
    Covered,
    /// Contents of another program, or unknown contents.
    ///
    /// In a wanted grid (what the screen is to show) the cell is not written; in a shown grid (what the screen shows)
    /// its contents are unknown.
    Foreign,
}

impl From<char> for Glyph {
    fn from(character: char) -> Self {
        Self::Char(character)
    }
}

/// Compares with a character; a glyph of any other kind equals none.
impl PartialEq<char> for Glyph {
    fn eq(&self, character: &char) -> bool {
        matches!(self, Self::Char(own) if own == character)
    }
}

/// Writes the glyph's text: nothing for [`Glyph::Covered`], a space for [`Glyph::Foreign`].
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

/// A cell: a glyph, its colours and its attributes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    /// The glyph.
    pub glyph: Glyph,
    /// The glyph's colour.
    pub fg: Ink,
    /// The colour of the background.
    pub bg: Ink,
    /// The colour of the underline, if the cell is underlined; the default is the glyph's colour.
    pub underline: Ink,
    /// The text attributes (bold, underlined and so on); none in a picture.
    #[doc(hidden)]
    pub attributes: Attributes,
}

impl Cell {
    /// A space in the terminal's default colours.
    #[doc(hidden)]
    pub const BLANK: Self = Self::new(' ', Ink::Default, Ink::Default);

    /// A cell that is not written in a wanted grid, and has unknown contents in a shown grid.
    #[cfg(any(feature = "backend", all(test, unit_tests)))]
    pub(crate) const FOREIGN: Self = Self::with_glyph(Glyph::Foreign, Ink::Default, Ink::Default);

    /// Returns a cell with a character in these colours, without attributes.
    ///
    /// ```
    /// use termtrace::{Cell, Ink, Srgb8};
    ///
    /// let cell = Cell::new('▄', Ink::Rgb(Srgb8::new(255, 0, 0)), Ink::Default);
    /// assert_eq!(cell.glyph, '▄');
    /// ```
    pub const fn new(character: char, fg: Ink, bg: Ink) -> Self {
        Self::with_glyph(Glyph::Char(character), fg, bg)
    }

    const fn with_glyph(glyph: Glyph, fg: Ink, bg: Ink) -> Self {
        Self { glyph, fg, bg, underline: Ink::Default, attributes: Attributes::empty() }
    }
}

/// A rectangle of cells, stored row by row from the top.
// A cell takes 16 bytes: its cluster, if it has one, is an index into the grid's own list. Cells are therefore read and
// set through the grid.
#[derive(Debug)]
pub struct Grid {
    size: Size,
    // One vector for all rows, because frames are compared, cloned and cleared as a whole.
    cells: Vec<PackedCell>,
    clusters: Clusters,
}

impl Clone for Grid {
    fn clone(&self) -> Self {
        Self { size: self.size, cells: self.cells.clone(), clusters: self.clusters.clone() }
    }

    // Copies into the memory of the grid's own cells instead of allocating.
    fn clone_from(&mut self, other: &Self) {
        self.size = other.size;
        self.cells.clone_from(&other.cells);
        self.clusters.clone_from(&other.clusters);
    }
}

impl PartialEq for Grid {
    fn eq(&self, other: &Self) -> bool {
        self.size == other.size
            // Two grids may number the same clusters differently, so that their texts have to be compared.
            && if self.clusters.is_empty() && other.clusters.is_empty() {
                self.cells == other.cells
            } else {
                self.cells().eq(other.cells())
            }
    }
}

impl Eq for Grid {}

impl Hash for Grid {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.size.hash(state);
        self.cells().for_each(|cell| cell.hash(state));
    }
}

/// Cells of a grid, row by row.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct Cells<'a> {
    cells: slice::Iter<'a, PackedCell>,
    clusters: &'a Clusters,
}

impl Iterator for Cells<'_> {
    type Item = Cell;

    #[inline]
    fn next(&mut self) -> Option<Cell> {
        self.cells.next().map(|&cell| self.clusters.unpack(cell))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.cells.size_hint()
    }

    fn nth(&mut self, at: usize) -> Option<Cell> {
        self.cells.nth(at).map(|&cell| self.clusters.unpack(cell))
    }
}

impl DoubleEndedIterator for Cells<'_> {
    fn next_back(&mut self) -> Option<Cell> {
        self.cells.next_back().map(|&cell| self.clusters.unpack(cell))
    }
}

impl ExactSizeIterator for Cells<'_> {}

/// A copy of a cell that is written back to its grid when it is dropped.
struct CellMut<'a> {
    grid: &'a mut Grid,
    at: usize,
    cell: Cell,
}

impl Deref for CellMut<'_> {
    type Target = Cell;

    fn deref(&self) -> &Cell {
        &self.cell
    }
}

impl DerefMut for CellMut<'_> {
    fn deref_mut(&mut self) -> &mut Cell {
        &mut self.cell
    }
}

impl Drop for CellMut<'_> {
    fn drop(&mut self) {
        self.grid.set_at(self.at, &self.cell);
    }
}

/// A blank grid of a size that is checked before memory is allocated.
///
/// ```
/// use termtrace::{Grid, Size};
///
/// let error = Grid::try_from(Size::new(65_535, 65_535)).unwrap_err();
/// assert_eq!(error.to_string(), "a grid of 65535x65535 cells is too large; at most 16777216 cells in all");
/// ```
impl TryFrom<Size> for Grid {
    type Error = ResolutionError;

    fn try_from(size: Size) -> Result<Self, ResolutionError> {
        Ok(Self::of(PackedCell::BLANK, size, size.checked_cell_count()?))
    }
}

impl Grid {
    /// Largest number of cells of a grid: 16,777,216, which take 268 MB.
    #[doc(hidden)]
    pub const MAX_CELLS: usize = framebuffer::MAX_CELLS;

    /// Returns a grid of this size, full of blanks.
    ///
    /// ```
    /// use termtrace::{Grid, Size};
    ///
    /// assert_eq!(Grid::new(Size::new(80, 24)).size(), Size::new(80, 24));
    /// ```
    ///
    /// # Panics
    /// If it has more than 16,777,216 cells. For a size that was not checked, use `Grid::try_from(size)`.
    pub fn new(size: Size) -> Self {
        Self::of(PackedCell::BLANK, size, Self::checked_cell_count(size))
    }

    fn of(cell: PackedCell, size: Size, cell_count: usize) -> Self {
        Self { size, cells: vec![cell; cell_count], clusters: Clusters::default() }
    }

    /// Sets the size and makes all cells blank.
    ///
    /// # Panics
    /// If it has more than 16,777,216 cells.
    #[doc(hidden)]
    pub fn clear(&mut self, size: Size) {
        // The memory of the cells is reused: with new grids for each frame, a key press caused 571 page faults instead
        // of 210.
        let count = Self::checked_cell_count(size);
        self.size = size;
        self.clusters.clear();
        self.cells.clear();
        self.cells.resize(count, PackedCell::BLANK);
    }

    /// Returns a grid in which each cell has [`Glyph::Foreign`].
    ///
    /// As the shown grid it represents a screen of unknown contents; as the wanted grid it changes no cell.
    ///
    /// # Panics
    /// If it has more than 16,777,216 cells.
    #[doc(hidden)]
    pub fn foreign(size: Size) -> Self {
        Self::of(PackedCell::FOREIGN, size, Self::checked_cell_count(size))
    }

    /// Returns the number of cells, if it is within the limit.
    // Panics instead of returning an error, because sizes of terminals are checked where they are read.
    fn checked_cell_count(size: Size) -> usize {
        size.checked_cell_count().unwrap_or_else(|error| panic!("{error}"))
    }

    /// Returns the size in cells.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Returns all cells, row by row from the top.
    #[doc(hidden)]
    pub fn cells(&self) -> Cells<'_> {
        self.view(&self.cells)
    }

    fn view<'a>(&'a self, cells: &'a [PackedCell]) -> Cells<'a> {
        Cells { cells: cells.iter(), clusters: &self.clusters }
    }

    /// Returns all cells as they are stored.
    pub(crate) fn packed(&self) -> &[PackedCell] {
        &self.cells
    }

    /// Returns the text of a cell of this grid whose glyph is a cluster.
    pub(crate) fn cluster(&self, cell: PackedCell) -> Option<&str> {
        self.clusters.text(cell).map(|text| &**text)
    }

    /// Returns whether a cell of this grid is equal to a cell of another.
    #[inline]
    pub(crate) fn is_same(&self, own: PackedCell, other: &Self, of_other: PackedCell) -> bool {
        if own.is_cluster() && of_other.is_cluster() {
            return self.clusters.unpack(own) == other.clusters.unpack(of_other);
        }
        own == of_other
    }

    /// Sets the cell at an index to a cell of another grid.
    #[inline]
    pub(crate) fn copy_cell(&mut self, at: usize, other: &Self, cell: PackedCell) {
        if cell.is_cluster() {
            self.set_at(at, &other.clusters.unpack(cell));
        } else {
            self.cells[at] = cell;
        }
    }

    /// Sets the cell at an index to one whose glyph is no cluster.
    #[inline]
    pub(crate) fn set_packed(&mut self, at: usize, cell: PackedCell) {
        debug_assert!(!cell.is_cluster(), "a cluster belongs to its grid");
        self.cells[at] = cell;
    }

    /// Copies a range of cells to another place, from the index `to` on.
    pub(crate) fn copy_within(&mut self, cells: Range<usize>, to: usize) {
        self.cells.copy_within(cells, to);
    }

    /// Returns the cell at an index, counted row by row from the top.
    ///
    /// # Panics
    /// If there are fewer cells.
    #[doc(hidden)]
    pub fn at(&self, index: usize) -> Cell {
        self.clusters.unpack(self.cells[index])
    }

    /// Sets the cell at an index, counted row by row from the top.
    ///
    /// # Panics
    /// If there are fewer cells.
    #[doc(hidden)]
    #[inline]
    pub fn set_at(&mut self, index: usize, cell: &Cell) {
        self.cells[index] = self.clusters.pack(cell);
        if self.clusters.is_crowded(self.cells.len()) {
            self.clusters.drop_unused(&mut self.cells);
        }
    }

    /// Sets all cells.
    #[doc(hidden)]
    pub fn fill(&mut self, cell: &Cell) {
        self.clusters.clear();
        let cell = self.clusters.pack(cell);
        self.cells.fill(cell);
    }

    /// Returns the rows from the top, each with its cells.
    ///
    /// ```
    /// use termtrace::{Grid, Size};
    ///
    /// assert!(Grid::new(Size::new(80, 24)).rows().all(|row| row.len() == 80));
    /// ```
    pub fn rows(&self) -> impl Iterator<Item = impl ExactSizeIterator<Item = Cell>> {
        self.packed_rows().map(|row| self.view(row))
    }

    /// Returns the rows as they are stored.
    pub(crate) fn packed_rows(&self) -> slice::ChunksExact<'_, PackedCell> {
        // At least 1, because `chunks_exact` panics for 0, the width of a grid without columns.
        self.cells.chunks_exact(usize::from(self.size.columns).max(1))
    }

    /// Returns the cells of a row from a column to the row's end.
    ///
    /// # Panics
    /// If the cell is outside the grid.
    #[doc(hidden)]
    pub fn row_from(&self, column: u16, row: u16) -> Cells<'_> {
        self.view(self.packed_row_from(column, row))
    }

    /// Returns the cells of a row from a column to the row's end, as they are stored.
    pub(crate) fn packed_row_from(&self, column: u16, row: u16) -> &[PackedCell] {
        let left = usize::from(self.size.columns - column);
        &self.cells[self.index(column, row)..][..left]
    }

    /// Returns the cell in this column and row, from 0 at the top left; `None` outside the grid.
    ///
    /// ```
    /// use termtrace::{Grid, Size};
    ///
    /// let grid = Grid::new(Size::new(80, 24));
    /// assert!(grid.get(79, 23).is_some_and(|cell| cell.glyph == ' '));
    /// assert!(grid.get(80, 0).is_none());
    /// ```
    pub fn get(&self, column: u16, row: u16) -> Option<Cell> {
        let is_inside = column < self.size.columns && row < self.size.rows;
        is_inside.then(|| self.cell(column, row))
    }

    /// Returns the cell in this column and row mutably; `None` outside the grid.
    ///
    /// The grid has the changed cell once the returned value is dropped.
    ///
    /// ```
    /// use termtrace::{Cell, Grid, Ink, Size};
    ///
    /// let mut grid = Grid::new(Size::new(80, 24));
    /// *grid.get_mut(79, 23).ok_or("the cell is inside the grid")? = Cell::new('x', Ink::Default, Ink::Indexed(4));
    /// assert!(grid.get(79, 23).is_some_and(|cell| cell.glyph == 'x'));
    /// # Ok::<(), &str>(())
    /// ```
    pub fn get_mut(&mut self, column: u16, row: u16) -> Option<impl DerefMut<Target = Cell>> {
        let is_inside = column < self.size.columns && row < self.size.rows;
        is_inside.then(|| self.cell_mut(column, row))
    }

    /// Returns the cell in this column and row, counted from 0 at the top left.
    ///
    /// # Panics
    /// If the cell is outside the grid.
    #[doc(hidden)]
    pub fn cell(&self, column: u16, row: u16) -> Cell {
        self.at(self.index(column, row))
    }

    /// Returns the cell in this column and row as it is stored.
    #[inline]
    pub(crate) fn packed_cell(&self, column: u16, row: u16) -> PackedCell {
        self.cells[self.index(column, row)]
    }

    /// Returns the cell in this column and row mutably.
    ///
    /// # Panics
    /// If the cell is outside the grid.
    #[doc(hidden)]
    pub fn cell_mut(&mut self, column: u16, row: u16) -> impl DerefMut<Target = Cell> {
        let at = self.index(column, row);
        CellMut { cell: self.at(at), at, grid: self }
    }

    /// Sets the cell in this column and row.
    ///
    /// # Panics
    /// If the cell is outside the grid.
    #[inline]
    pub(crate) fn set(&mut self, column: u16, row: u16, cell: &Cell) {
        let at = self.index(column, row);
        self.set_at(at, cell);
    }

    /// Writes a cell whose glyph is `columns` wide, and marks the cells that it covers.
    ///
    /// A wide glyph that is partly overwritten becomes blanks.
    ///
    /// # Panics
    /// If the cells are outside the grid.
    #[doc(hidden)]
    pub fn put(&mut self, column: u16, row: u16, cell: &Cell, columns: u16) {
        let end = column.saturating_add(columns.max(1));
        // As in terminals, a wide glyph at either end that is partly overwritten is replaced by blanks.
        self.split_wide_glyph(column, row);
        self.split_wide_glyph(end, row);
        for covered in column + 1..end {
            // A covered cell repeats the colours and attributes of the glyph, so that comparing it detects their
            // change.
            self.set(covered, row, &Cell { glyph: Glyph::Covered, ..*cell });
        }
        self.set(column, row, cell);
    }

    /// If a wide glyph extends from the left into this column, replaces it by blanks in its
    /// colours.
    fn split_wide_glyph(&mut self, column: u16, row: u16) {
        if column >= self.size.columns || !self.packed_cell(column, row).is_covered() {
            return;
        }
        // A glyph may cover any number of columns, so its first and last column are searched.
        let is_covered = |grid: &Self, column| grid.packed_cell(column, row).is_covered();
        let start = (0..column).rev().find(|&column| !is_covered(self, column)).unwrap_or(0);
        let end = (column..self.size.columns).find(|&column| !is_covered(self, column)).unwrap_or(self.size.columns);
        for column in start..end {
            let at = self.index(column, row);
            self.cells[at] = self.cells[at].blanked();
        }
    }

    /// Moves the contents of rows `region` up by `line_count` rows; blank rows follow at the
    /// bottom.
    ///
    /// Rows outside the grid are ignored.
    #[cfg(feature = "backend")]
    pub(crate) fn scroll_up(&mut self, region: Range<u16>, line_count: u16) {
        let (cells, shift) = self.region_and_shift(region, line_count);
        cells.rotate_left(shift);
        let kept = cells.len() - shift;
        cells[kept..].fill(PackedCell::BLANK);
    }

    /// Moves the contents of rows `region` down by `line_count` rows; blank rows are put on top.
    ///
    /// Rows outside the grid are ignored.
    #[cfg(feature = "scrolling-regions")]
    pub(crate) fn scroll_down(&mut self, region: Range<u16>, line_count: u16) {
        let (cells, shift) = self.region_and_shift(region, line_count);
        cells.rotate_right(shift);
        cells[..shift].fill(PackedCell::BLANK);
    }

    /// Returns the cells of the rows `region`, and the number of cells in `line_count` rows of
    /// them.
    #[cfg(feature = "backend")]
    fn region_and_shift(&mut self, region: Range<u16>, line_count: u16) -> (&mut [PackedCell], usize) {
        let end = region.end.min(self.size.rows);
        let start = region.start.min(end);
        let cells_of = |rows: u16| Size { rows, ..self.size }.cell_count();
        let (cells, shift) = (cells_of(start)..cells_of(end), cells_of(line_count.min(end - start)));
        (&mut self.cells[cells], shift)
    }

    fn index(&self, column: u16, row: u16) -> usize {
        let Size { columns, rows } = self.size;
        assert!(column < columns && row < rows, "cell ({column}, {row}) is outside the grid");
        usize::from(row) * usize::from(columns) + usize::from(column)
    }
}
