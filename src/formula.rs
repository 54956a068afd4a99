//! Formulas f(x, y, z): text -> tape -> values, gradients, and the first root along a ray.
//!
//! `parse` reads the text into a `tape`, a list of operations in which equal terms are shared. `point` evaluates the
//! tape in f64; `model` encloses its values on a piece of a ray by a quadratic polynomial and a bound of its error;
//! `roots` walks along the ray with these enclosures, so that no sign change is stepped over, on eight rays at once,
//! for which `packet` computes the models in f32.

mod check;
mod model;
mod packet;
mod parse;
mod point;
mod roots;
mod tape;

pub(crate) use parse::{Fault, is_free_name};
pub(crate) use roots::{Line, Searches, Solver};

use tape::Tape;

/// A formula in x, y and z, whose sign tells inside from outside.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Formula {
    tape: Tape,
}

impl Formula {
    /// Parses a formula, in which `params` are constants with names.
    ///
    /// # Errors
    /// The first fault, with its range of bytes in `text`.
    pub(crate) fn parse(text: &str, params: &[(String, f64)]) -> Result<Self, Fault> {
        parse::parse(text, params).map(|tape| Self { tape })
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
