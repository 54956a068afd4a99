//! The properties of a glyph kind.

use super::Glyphs;
use super::ink_converter::InkConverter;
use crate::grid::Grid;
use crate::tone::Picture;

/// A row of the table of glyph kinds: everything that distinguishes one.
// One constant per kind: before, a new kind took edits in nine files.
pub(super) struct GlyphKind {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
    pub(super) title: &'static str,
    pub(super) pixels_per_cell: (u32, u32),
    pub(super) has_blocks: bool,
    /// The kind to use without colours, if this one needs them.
    ///
    /// It has the same number of pixels per cell.
    pub(super) plain: Option<Glyphs>,
    pub(super) fill: Fill,
}

/// The function that fills the cells of a frame.
pub(super) enum Fill {
    /// A function that fills glyphs and colours together.
    Colored(fn(&mut Grid, &Picture, &mut InkConverter)),
    /// A function that fills glyphs by lightness; [`tint`](super::tint) adds the colours.
    Lightness(fn(&mut Grid, &Picture)),
}
