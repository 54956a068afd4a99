//! The properties of a cell kind.

use super::Glyphs;
use super::ink_converter::InkConverter;
use crate::grid::Grid;
use crate::tone::Picture;

/// Everything particular to a cell kind.
pub(super) struct GlyphKind {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
    pub(super) title: &'static str,
    pub(super) pixels_per_cell: (u32, u32),
    pub(super) has_blocks: bool,
    /// The kind used without colours, with the same number of pixels per cell; `None` if this one works without.
    pub(super) plain: Option<Glyphs>,
    pub(super) fill: Fill,
}

/// The way to fill cells, once per frame.
pub(super) enum Fill {
    /// Fills glyphs and colours together.
    Colored(fn(&mut Grid, &Picture, &mut InkConverter)),
    /// Fills glyphs that show lightness; colours, if any, are added afterwards.
    Lightness(fn(&mut Grid, &Picture)),
}
