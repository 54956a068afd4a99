//! The colours of the two halves of a picture cell, and the tolerance of their differences.

use crate::grid::{Grid, PackedCell, PackedInk};

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

/// Returns the sum of the squared differences of both halves.
pub(super) fn sum(squares: [u32; 2]) -> u64 {
    u64::from(squares[0]) + u64::from(squares[1])
}

/// Returns the colours of the halves of a truecolor half block or space; `None` for text.
// A space counts as picture only without a glyph colour. Panels give their blanks one, so these are never lossy.
#[inline]
pub(super) fn picture_halves(cell: PackedCell) -> Option<Halves> {
    let PackedCell { fg, bg, .. } = cell;
    let code = cell.glyph_and_attributes();
    let (is_space, is_lower, is_upper) = (code == SPACE, code == LOWER_HALF, code == UPPER_HALF);
    // Without branches, which pictures of spaces and half blocks would make hard to predict.
    let has_inks = bg.is_rgb() & if is_space { fg == PackedInk::DEFAULT } else { fg.is_rgb() };
    let halves = [if is_upper { fg } else { bg }, if is_lower { fg } else { bg }];
    ((is_space | is_lower | is_upper) & has_inks).then_some(halves)
}

/// The halves of a cell that shows text or is unknown.
pub(super) const NO_PICTURE: Halves = [PackedInk::DEFAULT; 2];

/// The halves of all cells of the shown and the wanted grid, in reading order.
///
/// Those of cells that are no picture are [`NO_PICTURE`].
#[derive(Default)]
pub(super) struct PictureHalves {
    pub(super) shown: Vec<Halves>,
    pub(super) wanted: Vec<Halves>,
}

impl PictureHalves {
    /// Reads the halves of the shown grid.
    pub(super) fn read_shown(&mut self, shown: &Grid) {
        read(shown, &mut self.shown);
    }

    /// Reads the halves of the wanted grid.
    pub(super) fn read_wanted(&mut self, wanted: &Grid) {
        read(wanted, &mut self.wanted);
    }
}

fn read(grid: &Grid, halves: &mut Vec<Halves>) {
    halves.clear();
    halves.extend(grid.packed().iter().map(|&cell| picture_halves(cell).unwrap_or(NO_PICTURE)));
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
