//! Half blocks: each half of a cell shows a pixel.

use super::Glyphs;
use super::glyph_kind::{Fill, GlyphKind};
use super::ink_converter::InkConverter;
use super::lit::is_lit;
use super::pair;
use crate::grid::{Cell, Grid, Ink};
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "half",
    help: "two pixels, one above the other",
    title: "half blocks",
    pixels_per_cell: (1, 2),
    has_blocks: true,
    // Without colours a half is only on or off, so the ten characters of the ramp show more of a picture.
    colorless_glyphs: Some(Glyphs::Ramp),
    fill: Fill::Colored(fill),
};

/// Sets each cell to a lower half block, in the lower pixel's colour on the upper pixel's colour.
// Always the same half block: at odd cell heights some terminals end the upper half block and begin the lower one at
// different rows of pixels, so that a mix of both kinds is visible. At even heights the encoder mixes them to save
// bytes. If both halves are equal the glyph is a space, because full blocks show hairlines in some fonts.
fn fill(grid: &mut Grid, picture: &Picture, inks: &mut InkConverter) {
    if matches!(inks, InkConverter::Monochrome) {
        return fill_without_colors(grid, picture);
    }
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let (upper, lower) = pair::pixels(picture, column, row);
            let (x, y) = (usize::from(column), 2 * usize::from(row));
            let upper = inks.ink_at(upper, x, y);
            let lower = lower.map(|lower| inks.ink_at(lower, x, y + 1));
            let cell = match lower {
                Some(lower) if lower != upper => Cell::new('▄', lower, upper),
                Some(_) => Cell::new(' ', Ink::Default, upper),
                // The lower half is below the picture and keeps the default background.
                None => Cell::new('▀', upper, Ink::Default),
            };
            grid.set(column, row, &cell);
        }
    }
}

/// Sets each cell to the space or block whose halves are filled where the dithered pixels are
/// light.
fn fill_without_colors(grid: &mut Grid, picture: &Picture) {
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let (upper, lower) = pair::pixels(picture, column, row);
            let (x, y) = (usize::from(column), 2 * usize::from(row));
            let upper = is_lit(upper, x, y);
            let lower = lower.is_some_and(|lower| is_lit(lower, x, y + 1));
            let glyph = match (upper, lower) {
                (false, false) => ' ',
                (false, true) => '▄',
                (true, false) => '▀',
                (true, true) => '█',
            };
            grid.set(column, row, &Cell::new(glyph, Ink::Default, Ink::Default));
        }
    }
}
