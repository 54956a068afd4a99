//! The internal error type of the readers, which becomes a [`MeshError`] once the file's name is
//! added.

use super::limits::MAX_PATH_BYTES;
use super::{FilePosition, MeshError};
use crate::progress::{Cancelled, Unfinished};
use crate::scene_text::clipped;
use crate::text::visible;

/// A fault, or a cancellation, before the file's name is added.
///
/// Boxed, because parsing a number returns a `Result` with this error, which stays in registers if the error has eight
/// bytes.
#[derive(Debug)]
pub(super) struct MeshFault(Box<Cause>);

#[derive(Debug)]
enum Cause {
    Here {
        offset: FaultOffset,
        message: String,
    },
    /// An error that already has its file's name: in a side file, or in the mesh file if it must
    /// not be left out.
    Elsewhere(MeshError),
    /// Not a fault: the work was cancelled.
    Cancelled,
}

/// The position of a fault: the number of bytes before it. Lines and columns are counted only once
/// a fault is reported.
#[derive(Clone, Copy, Debug)]
enum FaultOffset {
    File,
    /// As `File`, for a side file that is missing or cannot be read.
    SideFile,
    Text(usize),
    Byte(usize),
}

// Faults are made in cold functions, which keep their messages out of the loops of the parsers.
impl MeshFault {
    /// Returns a fault of the whole file, or one whose message gives the position.
    #[cold]
    pub(super) fn of_file(message: impl Into<String>) -> Self {
        Self(Box::new(Cause::Here { offset: FaultOffset::File, message: message.into() }))
    }

    /// Returns the fault, told as that of a side file that is missing or cannot be read.
    #[cold]
    pub(super) fn of_side_file(mut self) -> Self {
        if let Cause::Here { offset, .. } = &mut *self.0 {
            *offset = FaultOffset::SideFile;
        }
        self
    }

    /// Returns whether the fault is that of a side file that is missing or cannot be read.
    pub(super) fn is_of_side_file(&self) -> bool {
        matches!(*self.0, Cause::Here { offset: FaultOffset::SideFile, .. })
    }

    /// Returns a fault at a byte of a text.
    #[cold]
    pub(super) fn in_text(at: usize, message: impl Into<String>) -> Self {
        Self(Box::new(Cause::Here { offset: FaultOffset::Text(at), message: message.into() }))
    }

    /// Returns a fault at a byte of a binary file.
    #[cold]
    pub(super) fn at_byte(at: usize, message: impl Into<String>) -> Self {
        Self(Box::new(Cause::Here { offset: FaultOffset::Byte(at), message: message.into() }))
    }

    /// Returns whether the fault is at one place of the mesh file, so that the rest may be read.
    pub(super) fn is_of_part(&self) -> bool {
        matches!(*self.0, Cause::Here { offset: FaultOffset::Text(_) | FaultOffset::Byte(_), .. })
    }

    /// Returns the error of the file with these bytes.
    pub(super) fn into_error(self, name: &str, bytes: &[u8]) -> Unfinished<MeshError> {
        Unfinished::Failed(match *self.0 {
            Cause::Here { offset: FaultOffset::File | FaultOffset::SideFile, message } => {
                MeshError::of_file(name, &message)
            }
            Cause::Here { offset: FaultOffset::Byte(byte), message } => {
                MeshError::at(name, FilePosition::Byte(byte), &message)
            }
            Cause::Here { offset: FaultOffset::Text(at), message } => {
                let (line, column) = line_and_column(bytes, at);
                MeshError::at(name, FilePosition::Text { line, column }, &message)
            }
            Cause::Elsewhere(error) => error,
            Cause::Cancelled => return Unfinished::Cancelled,
        })
    }
}

impl From<MeshError> for MeshFault {
    fn from(error: MeshError) -> Self {
        Self(Box::new(Cause::Elsewhere(error)))
    }
}

impl From<Unfinished<MeshError>> for MeshFault {
    fn from(unfinished: Unfinished<MeshError>) -> Self {
        match unfinished {
            Unfinished::Cancelled => Cancelled.into(),
            Unfinished::Failed(error) => error.into(),
        }
    }
}

impl From<Cancelled> for MeshFault {
    #[cold]
    fn from(Cancelled: Cancelled) -> Self {
        Self(Box::new(Cause::Cancelled))
    }
}

/// Returns the line and column of a byte, counted from 1. Lines end with a line feed, a carriage
/// return, or both.
fn line_and_column(bytes: &[u8], offset: usize) -> (usize, usize) {
    let before = &bytes[..offset.min(bytes.len())];
    let ends_line =
        |&i: &usize| before[i] == b'\n' || (before[i] == b'\r' && bytes.get(i + 1).is_none_or(|&next| next != b'\n'));
    let line = 1 + (0..before.len()).filter(ends_line).count();
    let start = (0..before.len()).rev().find(ends_line).map_or(0, |end| end + 1);
    // A byte order mark takes no column.
    let text = before[start..].strip_prefix(b"\xef\xbb\xbf").unwrap_or(&before[start..]);
    // A mesh in Latin-1 is read too: a run of bytes that are not UTF-8 counts as one character.
    let characters = |chunk: std::str::Utf8Chunk<'_>| chunk.valid().chars().count() + chunk.invalid().len().min(1);
    (line, 1 + text.utf8_chunks().map(characters).sum::<usize>())
}

/// Returns a piece of a file as messages show it: in quotes, printable, clipped if it is long.
pub(super) fn shown(bytes: &[u8]) -> String {
    // Messages show only the beginning of a long piece, so the rest is not decoded.
    format!("\"{}\"", clipped(&String::from_utf8_lossy(&bytes[..bytes.len().min(200)])))
}

/// Returns a path as messages show it: in quotes, printable.
///
/// Of a long path only the end is shown, which tells more than the folders.
pub(super) fn shown_path(path: &str) -> String {
    const MAX_CHARS: usize = 60;
    let skipped = path.chars().count().saturating_sub(MAX_CHARS);
    if skipped == 0 {
        return format!("\"{}\"", visible(path));
    }
    // Cut before the name of a folder or file, unless the last name alone is too long.
    let tail: String = path.chars().skip(skipped).collect();
    let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let end = match tail.find(['/', '\\']) {
        Some(at) => &tail[at..],
        None if name.len() <= MAX_PATH_BYTES => name,
        None => &tail,
    };
    format!("\"...{}\"", visible(end))
}

#[cfg(all(test, unit_tests))]
mod tests;
