//! Ordered dithering to a palette.
//!
//! A mix is a list of sixteen palette colours whose mean light is near the wanted light (after Thomas Knoll's pattern
//! dithering, US patent 6,606,166, expired). The mean is taken in linear light, because the eye adds light. The colours
//! are sorted by luminance, and the blue-noise threshold of a pixel selects one of them. Unlike with error diffusion,
//! the colour of a pixel depends on that pixel only, so unchanged parts of a picture do not flicker and send no bytes.

use super::blue_noise::threshold;
use super::colors::xterm_color;
use crate::color::{LinearRgb, Srgb8, linear_from_srgb};

/// A palette with a cache of mixes.
pub(super) struct Palette {
    candidates: Candidates,
    /// A cache of mixes, indexed by a colour's three quantised channels and filled at the first use
    /// of each.
    mixes: Vec<Option<Mix>>,
}

/// The palette colours that a mix may use.
enum Candidates {
    /// The cube and the greys of the 256 palette colours.
    Cube(Cube),
    /// A list of colours with indices from 0.
    List(Vec<Candidate>),
}

/// A palette colour: its index and its linear light.
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

/// Sixteen palette indices, sorted by luminance.
type Mix = [u8; 16];

/// Number of levels per channel for which mixes are cached.
// A channel between two levels is dithered to one of them, so that 32 levels cause no bands. A pixel then takes two
// lookups; a cache of 256 levels would take 285 MB.
const CACHE_LEVELS: usize = 32;

impl Palette {
    /// Returns the palette of the 240 colours that themes leave alone.
    pub(super) fn cube() -> Self {
        Self::with_empty_cache(Candidates::Cube(Cube::new()))
    }

    /// Returns a palette of these colours. A colour's palette index is its position in the list.
    pub(super) fn from_colors(colors: &[Srgb8]) -> Self {
        Self::with_empty_cache(Candidates::List(
            (0..).zip(colors).map(|(index, &color)| Candidate::new(index, color)).collect(),
        ))
    }

    fn with_empty_cache(candidates: Candidates) -> Self {
        Self { candidates, mixes: vec![None; CACHE_LEVELS * CACHE_LEVELS * CACHE_LEVELS] }
    }

    /// Returns the palette index of a colour at a pixel of the screen.
    pub(super) fn index(&mut self, color: Srgb8, x: usize, y: usize) -> u8 {
        // Each pixel has two thresholds: `between` selects one of two cached levels, the other one a colour of the mix.
        // They are read at distant places of the tile, because equal thresholds would correlate.
        let between = usize::from(threshold(x + 13, y + 19)).min(254);
        let step = |code: u8| (usize::from(code) * (CACHE_LEVELS - 1) + between) / 255;
        let steps = [color.r, color.g, color.b].map(step);
        let candidates = &self.candidates;
        let mix = self.mixes[(steps[0] * CACHE_LEVELS + steps[1]) * CACHE_LEVELS + steps[2]]
            .get_or_insert_with(|| candidates.mix_for_levels(steps));
        mix[usize::from(threshold(x, y)) * mix.len() / 256]
    }
}

impl Candidates {
    fn mix_for_levels(&self, steps: [usize; 3]) -> Mix {
        let [r, g, b] = steps.map(|step| linear_from_srgb(step as f64 / (CACHE_LEVELS - 1) as f64) as f32);
        let light = LinearRgb::new(r, g, b);
        match self {
            Self::Cube(cube) => dithered_mix(light, &cube.neighbours(light)),
            Self::List(candidates) => dithered_mix(light, candidates),
        }
    }
}

/// Share of the error of the colours chosen so far that the next colour of a mix compensates.
// With 1 the mean of the mix is exact, but its colours are far from the wanted one, which is visible as grain. With 0.6
// they are nearer, and from a distance the picture still looks right: after a blur, its mean OKLab difference from the
// wanted picture is 0.0056 with 256 colours and 0.0137 with 16.
const ERROR_FEEDBACK: f32 = 0.6;

/// Returns a mix whose mean is near the wanted light.
fn dithered_mix(light: LinearRgb, candidates: &[Candidate]) -> Mix {
    let mut error = LinearRgb::BLACK;
    let mut chosen = [candidates[0]; 16];
    for slot in &mut chosen {
        *slot = nearest(light + error * ERROR_FEEDBACK, candidates);
        error += light + slot.light * -1.0;
    }
    chosen.sort_by(|a, b| a.light.luminance().total_cmp(&b.light.luminance()));
    chosen.map(|candidate| candidate.index)
}

/// Returns the candidate nearest to the wanted light, by distance in linear light.
///
/// # Panics
/// If there are no candidates.
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
    /// The 240 palette colours from index 16 on.
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

    /// Returns the eight corners of the cube cell that contains the light, and the greys below and
    /// above it.
    // Ten near colours instead of all 240, because mixes of near colours have the least grain and are found faster.
    fn neighbours(&self, light: LinearRgb) -> [Candidate; 10] {
        let [r, g, b] = [light.r, light.g, light.b].map(|channel| level_below(&self.levels, channel));
        let grey = level_below(&self.greys, light.luminance());
        std::array::from_fn(|k| match k {
            8.. => self.colors[216 + grey + k - 8],
            corner => self.colors[36 * (r + corner / 4) + 6 * (g + corner / 2 % 2) + b + corner % 2],
        })
    }
}

/// Returns the index of the highest of the `levels` up to `channel`, but never the last, so that a
/// level follows.
fn level_below(levels: &[f32], channel: f32) -> usize {
    levels[1..levels.len() - 1].iter().take_while(|&&level| level <= channel).count()
}
