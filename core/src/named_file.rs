//! Reading of files that the user names, within limits on kind, size and time.
//!
//! A name on the command line, in the environment or in a scene may refer to anything: an endless device, a pipe
//! without a writer, a file larger than memory. All such files are read by [`read`]. Standard input has no name, and is
//! read by the command line, up to a size.

use crate::progress::{Progress, Reporter, Work};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

#[cfg(not(feature = "posix"))]
mod plain;
#[cfg(feature = "posix")]
mod posix;
mod refusal;

#[cfg(not(feature = "posix"))]
use plain::{open, wait_until_readable};
#[cfg(feature = "posix")]
use posix::{open, wait_until_readable};
pub use refusal::reason;
use refusal::refusal_error;

/// The kinds of files that [`read`] accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accepted {
    /// Plain files: for names in a scene file, which may come from an untrusted source.
    Files,
    /// Plain files, pipes (`<(...)` in a shell) and `/dev/null`: for names given by the user.
    FilesAndPipes,
}

/// Number of bytes between two progress reports: 1 MiB.
// A disk delivers 1 MiB in about a millisecond, so that a cancel takes effect quickly and reports cost little.
const CHUNK_LEN: u64 = 1 << 20;

/// Returns all bytes of the file at `path`, at most `max_len(bytes so far)`.
///
/// The limit may depend on the file's first bytes, which show its format. Progress is reported; if the reporter
/// cancels, reading ends with [`ErrorKind::Interrupted`]. A pipe that delivers at least a byte a second is read to its
/// end: only its size is limited, not its time, because the user sees the progress and can press Ctrl-C.
///
/// # Errors
/// If the system reports an error, the kind of file is not accepted, a pipe delivers nothing for a second
/// ([`ErrorKind::TimedOut`]), or the file is too large ([`ErrorKind::FileTooLarge`]). [`reason`] returns the message.
pub fn read(
    path: &Path,
    accepted: Accepted,
    max_len: impl Fn(&[u8]) -> usize,
    reporter: &Reporter<'_>,
) -> io::Result<Vec<u8>> {
    let (mut file, size) = open(path, accepted)?;
    let size = usize::try_from(size).unwrap_or(usize::MAX);
    let name = path.to_string_lossy();
    let mut bytes = Vec::new();
    // Without the limits below, `/dev/zero` as a golden frame took 4 GB, and a pipe without a writer blocked for ever.
    loop {
        let work = Work::Reading(name.clone().into_owned());
        if reporter.report(Progress { work, done: bytes.len(), total: size }).is_err() {
            return Err(ErrorKind::Interrupted.into());
        }
        if read_and_check_end(&mut file, &mut bytes)? {
            return Ok(bytes);
        }
        // The size is checked before memory is reserved for it, because virtual files claim up to 2^63 bytes.
        let max_len = max_len(&bytes);
        if bytes.len().max(size) > max_len {
            return Err(too_large(max_len));
        }
        // With room for a byte more than the file has, its end is found without growing the buffer.
        bytes.try_reserve_exact((size + 1).saturating_sub(bytes.len()))?;
    }
}

/// Reads the next bytes, at most [`CHUNK_LEN`], and returns whether the file ended.
fn read_and_check_end(file: &mut File, bytes: &mut Vec<u8>) -> io::Result<bool> {
    wait_until_readable(file)?;
    match file.take(CHUNK_LEN).read_to_end(bytes) {
        Ok(count) => Ok(count == 0),
        // The pipe is empty for now, but not closed. `read_to_end` has left in `bytes` what it has read.
        Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(false),
        Err(error) => Err(error),
    }
}

fn too_large(max_len: usize) -> io::Error {
    let size = match max_len {
        _ if max_len.is_multiple_of(1 << 30) => format!("{} GiB", max_len >> 30),
        _ if max_len.is_multiple_of(1 << 20) => format!("{} MiB", max_len >> 20),
        _ if max_len.is_multiple_of(1 << 10) => format!("{} KiB", max_len >> 10),
        _ => format!("{max_len} bytes"),
    };
    refusal_error(ErrorKind::FileTooLarge, format!("the file is larger than {size}, too large to be read"))
}

#[cfg(all(test, unit_tests))]
mod tests;
