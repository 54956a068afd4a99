//! Taylor models: a quadratic polynomial and a bound of its distance from the true value.
//!
//! A [`Model`] encloses a quantity on a piece of a ray, whose parameter u runs from -1 to 1: the quantity is
//! c0 + c1 u + c2 u^2, off by at most `error`. Errors include those of f64 arithmetic, so that the true value of the
//! real function is enclosed. An error that is infinite or NaN encloses everything; comparisons with it must therefore
//! be written so that NaN decides nothing.

use super::elementary;
use super::operation::{Binary, Index, Operation, Unary};
use super::tape::{Steps, Tape};
use std::f64::consts::{FRAC_PI_2, PI};

/// Twice the largest relative rounding error of an f64 operation.
pub(super) const EPSILON: f64 = f64::EPSILON;

/// A quantity along a piece of a ray.
// The polynomial has order 2: in a prototype, order 1 took up to 1.6 times as long, order 3 up to 1.3 times, and order
// 6, which is exact for most polynomials, up to 2.2 times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Model {
    /// The coefficients of the polynomial.
    pub(super) c: [f64; 3],
    /// The largest distance of the quantity from the polynomial.
    pub(super) error: f64,
}

/// The continuity of a formula on a piece of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Continuity {
    /// Whether some operation may jump, or be undefined in a part of the piece.
    pub(super) may_jump: bool,
    /// Whether some operation is undefined everywhere on the piece.
    pub(super) is_undefined: bool,
}

impl Model {
    pub(super) const ANYTHING: Self = Self { c: [0.0; 3], error: f64::INFINITY };

    /// Returns the model with `error`, raised a little because its own computation was rounded.
    fn with_enlarged_error(c: [f64; 3], error: f64) -> Self {
        // No term of `error` is rounded more than 32 times, each time by half of EPSILON at most. Products that
        // underflow to 0 add less than MIN_POSITIVE.
        Self { c, error: error * (1.0 + 16.0 * EPSILON) + f64::MIN_POSITIVE }
    }

    /// Returns the model of a constant, whose error is 0.
    pub(super) fn constant(value: f64) -> Self {
        Self { c: [value, 0.0, 0.0], error: 0.0 }
    }

    /// Returns the model that encloses all values between two numbers.
    fn hull(low: f64, high: f64) -> Self {
        // Halved first, because the sum may overflow.
        let middle = 0.5 * low + 0.5 * high;
        let rounding = 4.0 * EPSILON * (low.abs() + high.abs());
        Self::with_enlarged_error([middle, 0.0, 0.0], 0.5 * high - 0.5 * low + rounding)
    }

    /// Returns the model of `origin + t * direction` for t in `from..=to`.
    pub(super) fn coordinate(origin: f64, direction: f64, [from, to]: [f64; 2]) -> Self {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let (at_middle, slope) = (middle * direction, half * direction);
        let rounding = 4.0 * EPSILON * (origin.abs() + at_middle.abs() + (from.abs() + to.abs()) * direction.abs());
        Self::with_enlarged_error([origin + at_middle, slope, 0.0], rounding)
    }

    /// Returns the model of a coordinate that may be any number in a range, for points in a box.
    pub(super) fn anything_between(low: f64, high: f64) -> Self {
        Self::hull(low, high)
    }

    /// Returns the sum of the coefficients' magnitudes.
    fn coefficient_abs_sum(&self) -> f64 {
        self.c[0].abs() + self.c[1].abs() + self.c[2].abs()
    }

    /// Returns a lower and an upper bound of the quantity.
    pub(super) fn range(&self) -> [f64; 2] {
        let Self { c: [c0, c1, c2], error } = *self;
        let slack = error + 4.0 * EPSILON * self.coefficient_abs_sum();
        [c0 - c1.abs() + c2.min(0.0) - slack, c0 + c1.abs() + c2.max(0.0) + slack]
    }

    fn negate(self) -> Self {
        Self { c: self.c.map(|c| -c), error: self.error }
    }

