//! Conversion of a pixel's colour to a colour of the terminal.

use super::colors::Colors;
use super::palette::Palette;
use crate::color::Srgb8;
use crate::grid::Ink;

/// A converter of sRGB colours to the inks of a set of colours.
pub(super) enum InkConverter {
    /// For the two default colours.
    Monochrome,
    /// For palette colours: the palette, and the index of black in it.
    Indexed(Palette, u8),
    /// For 24-bit colours, which need no conversion.
    Truecolor,
}

impl InkConverter {
    pub(super) fn for_colors(colors: Colors) -> Self {
        match colors {
            Colors::None => Self::Monochrome,
            Colors::Indexed16(values) => Self::Indexed(Palette::from_colors(&values), 0),
            // Black is index 16, in the cube, because a theme may change index 0.
            Colors::Indexed256 => Self::Indexed(Palette::cube_and_greys(), 16),
            Colors::Truecolor => Self::Truecolor,
        }
    }

    /// Returns the ink for a colour at the pixel in column `x` and row `y`.
    pub(super) fn ink_at(&mut self, color: Srgb8, x: usize, y: usize) -> Ink {
        match self {
            Self::Monochrome => Ink::Default,
            Self::Indexed(palette, _) => Ink::Indexed(palette.index(color, x, y)),
            Self::Truecolor => Ink::Rgb(color),
        }
    }

    /// Returns the ink for a character of this colour: not dithered, so the same at all pixels.
    pub(super) fn flat_ink(&mut self, color: Srgb8) -> Ink {
        match self {
            Self::Monochrome => Ink::Default,
            Self::Indexed(palette, _) => Ink::Indexed(palette.flat_index(color)),
            Self::Truecolor => Ink::Rgb(color),
        }
    }

    /// Returns the background on which characters are drawn: black, or the default background if
    /// there are no colours.
    pub(super) fn background(&self) -> Ink {
        match self {
            Self::Monochrome => Ink::Default,
            Self::Indexed(_, black) => Ink::Indexed(*black),
            Self::Truecolor => Ink::Rgb(Srgb8::new(0, 0, 0)),
        }
    }
}
