//! The two halves of a picture's cell, and how far they may be from the wanted ones.

use crate::color::{Oklab, Srgb8};
use crate::grid::{Cell, Glyph, Ink};

/// How far a half cell may be from the wanted one in this frame.
#[derive(Clone, Copy)]
pub(super) struct Tolerance {
    /// In OKLab.
    pub(super) distance: f32,
    /// The square of the difference in 8-bit sRGB, over all three channels.
    pub(super) square: u32,
}

impl Tolerance {
    pub(super) fn allows(self, shown: Srgb8, wanted: Srgb8) -> bool {
        shown == wanted
            || squared_difference(shown, wanted) <= self.square
                && Oklab::from_srgb8(shown).distance(Oklab::from_srgb8(wanted)) <= self.distance
    }
}

/// The square of the difference of two colours, over all three channels.
pub(super) fn squared_difference(a: Srgb8, b: Srgb8) -> u32 {
    [a.r.abs_diff(b.r), a.g.abs_diff(b.g), a.b.abs_diff(b.b)].map(|channel| u32::from(channel).pow(2)).iter().sum()
}

/// The upper and the lower colour of a picture's cell.
pub(super) type Halves = [Srgb8; 2];

/// Those of a half block or a space in truecolor; anything else is text, also a space that has a colour for characters.
pub(super) fn picture_halves(cell: &Cell) -> Option<Halves> {
    let (Ink::Rgb(bg), true) = (cell.bg, cell.attributes.is_empty()) else { return None };
    match (&cell.glyph, cell.fg) {
        (Glyph::Char(' '), Ink::Default) => Some([bg; 2]),
        (Glyph::Char('▄'), Ink::Rgb(fg)) => Some([bg, fg]),
        (Glyph::Char('▀'), Ink::Rgb(fg)) => Some([fg, bg]),
        _ => None,
    }
}

/// A cell with these halves, its block the same way up as the wanted one's.
pub(super) fn half_block_cell([upper, lower]: Halves, wanted: &Cell) -> Cell {
    if upper == lower {
        Cell::new(' ', Ink::Default, Ink::Rgb(upper))
    } else if wanted.glyph == '▀' {
        Cell::new('▀', Ink::Rgb(upper), Ink::Rgb(lower))
    } else {
        Cell::new('▄', Ink::Rgb(lower), Ink::Rgb(upper))
    }
}
