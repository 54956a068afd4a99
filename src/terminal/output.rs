//! Output to the terminal, which never blocks for longer than a given time.

use super::fault_injection;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::fd::AsFd;
use rustix::fs::OFlags;
use rustix::{process, termios};
use std::ffi::OsStr;
use std::fs::{File, OpenOptions};
use std::io::{self, IsTerminal, Write};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::OpenOptionsExt;
use std::time::{Duration, Instant};

/// The terminal's output and the bytes that wait to be written.
pub(super) struct Output {
    file: File,
    /// Whether the open file description is shared with the shell, so that a write may block.
    shared: bool,
    /// Bytes to write, of which the first `written` are written already.
    pending: Vec<u8>,
    written: usize,
}

/// Greatest number of bytes in one write to a shared file, which is in blocking mode.
// If `poll` reports a terminal as writable, it accepts this much without blocking: Linux accounts for the buffer of a
// pseudo-terminal in blocks of 256 bytes. A larger write may block in the middle, with signals and keys unhandled.
const MAX_SHARED_WRITE: usize = 256;

impl Output {
    /// Opens the terminal of standard output.
    pub(super) fn open() -> io::Result<Self> {
        let shared = File::from(io::stdout().as_fd().try_clone_to_owned()?);
        Ok(match reopen_non_blocking(&shared) {
            Some(own) => Self::new(own, false),
            None => Self::new(shared, true),
        })
    }

    fn new(file: File, shared: bool) -> Self {
        Self { file, shared, pending: Vec::new(), written: 0 }
    }

    /// Returns the file, to poll it and to ask for the window's size.
    pub(super) fn file(&self) -> &File {
        &self.file
    }

