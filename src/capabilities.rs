//! The capabilities of a terminal as plain values, and their detection.
//!
//! Capabilities are detected from the environment, the window and the terminal's replies.

mod known_terminals;
mod replies;
mod detection;
mod findings;
mod shifts;
#[cfg(feature = "live")]
mod terminfo;

// Capabilities are expressed in the types of the stages that use them.
pub use crate::cell::{CellMode, Colors, Glyphs};
pub use crate::grid::{CellShape, HalfBlocks};
pub use detection::{Clues, Detected, GlyphChoice, Source, colors, glyphs};
pub use findings::{Findings, Hints, SafeQueries, VARIABLES};
pub use replies::{Replies, TEST_COLOR};
pub use shifts::Shifts;
#[cfg(feature = "live")]
pub use terminfo::terminfo_colors;

use std::ops::RangeInclusive;

/// The capabilities of a terminal that affect how a picture is drawn in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capabilities {
    /// The glyph kind and the colours in which pixels are drawn.
    pub cell_mode: CellMode,
    /// The finer glyphs for a picture at rest, if the terminal is known to show them well.
    pub resting_glyphs: Option<Glyphs>,
    /// The cell aspect: a cell's height divided by its width, greater than 0.
    pub cell_aspect: f32,
    /// The half blocks that cells may use.
    pub half_blocks: HalfBlocks,
    /// Whether the terminal's default colours are dark text on a light background.
    pub light_background: bool,
    /// Whether the terminal supports synchronized output (DEC private mode 2026).
    pub synchronized_output: bool,
    /// Whether and how the terminal shifts shown cells.
    pub shifts: Shifts,
}

impl Capabilities {
    /// Returns the capabilities without shifts of shown cells.
    #[cfg(feature = "live")]
    pub(crate) fn without_shifts(self) -> Self {
        Self { shifts: Shifts::Off, ..self }
    }

    /// Returns the capabilities that the frames of an audience use.
    ///
    /// They have neither shifts nor finer glyphs at rest, so that viewers with and without them share frames.
    #[cfg(feature = "serve")]
    pub(crate) fn for_audience(self) -> Self {
        Self { resting_glyphs: None, ..self.without_shifts() }
    }

    /// Returns the capabilities for a picture at rest, which has finer glyphs if there are any.
    #[cfg(feature = "live")]
    pub(crate) fn at_rest(self) -> Self {
        let glyphs = self.resting_glyphs.unwrap_or(self.cell_mode.glyphs);
        Self { cell_mode: CellMode { glyphs, ..self.cell_mode }, ..self }
    }
}

/// The cell aspect of an unknown terminal: monospace fonts have cells of about 1:2.
pub const USUAL_CELL_ASPECT: f32 = 2.0;

/// The range of cell aspects that a user may state. Other values are refused or ignored.
pub const CELL_ASPECT_RANGE: RangeInclusive<f32> = 0.1..=10.0;

/// The user's choice of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorChoice {
    /// The colours that are detected.
    #[default]
    Auto,
    /// At least sixteen colours, even if `NO_COLOR` is set.
    Always,
    /// No colours.
    Never,
    /// Exactly these colours.
    Exactly(Colors),
}

/// Returns the cell aspect (height / width) from the size of a window in cells and in pixels.
///
/// Returns `None` if the result is not between 0.25 and 8: many terminals leave the size in pixels at 0.
///
/// ```
/// use termtrace::cell_aspect_of;
///
/// assert_eq!(cell_aspect_of(80, 24, 800, 480), Some(2.0));
/// assert_eq!(cell_aspect_of(80, 24, 0, 0), None);
/// ```
pub fn cell_aspect(columns: u16, rows: u16, width: u16, height: u16) -> Option<f32> {
    // Integer division, because cells have whole pixels and a window may be a few pixels larger than its cells.
    let cell_width = width.checked_div(columns)?;
    let cell_height = height.checked_div(rows)?;
    let aspect = f32::from(cell_height) / f32::from(cell_width);
    // Some terminals report garbage as the size in pixels, and a wrong aspect is worse than the default.
    is_plausible_cell_aspect(aspect).then_some(aspect)
}

/// Returns whether a cell aspect is plausible: in 0.25..=8, a range that includes every terminal's
/// font.
pub(crate) fn is_plausible_cell_aspect(aspect: f32) -> bool {
    (0.25..=8.0).contains(&aspect)
}

/// Returns the half blocks that cells may use, from the number of `rows` of a window and its
/// `height` in pixels.
pub fn half_blocks(rows: u16, height: u16) -> HalfBlocks {
    // If the height is not a multiple of the rows, because of a border or padding, the cell's height is uncertain.
    let cell_height = height.checked_div(rows).filter(|cell_height| cell_height * rows == height);
    cell_height.map_or(HalfBlocks::Lower, HalfBlocks::of_cell_height)
}

#[cfg(all(test, unit_tests))]
mod tests;
