//! The target of a path, and whether it may be written.

use rustix::fs::{Access, access};
use rustix::io::Errno;
use std::fs::{self, File, Metadata};
use std::io;
use std::iter::successors;
use std::path::{Path, PathBuf};

/// Limit on links followed, as in Linux. The system has followed them before, and found no loop.
const MAX_FOLLOWED_LINKS: usize = 40;

/// Opens a target that can only be written directly: a device, a pipe, a system file (`/proc/...`), or a descriptor
/// (`/dev/stdout`), which may refer to a plain file that another process has open. `None` for everything else.
///
/// # Errors
/// If it cannot be opened, or the path cannot be followed.
/// If it cannot be opened, or the path cannot be followed.
pub fn open_stream(path: &Path) -> io::Result<Option<File>> {
    let is_stream = match fs::metadata(path) {
        Ok(data) if data.is_dir() => false,
        Ok(data) => !data.is_file() || link_chain(path).any(|path| is_system_path(&path)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => false,
        Err(error) => return Err(error),
    };
    is_stream.then(|| File::options().write(true).truncate(true).open(path)).transpose()
}

/// Returns the path after all symbolic links, whether or not something exists there.
pub(super) fn resolve_links(path: &Path) -> PathBuf {
    link_chain(path).last().unwrap_or_else(|| path.to_owned())
}

/// Checks that there is a plain file that this process may write. Checked by `access`, not by opening it: a watcher
/// would take the closed file for a new one.
pub(super) fn check_writable(path: &Path, data: &Metadata) -> io::Result<()> {
    if data.is_dir() {
        return Err(Errno::ISDIR.into());
    }
    if !data.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a plain file"));
    }
    Ok(access(path, Access::WRITE_OK)?)
}

/// Checks that a file can have this name; otherwise the rename would fail after everything is written.
pub(super) fn check_names_a_file(path: &Path) -> io::Result<()> {
    match path.as_os_str().as_encoded_bytes() {
        [] => Err(Errno::NOENT.into()),
        [.., b'/'] | [.., b'/', b'.'] => Err(Errno::ISDIR.into()),
        _ => Ok(()),
    }
}

pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."))
}

/// Returns the path and the target of each symbolic link.
fn link_chain(path: &Path) -> impl Iterator<Item = PathBuf> {
    let next = |path: &PathBuf| fs::read_link(path).ok().map(|to| folder_of(path).join(to));
    successors(Some(path.to_owned()), next).take(MAX_FOLLOWED_LINKS + 1)
}

/// Returns whether a name belongs to the system: a descriptor or a kernel file. (Below `/dev` there are folders for
/// everybody, such as `/dev/shm`.)
fn is_system_path(path: &Path) -> bool {
    let folder = folder_of(path).canonicalize();
    folder.is_ok_and(|folder| {
        folder.starts_with("/proc") || ["/dev", "/dev/fd"].iter().any(|system| folder == Path::new(system))
    })
}
