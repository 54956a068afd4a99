//! The file that a path refers to, and checks that it may be written.

use rustix::fs::{Access, access};
use rustix::io::Errno;
use std::fs::{self, File, Metadata};
use std::io;
use std::iter::successors;
use std::path::{Path, PathBuf};

/// Largest number of symbolic links that are followed, as on Linux.
// The system has already resolved the path, so the limit matters only if a loop of links was created since.
const MAX_FOLLOWED_LINKS: usize = 40;

/// Opens a target that cannot be replaced but only written to; returns `None` for all others.
///
/// Such a target is a device, a pipe, a system file (`/proc/...`), or a descriptor (`/dev/stdout`), which may refer to
/// a plain file that another process has open.
///
/// # Errors
/// If the target cannot be opened, or the path cannot be resolved.
pub fn open_stream(path: &Path) -> io::Result<Option<File>> {
    let is_stream = match fs::metadata(path) {
        Ok(data) if data.is_dir() => false,
        Ok(data) => !data.is_file() || link_chain(path).any(|path| is_system_path(&path)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => false,
        Err(error) => return Err(error),
    };
    is_stream.then(|| File::options().write(true).truncate(true).open(path)).transpose()
}

/// Returns the path that remains after following all symbolic links. No file needs to exist there.
// Not `canonicalize`, which fails for a dangling link, whose target is created here.
pub(super) fn resolve_links(path: &Path) -> PathBuf {
    link_chain(path).last().unwrap_or_else(|| path.to_owned())
}

/// Checks that the target is a plain file that this process may write.
// Checked by `access`, not by opening the file, because a file watcher may report the close as a change.
pub(super) fn check_writable(path: &Path, data: &Metadata) -> io::Result<()> {
    if data.is_dir() {
        return Err(Errno::ISDIR.into());
    }
    if !data.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a plain file"));
    }
    Ok(access(path, Access::WRITE_OK)?)
}

/// Checks that the path can be the name of a file: it is not empty, and does not end in `/` or
/// `/.`.
// Without this check, only the rename would fail, after everything has been written.
pub(super) fn check_names_a_file(path: &Path) -> io::Result<()> {
    match path.as_os_str().as_encoded_bytes() {
        [] => Err(Errno::NOENT.into()),
        [.., b'/'] | [.., b'/', b'.'] => Err(Errno::ISDIR.into()),
        _ => Ok(()),
    }
}

/// Returns the folder that contains the path.
pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."))
}

/// Returns the path, then the target of each symbolic link in turn, up to [`MAX_FOLLOWED_LINKS`].
fn link_chain(path: &Path) -> impl Iterator<Item = PathBuf> {
    let next = |path: &PathBuf| fs::read_link(path).ok().map(|to| folder_of(path).join(to));
    successors(Some(path.to_owned()), next).take(MAX_FOLLOWED_LINKS + 1)
}

/// Returns whether a path refers to a descriptor or a file of the kernel.
// Not all folders below `/dev` count: some, such as `/dev/shm`, contain users' files.
fn is_system_path(path: &Path) -> bool {
    let folder = folder_of(path).canonicalize();
    folder.is_ok_and(|folder| {
        folder.starts_with("/proc") || ["/dev", "/dev/fd"].iter().any(|system| folder == Path::new(system))
    })
}