    fn plus(self, other: Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.c, other.c);
        let rounding = EPSILON * (self.coefficient_abs_sum() + other.coefficient_abs_sum());
        Self::with_enlarged_error([a0 + b0, a1 + b1, a2 + b2], self.error + other.error + rounding)
    }

    fn minus(self, other: Self) -> Self {
        self.plus(other.negate())
    }

    /// Returns the model of the product, whose terms of orders 3 and 4 go into the error.
    fn times(self, other: Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.c, other.c);
        let (of_a, of_b) = (self.coefficient_abs_sum(), other.coefficient_abs_sum());
        let beyond = (a1 * b2).abs() + (a2 * b1).abs() + (a2 * b2).abs();
        let error = self.error * (of_b + other.error) + other.error * of_a + 4.0 * EPSILON * of_a * of_b;
        Self::with_enlarged_error([a0 * b0, a0 * b1 + a1 * b0, a0 * b2 + a1 * b1 + a2 * b0], beyond + error)
    }

    fn scaled(self, factor: f64) -> Self {
        let error = self.error * factor.abs() + EPSILON * factor.abs() * self.coefficient_abs_sum();
        Self::with_enlarged_error(self.c.map(|c| c * factor), error)
    }

    /// Returns the model of a function g of the quantity.
    ///
    /// It is the Taylor polynomial at c0, or the range `hull` if that has the smaller error. `[g, g1, g2]` are g, g'
    /// and g'' / 2 at c0, and `third` is a bound of |g'''| / 6 on the range.
    fn function(self, [g, g1, g2]: [f64; 3], third: f64, hull: [f64; 2]) -> Self {
        let Self { c: [_, c1, c2], error } = self;
        let spread = c1.abs() + c2.abs() + error;
        // The square of c1 u + c2 u^2 ± error differs from c1^2 u^2 by at most this.
        let beyond = 2.0 * (c1 * c2).abs() + c2 * c2 + error * (2.0 * (c1.abs() + c2.abs()) + error);
        let (linear, square) = (g1 * c2, g2 * c1 * c1);
        let rounding = 8.0 * EPSILON * (g.abs() + (g1 * c1).abs() + linear.abs() + square.abs());
        // A bound that has underflowed no longer bounds anything, so it is replaced by infinity.
        let third = if third < f64::MIN_POSITIVE { f64::INFINITY } else { third };
        let remainder = third * spread * spread * spread;
        let taylor = Self::with_enlarged_error(
            [g, g1 * c1, linear + square],
            g1.abs() * error + g2.abs() * beyond + remainder + rounding,
        );
        let hull = Self::hull(hull[0], hull[1]);
        if taylor.error <= hull.error || hull.error.is_nan() { taylor } else { hull }
    }
}

/// The evaluation of operations, which records whether they may jump or are undefined.
pub(super) struct Evaluation<'c>(pub(super) &'c mut Continuity);

