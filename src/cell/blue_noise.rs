//! Blue noise: thresholds for dithering that never clump.
//!
//! Made by void and cluster (Robert Ulichney, "The void-and-cluster method for dither array generation", 1993) in
//! integers from a fixed seed, so that it is the same on every machine, when it is first needed.

use std::sync::LazyLock;

/// Side of the tile in pixels, after which the pattern repeats.
const SIDE: usize = 32;
const PLACES: usize = SIDE * SIDE;

/// Returns the threshold of a pixel. In a tile each of 0..=255 occurs equally often.
pub(super) fn threshold(x: usize, y: usize) -> u8 {
    TILE[y % SIDE * SIDE + x % SIDE]
}

static TILE: LazyLock<[u8; PLACES]> = LazyLock::new(|| {
    let mut thresholds = [0; PLACES];
    for (rank, place) in order().into_iter().enumerate() {
        thresholds[place] = (rank * 256 / PLACES) as u8; // less than 256
    }
    thresholds
});

/// Returns the pixels in the order in which they light up as a flat grey gets lighter: each time the one farthest from
/// all lit ones.
fn order() -> Vec<usize> {
    let mut lit = evenly_lit();
    let mut dark = lit.clone();
    let mut order: Vec<usize> = Vec::with_capacity(PLACES);
    // Backwards from there: the last one to light up was the most crowded.
    while let Some(place) = dark.most_crowded() {
        dark.turn(place);
        order.push(place);
    }
    order.reverse();
    while let Some(place) = lit.emptiest() {
        lit.turn(place);
        order.push(place);
    }
    order
}

/// Returns a tenth of the pixels, moved from clusters into voids until no move helps.
fn evenly_lit() -> Pattern {
    let mut pattern = Pattern { is_lit: [false; PLACES], crowd: [0; PLACES] };
    // The quick and dirty generator of Numerical Recipes: any start will do.
    let mut state = 1_u32;
    for _ in 0..PLACES / 10 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let place = (state >> 16) as usize % PLACES;
        if !pattern.is_lit[place] {
            pattern.turn(place);
        }
    }
    loop {
        let Some(from) = pattern.most_crowded() else { return pattern };
        pattern.turn(from);
        let Some(to) = pattern.emptiest() else { return pattern };
        pattern.turn(to);
        if to == from {
            return pattern;
        }
    }
}

/// The lit pixels, and how crowded each pixel is by them.
#[derive(Clone)]
struct Pattern {
    is_lit: [bool; PLACES],
    crowd: [i32; PLACES],
}

impl Pattern {
    /// Sets or clears a pixel.
    fn turn(&mut self, place: usize) {
        self.is_lit[place] ^= true;
        let sign = if self.is_lit[place] { 1 } else { -1 };
        let (x, y) = (place % SIDE, place / SIDE);
        for (at, crowd) in self.crowd.iter_mut().enumerate() {
            *crowd += sign * NEARNESS[apart(y, at / SIDE)] * NEARNESS[apart(x, at % SIDE)];
        }
    }

    fn most_crowded(&self) -> Option<usize> {
        (0..PLACES).filter(|&place| self.is_lit[place]).max_by_key(|&place| self.crowd[place])
    }

    fn emptiest(&self) -> Option<usize> {
        (0..PLACES).filter(|&place| !self.is_lit[place]).min_by_key(|&place| self.crowd[place])
    }
}

/// Returns the distance of two columns or rows of the repeating pattern.
fn apart(a: usize, b: usize) -> usize {
    let apart = a.abs_diff(b);
    apart.min(SIDE - apart)
}

/// Returns a Gaussian of 1.5 pixels, Ulichney's choice: `10,000 exp(-d^2 / 4.5)`.
const NEARNESS: [i32; SIDE / 2 + 1] = [10_000, 8_007, 4_111, 1_353, 286, 39, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_threshold_comes_as_often() {
        let mut counts = [0; 256];
        TILE.iter().for_each(|&threshold| counts[usize::from(threshold)] += 1);
        assert_eq!(counts, [PLACES / 256; 256]);
    }

    /// Blue noise has almost nothing in the means of blocks; white noise has 74 / 4 = 18 there.
    #[test]
    fn the_noise_is_blue() {
        let mean = |x: usize, y: usize| {
            let block = (0..16).map(|k| f64::from(threshold(x + k % 4, y + k / 4)));
            block.sum::<f64>() / 16.0 - 127.5
        };
        let square = |x: f64| x * x;
        let sum: f64 = (0..PLACES).map(|at| square(mean(at % SIDE, at / SIDE))).sum();
        let deviation = (sum / PLACES as f64).sqrt();
        assert!(deviation < 10.0, "{deviation}");
    }
}
