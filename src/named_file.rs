//! Reading of files that the user names, within limits on kind, size and time.
//!
//! A name on the command line, in the environment or in a scene may refer to anything: an endless device, a pipe
//! without a writer, more bytes than there is memory. [`read`] is the only way to the bytes behind a name. Standard
//! input has no name: the command line reads it, up to a size.

use crate::progress::{Progress, Reporter, Work};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

#[cfg(not(feature = "live"))]
mod plain;
#[cfg(feature = "live")]
mod posix;
mod refusal;

#[cfg(not(feature = "live"))]
use plain::{open, wait_until_readable};
#[cfg(feature = "live")]
use posix::{open, wait_until_readable};
pub use refusal::reason;
use refusal::refused;

/// The kinds of files that a read accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accepted {
    /// Plain files: for names given in a scene file, which may come from a stranger.
    Files,
    /// Plain files, pipes (`<(...)` in a shell) and `/dev/null`: for names given by the user.
    FilesAndPipes,
}

/// Number of bytes between two progress reports: 1 MiB.
// A disk delivers them in about a millisecond: short enough for a cancel, long enough that reports cost nothing.
const CHUNK_LEN: u64 = 1 << 20;

/// Returns all bytes of the file at `path`, at most `max_len(bytes so far)`.
///
/// The limit may depend on the file's first bytes, which tell its format. The number of bytes read is
/// reported; after a cancel reading ends with [`ErrorKind::Interrupted`]. A pipe that
/// delivers at least a byte a second is read to its end, as `cat` does: its size is limited, its time is not, because
/// the user sees how far it is and can press Ctrl-C.
///
/// # Errors
/// The system's error; another kind of file than accepted; a pipe that delivers nothing for a second
/// ([`ErrorKind::TimedOut`]); or too many bytes ([`ErrorKind::FileTooLarge`]). [`reason`] puts it into words.
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
    // Before these limits `/dev/zero` as a golden frame took 4 GB, and a pipe without a writer blocked for ever.
    loop {
        let work = Work::Reading(name.clone().into_owned());
        if reporter.report(Progress { work, done: bytes.len(), total: size }).is_err() {
            return Err(ErrorKind::Interrupted.into());
        }
        if read_chunk(&mut file, &mut bytes)? {
            return Ok(bytes);
        }
        // Checked before memory is reserved: virtual files claim up to 2^63 bytes.
        let max_len = max_len(&bytes);
        if bytes.len().max(size) > max_len {
            return Err(too_large(max_len));
        }
        bytes.try_reserve_exact((size + 1).saturating_sub(bytes.len()))?;
    }
}

/// Reads the next bytes, at most [`CHUNK_LEN`], and returns whether the file ended.
fn read_chunk(file: &mut File, bytes: &mut Vec<u8>) -> io::Result<bool> {
    wait_until_readable(file)?;
    match file.take(CHUNK_LEN).read_to_end(bytes) {
        Ok(count) => Ok(count == 0),
        // `bytes` holds what the pipe has delivered so far.
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
    refused(ErrorKind::FileTooLarge, format!("the file is larger than {size}, too large to be read"))
}

#[cfg(all(test, unit_tests))]
mod tests;
