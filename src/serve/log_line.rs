//! The lines of the server's log: an event, and its details as `key=value`.
//!
//! Pure: [`Log`](super::Log) writes them.

use std::fmt::{Display, Write};

/// A line of the log, such as `event=refused from=192.0.2.0/24 reason=rate`.
pub(super) struct LogLine(String);

impl LogLine {
    /// Returns the line of an event without details.
    pub(super) fn event(name: &str) -> Self {
        Self(format!("event={name}"))
    }

    /// Adds a detail.
    ///
    /// A value that is no plain word is quoted, so that a file's name or an error adds neither keys nor lines.
    pub(super) fn with(mut self, key: &str, value: impl Display) -> Self {
        let value = value.to_string();
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.:/+".contains(c);
        let _ = if !value.is_empty() && value.chars().all(is_plain) {
            write!(self.0, " {key}={value}")
        } else {
            // Escapes quotes, control characters, and characters that are invisible or change the direction of writing.
            write!(self.0, " {key}={value:?}")
        };
        self
    }

    /// Returns the text of the line.
    pub(super) fn text(&self) -> &str {
        &self.0
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
