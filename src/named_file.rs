//! Files that a person names, read within bounds of kind, size and time.
//!
//! A name on the command line, in the environment or in a scene may lead anywhere: to a device that never ends, to a pipe
//! that nothing is written to, to more bytes than there is memory. [`read`] is the one way to the bytes behind a name.
//! Standard input is not named: it is read as it comes, up to a size, by the command line.

use crate::progress::{Progress, Watcher, Work};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;
use std::fmt;
use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::time::{Duration, Instant};

/// What may stand behind a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accepted {
    /// Plain files: for names that a file gives, which may come from a stranger.
    Files,
    /// Plain files, pipes (`<(...)` of a shell is one) and `/dev/null`: for names that the user gives.
    FilesAndPipes,
}

/// The longest time that a pipe may deliver nothing. A program that writes into `<(...)` has started by then; and a view
/// that waits for longer looks as if it hung.
const PATIENCE: Duration = Duration::from_secs(1);

/// From one report to the watcher to the next: 1 MiB, which a disk delivers in about a millisecond.
const STRIDE: u64 = 1 << 20;

/// Returns all bytes of the file at `path`, at most `most` of them, which may depend on how they begin.
///
/// The watcher is told how many bytes have been read; it is not told that the file is needed. If it has gone, reading ends
/// with [`ErrorKind::Interrupted`]. A pipe is waited for at most a second at a time. Memory grows with the bytes that are
/// there, not with the size that is claimed for them.
///
/// # Errors
/// Whatever the system says, and what is not accepted: other kinds of files, a pipe that delivers nothing for a second
/// ([`ErrorKind::TimedOut`]), more than `most` bytes ([`ErrorKind::FileTooLarge`]). [`reason`] puts it into words.
pub fn read(
    path: &Path,
    accepted: Accepted,
    most: impl Fn(&[u8]) -> usize,
    watcher: &Watcher<'_>,
) -> io::Result<Vec<u8>> {
    let (mut file, size) = open(path, accepted)?;
    let name = path.to_string_lossy();
    let mut bytes = Vec::new();
    loop {
        let work = Work::Reading(name.clone().into_owned());
        if watcher.tell(Progress { work, done: bytes.len(), total: size }).is_err() {
            return Err(ErrorKind::Interrupted.into());
        }
        if read_on(&mut file, &mut bytes)? {
            return Ok(bytes);
        }
        // Checked before the size is reserved: files without contents claim up to 2^63 bytes.
        let most = most(&bytes);
        if bytes.len().max(size) > most {
            return Err(too_large(most));
        }
        bytes.try_reserve_exact((size + 1).saturating_sub(bytes.len()))?;
    }
}

