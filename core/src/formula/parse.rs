//! The parser of formulas, by recursive descent.
//!
//! ```text
//! formula  = { name "=" sum ";" } sum [ "=" sum ]        (a = b means a - b; below 0 is inside)
//! sum      = product { ("+" | "-") product }
//! product  = unary { ("*" | "/") unary }
//! unary    = "-" unary | power
//! power    = atom [ "^" unary ]                          (-x^2 = -(x^2); right to left)
//! atom     = number | name | name "(" sum { "," sum } ")" | "(" sum ")" | "|" sum "|"
//! ```

mod functions;
mod tokens;

use super::operation::{Binary, Index, Unary};
use super::tape::{MAX_OPERATIONS, TIME, Tape, TapeBuilder, TooLong};
use crate::text::{closest, visible};
use functions::{CONSTANTS, FUNCTIONS, VARIABLES};
use std::collections::HashMap;
use std::ops::Range;
use tokens::{FormulaToken, FormulaTokens};

/// The deepest nesting of brackets, signs and exponents.
// The parser is recursive, and a deeper formula could overflow the stack.
const MAX_NESTING: usize = 64;

/// The largest magnitude of an integer exponent; a larger one is a fault.
const MAX_EXPONENT: f64 = 32.0;

/// A fault of a formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FormulaFault {
    /// The range of bytes in the text of the formula.
    pub(crate) range: Range<usize>,
    /// The message: one line without a full stop.
    pub(crate) message: String,
}

impl FormulaFault {
    fn new<T>(range: Range<usize>, message: impl Into<String>) -> Result<T, Self> {
        Err(Self { range, message: message.into() })
    }
}

/// Returns whether a parameter may have this name.
pub(crate) fn is_free_name(name: &str) -> bool {
    let mut chars = name.chars();
    chars.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && chars.all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !reserved_names().any(|reserved| reserved == name)
}

fn reserved_names<'n>() -> impl Iterator<Item = &'n str> {
    let functions = FUNCTIONS.iter().map(|function| function.name);
    functions.chain(VARIABLES).chain(CONSTANTS.map(|(name, _)| name))
}

/// Returns the tape of a formula.
pub(super) fn parse(text: &str, params: &[(String, f64)]) -> Result<Tape, FormulaFault> {
    let mut parser = FormulaParser {
        tokens: FormulaTokens::new(text)?,
        tape: TapeBuilder::default(),
        names: HashMap::new(),
        depth: 0,
    };
    for (name, value) in params {
        let index = parser.constant(*value, 0..text.len())?;
        parser.names.insert(name.clone(), index);
    }
    let result = parser.formula()?;
    Ok(parser.tape.finish(result))
}

/// Returns the index of an operation, or the fault of a formula that is too long.
fn fits(index: Result<Index, TooLong>, range: Range<usize>) -> Result<Index, FormulaFault> {
    index.or_else(|TooLong| FormulaFault::new(range, format!("a formula has at most {MAX_OPERATIONS} operations")))
}

struct FormulaParser<'t> {
    tokens: FormulaTokens<'t>,
    tape: TapeBuilder,
    /// The parameters and the names that the formula defines.
    names: HashMap<String, Index>,
    depth: usize,
}

