//! The pixels of a cell that shows two of them.

use crate::color::Srgb8;
use crate::tone::Picture;

/// The upper and the lower pixel of a cell; the lower one is missing below the picture's edge.
pub(super) fn pixels(picture: &Picture, column: u16, row: u16) -> (Srgb8, Option<Srgb8>) {
    let width = picture.width as usize;
    let upper = usize::from(row) * 2 * width + usize::from(column);
    (picture.pixels[upper], picture.pixels.get(upper + width).copied())
}
