//! Taylor models of a formula on pieces of rays, of eight rays at once, in f32.
//!
//! They are the models of [`model`](super::model) with the rounding of f32. The frequent operations have a vector form
//! here; all others are computed lane by lane in f64. The bits of a lane do not depend on the other lanes.

use super::elementary::{exp_of_each, sin_or_cos_of_each};
use super::model::{Continuity, EPSILON as EPSILON_64, Evaluation, Model};
use super::tape::{Binary, Index, Operation, Tape, Unary};
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Mask, SimdKernel, set_bits};
use std::f64::consts::FRAC_2_PI;

/// Twice the largest relative rounding error of an f32 operation.
const EPSILON: f32 = f32::EPSILON;

/// The least error of a model that counts as a large error, as a share of |c1| + |c2|.
const BLUR: f32 = 1.0 / 16.0;

/// A bound of the absolute error of the polynomials for sine and cosine.
// The largest measured error, at every 37th float up to 8000, is 9.3e-8.
const SINE_ERROR: f32 = 2.0 * EPSILON;

/// A bound of the relative error of the polynomial for the exponential function.
// The largest measured error, at every 37th float, is 8.1e-8.
const EXP_RELATIVE_ERROR: f32 = 4.0 * EPSILON;

/// The largest angle, in radians, at which the reduction to a quarter turn is exact enough.
// Cephes gives 8192 as the limit of this reduction.
const LARGEST_ANGLE: f32 = 8000.0;

/// Eight Taylor models in memory, one per lane: the three coefficients of the quadratic polynomial,
/// then the largest distance from it.
pub(super) type StoredModels = [F32x8; 4];

/// The origins of eight lines, then their directions, axis by axis.
pub(super) type Lines = [[[f64; LANES]; 3]; 2];

/// Eight values, one per lane.
pub(super) type EightValues = [f64; LANES];

/// The kernel that computes the models of a tape on eight pieces, for the lanes in `lanes`.
pub(super) struct PacketModels<'a> {
    pub(super) tape: &'a Tape,
    pub(super) lines: &'a Lines,
    /// The starts of the pieces, then their ends.
    pub(super) pieces: &'a [[f64; LANES]; 2],
    pub(super) lanes: u32,
    pub(super) scratch: &'a mut Vec<StoredModels>,
}

/// The models of the whole formula on eight pieces, and which lanes may jump or have a certain
/// sign.
pub(super) struct SignForecasts {
    models: StoredModels,
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
    /// The coefficients of u and u^2.
    pub(super) c: [f64; 2],
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
    #[cfg(all(test, unit_tests))]
    pub(super) fn model(&self, lane: usize) -> Model {
        model_of_lane(&self.models, lane)
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
        let c = [1, 2].map(|power: usize| f64::from(self.models[power].0[lane]));
        SignForecast { c, sign, has_no_zero: self.has_no_zero(lane), near, far, blur }
    }
}

impl SimdKernel for PacketModels<'_> {
    type Output = SignForecasts;

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let Self { tape, lines, pieces, lanes, scratch } = self;
        let coordinates = coordinates(lines, pieces);
        let mut evaluation = PacketEvaluation { lanes, may_jump: 0, is_undefined: 0 };
        let operations = tape.operations();
        scratch.resize(operations.len(), [F32x8::ZERO; 4]);
        for (index, &operation) in operations.iter().enumerate() {
            let (known, rest) = scratch.split_at_mut(index);
            let models = match operation {
                Operation::Constant(bits) => Models::constant(f64::from_bits(bits)),
                Operation::Coordinate(axis) => Models::load(&coordinates[usize::from(axis)]),
                Operation::Unary(function, a) => {
                    evaluation.unary(function, Models::of_operation(known, a), tape.is_non_negative(usize::from(a)))
                }
                Operation::Binary(function, a, b) => match (function, tape.constant_as_f32(a), tape.constant_as_f32(b))
                {
                    (Binary::Multiply, Some(factor), _) => Models::of_operation(known, b).scaled(N::splat(factor)),
                    (Binary::Multiply, _, Some(factor)) => Models::of_operation(known, a).scaled(N::splat(factor)),
                    (Binary::Add, Some(term), _) => Models::of_operation(known, b).shifted(N::splat(term)),
                    (Binary::Add, _, Some(term)) => Models::of_operation(known, a).shifted(N::splat(term)),
                    (Binary::Subtract, Some(term), _) => {
                        Models::of_operation(known, b).negate().shifted(N::splat(term))
                    }
                    (Binary::Subtract, _, Some(term)) => Models::of_operation(known, a).shifted(N::splat(-term)),
                    _ => evaluation.binary(function, Models::of_operation(known, a), Models::of_operation(known, b)),
                },
            };
            rest[0] = models.store();
        }
        let last = scratch.last().copied().unwrap_or(Models::<N>::anything().store());
        let PacketEvaluation { may_jump, is_undefined, .. } = evaluation;
        Models::<N>::load(&last).sign_forecasts(lanes, may_jump, is_undefined)
    }
}

