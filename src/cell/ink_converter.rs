//! Conversion of a pixel's colour to a colour of the terminal.

use super::colors::Colors;
use super::palette::Palette;
use crate::color::Srgb8;
use crate::grid::Ink;

/// A converter of sRGB colours to the inks of a set of colours.
pub(super) enum InkConverter {
    /// For the two default colours: a palette in which index 0 is dark and 1 is light.
    Monochrome(Palette),
    /// For palette colours: the palette, and the index of black in it.
    Indexed(Palette, u8),
    /// For 24-bit colours, which need no conversion.
    Truecolor,
}

impl InkConverter {
    pub(super) fn for_colors(colors: Colors) -> Self {
        match colors {
            Colors::None => Self::Monochrome(Palette::from_colors(&[Srgb8::new(0, 0, 0), Srgb8::new(255, 255, 255)])),
            Colors::Indexed16(values) => Self::Indexed(Palette::from_colors(&values), 0),
            // Black is index 16, in the cube, because a theme may change index 0.
            Colors::Indexed256 => Self::Indexed(Palette::cube(), 16),
            Colors::Truecolor => Self::Truecolor,
        }
    }

    /// Returns the ink for a colour; the pixel's column `x` and row `y` select the dither
    /// threshold.
    pub(super) fn ink_at(&mut self, color: Srgb8, x: usize, y: usize) -> Ink {
        match self {
            Self::Monochrome(_) => Ink::Default,
            Self::Indexed(palette, _) => Ink::Indexed(palette.index(color, x, y)),
            Self::Truecolor => Ink::Rgb(color),
        }
    }

    /// Returns the background on which characters are drawn: black, or the default background if
    /// there are no colours.
    pub(super) fn background(&self) -> Ink {
        match self {
            Self::Monochrome(_) => Ink::Default,
            Self::Indexed(_, black) => Ink::Indexed(*black),
            Self::Truecolor => Ink::Rgb(Srgb8::new(0, 0, 0)),
        }
    }
}
