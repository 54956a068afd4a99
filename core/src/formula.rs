//! Formulas f(x, y, z): text -> tape -> values, gradients, and the first root along a ray.
//!
//! `parse` reads the text into a `tape`, a list of `operation`s in which equal terms are shared. `point` evaluates the
//! tape in f64; `model` encloses its values on a piece of a ray by a quadratic polynomial and a bound of its error.
//! `models` holds eight of them in f32, `packet` computes those of a tape, `choices` leaves out what no ray of the
//! eight needs, and `extremes` are the values of which a formula is the least or the greatest. `forecast` tells from
//! an enclosure where the sign may change; with it, `walks` go along eight rays at once, so that no sign change is
//! stepped over. `bracket` narrows sign changes down to the `roots`, by `values` that are those of `point` for eight
//! rays.

mod bracket;
mod check;
mod choices;
mod elementary;
mod extremes;
mod forecast;
mod model;
mod models;
mod operation;
mod packet;
mod parse;
mod point;
mod roots;
mod tape;
mod values;
mod walks;

pub(crate) use parse::{FormulaFault, is_free_name};
pub(crate) use roots::{Line, Searches, Solver};

use std::sync::Arc;
use tape::Tape;

/// A formula in x, y, z and the time, whose sign tells inside from outside.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Formula {
    /// The tape, in which the time is replaced by a constant.
    tape: Tape,
    /// The tape in which the time is a variable, if the formula depends on it.
    moving: Option<Arc<Tape>>,
}

impl Formula {
    /// Parses a formula, in which `params` are constants with names, and sets its time to 0.
    ///
    /// # Errors
    /// The first fault, with its range of bytes in `text`.
    pub(crate) fn parse(text: &str, params: &[(String, f64)]) -> Result<Self, FormulaFault> {
        let tape = parse::parse(text, params)?;
        if tape.moves() {
            return Ok(Self { tape: tape.at_time(0.0), moving: Some(Arc::new(tape)) });
        }
        Ok(Self { tape, moving: None })
    }

    /// Returns whether the formula depends on the time.
    pub(crate) fn moves(&self) -> bool {
        self.moving.is_some()
    }

    /// Returns the formula at a time in seconds.
    pub(crate) fn at_time(&self, seconds: f64) -> Self {
        let tape = self.moving.as_ref().map_or_else(|| self.tape.clone(), |moving| moving.at_time(seconds));
        Self { tape, moving: self.moving.clone() }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
