//! An error message in parts, for places with little room.

use super::visible;
use std::convert::Infallible;

/// An error message and the source line that it refers to. None of its characters controls a
/// terminal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notice {
    /// The message, after its position if it has one: one line.
    pub message: String,
    /// The source line, and a line with carets below the fault in it.
    pub excerpt: Option<[String; 2]>,
    /// Whether there are further errors.
    pub has_more: bool,
}

impl From<String> for Notice {
    /// Returns a notice of one line.
    fn from(message: String) -> Self {
        Self { message: visible(&message), ..Self::default() }
    }
}

impl From<Infallible> for Notice {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}
