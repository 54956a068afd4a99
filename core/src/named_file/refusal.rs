//! The reason why a file was not read, in words.

use std::fmt;
use std::io::{self, ErrorKind};

/// Returns an I/O error with the given message, which [`reason`] returns unchanged.
pub(super) fn refusal_error(kind: ErrorKind, message: String) -> io::Error {
    io::Error::new(kind, Refusal(message))
}

/// The payload of errors that [`refusal_error`] returns.
// A distinct type, by which `reason` recognises messages that need no prefix.
#[derive(Debug)]
struct Refusal(String);

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

/// Returns the message of an error, to be put after a file's name and a colon.
// The system's messages end with "(os error 2)", which does not help users, so the common ones are replaced.
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        _ if error.get_ref().and_then(|inner| inner.downcast_ref::<Refusal>()).is_some() => error.to_string(),
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::IsADirectory => "this is a directory, not a file".to_owned(),
        ErrorKind::PermissionDenied => "no permission to read this file".to_owned(),
        _ => format!("cannot be read: {error}"),
    }
}
