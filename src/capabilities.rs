//! What a terminal can show: plain values, and how the environment and its own answers tell them.

mod answers;
mod detection;
mod findings;
#[cfg(feature = "live")]
mod terminfo;

// What a terminal can show is said in the words of what shows it.
pub use crate::cell::{CellMode, Colors, Glyphs};
pub use crate::grid::CellShape;
pub use answers::{Answers, TEST_COLOR};
pub use detection::{Clues, Found, GlyphChoice, Source, colors, glyphs};
pub use findings::{Asking, Findings, Hints, VARIABLES};
#[cfg(feature = "live")]
pub use terminfo::terminfo_colors;

use std::ops::RangeInclusive;

/// What the screen's cells can be made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capabilities {
    /// How pixels become cells.
    pub cell_mode: CellMode,
    /// A cell's height over its width, greater than 0.
    pub cell_aspect: f32,
    /// Whether the upper and the lower half block meet in the same line: only then may a picture mix them.
    pub halves_meet: bool,
    /// Whether the terminal writes dark on light: where its own colours are all there are, more ink is then less light.
    pub light_background: bool,
    /// Whether it knows synchronized output: each frame is then shown at once.
    pub synchronized_output: bool,
}

/// The aspect of a cell of which nothing is known.
pub const USUAL_CELL_ASPECT: f32 = 2.0;

/// The aspects of cells in which anybody could read. Others are not what a person or a program means.
pub const CELL_ASPECTS: RangeInclusive<f32> = 0.1..=10.0;

/// Whether pictures may be coloured, and how, as the user says it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorChoice {
    /// As the terminal is likely to show them.
    #[default]
    Auto,
    /// At least sixteen, whatever `NO_COLOR` says.
    Always,
    /// None at all.
    Never,
    /// Exactly these.
    Exactly(Colors),
}

/// A cell's height over its width from a window's size in cells and in pixels, where it gives a sensible one.
pub fn cell_aspect(columns: u16, rows: u16, width: u16, height: u16) -> Option<f32> {
    // Cells have whole pixels; a window may be a few pixels larger than its cells.
    let cell_width = width.checked_div(columns)?;
    let cell_height = height.checked_div(rows)?;
    let aspect = f32::from(cell_height) / f32::from(cell_width);
    // Some terminals fill the fields with anything.
    (0.25..=8.0).contains(&aspect).then_some(aspect)
}

/// Whether the two half blocks meet in the same line, from a window's height in cells and in pixels: where a cell has an
/// even number of pixel rows. With an odd number, some terminals give the middle one to either half, others to the
/// glyph, and their mix would show.
pub fn halves_meet(rows: u16, height: u16) -> bool {
    // A remainder may be a border, or say that the figure is no cell's.
    let cell_height = height.checked_div(rows).filter(|cell_height| cell_height * rows == height);
    cell_height.is_some_and(|cell_height| cell_height > 0 && cell_height % 2 == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_meet_in_cells_of_even_height() {
        for (rows, height, expected) in
            [(24, 480, true), (24, 456, false), (24, 24 * 17, false), (24, 497, false), (24, 0, false), (0, 480, false)]
        {
            assert_eq!(halves_meet(rows, height), expected, "{rows} rows in {height} pixels");
        }
    }

    #[test]
    fn cell_aspect_needs_a_sensible_window() {
        for (columns, rows, width, height, expected) in [
            (80, 24, 800, 480, Some(2.0)),
            (80, 24, 800, 456, Some(1.9)),
            (80, 24, 805, 497, Some(2.0)),
            (80, 24, 0, 0, None),
            (0, 0, 800, 480, None),
            (80, 24, 79, 480, None),
            (80, 24, 65535, 24, None),
        ] {
            assert_eq!(cell_aspect(columns, rows, width, height), expected, "{columns}x{rows} in {width}x{height}");
        }
    }
}
