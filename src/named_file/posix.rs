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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::named_file::{read, reason};
    use crate::progress::Reporter;
    use nix::sys::stat::Mode;
    use nix::unistd::mkfifo;
    use std::fs;
    use std::io::Write;
    use std::os::unix::net::UnixListener;
    use std::path::PathBuf;

    fn read_up_to(most: usize, path: &Path, accepted: Accepted) -> Result<Vec<u8>, String> {
        read(path, accepted, |_| most, &Reporter::silent()).map_err(|error| reason(&error))
    }

    fn fifo(folder: &Path) -> PathBuf {
        let path = folder.join("fifo");
        mkfifo(&path, Mode::S_IRWXU).expect("a pipe can be made");
        path
    }

    #[test]
    fn only_accepted_kinds_of_files_are_read() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let (file, socket) = (folder.path().join("file"), folder.path().join("socket"));
        fs::write(&file, "hello").expect("written");
        let _listener = UnixListener::bind(&socket).expect("a socket can be made");
        let fifo = fifo(folder.path());
        let [zero, null] = ["/dev/zero", "/dev/null"].map(Path::new);
        let refusal = |what: &str| Err(what.to_owned());
        for (path, for_user, for_file) in [
            (&*file, Ok(b"hello".to_vec()), Ok(b"hello".to_vec())),
            (null, Ok(Vec::new()), refusal("this is a device, not a plain file")),
            (zero, refusal("this is a device, not a file or a pipe"), refusal("this is a device, not a plain file")),
            (&socket, refusal("this is a socket, not a file or a pipe"), refusal("this is a socket, not a plain file")),
            (&fifo, refusal("this pipe delivered nothing for a second"), refusal("this is a pipe, not a plain file")),
            (folder.path(), refusal("this is a directory, not a file"), refusal("this is a directory, not a file")),
        ] {
            assert_eq!(read_up_to(9, path, Accepted::FilesAndPipes), for_user, "{}", path.display());
            assert_eq!(read_up_to(9, path, Accepted::Files), for_file, "{}", path.display());
        }
    }

    /// The writer yields after each part, so that the reader finds the pipe empty, or is about to.
    #[test]
    fn a_slow_pipe_is_read_to_its_end() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = fifo(folder.path());
        let parts: Vec<_> = (0..40).map(|part| vec![part; 100_000]).collect();
        let (whole, writer) = (parts.concat(), path.clone());
        let writing = std::thread::spawn(move || {
            let mut pipe = OpenOptions::new().write(true).open(writer).expect("the reader opens it");
            for part in parts {
                pipe.write_all(&part).expect("the reader reads on");
                std::thread::yield_now();
            }
        });
        assert!(read_up_to(4_000_000, &path, Accepted::FilesAndPipes) == Ok(whole), "all that was written");
        writing.join().expect("all was written");
    }

    #[test]
    fn a_pipe_without_end_is_refused_at_the_limit() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = fifo(folder.path());
        let writer = path.clone();
        let writing = std::thread::spawn(move || {
            let mut pipe = OpenOptions::new().write(true).open(writer).expect("the reader opens it");
            while pipe.write_all(&[0; 4096]).is_ok() {}
        });
        let too_large = "the file is larger than 2 MiB, too large to be read";
        assert_eq!(read_up_to(2 << 20, &path, Accepted::FilesAndPipes), Err(too_large.to_owned()));
        writing.join().expect("the pipe has closed");
    }
}
