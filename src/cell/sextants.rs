//! Sextants (U+1FB00 to U+1FB3B, of Unicode 13).

use super::glyph_kind::{Fill, GlyphKind};
use super::ink_converter::InkConverter;
use super::mosaic::Mosaic;
use crate::grid::Grid;
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "sextants",
    help: "sixths of a cell, two by three, of Unicode 13",
    title: "sextants",
    pixels_per_cell: MOSAIC.pixels_per_cell(),
    has_blocks: true,
    colorless_glyphs: None,
    fill: Fill::Colored(fill),
};

const MOSAIC: Mosaic = Mosaic { parts: [2, 3], part_pixels: [2, 2], glyph: sextant, has_eighths: false };

fn fill(grid: &mut Grid, picture: &Picture, inks: &mut InkConverter) {
    MOSAIC.fill(grid, picture, inks);
}

/// Returns the glyph of a mask of sextants.
// The block of Unicode 13 has all masks in order, except for the space and the left, right and full block.
pub(super) fn sextant(mask: u8) -> char {
    match mask & 63 {
        0 => ' ',
        21 => '▌',
        42 => '▐',
        63 => '█',
        mask => {
            char::from_u32(0x1FB00 + u32::from(mask) - 1 - u32::from(mask > 21) - u32::from(mask > 42)).unwrap_or(' ')
        }
    }
}
