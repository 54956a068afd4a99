//! Blue noise: thresholds for dithering that never clump.
//!
//! Made by void and cluster (Robert Ulichney, "The void-and-cluster method for dither array generation", 1993) in
//! integers from a fixed seed, so that it is the same on every machine, when it is first needed.

use std::sync::LazyLock;

/// Side of the tile in pixels, after which the pattern repeats.
const TILE_SIDE: usize = 32;
const TILE_PIXELS: usize = TILE_SIDE * TILE_SIDE;

/// Returns the threshold of a pixel. In a tile each of 0..=255 occurs equally often.
pub(super) fn threshold(x: usize, y: usize) -> u8 {
    THRESHOLDS[y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE]
}

static THRESHOLDS: LazyLock<[u8; TILE_PIXELS]> = LazyLock::new(|| {
    let mut thresholds = [0; TILE_PIXELS];
    for (rank, pixel) in ranked_pixels().into_iter().enumerate() {
        thresholds[pixel] = (rank * 256 / TILE_PIXELS) as u8; // less than 256
    }
    thresholds
});

/// Returns the pixels in the order in which they light up as a flat grey gets lighter: each time the one farthest from
/// all lit ones.
fn ranked_pixels() -> Vec<usize> {
    let mut lit = initial_pattern();
    let mut dark = lit.clone();
    let mut order: Vec<usize> = Vec::with_capacity(TILE_PIXELS);
    // Backwards from there: the last one to light up was the most crowded.
    while let Some(pixel) = dark.tightest_cluster() {
        dark.toggle(pixel);
        order.push(pixel);
    }
    order.reverse();
    while let Some(pixel) = lit.largest_void() {
        lit.toggle(pixel);
        order.push(pixel);
    }
    order
}

/// Returns a tenth of the pixels, moved from clusters into voids until no move helps.
fn initial_pattern() -> Pattern {
    let mut pattern = Pattern { is_lit: [false; TILE_PIXELS], density: [0; TILE_PIXELS] };
    // The quick and dirty generator of Numerical Recipes: any start will do.
    let mut state = 1_u32;
    for _ in 0..TILE_PIXELS / 10 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let pixel = (state >> 16) as usize % TILE_PIXELS;
        if !pattern.is_lit[pixel] {
            pattern.toggle(pixel);
        }
    }
    loop {
        let Some(from) = pattern.tightest_cluster() else { return pattern };
        pattern.toggle(from);
        let Some(to) = pattern.largest_void() else { return pattern };
        pattern.toggle(to);
        if to == from {
            return pattern;
        }
    }
}

/// The lit pixels, and how crowded each pixel is by them.
#[derive(Clone)]
struct Pattern {
    is_lit: [bool; TILE_PIXELS],
    density: [i32; TILE_PIXELS],
}

impl Pattern {
    /// Sets or clears a pixel.
    fn toggle(&mut self, pixel: usize) {
        self.is_lit[pixel] ^= true;
        let sign = if self.is_lit[pixel] { 1 } else { -1 };
        let (x, y) = (pixel % TILE_SIDE, pixel / TILE_SIDE);
        for (at, density) in self.density.iter_mut().enumerate() {
            *density +=
                sign * GAUSSIAN[wrapped_distance(y, at / TILE_SIDE)] * GAUSSIAN[wrapped_distance(x, at % TILE_SIDE)];
        }
    }

    fn tightest_cluster(&self) -> Option<usize> {
        (0..TILE_PIXELS).filter(|&pixel| self.is_lit[pixel]).max_by_key(|&pixel| self.density[pixel])
    }

    fn largest_void(&self) -> Option<usize> {
        (0..TILE_PIXELS).filter(|&pixel| !self.is_lit[pixel]).min_by_key(|&pixel| self.density[pixel])
    }
}

/// Returns the distance of two columns or rows of the repeating pattern.
fn wrapped_distance(a: usize, b: usize) -> usize {
    let distance = a.abs_diff(b);
    distance.min(TILE_SIDE - distance)
}

/// Returns a Gaussian of 1.5 pixels, Ulichney's choice: `10,000 exp(-d^2 / 4.5)`.
const GAUSSIAN: [i32; TILE_SIDE / 2 + 1] = [10_000, 8_007, 4_111, 1_353, 286, 39, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_threshold_comes_as_often() {
        let mut counts = [0; 256];
        THRESHOLDS.iter().for_each(|&threshold| counts[usize::from(threshold)] += 1);
        assert_eq!(counts, [TILE_PIXELS / 256; 256]);
    }

    /// Blue noise has almost nothing in the means of blocks; white noise has 74 / 4 = 18 there.
    #[test]
    fn the_noise_is_blue() {
        let mean = |x: usize, y: usize| {
            let block = (0..16).map(|k| f64::from(threshold(x + k % 4, y + k / 4)));
            block.sum::<f64>() / 16.0 - 127.5
        };
        let square = |x: f64| x * x;
        let sum: f64 = (0..TILE_PIXELS).map(|at| square(mean(at % TILE_SIDE, at / TILE_SIDE))).sum();
        let deviation = (sum / TILE_PIXELS as f64).sqrt();
        assert!(deviation < 10.0, "{deviation}");
    }
}
