//! The two pixels, one above the other, that a half block or ramp cell shows.

use crate::color::Srgb8;
use crate::tone::Picture;

/// Returns the upper and the lower pixel of a cell; the lower is `None` if it is below the picture.
pub(super) fn pixels(picture: &Picture, column: u16, row: u16) -> (Srgb8, Option<Srgb8>) {
    let width = picture.width() as usize;
    let upper = usize::from(row) * 2 * width + usize::from(column);
    (picture.pixels()[upper], picture.pixels().get(upper + width).copied())
}
