//! Few colours: each pixel's is mixed from those that there are, which lie side by side on the screen.
//!
//! A mix is sixteen colours of the palette whose light has nearly the wanted mean (after Thomas Knoll's pattern dithering,
//! US patent 6,606,166, expired), because light is what the eye adds up. They go from dark to light, and which of them a
//! pixel gets is decided by the blue noise at its place: a picture that stands still stays as it is.

use super::blue_noise::threshold;
use super::colors::xterm_color;
use crate::color::{LinearRgb, Srgb8, linear_from_srgb};

/// Colours with a number, and what has been mixed from them so far.
pub(super) struct Palette {
    candidates: Candidates,
    /// By the three steps of the colour, once it has been needed.
    mixes: Vec<Option<Mix>>,
}

/// The colours that a mix may be made of.
enum Candidates {
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

impl Candidate {
    fn new(index: u8, color: Srgb8) -> Self {
        Self { index, light: LinearRgb::from_srgb8(color) }
    }
}

/// Indices of the palette, from dark to light.
type Mix = [u8; 16];

/// Mixes are kept for so many values of a band; a value between two is dithered to them.
const STEPS: usize = 32;

impl Palette {
    /// The colours of 256 that users do not change.
    pub(super) fn cube() -> Self {
        Self::of(Candidates::Cube(Cube::new()))
    }

    /// These colours, with the numbers of their places.
    pub(super) fn few(colors: &[Srgb8]) -> Self {
        Self::of(Candidates::Few((0..).zip(colors).map(|(index, &color)| Candidate::new(index, color)).collect()))
    }

    fn of(candidates: Candidates) -> Self {
        Self { candidates, mixes: vec![None; STEPS * STEPS * STEPS] }
    }

    /// The number of the colour that stands for this one in that pixel of the screen.
    pub(super) fn index(&mut self, color: Srgb8, x: usize, y: usize) -> u8 {
        // Far enough away in the tile to have nothing to do with the other threshold.
        let between = usize::from(threshold(x + 13, y + 19)).min(254);
        let step = |code: u8| (usize::from(code) * (STEPS - 1) + between) / 255;
        let steps = [color.r, color.g, color.b].map(step);
        let candidates = &self.candidates;
        let mix =
            self.mixes[(steps[0] * STEPS + steps[1]) * STEPS + steps[2]].get_or_insert_with(|| candidates.mix(steps));
        mix[usize::from(threshold(x, y)) * mix.len() / 256]
    }
}

impl Candidates {
    fn mix(&self, steps: [usize; 3]) -> Mix {
        let [r, g, b] = steps.map(|step| linear_from_srgb(step as f64 / (STEPS - 1) as f64) as f32);
        let light = LinearRgb::new(r, g, b);
        match self {
            Self::Cube(cube) => mix(light, &cube.around(light)),
            Self::Few(candidates) => mix(light, candidates),
        }
    }
}

/// How much of what a mix lacks the next colour makes up for. All of it would give the exact mean by colours far from it,
/// which is seen before it is.
const MADE_UP: f32 = 0.6;

/// Colours whose mean is near the light.
fn mix(light: LinearRgb, candidates: &[Candidate]) -> Mix {
    let mut lacks = LinearRgb::BLACK;
    let mut chosen = [candidates[0]; 16];
    for place in &mut chosen {
        *place = nearest(light + lacks * MADE_UP, candidates);
        lacks += light + place.light * -1.0;
    }
    chosen.sort_by(|a, b| a.light.luminance().total_cmp(&b.light.luminance()));
    chosen.map(|candidate| candidate.index)
}

/// There is one candidate at least.
fn nearest(wanted: LinearRgb, candidates: &[Candidate]) -> Candidate {
    let distance = |candidate: &Candidate| {
        let LinearRgb { r, g, b } = wanted + candidate.light * -1.0;
        r * r + g * g + b * b
    };
    let mut nearest = candidates[0];
    for candidate in &candidates[1..] {
        if distance(candidate) < distance(&nearest) {
            nearest = *candidate;
        }
    }
    nearest
}

/// The cube of six levels to a band (16..=231) and the greys between black and white (232..=255).
struct Cube {
    levels: [f32; 6],
    greys: [f32; 24],
    /// From number 16 on.
    colors: Vec<Candidate>,
}

impl Cube {
    fn new() -> Self {
        let light = |index: usize| LinearRgb::from_srgb8(xterm_color(index as u8));
        Self {
            levels: std::array::from_fn(|level| light(16 + level).b),
            greys: std::array::from_fn(|grey| light(232 + grey).r),
            colors: (16..=255).map(|index| Candidate::new(index, xterm_color(index))).collect(),
        }
    }

    /// The eight corners of the box of levels that the light is in, and the two greys about its luminance: what is mixed
    /// from colours near each other is the least grainy.
    fn around(&self, light: LinearRgb) -> [Candidate; 10] {
        let [r, g, b] = [light.r, light.g, light.b].map(|band| below(&self.levels, band));
        let grey = below(&self.greys, light.luminance());
        std::array::from_fn(|k| match k {
            8.. => self.colors[216 + grey + k - 8],
            corner => self.colors[36 * (r + corner / 4) + 6 * (g + corner / 2 % 2) + b + corner % 2],
        })
    }
}

/// The last level that is not above the band, but the highest, so that another follows.
fn below(levels: &[f32], band: f32) -> usize {
    levels[1..levels.len() - 1].iter().take_while(|&&level| level <= band).count()
}
