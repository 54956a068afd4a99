//! Taylor models of a formula on pieces of rays, of eight rays at once, in f32.
//!
//! The frequent operations have a vector form, in [`models`](super::models) and here; all others are computed lane by
//! lane in f64. The bits of a lane do not depend on the other lanes.

use super::extremes::Extreme;
use super::forecast::SignForecasts;
use super::model::{Continuity, EPSILON as EPSILON_64, Evaluation, Model};
use super::models::{EPSILON, Models, StoredModels, Taylor, enlarged, model_of_lane};
use super::operation::{Binary, COORDINATES, Operation, Unary};
use super::tape::{Steps, Tape};
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, SimdKernel, set_bits};

/// The origins of eight lines, then their directions, axis by axis.
pub(super) type Lines = [[[f64; LANES]; 3]; 2];

/// Eight values, one per lane.
pub(super) type EightValues = [f64; LANES];

/// The kernel that computes the models of a formula on eight pieces, for the lanes in `lanes`.
pub(super) struct PacketModels<'a> {
    pub(super) tape: &'a Tape,
    pub(super) steps: Steps<'a>,
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
        let Self { tape, mut steps, lanes, .. } = self;
        if steps.extremes.len() > 1 {
            steps.operations = &steps.operations[..tape.combining()];
        }
        let (models, [may_jump, is_undefined]) = PacketModels { steps, ..self }.models::<N>();
        let mut greatest: Option<SignForecasts> = None;
        for &Extreme { index, is_negated } in steps.extremes {
            let models = Models::<N>::of_index(tape, models, index);
            // The least value is the greatest negated one, negated.
            let models = if is_negated == steps.is_least { models } else { models.negate() };
            let forecasts = models.sign_forecasts(lanes, may_jump, is_undefined);
            greatest = Some(match greatest {
                None => forecasts,
                Some(others) => others.of_greatest::<N>(&forecasts),
            });
        }
        let greatest = greatest.unwrap_or(SignForecasts::UNKNOWN);
        if steps.is_least { greatest.negated() } else { greatest }
    }
}

impl<'a> PacketModels<'a> {
    /// Returns the models of coordinates and operations, and the lanes that may jump, and that are
    /// undefined.
    #[inline(always)]
    pub(super) fn models<N: Lanes>(self) -> (&'a [StoredModels], [u32; 2]) {
        let Self { tape, steps, lines, pieces, lanes, scratch } = self;
        let count = COORDINATES + steps.operations.len();
        if scratch.len() < count {
            scratch.resize(count, [F32x8::ZERO; 4]);
        }
        let all = &mut scratch[..count];
        let ([from, to], mut spans) = (pieces, [[0.0; LANES]; 2]);
        for lane in 0..LANES {
            (spans[0][lane], spans[1][lane]) = (0.5 * (from[lane] + to[lane]), 0.5 * (to[lane] - from[lane]));
        }
        for (to, (origins, directions)) in all.iter_mut().zip(lines[0].iter().zip(&lines[1])) {
            // Inlined three times, the compiler would compute the axes side by side, with gathers and scatters.
            N::call_no_inline(CoordinateModels { origins, directions, pieces: &spans, to });
        }
        let mut evaluation = PacketEvaluation { lanes, may_jump: 0, is_undefined: 0 };
        // Each operation stores its own result, and all but the most frequent ones are functions of their own: with the
        // results merged in registers, moving them took a third of the time.
        for (at, &operation) in steps.operations.iter().enumerate() {
            let (known, rest) = all.split_at_mut(COORDINATES + at);
            match operation {
                Operation::Unary(Unary::Square, a) => {
                    rest[0] = Models::<N>::of_index(tape, known, a).squared().store();
                }
                // Sums and products have their constant last.
                Operation::Binary(Binary::Add, a, b) => {
                    let a = Models::<N>::of_index(tape, known, a);
                    match tape.constant_as_f32(b) {
                        Some(term) => rest[0] = a.shifted(N::splat(term)).store(),
                        None => rest[0] = a.plus(Models::<N>::of_index(tape, known, b)).store(),
                    }
                }
                Operation::Binary(Binary::Multiply, a, b) => {
                    let a = Models::<N>::of_index(tape, known, a);
                    match tape.constant_as_f32(b) {
                        Some(factor) => rest[0] = a.scaled(N::splat(factor)).store(),
                        None => rest[0] = a.times(Models::<N>::of_index(tape, known, b)).store(),
                    }
                }
                Operation::Binary(Binary::Subtract, a, b) => {
                    let a = Models::<N>::of_index(tape, known, a);
                    match tape.constant_as_f32(b) {
                        Some(term) => rest[0] = a.shifted(N::splat(-term)).store(),
                        None => rest[0] = a.plus(Models::<N>::of_index(tape, known, b).negate()).store(),
                    }
                }
                // Computed together with the sine.
                Operation::Unary(Unary::Cos, _) if at > 0 && Some(steps.operations[at - 1]) == operation.twin() => {}
                _ => {
                    let with_next = steps.operations.get(at + 1) == operation.twin().as_ref();
                    let (chosen, evaluation) = (steps.chosen(at), &mut evaluation);
                    evaluation.lanes = lanes & steps.needed(at);
                    N::call_no_inline(RareOperation { tape, operation, with_next, chosen, known, rest, evaluation });
                }
            }
        }
        (all, [evaluation.may_jump, evaluation.is_undefined])
    }
}

