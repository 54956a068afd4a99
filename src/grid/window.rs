//! The size of a terminal's window, and the shape of its cells.

use crate::framebuffer::{MAX_CELLS, ResolutionError};

/// A screen's size in cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Size {
    /// Cells in a row.
    pub columns: u16,
    /// Rows of cells.
    pub rows: u16,
}

/// Converts a pair of columns and rows, in this order.
impl From<(u16, u16)> for Size {
    fn from((columns, rows): (u16, u16)) -> Self {
        Self { columns, rows }
    }
}

impl Size {
    /// Returns a size of this many columns and rows.
    ///
    /// ```
    /// use termtrace::Size;
    ///
    /// assert_eq!(Size::new(80, 24), Size::from((80, 24)));
    /// ```
    pub const fn new(columns: u16, rows: u16) -> Self {
        Self { columns, rows }
    }

    /// Returns the number of cells.
    #[doc(hidden)]
    pub const fn cell_count(self) -> usize {
        // The product is at most 65,535 squared, which fits into 32 bits, so that it overflows on no target.
        self.columns as usize * self.rows as usize
    }

    /// Returns the number of cells, if it is within the limit [`MAX_CELLS`] of grids.
    ///
    /// # Errors
    /// [`ResolutionError::TooManyCells`], if the number is above the limit.
    pub(crate) fn checked_cell_count(self) -> Result<usize, ResolutionError> {
        let Self { columns, rows } = self;
        let count = self.cell_count();
        if count <= MAX_CELLS { Ok(count) } else { Err(ResolutionError::TooManyCells { columns, rows }) }
    }
}

/// The shape of a cell, as derived from the window's size in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CellShape {
    /// A cell's height over its width, if the terminal reports the window's size in pixels.
    pub aspect: Option<f32>,
    /// The half blocks that cells may use.
    pub half_blocks: HalfBlocks,
}

/// The half blocks (`▄`, `▀`) that cells may use to show two pixels.
///
/// ```
/// use termtrace::{Encoder, HalfBlocks};
///
/// // For a terminal that divides its cells evenly, such as kitty.
/// let encoder = Encoder::new().with_half_blocks(HalfBlocks::Either);
/// # let _ = encoder;
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum HalfBlocks {
    /// Lower half blocks only, which is right at every cell height.
    #[default]
    Lower,
    /// Either half block, whichever saves a change of colour.
    ///
    /// The terminal must divide the cell at the same line of pixels for both.
    Either,
}

impl HalfBlocks {
    /// Returns the half blocks for cells of this height in pixels: either one if the height is
    /// even.
    // Compared pixel by pixel, xterm, st, kitty, alacritty and foot divide cells of even height at the same line for
    // the upper and the lower half block. At odd heights it depends on the terminal and the glyph to which half the
    // middle row of pixels belongs, so that a mix of both blocks would be visible.
    pub(crate) fn of_cell_height(height: u16) -> Self {
        if height > 0 && height.is_multiple_of(2) { Self::Either } else { Self::Lower }
    }
}

/// The size of a terminal's window, and the shape of its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The window's size in cells.
    pub size: Size,
    /// The shape of a cell, as far as the window's size in pixels determines it.
    pub cell: CellShape,
    /// A cell's width and height in pixels, if known.
    pub cell_pixels: Option<(u16, u16)>,
    /// Whether the terminal's window is larger, and this is its upper left part.
    pub is_part: bool,
}