/// An evaluator of a tape at one point on each of eight lines.
pub(super) struct PacketValues<'a> {
    pub(super) tape: &'a Tape,
    pub(super) lines: &'a Lines,
    pub(super) scratch: &'a mut Vec<EightValues>,
}

impl PacketValues<'_> {
    /// Returns the values at `t` on each line.
    ///
    /// They have the same bits as [`Tape::value`] for each lane, whatever the instruction set.
    #[inline(always)]
    pub(super) fn at(&mut self, t: &EightValues) -> EightValues {
        let Self { tape, lines: [origins, directions], scratch } = self;
        let operations = tape.operations();
        scratch.resize(operations.len(), [0.0; LANES]);
        for (index, &operation) in operations.iter().enumerate() {
            let (known, rest) = scratch.split_at_mut(index);
            let (of, to) = (|index: Index| &known[usize::from(index)], &mut rest[0]);
            match operation {
                Operation::Constant(bits) => *to = [f64::from_bits(bits); LANES],
                Operation::Coordinate(axis) => {
                    let (o, d) = (&origins[usize::from(axis)], &directions[usize::from(axis)]);
                    (0..LANES).for_each(|lane| to[lane] = o[lane] + d[lane] * t[lane]);
                }
                Operation::Unary(function, a) => unary_of_each(function, of(a), to),
                Operation::Binary(function, a, b) => binary_of_each(function, of(a), of(b), to),
            }
        }
        scratch.last().copied().unwrap_or([f64::NAN; LANES])
    }
}

/// Computes a function of each value.
///
/// Frequent functions have a loop of their own, which becomes vector instructions.
#[inline(always)]
fn unary_of_each(function: Unary, a: &EightValues, to: &mut EightValues) {
    match function {
        Unary::Negate => (0..LANES).for_each(|lane| to[lane] = -a[lane]),
        Unary::Abs => (0..LANES).for_each(|lane| to[lane] = a[lane].abs()),
        Unary::Square => (0..LANES).for_each(|lane| to[lane] = a[lane] * a[lane]),
        Unary::Sqrt => (0..LANES).for_each(|lane| to[lane] = a[lane].sqrt()),
        Unary::Sin => sin_or_cos_of_each(a, to, false),
        Unary::Cos => sin_or_cos_of_each(a, to, true),
        Unary::Exp => exp_of_each(a, to),
        _ => (0..LANES).for_each(|lane| to[lane] = function.at(a[lane])),
    }
}

/// Computes a function of two values in each lane; see [`unary_of_each`].
#[inline(always)]
fn binary_of_each(function: Binary, a: &EightValues, b: &EightValues, to: &mut EightValues) {
    match function {
        Binary::Add => (0..LANES).for_each(|lane| to[lane] = a[lane] + b[lane]),
        Binary::Subtract => (0..LANES).for_each(|lane| to[lane] = a[lane] - b[lane]),
        Binary::Multiply => (0..LANES).for_each(|lane| to[lane] = a[lane] * b[lane]),
        Binary::Divide => (0..LANES).for_each(|lane| to[lane] = a[lane] / b[lane]),
        Binary::Min => (0..LANES).for_each(|lane| to[lane] = Binary::Min.at(a[lane], b[lane])),
        Binary::Max => (0..LANES).for_each(|lane| to[lane] = Binary::Max.at(a[lane], b[lane])),
        Binary::Atan2 => (0..LANES).for_each(|lane| to[lane] = function.at(a[lane], b[lane])),
    }
}

