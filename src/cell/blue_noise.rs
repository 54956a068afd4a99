//! Blue noise: dither thresholds without visible clusters.
//!
//! The thresholds are computed at the first use by void-and-cluster (Robert Ulichney, "The void-and-cluster method for
//! dither array generation", 1993), in integers and from a fixed seed, so that they are the same on every machine.

use std::sync::LazyLock;

/// Side in pixels of the square tile of thresholds, which is repeated over the picture.
// With 1024 pixels each of the 256 thresholds occurs four times, and the filter (radius 6) does not wrap around the
// tile onto itself.
const TILE_SIDE: usize = 32;
const TILE_PIXELS: usize = TILE_SIDE * TILE_SIDE;

/// Returns the dither threshold of a pixel, in 0..=255. In a tile each value occurs equally often.
pub(super) fn threshold(x: usize, y: usize) -> u8 {
    THRESHOLDS[y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE]
}

/// The thresholds of a tile, row by row.
static THRESHOLDS: LazyLock<[u8; TILE_PIXELS]> = LazyLock::new(|| {
    let mut thresholds = [0; TILE_PIXELS];
    for (rank, pixel) in ranked_pixels().into_iter().enumerate() {
        thresholds[pixel] = (rank * 256 / TILE_PIXELS) as u8; // less than 256
    }
    thresholds
});

/// Returns the tile's pixels in the order in which they light up as a flat grey gets lighter.
///
/// After the initial pattern, the next pixel is always the largest void: the dark pixel with the lowest density of lit
/// pixels around it.
fn ranked_pixels() -> Vec<usize> {
    let mut lit = initial_pattern();
    let mut dark = lit.clone();
    let mut order: Vec<usize> = Vec::with_capacity(TILE_PIXELS);
    // The pixels of the initial pattern are ordered backwards: the one that lights up last is the tightest cluster.
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

/// Returns a pattern of up to a tenth of the pixels, evenly spread by moving pixels from clusters
/// to voids.
fn initial_pattern() -> Pattern {
    let mut pattern = Pattern { is_lit: [false; TILE_PIXELS], density: [0; TILE_PIXELS] };
    // Random pixels by the linear congruential generator of Numerical Recipes. A better one is not needed, because the
    // moves below remove any structure.
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
        // If the largest void is the place that the pixel came from, no move improves the pattern.
        if to == from {
            return pattern;
        }
    }
}

/// A pattern of lit pixels, and the filtered density of lit pixels around each pixel.
#[derive(Clone)]
struct Pattern {
    is_lit: [bool; TILE_PIXELS],
    density: [i32; TILE_PIXELS],
}

impl Pattern {
    /// Lights a dark pixel, or clears a lit one.
    fn toggle(&mut self, pixel: usize) {
        self.is_lit[pixel] ^= true;
        let sign = if self.is_lit[pixel] { 1 } else { -1 };
        let (x, y) = (pixel % TILE_SIDE, pixel / TILE_SIDE);
        for (at, density) in self.density.iter_mut().enumerate() {
            // The Gaussian is separable. Integer sums are exact, so that ties are decided equally on every machine.
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

/// Returns the distance between two columns (or rows) of the tile, which wraps around.
fn wrapped_distance(a: usize, b: usize) -> usize {
    let distance = a.abs_diff(b);
    distance.min(TILE_SIDE - distance)
}

/// The weights of the Gaussian filter by distance `d` in pixels: `10,000 exp(-d^2 / 4.5)`.
///
/// The standard deviation of 1.5 pixels is the one that Ulichney proposes.
const GAUSSIAN: [i32; TILE_SIDE / 2 + 1] = [10_000, 8_007, 4_111, 1_353, 286, 39, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

#[cfg(all(test, unit_tests))]
mod tests;
