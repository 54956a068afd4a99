//! Output files that are replaced atomically.
//!
//! An [`OutputFile`] is written under a temporary name in the folder of its target. [`OutputFile::finish`] syncs it to
//! disk (`sync_all`) and renames it. If it is dropped before that, the temporary file is removed, and the target is
//! unchanged. If two processes write the same target, the result is the complete file of the one that finishes last.
//!
//! - **Symbolic links** are followed, even if their target does not exist yet: the link stays a link.
//! - **A new file** gets the mode that the umask gives; **an existing one** keeps its owner and mode, and is refused if
//!   this process may not write it. Access control lists and extended attributes are not copied.
//! - **Devices, pipes and descriptors** (`/dev/stdout`) cannot be replaced: [`open_stream`] opens them.
//! - **In place**, over its old bytes, an existing file is written only if its identity cannot be kept otherwise: it
//!   has another hard link (which a new file would break), its owner cannot be restored, its folder does not allow new
//!   files, or it is a mount point. The contents are finished first, and a lock keeps other writers out. If writing
//!   fails, as on a full disk, the old bytes are written back; but a crash of the machine or SIGKILL within these
//!   milliseconds leaves a mixture.
//! - **Leftovers**: a killed process leaves its temporary file. [`OutputFile::remove_stale`] removes those with exactly
//!   our pattern of name that belong to our user and are not locked by a living writer.
//!
//! The rename itself is not synced: after a power failure there is the old file or the new one.
//!
//! The crate `tempfile` was considered: its `NamedTempFile` would replace some thirty lines (unused name, removal on
//! drop, rename), but not the locks that tell a leftover from a living writer's file, nor links, owners and writing in
//! place. `O_TMPFILE`, which leaves nothing even when killed, is missing on macOS and several file systems, so that all
//! of this would be needed beside it.

mod in_place;
mod target;
mod temporary;

