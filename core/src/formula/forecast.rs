//! Forecasts: the sign of a formula at the start of a piece, and where on the piece it may change.

use super::model::{Continuity, Model};
use super::models::{EPSILON, Models};
use crate::lanes::{ALL, F32x8, LANES, LaneMask, Lanes};

/// The error of a model, relative to the value of f, for which the lengths of pieces are chosen.
// Of five values from .12 to .6, this one took the fewest pieces in the pictures of `benches/formulas`.
pub(super) const TARGET: f32 = 0.12;

/// The least error of a model that counts as a large error, as a share of |c1| + |c2|.
const BLUR: f32 = 1.0 / 16.0;

/// The models of the whole formula on eight pieces, and which lanes may jump or have a certain
/// sign.
pub(super) struct SignForecasts {
    pub(super) may_jump: u32,
    pub(super) is_undefined: u32,
    /// `near`, `far` and `blur` of each lane's [`SignForecast`].
    pub(super) shares: [F32x8; 3],
    /// The lanes in which the sign is certain at the start of the piece.
    pub(super) is_certain: u32,
    /// The lanes in which the sign is certain at the start and does not change on the piece.
    pub(super) has_no_zero: u32,
    /// The lanes in which the sign at the start is negative, if it is certain.
    pub(super) is_negative: u32,
    /// The lanes in which the error is small compared with how much the polynomial varies on the
    /// piece.
    pub(super) has_small_error: u32,
}

/// The sign of a model at the start of a piece, and where the sign may change.
#[derive(Clone, Copy, Debug)]
pub(super) struct SignForecast {
    /// The sign at the start, 1 or -1; 0 if it is uncertain.
    pub(super) sign: f64,
    /// Whether the sign is the same on the whole piece.
    pub(super) has_no_zero: bool,
    /// The share of the piece up to which the sign is the same.
    pub(super) near: f64,
    /// A share shortly behind the first change of the sign; above 1 if none is known.
    pub(super) far: f64,
    /// The error relative to the magnitude of the polynomial at the start of the piece or, if
    /// `has_no_zero`, to a lower bound of that magnitude on the piece.
    pub(super) blur: f64,
}

impl SignForecasts {
    /// The forecasts of a formula of which nothing is known.
    pub(super) const UNKNOWN: Self = Self {
        may_jump: ALL,
        is_undefined: 0,
        shares: [F32x8::ZERO, F32x8([2.0; LANES]), F32x8([f32::INFINITY; LANES])],
        is_certain: 0,
        has_no_zero: 0,
        is_negative: 0,
        has_small_error: 0,
    };

    /// Returns the forecasts of the formula with the other sign.
    #[inline(always)]
    pub(super) fn negated(self) -> Self {
        Self { is_negative: !self.is_negative, ..self }
    }

    /// Returns `near`, `far` and `blur`.
    ///
    /// Without a change of the sign, `near` is at the end of the piece, and `far` behind it.
    #[inline(always)]
    fn complete_shares<N: Lanes>(&self) -> [N; 3] {
        let ([near, far, blur], same) = (self.shares.each_ref().map(N::load), N::mask_from_bits(self.has_no_zero));
        [N::select(same, N::splat(1.0), near), N::select(same, N::splat(2.0), far), blur]
    }

    /// Returns the forecasts of the greater one of two formulas of the same rays and pieces.
    #[inline(always)]
    pub(super) fn of_greatest<N: Lanes>(&self, other: &Self) -> Self {
        let [near_a, far_a, blur_a] = self.complete_shares::<N>();
        let [near_b, far_b, blur_b] = other.complete_shares::<N>();
        let [(positive_a, negative_a), (positive_b, negative_b)] =
            [self, other].map(|of| (of.is_certain & !of.is_negative, of.is_certain & of.is_negative));
        // The greater one is positive where either is, and negative where both are.
        let (positive, negative) = (positive_a | positive_b, negative_a & negative_b);
        let (is_a, is_b) = (N::mask_from_bits(positive_a), N::mask_from_bits(positive_b));
        let (both_negative, is_positive) = (N::mask_from_bits(negative), N::mask_from_bits(positive));
        let (zero, two, infinity) = (N::splat(0.0), N::splat(2.0), N::splat(f32::INFINITY));
        let last_positive = N::select(is_a, near_a, zero).max(N::select(is_b, near_b, zero));
        let near = N::select(both_negative, near_a.min(near_b), last_positive);
        // A fall is only certain where one is positive and the other is still negative behind that.
        let falls_a = N::mask_from_bits(positive_a & negative_b) & far_a.lt(near_b);
        let falls_b = N::mask_from_bits(positive_b & negative_a) & far_b.lt(near_a);
        let fall = N::select(falls_a, far_a, N::select(falls_b, far_b, two));
        let far = N::select(both_negative, far_a.min(far_b), fall);
        let of_positive = N::select(is_a, blur_a, infinity).min(N::select(is_b, blur_b, infinity));
        let blur = N::select(is_positive, of_positive, blur_a.max(blur_b));
        let is_small = (self.has_small_error | self.has_no_zero) & (other.has_small_error | other.has_no_zero);
        Self {
            may_jump: self.may_jump | other.may_jump,
            is_undefined: self.is_undefined | other.is_undefined,
            shares: [near.store(), far.store(), blur.store()],
            is_certain: positive | negative,
            has_no_zero: positive_a & self.has_no_zero
                | positive_b & other.has_no_zero
                | negative & self.has_no_zero & other.has_no_zero,
            is_negative: negative,
            has_small_error: positive_a & self.has_small_error | positive_b & other.has_small_error | is_small,
        }
    }

