//! Half blocks: each half of a cell shows a pixel.

use super::Glyphs;
use super::glyph_kind::{Fill, GlyphKind};
use super::ink_converter::InkConverter;
use super::pair;
use super::palette::Palette;
use crate::grid::{Cell, Grid, Ink};
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "half",
    help: "two pixels, one above the other",
    title: "half blocks",
    pixels_per_cell: (1, 2),
    has_blocks: true,
    // Without colours a half is either on or off, which shows less of a picture than ten characters do.
    plain: Some(Glyphs::Ramp),
    fill: Fill::Colored(fill),
};

/// Fills each cell with a lower half block in the lower pixel's colour on the upper pixel's.
// The upper half block would do as well, but at odd cell heights some terminals split the two glyphs one row
// of pixels apart, and a mix of them shows; one glyph everywhere keeps the split straight. The encoder mixes them where
// the height is even and that saves bytes. Equal halves are a space: full blocks show hairlines in some fonts.
fn fill(grid: &mut Grid, picture: &Picture, inks: &mut InkConverter) {
    if let InkConverter::Monochrome(palette) = inks {
        return fill_without_colors(grid, picture, palette);
    }
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let (upper, lower) = pair::pixels(picture, column, row);
            let (x, y) = (usize::from(column), 2 * usize::from(row));
            let upper = inks.ink_at(upper, x, y);
            let lower = lower.map(|lower| inks.ink_at(lower, x, y + 1));
            *grid.cell_mut(column, row) = match lower {
                Some(lower) if lower != upper => Cell::new('▄', lower, upper),
                Some(_) => Cell::new(' ', Ink::Default, upper),
                // Below the picture: the lower half keeps the default background.
                None => Cell::new('▀', upper, Ink::Default),
            };
        }
    }
}

/// Fills each cell with the block whose halves are on where the dithered pixels are light.
fn fill_without_colors(grid: &mut Grid, picture: &Picture, palette: &mut Palette) {
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let (upper, lower) = pair::pixels(picture, column, row);
            let (x, y) = (usize::from(column), 2 * usize::from(row));
            let upper = palette.index(upper, x, y) > 0;
            let lower = lower.is_some_and(|lower| palette.index(lower, x, y + 1) > 0);
            let glyph = match (upper, lower) {
                (false, false) => ' ',
                (false, true) => '▄',
                (true, false) => '▀',
                (true, true) => '█',
            };
            *grid.cell_mut(column, row) = Cell::new(glyph, Ink::Default, Ink::Default);
        }
    }
}
