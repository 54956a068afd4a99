//! The lecture's equations for where a ray crosses a surface: what is put in, and what comes out.
//!
//! They are solved as they stand in the lecture, in f64. What the picture is made with are other forms of them that keep
//! their digits in f32; so the last digits may differ.

/// Where a ray's line crosses a surface, in front of the origin or behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// The computation, line by line.
    pub steps: Vec<Step>,
    /// Each t at which the line crosses the surface, or the plane in which it lies, the least first.
    pub roots: Vec<f64>,
    /// What is said where there is no root.
    pub without_root: &'static str,
    /// Whether the plane is crossed outside the surface.
    pub is_outside: bool,
}

/// A line of a computation, in ASCII.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A formula and its value.
    Value(&'static str, f64),
    /// A formula, or words, without a value.
    Text(&'static str),
    /// Some values with what stands before them and between them.
    Values(&'static str, &'static str, Vec<f64>),
}

/// The quotient, if it is a number and finite.
pub(super) fn quotient(above: f64, below: f64) -> Option<f64> {
    Some(above / below).filter(|quotient| quotient.is_finite())
}
