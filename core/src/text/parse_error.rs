//! The error of `FromStr` implementations.

use super::{closest, listed, visible};
use std::fmt;

/// The error of parsing a value from text: what was found, and what would be right.
///
/// ```
/// use termtrace::{Map, ParseError};
///
/// let error: ParseError = "norml".parse::<Map>().unwrap_err();
/// assert_eq!(error.to_string(), "unknown map \"norml\"; did you mean \"normal\"?");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseError {
    message: String,
}

impl ParseError {
    /// Returns an error with this message: one line without a full stop.
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into() }
    }
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ParseError {}

/// Returns the value among `all` whose name is `text`.
///
/// # Errors
/// If no value has this name. The message gives the name that was probably meant, or else all names.
pub fn named<T: Copy>(kind: &str, text: &str, all: &[T], name: fn(T) -> &'static str) -> Result<T, ParseError> {
    all.iter().copied().find(|&value| name(value) == text).ok_or_else(|| {
        let names: Vec<_> = all.iter().map(|&value| name(value)).collect();
        let unknown = format!("unknown {kind} \"{}\"", visible(text));
        ParseError::new(match closest(text, names.iter().copied()) {
            Some(meant) => format!("{unknown}; did you mean \"{meant}\"?"),
            None => format!("{unknown}; there are {}", listed(&names)),
        })
    })
}