/// Returns the models of the coordinates on eight pieces, see [`Model::coordinate`].
#[inline(always)]
fn coordinates([origins, directions]: &Lines, [from, to]: &[[f64; LANES]; 2]) -> [StoredModels; 3] {
    let mut models = [[F32x8::ZERO; 4]; 3];
    for (axis, [c0, c1, _, error]) in models.iter_mut().enumerate() {
        let (o, d) = (&origins[axis], &directions[axis]);
        for lane in 0..LANES {
            let (middle, half) = (0.5 * (from[lane] + to[lane]), 0.5 * (to[lane] - from[lane]));
            let (at_middle, slope) = (middle * d[lane], half * d[lane]);
            let of_f64 = o[lane].abs() + at_middle.abs() + (from[lane].abs() + to[lane].abs()) * d[lane].abs();
            (c0.0[lane], c1.0[lane]) = ((o[lane] + at_middle) as f32, slope as f32);
            let rounding = EPSILON * (c0.0[lane].abs() + c1.0[lane].abs()) + (4.0 * EPSILON_64 * of_f64) as f32;
            error.0[lane] = enlarged(rounding);
        }
    }
    models
}

/// Returns the model of one lane.
fn model_of_lane(models: &StoredModels, lane: usize) -> Model {
    let [c0, c1, c2, error] = models.map(|numbers| f64::from(numbers.0[lane]));
    Model { c: [c0, c1, c2], error }
}

/// Returns the error with room for its own rounding, and for products that underflow to 0.
fn enlarged(error: f32) -> f32 {
    error * (1.0 + 16.0 * EPSILON) + 16.0 * f32::MIN_POSITIVE
}

/// Eight models in registers.
#[derive(Clone, Copy)]
struct Models<N> {
    c: [N; 3],
    error: N,
}

/// A function at c0 of eight models.
struct Taylor<N> {
    /// The function, its derivative, and half the second derivative, at c0.
    at: [N; 3],
    /// A bound of the third derivative's magnitude on the range, divided by 6.
    third: N,
    /// The absolute error of each number in `at`.
    off: N,
}

// All functions are inlined: others would be compiled without the kernel's target features.
impl<N: Lanes> Models<N> {
    #[inline(always)]
    fn load(&[c0, c1, c2, error]: &StoredModels) -> Self {
        Self { c: [N::load(&c0), N::load(&c1), N::load(&c2)], error: N::load(&error) }
    }

    /// Returns the models of the operation at `index`.
    #[inline(always)]
    fn of_operation(known: &[StoredModels], index: Index) -> Self {
        Self::load(&known[usize::from(index)])
    }

    #[inline(always)]
    fn store(self) -> StoredModels {
        let [c0, c1, c2] = self.c;
        [c0.store(), c1.store(), c2.store(), self.error.store()]
    }

    #[inline(always)]
    fn with_enlarged_error(c: [N; 3], error: N) -> Self {
        let room = N::splat(1.0 + 16.0 * EPSILON);
        Self { c, error: error * room + N::splat(16.0 * f32::MIN_POSITIVE) }
    }

    #[inline(always)]
    fn anything() -> Self {
        Self { c: [N::splat(0.0); 3], error: N::splat(f32::INFINITY) }
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        let (zero, rounded) = (N::splat(0.0), value as f32);
        let error = if f64::from(rounded) == value { 0.0 } else { enlarged(EPSILON * rounded.abs()) };
        Self { c: [N::splat(rounded), zero, zero], error: N::splat(error) }
    }

    #[inline(always)]
    fn hull(low: N, high: N) -> Self {
        let half = N::splat(0.5);
        let rounding = N::splat(4.0 * EPSILON) * (low.abs() + high.abs());
        let zero = N::splat(0.0);
        Self::with_enlarged_error([half * low + half * high, zero, zero], half * high - half * low + rounding)
    }