    /// Returns whether bytes wait to be written.
    pub(super) fn is_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    /// Appends bytes and writes them, in a single call if the terminal accepts all.
    pub(super) fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.append(bytes);
        self.write_pending()
    }

    /// Appends bytes without writing them.
    pub(super) fn append(&mut self, bytes: &[u8]) {
        self.pending.extend_from_slice(bytes);
    }

    /// Writes pending bytes until the terminal accepts no more.
    pub(super) fn write_pending(&mut self) -> io::Result<()> {
        while self.is_pending() {
            match self.write() {
                // A write of no bytes is an error, because trying again might loop for ever.
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(count) => self.record_written(count),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                    return fault_injection::report_phase("frame");
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn write(&mut self) -> io::Result<usize> {
        let mut bytes = &self.pending[self.written..];
        if self.shared {
            if !is_writable(&self.file, Duration::ZERO) {
                return Err(io::ErrorKind::WouldBlock.into());
            }
            bytes = &bytes[..bytes.len().min(MAX_SHARED_WRITE)];
        }
        self.file.write(bytes)
    }

    fn record_written(&mut self, count: usize) {
        self.written += count;
        if self.written == self.pending.len() {
            self.pending.clear();
            self.written = 0;
        }
    }

    /// Drops the pending part of a frame: text and the sequences that position and colour it.
    ///
    /// Pending mode switches and queries are kept.
    pub(super) fn drop_frame(&mut self) {
        let boundary = next_boundary(&self.pending, self.written);
        let rest = self.pending.split_off(boundary);
        self.pending.extend(escape_sequences(&rest).filter(|sequence| !belongs_to_frame(sequence)).flatten());
        self.record_written(0);
    }

    /// Writes all pending bytes until the deadline, and returns whether the terminal accepts more,
    /// so that the next print does not block.
    ///
    /// (A terminal that has stopped reading may have had room for exactly these bytes.)
    pub(super) fn drain(&mut self, deadline: Instant) -> bool {
        while self.write_pending().is_ok() && self.is_pending() {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            is_writable(&self.file, left);
        }
        !self.is_pending() && is_writable(&self.file, deadline.saturating_duration_since(Instant::now()))
    }
}

/// Returns the first index at or after `index` that lies inside neither an escape sequence nor a
/// UTF-8 character.
fn next_boundary(bytes: &[u8], index: usize) -> usize {
    let start = bytes[..index].iter().rposition(|&byte| byte == ESCAPE).unwrap_or(index);
    let end = index.max(start + sequence_len(&bytes[start..]).unwrap_or(0));
    let is_continuation = |byte: &&u8| **byte & 0xc0 == 0x80;
    end + bytes[end..].iter().take_while(is_continuation).count()
}

/// Returns the escape sequences in `bytes`, whose start must not lie inside a sequence.
fn escape_sequences(mut bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    std::iter::from_fn(move || {
        let start = bytes.iter().position(|&byte| byte == ESCAPE)?;
        let (sequence, rest) = bytes[start..].split_at(sequence_len(&bytes[start..])?);
        bytes = rest;
        Some(sequence)
    })
}

const ESCAPE: u8 = 0x1b;

/// Returns the length of the escape sequence at the start of `bytes`, or `None` if none starts
/// there or it is incomplete.
///
/// Knows the forms that the program sends: CSI sequences with their final byte, OSC strings that end with ST, and
/// two-byte sequences.
fn sequence_len(bytes: &[u8]) -> Option<usize> {
    match bytes {
        [ESCAPE, b'[', rest @ ..] => Some(3 + rest.iter().position(|byte| (0x40..=0x7e).contains(byte))?),
        [ESCAPE, b']', rest @ ..] => Some(4 + rest.windows(2).position(|end| end == b"\x1b\\")?),
        [ESCAPE, _, ..] => Some(2),
        _ => None,
    }
}

/// Returns whether a sequence belongs to a frame: it moves the cursor, sets colours or erases.
fn belongs_to_frame(sequence: &[u8]) -> bool {
    let [ESCAPE, b'[', parameters @ .., end] = sequence else { return false };
    // Private sequences, such as modes and the keyboard protocol, have a marker (`?`, `>`, ...) before their
    // parameters.
    let is_plain = parameters.iter().all(|byte| matches!(byte, b'0'..=b'9' | b';' | b':'));
    is_plain && matches!(end, b'm' | b'H' | b'G' | b'A'..=b'D' | b'J')
}

/// Waits for at most `timeout` and returns whether the terminal accepts bytes or has hung up.
fn is_writable(file: &impl AsFd, timeout: Duration) -> bool {
    let deadline = Instant::now() + timeout;
    loop {
        let left = deadline.saturating_duration_since(Instant::now());
        match poll(&mut [PollFd::new(file, PollFlags::OUT)], Some(&timespec(left))) {
            // A signal does not end the wait. While a window is resized there is a SIGWINCH every few milliseconds; if
            // one ended the wait, the terminal would seem blocked, and the error message would be lost.
            Err(rustix::io::Errno::INTR) => {}
            ready => return ready.is_ok_and(|ready| ready > 0),
        }
    }
}

/// Returns whether a message can be written to standard error without blocking.
///
/// That is so if standard error is not a terminal, or if the terminal accepts bytes within 250 ms. A terminal that has
/// stopped reading would keep the program from ending.
pub fn stderr_accepts_message() -> bool {
    let stderr = io::stderr();
    !stderr.is_terminal() || is_writable(&stderr, Duration::from_millis(250))
}

/// Opens the terminal a second time, in non-blocking mode; `None` if that fails.
///
/// `O_NONBLOCK` on the open file description shared with the shell would outlive the program. Opening by name fails if
/// the device belongs to another user (after `su`); `/dev/tty` then works if it is the terminal of this session.
fn reopen_non_blocking(terminal: &File) -> Option<File> {
    let open = |name: &[u8]| {
        // Without NOCTTY, the opened terminal might become the controlling terminal of a session that has none.
        let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits().try_into().ok()?;
        OpenOptions::new().write(true).custom_flags(flags).open(OsStr::from_bytes(name)).ok()
    };
    let by_name = || open(termios::ttyname(terminal, Vec::new()).ok()?.as_bytes());
    let is_ours = || termios::tcgetsid(terminal).ok() == process::getsid(None).ok();
    by_name().or_else(|| is_ours().then(|| open(b"/dev/tty"))?)
}

pub(super) fn timespec(duration: Duration) -> rustix::event::Timespec {
    rustix::event::Timespec {
        tv_sec: i64::try_from(duration.as_secs()).unwrap_or(i64::MAX),
        tv_nsec: duration.subsec_nanos().into(),
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
