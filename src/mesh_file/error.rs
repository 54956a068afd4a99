//! Why a file is no mesh, and how a person is told: one line with the place in it.

use crate::text::visible;
use std::fmt;

/// Why a file gave no mesh: its first fault. Printed, it is one line that controls no terminal:
///
/// ```text
/// bunny.obj:1042:9: vertex 35948 does not exist: 35947 stand above this line
/// bunny.glb: byte 20: this chunk should be JSON, but is "BIN"
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshError {
    name: String,
    place: Place,
    message: String,
}

/// Where in a file a fault lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In all of it, or where its message says.
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
    /// A fault of that file as a whole.
    pub(super) fn of_file(name: &str, message: &str) -> Self {
        Self::at(name, Place::File, message)
    }

    pub(super) fn at(name: &str, place: Place, message: &str) -> Self {
        Self { name: visible(name), place, message: visible(message) }
    }

    /// The file that the fault is in: the mesh, or one that it names.
    #[doc(hidden)]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where the fault is.
    #[doc(hidden)]
    pub fn place(&self) -> Place {
        self.place
    }

    /// What is wrong: one line, no full stop.
    #[doc(hidden)]
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, place, message } = self;
        match place {
            Place::File => write!(f, "{name}: {message}"),
            Place::Text { line, column } => write!(f, "{name}:{line}:{column}: {message}"),
            Place::Byte(byte) => write!(f, "{name}: byte {byte}: {message}"),
        }
    }
}

impl std::error::Error for MeshError {}