use std::fs::{self, File, Metadata};
use std::io::{self, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
pub use target::open_stream;
use temporary::Temporary;

/// An output file whose contents appear at its path only when it is finished.
#[derive(Debug)]
pub struct OutputFile {
    /// The path of the file to write, after symbolic links are followed.
    target: PathBuf,
    destination: Destination,
}

/// The storage of the contents until the file is finished, and the way they then reach the target.
#[derive(Debug)]
enum Destination {
    /// A temporary file that is renamed to the target, even if another file has got that name
    /// meanwhile.
    New(Temporary),
    /// A temporary file that is renamed to the target only if that name is still unused.
    NewOnly(Temporary),
    /// A temporary file that replaces an existing file, and gets its owner and mode from this
    /// metadata.
    Replace(Temporary, Metadata),
    /// A buffer that is written over the bytes of an existing file.
    InPlace(Vec<u8>),
}

impl OutputFile {
    /// Starts a file that replaces the file at the path, if there is one.
    ///
    /// # Errors
    /// If the path leads to a folder, a stream (see [`open_stream`]) or a file that may not be written, or the folder
    /// does not allow a new file.
    pub fn create(path: &Path) -> io::Result<Self> {
        let target = target::resolve_links(path);
        let destination = match fs::metadata(path) {
            Ok(existing) => destination_over(&target, existing)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                target::check_names_a_file(&target)?;
                Destination::New(Temporary::new_file(&target)?)
            }
            Err(error) => return Err(error),
        };
        Ok(Self { target, destination })
    }

    /// Starts a file whose name must be unused.
    ///
    /// # Errors
    /// [`AlreadyExists`](io::ErrorKind::AlreadyExists), here or from [`finish`](Self::finish), if the name is used,
    /// even by a link; or if the folder does not allow a new file.
    pub fn create_new(path: &Path) -> io::Result<Self> {
        Self::create_new_by(path, Temporary::new_file)
    }

    /// Starts a file whose name must be unused and which only its owner may read (mode 0600).
    ///
    /// # Errors
    /// As for [`create_new`](Self::create_new).
    pub fn create_new_private(path: &Path) -> io::Result<Self> {
        Self::create_new_by(path, Temporary::new_private_file)
    }

    fn create_new_by(path: &Path, create: impl FnOnce(&Path) -> io::Result<Temporary>) -> io::Result<Self> {
        match fs::symlink_metadata(path) {
            Ok(_) => Err(io::ErrorKind::AlreadyExists.into()),
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            Err(_) => Ok(Self { target: path.to_owned(), destination: Destination::NewOnly(create(path)?) }),
        }
    }

    /// Starts a file in `folder` that [`finish_unused`](Self::finish_unused) will complete and
    /// name.
    ///
    /// # Errors
    /// If the folder does not allow a new file.
    pub fn create_in(folder: &Path) -> io::Result<Self> {
        // `finish_unused` chooses the name. Until then only the folder of the target matters.
        let target = folder.join("new");
        let destination = Destination::NewOnly(Temporary::new_file(&target)?);
        Ok(Self { target, destination })
    }

    /// Completes the file under the first path of `names` that is unused, and returns that path.
    ///
    /// # Errors
    /// If the file cannot be written or renamed, or [`AlreadyExists`](io::ErrorKind::AlreadyExists) if all names are
    /// used.
    pub fn finish_unused(mut self, names: impl IntoIterator<Item = PathBuf>) -> io::Result<PathBuf> {
        if let Destination::NewOnly(temporary) = &mut self.destination {
            // Synced once for all names, because a new name does not change the contents.
            temporary.sync()?;
            for name in names {
                match rename_to_unused(temporary, &name) {
                    Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                    done => return done.map(|()| name),
                }
            }
        }
        Err(io::Error::new(io::ErrorKind::AlreadyExists, "there are too many of that name"))
    }

    /// Removes the temporary files that killed processes of this user left in the folder.
    ///
    /// Each call reads the whole folder, so a command that writes many files should call this once.
    pub fn remove_stale(&self) {
        if let Destination::New(temporary) | Destination::NewOnly(temporary) | Destination::Replace(temporary, _) =
            &self.destination
        {
            temporary.remove_stale();
        }
    }

    /// Completes the file and gives it its final name.
    ///
    /// # Errors
    /// If it cannot be written or renamed, in which case the target is unchanged.
    pub fn finish(self) -> io::Result<()> {
        let target = &self.target;
        match self.destination {
            Destination::New(mut temporary) => temporary.sync().and_then(|()| temporary.rename(target)),
            Destination::NewOnly(mut temporary) => {
                temporary.sync().and_then(|()| rename_to_unused(&mut temporary, target))
            }
            Destination::Replace(mut temporary, existing) => rename_or_overwrite(&mut temporary, &existing, target),
            Destination::InPlace(contents) => in_place::write(target, &contents),
        }
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.destination {
            Destination::New(temporary) | Destination::NewOnly(temporary) | Destination::Replace(temporary, _) => {
                temporary.write(bytes)
            }
            Destination::InPlace(contents) => contents.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Returns the destination for contents that are to replace an existing file.
fn destination_over(target: &Path, existing: Metadata) -> io::Result<Destination> {
    target::check_writable(target, &existing)?;
    match Temporary::new_private_file(target) {
        Ok(temporary) => Ok(Destination::Replace(temporary, existing)),
        Err(error) if is_replacement_refused(&error) => Ok(Destination::InPlace(Vec::new())),
        Err(error) => Err(error),
    }
}

/// Renames the temporary file to a name that must be unused.
// The name is reserved by an empty file first, because not all file systems support the system calls that fail if the
// name exists (`link`, `renameat2`).
fn rename_to_unused(temporary: &mut Temporary, target: &Path) -> io::Result<()> {
    File::create_new(target)?;
    temporary.rename(target).inspect_err(|_| {
        let _ = fs::remove_file(target);
    })
}

/// Replaces a file by renaming, or overwrites it if renaming would change more than its contents.
fn rename_or_overwrite(temporary: &mut Temporary, existing: &Metadata, target: &Path) -> io::Result<()> {
    if existing.nlink() == 1 && temporary.copy_owner_and_mode(existing).is_ok() {
        // The file is synced before it is renamed; otherwise, after a power failure, some file systems have an empty
        // file under the name.
        temporary.sync()?;
        match temporary.rename(target) {
            Err(error) if is_replacement_refused(&error) => {}
            done => return done,
        }
    }
    in_place::write(target, &temporary.contents()?)
}

/// Returns whether an error means that the folder does not allow a new file or a rename over the
/// target.
// Files that cannot be replaced are, for example, another user's file in a sticky folder, and a mount point.
fn is_replacement_refused(error: &io::Error) -> bool {
    use io::ErrorKind::{PermissionDenied, ReadOnlyFilesystem, ResourceBusy};
    matches!(error.kind(), PermissionDenied | ReadOnlyFilesystem | ResourceBusy)
}

#[cfg(all(test, unit_tests))]
mod tests;
