//! Taylor models of a formula on pieces of rays, of eight rays at once, in f32.
//!
//! They are the models of [`model`](super::model) with the rounding of f32. The frequent operations have a vector form
//! here; all others are computed lane by lane in f64. The bits of a lane do not depend on the other lanes.

use super::elementary::{exp_of_each, sin_or_cos_of_each};
use super::forecast::SignForecasts;
use super::model::{Continuity, EPSILON as EPSILON_64, Evaluation, Model};
use super::models::{EPSILON, Models, StoredModels, Taylor, enlarged, model_of_lane};
use super::tape::{Binary, Index, Operation, Tape, Unary};
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Mask, SimdKernel, set_bits};

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
