//! The screen's side of the terminal: bytes go out as fast as it takes them, and nothing here waits for ever.

use rustix::event::{PollFd, PollFlags, poll};
use rustix::fd::AsFd;
use rustix::fs::OFlags;
use rustix::termios;
use std::ffi::OsStr;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::OpenOptionsExt;
use std::time::{Duration, Instant};

/// Bytes on their way to the screen.
pub(super) struct Output {
    file: File,
    /// What the terminal has not taken yet.
    pending: Vec<u8>,
}

impl Output {
    /// The terminal of standard output.
    pub(super) fn open() -> io::Result<Self> {
        let shared = File::from(io::stdout().as_fd().try_clone_to_owned()?);
        let file = opened_again(&shared).unwrap_or(shared);
        Ok(Self { file, pending: Vec::new() })
    }

    /// What to ask for the window's size, and to poll.
    pub(super) fn file(&self) -> &File {
        &self.file
    }

    /// Whether the terminal has not taken all bytes yet.
    pub(super) fn is_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    /// Sends bytes after those before: in one write where the terminal takes them whole.
    pub(super) fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.pending.extend_from_slice(bytes);
        self.push()
    }

    /// Sends as much of what is pending as the terminal takes.
    pub(super) fn push(&mut self) -> io::Result<()> {
        while self.is_pending() {
            match self.file.write(&self.pending) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(taken) => drop(self.pending.drain(..taken)),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(()),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Waits until the terminal has taken everything, at most until the deadline. Whether it has.
    pub(super) fn finish(&mut self, deadline: Instant) -> bool {
        while self.push().is_ok() {
            let left = deadline.saturating_duration_since(Instant::now());
            if !self.is_pending() || left.is_zero() {
                break;
            }
            let mut fds = [PollFd::new(&self.file, PollFlags::OUT)];
            let _ = poll(&mut fds, Some(&timespec(left)));
        }
        !self.is_pending()
    }
}

/// The terminal by its name, without blocking. Opened anew it has flags of its own; `O_NONBLOCK` on the shell's would
/// stay there when we are gone. Where it cannot be opened (after `su`, it may belong to somebody else) the shell's must
/// do, and a terminal that has stopped reading stops us too.
fn opened_again(terminal: &File) -> Option<File> {
    let name = termios::ttyname(terminal, Vec::new()).ok()?;
    let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits().try_into().ok()?;
    OpenOptions::new().write(true).custom_flags(flags).open(OsStr::from_bytes(name.as_bytes())).ok()
}

pub(super) fn timespec(duration: Duration) -> rustix::event::Timespec {
    rustix::event::Timespec {
        tv_sec: i64::try_from(duration.as_secs()).unwrap_or(i64::MAX),
        tv_nsec: duration.subsec_nanos().into(),
    }
}
