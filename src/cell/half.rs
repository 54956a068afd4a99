//! Half blocks: each half of a cell is a pixel.

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
    // Without colours a half could only be on or off, which shows little.
    plain: Some(Glyphs::Ramp),
    fill: Fill::Colored(fill),
};

/// Returns a lower half block in the lower pixel's colour on the upper pixel's. The upper half block would do as well,
/// but where the font draws it, it covers a pixel row of the wrong half at odd cell heights; a single glyph everywhere
/// keeps the split straight. Two equal halves are a space: a full block shows hairlines in some fonts.
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
                None => Cell::new('▀', upper, Ink::Default),
            };
        }
    }
}

/// Returns the glyph without colours, where each half is on or off.
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
