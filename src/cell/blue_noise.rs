//! Blue noise: thresholds that never clump, for dithering.
//!
//! Made by void and cluster (Robert Ulichney, "The void-and-cluster method for dither array generation", 1993) in whole
//! numbers from a fixed seed: the same on every machine, and the first time it is asked for.

use std::sync::LazyLock;

/// The tile repeats after so many pixels each way.
const SIDE: usize = 32;
const PLACES: usize = SIDE * SIDE;

/// The threshold of a place on the screen. Over a tile each of 0..=255 comes as often.
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

/// The places in the order in which they light up as a flat grey gets lighter: each time the one farthest from all lit.
fn order() -> Vec<usize> {
    let mut lit = evenly_lit();
    let mut dark = lit.clone();
    let mut order: Vec<usize> = Vec::with_capacity(PLACES);
    // Downwards from there: the last to light up was the most crowded.
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

/// A tenth of the places, moved from where they crowd to where it is empty until none has a better place.
fn evenly_lit() -> Pattern {
    let mut pattern = Pattern { is_lit: [false; PLACES], crowd: [0; PLACES] };
    // Numerical Recipes' quick and dirty generator: any start will do.
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

/// Which places are lit, and how crowded each place is with them.
#[derive(Clone)]
struct Pattern {
    is_lit: [bool; PLACES],
    crowd: [i32; PLACES],
}

impl Pattern {
    /// Lights a place or puts it out.
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

/// How far two columns or rows of the endless pattern are apart.
fn apart(a: usize, b: usize) -> usize {
    let apart = a.abs_diff(b);
    apart.min(SIDE - apart)
}

/// A Gaussian of 1.5 pixels, Ulichney's choice: `10,000 exp(-d^2 / 4.5)`.
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

    /// Noise is blue if it has next to nothing in the means of blocks: white noise has 74 / 4 = 18 there.
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
