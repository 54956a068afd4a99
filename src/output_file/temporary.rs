//! Temporary files: their creation, renaming, and removal after their process was killed.
//!
//! Each file is locked (`flock`) while its process lives. Creating and locking are two steps: if another process
//! removes the file between them as a leftover, its creator notices that and creates another one.

use super::target::folder_of;
use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use std::ffi::OsStr;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read, Seek, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, fchown};
use std::path::{Path, PathBuf};

/// Start of a temporary file's name, `.termtrace-PROCESS-NUMBER.tmp`.
const NAME_PREFIX: &str = ".termtrace-";
/// End of a temporary file's name.
const NAME_SUFFIX: &str = ".tmp";

/// Largest number of names that are tried for a temporary file.
// More than the files that a process writes at once, or that killed processes with the same process number left.
const MAX_NAME_ATTEMPTS: u32 = 1000;

/// A locked temporary file, which is removed when dropped.
#[derive(Debug)]
pub(super) struct Temporary {
    /// The path of the temporary file; `None` once it has been renamed to its target.
    path: Option<PathBuf>,
    file: File,
}

impl Temporary {
    /// Creates a temporary file that will become a new file, with the mode that the umask gives.
    pub(super) fn new_file(target: &Path) -> io::Result<Self> {
        Self::create_beside(target, 0o666)
    }

    /// Creates a temporary file that will replace an existing one, readable by the owner only.
    // The file to be replaced may be secret. The temporary file gets the mode of that file only when the contents are
    // complete.
    pub(super) fn new_private_file(target: &Path) -> io::Result<Self> {
        Self::create_beside(target, 0o600)
    }

    fn create_beside(target: &Path, mode: u32) -> io::Result<Self> {
        let process = std::process::id();
        for number in 0..MAX_NAME_ATTEMPTS {
            let path = folder_of(target).join(format!("{NAME_PREFIX}{process}-{number}{NAME_SUFFIX}"));
            match OpenOptions::new().read(true).write(true).create_new(true).mode(mode).open(&path) {
                Ok(file) => {
                    if let Some(temporary) = Self::lock_new(path, file)? {
                        return Ok(temporary);
                    }
                }
                // The name is taken, by a leftover file or by a process with the same id in another container: try the
                // next name.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other("its folder is full of temporary files"))
    }

    /// Locks a file just created; returns `None` if another process is removing it as a leftover.
    fn lock_new(path: PathBuf, file: File) -> io::Result<Option<Self>> {
        // Other errors of locking are ignored: where files cannot be locked, no process removes leftovers.
        let is_taken = try_lock(&file) == Err(Errno::WOULDBLOCK);
        if is_taken || !has_path(&file, &path)? {
            return Ok(None);
        }
        Ok(Some(Self { path: Some(path), file }))
    }

    /// Gives the temporary file the owner and mode of another file.
    pub(super) fn copy_owner_and_mode(&self, replaced: &Metadata) -> io::Result<()> {
        let own = self.file.metadata()?;
        if (own.uid(), own.gid()) != (replaced.uid(), replaced.gid()) {
            fchown(&self.file, Some(replaced.uid()), Some(replaced.gid()))?;
        }
        // The mode is set after the owner, because changing the owner clears the set-user-id bit.
        if own.mode() != replaced.mode() {
            self.file.set_permissions(replaced.permissions())?;
        }
        Ok(())
    }

    pub(super) fn sync(&self) -> io::Result<()> {
        self.file.sync_all()
    }

    pub(super) fn rename(&mut self, target: &Path) -> io::Result<()> {
        if let Some(path) = &self.path {
            fs::rename(path, target)?;
        }
        self.path = None;
        Ok(())
    }

    /// Returns all bytes written so far.
    pub(super) fn contents(&mut self) -> io::Result<Vec<u8>> {
        let mut contents = Vec::new();
        self.file.rewind()?;
        self.file.read_to_end(&mut contents)?;
        Ok(contents)
    }

    /// Removes temporary files in the same folder that belong to the same user and whose processes
    /// have ended.
    pub(super) fn remove_stale(&self) {
        let Some((path, own)) = self.path.as_deref().zip(self.file.metadata().ok()) else { return };
        for entry in fs::read_dir(folder_of(path)).into_iter().flatten().flatten() {
            if is_temporary_name(&entry.file_name()) {
                // Errors are ignored: the file is another user's, or already removed.
                let _ = remove_if_stale(&entry.path(), own.uid());
            }
        }
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(path) = &self.path {
            // If this fails, the next run removes the file.
            let _ = fs::remove_file(path);
        }
    }
}

/// Removes a temporary file of the user `owner`, if no process has locked it.
// A file that this process can lock has no living writer. It is removed only if it still has the name, which may have
// been given to a new file in between.
fn remove_if_stale(path: &Path, owner: u32) -> io::Result<()> {
    let data = fs::symlink_metadata(path)?;
    if data.is_file() && data.uid() == owner {
        // Opened for writing, because some network file systems can lock a file only then.
        let file = File::options().write(true).open(path)?;
        if try_lock(&file).is_ok() && has_path(&file, path)? {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Locks the file, unless another process has locked it.
// The standard library's `File::try_lock` requires Rust 1.89; the crate supports 1.88.
fn try_lock(file: &File) -> rustix::io::Result<()> {
    flock(file, FlockOperation::NonBlockingLockExclusive)
}

/// Returns whether `path` refers to `file`.
fn has_path(file: &File, path: &Path) -> io::Result<bool> {
    // Compared by device and inode number, because the name may belong to another file by now.
    let own = file.metadata()?;
    match fs::symlink_metadata(path) {
        Ok(there) => Ok((there.dev(), there.ino()) == (own.dev(), own.ino())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// Returns whether a name has exactly the form of a temporary file's name.
fn is_temporary_name(name: &OsStr) -> bool {
    let numbers =
        name.to_str().and_then(|name| name.strip_prefix(NAME_PREFIX)?.strip_suffix(NAME_SUFFIX)?.split_once('-'));
    let is_number = |text: &str| text.parse::<u32>().is_ok_and(|number| number.to_string() == text);
    numbers.is_some_and(|(process, number)| is_number(process) && is_number(number))
}

#[cfg(all(test, unit_tests))]
mod tests;
