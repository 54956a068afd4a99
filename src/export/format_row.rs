//! The properties of an export format, which are a row of the table of formats.

use crate::capabilities::Colors;
use crate::grid::Grid;
use crate::tone::Picture;
use std::io;

/// A row of the table of formats: all properties of one export format.
// Flags, completions, keys, commands and messages follow from the rows; without the table, a new format took edits in
// eight files. Films (`record`) are not in it, because they are written frame by frame.
pub(super) struct FormatRow {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
    /// The file name extensions of the format; new files get the first.
    pub(super) extensions: &'static [&'static str],
    // The key and the command's name do not follow from the format's name, because users' keymaps contain them.
    pub(super) key: char,
    pub(super) command: &'static str,
    pub(super) title: &'static str,
    pub(super) file_encoder: FileEncoder,
    /// Returns a report of how the second file differs from the first, which is the golden file.
    pub(super) difference: fn(&[u8], &[u8]) -> GoldenDifference,
}

/// A readable report of how a file differs from a golden file.
pub struct GoldenDifference {
    /// The difference as lines of text.
    pub text: String,
    /// A picture file in the golden file's format that shows where the files differ, if both are
    /// pictures of one size.
    pub picture: Option<Vec<u8>>,
}

impl From<String> for GoldenDifference {
    fn from(text: String) -> Self {
        Self { text, picture: None }
    }
}

/// The function that makes a file of a format, from pixels or from cells.
#[derive(Clone, Copy)]
// Function pointers instead of a trait, because rows are constants and a format has a single function.
pub enum FileEncoder {
    /// Makes the file from a picture, its pixel aspect (height / width), and the side of a pixel in
    /// the file.
    Pixels(fn(&Picture, f32, u32) -> io::Result<Vec<u8>>),
    /// The format contains the cells that show the picture.
    Cells {
        /// Whether the format has colours.
        has_colors: bool,
        /// Whether the file shows default colours as light on black; else its viewer chooses them.
        is_on_black: bool,
        /// Makes the file from a grid, the colours that its cells may have, the aspect of the cells
        /// (height / width), and the name of the scene.
        write: fn(&Grid, Colors, f32, &str) -> Vec<u8>,
    },
}
