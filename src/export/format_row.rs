//! What there is to say of a format.

use crate::capabilities::Colors;
use crate::grid::Grid;
use crate::tone::Picture;
use std::io;

/// All that is particular to a format.
pub(super) struct FormatRow {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
    /// What is written first.
    pub(super) extensions: &'static [&'static str],
    pub(super) key: char,
    pub(super) command: &'static str,
    pub(super) title: &'static str,
    pub(super) contents: Contents,
    /// How the second of two files differs from the first, the golden one.
    pub(super) difference: fn(&[u8], &[u8]) -> String,
}

/// What files of a format are made of, and the function that makes them.
#[derive(Clone, Copy)]
pub enum Contents {
    /// The picture's pixels, of that aspect (height / width), each as a square of so many each way.
    Pixels(fn(&Picture, f32, u32) -> io::Result<Vec<u8>>),
    /// The cells that show it.
    Cells {
        /// Whether it can say anything of their colours.
        has_colors: bool,
        /// Made of a grid, the colours that its cells may have, and their aspect (height / width).
        write: fn(&Grid, Colors, f32) -> Vec<u8>,
    },
}