    #[inline(always)]
    fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        let pick = |axis: usize| N::select(mask, yes.c[axis], no.c[axis]);
        Self { c: [pick(0), pick(1), pick(2)], error: N::select(mask, yes.error, no.error) }
    }

    #[inline(always)]
    fn coefficient_abs_sum(self) -> N {
        self.c[0].abs() + self.c[1].abs() + self.c[2].abs()
    }

    #[inline(always)]
    fn range(self) -> [N; 2] {
        let (Self { c: [c0, c1, c2], error }, zero) = (self, N::splat(0.0));
        let slack = error + N::splat(4.0 * EPSILON) * self.coefficient_abs_sum();
        [c0 - c1.abs() + c2.min(zero) - slack, c0 + c1.abs() + c2.max(zero) + slack]
    }

    #[inline(always)]
    fn negate(self) -> Self {
        let [c0, c1, c2] = self.c;
        Self { c: [-c0, -c1, -c2], error: self.error }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.c, other.c);
        let rounding = N::splat(EPSILON) * (self.coefficient_abs_sum() + other.coefficient_abs_sum());
        Self::with_enlarged_error([a0 + b0, a1 + b1, a2 + b2], self.error + other.error + rounding)
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.c, other.c);
        let (of_a, of_b) = (self.coefficient_abs_sum(), other.coefficient_abs_sum());
        let beyond = (a1 * b2).abs() + (a2 * b1).abs() + (a2 * b2).abs();
        let rounding = N::splat(4.0 * EPSILON) * of_a * of_b;
        let error = self.error * (of_b + other.error) + other.error * of_a + rounding;
        Self::with_enlarged_error([a0 * b0, a0 * b1 + a1 * b0, a0 * b2 + a1 * b1 + a2 * b0], beyond + error)
    }

    /// Returns the product with a number; the error allows for a number that was rounded to f32.
    #[inline(always)]
    fn scaled(self, factor: N) -> Self {
        let ([c0, c1, c2], size) = (self.c, factor.abs());
        let error = self.error * size + N::splat(2.0 * EPSILON) * size * self.coefficient_abs_sum();
        Self::with_enlarged_error([c0 * factor, c1 * factor, c2 * factor], error)
    }

    /// Returns the sum with a number; the error allows for a number that was rounded to f32.
    #[inline(always)]
    fn shifted(self, term: N) -> Self {
        let [c0, c1, c2] = self.c;
        let rounding = N::splat(EPSILON) * (c0.abs() + term.abs());
        Self::with_enlarged_error([c0 + term, c1, c2], self.error + rounding)
    }

    /// Returns what the models tell about the sign of the formula on their pieces.
    ///
    /// Shares of the pieces are computed as zeros of polynomials, with a slack larger than the rounding errors of this
    /// computation.
    #[inline(always)]
    fn sign_forecasts(self, lanes: u32, may_jump: u32, is_undefined: u32) -> SignForecasts {
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
            models: self.store(),
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

    /// Returns a function of these models: its Taylor polynomial, or `hull` if that is narrower.
    #[inline(always)]
    fn function(self, taylor: Taylor<N>, hull: Self) -> Self {
        self.taylor(taylor).or_if_narrower(hull)
    }

    #[inline(always)]
    fn taylor(self, Taylor { at: [g, g1, g2], third, off }: Taylor<N>) -> Self {
        let Self { c: [_, c1, c2], error } = self;
        let (two, sizes) = (N::splat(2.0), c1.abs() + c2.abs());
        let spread = sizes + error;
        let beyond = two * (c1 * c2).abs() + c2 * c2 + error * (two * sizes + error);
        let (linear, square) = (g1 * c2, g2 * c1 * c1);
        let rounding = N::splat(8.0 * EPSILON) * (g.abs() + (g1 * c1).abs() + linear.abs() + square.abs());
        let of_values = off * (N::splat(1.0) + sizes + c1 * c1);
        // A bound that has underflowed to 0 no longer bounds anything.
        let third = N::select(third.lt(N::splat(f32::MIN_POSITIVE)), N::splat(f32::INFINITY), third);
        let remainder = third * spread * spread * spread;
        let error = g1.abs() * error + g2.abs() * beyond + remainder + rounding + of_values;
        Self::with_enlarged_error([g, g1 * c1, linear + square], error)
    }

    /// Returns the models with the smaller errors.
    #[inline(always)]
    fn or_if_narrower(self, hull: Self) -> Self {
        let is_closer = self.error.le(hull.error) | !hull.error.le(hull.error);
        Self::select(is_closer, self, hull)
    }

    #[inline(always)]
    fn squared(self) -> Self {
        let (Self { c: [c0, c1, c2], error }, size) = (self, self.coefficient_abs_sum());
        let (two, four) = (N::splat(2.0), N::splat(4.0 * EPSILON));
        let beyond = (two * c1.abs() + c2.abs()) * c2.abs();
        let doubled = two * c0;
        let squares = [c0 * c0, doubled * c1, doubled * c2 + c1 * c1];
        let taylor = Self::with_enlarged_error(squares, beyond + error * (two * size + error) + four * size * size);
        // With an error this small, the Taylor model is narrower than the hull. Each lane chooses for itself, so that
        // its bits do not depend on the others; only this shortcut depends on all lanes.
        let is_close = taylor.error.le(size * size * N::splat(0.25));
        if is_close.all() {
            return taylor;
        }
        let ([low, high], zero) = (self.range(), N::splat(0.0));
        let (one, other) = (low * low, high * high);
        let least = N::select(low.le(zero) & zero.le(high), zero, one.min(other));
        Self::select(is_close, taylor, taylor.or_if_narrower(Self::hull(least, one.max(other))))
    }

    /// Returns |a|: `a`, its negative or, if its range contains 0, the chord of |a| over the range.
    #[inline(always)]
    fn absolute(self) -> Self {
        let ([low, high], zero) = (self.range(), N::splat(0.0));
        let width = high - low;
        let (slope, at_zero) = ((high + low) / width, N::splat(-2.0) * low * high / width);
        let rounding = N::splat(16.0 * EPSILON) * (at_zero + width);
        let half = N::splat(0.5) * at_zero;
        let chord = self.scaled(slope).plus(Self::with_enlarged_error([half, zero, zero], half + rounding));
        let chord = Self::select(width.lt(N::splat(f32::INFINITY)), chord, Self::anything());
        Self::select(zero.le(low), self, Self::select(high.le(zero), self.negate(), chord))
    }

    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
        let (difference, zero) = (self.plus(other.negate()), N::splat(0.0));
        let [low, high] = difference.range();
        let blend = self.plus(other).plus(difference.absolute().negate()).scaled(N::splat(0.5));
        Self::select(high.le(zero), self, Self::select(zero.le(low), other, blend))
    }

    /// Returns the sines, or the cosines.
    #[inline(always)]
    fn sin_or_cos(self, is_cosine: bool) -> Self {
        let (c0, one) = (self.c[0], N::splat(1.0));
        let [sin, cos] = sin_cos(c0);
        let [value, slope] = if is_cosine { [cos, -sin] } else { [sin, cos] };
        let taylor = Taylor {
            at: [value, slope, N::splat(-0.5) * value],
            third: N::splat(1.0 / 5.9),
            off: N::select(c0.abs().le(N::splat(LARGEST_ANGLE)), N::splat(SINE_ERROR), N::splat(f32::INFINITY)),
        };
        self.function(taylor, Self::hull(-one, one))
    }

    /// Returns e to the quantity by its Taylor polynomial.
    ///
    /// `value` is the function at c0, `most` its largest value on the piece, and `off` the error of `value`.
    // Not a closure, which would be compiled without the kernel's target features: that took four times as long.
    #[inline(always)]
    fn exponential_taylor(self, [value, most, off]: [N; 3]) -> Self {
        let third = most * N::splat(1.0 / 5.9);
        self.taylor(Taylor { at: [value, value, N::splat(0.5) * value], third, off })
    }

    #[inline(always)]
    fn exponential(self) -> Self {
        let ([low, high], zero, one) = (self.range(), N::splat(0.0), N::splat(1.0));
        let value = exp(self.c[0]);
        // Below -87 `exp` returns 1.6e-38, and the true value is between 0 and that.
        let off = N::splat(EXP_RELATIVE_ERROR) * value + N::splat(1e-37);
        // Up to a spread s of 1, e^s is at most 1 + s + s^2, which gives `most` without another `exp`, and the hull is
        // not narrower than the Taylor model. Each lane chooses for itself, as in `squared`.
        let spread = high - self.c[0];
        let (is_narrow, is_in_reach) = (spread.lt(one) & N::splat(-80.0).lt(self.c[0]), high.lt(N::splat(87.0)));
        let most = value * (one + spread + spread * spread) * N::splat(1.0 + 2.0 * EXP_RELATIVE_ERROR);
        let narrow = self.exponential_taylor([value, most, off]);
        if (is_narrow & is_in_reach).all() {
            return narrow;
        }
        let most = exp(high) * N::splat(1.0 + EXP_RELATIVE_ERROR);
        // From -86 on, the relative error of `exp` is at most `EXP_RELATIVE_ERROR`.
        let least = N::select(low.lt(N::splat(-86.0)), zero, exp(low) * N::splat(1.0 - EXP_RELATIVE_ERROR));
        let wide = self.exponential_taylor([value, most, off]).or_if_narrower(Self::hull(least, most));
        Self::select(is_in_reach, Self::select(is_narrow, narrow, wide), Self::anything())
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
    let (zero, none) = (N::splat(0.0), N::splat(f32::INFINITY));
    let root = (slope * slope - N::splat(4.0) * curvature * start).sqrt();
    // `root` gets the sign with which it does not cancel against the slope.
    let sum = slope - N::select(slope.lt(zero), root, -root);
    let (one, other) = (N::splat(-0.5) * sum / curvature, N::splat(-2.0) * start / sum);
    N::select(zero.lt(one), one, none).min(N::select(zero.lt(other), other, none))
}