/// The kernel that computes the models of an operation.
struct RareOperation<'a> {
    tape: &'a Tape,
    operation: Operation,
    /// Whether the next operation is the cosine of the same angle.
    with_next: bool,
    chosen: [u8; 2],
    known: &'a [StoredModels],
    /// The models of the operation and those behind it.
    rest: &'a mut [StoredModels],
    evaluation: &'a mut PacketEvaluation,
}

impl SimdKernel for RareOperation<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { tape, operation, with_next, chosen, known, rest, evaluation } = self;
        let [a, b] = operation.operands();
        let (a, b) = (Models::<N>::of_index(tape, known, a), Models::<N>::of_index(tape, known, b));
        let models = match operation {
            Operation::Unary(Unary::Sin, _) if with_next => {
                let [sine, cosine] = a.sin_and_cos();
                rest[1] = cosine.store();
                sine
            }
            Operation::Unary(function, _) => evaluation.unary(function, a),
            Operation::Binary(function, ..) => evaluation.binary(function, a, b),
        };
        rest[0] = models.chosen(chosen, [a, b]).store();
    }
}

/// The kernel that computes the models of one coordinate: see [`Model::coordinate`].
struct CoordinateModels<'a> {
    origins: &'a EightValues,
    directions: &'a EightValues,
    /// The middles of the pieces, then half their lengths.
    pieces: &'a [EightValues; 2],
    to: &'a mut StoredModels,
}

impl SimdKernel for CoordinateModels<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { origins: o, directions: d, pieces: [middles, halves], to } = self;
        let [mut c0, mut c1, mut of_origin] = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            (c0[lane], c1[lane]) = ((o[lane] + middles[lane] * d[lane]) as f32, (halves[lane] * d[lane]) as f32);
            of_origin[lane] = o[lane] as f32;
        }
        let [c0, c1, of_origin] = [c0, c1, of_origin].map(F32x8);
        let (c0, c1) = (N::load(&c0), N::load(&c1));
        // The rounding errors in f64 are at most 16 `EPSILON_64` of |o|, |c0| and |c1|. Those of |c0| and |c1| are
        // covered by `EPSILON`, which is twice the rounding error in f32.
        let of_origin = N::splat((16.0 * EPSILON_64) as f32) * N::load(&of_origin).abs();
        let rounding = N::splat(EPSILON) * (c0.abs() + c1.abs()) + of_origin;
        *to = Models::with_enlarged_error([c0, c1, N::splat(0.0)], rounding).store();
    }
}

/// The evaluation of operations, which records the lanes in which they may jump or are undefined.
struct PacketEvaluation {
    /// The lanes that need the operation that is evaluated; only these are recorded.
    lanes: u32,
    may_jump: u32,
    is_undefined: u32,
}

impl PacketEvaluation {
    #[inline(always)]
    fn unary<N: Lanes>(&mut self, function: Unary, a: Models<N>) -> Models<N> {
        match function {
            Unary::Negate => a.negate(),
            Unary::Abs => a.absolute(),
            Unary::Square => a.squared(),
            Unary::Sin => a.sin_and_cos()[0],
            Unary::Cos => a.sin_and_cos()[1],
            Unary::Exp => a.exponential(),
            Unary::Sqrt => self.square_root(a, false),
            Unary::SqrtOfNonNegative => self.square_root(a, true),
            _ => self.lane_by_lane([a, a], |evaluation, [a, _]| evaluation.unary(function, a)),
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
        self.may_jump |= mask.bits() & self.lanes;
        self.is_undefined |= is_undefined.bits() & self.lanes;
        Models::select(mask, Models::anything(), else_)
    }

    #[inline(always)]
    fn square_root<N: Lanes>(&mut self, a: Models<N>, is_non_negative: bool) -> Models<N> {
        let ([low, high], zero) = (a.range(), N::splat(0.0));
        let value = a.c[0].sqrt();
        let slope = N::splat(0.5) / value;
        let root = low.sqrt();
        let inverse = N::splat(1.0) / a.c[0];
        let half_second = N::splat(-0.25) * slope * inverse;
        let at = [value, slope, half_second, N::splat(-0.5) * half_second * inverse];
        let fourth = N::splat(1.0) / (N::splat(25.5) * low * low * low * root);
        let taylor = Taylor { at, fourth, off: zero };
        let of_positive = a.function(taylor, Models::hull(root, high.sqrt()));
        let is_positive = zero.lt(low);
        let of_any = Models::select(is_positive, of_positive, Models::hull(zero, high.max(zero).sqrt()));
        if !is_non_negative {
            self.may_jump |= (!is_positive).bits() & self.lanes;
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
            at: [value, -(value * value), value * value * value, -(value * value) * (value * value)],
            fourth: N::splat(1.01) / (squared * squared * nearest),
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
