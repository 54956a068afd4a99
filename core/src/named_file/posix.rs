//! Opening of files and pipes on POSIX systems, without blocking.

use super::Accepted;
use super::refusal::refusal_error;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;
use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, ErrorKind};
use std::os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::time::{Duration, Instant};

/// Longest time to wait for bytes from a pipe.
// By then, a program in `<(...)` has usually started to write, and a longer wait would look like a hang.
const PIPE_TIMEOUT: Duration = Duration::from_secs(1);

/// Opens a file, and returns the size in bytes that the system reports: 0 for a pipe, and too small
/// for a file that grows.
pub(super) fn open(path: &Path, accepted: Accepted) -> io::Result<(File, u64)> {
    // The file is checked before it is opened, because opening a device may have an effect, and again afterwards,
    // because another file may have got its name in between.
    check_kind(&path.metadata()?, accepted)?;
    // Without this flag, opening a FIFO waits for its writer.
    let flags = OFlags::NONBLOCK | OFlags::NOCTTY;
    let file = OpenOptions::new().read(true).custom_flags(flags.bits().cast_signed()).open(path)?;
    let data = file.metadata()?;
    check_kind(&data, accepted)?;
    Ok((file, data.len()))
}

fn check_kind(data: &Metadata, accepted: Accepted) -> io::Result<()> {
    let kind = data.file_type();
    let with_pipes = accepted == Accepted::FilesAndPipes;
    let what = match kind {
        _ if kind.is_file() || with_pipes && (kind.is_fifo() || is_null(data)) => return Ok(()),
        _ if kind.is_dir() => return Err(ErrorKind::IsADirectory.into()),
        _ if kind.is_fifo() => "a pipe",
        _ if kind.is_socket() => "a socket",
        _ => "a device",
    };
    let wanted = if with_pipes { "a file or a pipe" } else { "a plain file" };
    Err(refusal_error(ErrorKind::InvalidInput, format!("this is {what}, not {wanted}")))
}

/// Returns whether the metadata is that of `/dev/null`, under any path.
fn is_null(data: &Metadata) -> bool {
    let is_same = |null: Metadata| data.file_type().is_char_device() && data.rdev() == null.rdev();
    Path::new("/dev/null").metadata().is_ok_and(is_same)
}

/// Waits until the file has bytes to read or is at its end, or fails after [`PIPE_TIMEOUT`].
///
/// A plain file is always ready.
pub(super) fn wait_until_readable(file: &File) -> io::Result<()> {
    let deadline = Instant::now() + PIPE_TIMEOUT;
    loop {
        let left = Timespec::try_from(deadline.saturating_duration_since(Instant::now())).ok();
        match poll(&mut [PollFd::new(file, PollFlags::IN)], left.as_ref()) {
            Ok(0) => {
                return Err(refusal_error(ErrorKind::TimedOut, "this pipe delivered nothing for a second".to_owned()));
            }
            Err(rustix::io::Errno::INTR) => {}
            // If polling fails, reading reports the reason.
            _ => return Ok(()),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
