//! Octants (U+1CD00 to U+1CDE5, of Unicode 16) and eighths.

use super::glyph_kind::{Fill, GlyphKind};
use super::ink_converter::InkConverter;
use super::mosaic::Mosaic;
use crate::grid::Grid;
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "octants",
    help: "eighths of a cell, two by four, of Unicode 16",
    title: "octants",
    pixels_per_cell: MOSAIC.pixels_per_cell(),
    has_blocks: true,
    colorless_glyphs: None,
    fill: Fill::Colored(fill),
};

const MOSAIC: Mosaic = Mosaic { parts: [2, 4], part_pixels: [2, 2], glyph: octant, has_eighths: true };

fn fill(grid: &mut Grid, picture: &Picture, inks: &mut InkConverter) {
    MOSAIC.fill(grid, picture, inks);
}

/// The masks of octants whose glyphs are outside the block of Unicode 16, with these glyphs.
const ELSEWHERE: [(u8, char); 26] = [
    (0x00, ' '),
    (0x01, '\u{1CEA8}'),
    (0x02, '\u{1CEAB}'),
    (0x03, '\u{1FB82}'),
    (0x05, '▘'),
    (0x0a, '▝'),
    (0x0f, '▀'),
    (0x14, '\u{1FBE6}'),
    (0x28, '\u{1FBE7}'),
    (0x3f, '\u{1FB85}'),
    (0x40, '\u{1CEA3}'),
    (0x50, '▖'),
    (0x55, '▌'),
    (0x5a, '▞'),
    (0x5f, '▛'),
    (0x80, '\u{1CEA0}'),
    (0xa0, '▗'),
    (0xa5, '▚'),
    (0xaa, '▐'),
    (0xaf, '▜'),
    (0xc0, '▂'),
    (0xf0, '▄'),
    (0xf5, '▙'),
    (0xfa, '▟'),
    (0xfc, '▆'),
    (0xff, '█'),
];

/// Returns the glyph of a mask of octants.
// The block of Unicode 16 has all masks in order, except for those whose glyphs are older or belong to other sets.
pub(super) fn octant(mask: u8) -> char {
    let before = ELSEWHERE.partition_point(|&(other, _)| other < mask);
    match ELSEWHERE.get(before) {
        Some(&(other, glyph)) if other == mask => glyph,
        _ => char::from_u32(0x1CD00 + u32::from(mask) - before as u32).unwrap_or(' '),
    }
}
