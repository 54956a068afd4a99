//! The tape: the operations of a formula, each after its operands, in which equal terms are shared.

use std::collections::HashMap;

/// The largest number of operations of a formula.
// The models of a packet take 128 bytes for each operation: at most half a megabyte in each thread.
pub(super) const MAX_OPERATIONS: usize = 4096;

/// The index of the time as a coordinate; tapes with it are evaluated only after [`Tape::at_time`].
pub(super) const TIME: u8 = 3;

/// The index of an operation in its tape.
pub(super) type Index = u16;

/// An operation of a tape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Operation {
    /// A number, by its bits, so that operations can be compared and hashed.
    Constant(u64),
    /// x, y or z: 0, 1 or 2; or the [`TIME`].
    Coordinate(u8),
    Unary(Unary, Index),
    Binary(Binary, Index, Index),
}

/// A function of one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Unary {
    Negate,
    Abs,
    Square,
    Sqrt,
    Cbrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Atan,
    Floor,
    /// 0 for negative operands, else 1.
    Step,
}

/// A function of two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Min,
    Max,
    Atan2,
}

/// The operations of a formula in the order of evaluation; the last one is the result.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tape {
    operations: Vec<Operation>,
    /// For each operation, whether its values are known to be at least 0, and to be at most 0.
    signs: Vec<[bool; 2]>,
}

impl Tape {
    pub(super) fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// Returns the value of a constant operation, rounded to f32, if that is a normal number.
    pub(super) fn constant_as_f32(&self, index: Index) -> Option<f32> {
        let Operation::Constant(bits) = self.operations[usize::from(index)] else { return None };
        Some(f64::from_bits(bits) as f32).filter(|rounded| rounded.is_normal())
    }

    /// Returns whether the value of the formula depends on the time.
    pub(super) fn moves(&self) -> bool {
        self.operations.contains(&Operation::Coordinate(TIME))
    }

    /// Returns the tape with the time replaced by the constant `seconds`.
    pub(super) fn at_time(&self, seconds: f64) -> Self {
        let (mut builder, mut places) = (TapeBuilder::default(), Vec::with_capacity(self.operations.len()));
        for &operation in &self.operations {
            let of = |operand: Index| places[usize::from(operand)];
            let place = match operation {
                Operation::Coordinate(TIME) => builder.constant(seconds),
                Operation::Unary(function, a) => builder.unary(function, of(a)),
                Operation::Binary(function, a, b) => builder.binary(function, of(a), of(b)),
                leaf => builder.push(leaf),
            };
            // No operation becomes more than one, so the tape does not become too long.
            places.push(place.unwrap_or_default());
        }
        let result = places.last().copied().unwrap_or_default();
        builder.finish(result)
    }

    /// Returns whether the operation at `index` can be shown to have no negative value.
    pub(super) fn is_non_negative(&self, index: usize) -> bool {
        self.signs[index][0]
    }

    /// Returns whether the operation at `index` can be shown to have no positive value.
    pub(super) fn is_non_positive(&self, index: usize) -> bool {
        self.signs[index][1]
    }
}

/// The error of a formula with more than [`MAX_OPERATIONS`].
#[derive(Debug)]
pub(super) struct TooLong;

/// A tape under construction, which folds constants and adds equal operations only once.
#[derive(Default)]
pub(super) struct TapeBuilder {
    operations: Vec<Operation>,
    indices: HashMap<Operation, Index>,
}

impl TapeBuilder {
    fn push(&mut self, operation: Operation) -> Result<Index, TooLong> {
        if let Some(&index) = self.indices.get(&operation) {
            return Ok(index);
        }
        if self.operations.len() >= MAX_OPERATIONS {
            return Err(TooLong);
        }
        let index = self.operations.len() as Index;
        self.operations.push(operation);
        self.indices.insert(operation, index);
        Ok(index)
    }

    /// Adds a number.
    pub(super) fn constant(&mut self, value: f64) -> Result<Index, TooLong> {
        // -0 and 0 are one constant.
        self.push(Operation::Constant((value + 0.0).to_bits()))
    }

    pub(super) fn coordinate(&mut self, axis: u8) -> Result<Index, TooLong> {
        self.push(Operation::Coordinate(axis))
    }

    /// Returns the value of an operation that is a constant.
    pub(super) fn value(&self, index: Index) -> Option<f64> {
        match self.operations[usize::from(index)] {
            Operation::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    pub(super) fn unary(&mut self, function: Unary, operand: Index) -> Result<Index, TooLong> {
        match (self.value(operand), self.operations[usize::from(operand)]) {
            (Some(value), _) => self.constant(function.at(value)),
            (_, Operation::Unary(Unary::Negate, inner)) if function == Unary::Negate => Ok(inner),
            (_, Operation::Unary(Unary::Negate | Unary::Abs, inner)) if function == Unary::Square => {
                self.unary(function, inner)
            }
            _ => self.push(Operation::Unary(function, operand)),
        }
    }

    pub(super) fn binary(&mut self, function: Binary, a: Index, b: Index) -> Result<Index, TooLong> {
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
        let is_commutative = matches!(function, Binary::Add | Binary::Multiply | Binary::Min | Binary::Max);
        let (a, b) = if is_commutative { (a.min(b), a.max(b)) } else { (a, b) };
        self.push(Operation::Binary(function, a, b))
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
        let count = usize::from(result) + 1;
        let mut is_used = vec![false; count];
        is_used[count - 1] = true;
        // Marking goes from the result backwards, and operands come first; so one pass in reverse order is enough.
        for index in (0..count).rev() {
            if is_used[index] {
                mark_operands(self.operations[index], &mut is_used);
            }
        }
        let (mut operations, mut places) = (Vec::new(), vec![0; count]);
        for index in (0..count).filter(|&index| is_used[index]) {
            places[index] = operations.len() as Index;
            let place = |operand: Index| places[usize::from(operand)];
            operations.push(match self.operations[index] {
                Operation::Unary(function, a) => Operation::Unary(function, place(a)),
                Operation::Binary(function, a, b) => Operation::Binary(function, place(a), place(b)),
                leaf => leaf,
            });
        }
        let signs = signs(&operations);
        Tape { operations, signs }
    }
}

fn mark_operands(operation: Operation, is_used: &mut [bool]) {
    match operation {
        Operation::Unary(_, a) => is_used[usize::from(a)] = true,
        Operation::Binary(_, a, b) => (is_used[usize::from(a)], is_used[usize::from(b)]) = (true, true),
        Operation::Constant(_) | Operation::Coordinate(_) => {}
    }
}

/// Returns for each operation whether its values are known to be at least 0, and to be at most 0.
fn signs(operations: &[Operation]) -> Vec<[bool; 2]> {
    let mut known: Vec<[bool; 2]> = Vec::with_capacity(operations.len());
    for &operation in operations {
        let of = |index: Index| known[usize::from(index)];
        let signs = match operation {
            Operation::Constant(bits) => [f64::from_bits(bits) >= 0.0, f64::from_bits(bits) <= 0.0],
            Operation::Coordinate(_) => [false; 2],
            Operation::Unary(function, a) => match function {
                Unary::Abs | Unary::Square | Unary::Sqrt | Unary::Exp | Unary::Step => [true, false],
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
