//! The tape: the operations of a formula, each after its operands, in which equal terms are shared.

use super::extremes::{Extreme, extremes_of};
use super::operation::{Binary, COORDINATES, FIRST_CONSTANT, Index, Operation, Unary};
use crate::lanes::ALL;
use std::collections::HashMap;

/// The largest number of operations of a formula.
// Models and values take 256 bytes for each operation: at most a megabyte in each thread.
pub(super) const MAX_OPERATIONS: usize = 4096;

/// The slot of the time; tapes with it are evaluated only after [`Tape::at_time`].
pub(super) const TIME: u8 = 3;

/// The number of [choices](Tape::has_many_choices) from which on it is worthwhile to shorten the
/// tape for each search.
// Shortening takes about as long as one step of the search.
const MANY_CHOICES: usize = 4;

/// The operations of a formula in the order of evaluation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tape {
    constants: Box<[f64]>,
    operations: Box<[Operation]>,
    /// The number of operations in front of the last ones, of which only the sign matters.
    combining: Index,
    result: Index,
    /// The number of minima, maxima and absolute values.
    choices: Index,
    /// The values of which the result is the least or the greatest; else only the result.
    extremes: Box<[Extreme]>,
    /// Whether the result is the least of `extremes`.
    is_least: bool,
    is_algebraic: bool,
}

/// The operations to evaluate: all of a tape, or a part of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps<'t> {
    pub(super) operations: &'t [Operation],
    /// For each operation the lanes in which it is its first operand, and those in which it is its
    /// second operand; empty if there are no such lanes.
    pub(super) chosen: &'t [[u8; 2]],
    /// For each operation the lanes that need its value; empty if all lanes need all values.
    ///
    /// In other lanes its operands may have any value, so it must not count as undefined or as a jump there.
    pub(super) needed: &'t [u8],
    /// The index of the result.
    pub(super) result: Index,
    /// The values of which the result is the least or the greatest; else only the result.
    pub(super) extremes: &'t [Extreme],
    /// Whether the result is the least of `extremes`.
    pub(super) is_least: bool,
}

/// The part of a term on which the sign of the result depends.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Need {
    Nothing,
    Sign,
    Value,
}

impl Steps<'_> {
    /// Returns the lanes in which an operation is its first operand, then those in which it is its
    /// second.
    #[inline(always)]
    pub(super) fn chosen(&self, operation: usize) -> [u8; 2] {
        self.chosen.get(operation).copied().unwrap_or_default()
    }

    /// Returns the lanes that need the value of an operation.
    #[inline(always)]
    pub(super) fn needed(&self, operation: usize) -> u32 {
        self.needed.get(operation).map_or(ALL, |&lanes| u32::from(lanes))
    }
}

