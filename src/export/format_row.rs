//! The properties of a file format.

use crate::capabilities::Colors;
use crate::grid::Grid;
use crate::tone::Picture;
use std::io;

/// A row of the table of formats: everything that distinguishes one.
// One constant per format: before, a new one took edits in eight files. Flags, completions, keys, commands and messages
// follow from the rows. Films (`record`) are no rows: they are written frame by frame into an open sink.
pub(super) struct FormatRow {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
    /// The extensions of file names; new files get the first.
    pub(super) extensions: &'static [&'static str],
    // Keys and commands are in users' keymaps, so they do not follow from the name.
    pub(super) key: char,
    pub(super) command: &'static str,
    pub(super) title: &'static str,
    pub(super) contents: Contents,
    /// Returns the difference of the second file from the first, the golden one.
    pub(super) difference: fn(&[u8], &[u8]) -> String,
}

/// The input of a format, and the function that makes the file.
#[derive(Clone, Copy)]
// Function pointers, not a trait: rows are constants, and a format is no more than its function.
pub enum Contents {
    /// The picture's pixels, their aspect (height / width), and the side of each in the file.
    Pixels(fn(&Picture, f32, u32) -> io::Result<Vec<u8>>),
    /// The cells that show the picture.
    Cells {
        /// Whether the format has colours.
        has_colors: bool,
        /// Makes the file from a grid, the colours of its cells, and their aspect (height / width).
        write: fn(&Grid, Colors, f32) -> Vec<u8>,
    },
}