impl Evaluation<'_> {
    /// Notes that an operation may jump, and whether it is undefined everywhere; returns
    /// [`Model::ANYTHING`].
    fn anything(&mut self, is_undefined: bool) -> Model {
        self.0.may_jump = true;
        self.0.is_undefined |= is_undefined;
        Model::ANYTHING
    }

    pub(super) fn unary(&mut self, function: Unary, a: Model) -> Model {
        let [low, high] = a.range();
        // Negated, so that the branch is also taken if a bound is NaN.
        if !(high - low < f64::INFINITY) {
            return match function {
                Unary::Negate => a.negate(),
                Unary::Sin | Unary::Cos => Model::hull(-1.0, 1.0),
                Unary::Abs | Unary::Square | Unary::Cbrt | Unary::Exp | Unary::Atan => Model::ANYTHING,
                _ => self.anything(false),
            };
        }
        let c0 = a.c[0];
        let (value, around) = (function.at(c0), [function.at(low), function.at(high)]);
        match function {
            Unary::Negate => a.negate(),
            Unary::Abs => absolute(a),
            Unary::Square => square(a),
            Unary::Sqrt => self.square_root(a, false),
            Unary::SqrtOfNonNegative => self.square_root(a, true),
            Unary::Cbrt => cube_root(a),
            // 5.9 instead of 6, and below 2.9, 15.9 and 1.01 instead of 3, 16 and 1: room for the rounding of the bound
            // itself.
            Unary::Exp => a.function([value, value, 0.5 * value], around[1] / 5.9, around),
            Unary::Ln if high <= 0.0 => self.anything(true),
            Unary::Ln if low <= 0.0 => self.anything(false),
            Unary::Ln => {
                let inverse = 1.0 / c0;
                let third = 1.0 / (2.9 * low * low * low);
                a.function([value, inverse, -0.5 * inverse * inverse], third, around)
            }
            Unary::Sin => a.function([value, elementary::cos(c0), -0.5 * value], 1.0 / 5.9, [-1.0, 1.0]),
            Unary::Cos => a.function([value, -elementary::sin(c0), -0.5 * value], 1.0 / 5.9, [-1.0, 1.0]),
            Unary::Tan => self.tangent(a, value, around),
            Unary::Asin => self.arc_sine(a),
            Unary::Atan => {
                let slope = 1.0 / (1.0 + c0 * c0);
                a.function([value, slope, -c0 * slope * slope], 1.0 / 2.9, around)
            }
            Unary::Floor | Unary::Step => {
                self.0.may_jump |= around[0] != around[1];
                if around[0] == around[1] { Model::constant(around[0]) } else { Model::hull(around[0], around[1]) }
            }
        }
    }

    fn square_root(&mut self, a: Model, is_non_negative: bool) -> Model {
        let [low, high] = a.range();
        if high < 0.0 {
            return self.anything(true);
        }
        if low <= 0.0 {
            self.0.may_jump |= !is_non_negative;
            return Model::hull(0.0, high.sqrt());
        }
        let value = a.c[0].sqrt();
        let slope = 0.5 / value;
        let third = 1.0 / (15.9 * low * low * low.sqrt());
        a.function([value, slope, -0.25 * slope / a.c[0]], third, [low.sqrt(), high.sqrt()])
    }

    fn tangent(&mut self, a: Model, value: f64, around: [f64; 2]) -> Model {
        let [low, high] = a.range();
        // The number of the tangent's branch at x, from pole to pole, with room for the rounding of the division.
        let branch = |x: f64, slack: f64| libm::floor(x / PI + 0.5 + slack * (1.0 + x.abs()) * 4.0 * EPSILON);
        if branch(low, -1.0) != branch(high, 1.0) {
            return self.anything(false);
        }
        let slope = 1.0 + value * value;
        let steepest = around[0].abs().max(around[1].abs());
        let squared = steepest * steepest;
        a.function([value, slope, value * slope], (1.0 + squared) * (1.0 + 3.0 * squared) / 2.9, around)
    }

    fn arc_sine(&mut self, a: Model) -> Model {
        let [low, high] = a.range();
        if low > 1.0 || high < -1.0 {
            return self.anything(true);
        }
        let hull = [libm::asin(low.max(-1.0)), libm::asin(high.min(1.0))];
        let largest = low.abs().max(high.abs());
        if largest >= 1.0 {
            self.0.may_jump = true;
            return Model::hull(hull[0], hull[1]);
        }
        // As a product, which does not cancel near 1 as 1 - x^2 does.
        let inverse = |x: f64| 1.0 / ((1.0 - x) * (1.0 + x)).sqrt();
        let (c0, q, steepest) = (a.c[0], inverse(a.c[0]), inverse(largest));
        let squared = steepest * steepest;
        let third = (1.0 + 2.0 * largest * largest) * squared * squared * steepest / 5.9;
        a.function([libm::asin(c0), q, 0.5 * c0 * q * q * q], third, hull)
    }

    pub(super) fn binary(&mut self, function: Binary, a: Model, b: Model) -> Model {
        match function {
            Binary::Add => a.plus(b),
            Binary::Subtract => a.minus(b),
            Binary::Multiply => a.times(b),
            Binary::Divide => self.quotient(a, b),
            Binary::Min => minimum(a, b),
            Binary::Max => minimum(a.negate(), b.negate()).negate(),
            Binary::Atan2 => self.angle(a, b),
        }
    }

    fn quotient(&mut self, a: Model, b: Model) -> Model {
        let [low, high] = b.range();
        // Negated, so that the branch is also taken if a bound is NaN.
        if !(low > 0.0 || high < 0.0) {
            return self.anything(low == 0.0 && high == 0.0);
        }
        let (value, nearest) = (1.0 / b.c[0], low.abs().min(high.abs()));
        let squared = nearest * nearest;
        let third = 1.01 / (squared * squared);
        let inverse = b.function([value, -value * value, value * value * value], third, [1.0 / high, 1.0 / low]);
        a.times(inverse)
    }

    /// Returns the angle of the point (x, y), which jumps where y is 0 and x is negative.
    fn angle(&mut self, y: Model, x: Model) -> Model {
        let ([low_x, high_x], [low_y, high_y]) = (x.range(), y.range());
        if low_x > 0.0 {
            let quotient = self.quotient(y, x);
            self.unary(Unary::Atan, quotient)
        } else if low_y > 0.0 || high_y < 0.0 {
            let quotient = self.quotient(x, y);
            let quarter = Model::constant(FRAC_PI_2.copysign(low_y));
            quarter.minus(self.unary(Unary::Atan, quotient))
        } else {
            self.0.may_jump = true;
            self.0.is_undefined |= (low_x, high_x, low_y, high_y) == (0.0, 0.0, 0.0, 0.0);
            Model::hull(-PI, PI)
        }
    }
}

