//! Spaces: each cell is a space on the mean colour of its two pixels.
//!
//! They are as bright as half blocks, and need no characters beyond ASCII.

use super::Glyphs;
use super::glyph_kind::{Fill, GlyphKind};
use super::ink_converter::InkConverter;
use super::{ramp, tint};
use crate::grid::{Cell, Grid, Ink};
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "spaces",
    help: "a space on the mean colour of two pixels",
    title: "coloured spaces",
    pixels_per_cell: (1, 2),
    has_blocks: false,
    colorless_glyphs: Some(Glyphs::Ramp),
    fill: Fill::Colored(fill),
};

/// Sets each cell to a space on its colour; without colours, to the character of the ramp.
fn fill(grid: &mut Grid, picture: &Picture, inks: &mut InkConverter) {
    if matches!(inks, InkConverter::Monochrome) {
        return ramp::fill(grid, picture);
    }
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let mean = tint::cell_mean(picture, KIND.pixels_per_cell, column, row);
            let ink = inks.ink_at(mean, column.into(), row.into());
            grid.set(column, row, &Cell::new(' ', Ink::Default, ink));
        }
    }
}
