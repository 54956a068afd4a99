//! The files of a scene, and what each was like when it was read.

use std::fs::{self, Metadata};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// A file that a scene needs, and its state before it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) struct Needed {
    path: PathBuf,
    state: State,
}

/// What a path leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Nothing, or nothing that may be reached.
    Missing,
    Plain {
        identity: Identity,
        /// With the permissions: a file that may be read at last is read.
        mode: u32,
        /// Seconds and nanoseconds.
        modified: (i64, i64),
        length: u64,
    },
    /// A folder, a pipe, a device: it is told from others, but not whether it has changed, as pipes and devices do by
    /// being read.
    Other(Identity),
}

/// Device and inode.
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

impl Needed {
    /// The file as it is now.
    pub(in crate::app) fn now(path: &Path) -> Self {
        Self { path: path.to_owned(), state: State::of(path) }
    }

    pub(in crate::app) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns whether it was something else than a plain file: reading may wait for ever.
    pub(in crate::app) fn is_other(&self) -> bool {
        matches!(self.state, State::Other(_))
    }

    /// Returns whether the path leads to something new. A file that is gone is on its way to new contents: its coming back
    /// is told.
    pub(in crate::app) fn has_changed(&self) -> bool {
        let now = State::of(&self.path);
        now != State::Missing && now != self.state
    }
}