/// Returns |a|: `a`, its negative or, if its range contains 0, the chord of |a| over the range.
fn absolute(a: Model) -> Model {
    let [low, high] = a.range();
    if low >= 0.0 {
        a
    } else if high <= 0.0 {
        a.negate()
    } else if high - low < f64::INFINITY {
        // The chord from (low, -low) to (high, high) is above |a| by at most its value at 0.
        let slope = (high + low) / (high - low);
        let at_zero = -2.0 * low * high / (high - low);
        let rounding = 16.0 * EPSILON * (at_zero + high - low);
        a.scaled(slope).plus(Model::with_enlarged_error([0.5 * at_zero, 0.0, 0.0], 0.5 * at_zero + rounding))
    } else {
        Model::ANYTHING
    }
}

fn square(a: Model) -> Model {
    let ([low, high], taylor) = (a.range(), a.times(a));
    let (one, other) = (low * low, high * high);
    let least = if low <= 0.0 && high >= 0.0 { 0.0 } else { one.min(other) };
    let hull = Model::hull(least, one.max(other));
    if taylor.error <= hull.error || hull.error.is_nan() { taylor } else { hull }
}

fn cube_root(a: Model) -> Model {
    let [low, high] = a.range();
    let hull = [libm::cbrt(low), libm::cbrt(high)];
    if low <= 0.0 && high >= 0.0 {
        return Model::hull(hull[0], hull[1]);
    }
    let (value, nearest) = (libm::cbrt(a.c[0]), hull[0].abs().min(hull[1].abs()));
    let (squared, fourth) = (value * value, nearest * nearest * nearest * nearest);
    let third = 1.01 * 10.0 / (27.0 * 6.0 * fourth * fourth);
    a.function([value, 1.0 / (3.0 * squared), -1.0 / (9.0 * squared * squared * value)], third, hull)
}

/// Returns the smaller of two models if that is certain, else the model of (a + b - |a - b|) / 2.
fn minimum(a: Model, b: Model) -> Model {
    let difference = a.minus(b);
    let [low, high] = difference.range();
    if high <= 0.0 {
        a
    } else if low >= 0.0 {
        b
    } else {
        a.plus(b).minus(absolute(difference)).scaled(0.5)
    }
}

impl Tape {
    /// Returns the model and the continuity of the formula for models of x, y and z.
    ///
    /// `models` is scratch memory.
    pub(super) fn model(&self, coordinates: [Model; 3], models: &mut Vec<Model>) -> (Model, Continuity) {
        self.model_of_steps(self.steps(), 0, coordinates, models)
    }

    /// Returns the model and the continuity of the result of some steps, for the choices of a lane.
    pub(super) fn model_of_steps(
        &self,
        steps: Steps<'_>,
        lane: usize,
        coordinates: [Model; 3],
        models: &mut Vec<Model>,
    ) -> (Model, Continuity) {
        models.clear();
        models.extend(coordinates);
        models.push(Model::ANYTHING);
        let mut continuity = Continuity::default();
        let mut evaluation = Evaluation(&mut continuity);
        let of = |models: &[Model], index: Index| match self.constant(index) {
            Some(value) => Model::constant(value),
            None => models[usize::from(index)],
        };
        for (at, &operation) in steps.operations.iter().enumerate() {
            if steps.needed(at) >> lane & 1 == 0 {
                models.push(Model::ANYTHING);
                continue;
            }
            let [is_first, is_second] = steps.chosen(at).map(|lanes| lanes >> lane & 1 == 1);
            let model = match operation {
                Operation::Unary(_, a) if is_first => of(models, a),
                Operation::Binary(_, a, _) if is_first => of(models, a),
                Operation::Binary(_, _, b) if is_second => of(models, b),
                Operation::Unary(function, a) => evaluation.unary(function, of(models, a)),
                Operation::Binary(function, a, b) => evaluation.binary(function, of(models, a), of(models, b)),
            };
            models.push(model);
        }
        (of(models, steps.result), continuity)
    }
}
