//! The error of reading a mesh: one line with the position.

use crate::text::visible;
use std::fmt;

/// The error of reading a mesh: its first fault. Its `Display` is one line without control
/// characters:
///
/// ```text
/// bunny.obj:1042:9: vertex 35948 does not exist: the file has 35947
/// bunny.glb: byte 20: this chunk should be JSON, but is "BIN"
/// ```
///
/// ```
/// use termtrace::{LoadError, Scene};
///
/// let path = std::env::temp_dir().join(format!("termtrace-{}.obj", std::process::id()));
/// std::fs::write(&path, "v 0 0 0\nf 1 2 3\n")?;
/// let error = Scene::load(&path).expect_err("there is only one vertex");
/// std::fs::remove_file(&path)?;
/// assert!(matches!(error, LoadError::Mesh(_)));
/// assert!(error.to_string().ends_with(".obj:2:5: vertex 2 does not exist: the file has 1"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshError {
    name: String,
    position: FilePosition,
    message: String,
}

/// The position of a fault in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePosition {
    /// The file as a whole. In glTF, the message begins with the faulty value's path in the JSON.
    File,
    /// In a text: line and column, counted from 1, the column in characters.
    Text {
        /// The line.
        line: usize,
        /// The column.
        column: usize,
    },
    /// In a binary file: the byte, counted from 0.
    Byte(usize),
}

impl MeshError {
    /// Returns an error of a file as a whole.
    pub(super) fn of_file(name: &str, message: &str) -> Self {
        Self::at(name, FilePosition::File, message)
    }

    pub(super) fn at(name: &str, position: FilePosition, message: &str) -> Self {
        Self { name: visible(name), position, message: visible(message) }
    }

    /// Returns the name of the file with the fault: the mesh, or a side file.
    #[doc(hidden)]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the position of the fault.
    #[doc(hidden)]
    pub fn position(&self) -> FilePosition {
        self.position
    }

    /// Returns the message: one line without a full stop.
    #[doc(hidden)]
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, position, message } = self;
        match position {
            FilePosition::File => write!(f, "{name}: {message}"),
            FilePosition::Text { line, column } => write!(f, "{name}:{line}:{column}: {message}"),
            FilePosition::Byte(byte) => write!(f, "{name}: byte {byte}: {message}"),
        }
    }
}

impl std::error::Error for MeshError {}
