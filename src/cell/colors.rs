//! The sets of colours that a terminal's cells may have.

use crate::color::{Oklab, Srgb8};
use crate::grid::Ink;

/// A set of colours, ordered by the number of colours.
///
/// ```
/// use termtrace::Colors;
///
/// assert!(Colors::None < Colors::Indexed256 && Colors::Indexed256 < Colors::Truecolor);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Colors {
    /// The terminal's two default colours; no colour sequence is sent.
    None,
    /// The first sixteen palette colours, with the sRGB values that the terminal's theme gives
    /// them.
    Indexed16([Srgb8; 16]),
    /// The 240 palette colours that themes leave alone.
    ///
    /// These are a cube of six levels per channel and 24 greys, whose sRGB values are the same in all terminals.
    Indexed256,
    /// Every 8-bit sRGB colour.
    Truecolor,
}

impl Colors {
    /// Sixteen colours with xterm's default values.
    #[doc(hidden)]
    pub const SIXTEEN: Self = Self::Indexed16(XTERM_16);
}

/// The inks of characters: the nearest one for each colour, as characters cannot be dithered.
pub(super) struct TextInks {
    colors: Colors,
    /// The sixteen colours of a terminal that has only those; else empty.
    // Converted once per frame, because the conversion of 16 colours takes about a microsecond.
    sixteen: Vec<Oklab>,
}

impl TextInks {
    pub(super) fn of(colors: Colors) -> Self {
        let sixteen = match colors {
            Colors::Indexed16(values) => values.map(Oklab::from_srgb8).into(),
            _ => Vec::new(),
        };
        Self { colors, sixteen }
    }

    pub(super) fn are_default(&self) -> bool {
        self.colors == Colors::None
    }

    /// Returns the ink that is nearest to a colour.
    pub(super) fn nearest(&self, color: Srgb8) -> Ink {
        match self.colors {
            Colors::None => Ink::Default,
            Colors::Truecolor => Ink::Rgb(color),
            Colors::Indexed256 => {
                // The index of the nearest level: the number of midpoints between neighbouring levels below the
                // channel.
                let level = |channel: u8| LEVELS.windows(2).filter(|pair| channel > pair[0].midpoint(pair[1])).count();
                let [r, g, b] = [color.r, color.g, color.b].map(level);
                Ink::Indexed((16 + 36 * r + 6 * g + b) as u8)
            }
            Colors::Indexed16(_) => {
                let wanted = Oklab::from_srgb8(color);
                // Lightness counts half, because the hue tells objects apart.
                let distance = |&Oklab { l, a, b }: &Oklab| {
                    let (l, a, b) = (0.5 * (l - wanted.l), a - wanted.a, b - wanted.b);
                    l * l + a * a + b * b
                };
                let distances = self.sixteen.iter().map(distance).enumerate();
                Ink::Indexed(distances.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(index, _)| index as u8))
            }
        }
    }
}

/// The levels of a channel in the cube of the 256 palette colours.
const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];

/// xterm's default values of the first sixteen palette colours.
// These values are assumed until the terminal reports its own (OSC 4).
const XTERM_16: [Srgb8; 16] = [
    Srgb8::new(0, 0, 0),
    Srgb8::new(205, 0, 0),
    Srgb8::new(0, 205, 0),
    Srgb8::new(205, 205, 0),
    Srgb8::new(0, 0, 238),
    Srgb8::new(205, 0, 205),
    Srgb8::new(0, 205, 205),
    Srgb8::new(229, 229, 229),
    Srgb8::new(127, 127, 127),
    Srgb8::new(255, 0, 0),
    Srgb8::new(0, 255, 0),
    Srgb8::new(255, 255, 0),
    Srgb8::new(92, 92, 255),
    Srgb8::new(255, 0, 255),
    Srgb8::new(0, 255, 255),
    Srgb8::new(255, 255, 255),
];

/// Returns xterm's default sRGB value of a palette colour.
///
/// Colours 0..=15 vary with the theme, 16..=231 are a cube of six levels per channel, and 232..=255 are greys.
pub(crate) fn xterm_color(index: u8) -> Srgb8 {
    match index {
        0..16 => XTERM_16[usize::from(index)],
        16..232 => {
            let [r, g, b] = [36, 6, 1].map(|step| LEVELS[usize::from((index - 16) / step % 6)]);
            Srgb8::new(r, g, b)
        }
        232.. => {
            let grey = 8 + 10 * (index - 232);
            Srgb8::new(grey, grey, grey)
        }
    }
}
