//! Quadrants and eighths: the block characters that every font has (U+2580 to U+259F).

use super::glyph_kind::{Fill, GlyphKind};
use super::ink_converter::InkConverter;
use super::mosaic::Mosaic;
use crate::grid::Grid;
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "blocks",
    help: "quadrants, and eighths of a cell: the best two colours for each cell",
    title: "quadrants and eighths",
    pixels_per_cell: MOSAIC.pixels_per_cell(),
    has_blocks: true,
    colorless_glyphs: None,
    fill: Fill::Colored(fill),
};

const MOSAIC: Mosaic = Mosaic { parts: [2, 2], part_pixels: [2, 4], glyph: quadrant, has_eighths: true };

fn fill(grid: &mut Grid, picture: &Picture, inks: &mut InkConverter) {
    MOSAIC.fill(grid, picture, inks);
}

/// Returns the glyph of a mask of quadrants.
pub(super) fn quadrant(mask: u8) -> char {
    const GLYPHS: [char; 16] = [' ', '▘', '▝', '▀', '▖', '▌', '▞', '▛', '▗', '▚', '▐', '▜', '▄', '▙', '▟', '█'];
    GLYPHS[usize::from(mask & 15)]
}
