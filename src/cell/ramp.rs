//! The ASCII ramp: one of ten characters by lightness.
//!
//! The ramp replaces half blocks on terminals without colours, and is the most even kind for text that programs read.

use super::glyph_kind::{Fill, GlyphKind};
use super::pair;
use crate::color::{LinearRgb, Srgb8};
use crate::grid::{Cell, Grid, Ink};
use crate::tone::Picture;
use std::sync::LazyLock;

pub(super) const KIND: GlyphKind = GlyphKind {
    name: "ramp",
    help: "one of ten characters, by lightness",
    title: "characters by lightness",
    pixels_per_cell: (1, 2),
    has_blocks: false,
    colorless_glyphs: None,
    fill: Fill::Lightness(fill),
};

/// The characters of the ramp, from dark to light.
// The characters are in the order of their ink in `DejaVu` Sans Mono. Neither they nor the limits of their steps may
// change without a breaking release, because users' snapshots depend on them.
pub const RAMP: &[u8; 10] = b" .-:*+=%#@";

/// Fills each cell with the character of its pixels' mean luminance.
pub(super) fn fill(grid: &mut Grid, picture: &Picture) {
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let (upper, lower) = pair::pixels(picture, column, row);
            let luminance = lower.map_or(luminance(upper), |lower| 0.5 * (luminance(upper) + luminance(lower)));
            grid.set(column, row, &Cell::new(glyph(luminance), Ink::Default, Ink::Default));
        }
    }
}

fn luminance(pixel: Srgb8) -> f32 {
    LinearRgb::from_srgb8(pixel).luminance()
}

/// Returns the ramp's character for a luminance.
// All steps but the first and the last are equal in lightness L*, not in luminance, so that they look equal.
fn glyph(luminance: f32) -> char {
    let step = LUMINANCE_AT_STEP.iter().take_while(|&&least| luminance >= least).count();
    char::from(RAMP[step])
}

/// The least luminance of each character but the first: that of a lightness L* of 8, 18, ... 88.
// With 10, 20, ... 90 the rank correlation of light and ink inside objects was .81 to .85 in `teapot.obj`, which is
// dark; it is .86 to .90. Lower limits gain more on a dark background, and lose on a light one, which shows the
// negative: with 6, 16, ... 86 it was .91 and .78 at 80x24.
static LUMINANCE_AT_STEP: LazyLock<[f32; RAMP.len() - 1]> =
    LazyLock::new(|| std::array::from_fn(|k| luminance_from_lightness(0.08 + k as f64 / RAMP.len() as f64) as f32));

/// Returns the luminance Y of a lightness L* (CIE 1976), where white is 1 for both.
fn luminance_from_lightness(lightness: f64) -> f64 {
    if lightness > 0.08 { libm::pow((lightness + 0.16) / 1.16, 3.0) } else { lightness * 27.0 / 24_389.0 * 100.0 }
}

#[cfg(all(test, unit_tests))]
mod tests;
