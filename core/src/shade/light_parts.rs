//! The parts of lights that have a size, towards which shadow rays are traced.
//!
//! All points of a picture use the same parts, so that the shadow rays to a part are a packet as good as that to a
//! point source, and a penumbra neither flickers nor is noisy. Each further sample of a pixel moves the parts, by a
//! low-discrepancy sequence that every point starts anew: with more samples, the steps of a penumbra vanish.

use crate::lanes::{F32x8, LANES, Lanes};
use crate::light::{PARTS, PartPosition};
use std::f64::consts::PI;

/// The displacements of the parts for the samples of eight rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PartShifts {
    /// The amounts added to both coordinates of a part in the unit square, modulo 1.
    square: [F32x8; 2],
    /// The cosine and sine of the angle by which directions are turned.
    turn: [F32x8; 2],
}

impl PartShifts {
    /// The displacements of a pixel's first sample: none.
    const NONE: Self = Self { square: [F32x8::ZERO; 2], turn: [F32x8([1.0; LANES]), F32x8::ZERO] };

    /// Returns the displacements for samples with these numbers in their pixels, at most eight.
    pub(super) fn of(samples: &[u32]) -> Self {
        let mut shifts = Self::NONE;
        for (lane, &sample) in samples.iter().enumerate().filter(|(_, sample)| **sample != 0) {
            // Multiples of the powers of the inverse of x with x^4 = x + 1, modulo 1 (Roberts' R3 sequence), in
            // integers, which are exact on every CPU.
            let part = |step: u32| f64::from(sample.wrapping_mul(step)) / 4_294_967_296.0;
            let [a, b, c] = [3_518_319_155, 2_882_110_345, 2_360_945_575].map(part);
            let (sine, cosine) = libm::sincos(2.0 * PI * c);
            shifts.square[0].0[lane] = a as f32;
            shifts.square[1].0[lane] = b as f32;
            shifts.turn[0].0[lane] = cosine as f32;
            shifts.turn[1].0[lane] = sine as f32;
        }
        shifts
    }

    /// Writes the displacements for the samples of `groups` groups of eight rays.
    ///
    /// Without numbers of samples, all are first samples.
    pub(super) fn fill(samples: &[u32], groups: usize, shifts: &mut Vec<Self>) {
        shifts.clear();
        shifts.extend(samples.chunks(LANES).take(groups).map(Self::of));
        shifts.resize(groups, Self::NONE);
    }

    /// Returns the position of part `part` of a light in each lane.
    #[inline(always)]
    pub(super) fn position<N: Lanes>(&self, part: u32) -> PartPosition<N> {
        let base = &BASE[(part % PARTS) as usize];
        let wrapped = |start: f32, shift: &F32x8| {
            let sum = N::splat(start) + N::load(shift);
            sum - sum.floor()
        };
        let [x, y] = [N::splat(base.direction[0]), N::splat(base.direction[1])];
        let [cosine, sine] = [N::load(&self.turn[0]), N::load(&self.turn[1])];
        PartPosition {
            square: [wrapped(base.square[0], &self.square[0]), wrapped(base.square[1], &self.square[1])],
            direction: [x * cosine - y * sine, x * sine + y * cosine],
            height: wrapped(base.height, &self.square[0]),
        }
    }
}

/// The positions of the parts for a pixel's first sample.
///
/// The square is divided into 4 by 4 cells with a part each, and each column and each row of sixteen has one part
/// (Chiu, Shirley and Wang, Multi-Jittered Sampling, 1994). Directions come in pairs of opposites, so that their sum is
/// 0; each pair has a height of its own.
static BASE: [PartPosition<f32>; PARTS as usize] = base();

const fn base() -> [PartPosition<f32>; PARTS as usize] {
    /// The directions of the first part of each pair.
    // Multiples of 180 degrees times the golden ratio, modulo 180.
    const DIRECTIONS: [[f32; 2]; PARTS as usize / 2] = [
        [1.0, 0.0],
        [-0.362_374_9, 0.932_032_4],
        [0.737_368_9, 0.675_490_3],
        [-0.896_782_8, 0.442_471],
        [0.087_425_7, 0.996_171],
        [0.960_144_6, 0.279_503_8],
        [-0.608_438_9, 0.793_600_8],
        [0.519_178_7, 0.854_665_7],
    ];
    /// The quarter of its cell in which a part is.
    ///
    /// Along x it depends on the cell's row, and along y on the cell's column.
    // Of all permutations, these integrate the light of panels best: seven panels, as wide as three times their
    // distance, within 0.7 % (a Hammersley set: within 46 %).
    const ACROSS: [[u32; 4]; 2] = [[2, 0, 3, 1], [1, 2, 3, 0]];
    let mut parts = [PartPosition { square: [0.0; 2], direction: [0.0; 2], height: 0.0 }; PARTS as usize];
    let mut part = 0;
    while part < PARTS {
        let pair = part / 2;
        let [x, y] = DIRECTIONS[pair as usize];
        let sign = if part % 2 == 0 { 1.0 } else { -1.0 };
        let [i, j] = [part / 4, part % 4];
        let [x16, y16] = [4 * i + ACROSS[0][j as usize], 4 * j + ACROSS[1][i as usize]];
        parts[part as usize] = PartPosition {
            square: [(x16 as f32 + 0.5) / 16.0, (y16 as f32 + 0.5) / 16.0],
            direction: [sign * x, sign * y],
            height: ((pair.reverse_bits() >> 29) as f32 + 0.5) / 8.0,
        };
        part += 1;
    }
    parts
}

#[cfg(all(test, unit_tests))]
mod tests;