    pub(super) fn continuity(&self, lane: usize) -> Continuity {
        Continuity { may_jump: self.may_jump >> lane & 1 == 1, is_undefined: self.is_undefined >> lane & 1 == 1 }
    }

    pub(super) fn has_no_zero(&self, lane: usize) -> bool {
        self.has_no_zero >> lane & 1 == 1
    }

    /// Returns whether the error in a lane is large compared with the extent of the polynomial.
    ///
    /// A lane whose sign is the same on the whole piece (`has_no_zero`) does not count.
    pub(super) fn has_large_error(&self, lane: usize) -> bool {
        (self.has_small_error | self.has_no_zero) >> lane & 1 == 0
    }

    /// Returns the sign at the start, 1 or -1; it is only valid in the lanes of `is_certain`.
    pub(super) fn sign_at_start(&self, lane: usize) -> f64 {
        if self.is_negative >> lane & 1 == 1 { -1.0 } else { 1.0 }
    }

    pub(super) fn forecast(&self, lane: usize) -> SignForecast {
        let [near, far, blur] = self.shares.map(|share| f64::from(share.0[lane]));
        let sign = if self.is_certain >> lane & 1 == 1 { self.sign_at_start(lane) } else { 0.0 };
        SignForecast { sign, has_no_zero: self.has_no_zero(lane), near, far, blur }
    }
}

// All functions are inlined: others would be compiled without the kernel's target features.
impl<N: Lanes> Models<N> {
    /// Returns what the models tell about the sign of the formula on their pieces.
    ///
    /// Shares of the pieces are computed as zeros of polynomials, with a slack larger than the rounding errors of this
    /// computation.
    #[inline(always)]
    pub(super) fn sign_forecasts(self, lanes: u32, may_jump: u32, is_undefined: u32) -> SignForecasts {
        let (n, zero, one) = (N::splat, N::splat(0.0), N::splat(1.0));
        // All numbers are divided by the size of the polynomial, so that no square overflows or underflows.
        let inverse = one / self.coefficient_abs_sum();
        let error = self.error * inverse * n(1.0 + 4.0 * EPSILON) + n(8.0 * EPSILON);
        let [c0, c1, c2] = self.c;
        let is_negative = (c0 - c1 + c2).lt(zero);
        let flip = N::select(is_negative, -inverse, inverse);
        let [c0, c1, c2] = [c0 * flip, c1 * flip, c2 * flip];
        // The coefficients in the Bernstein basis, between which the polynomial lies.
        let (first, middle, last) = (c0 - c1 + c2, c0 - c2, c0 + c1 + c2);
        let least = first.min(middle).min(last);
        let has_no_zero = error.lt(least);
        let (is_certain, has_small_error) = (error.lt(first), error.lt(n(BLUR) * (c1.abs() + c2.abs())));
        let mut forecasts = SignForecasts {
            may_jump,
            is_undefined,
            shares: [F32x8::ZERO, F32x8::ZERO, (error / N::select(has_no_zero, least, first.abs())).store()],
            is_certain: is_certain.bits(),
            has_no_zero: has_no_zero.bits() & !is_undefined,
            is_negative: is_negative.bits(),
            has_small_error: has_small_error.bits(),
        };
        if forecasts.has_no_zero & lanes == lanes {
            return forecasts;
        }
        let (slack, two) = (error + n(16.0 * EPSILON), n(2.0));
        let (slope, curvature) = (two * c1 - n(4.0) * c2, n(4.0) * c2);
        // The polynomial falls at most as steeply as the steeper chord from the first coefficient to one of the others.
        let steepest = (two * (middle - first)).min(last - first);
        let by_chord = (n(0.999) * (first - error) / -steepest).max(zero).min(one);
        let near = (first_zero(first - slack, slope, curvature) * n(1.0 - 1e-5) - n(1e-6)).min(one);
        // Close to the surface the slack may exceed the value at the start. `first_zero` then returns a point where the
        // polynomial rises to the slack; that point is not used.
        let is_found = slack.lt(first) & zero.lt(near) & error.lt(at_share([c0, c1, c2], near));
        let near = N::select(is_found, near.max(by_chord), by_chord);
        let far = first_zero(first + slack, slope, curvature) * n(1.0 + 1e-5) + n(1e-6);
        let is_beyond = near.lt(far) & far.le(one) & at_share([c0, c1, c2], far).lt(-error);
        forecasts.has_no_zero |= (is_certain & one.le(near)).bits() & !is_undefined;
        (forecasts.shares[0], forecasts.shares[1]) = (near.store(), N::select(is_beyond, far, two).store());
        forecasts
    }
}

