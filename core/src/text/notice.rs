//! An error message in parts, for panels of the live view with little room.

use super::visible;
use std::convert::Infallible;

/// An error message, and the source line that it refers to. Both contain no control characters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notice {
    /// The message in one line, with the position in the file before it if there is one.
    pub message: String,
    /// The faulty source line, and a line with carets below the fault.
    pub excerpt: Option<[String; 2]>,
    /// Whether there are further errors.
    pub has_more: bool,
}

impl From<String> for Notice {
    /// Returns a notice with this message, without a source line.
    fn from(message: String) -> Self {
        Self { message: visible(&message), ..Self::default() }
    }
}

impl From<Infallible> for Notice {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}
