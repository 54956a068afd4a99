//! Files under a temporary name: made, renamed, and found again when their process was killed.
//!
//! Each is locked (`flock`) for as long as its process lives. Making and locking are two steps; if another process takes
//! an unlocked one for a leftover between them, the maker sees that it lost the file and makes another.

use super::target::folder_of;
use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use std::ffi::OsStr;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read, Seek, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, fchown};
use std::path::{Path, PathBuf};

/// Names are `.termtrace-PROCESS-NUMBER.tmp`.
const START: &str = ".termtrace-";
const END: &str = ".tmp";

/// As many names are tried: more than a process writes at once, or than can be left by earlier ones of its number.
const MOST_NAMES: u32 = 1000;

/// A locked file of our own, removed when dropped.
#[derive(Debug)]
pub(super) struct Temporary {
    /// `None`: it has another name, or is gone.
    path: Option<PathBuf>,
    file: File,
}

impl Temporary {
    /// For a new file: with the mode that the umask gives.
    pub(super) fn new_file(target: &Path) -> io::Result<Self> {
        Self::beside(target, 0o666)
    }

    /// For a file that has a mode already, and may be secret.
    pub(super) fn private(target: &Path) -> io::Result<Self> {
        Self::beside(target, 0o600)
    }

    fn beside(target: &Path, mode: u32) -> io::Result<Self> {
        let process = std::process::id();
        for number in 0..MOST_NAMES {
            let path = folder_of(target).join(format!("{START}{process}-{number}{END}"));
            match OpenOptions::new().read(true).write(true).create_new(true).mode(mode).open(&path) {
                Ok(file) => {
                    if let Some(temporary) = Self::claim(path, file)? {
                        return Ok(temporary);
                    }
                }
                // It is another process's of this number, in a container, or a leftover.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other("its folder is full of temporary files"))
    }

    /// Locks a file just made; `None` if another process takes it for a leftover.
    fn claim(path: PathBuf, file: File) -> io::Result<Option<Self>> {
        // Where the file system has no locks, nobody else gets one to remove it either.
        let is_taken = try_lock(&file) == Err(Errno::WOULDBLOCK);
        if is_taken || !is_at(&file, &path)? {
            return Ok(None);
        }
        Ok(Some(Self { path: Some(path), file }))
    }

    /// Gives it another's owner and mode.
    pub(super) fn become_like(&self, other: &Metadata) -> io::Result<()> {
        let own = self.file.metadata()?;
        if (own.uid(), own.gid()) != (other.uid(), other.gid()) {
            fchown(&self.file, Some(other.uid()), Some(other.gid()))?;
        }
        // After the owner: a change of owner takes the set-user-id bit away.
        if own.mode() != other.mode() {
            self.file.set_permissions(other.permissions())?;
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

    /// All that was written.
    pub(super) fn contents(&mut self) -> io::Result<Vec<u8>> {
        let mut contents = Vec::new();
        self.file.rewind()?;
        self.file.read_to_end(&mut contents)?;
        Ok(contents)
    }

    /// Removes its like in its folder, of its owner, whose processes have ended.
    pub(super) fn remove_stale(&self) {
        let Some((path, own)) = self.path.as_deref().zip(self.file.metadata().ok()) else { return };
        for entry in fs::read_dir(folder_of(path)).into_iter().flatten().flatten() {
            if is_temporary(&entry.file_name()) {
                // Not ours, or gone already.
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
            let _ = fs::remove_file(path);
        }
    }
}

/// Its writer holds a lock. With the lock ours, the file is nobody's, and if it still has the name, nobody else can take
/// the name from it.
fn remove_if_stale(path: &Path, owner: u32) -> io::Result<()> {
    let data = fs::symlink_metadata(path)?;
    if data.is_file() && data.uid() == owner {
        // Writable, because some network file systems lock no others.
        let file = File::options().write(true).open(path)?;
        if try_lock(&file).is_ok() && is_at(&file, path)? {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Locks the file if no other has it locked. (The standard library's function came with Rust 1.89.)
fn try_lock(file: &File) -> rustix::io::Result<()> {
    flock(file, FlockOperation::NonBlockingLockExclusive)
}

/// Whether the file has this name.
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    let own = file.metadata()?;
    match fs::symlink_metadata(path) {
        Ok(there) => Ok((there.dev(), there.ino()) == (own.dev(), own.ino())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// Whether a name is exactly one of ours.
fn is_temporary(name: &OsStr) -> bool {
    let numbers = name.to_str().and_then(|name| name.strip_prefix(START)?.strip_suffix(END)?.split_once('-'));
    let is_number = |text: &str| text.parse::<u32>().is_ok_and(|number| number.to_string() == text);
    numbers.is_some_and(|(process, number)| is_number(process) && is_number(number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_our_own_names_are_temporary() {
        for (name, expected) in [
            (".termtrace-1-0.tmp", true),
            (".termtrace-4194304-999.tmp", true),
            ("termtrace-1-0.tmp", false),
            (".termtrace-1-0.tmp~", false),
            (".termtrace-1.tmp", false),
            (".termtrace--0.tmp", false),
            (".termtrace-01-0.tmp", false),
            (".termtrace-+1-0.tmp", false),
            (".termtrace-1-0-0.tmp", false),
            (".termtrace-99999999999-0.tmp", false),
            (".termtrace-x-0.tmp", false),
        ] {
            assert_eq!(is_temporary(OsStr::new(name)), expected, "{name}");
        }
    }

    /// Another process may look at the folder between the making of a file and its lock.
    #[test]
    fn a_file_taken_for_a_leftover_is_not_written() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join(".termtrace-1-0.tmp");
        let made = || File::create_new(&path).expect("the name is unused");
        let removed = made();
        fs::remove_file(&path).expect("it is there");
        assert!(Temporary::claim(path.clone(), removed).expect("it can be looked at").is_none());
        let (locked, other) = (made(), File::open(&path).expect("it is there"));
        other.lock().expect("nobody has it");
        assert!(Temporary::claim(path.clone(), locked).expect("it can be looked at").is_none());
        assert!(path.exists(), "who has the lock removes it");
    }
}
