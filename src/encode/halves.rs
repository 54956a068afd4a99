//! The colours of the two halves of a picture cell, and the tolerance of their differences.

use crate::color::{Oklab, Srgb8};
use crate::grid::{PackedCell, PackedInk};

/// The largest allowed difference between the shown and the wanted colour of a half cell.
#[derive(Clone, Copy)]
pub(super) struct Tolerance {
    /// The largest distance of the two colours in OKLab, less the error of [`Oklab::near_srgb8`].
    pub(super) distance: f32,
    /// The largest squared difference in 8-bit sRGB, summed over the channels.
    // Two measures are needed: `distance` in OKLab bounds the visible difference in a cell, `square` in sRGB the
    // signal-to-noise ratio of the picture.
    pub(super) square: u32,
}

impl Tolerance {
    /// Returns whether the colour `shown` is within the tolerance of `wanted`.
    pub(super) fn allows(self, shown: Srgb8, wanted: Srgb8) -> bool {
        // The cheaper measure is tested first: OKLab takes six cube roots.
        shown == wanted
            || squared_difference(shown, wanted) <= self.square
                && self.is_near(Oklab::near_srgb8(shown), Oklab::near_srgb8(wanted))
    }

    /// Returns whether two colours are within the distance.
    #[inline]
    pub(super) fn is_near(self, a: Oklab, b: Oklab) -> bool {
        a.squared_distance(b) <= self.distance * self.distance
    }
}

/// Returns the squared difference of two colours, summed over the channels.
pub(super) fn squared_difference(a: Srgb8, b: Srgb8) -> u32 {
    [a.r.abs_diff(b.r), a.g.abs_diff(b.g), a.b.abs_diff(b.b)].map(|channel| u32::from(channel).pow(2)).iter().sum()
}

/// The colours of the upper and the lower half of a picture cell.
pub(super) type Halves = [Srgb8; 2];

/// Returns the colours of the halves of a truecolor half block or space; `None` for text.
// A space counts as picture only without a glyph colour. Panels give their blanks one, so these are never lossy.
#[inline]
pub(super) fn picture_halves(cell: PackedCell) -> Option<Halves> {
    let bg = cell.bg.color()?;
    match (cell.code(), cell.fg.color()) {
        (SPACE, None) if cell.fg == PackedInk::DEFAULT => Some([bg; 2]),
        (LOWER_HALF, Some(fg)) => Some([bg, fg]),
        (UPPER_HALF, Some(fg)) => Some([fg, bg]),
        _ => None,
    }
}

/// [Codes](PackedCell::code) of cells without attributes: the numbers of the characters.
const SPACE: u32 = ' ' as u32;
const LOWER_HALF: u32 = '▄' as u32;
const UPPER_HALF: u32 = '▀' as u32;

/// Returns a cell that shows these halves, with the half block of `wanted`.
pub(super) fn half_block_cell(halves: Halves, wanted: PackedCell) -> PackedCell {
    let [upper, lower] = halves.map(PackedInk::rgb);
    if upper == lower {
        PackedCell::new(' ', PackedInk::DEFAULT, upper)
    } else if wanted.has_char('▀') {
        PackedCell::new('▀', upper, lower)
    } else {
        PackedCell::new('▄', lower, upper)
    }
}
