//! ASCII by shape: the character whose ink lies where the picture has its light.
//!
//! Cells and glyphs are compared as seen from some distance, where a character blurs into its neighbours: by eight
//! samples of each after a blur. Without the blur, a glyph that fits a cell in detail wins over one of the right
//! lightness, and the picture gets dark and spotty.

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
    plain: None,
    fill: Fill::Lightness(fill),
};

const SAMPLES: usize = SAMPLE_COLUMNS * SAMPLE_ROWS;
/// One sample for each part of a cell, row by row from the top.
type Samples = [f32; SAMPLES];

/// Fills each cell by its samples.
fn fill(grid: &mut Grid, picture: &Picture) {
    let matcher = &*MATCHER;
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let glyph = matcher.nearest(&samples(picture, column, row));
            *grid.cell_mut(column, row) = Cell::new(glyph, Ink::Default, Ink::Default);
        }
    }
}

/// Returns the lightness of a cell's pixels; beyond the picture's edge the edge is continued.
fn samples(picture: &Picture, column: u16, row: u16) -> Samples {
    let (left, top) = (usize::from(column) * SAMPLE_COLUMNS, usize::from(row) * SAMPLE_ROWS);
    let (last_x, last_y) = (picture.width as usize - 1, picture.height as usize - 1);
    std::array::from_fn(|at| {
        let (x, y) = ((left + at % SAMPLE_COLUMNS).min(last_x), (top + at / SAMPLE_COLUMNS).min(last_y));
        lightness(picture.pixels[y * picture.width as usize + x])
    })
}

/// Returns the approximate lightness of a pixel: the luma of the encoded channels, in 0..=1.
fn lightness(pixel: Srgb8) -> f32 {
    (0.2126 * f32::from(pixel.r) + 0.7152 * f32::from(pixel.g) + 0.0722 * f32::from(pixel.b)) / 255.0
}

const GLYPHS: usize = INK.len();

/// All glyphs, prepared for matching. After the blur, the squared distance of a glyph from samples `x` is its `square -
/// weights * x`, plus a term that is the same for all glyphs.
struct Matcher {
    /// For each sample, the weights of all glyphs, so that glyphs are compared in SIMD.
    weights: [[f32; GLYPHS]; SAMPLES],
    squares: [f32; GLYPHS],
}

static MATCHER: LazyLock<Matcher> = LazyLock::new(|| {
    let inks = INK.map(|ink| ink.map(|part| f32::from(part) / 255.0));
    // Scaled so that the densest glyph is white.
    let white = inks.iter().map(|ink| ink.iter().sum::<f32>() / SAMPLES as f32).fold(0.0, f32::max);
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

/// Returns samples after a Gaussian blur whose standard deviation is 0.35 of the cell's width, on a screen full of such
/// cells.
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

/// Returns the weights of a sample itself, the next one and so on, in a row that wraps around.
fn gaussian_weights<const N: usize>(deviation: f64) -> [f32; N] {
    let mut weights = [0.0; N];
    weights[0] = 1.0;
    for distance in 1..8 * N {
        let deviations = distance as f64 / deviation;
        let weight = libm::exp(-0.5 * deviations * deviations);
        // One to the right, one to the left.
        weights[distance % N] += weight;
        weights[(N - distance % N) % N] += weight;
    }
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| (weight / sum) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the character for a cell of rows of two pixels, each a letter from a (black) to z (white).
    fn character(pixels: &str) -> String {
        let grey = |letter: char| ((letter as u32 - 'a' as u32) * 255 / 25) as u8;
        let pixels = pixels.chars().map(|letter| Srgb8::new(grey(letter), grey(letter), grey(letter)));
        let [width, height] = [2, 4];
        let mut grid = Grid::new(crate::grid::Size::new(1, 1));
        fill(&mut grid, &Picture { width, height, pixels: pixels.collect() });
        grid.cell(0, 0).glyph.to_string()
    }

    /// A cell lit like a glyph's ink gets that glyph, or one with as much ink in the same places.
    #[test]
    fn a_glyph_stands_for_itself() {
        let white = INK.iter().map(|ink| ink.iter().map(|&part| u32::from(part)).sum::<u32>()).max().expect("95");
        let mut found = 0;
        for (character, ink) in (b' '..).zip(&INK) {
            let samples = ink.map(|part| f32::from(part) * SAMPLES as f32 / white as f32);
            found += usize::from(MATCHER.nearest(&samples) == char::from(character));
        }
        assert!(found >= 90, "{found} of 95");
    }

    #[test]
    fn ink_lies_where_the_light_is() {
        assert_eq!(character("aaaaaaaa"), " ");
        assert_eq!(character("zzzzzzzz"), "Q");
        // The first four samples are the upper half, every other one is on the left.
        for (pixels, lit) in [
            ("zzzzaaaa", [0, 1, 2, 3]),
            ("aaaazzzz", [4, 5, 6, 7]),
            ("zazazaza", [0, 2, 4, 6]),
            ("azazazaz", [1, 3, 5, 7]),
        ] {
            let character = character(pixels);
            let ink = INK[usize::from(character.as_bytes()[0] - b' ')];
            let sum = |is_lit| {
                (0..SAMPLES).filter(|&at| lit.contains(&at) == is_lit).map(|at| u32::from(ink[at])).sum::<u32>()
            };
            assert!(sum(true) > sum(false), "{pixels}: {character}");
        }
    }
}
