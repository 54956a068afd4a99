//! Conversion of a pixel's colour to one that the terminal has.

use super::colors::Colors;
use super::palette::Palette;
use crate::color::Srgb8;
use crate::grid::Ink;

/// The colours of a terminal.
pub(super) enum InkConverter {
    /// Its own two, dark and light, as numbers 0 and 1 of a palette.
    Monochrome(Palette),
    /// Some of the 256 colours, and which of them is black.
    Indexed(Palette, u8),
    /// All colours.
    Truecolor,
}

impl InkConverter {
    pub(super) fn of(colors: Colors) -> Self {
        match colors {
            Colors::None => Self::Monochrome(Palette::from_colors(&[Srgb8::new(0, 0, 0), Srgb8::new(255, 255, 255)])),
            Colors::Indexed16(values) => Self::Indexed(Palette::from_colors(&values), 0),
            Colors::Indexed256 => Self::Indexed(Palette::cube(), 16),
            Colors::Truecolor => Self::Truecolor,
        }
    }

    /// Returns the ink for a pixel of the screen.
    pub(super) fn ink_at(&mut self, color: Srgb8, x: usize, y: usize) -> Ink {
        match self {
            Self::Monochrome(_) => Ink::Default,
            Self::Indexed(palette, _) => Ink::Indexed(palette.index(color, x, y)),
            Self::Truecolor => Ink::Rgb(color),
        }
    }

    /// Returns the ink behind characters.
    pub(super) fn background(&self) -> Ink {
        match self {
            Self::Monochrome(_) => Ink::Default,
            Self::Indexed(_, black) => Ink::Indexed(*black),
            Self::Truecolor => Ink::Rgb(Srgb8::new(0, 0, 0)),
        }
    }
}
