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

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::ops::ControlFlow;

    fn read_up_to(max_len: usize, path: &Path, accepted: Accepted) -> Result<Vec<u8>, String> {
        read(path, accepted, |_| max_len, &Reporter::silent()).map_err(|error| reason(&error))
    }

    #[test]
    fn no_more_bytes_than_allowed_are_read() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join("file");
        let size = 3 << 20;
        fs::write(&path, vec![7; size]).expect("written");
        let too_large = |size: &str| Err(format!("the file is larger than {size}, too large to be read"));
        assert_eq!(read_up_to(size, &path, Accepted::Files).map(|bytes| bytes.len()), Ok(size));
        assert_eq!(read_up_to(size - 1, &path, Accepted::Files), too_large("3145727 bytes"));
        assert_eq!(read_up_to(2 << 20, &path, Accepted::Files), too_large("2 MiB"));
        // The first bytes determine the limit.
        let max_len = |bytes: &[u8]| if bytes.starts_with(&[7]) { 64 << 10 } else { usize::MAX };
        let error = read(&path, Accepted::Files, max_len, &Reporter::silent()).expect_err("too large");
        assert_eq!(Err(reason(&error)), too_large("64 KiB"));
        // The claimed size alone is enough.
        File::create(&path).and_then(|file| file.set_len(1 << 42)).expect("a sparse file can be made");
        assert_eq!(read_up_to(1 << 30, &path, Accepted::Files), too_large("1 GiB"));
    }

    /// The reporter is called between two chunks.
    #[test]
    fn a_cancelled_read_ends() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join("file");
        fs::write(&path, vec![7; 3 << 20]).expect("written");
        let on_progress = |progress: Progress| {
            if progress.done < 2 << 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let error = read(&path, Accepted::Files, |_| usize::MAX, &Reporter::new(&on_progress)).expect_err("given up");
        assert_eq!(error.kind(), ErrorKind::Interrupted);
    }
}