impl Tape {
    /// Returns all operations.
    pub(super) fn steps(&self) -> Steps<'_> {
        let Self { operations, extremes, result, is_least, .. } = self;
        Steps { operations, chosen: &[], needed: &[], result: *result, extremes, is_least: *is_least }
    }

    pub(super) fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// Returns the number of operations whose value matters; the sign is enough of those behind.
    pub(super) fn combining(&self) -> usize {
        usize::from(self.combining)
    }

    pub(super) fn result(&self) -> Index {
        self.result
    }

    /// Returns the value at an index, if it is a constant.
    #[inline(always)]
    pub(super) fn constant(&self, index: Index) -> Option<f64> {
        let at = index.checked_sub(FIRST_CONSTANT)?;
        self.constants.get(usize::from(at)).copied()
    }

    /// Returns a constant rounded to f32, if that is a normal number.
    #[inline(always)]
    pub(super) fn constant_as_f32(&self, index: Index) -> Option<f32> {
        self.constant(index).map(|value| value as f32).filter(|rounded| rounded.is_normal())
    }

    /// Returns whether there are enough minima, maxima and absolute values to decide them before
    /// each search.
    pub(super) fn has_many_choices(&self) -> bool {
        usize::from(self.choices) >= MANY_CHOICES
    }

    /// Returns whether the formula has only arithmetic, roots, comparisons and rounding.
    pub(super) fn is_algebraic(&self) -> bool {
        self.is_algebraic
    }

    /// Returns whether the value of the formula depends on the time.
    pub(super) fn moves(&self) -> bool {
        let is_time = |index: Index| index == Index::from(TIME);
        is_time(self.result) || self.operations.iter().any(|operation| operation.operands().into_iter().any(is_time))
    }

    /// Returns the tape with the time replaced by the constant `seconds`.
    pub(super) fn at_time(&self, seconds: f64) -> Self {
        let (mut builder, mut places) = (TapeBuilder::default(), Vec::with_capacity(self.operations.len()));
        // No operation becomes more than one, so the tape does not become too long.
        let leaf = |builder: &mut TapeBuilder, places: &[Index], index: Index| {
            let place = match (self.constant(index), index as u8) {
                (Some(value), _) => builder.constant(value),
                _ if usize::from(index) >= COORDINATES => Ok(places[usize::from(index) - COORDINATES]),
                (_, TIME) => builder.constant(seconds),
                (_, axis) => builder.coordinate(axis),
            };
            place.unwrap_or_default()
        };
        for &operation in &self.operations {
            let place = match operation {
                Operation::Unary(function, a) => {
                    let a = leaf(&mut builder, &places, a);
                    builder.unary(if function == Unary::SqrtOfNonNegative { Unary::Sqrt } else { function }, a)
                }
                Operation::Binary(function, a, b) => {
                    let (a, b) = (leaf(&mut builder, &places, a), leaf(&mut builder, &places, b));
                    builder.binary_in_order(function, a, b)
                }
            };
            places.push(place.unwrap_or_default());
        }
        let result = leaf(&mut builder, &places, self.result);
        builder.finish(result)
    }

    /// Returns whether the values of the formula are known to be at least 0, and to be at most 0.
    pub(super) fn known_signs(&self) -> [bool; 2] {
        let signs = signs(&self.operations, &self.constants);
        sign_at(&signs, &self.constants, self.result)
    }

    /// Returns the tape as one that is evaluated as a whole in each search.
    #[cfg(all(test, unit_tests))]
    pub(super) fn never_shortened(&self) -> Self {
        Self { choices: 0, ..self.clone() }
    }

    /// Returns the number of bytes that the tape takes.
    #[cfg(all(test, unit_tests))]
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self) + size_of_val(&*self.constants) + size_of_val(&*self.operations)
    }
}

/// The error of a formula with more than [`MAX_OPERATIONS`].
#[derive(Debug)]
pub(super) struct TooLong;

/// A term of a formula: a leaf or an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Term {
    /// A number, by its bits, so that terms can be compared and hashed.
    Constant(u64),
    /// x, y or z: 0, 1 or 2; or the [`TIME`].
    Coordinate(u8),
    Operation(Operation),
}

/// A tape under construction, which folds constants and adds equal terms only once.
#[derive(Default)]
pub(super) struct TapeBuilder {
    terms: Vec<Term>,
    indices: HashMap<Term, Index>,
}

impl TapeBuilder {
    fn push(&mut self, term: Term) -> Result<Index, TooLong> {
        if let Some(&index) = self.indices.get(&term) {
            return Ok(index);
        }
        if self.terms.len() >= MAX_OPERATIONS {
            return Err(TooLong);
        }
        let index = self.terms.len() as Index;
        self.terms.push(term);
        self.indices.insert(term, index);
        Ok(index)
    }

    /// Adds a number.
    pub(super) fn constant(&mut self, value: f64) -> Result<Index, TooLong> {
        // -0 and 0 are one constant.
        self.push(Term::Constant((value + 0.0).to_bits()))
    }

    pub(super) fn coordinate(&mut self, axis: u8) -> Result<Index, TooLong> {
        self.push(Term::Coordinate(axis))
    }

