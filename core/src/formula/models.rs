//! Eight Taylor models in registers, in f32.
//!
//! They are the models of [`model`](super::model) with the rounding of f32 and with smaller errors: terms of orders 3
//! and 4 do not go into the error as a whole, but are replaced by the closest polynomials of order 2.

use super::model::Model;
use super::operation::Index;
use super::tape::Tape;
use crate::lanes::{F32x8, Lanes, Mask};
use std::f64::consts::FRAC_2_PI;

/// Twice the largest relative rounding error of an f32 operation.
pub(super) const EPSILON: f32 = f32::EPSILON;

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

/// Returns the model of one lane.
pub(super) fn model_of_lane(models: &StoredModels, lane: usize) -> Model {
    let [c0, c1, c2, error] = models.map(|numbers| f64::from(numbers.0[lane]));
    Model { c: [c0, c1, c2], error }
}

/// Returns the error with room for its own rounding, and for products that underflow to 0.
pub(super) fn enlarged(error: f32) -> f32 {
    error * (1.0 + 16.0 * EPSILON) + 16.0 * f32::MIN_POSITIVE
}

/// Eight models in registers.
#[derive(Clone, Copy)]
pub(super) struct Models<N> {
    pub(super) c: [N; 3],
    pub(super) error: N,
}

/// A function at c0 of eight models.
pub(super) struct Taylor<N> {
    /// The coefficients of the Taylor polynomial at c0.
    ///
    /// They are the function, its derivative, half the second derivative, and a sixth of the third one.
    pub(super) at: [N; 4],
    /// A bound of the fourth derivative's magnitude on the range, divided by 24.
    pub(super) fourth: N,
    /// The absolute error of each number in `at`.
    pub(super) off: N,
}

// All functions are inlined: others would be compiled without the kernel's target features.
impl<N: Lanes> Models<N> {
    #[inline(always)]
    pub(super) fn load(&[c0, c1, c2, error]: &StoredModels) -> Self {
        Self { c: [N::load(&c0), N::load(&c1), N::load(&c2)], error: N::load(&error) }
    }

    /// Returns the models of the constant, coordinate or operation at `index`.
    #[inline(always)]
    pub(super) fn of_index(tape: &Tape, known: &[StoredModels], index: Index) -> Self {
        match tape.constant(index) {
            Some(value) => Self::constant(value),
            None => Self::load(&known[usize::from(index)]),
        }
    }

    #[inline(always)]
    pub(super) fn store(self) -> StoredModels {
        let [c0, c1, c2] = self.c;
        [c0.store(), c1.store(), c2.store(), self.error.store()]
    }

    #[inline(always)]
    pub(super) fn with_enlarged_error(c: [N; 3], error: N) -> Self {
        let room = N::splat(1.0 + 16.0 * EPSILON);
        Self { c, error: error * room + N::splat(16.0 * f32::MIN_POSITIVE) }
    }

    #[inline(always)]
    pub(super) fn anything() -> Self {
        Self { c: [N::splat(0.0); 3], error: N::splat(f32::INFINITY) }
    }

    #[inline(always)]
    pub(super) fn constant(value: f64) -> Self {
        let (zero, rounded) = (N::splat(0.0), value as f32);
        let error = if f64::from(rounded) == value { 0.0 } else { enlarged(EPSILON * rounded.abs()) };
        Self { c: [N::splat(rounded), zero, zero], error: N::splat(error) }
    }

    #[inline(always)]
    pub(super) fn hull(low: N, high: N) -> Self {
        let half = N::splat(0.5);
        let rounding = N::splat(4.0 * EPSILON) * (low.abs() + high.abs());
        let zero = N::splat(0.0);
        Self::with_enlarged_error([half * low + half * high, zero, zero], half * high - half * low + rounding)
    }

