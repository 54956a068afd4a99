//! Values of a formula in f64 at two points on each of eight lines.

use super::elementary::{exp_of_each, sin_and_cos_of_each};
use super::packet::{EightValues, Lines};
use super::tape::{Binary, COORDINATES, Index, Operation, Steps, Tape, Unary};
use crate::lanes::LANES;

/// The number of values that are computed together.
// The time that each operation takes besides its arithmetic is spread over more values than with eight.
const COUNT: usize = 2 * LANES;

/// Two values in each lane: the first ones of all lanes, then the second ones.
pub(super) type PairedValues = [f64; COUNT];

/// An evaluator of a tape at two points on each of eight lines.
pub(super) struct PacketValues<'a> {
    pub(super) tape: &'a Tape,
    pub(super) steps: Steps<'a>,
    pub(super) lines: &'a Lines,
    pub(super) scratch: &'a mut Vec<PairedValues>,
}

impl PacketValues<'_> {
    /// Returns the values at two `t` on each line.
    ///
    /// They have the same bits as [`Tape::value`] for each lane, whatever the instruction set.
    #[inline(always)]
    pub(super) fn at(&mut self, t: &[EightValues; 2]) -> [EightValues; 2] {
        let Self { tape, steps, lines: [origins, directions], scratch } = self;
        let count = COORDINATES + steps.operations.len();
        if scratch.len() < count {
            scratch.resize(count, [0.0; COUNT]);
        }
        let all = &mut scratch[..count];
        for (to, (o, d)) in all.iter_mut().zip(origins.iter().zip(directions)) {
            for (to, t) in to.chunks_exact_mut(LANES).zip(t) {
                (0..LANES).for_each(|lane| to[lane] = o[lane] + d[lane] * t[lane]);
            }
        }
        for (at, &operation) in steps.operations.iter().enumerate() {
            let (known, rest) = all.split_at_mut(COORDINATES + at);
            match operation {
                Operation::Unary(Unary::Sin, a) if steps.operations.get(at + 1) == operation.twin().as_ref() => {
                    let ((sines, cosines), mut constant) = (rest.split_at_mut(1), [0.0; COUNT]);
                    let a = values_at(tape, known, a, &mut constant);
                    sin_and_cos_of_each(a, &mut sines[0], &mut cosines[0]);
                }
                // Computed together with the sine.
                Operation::Unary(Unary::Cos, _) if at > 0 && Some(steps.operations[at - 1]) == operation.twin() => {}
                Operation::Unary(function, a) => {
                    unary_of_each(function, values_at(tape, known, a, &mut [0.0; COUNT]), &mut rest[0]);
                }
                Operation::Binary(function, a, b) => {
                    let (mut of_a, mut of_b) = ([0.0; COUNT], [0.0; COUNT]);
                    let a = values_at(tape, known, a, &mut of_a);
                    // Sums and products have their constant last.
                    if matches!(function, Binary::Add | Binary::Subtract | Binary::Multiply)
                        && let Some(b) = tape.constant(b)
                    {
                        with_constant_of_each(function, a, b, &mut rest[0]);
                        continue;
                    }
                    let b = values_at(tape, known, b, &mut of_b);
                    binary_of_each(function, a, b, &mut rest[0]);
                    if matches!(function, Binary::Min | Binary::Max) {
                        choose(steps.chosen(at), [a, b], &mut rest[0]);
                    }
                }
            }
        }
        let mut constant = [0.0; COUNT];
        let values = values_at(tape, all, steps.result, &mut constant);
        [0, LANES].map(|first| std::array::from_fn(|lane| values[first + lane]))
    }
}

/// Returns the values of the constant, coordinate or operation at an index.
#[inline(always)]
fn values_at<'v>(
    tape: &Tape,
    known: &'v [PairedValues],
    index: Index,
    constant: &'v mut PairedValues,
) -> &'v PairedValues {
    match tape.constant(index) {
        Some(value) => {
            *constant = [value; COUNT];
            constant
        }
        None => &known[usize::from(index)],
    }
}

/// Replaces values by those of the first operand in the lanes of the first mask, and by those of
/// the second operand in the lanes of the second mask.
#[inline(always)]
fn choose(chosen: [u8; 2], operands: [&PairedValues; 2], values: &mut PairedValues) {
    if chosen == [0; 2] {
        return;
    }
    for (lanes, operand) in chosen.into_iter().zip(operands) {
        for (at, value) in values.iter_mut().enumerate() {
            *value = if lanes >> (at % LANES) & 1 == 1 { operand[at] } else { *value };
        }
    }
}

/// Computes a function of each value.
///
/// Frequent functions have a loop of their own, which becomes vector instructions.
#[inline(always)]
fn unary_of_each(function: Unary, a: &PairedValues, to: &mut PairedValues) {
    match function {
        Unary::Negate => (0..COUNT).for_each(|at| to[at] = -a[at]),
        Unary::Abs => (0..COUNT).for_each(|at| to[at] = a[at].abs()),
        Unary::Square => (0..COUNT).for_each(|at| to[at] = a[at] * a[at]),
        Unary::Sqrt | Unary::SqrtOfNonNegative => (0..COUNT).for_each(|at| to[at] = a[at].sqrt()),
        Unary::Sin => sin_and_cos_of_each(a, to, &mut [0.0; COUNT]),
        Unary::Cos => sin_and_cos_of_each(a, &mut [0.0; COUNT], to),
        Unary::Exp => exp_of_each(a, to),
        _ => (0..COUNT).for_each(|at| to[at] = function.at(a[at])),
    }
}

/// Computes a function of two values in each lane; see [`unary_of_each`].
#[inline(always)]
fn binary_of_each(function: Binary, a: &PairedValues, b: &PairedValues, to: &mut PairedValues) {
    match function {
        Binary::Add => (0..COUNT).for_each(|at| to[at] = a[at] + b[at]),
        Binary::Subtract => (0..COUNT).for_each(|at| to[at] = a[at] - b[at]),
        Binary::Multiply => (0..COUNT).for_each(|at| to[at] = a[at] * b[at]),
        Binary::Divide => (0..COUNT).for_each(|at| to[at] = a[at] / b[at]),
        Binary::Min => (0..COUNT).for_each(|at| to[at] = Binary::Min.at(a[at], b[at])),
        Binary::Max => (0..COUNT).for_each(|at| to[at] = Binary::Max.at(a[at], b[at])),
        Binary::Atan2 => (0..COUNT).for_each(|at| to[at] = function.at(a[at], b[at])),
    }
}

/// Computes a sum, difference or product of each value and a constant.
#[inline(always)]
fn with_constant_of_each(function: Binary, a: &PairedValues, b: f64, to: &mut PairedValues) {
    match function {
        Binary::Add => (0..COUNT).for_each(|at| to[at] = a[at] + b),
        Binary::Subtract => (0..COUNT).for_each(|at| to[at] = a[at] - b),
        _ => (0..COUNT).for_each(|at| to[at] = a[at] * b),
    }
}
