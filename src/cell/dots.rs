//! A dot for each light pixel: a glyph kind that exists in tests only.
//!
//! It shows that a file and a row of the table suffice to add a glyph kind.

use super::glyph_kind::{Fill, GlyphKind};
use crate::grid::{Cell, Grid, Ink};
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "dots",
    help: "a dot for each pixel that is light",
    title: "dots",
    pixels_per_cell: (1, 1),
    has_blocks: false,
    colorless_glyphs: None,
    fill: Fill::Lightness(fill),
};

fn fill(grid: &mut Grid, picture: &Picture) {
    for (cell, pixel) in picture.pixels().iter().enumerate() {
        grid.set_at(cell, &Cell::new(if pixel.g >= 128 { 'o' } else { ' ' }, Ink::Default, Ink::Default));
    }
}
