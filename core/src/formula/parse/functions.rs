//! The functions of formulas, and the operations that they consist of.

use super::{FormulaFault, FormulaParser};
use crate::formula::operation::{Binary, Index, Unary};
use std::f64::consts::{E, FRAC_PI_2, LOG2_E, PI, TAU};
use std::ops::Range;

/// The names of variables.
pub(super) const VARIABLES: [&str; 5] = ["x", "y", "z", "r", "time"];

/// The names of constants, and their values.
pub(super) const CONSTANTS: [(&str, f64); 4] = [("pi", PI), ("tau", TAU), ("e", E), ("phi", 1.618_033_988_749_895)];

/// A function that formulas can call.
pub(super) struct Function {
    pub(super) name: &'static str,
    /// The possible numbers of operands.
    pub(super) operands: Range<usize>,
    pub(super) kind: Kind,
}

/// The operations that a call of a function such as `sin`, `max` or `tanh` consists of.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Unary(Unary),
    Binary(Binary),
    /// The least or the greatest of all operands.
    Fold(Binary),
    /// A function that consists of several operations.
    Composed(fn(&mut Composer<'_, '_>, &[Index]) -> Result<Index, FormulaFault>),
}

/// The end of `operands` of a function that takes any number: more than a formula can have.
const MANY: usize = usize::MAX;

const fn unary(name: &'static str, function: Unary) -> Function {
    Function { name, operands: 1..2, kind: Kind::Unary(function) }
}

const fn composed(
    name: &'static str,
    operands: Range<usize>,
    compose: fn(&mut Composer<'_, '_>, &[Index]) -> Result<Index, FormulaFault>,
) -> Function {
    Function { name, operands, kind: Kind::Composed(compose) }
}

/// All functions.
pub(super) static FUNCTIONS: &[Function] = &[
    unary("abs", Unary::Abs),
    unary("sqrt", Unary::Sqrt),
    unary("cbrt", Unary::Cbrt),
    unary("exp", Unary::Exp),
    unary("ln", Unary::Ln),
    unary("sin", Unary::Sin),
    unary("cos", Unary::Cos),
    unary("tan", Unary::Tan),
    unary("asin", Unary::Asin),
    unary("atan", Unary::Atan),
    unary("floor", Unary::Floor),
    Function { name: "atan2", operands: 2..3, kind: Kind::Binary(Binary::Atan2) },
    Function { name: "min", operands: 2..MANY, kind: Kind::Fold(Binary::Min) },
    Function { name: "max", operands: 2..MANY, kind: Kind::Fold(Binary::Max) },
    composed("length", 2..MANY, |c, all| c.parser.length(all, c.range.clone())),
    composed("pow", 2..3, |c, of| c.parser.raised(of[0], of[1], c.range.clone())),
    composed("sign", 1..2, |c, of| {
        let negative = c.unary(Unary::Negate, of[0])?;
        let (above, below) = (c.unary(Unary::Step, of[0])?, c.unary(Unary::Step, negative)?);
        c.binary(Binary::Subtract, above, below)
    }),
    composed("ceil", 1..2, |c, of| {
        let negative = c.unary(Unary::Negate, of[0])?;
        let floor = c.unary(Unary::Floor, negative)?;
        c.unary(Unary::Negate, floor)
    }),
    composed("fract", 1..2, |c, of| {
        let floor = c.unary(Unary::Floor, of[0])?;
        c.binary(Binary::Subtract, of[0], floor)
    }),
    composed("mod", 2..3, |c, of| {
        let quotient = c.binary(Binary::Divide, of[0], of[1])?;
        let floor = c.unary(Unary::Floor, quotient)?;
        let product = c.binary(Binary::Multiply, of[1], floor)?;
        c.binary(Binary::Subtract, of[0], product)
    }),
    composed("clamp", 3..4, |c, of| c.clamp(of[0], of[1], of[2])),
    composed("mix", 3..4, |c, of| c.mix(of[0], of[1], of[2])),
    composed("step", 2..3, |c, of| {
        let difference = c.binary(Binary::Subtract, of[1], of[0])?;
        c.unary(Unary::Step, difference)
    }),
    composed("smoothstep", 3..4, |c, of| {
        let (along, width) = (c.binary(Binary::Subtract, of[2], of[0])?, c.binary(Binary::Subtract, of[1], of[0])?);
        let share = c.binary(Binary::Divide, along, width)?;
        let (zero, one) = (c.constant(0.0)?, c.constant(1.0)?);
        let share = c.clamp(share, zero, one)?;
        let (two, three) = (c.constant(2.0)?, c.constant(3.0)?);
        let (square, twice) = (c.unary(Unary::Square, share)?, c.binary(Binary::Multiply, two, share)?);
        let rest = c.binary(Binary::Subtract, three, twice)?;
        c.binary(Binary::Multiply, square, rest)
    }),
    // After Quilez: the minimum, rounded over a width of `k`.
    composed("smin", 3..4, |c, of| {
        let (half, zero, one) = (c.constant(0.5)?, c.constant(0.0)?, c.constant(1.0)?);
        let difference = c.binary(Binary::Subtract, of[1], of[0])?;
        let quotient = c.binary(Binary::Divide, difference, of[2])?;
        let halved = c.binary(Binary::Multiply, half, quotient)?;
        let share = c.binary(Binary::Add, half, halved)?;
        let share = c.clamp(share, zero, one)?;
        let (mixed, rest) = (c.mix(of[1], of[0], share)?, c.binary(Binary::Subtract, one, share)?);
        let product = c.binary(Binary::Multiply, share, rest)?;
        let rounding = c.binary(Binary::Multiply, of[2], product)?;
        c.binary(Binary::Subtract, mixed, rounding)
    }),
    composed("log2", 1..2, |c, of| {
        let (logarithm, factor) = (c.unary(Unary::Ln, of[0])?, c.constant(LOG2_E)?);
        c.binary(Binary::Multiply, factor, logarithm)
    }),
    composed("acos", 1..2, |c, of| {
        let (sine, quarter) = (c.unary(Unary::Asin, of[0])?, c.constant(FRAC_PI_2)?);
        c.binary(Binary::Subtract, quarter, sine)
    }),
    composed("sinh", 1..2, |c, of| c.hyperbolic(of[0], Binary::Subtract)),
    composed("cosh", 1..2, |c, of| c.hyperbolic(of[0], Binary::Add)),
    composed("tanh", 1..2, |c, of| {
        // 1 - 2 / (e^2a + 1), which does not overflow to an undefined quotient.
        let (one, two) = (c.constant(1.0)?, c.constant(2.0)?);
        let doubled = c.binary(Binary::Multiply, two, of[0])?;
        let power = c.unary(Unary::Exp, doubled)?;
        let below = c.binary(Binary::Add, power, one)?;
        let quotient = c.binary(Binary::Divide, two, below)?;
        c.binary(Binary::Subtract, one, quotient)
    }),
];