impl FormulaParser<'_> {
    fn formula(&mut self) -> Result<Index, FormulaFault> {
        while self.tokens.starts_definition() {
            let (name, range) = (self.tokens.text(), self.tokens.range());
            if !is_free_name(name) || self.names.contains_key(name) {
                return FormulaFault::new(range, format!("`{name}` has a meaning already: choose another name"));
            }
            self.tokens.advance();
            self.tokens.advance();
            let value = self.sum()?;
            self.expect(FormulaToken::Sign(';'))?;
            self.names.insert(name.to_owned(), value);
        }
        let mut result = self.sum()?;
        if self.tokens.is_sign('=') {
            let range = self.tokens.range();
            self.tokens.advance();
            let other = self.sum()?;
            result = self.binary(Binary::Subtract, result, other, range)?;
        }
        match self.tokens.token() {
            FormulaToken::End => Ok(result),
            _ => self.unexpected(),
        }
    }

    fn sum(&mut self) -> Result<Index, FormulaFault> {
        let mut sum = self.product()?;
        loop {
            let function = match self.tokens.token() {
                FormulaToken::Sign('+') => Binary::Add,
                FormulaToken::Sign('-') => Binary::Subtract,
                _ => return Ok(sum),
            };
            sum = self.then(function, sum, Self::product)?;
        }
    }

    fn product(&mut self) -> Result<Index, FormulaFault> {
        let mut product = self.unary()?;
        loop {
            let function = match self.tokens.token() {
                FormulaToken::Sign('*') => Binary::Multiply,
                FormulaToken::Sign('/') => Binary::Divide,
                _ => return Ok(product),
            };
            product = self.then(function, product, Self::unary)?;
        }
    }

    /// Reads an operator and its second operand, and adds the operation to the tape.
    fn then(
        &mut self,
        function: Binary,
        first: Index,
        read: fn(&mut Self) -> Result<Index, FormulaFault>,
    ) -> Result<Index, FormulaFault> {
        let range = self.tokens.range();
        self.tokens.advance();
        let second = read(self)?;
        self.binary(function, first, second, range)
    }

    fn unary(&mut self) -> Result<Index, FormulaFault> {
        if !self.tokens.is_sign('-') {
            return self.power();
        }
        let range = self.tokens.range();
        self.tokens.advance();
        let operand = self.nested(range.clone(), Self::unary)?;
        self.unary_of(Unary::Negate, operand, range)
    }

    fn power(&mut self) -> Result<Index, FormulaFault> {
        let base = self.atom()?;
        if !self.tokens.is_sign('^') {
            return Ok(base);
        }
        let range = self.tokens.range();
        self.tokens.advance();
        let exponent = self.nested(range.clone(), Self::unary)?;
        self.raised(base, exponent, range)
    }

    fn atom(&mut self) -> Result<Index, FormulaFault> {
        let range = self.tokens.range();
        match self.tokens.token() {
            FormulaToken::Number(value) => {
                self.tokens.advance();
                self.constant(value, range)
            }
            FormulaToken::Name => self.name(),
            FormulaToken::Sign('(') => {
                self.tokens.advance();
                let inner = self.nested(range, Self::sum)?;
                self.expect(FormulaToken::Sign(')'))?;
                Ok(inner)
            }
            FormulaToken::Sign('|') => {
                self.tokens.advance();
                let inner = self.nested(range.clone(), Self::sum)?;
                self.expect(FormulaToken::Sign('|'))?;
                self.unary_of(Unary::Abs, inner, range)
            }
            FormulaToken::End => FormulaFault::new(range, "the formula ends here: expected a number, a name or `(`"),
            FormulaToken::Sign(sign) => {
                FormulaFault::new(range, format!("expected a number, a name or `(`, found `{sign}`"))
            }
        }
    }

    fn name(&mut self) -> Result<Index, FormulaFault> {
        let (name, range) = (self.tokens.text(), self.tokens.range());
        self.tokens.advance();
        if self.tokens.is_sign('(')
            && let Some(function) = FUNCTIONS.iter().find(|function| function.name == name)
        {
            return self.call(function, range);
        }
        if let Some(&index) = self.names.get(name) {
            return Ok(index);
        }
        if let Some(&(_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            return self.constant(value, range);
        }
        let coordinate = |parser: &mut Self, axis| {
            let index = parser.tape.coordinate(axis);
            fits(index, range.clone())
        };
        match name {
            "x" => coordinate(self, 0),
            "y" => coordinate(self, 1),
            "z" => coordinate(self, 2),
            "r" => {
                let axes = [coordinate(self, 0)?, coordinate(self, 1)?, coordinate(self, 2)?];
                self.length(&axes, range)
            }
            "time" => coordinate(self, TIME),
            _ => FormulaFault::new(range, self.unknown_name(name)),
        }
    }

    fn unknown_name(&self, name: &str) -> String {
        if FUNCTIONS.iter().any(|function| function.name == name) {
            return format!("`{name}` is a function: expected `(` after it");
        }
        let known: Vec<&str> = reserved_names().chain(self.names.keys().map(String::as_str)).collect();
        match closest(name, known) {
            Some(meant) => format!("unknown name `{name}`: did you mean `{meant}`?"),
            None => format!("unknown name `{name}`: expected x, y, z, a function or a parameter"),
        }
    }

    fn call(&mut self, function: &functions::Function, range: Range<usize>) -> Result<Index, FormulaFault> {
        let mut operands = Vec::new();
        loop {
            // Skips `(` or `,`.
            self.tokens.advance();
            operands.push(self.nested(range.clone(), Self::sum)?);
            let (here, most) = (self.tokens.range(), function.operands.end);
            match self.tokens.token() {
                FormulaToken::Sign(',') if operands.len() + 1 < most => {}
                FormulaToken::Sign(',') => {
                    return FormulaFault::new(here, format!("{}: expected `)`", function.takes()));
                }
                FormulaToken::Sign(')') if operands.len() < function.operands.start => {
                    return FormulaFault::new(here, format!("{}: expected `,`", function.takes()));
                }
                _ => break,
            }
        }
        self.expect(FormulaToken::Sign(')'))?;
        self.apply(function.kind, &operands, range)
    }

    /// Calls `read` one level of nesting deeper, or returns the fault of too deep a nesting.
    fn nested<T>(
        &mut self,
        range: Range<usize>,
        read: impl FnOnce(&mut Self) -> Result<T, FormulaFault>,
    ) -> Result<T, FormulaFault> {
        if self.depth == MAX_NESTING {
            return FormulaFault::new(
                range,
                format!("brackets, signs and exponents may be {MAX_NESTING} deep, not deeper"),
            );
        }
        self.depth += 1;
        let value = read(self)?;
        self.depth -= 1;
        Ok(value)
    }

    fn expect(&mut self, wanted: FormulaToken) -> Result<(), FormulaFault> {
        if self.tokens.token() == wanted {
            self.tokens.advance();
            return Ok(());
        }
        let FormulaToken::Sign(sign) = wanted else { return self.unexpected() };
        match self.tokens.token() {
            FormulaToken::End => {
                FormulaFault::new(self.tokens.range(), format!("the formula ends here: expected `{sign}`"))
            }
            _ => self.unexpected(),
        }
    }

    /// Returns the fault of a token that cannot follow a complete operand.
    fn unexpected<T>(&self) -> Result<T, FormulaFault> {
        let (range, text) = (self.tokens.range(), visible(self.tokens.text()));
        match (self.tokens.token(), self.tokens.before()) {
            (FormulaToken::Name | FormulaToken::Number(_) | FormulaToken::Sign('('), Some(before)) => {
                let before = if before.len() > 12 { ")" } else { before };
                let operand = if text == "(" { "(...)" } else { &text };
                let form = if before == ")" { format!("...) * {operand}") } else { format!("{before}*{operand}") };
                FormulaFault::new(range, format!("expected an operator, found `{text}`: write {form}"))
            }
            (FormulaToken::End, _) => FormulaFault::new(range, "the formula ends here: expected an operator"),
            _ => FormulaFault::new(range, format!("expected an operator, found `{text}`")),
        }
    }

    // Operations --------------------------------------------------------------------------------------------------

    fn constant(&mut self, value: f64, range: Range<usize>) -> Result<Index, FormulaFault> {
        let index = self.tape.constant(value);
        fits(index, range)
    }

    /// Adds an operation, unless it is undefined for its constant operands.
    fn unary_of(&mut self, function: Unary, operand: Index, range: Range<usize>) -> Result<Index, FormulaFault> {
        let operand_value = self.tape.value(operand);
        let index = self.tape.unary(function, operand);
        let index = fits(index, range.clone())?;
        match (operand_value, self.tape.value(index)) {
            (Some(operand), Some(value)) if !value.is_finite() => {
                FormulaFault::new(range, format!("`{}` of {operand} is undefined", functions::name_of(function)))
            }
            _ => Ok(index),
        }
    }

    /// Adds an operation, unless it is undefined for its constant operands.
    fn binary(&mut self, function: Binary, a: Index, b: Index, range: Range<usize>) -> Result<Index, FormulaFault> {
        if function == Binary::Divide && self.tape.value(b) == Some(0.0) {
            return FormulaFault::new(range, "a division by 0 is undefined");
        }
        let index = self.tape.binary(function, a, b);
        let index = fits(index, range.clone())?;
        match self.tape.value(index) {
            Some(value) if !value.is_finite() => FormulaFault::new(range, "this number is too large"),
            _ => Ok(index),
        }
    }

    fn raised(&mut self, base: Index, exponent: Index, range: Range<usize>) -> Result<Index, FormulaFault> {
        match self.tape.value(exponent) {
            Some(value) if value == libm::trunc(value) => {
                if value.abs() > MAX_EXPONENT {
                    return FormulaFault::new(
                        range,
                        format!("a whole exponent is at most {MAX_EXPONENT}, found {value}"),
                    );
                }
                if value < 0.0 && self.tape.value(base) == Some(0.0) {
                    return FormulaFault::new(range, "a division by 0 is undefined");
                }
                let index = self.tape.power(base, value as i32);
                fits(index, range)
            }
            _ => {
                // base^exponent is exp(exponent * ln(base)), which is undefined for a negative base even if a root
                // exists, as for x^(1/3): formulas have `cbrt` for that.
                let logarithm = self.unary_of(Unary::Ln, base, range.clone())?;
                let product = self.binary(Binary::Multiply, exponent, logarithm, range.clone())?;
                self.unary_of(Unary::Exp, product, range)
            }
        }
    }

    fn length(&mut self, operands: &[Index], range: Range<usize>) -> Result<Index, FormulaFault> {
        // This 0 adds no operation: the builder of the tape replaces 0 + x with x.
        let mut sum = self.constant(0.0, range.clone())?;
        for &operand in operands {
            let square = self.unary_of(Unary::Square, operand, range.clone())?;
            sum = self.binary(Binary::Add, sum, square, range.clone())?;
        }
        self.unary_of(Unary::Sqrt, sum, range)
    }
}