/// Returns sine and cosine, off by at most [`SINE_ERROR`] up to [`LARGEST_ANGLE`].
#[inline(always)]
fn sin_cos<N: Lanes>(x: N) -> [N; 2] {
    let number = |value: f64| N::splat(value as f32);
    let (one, two, half) = (number(1.0), number(2.0), number(0.5));
    let quarters = (x * number(FRAC_2_PI) + half).floor();
    // A quarter turn in three parts, of which the products with the first two are exact (Cody and Waite; Cephes).
    let r = x - quarters * number(1.570_312_5) - quarters * number(4.837_512_969_970_703e-4);
    let r = r - quarters * number(7.549_789_948_768_648e-8);
    let r2 = r * r;
    let odd_part = number(8.332_160_873_6e-3) - r2 * number(1.951_529_589_1e-4);
    let sin = r + r * r2 * (r2 * odd_part - number(1.666_665_461_1e-1));
    let even_part = r2 * number(2.443_315_711_809_948e-5) - number(1.388_731_625_493_765e-3);
    let cos = one - half * r2 + r2 * r2 * (r2 * even_part + number(4.166_664_568_298_827e-2));
    let halves = (quarters * half).floor();
    let odd = quarters - two * halves;
    let turned = halves - two * (halves * half).floor();
    let is_odd = half.lt(odd);
    let sign_of_cos = turned + odd - two * turned * odd;
    [N::select(is_odd, cos, sin) * (one - two * turned), N::select(is_odd, sin, cos) * (one - two * sign_of_cos)]
}