    /// Returns the value of a term that is a constant.
    pub(super) fn value(&self, index: Index) -> Option<f64> {
        match self.terms[usize::from(index)] {
            Term::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    pub(super) fn unary(&mut self, function: Unary, operand: Index) -> Result<Index, TooLong> {
        match (self.value(operand), self.terms[usize::from(operand)]) {
            (Some(value), _) => self.constant(function.at(value)),
            (_, Term::Operation(Operation::Unary(Unary::Negate, inner))) if function == Unary::Negate => Ok(inner),
            (_, Term::Operation(Operation::Unary(Unary::Negate | Unary::Abs, inner))) if function == Unary::Square => {
                self.unary(function, inner)
            }
            _ => self.push(Term::Operation(Operation::Unary(function, operand))),
        }
    }

    pub(super) fn binary(&mut self, function: Binary, a: Index, b: Index) -> Result<Index, TooLong> {
        let is_commutative = matches!(function, Binary::Add | Binary::Multiply | Binary::Min | Binary::Max);
        let (a, b) = if is_commutative { (a.min(b), a.max(b)) } else { (a, b) };
        self.binary_in_order(function, a, b)
    }

    /// Adds an operation without sorting its operands.
    // Where the operands of a minimum are equal, their order decides which gradient it has.
    fn binary_in_order(&mut self, function: Binary, a: Index, b: Index) -> Result<Index, TooLong> {
        if let (Some(a), Some(b)) = (self.value(a), self.value(b)) {
            return self.constant(function.at(a, b));
        }
        // Only identities that also hold where the operand is undefined: `0 * x` stays, as it is undefined where x is.
        match (function, self.value(a), self.value(b)) {
            (Binary::Add, Some(0.0), _) | (Binary::Multiply, Some(1.0), _) => return Ok(b),
            (Binary::Add | Binary::Subtract, _, Some(0.0)) | (Binary::Multiply | Binary::Divide, _, Some(1.0)) => {
                return Ok(a);
            }
            (Binary::Subtract, Some(0.0), _) => return self.unary(Unary::Negate, b),
            (Binary::Multiply, ..) if a == b => return self.unary(Unary::Square, a),
            _ => {}
        }
        self.push(Term::Operation(Operation::Binary(function, a, b)))
    }

    /// Returns `base` to a whole power, by squaring.
    pub(super) fn power(&mut self, base: Index, exponent: i32) -> Result<Index, TooLong> {
        let (mut rest, mut square, mut product) = (exponent.unsigned_abs(), base, self.constant(1.0)?);
        while rest > 0 {
            if rest & 1 == 1 {
                product = self.binary(Binary::Multiply, product, square)?;
            }
            rest >>= 1;
            if rest > 0 {
                square = self.unary(Unary::Square, square)?;
            }
        }
        if exponent < 0 {
            let one = self.constant(1.0)?;
            return self.binary(Binary::Divide, one, product);
        }
        Ok(product)
    }

    /// Returns the tape of the operations on which `result` depends.
    pub(super) fn finish(self, result: Index) -> Tape {
        let needs = self.needs(result);
        let (order, combining) = self.order(&needs);
        let (mut constants, mut places) = (Vec::new(), vec![0; needs.len()]);
        for ((&term, &need), place) in self.terms.iter().zip(&needs).zip(&mut places) {
            match term {
                Term::Constant(bits) if need > Need::Nothing => {
                    *place = FIRST_CONSTANT + constants.len() as Index;
                    constants.push(f64::from_bits(bits));
                }
                Term::Coordinate(axis) => *place = Index::from(axis),
                _ => {}
            }
        }
        let (mut operations, mut choices) = (Vec::with_capacity(order.len()), 0);
        for (index, operation) in order {
            places[usize::from(index)] = (COORDINATES + operations.len()) as Index;
            let operation = operation.with_operands(|operand| places[usize::from(operand)]);
            choices += Index::from(operation.is_choice());
            operations.push(operation.with_constant_last());
        }
        let signs = signs(&operations, &constants);
        for operation in &mut operations {
            if let Operation::Unary(function @ Unary::Sqrt, a) = operation
                && sign_at(&signs, &constants, *a)[0]
            {
                *function = Unary::SqrtOfNonNegative;
            }
        }
        let result = places[usize::from(result)];
        let (constants, operations) = (constants.into_boxed_slice(), operations.into_boxed_slice());
        let is_algebraic = operations.iter().all(|operation| operation.is_algebraic());
        let is_shortened = usize::from(choices) >= MANY_CHOICES;
        let found = if is_shortened { None } else { extremes_of(&operations, usize::from(combining), result) };
        let of_result = || (Box::from([Extreme { index: result, is_negated: false }]), false);
        let (extremes, is_least) = found.unwrap_or_else(of_result);
        Tape { constants, operations, combining, result, choices, extremes, is_least, is_algebraic }
    }

    /// Returns for each term up to `result` what of it the sign of the result depends on.
    fn needs(&self, result: Index) -> Vec<Need> {
        let mut needs = vec![Need::Nothing; usize::from(result) + 1];
        needs[usize::from(result)] = Need::Sign;
        // Goes from the result backwards, and operands come first; so one pass in reverse order is enough.
        for index in (0..needs.len()).rev() {
            let Term::Operation(operation) = self.terms[index] else { continue };
            let need = match needs[index] {
                Need::Nothing => continue,
                Need::Sign if operation.combines_signs() => Need::Sign,
                _ => Need::Value,
            };
            for operand in operation.operands() {
                needs[usize::from(operand)] = needs[usize::from(operand)].max(need);
            }
        }
        needs
    }

    /// Returns the operations in the order of evaluation, and the number of those in front of the
    /// ones that combine signs.
    fn order(&self, needs: &[Need]) -> (Vec<(Index, Operation)>, Index) {
        let (mut order, mut combining) = (Vec::new(), Vec::new());
        for (index, &need) in needs.iter().enumerate() {
            let (index, Term::Operation(operation)) = (index as Index, self.terms[index]) else { continue };
            if need == Need::Nothing {
                continue;
            }
            if need == Need::Sign && operation.combines_signs() {
                combining.push((index, operation));
                continue;
            }
            // Sine and cosine of one angle are computed together if they follow each other.
            let twin = operation.twin().and_then(|twin| {
                let other = *self.indices.get(&Term::Operation(twin))?;
                let is_needed = needs.get(usize::from(other)).is_some_and(|&need| need > Need::Nothing);
                is_needed.then_some((other, twin))
            });
            match (operation, twin) {
                (_, Some((other, _))) if other < index => {}
                (Operation::Unary(Unary::Sin, _), Some(cosine)) => order.extend([(index, operation), cosine]),
                (_, Some(sine)) => order.extend([sine, (index, operation)]),
                (_, None) => order.push((index, operation)),
            }
        }
        let count = order.len() as Index;
        order.append(&mut combining);
        (order, count)
    }
}

/// Returns for each operation whether its values are known to be at least 0, and to be at most 0.
fn signs(operations: &[Operation], constants: &[f64]) -> Vec<[bool; 2]> {
    let mut known: Vec<[bool; 2]> = Vec::with_capacity(operations.len());
    for &operation in operations {
        let of = |index: Index| sign_at(&known, constants, index);
        let signs = match operation {
            Operation::Unary(function, a) => match function {
                Unary::Abs | Unary::Square | Unary::Sqrt | Unary::SqrtOfNonNegative | Unary::Exp | Unary::Step => {
                    [true, false]
                }
                Unary::Negate => [of(a)[1], of(a)[0]],
                Unary::Cbrt | Unary::Floor | Unary::Atan | Unary::Asin => [of(a)[0], false],
                Unary::Ln | Unary::Sin | Unary::Cos | Unary::Tan => [false; 2],
            },
            Operation::Binary(function, a, b) => {
                let ([a, below_a], [b, below_b]) = (of(a), of(b));
                match function {
                    Binary::Add => [a && b, below_a && below_b],
                    Binary::Subtract => [a && below_b, below_a && b],
                    Binary::Multiply | Binary::Divide => [a && b || below_a && below_b, a && below_b || below_a && b],
                    Binary::Min => [a && b, below_a || below_b],
                    Binary::Max => [a || b, below_a && below_b],
                    Binary::Atan2 => [a, false],
                }
            }
        };
        known.push(signs);
    }
    known
}

/// Returns whether the values at an index are known to be at least 0, and to be at most 0.
fn sign_at(of_operations: &[[bool; 2]], constants: &[f64], index: Index) -> [bool; 2] {
    if let Some(at) = index.checked_sub(FIRST_CONSTANT) {
        let value = constants[usize::from(at)];
        return [value >= 0.0, value <= 0.0];
    }
    usize::from(index).checked_sub(COORDINATES).map_or([false; 2], |at| of_operations[at])
}
