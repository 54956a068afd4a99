//! The files that a scene was read from, and the state of each at that time.

use std::fs::{self, Metadata};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// A file that a scene is read from, and its state just before it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) struct Dependency {
    path: PathBuf,
    state: DependencyState,
}

/// The state of the file that a path leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DependencyState {
    /// There is no file, or the process has no access to it.
    Missing,
    /// A regular file.
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
    /// Its times are not compared, because reading a pipe or device changes them.
    Special(Identity),
}

/// Device and inode number, which identify a file or folder.
pub(super) type Identity = (u64, u64);

impl DependencyState {
    fn read(path: &Path) -> Self {
        match fs::metadata(path) {
            Ok(data) if data.is_file() => Self::Plain {
                identity: identity(&data),
                mode: data.mode(),
                modified: (data.mtime(), data.mtime_nsec()),
                length: data.len(),
            },
            Ok(data) => Self::Special(identity(&data)),
            Err(_) => Self::Missing,
        }
    }
}

pub(super) fn identity(data: &Metadata) -> Identity {
    (data.dev(), data.ino())
}

impl Dependency {
    /// Returns the file at `path` with its current state.
    pub(in crate::app) fn in_current_state(path: &Path) -> Self {
        Self { path: path.to_owned(), state: DependencyState::read(path) }
    }

    pub(in crate::app) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns whether the path led to a pipe, device or folder, so that reading it may block for
    /// ever.
    pub(in crate::app) fn is_special_file(&self) -> bool {
        matches!(self.state, DependencyState::Special(_))
    }

    /// Returns whether the path now leads to another file, or to the same file with another state.
    ///
    /// A missing file does not count as changed, because an event reports when it comes back.
    pub(in crate::app) fn has_changed(&self) -> bool {
        // Some editors replace a file in two steps, between which it is missing.
        let now = DependencyState::read(&self.path);
        now != DependencyState::Missing && now != self.state
    }
}
