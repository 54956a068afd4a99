//! Conversion of a pixel's colour to a colour of the terminal.

use super::colors::Colors;
use super::palette::Palette;
use crate::color::Srgb8;
use crate::grid::Ink;

/// A converter to a set of colours.
pub(super) enum InkConverter {
    /// The two default colours, dark and light, as indices 0 and 1 of a palette.
    Monochrome(Palette),
    /// Some of the 256 palette colours, and the index of black.
    Indexed(Palette, u8),
    /// All 24-bit colours.
    Truecolor,
}

impl InkConverter {
    pub(super) fn of(colors: Colors) -> Self {
        match colors {
            Colors::None => Self::Monochrome(Palette::from_colors(&[Srgb8::new(0, 0, 0), Srgb8::new(255, 255, 255)])),
            Colors::Indexed16(values) => Self::Indexed(Palette::from_colors(&values), 0),
            // Index 16 is the cube's black, which no theme changes; index 0 is the theme's.
            Colors::Indexed256 => Self::Indexed(Palette::cube(), 16),
            Colors::Truecolor => Self::Truecolor,
        }
    }

    /// Returns the ink of a colour at a pixel of the screen, which selects the dither threshold.
    pub(super) fn ink_at(&mut self, color: Srgb8, x: usize, y: usize) -> Ink {
        match self {
            Self::Monochrome(_) => Ink::Default,
            Self::Indexed(palette, _) => Ink::Indexed(palette.index(color, x, y)),
            Self::Truecolor => Ink::Rgb(color),
        }
    }

    /// Returns the background of characters: black, or the default background without colours.
    pub(super) fn background(&self) -> Ink {
        match self {
            Self::Monochrome(_) => Ink::Default,
            Self::Indexed(_, black) => Ink::Indexed(*black),
            Self::Truecolor => Ink::Rgb(Srgb8::new(0, 0, 0)),
        }
    }
}
