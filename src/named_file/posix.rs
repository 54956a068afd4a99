//! Files and pipes on POSIX systems.

use super::Accepted;
use super::refusal::refused;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;
use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, ErrorKind};
use std::os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::time::{Duration, Instant};

/// Longest time without bytes from a pipe.
// A program that writes into `<(...)` has started by then, and a longer wait looks like a hang.
const PIPE_TIMEOUT: Duration = Duration::from_secs(1);

/// Opens a file and returns its size, if known: a pipe has none, and a file may grow.
pub(super) fn open(path: &Path, accepted: Accepted) -> io::Result<(File, u64)> {
    // Checked before it is opened, because opening a device may have an effect, and again afterwards, because the name
    // may have been replaced.
    check(&path.metadata()?, accepted)?;
    // Without this flag, opening a FIFO waits for its writer.
    let flags = OFlags::NONBLOCK | OFlags::NOCTTY;
    let file = OpenOptions::new().read(true).custom_flags(flags.bits().cast_signed()).open(path)?;
    let data = file.metadata()?;
    check(&data, accepted)?;
    Ok((file, data.len()))
}

fn check(data: &Metadata, accepted: Accepted) -> io::Result<()> {
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
    Err(refused(ErrorKind::InvalidInput, format!("this is {what}, not {wanted}")))
}

/// Returns whether this is `/dev/null`, under any name.
fn is_null(data: &Metadata) -> bool {
    let is_same = |null: Metadata| data.file_type().is_char_device() && data.rdev() == null.rdev();
    Path::new("/dev/null").metadata().is_ok_and(is_same)
}

/// Waits until there are bytes to read, or the end. A plain file is always ready.
pub(super) fn wait_until_readable(file: &File) -> io::Result<()> {
    let deadline = Instant::now() + PIPE_TIMEOUT;
    loop {
        let left = Timespec::try_from(deadline.saturating_duration_since(Instant::now())).ok();
        match poll(&mut [PollFd::new(file, PollFlags::IN)], left.as_ref()) {
            Ok(0) => return Err(refused(ErrorKind::TimedOut, "this pipe delivered nothing for a second".to_owned())),
            Err(rustix::io::Errno::INTR) => {}
            // If polling fails, reading reports the reason.
            _ => return Ok(()),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
