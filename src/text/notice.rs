//! An error message in parts, for where there is little room for it.

use super::visible;
use std::convert::Infallible;

/// What is wrong, and what of it can be shown. No character of it controls a terminal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notice {
    /// What is wrong, after its place if it has one: one line.
    pub message: String,
    /// The line of a file that it is about, and one with carets below what is wrong in it.
    pub excerpt: Option<[String; 2]>,
    /// Whether more is wrong than this.
    pub has_more: bool,
}

impl From<String> for Notice {
    /// A message of one line.
    fn from(message: String) -> Self {
        Self { message: visible(&message), ..Self::default() }
    }
}

impl From<Infallible> for Notice {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}