/// Returns e^x with a relative error of at most [`EXP_RELATIVE_ERROR`] for x from -86 to 87.
///
/// Below -87 and above 88, it returns the value at that limit.
#[inline(always)]
fn exp<N: Lanes>(x: N) -> N {
    let number = |value: f64| N::splat(value as f32);
    // Beyond these limits, `scale` would be subnormal or infinite.
    let x = x.max(number(-87.0)).min(number(88.0));
    // ln 2 is split in two, so that `power` times the first part is exact. The polynomial is that of Cephes.
    let power = (x * number(std::f64::consts::LOG2_E) + number(0.5)).floor();
    let r = x - power * number(0.693_359_375) + power * number(2.121_944_4e-4);
    let polynomial = [1.398_199_950_7e-3, 8.333_451_907_3e-3, 4.166_579_589_4e-2, 1.666_666_545_9e-1, 0.5];
    let sum = polynomial.iter().fold(number(1.987_569_150_0e-4), |sum, &c| sum * r + number(c));
    let [scale] = N::map_lanes([power], |[power]| [f32::from_bits(((power as i32 + 127) as u32) << 23)]);
    (sum * r * r + r + number(1.0)) * scale
}

/// The evaluation of operations, which records the lanes in which they may jump or are undefined.
struct PacketEvaluation {
    lanes: u32,
    may_jump: u32,
    is_undefined: u32,
}

impl PacketEvaluation {
    #[inline(always)]
    fn unary<N: Lanes>(&mut self, function: Unary, a: Models<N>, is_non_negative: bool) -> Models<N> {
        match function {
            Unary::Negate => a.negate(),
            Unary::Abs => a.absolute(),
            Unary::Square => a.squared(),
            Unary::Sin => a.sin_or_cos(false),
            Unary::Cos => a.sin_or_cos(true),
            Unary::Exp => a.exponential(),
            Unary::Sqrt => self.square_root(a, is_non_negative),
            _ => self.lane_by_lane([a, a], |evaluation, [a, _]| evaluation.unary(function, a, is_non_negative)),
        }
    }