/// Returns the value of a polynomial at a share of the piece.
#[inline(always)]
fn at_share<N: Lanes>([c0, c1, c2]: [N; 3], share: N) -> N {
    let u = N::splat(2.0) * share - N::splat(1.0);
    c0 + u * (c1 + u * c2)
}

/// Returns the first positive zero of a quadratic polynomial that is positive at 0, or infinity.
#[inline(always)]
fn first_zero<N: Lanes>(start: N, slope: N, curvature: N) -> N {
    let zero = N::splat(0.0);
    let root = (slope * slope - N::splat(4.0) * curvature * start).sqrt();
    // Of the two forms of the same zero, the one in which `root` does not cancel against the slope.
    let falls = slope.lt(zero);
    let numerator = N::select(falls, N::splat(2.0) * start, slope + root);
    let denominator = N::select(falls, root - slope, N::splat(-2.0) * curvature);
    let share = numerator / denominator;
    N::select(zero.lt(share), share, N::splat(f32::INFINITY))
}

impl SignForecast {
    /// Returns the forecast from a model in f64.
    pub(super) fn of(&Model { c: [c0, c1, c2], error }: &Model) -> Self {
        // The coefficients in the Bernstein basis: the polynomial lies between the least and the greatest.
        let b = [c0 - c1 + c2, c0 - c2, c0 + c1 + c2];
        let sign = if b[0].abs() > error { b[0].signum() } else { 0.0 };
        let [first, middle, last] = b.map(|b| sign * b);
        let has_no_zero = sign != 0.0 && first.min(middle).min(last) > error;
        // The polynomial falls at most as steeply as the steeper chord from the first coefficient to one of the others.
        let steepest = (2.0 * (middle - first)).min(last - first);
        // 0.999 of the way to where f could first be 0, so that the sign of f there is certain in spite of rounding.
        let near = (0.999 * (first - error) / -steepest).clamp(0.0, 1.0);
        let far = first_below([first, middle, last], -error).unwrap_or(2.0);
        let blur = error / if has_no_zero { first.min(middle).min(last) } else { b[0].abs() };
        Self { sign, has_no_zero, near, far, blur }
    }

    /// Returns the next piece's length relative to this piece's, limited to `least..=most`.
    ///
    /// It is a cube root, because the error grows with the cube of the length.
    pub(super) fn length_factor(&self, least: f64, most: f64) -> f64 {
        cube_root(TARGET / self.blur as f32).max(least).min(most)
    }
}

/// Returns the share of the piece shortly behind the first fall of the polynomial below `level`.
///
/// At this share the polynomial is certainly below `level`; `None` if no such share is found.
fn first_below(b: [f64; 3], level: f64) -> Option<f64> {
    let (start, slope, curvature) = (b[0] - level, 2.0 * (b[1] - b[0]), b[0] - 2.0 * b[1] + b[2]);
    let under_root = slope * slope - 4.0 * curvature * start;
    // The condition is also true for NaN.
    if !(under_root >= 0.0) {
        return None;
    }
    let sum = -0.5 * (slope + under_root.sqrt().copysign(slope));
    let root = [sum / curvature, start / sum].into_iter().filter(|root| (0.0..=1.0).contains(root)).reduce(f64::min)?;
    let behind = (root + 1e-6 * root + 1e-9).min(1.0);
    let there = b[0] + behind * (slope + behind * curvature);
    (there < level).then_some(behind)
}

/// Returns the cube root of a positive number, off by 6 %.
///
/// Infinity and NaN give large numbers.
#[inline(always)]
pub(super) fn cube_root(x: f32) -> f64 {
    f64::from(f32::from_bits((x.to_bits() & (u32::MAX >> 1)) / 3 + 0x2a51_37a0))
}
