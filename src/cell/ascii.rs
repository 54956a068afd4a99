//! ASCII with outlines: characters draw where surfaces meet, and fill objects by their shading.

use super::glyph_kind::{Fill, GlyphKind};
use super::ink_converter::InkConverter;
use crate::grid::{Cell, Grid, Ink};
use crate::render::{Extent, Geometry};
use crate::tone::Picture;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "ascii",
    help: "outlines, and each object filled by its own shading",
    title: "characters with outlines",
    pixels_per_cell: (2, 4),
    has_blocks: false,
    plain: None,
    fill: Fill::Geometry(fill),
};

/// Sets each cell's glyph and colour.
fn fill(grid: &mut Grid, _: &Picture, geometry: &Geometry, _: bool, _: &mut InkConverter) {
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let (x, y) = (usize::from(column), usize::from(row));
            let glyph = match geometry.at(4 * x + 2, 8 * y + 4).extent {
                _ if geometry.has_edge(x, y) => '*',
                Extent::Bounded => 'o',
                _ => ' ',
            };
            *grid.cell_mut(column, row) = Cell::new(glyph, Ink::Default, Ink::Default);
        }
    }
}
