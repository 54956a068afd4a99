//! Braille patterns (U+2800 to U+28FF): two by four dots on a background.

use super::glyph_kind::{Fill, GlyphKind};
use super::ink_converter::InkConverter;
use super::mosaic::Mosaic;
use crate::grid::Grid;
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "braille",
    help: "two by four dots on a background",
    title: "braille dots",
    pixels_per_cell: MOSAIC.pixels_per_cell(),
    has_blocks: true,
    colorless_glyphs: None,
    fill: Fill::Colored(fill),
};

const MOSAIC: Mosaic = Mosaic { parts: [2, 4], part_pixels: [2, 2], glyph: dots, has_eighths: false };

fn fill(grid: &mut Grid, picture: &Picture, inks: &mut InkConverter) {
    MOSAIC.fill(grid, picture, inks);
}

/// Returns the pattern with a dot for each bit of a mask.
// Unicode added the lowest row of dots last, so it has the highest bits.
fn dots(mask: u8) -> char {
    const BITS: [u32; 8] = [0x01, 0x08, 0x02, 0x10, 0x04, 0x20, 0x40, 0x80];
    let bits: u32 = (0..8).filter(|part| mask >> part & 1 == 1).map(|part| BITS[part]).sum();
    char::from_u32(0x2800 + bits).unwrap_or(' ')
}
