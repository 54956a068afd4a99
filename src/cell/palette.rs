//! Few colours: each pixel's is mixed from those that there are, which lie side by side on the screen.
//!
//! A mix is sixteen colours of the palette whose light has the wanted mean (after Thomas Knoll's pattern dithering,
//! US patent 6,606,166, expired; in linear light, because light is what the eye adds up), from dark to light. Which of
//! them a pixel gets is decided by the blue noise at its place: a picture that stands still stays as it is.

use super::blue_noise::threshold;
use crate::color::{LinearRgb, Srgb8, linear_from_srgb};

/// Colours with a number, and what has been mixed from them so far.
pub(super) struct Palette {
    kind: Kind,
    /// By the three steps of the colour, once it has been needed.
    mixes: Vec<Option<Mix>>,
}

enum Kind {
    /// The cube and the greys of 256 colours.
    Cube(Cube),
    /// Those that there are, from number 0 on.
    Few(Vec<Candidate>),
}

/// A colour of the palette.
#[derive(Clone, Copy)]
struct Candidate {
    index: u8,
    light: LinearRgb,
}

/// Indices of the palette, from dark to light.
type Mix = [u8; 16];

/// Mixes are kept for so many values of a band; a value between two is dithered to them.
const STEPS: usize = 32;

impl Palette {
    /// The colours of 256 that users do not change.
    pub(super) fn cube() -> Self {
        Self::of(Kind::Cube(Cube::new()))
    }

    /// These colours, with the numbers of their places.
    pub(super) fn few(colors: &[Srgb8]) -> Self {
        let candidates =
            (0..).zip(colors).map(|(index, &color)| Candidate { index, light: LinearRgb::from_srgb8(color) });
        Self::of(Kind::Few(candidates.collect()))
    }

    fn of(kind: Kind) -> Self {
        Self { kind, mixes: vec![None; STEPS * STEPS * STEPS] }
    }

    /// The number of the colour that stands for this one in that pixel of the screen.
    pub(super) fn index(&mut self, color: Srgb8, x: usize, y: usize) -> u8 {
        // Far enough away in the tile to have nothing to do with the other threshold.
        let between = usize::from(threshold(x + 13, y + 19)).min(254);
        let step = |code: u8| (usize::from(code) * (STEPS - 1) + between) / 255;
        let steps = [color.r, color.g, color.b].map(step);
        let kind = &self.kind;
        let mix = self.mixes[(steps[0] * STEPS + steps[1]) * STEPS + steps[2]].get_or_insert_with(|| kind.mix(steps));
        mix[usize::from(threshold(x, y)) * mix.len() / 256]
    }
}

impl Kind {
    fn mix(&self, steps: [usize; 3]) -> Mix {
        let [r, g, b] = steps.map(|step| linear_from_srgb(step as f64 / (STEPS - 1) as f64) as f32);
        let light = LinearRgb::new(r, g, b);
        match self {
            Self::Cube(cube) => mix(light, &cube.around(light)),
            Self::Few(candidates) => mix(light, candidates),
        }
    }
}

/// Colours whose mean is the nearest to the light: each makes up for what those before it have left.
fn mix(light: LinearRgb, candidates: &[Candidate]) -> Mix {
    let mut left = LinearRgb::BLACK;
    let mut chosen = [candidates[0]; 16];
    for place in &mut chosen {
        left += light;
        let nearer = |a: &&Candidate, b: &&Candidate| square(left, a.light).total_cmp(&square(left, b.light));
        *place = *candidates.iter().min_by(nearer).unwrap_or(place);
        left += place.light * -1.0;
    }
    chosen.sort_by(|a, b| a.light.luminance().total_cmp(&b.light.luminance()));
    chosen.map(|candidate| candidate.index)
}

/// The square of the distance between two lights.
fn square(a: LinearRgb, b: LinearRgb) -> f32 {
    let LinearRgb { r, g, b } = a + b * -1.0;
    r * r + g * g + b * b
}

/// The cube of six levels to a band (16..=231) and the greys between black and white (232..=255).
struct Cube {
    levels: [f32; 6],
    greys: [f32; 24],
}

impl Cube {
    fn new() -> Self {
        let linear = |code: usize| linear_from_srgb(code as f64 / 255.0) as f32;
        Self {
            levels: [0, 95, 135, 175, 215, 255].map(linear),
            greys: std::array::from_fn(|grey| linear(8 + 10 * grey)),
        }
    }

    /// The eight corners of the box of levels that the light is in, and the two greys about its luminance: what is mixed
    /// from colours near each other is the least grainy.
    fn around(&self, light: LinearRgb) -> [Candidate; 10] {
        let bands = [light.r, light.g, light.b].map(|band| below(&self.levels, band));
        let grey = below(&self.greys, light.luminance());
        std::array::from_fn(|k| match k {
            8.. => self.grey(grey + k - 8),
            corner => self.corner([bands[0] + (corner & 1), bands[1] + (corner >> 1 & 1), bands[2] + (corner >> 2)]),
        })
    }

    fn corner(&self, [r, g, b]: [usize; 3]) -> Candidate {
        let index = (16 + 36 * r + 6 * g + b) as u8; // levels are 0..=5
        Candidate { index, light: LinearRgb::new(self.levels[r], self.levels[g], self.levels[b]) }
    }

    fn grey(&self, grey: usize) -> Candidate {
        Candidate { index: 232 + grey as u8, light: LinearRgb::grey(self.greys[grey]) } // greys are 0..=23
    }
}

/// The last level that is not above the band, but the highest, so that another follows.
fn below(levels: &[f32], band: f32) -> usize {
    levels[1..levels.len() - 1].iter().take_while(|&&level| level <= band).count()
}
