//! Dithering to black and white: the pixels that are lit on a terminal without colours.

use super::blue_noise::threshold;
use crate::color::{Srgb8, linear_from_srgb};
use std::sync::LazyLock;

/// Number of levels per channel to which colours are dithered first.
const LEVELS: usize = 32;

/// The linear light of each level.
static LIGHT: LazyLock<[f32; LEVELS]> =
    LazyLock::new(|| std::array::from_fn(|level| linear_from_srgb(level as f64 / (LEVELS - 1) as f64) as f32));

/// Returns whether the pixel at column `x` and row `y` of the screen is lit.
///
/// A share of the pixels of one colour is lit, in sixteenths and spread by blue noise: none of the darkest colour, all
/// of the lightest one.
// A sixteenth of the pixels is lit from a mean light of 0.05 on, and another one for each 0.06 more. These are the
// steps of mixes in which each of sixteen pixels compensates 0.6 of the error of those before it. They are calmer than
// steps of a sixteenth (0.0625): shadows and highlights have no single dots.
pub(super) fn is_lit(color: Srgb8, x: usize, y: usize) -> bool {
    // A channel between two levels is dithered to one of them, by a threshold that is read at a distant place of the
    // tile, because equal thresholds would correlate.
    let between = usize::from(threshold(x + 13, y + 19)).min(254);
    let light = |code: u8| LIGHT[(usize::from(code) * (LEVELS - 1) + between) / 255];
    let mean = (light(color.r) + light(color.g) + light(color.b)) / 3.0;
    f32::from(16 - threshold(x, y) / 16) <= (mean + 0.01) / 0.06
}
