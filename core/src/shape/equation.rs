//! The lecture's equations for the crossing of a ray and a surface, with inputs and results.
//!
//! Explanations solve them in the lecture's form, in f64. Pictures use other forms, which are stable in f32, so the
//! last digits may differ.

/// A solved equation: the crossings of a ray's line and a surface, including those behind the
/// origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// The solution of the equation, line by line.
    pub steps: Vec<EquationStep>,
    /// The values of t at which the line crosses the surface or its plane, ascending.
    pub roots: Vec<f64>,
    /// The text to show if there is no root.
    pub without_root: &'static str,
    /// Whether the line crosses the surface's plane outside the surface.
    pub is_outside: bool,
}

/// A line of the written-out solution of an [`Equation`], in ASCII.
#[derive(Clone, Debug, PartialEq)]
pub enum EquationStep {
    /// A formula and its value.
    Value(&'static str, f64),
    /// A formula or words without a value.
    Text(&'static str),
    /// The formula f of an implicit surface, as written in the scene file.
    Formula(String),
    /// A list of values: a prefix, the separator between values, and the values.
    Values(&'static str, &'static str, Vec<f64>),
}

/// Returns `above / below` if it is finite.
pub(super) fn finite_quotient(above: f64, below: f64) -> Option<f64> {
    Some(above / below).filter(|quotient| quotient.is_finite())
}
