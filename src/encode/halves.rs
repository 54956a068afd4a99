//! The colours of the two halves of a picture cell, and the tolerance of their differences.

use crate::grid::{PackedCell, PackedInk};

/// The largest allowed difference between the shown and the wanted colour of a half cell.
#[derive(Clone, Copy)]
pub(super) struct Tolerance {
    /// The largest distance of the two colours in OKLab, less the error of
    /// [`ColorList::fill`](super::eights::ColorList::fill).
    pub(super) distance: f32,
    /// The largest squared difference in 8-bit sRGB, summed over the channels.
    // Two measures are needed: `distance` in OKLab bounds the visible difference in a cell, `square` in sRGB the
    // signal-to-noise ratio of the picture.
    pub(super) square: u32,
}

/// Returns the squared difference of two colours in truecolor, summed over the channels.
#[inline]
pub(super) fn squared_difference(a: PackedInk, b: PackedInk) -> u32 {
    let difference = |shift: u32| (a.bits() >> shift & 255).cast_signed() - (b.bits() >> shift & 255).cast_signed();
    let (r, g, b) = (difference(16), difference(8), difference(0));
    (r * r + g * g + b * b).cast_unsigned()
}

/// The colours, in truecolor, of the upper and the lower half of a picture cell.
pub(super) type Halves = [PackedInk; 2];

/// Returns the squared differences of both halves.
#[inline]
pub(super) fn squared_differences(a: Halves, b: Halves) -> [u32; 2] {
    [squared_difference(a[0], b[0]), squared_difference(a[1], b[1])]
}

/// Returns the colours of the halves of a truecolor half block or space; `None` for text.
// A space counts as picture only without a glyph colour. Panels give their blanks one, so these are never lossy.
#[inline]
pub(super) fn picture_halves(cell: PackedCell) -> Option<Halves> {
    let PackedCell { fg, bg, .. } = cell;
    let (halves, is_picture) = match cell.glyph_and_attributes() {
        SPACE => ([bg, bg], fg == PackedInk::DEFAULT),
        LOWER_HALF => ([bg, fg], fg.is_rgb()),
        UPPER_HALF => ([fg, bg], fg.is_rgb()),
        _ => return None,
    };
    (is_picture && bg.is_rgb()).then_some(halves)
}

/// [Codes](PackedCell::code) of cells without attributes: the numbers of the characters.
pub(super) const SPACE: u32 = ' ' as u32;
pub(super) const LOWER_HALF: u32 = '▄' as u32;
pub(super) const UPPER_HALF: u32 = '▀' as u32;

/// Returns a cell that shows these halves, with the half block of `wanted`.
#[inline]
pub(super) fn half_block_cell_with_glyph_of([upper, lower]: Halves, wanted: PackedCell) -> PackedCell {
    if upper == lower {
        PackedCell::new(' ', PackedInk::DEFAULT, upper)
    } else if wanted.has_char('▀') {
        PackedCell::new('▀', upper, lower)
    } else {
        PackedCell::new('▄', lower, upper)
    }
}
