//! Dithering to few colours.
//!
//! A mix is sixteen colours of the palette whose light has nearly the wanted mean (after Thomas Knoll's pattern
//! dithering, US patent 6,606,166, expired), because the eye adds light. They are sorted from dark to light, and the
//! blue noise at a pixel decides which of them it gets, so that a still picture does not flicker.

use super::blue_noise::threshold;
use super::colors::xterm_color;
use crate::color::{LinearRgb, Srgb8, linear_from_srgb};

/// A palette, with a cache of mixes.
pub(super) struct Palette {
    candidates: Candidates,
    /// Mixes by the three quantised channels of the colour, computed when first needed.
    mixes: Vec<Option<Mix>>,
}

/// The colours that mixes may use.
enum Candidates {
    /// The cube and the greys of the 256 colours.
    Cube(Cube),
    /// A list of colours, numbered from 0.
    List(Vec<Candidate>),
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

/// Indices into the palette, from dark to light.
type Mix = [u8; 16];

/// Number of levels per channel for which mixes are cached; a value between two levels is dithered to them.
const CACHE_LEVELS: usize = 32;

impl Palette {
    /// Returns the palette of the 240 colours that users do not change.
    pub(super) fn cube() -> Self {
        Self::of(Candidates::Cube(Cube::new()))
    }

    /// Returns a palette of these colours, numbered by their index.
    pub(super) fn from_colors(colors: &[Srgb8]) -> Self {
        Self::of(Candidates::List((0..).zip(colors).map(|(index, &color)| Candidate::new(index, color)).collect()))
    }

    fn of(candidates: Candidates) -> Self {
        Self { candidates, mixes: vec![None; CACHE_LEVELS * CACHE_LEVELS * CACHE_LEVELS] }
    }

    /// Returns the number of the colour for this pixel of the screen.
    pub(super) fn index(&mut self, color: Srgb8, x: usize, y: usize) -> u8 {
        // Far enough away in the tile to be independent of the other threshold.
        let between = usize::from(threshold(x + 13, y + 19)).min(254);
        let step = |code: u8| (usize::from(code) * (CACHE_LEVELS - 1) + between) / 255;
        let steps = [color.r, color.g, color.b].map(step);
        let candidates = &self.candidates;
        let mix = self.mixes[(steps[0] * CACHE_LEVELS + steps[1]) * CACHE_LEVELS + steps[2]]
            .get_or_insert_with(|| candidates.mix(steps));
        mix[usize::from(threshold(x, y)) * mix.len() / 256]
    }
}

impl Candidates {
    fn mix(&self, steps: [usize; 3]) -> Mix {
        let [r, g, b] = steps.map(|step| linear_from_srgb(step as f64 / (CACHE_LEVELS - 1) as f64) as f32);
        let light = LinearRgb::new(r, g, b);
        match self {
            Self::Cube(cube) => mix(light, &cube.neighbours(light)),
            Self::List(candidates) => mix(light, candidates),
        }
    }
}

/// Share of a mix's remaining error that the next colour compensates. The full error would give the exact mean, by
/// colours far from it, which look worse than a slightly wrong mean.
const ERROR_FEEDBACK: f32 = 0.6;

/// Returns colours whose mean is near the light.
fn mix(light: LinearRgb, candidates: &[Candidate]) -> Mix {
    let mut error = LinearRgb::BLACK;
    let mut chosen = [candidates[0]; 16];
    for slot in &mut chosen {
        *slot = nearest(light + error * ERROR_FEEDBACK, candidates);
        error += light + slot.light * -1.0;
    }
    chosen.sort_by(|a, b| a.light.luminance().total_cmp(&b.light.luminance()));
    chosen.map(|candidate| candidate.index)
}

/// There is at least one candidate.
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

/// The cube of six levels per channel (16..=231) and the greys between black and white (232..=255).
struct Cube {
    levels: [f32; 6],
    greys: [f32; 24],
    /// The colours from number 16 on.
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

    /// Returns the eight corners of the cell of levels around the light, and the two greys around its luminance: mixes
    /// of near colours have the least grain.
    fn neighbours(&self, light: LinearRgb) -> [Candidate; 10] {
        let [r, g, b] = [light.r, light.g, light.b].map(|channel| level_below(&self.levels, channel));
        let grey = level_below(&self.greys, light.luminance());
        std::array::from_fn(|k| match k {
            8.. => self.colors[216 + grey + k - 8],
            corner => self.colors[36 * (r + corner / 4) + 6 * (g + corner / 2 % 2) + b + corner % 2],
        })
    }
}

/// Returns the highest level not above the channel, except the last one, so that another follows.
fn level_below(levels: &[f32], channel: f32) -> usize {
    levels[1..levels.len() - 1].iter().take_while(|&&level| level <= channel).count()
}
