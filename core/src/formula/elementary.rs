//! Sine, cosine and the exponential function in f64: the same bits for one number and for several.
//!
//! They are written without branches, so that loops over several numbers become vector instructions: with `libm` they
//! took most of the time of the last steps to a root. For large arguments `libm` is called.

use std::f64::consts::{FRAC_2_PI, LOG2_E};

/// 1.5 * 2^52: the low bits of its sum with a small number are that number, rounded to a whole one.
const TO_WHOLE: f64 = 6_755_399_441_055_744.0;

/// The angle in radians up to which products with the first two parts of [`QUARTER`] are exact.
const LARGEST_ANGLE: f64 = 1e6;

/// The magnitude of the exponent up to which the power of e is a normal number.
const LARGEST_EXPONENT: f64 = 700.0;

/// A quarter turn in parts of 33 bits (fdlibm).
const QUARTER: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

/// The polynomials of sine and cosine, from the highest power (fdlibm).
const SINE: [f64; 6] = [
    1.589_690_995_211_55e-10,
    -2.505_076_025_340_686_3e-8,
    2.755_731_370_707_006_8e-6,
    -1.984_126_982_985_795e-4,
    8.333_333_333_322_49e-3,
    -1.666_666_666_666_663_2e-1,
];
const COSINE: [f64; 6] = [
    -1.135_964_755_778_819_5e-11,
    2.087_572_321_298_175e-9,
    -2.755_731_435_139_066_3e-7,
    2.480_158_728_947_673e-5,
    -1.388_888_888_887_411e-3,
    4.166_666_666_666_66e-2,
];

/// ln 2 in two parts, the first of 33 bits (fdlibm).
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// The inverse factorials of 13 to 2.
const INVERSE_FACTORIALS: [f64; 12] = [
    1.605_904_383_682_161_3e-10,
    2.087_675_698_786_81e-9,
    2.505_210_838_544_172e-8,
    2.755_731_922_398_589e-7,
    2.755_731_922_398_589_3e-6,
    2.480_158_730_158_73e-5,
    1.984_126_984_126_984e-4,
    1.388_888_888_888_889e-3,
    8.333_333_333_333_333e-3,
    4.166_666_666_666_666_4e-2,
    1.666_666_666_666_666_6e-1,
    0.5,
];

/// Computes a polynomial of each number.
// Loop by loop, because the compiler makes no vector instructions of a loop in another one.
#[inline(always)]
fn polynomial<const COUNT: usize>(coefficients: &[f64], x: &[f64; COUNT]) -> [f64; COUNT] {
    let mut sums = [0.0; COUNT];
    for c in coefficients {
        for (sum, x) in sums.iter_mut().zip(x) {
            *sum = *sum * x + c;
        }
    }
    sums
}

/// Returns the sines and the cosines of angles up to [`LARGEST_ANGLE`].
#[inline(always)]
fn sin_and_cos_in_range<const COUNT: usize>(x: &[f64; COUNT]) -> [[f64; COUNT]; 2] {
    let (mut turns, mut rests, mut squares) = ([0; COUNT], [0.0; COUNT], [0.0; COUNT]);
    for at in 0..COUNT {
        let shifted = x[at] * FRAC_2_PI + TO_WHOLE;
        let quarters = shifted - TO_WHOLE;
        let r = x[at] - quarters * QUARTER[0] - quarters * QUARTER[1] - quarters * QUARTER[2];
        (turns[at], rests[at], squares[at]) = (shifted.to_bits(), r, r * r);
    }
    let (of_sine, of_cosine) = (polynomial(&SINE, &squares), polynomial(&COSINE, &squares));
    let (mut sines, mut cosines) = ([0.0; COUNT], [0.0; COUNT]);
    for at in 0..COUNT {
        let (turn, r, squared) = (turns[at], rests[at], squares[at]);
        let sin = r + r * squared * of_sine[at];
        let cos = 1.0 - (0.5 * squared - squared * squared * of_cosine[at]);
        // By bits, because a branch would keep the loop from becoming vector instructions.
        let exchanged = (sin.to_bits() ^ cos.to_bits()) & 0_u64.wrapping_sub(turn & 1);
        sines[at] = f64::from_bits(sin.to_bits() ^ exchanged ^ ((turn & 2) << 62));
        cosines[at] = f64::from_bits(cos.to_bits() ^ exchanged ^ (((turn + 1) & 2) << 62));
    }
    [sines, cosines]
}

/// Returns e to the power of numbers up to [`LARGEST_EXPONENT`] in magnitude.
#[inline(always)]
fn exp_in_range<const COUNT: usize>(x: &[f64; COUNT]) -> [f64; COUNT] {
    let (mut scales, mut rests) = ([0.0; COUNT], [0.0; COUNT]);
    for at in 0..COUNT {
        let shifted = x[at] * LOG2_E + TO_WHOLE;
        let power = shifted - TO_WHOLE;
        rests[at] = x[at] - power * LN_2[0] - power * LN_2[1];
        scales[at] = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    }
    let (mut powers, sums) = ([0.0; COUNT], polynomial(&INVERSE_FACTORIALS, &rests));
    for at in 0..COUNT {
        let r = rests[at];
        powers[at] = (1.0 + (r + r * r * sums[at])) * scales[at];
    }
    powers
}

pub(super) fn sin(x: f64) -> f64 {
    if x.abs() <= LARGEST_ANGLE { sin_and_cos_in_range(&[x])[0][0] } else { libm::sin(x) }
}

pub(super) fn cos(x: f64) -> f64 {
    if x.abs() <= LARGEST_ANGLE { sin_and_cos_in_range(&[x])[1][0] } else { libm::cos(x) }
}

pub(super) fn exp(x: f64) -> f64 {
    if x.abs() <= LARGEST_EXPONENT { exp_in_range(&[x])[0] } else { libm::exp(x) }
}

/// Returns the sines and the cosines of numbers.
#[inline(always)]
pub(super) fn sin_and_cos_of_each<const COUNT: usize>(x: &[f64; COUNT]) -> [[f64; COUNT]; 2] {
    if x.iter().all(|x| x.abs() <= LARGEST_ANGLE) { sin_and_cos_in_range(x) } else { [x.map(sin), x.map(cos)] }
}

/// Returns e to the power of each number.
#[inline(always)]
pub(super) fn exp_of_each<const COUNT: usize>(x: &[f64; COUNT]) -> [f64; COUNT] {
    if x.iter().all(|x| x.abs() <= LARGEST_EXPONENT) { exp_in_range(x) } else { x.map(exp) }
}