    #[inline(always)]
    pub(super) fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        let pick = |axis: usize| N::select(mask, yes.c[axis], no.c[axis]);
        Self { c: [pick(0), pick(1), pick(2)], error: N::select(mask, yes.error, no.error) }
    }

    #[inline(always)]
    pub(super) fn coefficient_abs_sum(self) -> N {
        self.c[0].abs() + self.c[1].abs() + self.c[2].abs()
    }

    #[inline(always)]
    pub(super) fn range(self) -> [N; 2] {
        let (Self { c: [c0, c1, c2], error }, zero) = (self, N::splat(0.0));
        let slack = error + N::splat(4.0 * EPSILON) * self.coefficient_abs_sum();
        [c0 - c1.abs() + c2.min(zero) - slack, c0 + c1.abs() + c2.max(zero) + slack]
    }

    /// Returns narrower bounds than [`range`](Self::range), by the polynomial's extremum.
    #[inline(always)]
    pub(super) fn tight_range(self) -> [N; 2] {
        let (Self { c: [c0, c1, c2], error }, two) = (self, N::splat(2.0));
        let (size, slack) = (c1.abs(), error + N::splat(8.0 * EPSILON) * self.coefficient_abs_sum());
        // The quotient, below 2 where this is selected, comes first: `c1 * c1` may underflow to 0.
        let extremum = c0 - c1 * (N::splat(0.25) * (c1 / c2));
        let low = N::select(size.lt(two * c2), extremum, c0 - size + c2);
        let high = N::select(size.lt(-(two * c2)), extremum, c0 + size + c2);
        [low - slack, high + slack]
    }

    #[inline(always)]
    pub(super) fn negate(self) -> Self {
        let [c0, c1, c2] = self.c;
        Self { c: [-c0, -c1, -c2], error: self.error }
    }

    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.c, other.c);
        let [c0, c1, c2] = [a0 + b0, a1 + b1, a2 + b2];
        let rounding = N::splat(EPSILON) * (c0.abs() + c1.abs() + c2.abs());
        Self::with_enlarged_error([c0, c1, c2], self.error + other.error + rounding)
    }

    #[inline(always)]
    pub(super) fn times(self, other: Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.c, other.c);
        let (of_a, of_b) = (self.coefficient_abs_sum(), other.coefficient_abs_sum());
        let orders = [a0 * b0, a0 * b1 + a1 * b0, a0 * b2 + a1 * b1 + a2 * b0, a1 * b2 + a2 * b1, a2 * b2];
        let rounding = N::splat(4.0 * EPSILON) * of_a * of_b;
        let error = self.error * (of_b + other.error) + other.error * of_a + rounding;
        Self::lowered(orders, error)
    }

    /// Returns the models of polynomials of order 4, from their coefficients.
    // By Chebyshev's polynomials: from -1 to 1, u^3 is 3/4 u but for 1/4, and u^4 is u^2 - 1/8 but for 1/8. With the
    // whole terms in the error, rays took up to a half more pieces.
    #[inline(always)]
    fn lowered([c0, c1, c2, c3, c4]: [N; 5], error: N) -> Self {
        let (quarter, eighth) = (N::splat(0.25), N::splat(0.125) * c4);
        let beyond = quarter * c3.abs() + eighth.abs();
        Self::with_enlarged_error([c0 - eighth, c1 + N::splat(0.75) * c3, c2 + c4], beyond + error)
    }

    /// Returns the product with a number; the error allows for a number that was rounded to f32.
    #[inline(always)]
    pub(super) fn scaled(self, factor: N) -> Self {
        let ([c0, c1, c2], size) = (self.c, factor.abs());
        let error = self.error * size + N::splat(2.0 * EPSILON) * size * self.coefficient_abs_sum();
        Self::with_enlarged_error([c0 * factor, c1 * factor, c2 * factor], error)
    }

    /// Returns the sum with a number; the error allows for a number that was rounded to f32.
    #[inline(always)]
    pub(super) fn shifted(self, term: N) -> Self {
        let ([c0, c1, c2], size) = (self.c, term.abs());
        let shifted = c0 + term;
        let rounding = N::splat(EPSILON) * (shifted.abs() + size);
        Self::with_enlarged_error([shifted, c1, c2], self.error + rounding)
    }

    /// Returns a function of these models: its Taylor polynomial, or `hull` if that is narrower.
    #[inline(always)]
    pub(super) fn function(self, taylor: Taylor<N>, hull: Self) -> Self {
        self.taylor(taylor).or_if_narrower(hull)
    }

    #[inline(always)]
    pub(super) fn taylor(self, Taylor { at: [g, g1, g2, g3], fourth, off }: Taylor<N>) -> Self {
        let (Self { c: [_, c1, c2], error }, one, two, three) = (self, N::splat(1.0), N::splat(2.0), N::splat(3.0));
        let (sizes, square) = (c1.abs() + c2.abs(), c1 * c1);
        let (spread, of_g1, of_g2, of_g3) = (sizes + error, g1.abs(), g2.abs(), g3.abs());
        let cubic = c1 * (two * g2 * c2 + g3 * square);
        let orders = [g, g1 * c1, g1 * c2 + g2 * square, cubic, c2 * (g2 * c2 + three * g3 * square)];
        // The terms of orders 5 and 6.
        let beyond = of_g3 * c2 * c2 * (three * c1.abs() + c2.abs());
        let of_error = error * (of_g1 + spread * (two * of_g2 + three * spread * of_g3));
        let rounding = N::splat(8.0 * EPSILON) * (g.abs() + sizes * (of_g1 + sizes * (of_g2 + sizes * of_g3)));
        let of_values = off * (one + spread * (one + spread * (one + spread)));
        // A bound that has underflowed to 0 no longer bounds anything.
        let fourth = N::select(fourth.lt(N::splat(f32::MIN_POSITIVE)), N::splat(f32::INFINITY), fourth);
        let squared = spread * spread;
        Self::lowered(orders, beyond + of_error + fourth * squared * squared + rounding + of_values)
    }

    /// Returns the models with the smaller errors.
    #[inline(always)]
    pub(super) fn or_if_narrower(self, hull: Self) -> Self {
        let is_closer = self.error.le(hull.error) | !hull.error.le(hull.error);
        Self::select(is_closer, self, hull)
    }

    #[inline(always)]
    pub(super) fn squared(self) -> Self {
        let (Self { c: [c0, c1, c2], error }, size) = (self, self.coefficient_abs_sum());
        let (two, four) = (N::splat(2.0), N::splat(4.0 * EPSILON));
        let doubled = two * c0;
        let orders = [c0 * c0, doubled * c1, doubled * c2 + c1 * c1, two * c1 * c2, c2 * c2];
        let taylor = Self::lowered(orders, error * (two * size + error) + four * size * size);
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
    pub(super) fn absolute(self) -> Self {
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
    pub(super) fn minimum(self, other: Self) -> Self {
        let (difference, zero) = (self.plus(other.negate()), N::splat(0.0));
        let [low, high] = difference.range();
        let blend = self.plus(other).plus(difference.absolute().negate()).scaled(N::splat(0.5));
        Self::select(high.le(zero), self, Self::select(zero.le(low), other, blend))
    }

    /// Returns the first operand in the lanes of the first mask, the second one in those of the
    /// second mask, and else these models.
    #[inline(always)]
    pub(super) fn chosen(self, chosen: [u8; 2], [first, second]: [Self; 2]) -> Self {
        if chosen == [0; 2] {
            return self;
        }
        let of_second = Self::select(N::mask_from_bits(u32::from(chosen[1])), second, self);
        Self::select(N::mask_from_bits(u32::from(chosen[0])), first, of_second)
    }

    /// Returns the sines and the cosines.
    #[inline(always)]
    pub(super) fn sin_and_cos(self) -> [Self; 2] {
        let c0 = self.c[0];
        let ([sin, cos], one) = (sin_cos(c0), N::splat(1.0));
        let off = N::select(c0.abs().le(N::splat(LARGEST_ANGLE)), N::splat(SINE_ERROR), N::splat(f32::INFINITY));
        let hull = Self::hull(-one, one);
        [self.sine([sin, cos, off], hull), self.sine([cos, -sin, off], hull)]
    }

    /// Returns the sines or cosines from their values and slopes at c0, and the error of both.
    #[inline(always)]
    pub(super) fn sine(self, [value, slope, off]: [N; 3], hull: Self) -> Self {
        let at = [value, slope, N::splat(-0.5) * value, N::splat(-1.0 / 6.0) * slope];
        self.function(Taylor { at, fourth: N::splat(1.0 / 23.9), off }, hull)
    }

    /// Returns e to the quantity by its Taylor polynomial.
    ///
    /// `value` is the function at c0, `most` its largest value on the piece, and `off` the error of `value`.
    // Not a closure, which would be compiled without the kernel's target features: that took four times as long.
    #[inline(always)]
    pub(super) fn exponential_taylor(self, [value, most, off]: [N; 3]) -> Self {
        let fourth = most * N::splat(1.0 / 23.9);
        self.taylor(Taylor { at: [value, value, N::splat(0.5) * value, N::splat(1.0 / 6.0) * value], fourth, off })
    }

    #[inline(always)]
    pub(super) fn exponential(self) -> Self {
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

/// Returns a number in all lanes.
// Not a closure, which would be compiled without the kernel's target features.
#[inline(always)]
fn number<N: Lanes>(value: f64) -> N {
    N::splat(value as f32)
}

/// Returns sine and cosine, off by at most [`SINE_ERROR`] up to [`LARGEST_ANGLE`].
#[inline(always)]
fn sin_cos<N: Lanes>(x: N) -> [N; 2] {
    let (one, two, half) = (number::<N>(1.0), number::<N>(2.0), number::<N>(0.5));
    let quarters = (x * number::<N>(FRAC_2_PI) + half).floor();
    // A quarter turn in three parts, of which the products with the first two are exact (Cody and Waite; Cephes).
    let r = x - quarters * number::<N>(1.570_312_5) - quarters * number::<N>(4.837_512_969_970_703e-4);
    let r = r - quarters * number::<N>(7.549_789_948_768_648e-8);
    let r2 = r * r;
    let odd_part = number::<N>(8.332_160_873_6e-3) - r2 * number::<N>(1.951_529_589_1e-4);
    let sin = r + r * r2 * (r2 * odd_part - number::<N>(1.666_665_461_1e-1));
    let even_part = r2 * number::<N>(2.443_315_711_809_948e-5) - number::<N>(1.388_731_625_493_765e-3);
    let cos = one - half * r2 + r2 * r2 * (r2 * even_part + number::<N>(4.166_664_568_298_827e-2));
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
    // Beyond these limits, `scale` would be subnormal or infinite.
    let x = x.max(number::<N>(-87.0)).min(number::<N>(88.0));
    // ln 2 is split in two, so that `power` times the first part is exact. The polynomial is that of Cephes.
    let power = (x * number::<N>(std::f64::consts::LOG2_E) + number::<N>(0.5)).floor();
    let r = x - power * number::<N>(0.693_359_375) + power * number::<N>(2.121_944_4e-4);
    let mut sum = number::<N>(1.987_569_150_0e-4);
    for c in [1.398_199_950_7e-3, 8.333_451_907_3e-3, 4.166_579_589_4e-2, 1.666_666_545_9e-1, 0.5] {
        sum = sum * r + number::<N>(c);
    }
    // The sum is a whole number between 2^23 and 2^24: its lowest bits are the biased exponent.
    let biased = power + N::splat(12_582_912.0 + 127.0);
    let [scale] = N::map_lanes([biased], |[biased]| [f32::from_bits(biased.to_bits() << 23)]);
    (sum * r * r + r + number::<N>(1.0)) * scale
}