    #[inline(always)]
    fn binary<N: Lanes>(&mut self, function: Binary, a: Models<N>, b: Models<N>) -> Models<N> {
        match function {
            Binary::Add => a.plus(b),
            Binary::Subtract => a.plus(b.negate()),
            Binary::Multiply => a.times(b),
            Binary::Divide => self.quotient(a, b),
            Binary::Min => a.minimum(b),
            Binary::Max => a.negate().minimum(b.negate()).negate(),
            Binary::Atan2 => self.lane_by_lane([a, b], |evaluation, [a, b]| evaluation.binary(function, a, b)),
        }
    }

    /// Records that the lanes of `mask` may jump; their models become [`Models::anything`].
    #[inline(always)]
    fn anything_where<N: Lanes>(&mut self, mask: N::Mask, is_undefined: N::Mask, else_: Models<N>) -> Models<N> {
        self.may_jump |= mask.bits();
        self.is_undefined |= is_undefined.bits();
        Models::select(mask, Models::anything(), else_)
    }

    #[inline(always)]
    fn square_root<N: Lanes>(&mut self, a: Models<N>, is_non_negative: bool) -> Models<N> {
        let ([low, high], zero) = (a.range(), N::splat(0.0));
        let value = a.c[0].sqrt();
        let slope = N::splat(0.5) / value;
        let root = low.sqrt();
        let third = N::splat(1.0) / (N::splat(15.9) * low * low * root);
        let taylor = Taylor { at: [value, slope, N::splat(-0.25) * slope / a.c[0]], third, off: zero };
        let of_positive = a.function(taylor, Models::hull(root, high.sqrt()));
        let is_positive = zero.lt(low);
        let of_any = Models::select(is_positive, of_positive, Models::hull(zero, high.max(zero).sqrt()));
        if !is_non_negative {
            self.may_jump |= (!is_positive).bits();
        }
        let (is_undefined, is_known) = (high.lt(zero), (high - low).lt(N::splat(f32::INFINITY)));
        self.anything_where(is_undefined | !is_known, is_undefined, of_any)
    }

    #[inline(always)]
    fn quotient<N: Lanes>(&mut self, a: Models<N>, b: Models<N>) -> Models<N> {
        let ([low, high], zero, one) = (b.range(), N::splat(0.0), N::splat(1.0));
        let (value, nearest) = (one / b.c[0], low.abs().min(high.abs()));
        let squared = nearest * nearest;
        let taylor = Taylor {
            at: [value, -(value * value), value * value * value],
            third: N::splat(1.01) / (squared * squared),
            off: zero,
        };
        let inverse = b.function(taylor, Models::hull(one / high, one / low));
        let is_defined = zero.lt(low) | high.lt(zero);
        let is_undefined = zero.le(low) & high.le(zero);
        self.anything_where(!is_defined, is_undefined, a.times(inverse))
    }

    /// Computes a rare operation in f64, one lane after the other.
    #[inline(always)]
    fn lane_by_lane<N: Lanes>(
        &mut self,
        operands: [Models<N>; 2],
        operation: impl Fn(&mut Evaluation<'_>, [Model; 2]) -> Model,
    ) -> Models<N> {
        let (operands, mut results) = (operands.map(Models::store), Models::<N>::anything().store());
        for lane in set_bits(self.lanes) {
            let mut continuity = Continuity::default();
            let Model { c, error } = operation(
                &mut Evaluation(&mut continuity),
                [model_of_lane(&operands[0], lane), model_of_lane(&operands[1], lane)],
            );
            self.may_jump |= u32::from(continuity.may_jump) << lane;
            self.is_undefined |= u32::from(continuity.is_undefined) << lane;
            let rounding = EPSILON * c.iter().map(|c| c.abs() as f32).sum::<f32>();
            for (result, c) in results.iter_mut().zip(c) {
                result.0[lane] = c as f32;
            }
            results[3].0[lane] = enlarged(error as f32 + rounding);
        }
        Models::load(&results)
    }
}
