//! Half blocks: each half of a cell is a pixel.

use super::pixel_pair;
use crate::grid::{Cell, Grid, Ink};
use crate::tone::Picture;

/// The lower half block, coloured by the lower pixel, on the upper one. (The upper half block would do as well, but
/// where the font draws it, it covers a pixel row of the wrong half at odd cell heights; one glyph everywhere keeps
/// the split straight.) Two equal pixels are a space: a full block shows hairlines in some fonts.
pub(super) fn fill(grid: &mut Grid, picture: &Picture) {
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let (upper, lower) = pixel_pair(picture, column, row);
            *grid.cell_mut(column, row) = match lower {
                Some(lower) if lower != upper => Cell::new('▄', Ink::Rgb(lower), Ink::Rgb(upper)),
                Some(_) => Cell::new(' ', Ink::Default, Ink::Rgb(upper)),
                None => Cell::new('▀', Ink::Rgb(upper), Ink::Default),
            };
        }
    }
}
