//! Values of a formula in f64 at two points on each of eight lines.

use super::elementary::{exp_of_each, sin_and_cos_of_each};
use super::operation::{Binary, COORDINATES, Index, Operation, Unary};
use super::packet::{EightValues, Lines};
use super::tape::{Steps, Tape};
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
            let mut values = [[0.0; LANES]; 2];
            for (values, t) in values.iter_mut().zip(t) {
                for (value, (t, (o, d))) in values.iter_mut().zip(t.iter().zip(o.iter().zip(d))) {
                    *value = o + d * t;
                }
            }
            to.copy_from_slice(values.as_flattened());
        }
        for (at, &operation) in steps.operations.iter().enumerate() {
            let (known, rest) = all.split_at_mut(COORDINATES + at);
            match operation {
                Operation::Unary(Unary::Sin, a) if steps.operations.get(at + 1) == operation.twin().as_ref() => {
                    [rest[0], rest[1]] = sin_and_cos_of_each(values_at(tape, known, a, &mut [0.0; COUNT]));
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
        // Copied as a whole: number by number, the copy would wait for its own stores.
        let mut values = [[0.0; LANES]; 2];
        values.as_flattened_mut().copy_from_slice(values_at(tape, all, steps.result, &mut [0.0; COUNT]));
        values
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

/// Computes a number from each value.
// In an array of its own, which overlaps no operand: in place, the loop would not become vector instructions.
#[inline(always)]
fn map(a: &PairedValues, function: impl Fn(f64) -> f64) -> PairedValues {
    let mut results = [0.0; COUNT];
    for (result, &a) in results.iter_mut().zip(a) {
        *result = function(a);
    }
    results
}

/// Computes a number from each pair of values.
#[inline(always)]
fn map_pairs(a: &PairedValues, b: &PairedValues, function: impl Fn(f64, f64) -> f64) -> PairedValues {
    let mut results = [0.0; COUNT];
    for (result, (&a, &b)) in results.iter_mut().zip(a.iter().zip(b)) {
        *result = function(a, b);
    }
    results
}

/// Computes a function of each value.
///
/// Frequent functions have a loop of their own, which becomes vector instructions.
#[inline(always)]
fn unary_of_each(function: Unary, a: &PairedValues, to: &mut PairedValues) {
    *to = match function {
        Unary::Negate => map(a, |a| -a),
        Unary::Abs => map(a, f64::abs),
        Unary::Square => map(a, |a| a * a),
        Unary::Sqrt | Unary::SqrtOfNonNegative => map(a, f64::sqrt),
        Unary::Sin => sin_and_cos_of_each(a)[0],
        Unary::Cos => sin_and_cos_of_each(a)[1],
        Unary::Exp => exp_of_each(a),
        _ => map(a, |a| function.at(a)),
    }
}

/// Computes a function of two values in each lane; see [`unary_of_each`].
#[inline(always)]
fn binary_of_each(function: Binary, a: &PairedValues, b: &PairedValues, to: &mut PairedValues) {
    *to = match function {
        Binary::Add => map_pairs(a, b, |a, b| a + b),
        Binary::Subtract => map_pairs(a, b, |a, b| a - b),
        Binary::Multiply => map_pairs(a, b, |a, b| a * b),
        Binary::Divide => map_pairs(a, b, |a, b| a / b),
        Binary::Min => map_pairs(a, b, |a, b| Binary::Min.at(a, b)),
        Binary::Max => map_pairs(a, b, |a, b| Binary::Max.at(a, b)),
        Binary::Atan2 => map_pairs(a, b, |a, b| function.at(a, b)),
    }
}

/// Computes a sum, difference or product of each value and a constant.
#[inline(always)]
fn with_constant_of_each(function: Binary, a: &PairedValues, b: f64, to: &mut PairedValues) {
    *to = match function {
        Binary::Add => map(a, |a| a + b),
        Binary::Subtract => map(a, |a| a - b),
        _ => map(a, |a| a * b),
    }
}
