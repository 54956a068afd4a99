//! The files of a scene and the state of each when it was read.

use std::fs::{self, Metadata};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// A file that a scene needs, and its state before it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) struct Dependency {
    path: PathBuf,
    state: State,
}

/// The thing that a path leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Nothing, or nothing that the process may reach.
    Missing,
    Plain {
        identity: Identity,
        /// The file type and permissions: a file that becomes readable counts as changed.
        mode: u32,
        /// Time of the last modification, in seconds and nanoseconds.
        modified: (i64, i64),
        length: u64,
    },
    /// A folder, pipe or device.
    ///
    /// Only its identity counts: reading alone changes the times of pipes and devices.
    Other(Identity),
}

/// Device and inode numbers.
pub(super) type Identity = (u64, u64);

impl State {
    fn of(path: &Path) -> Self {
        match fs::metadata(path) {
            Ok(data) if data.is_file() => Self::Plain {
                identity: identity(&data),
                mode: data.mode(),
                modified: (data.mtime(), data.mtime_nsec()),
                length: data.len(),
            },
            Ok(data) => Self::Other(identity(&data)),
            Err(_) => Self::Missing,
        }
    }
}

pub(super) fn identity(data: &Metadata) -> Identity {
    (data.dev(), data.ino())
}

impl Dependency {
    /// Returns the file at `path` with its current state.
    pub(in crate::app) fn now(path: &Path) -> Self {
        Self { path: path.to_owned(), state: State::of(path) }
    }

    pub(in crate::app) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns whether it was neither missing nor a plain file, so that reading may block for ever.
    pub(in crate::app) fn is_other(&self) -> bool {
        matches!(self.state, State::Other(_))
    }

    /// Returns whether the path leads to something new.
    ///
    /// A missing file does not count: an event reports when it comes back.
    pub(in crate::app) fn has_changed(&self) -> bool {
        // Editors replace a file in two steps: it is missing for a moment.
        let now = State::of(&self.path);
        now != State::Missing && now != self.state
    }
}
