//! The properties of a glyph kind, which are a row of the table of glyph kinds.

use super::ink_converter::InkConverter;
use super::last_frame::LastFrame;
use super::{Colors, Glyphs};
use crate::grid::Grid;
use crate::render::Geometry;
use crate::tone::Picture;

/// A row of the table of glyph kinds: all properties of one kind.
// Without this table, adding a kind took edits in nine files.
pub(super) struct GlyphKind {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
    pub(super) title: &'static str,
    pub(super) pixels_per_cell: (u32, u32),
    pub(super) has_blocks: bool,
    /// The kind to use instead on terminals without colours; `None` if this kind needs no colours.
    ///
    /// Both kinds must have the same number of pixels per cell.
    pub(super) colorless_glyphs: Option<Glyphs>,
    pub(super) fill: Fill,
}

/// The function that fills the cells of a frame.
pub(super) enum Fill {
    /// Sets glyphs and colours together.
    Colored(fn(&mut Grid, &Picture, &mut InkConverter)),
    /// Sets glyphs by lightness; [`tint`](super::tint) then adds the colours.
    Lightness(fn(&mut Grid, &Picture)),
    /// Sets glyphs and colours from the picture, its surfaces and the terminal's background.
    ///
    /// With a last frame, cells of a moving view keep the glyphs of the frame before if these still fit well enough.
    Geometry(fn(&mut Grid, &Picture, &Geometry, (Background, Colors), Option<&mut LastFrame>)),
}

/// The terminal's default background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Background {
    Dark,
    Light,
}