/// The open file, and its size as far as that is known: a pipe has none, and a file may grow.
fn open(path: &Path, accepted: Accepted) -> io::Result<(File, usize)> {
    // Looked at before it is opened, because opening a device can do something to it; and once more after that, because
    // something else may have taken the name.
    check(&path.metadata()?, accepted)?;
    // Opening a FIFO waits for its writer otherwise.
    let flags = OFlags::NONBLOCK | OFlags::NOCTTY;
    let file = OpenOptions::new().read(true).custom_flags(flags.bits().cast_signed()).open(path)?;
    let data = file.metadata()?;
    check(&data, accepted)?;
    Ok((file, data.len() as usize)) // 64 bits on all that termtrace runs on
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

/// Whether this is `/dev/null`, under any name.
fn is_null(data: &Metadata) -> bool {
    let is_same = |null: Metadata| data.file_type().is_char_device() && data.rdev() == null.rdev();
    Path::new("/dev/null").metadata().is_ok_and(is_same)
}

/// Reads the next bytes, up to [`STRIDE`], and returns whether these were all.
fn read_on(file: &mut File, bytes: &mut Vec<u8>) -> io::Result<bool> {
    wait(file)?;
    match file.take(STRIDE).read_to_end(bytes) {
        Ok(count) => Ok(count == 0),
        // What the pipe has held so far is in `bytes`.
        Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(false),
        Err(error) => Err(error),
    }
}

/// Waits until there is something to read, or an end. There always is in a plain file.
fn wait(file: &File) -> io::Result<()> {
    let deadline = Instant::now() + PATIENCE;
    loop {
        let left = Timespec::try_from(deadline.saturating_duration_since(Instant::now())).ok();
        match poll(&mut [PollFd::new(file, PollFlags::IN)], left.as_ref()) {
            Ok(0) => return Err(refused(ErrorKind::TimedOut, "this pipe delivered nothing for a second".to_owned())),
            Err(rustix::io::Errno::INTR) => {}
            // Where it cannot be waited for, reading says why.
            _ => return Ok(()),
        }
    }
}

fn too_large(most: usize) -> io::Error {
    let size = match most {
        _ if most.is_multiple_of(1 << 30) => format!("{} GiB", most >> 30),
        _ if most.is_multiple_of(1 << 20) => format!("{} MiB", most >> 20),
        _ if most.is_multiple_of(1 << 10) => format!("{} KiB", most >> 10),
        _ => format!("{most} bytes"),
    };
    refused(ErrorKind::FileTooLarge, format!("the file is larger than {size}, too large to be read"))
}

/// An error whose words are our own.
fn refused(kind: ErrorKind, message: String) -> io::Error {
    io::Error::new(kind, Refusal(message))
}

#[derive(Debug)]
struct Refusal(String);

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

/// Why a file could not be read: the words that follow its name and a colon in a message.
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        _ if error.get_ref().and_then(|inner| inner.downcast_ref::<Refusal>()).is_some() => error.to_string(),
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::IsADirectory => "this is a directory, not a file".to_owned(),
        ErrorKind::PermissionDenied => "no permission to read this file".to_owned(),
        _ => format!("cannot be read: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nix::sys::stat::Mode;
    use nix::unistd::mkfifo;
    use std::fs;
    use std::io::Write;
    use std::ops::ControlFlow;
    use std::os::unix::net::UnixListener;
    use std::path::PathBuf;

    fn read_up_to(most: usize, path: &Path, accepted: Accepted) -> Result<Vec<u8>, String> {
        read(path, accepted, |_| most, &Watcher::patient()).map_err(|error| reason(&error))
    }

    fn fifo(folder: &Path) -> PathBuf {
        let path = folder.join("fifo");
        mkfifo(&path, Mode::S_IRWXU).expect("a pipe can be made");
        path
    }

    #[test]
    fn only_what_is_accepted_is_read() {
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

    #[test]
    fn as_many_bytes_as_allowed_are_read_and_no_more() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join("file");
        let size = 3 << 20;
        fs::write(&path, vec![7; size]).expect("written");
        let too_large = |size: &str| Err(format!("the file is larger than {size}, too large to be read"));
        assert_eq!(read_up_to(size, &path, Accepted::Files).map(|bytes| bytes.len()), Ok(size));
        assert_eq!(read_up_to(size - 1, &path, Accepted::Files), too_large("3145727 bytes"));
        assert_eq!(read_up_to(2 << 20, &path, Accepted::Files), too_large("2 MiB"));
        // What the first bytes are says how many there may be.
        let most = |bytes: &[u8]| if bytes.starts_with(&[7]) { 64 << 10 } else { usize::MAX };
        let error = read(&path, Accepted::Files, most, &Watcher::patient()).expect_err("too large");
        assert_eq!(Err(reason(&error)), too_large("64 KiB"));
        // Its size alone is enough.
        File::create(&path).and_then(|file| file.set_len(1 << 42)).expect("a sparse file can be made");
        assert_eq!(read_up_to(1 << 30, &path, Accepted::Files), too_large("1 GiB"));
    }

    /// The writer waits until its last bytes have been taken: the reader has found the pipe empty then, or is about to.
    #[test]
    fn a_pipe_is_read_to_its_end_however_slowly_it_comes() {
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
    fn a_pipe_without_end_is_given_up() {
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

    /// Between two waits the watcher is asked.
    #[test]
    fn reading_ends_when_the_watcher_has_gone() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join("file");
        fs::write(&path, vec![7; 3 << 20]).expect("written");
        let hear = |progress: Progress| {
            if progress.done < 2 << 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let error = read(&path, Accepted::Files, |_| usize::MAX, &Watcher::new(&hear)).expect_err("given up");
        assert_eq!(error.kind(), ErrorKind::Interrupted);
    }
}