impl Function {
    /// Returns text for messages on the number of operands: `` `sin` takes one argument ``.
    pub(super) fn takes(&self) -> String {
        let Range { start, end } = self.operands;
        let count = ["no", "one", "two", "three"][start.min(3)];
        let more = if end == MANY { " or more" } else { "" };
        let plural = if start == 1 && more.is_empty() { "" } else { "s" };
        format!("`{}` takes {count} argument{plural}{more}", self.name)
    }
}

/// Returns the name of a function in formulas, for messages.
pub(super) fn name_of(function: Unary) -> &'static str {
    let named = FUNCTIONS.iter().find(|known| matches!(known.kind, Kind::Unary(unary) if unary == function));
    named.map_or("the value", |known| known.name)
}

/// The operations of a call under construction; faults are reported at the function's name.
pub(super) struct Composer<'p, 't> {
    parser: &'p mut FormulaParser<'t>,
    range: Range<usize>,
}

impl FormulaParser<'_> {
    /// Adds the operations of a call of a function, whose name is at `range`, and returns the
    /// index of its result.
    pub(super) fn apply(&mut self, kind: Kind, operands: &[Index], range: Range<usize>) -> Result<Index, FormulaFault> {
        match kind {
            Kind::Unary(function) => self.unary_of(function, operands[0], range),
            Kind::Binary(function) => self.binary(function, operands[0], operands[1], range),
            Kind::Fold(function) => {
                let mut result = operands[0];
                for &operand in &operands[1..] {
                    result = self.binary(function, result, operand, range.clone())?;
                }
                Ok(result)
            }
            Kind::Composed(compose) => compose(&mut Composer { parser: self, range }, operands),
        }
    }
}

impl Composer<'_, '_> {
    fn constant(&mut self, value: f64) -> Result<Index, FormulaFault> {
        self.parser.constant(value, self.range.clone())
    }

    fn unary(&mut self, function: Unary, operand: Index) -> Result<Index, FormulaFault> {
        self.parser.unary_of(function, operand, self.range.clone())
    }

    fn binary(&mut self, function: Binary, a: Index, b: Index) -> Result<Index, FormulaFault> {
        self.parser.binary(function, a, b, self.range.clone())
    }

    fn clamp(&mut self, value: Index, low: Index, high: Index) -> Result<Index, FormulaFault> {
        let above = self.binary(Binary::Max, value, low)?;
        self.binary(Binary::Min, above, high)
    }

    fn mix(&mut self, from: Index, to: Index, share: Index) -> Result<Index, FormulaFault> {
        let difference = self.binary(Binary::Subtract, to, from)?;
        let product = self.binary(Binary::Multiply, share, difference)?;
        self.binary(Binary::Add, from, product)
    }

    /// Adds the operations of half the sum of e^a and e^-a for the operand a, or of half their
    /// difference if `function` subtracts.
    fn hyperbolic(&mut self, operand: Index, function: Binary) -> Result<Index, FormulaFault> {
        let negative = self.unary(Unary::Negate, operand)?;
        let (power, inverse) = (self.unary(Unary::Exp, operand)?, self.unary(Unary::Exp, negative)?);
        let (half, combined) = (self.constant(0.5)?, self.binary(function, power, inverse)?);
        self.binary(Binary::Multiply, half, combined)
    }
}
