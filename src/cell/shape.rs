//! ASCII by shape: the character whose ink is distributed most like the light of the cell.
//!
//! Cells and glyphs are compared by eight samples each, after a blur that simulates viewing from a distance, where a
//! character merges with its neighbours. Without the blur, glyphs that match details are preferred over glyphs of the
//! right lightness, and the picture becomes dark and spotty.

use super::glyph_kind::{Fill, GlyphKind};
use crate::color::Srgb8;
use crate::grid::{Cell, Grid, Ink};
use crate::tone::Picture;
use std::sync::LazyLock;

mod glyphs;

use glyphs::{INK, SAMPLE_COLUMNS, SAMPLE_ROWS};

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "shape",
    help: "the character of ASCII that has its ink where the picture has its light",
    title: "characters by shape",
    pixels_per_cell: (SAMPLE_COLUMNS as u32, SAMPLE_ROWS as u32),
    has_blocks: false,
    colorless_glyphs: None,
    fill: Fill::Lightness(fill),
};

const SAMPLES: usize = SAMPLE_COLUMNS * SAMPLE_ROWS;
/// The lightness of a cell's eight samples, row by row from the top, each in 0..=1.
type Samples = [f32; SAMPLES];

/// Sets each cell's glyph to the one whose ink is nearest to the cell's samples.
fn fill(grid: &mut Grid, picture: &Picture) {
    let matcher = &*MATCHER;
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let glyph = matcher.nearest(&samples(picture, column, row));
            grid.set(column, row, &Cell::new(glyph, Ink::Default, Ink::Default));
        }
    }
}

/// Returns the lightness of a cell's eight pixels; beyond the picture's edge its last pixels are
/// repeated.
fn samples(picture: &Picture, column: u16, row: u16) -> Samples {
    let (left, top) = (usize::from(column) * SAMPLE_COLUMNS, usize::from(row) * SAMPLE_ROWS);
    let (last_x, last_y) = (picture.width() as usize - 1, picture.height() as usize - 1);
    std::array::from_fn(|at| {
        let (x, y) = ((left + at % SAMPLE_COLUMNS).min(last_x), (top + at / SAMPLE_COLUMNS).min(last_y));
        lightness(picture.pixels()[y * picture.width() as usize + x])
    })
}

/// Returns the luma of a pixel (the weighted sum of its encoded channels) in 0..=1.
// Luma approximates lightness without computing a power, and its error is below the differences between glyphs.
fn lightness(pixel: Srgb8) -> f32 {
    (0.2126 * f32::from(pixel.r) + 0.7152 * f32::from(pixel.g) + 0.0722 * f32::from(pixel.b)) / 255.0
}

const GLYPHS: usize = INK.len();

/// The precomputed part of the distances between cells and glyphs.
///
/// After the blur, the squared distance of a glyph from samples `x` is the glyph's `square`, minus the dot product of
/// its weights and `x`, plus a term that is the same for all glyphs.
struct Matcher {
    /// For each sample, the weights of all glyphs.
    // With the glyphs as the inner dimension, the loop over them is vectorised, and a cell takes 0.3 to 0.4 us instead
    // of 0.6.
    weights: [[f32; GLYPHS]; SAMPLES],
    /// For each glyph, the sum of its ink times its blurred ink.
    squares: [f32; GLYPHS],
}

static MATCHER: LazyLock<Matcher> = LazyLock::new(|| {
    let inks = INK.map(|ink| ink.map(|part| f32::from(part) / 255.0));
    // The scale that makes the densest glyph (`@`, which covers 28 % of its cell) correspond to white.
    let white = inks.iter().map(|ink| ink.iter().sum::<f32>() / SAMPLES as f32).fold(0.0, f32::max);
    // Blurred twice, because the squared distance |B (ink - x)|^2 contains the symmetric blur B twice.
    let blurred_inks = inks.map(|ink| blurred(&blurred(&ink)));
    Matcher {
        weights: std::array::from_fn(|sample| blurred_inks.map(|ink| 2.0 * white * ink[sample])),
        squares: std::array::from_fn(|glyph| {
            inks[glyph].iter().zip(&blurred_inks[glyph]).map(|(ink, blurred)| ink * blurred).sum()
        }),
    }
});

impl Matcher {
    fn nearest(&self, samples: &Samples) -> char {
        let mut distances = self.squares;
        for (weights, sample) in self.weights.iter().zip(samples) {
            for (distance, weight) in distances.iter_mut().zip(weights) {
                *distance -= weight * sample;
            }
        }
        let mut nearest = (f32::INFINITY, b' ');
        for (character, distance) in (b' '..).zip(distances) {
            if distance < nearest.0 {
                nearest = (distance, character);
            }
        }
        char::from(nearest.1)
    }
}

/// Returns the samples after a Gaussian blur, as if all cells of the screen had the same samples.
///
/// The standard deviation is 0.35 of a cell's width, which is 0.175 of its height.
fn blurred(samples: &Samples) -> Samples {
    let across: [f32; SAMPLE_COLUMNS] = gaussian_weights(0.35 * SAMPLE_COLUMNS as f64);
    let down: [f32; SAMPLE_ROWS] = gaussian_weights(0.175 * SAMPLE_ROWS as f64);
    std::array::from_fn(|to| {
        let weight = |from: usize| {
            let (x, y) = (
                SAMPLE_COLUMNS + to % SAMPLE_COLUMNS - from % SAMPLE_COLUMNS,
                SAMPLE_ROWS + to / SAMPLE_COLUMNS - from / SAMPLE_COLUMNS,
            );
            across[x % SAMPLE_COLUMNS] * down[y % SAMPLE_ROWS]
        };
        samples.iter().enumerate().map(|(from, sample)| weight(from) * sample).sum()
    })
}

/// Returns the weights of a Gaussian, by distance, in a row of `N` samples that wraps around.
/// `deviation` is in samples.
fn gaussian_weights<const N: usize>(deviation: f64) -> [f32; N] {
    let mut weights = [0.0; N];
    weights[0] = 1.0;
    for distance in 1..8 * N {
        let deviations = distance as f64 / deviation;
        let weight = libm::exp(-0.5 * deviations * deviations);
        // Added twice: for the sample at this distance to the right and for the one to the left.
        weights[distance % N] += weight;
        weights[(N - distance % N) % N] += weight;
    }
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| (weight / sum) as f32)
}

#[cfg(all(test, unit_tests))]
mod tests;
