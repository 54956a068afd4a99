//! Output files that are replaced whole, or not at all.
//!
//! An [`OutputFile`] is written under a temporary name in the folder of its target. [`OutputFile::finish`] sends it to the
//! disk (`sync_all`) and renames it; dropped before that, it is removed, and what stands under the target's name is as it
//! was. So of two processes that write one name, the later one's file is there, whole.
//!
//! - **Symbolic links** are followed, also one whose target does not exist yet: the link stays a link.
//! - **A new file** gets the mode that the umask gives; **an existing one** keeps its owner and mode, and is refused if
//!   this process may not write it. Access control lists and extended attributes are not copied.
//! - **Devices, pipes and descriptors** (`/dev/stdout`) cannot be replaced: [`open_stream`] opens them.
//! - **In place**, over its old bytes, an existing file is written only if nothing else keeps what it is: it has another
//!   hard link (a new file would cut it), its owner cannot be given back, its folder takes no new file, or it is a
//!   mount point. The contents are finished first, and a lock keeps other writers out. If writing fails, as on a full
//!   disk, the old bytes are put back; but a crash of the machine or SIGKILL in these milliseconds leaves a mixture.
//! - **Leftovers**: a process that is killed leaves its temporary file. [`OutputFile::remove_stale`] removes those that
//!   have exactly our pattern of name, belong to our user, and are not locked by a process that still writes them.
//!
//! The rename itself is not awaited on the disk: after a power failure there is the old file or the new one.
//!
//! The crate `tempfile` was weighed: its `NamedTempFile` would replace some thirty lines (unused name, removal on drop,
//! rename), but neither the locks by which a leftover is told from a living writer's file, nor links, owners and what is
//! written in place. `O_TMPFILE`, which leaves nothing even when killed, is missing on macOS and several file
//! systems, so that all of this would be needed beside it.

mod in_place;
mod target;
mod temporary;

use std::fs::{self, File, Metadata};
use std::io::{self, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
pub use target::open_stream;
use temporary::Temporary;

/// A file that has its name once it is finished.
#[derive(Debug)]
pub struct OutputFile {
    /// Where symbolic links lead to.
    target: PathBuf,
    place: Place,
}

/// Where the contents are until the file is finished, and what becomes of them.
#[derive(Debug)]
enum Place {
    /// Takes the name, whether or not a file has got it meanwhile.
    New(Temporary),
    /// Takes the name if it is still unused.
    Unused(Temporary),
    /// Takes the place, owner and mode of a file that was like this.
    Over(Temporary, Metadata),
    /// Goes over the bytes of a file whose folder takes no other.
    Within(Vec<u8>),
}

impl OutputFile {
    /// Begins a file that replaces what the path leads to, if there is something.
    ///
    /// # Errors
    /// If there is a folder, a stream (see [`open_stream`]) or a file that may not be written; if the folder of a new file
    /// takes none.
    pub fn create(path: &Path) -> io::Result<Self> {
        let target = target::followed(path);
        let place = match fs::metadata(path) {
            Ok(existing) => over(&target, existing)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                target::check_names_a_file(&target)?;
                Place::New(Temporary::new_file(&target)?)
            }
            Err(error) => return Err(error),
        };
        Ok(Self { target, place })
    }

    /// Begins a file of a name that is not used yet, not even by a link.
    ///
    /// # Errors
    /// [`AlreadyExists`](io::ErrorKind::AlreadyExists), here or from [`finish`](Self::finish), if the name is used; if the
    /// folder takes no file.
    pub fn create_new(path: &Path) -> io::Result<Self> {
        match fs::symlink_metadata(path) {
            Ok(_) => Err(io::ErrorKind::AlreadyExists.into()),
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            Err(_) => Ok(Self { target: path.to_owned(), place: Place::Unused(Temporary::new_file(path)?) }),
        }
    }

    /// Removes the temporary files that killed processes of this user left in the folder. It reads the whole folder: once
    /// is enough for many files.
    pub fn remove_stale(&self) {
        if let Place::New(temporary) | Place::Unused(temporary) | Place::Over(temporary, _) = &self.place {
            temporary.remove_stale();
        }
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// If it cannot be written or renamed; what stands under the name is then as it was.
    pub fn finish(self) -> io::Result<()> {
        let target = &self.target;
        match self.place {
            Place::New(mut temporary) => temporary.sync().and_then(|()| temporary.rename(target)),
            Place::Unused(mut temporary) => temporary.sync().and_then(|()| take_name(&mut temporary, target)),
            Place::Over(mut temporary, existing) => replace(&mut temporary, &existing, target),
            Place::Within(contents) => in_place::write(target, &contents),
        }
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.place {
            Place::New(temporary) | Place::Unused(temporary) | Place::Over(temporary, _) => temporary.write(bytes),
            Place::Within(contents) => contents.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Where the contents go while this file is there.
fn over(target: &Path, existing: Metadata) -> io::Result<Place> {
    target::check_writable(target, &existing)?;
    match Temporary::private(target) {
        Ok(temporary) => Ok(Place::Over(temporary, existing)),
        Err(error) if is_refused(&error) => Ok(Place::Within(Vec::new())),
        Err(error) => Err(error),
    }
}

/// The name is reserved first, by an empty file: what would leave an existing file alone (`link`, `renameat2`) is not
/// known to all file systems.
fn take_name(temporary: &mut Temporary, target: &Path) -> io::Result<()> {
    File::create_new(target)?;
    temporary.rename(target).inspect_err(|_| {
        let _ = fs::remove_file(target);
    })
}

/// By a rename; in place where that would change more than the contents.
fn replace(temporary: &mut Temporary, existing: &Metadata, target: &Path) -> io::Result<()> {
    if existing.nlink() == 1 && temporary.become_like(existing).is_ok() {
        temporary.sync()?;
        match temporary.rename(target) {
            Err(error) if is_refused(&error) => {}
            done => return done,
        }
    }
    in_place::write(target, &temporary.contents()?)
}

/// Whether a folder takes no new file, or keeps a name (somebody else's in a sticky folder, a mount point's): the file
/// itself may be writable nevertheless.
fn is_refused(error: &io::Error) -> bool {
    use io::ErrorKind::{PermissionDenied, ReadOnlyFilesystem, ResourceBusy};
    matches!(error.kind(), PermissionDenied | ReadOnlyFilesystem | ResourceBusy)
}

#[cfg(test)]
mod tests;
