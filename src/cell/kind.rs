//! What there is to say of a kind of cells.

use super::Glyphs;
use super::inks::Inks;
use crate::grid::Grid;
use crate::tone::Picture;

/// All that is particular to a kind of cells.
pub(super) struct Kind {
    pub(super) name: &'static str,
    pub(super) help: &'static str,
    pub(super) title: &'static str,
    pub(super) pixels_per_cell: (u32, u32),
    pub(super) has_blocks: bool,
    /// What is in its place where there are no colours, of as many pixels in a cell; `None`: it is as good without.
    pub(super) plain: Option<Glyphs>,
    pub(super) fill: Fill,
}

/// How cells are filled: once for each frame.
pub(super) enum Fill {
    /// Glyphs and their colours together.
    Colored(fn(&mut Grid, &Picture, &mut Inks)),
    /// Glyphs that say how light it is; where there are colours, they are given to them later.
    Lightness(fn(&mut Grid, &Picture)),
}
