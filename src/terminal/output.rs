//! The screen's side of the terminal: bytes go out as fast as it takes them, and nothing here waits for ever.

use super::rehearsal;
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

/// Bytes on their way to the screen.
pub(super) struct Output {
    file: File,
    /// The file is the shell's too, and may block.
    shared: bool,
    /// What the terminal has not taken yet, from `taken` on.
    pending: Vec<u8>,
    taken: usize,
}

/// So much is written at once where writing may block. A terminal that says it has room has room for this: Linux counts
/// the room of a pseudo-terminal in blocks of 256 bytes.
const ROOM: usize = 256;

impl Output {
    /// The terminal of standard output.
    pub(super) fn open() -> io::Result<Self> {
        let shared = File::from(io::stdout().as_fd().try_clone_to_owned()?);
        Ok(match opened_again(&shared) {
            Some(own) => Self::of(own, false),
            None => Self::of(shared, true),
        })
    }

    fn of(file: File, shared: bool) -> Self {
        Self { file, shared, pending: Vec::new(), taken: 0 }
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
        self.put(bytes);
        self.push()
    }

    /// Adds to what is pending.
    pub(super) fn put(&mut self, bytes: &[u8]) {
        self.pending.extend_from_slice(bytes);
    }

    /// Sends as much of what is pending as the terminal takes.
    pub(super) fn push(&mut self) -> io::Result<()> {
        while self.is_pending() {
            match self.write() {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(count) => self.count(count),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return rehearsal::reach("frame"),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn write(&mut self) -> io::Result<usize> {
        let mut bytes = &self.pending[self.taken..];
        if self.shared {
            if !has_room(&self.file, Duration::ZERO) {
                return Err(io::ErrorKind::WouldBlock.into());
            }
            bytes = &bytes[..bytes.len().min(ROOM)];
        }
        self.file.write(bytes)
    }

    fn count(&mut self, taken: usize) {
        self.taken += taken;
        if self.taken == self.pending.len() {
            self.pending.clear();
            self.taken = 0;
        }
    }

    /// Drops what the terminal has not taken of pictures, so that it need not be waited for: all that is printed, and the
    /// sequences that place and colour it. What turns modes on or off and what asks for a reply stays.
    pub(super) fn drop_picture(&mut self) {
        let boundary = boundary(&self.pending, self.taken);
        let rest = self.pending.split_off(boundary);
        self.pending.extend(sequences(&rest).filter(|sequence| !paints(sequence)).flatten());
        self.count(0);
    }

    /// Waits until the terminal has taken everything and takes more, at most until the deadline. Whether it does: what is
    /// printed next then blocks nobody. (One that has stopped reading may still have had room for the last bytes.)
    pub(super) fn finish(&mut self, deadline: Instant) -> bool {
        while self.push().is_ok() && self.is_pending() {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            has_room(&self.file, left);
        }
        !self.is_pending() && has_room(&self.file, deadline.saturating_duration_since(Instant::now()))
    }
}

/// Where the sequence or the character ends that has begun before that place.
fn boundary(bytes: &[u8], place: usize) -> usize {
    let start = bytes[..place].iter().rposition(|&byte| byte == ESCAPE).unwrap_or(place);
    let end = place.max(start + sequence_len(&bytes[start..]).unwrap_or(0));
    let is_inside = |byte: &&u8| **byte & 0xc0 == 0x80;
    end + bytes[end..].iter().take_while(is_inside).count()
}

/// The escape sequences of bytes that begin outside of one.
fn sequences(mut bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    std::iter::from_fn(move || {
        let start = bytes.iter().position(|&byte| byte == ESCAPE)?;
        let (sequence, rest) = bytes[start..].split_at(sequence_len(&bytes[start..])?);
        bytes = rest;
        Some(sequence)
    })
}

const ESCAPE: u8 = 0x1b;

/// How long the escape sequence is that bytes begin with: of those that are sent, a control sequence ends with a letter, and
/// a string with ST. `None`: there is none, or no end of it.
fn sequence_len(bytes: &[u8]) -> Option<usize> {
    match bytes {
        [ESCAPE, b'[', rest @ ..] => Some(3 + rest.iter().position(|byte| (0x40..=0x7e).contains(byte))?),
        [ESCAPE, b']', rest @ ..] => Some(4 + rest.windows(2).position(|end| end == b"\x1b\\")?),
        [ESCAPE, _, ..] => Some(2),
        _ => None,
    }
}

/// Whether it only says where and in which colour something is printed.
fn paints(sequence: &[u8]) -> bool {
    let [ESCAPE, b'[', parameters @ .., end] = sequence else { return false };
    // Modes and what concerns the keyboard have a mark before their parameters.
    let is_plain = parameters.iter().all(|byte| matches!(byte, b'0'..=b'9' | b';' | b':'));
    is_plain && matches!(end, b'm' | b'H' | b'G' | b'A'..=b'D' | b'J')
}

/// Waits until the terminal takes bytes, or is gone, at most so long. Whether it does, or is.
fn has_room(file: &impl AsFd, patience: Duration) -> bool {
    let mut fds = [PollFd::new(file, PollFlags::OUT)];
    poll(&mut fds, Some(&timespec(patience))).is_ok_and(|ready| ready > 0)
}

/// Whether words to standard error are read, or can wait: a terminal that has stopped reading would stop us too. It gets
/// a moment.
pub fn stderr_is_read() -> bool {
    let stderr = io::stderr();
    !stderr.is_terminal() || has_room(&stderr, Duration::from_millis(250))
}

/// The terminal without blocking. Opened anew it has flags of its own; `O_NONBLOCK` on the shell's would stay there when
/// we are gone. By its name it cannot be opened where it belongs to somebody else (after `su`); as the session's own
/// terminal it can.
fn opened_again(terminal: &File) -> Option<File> {
    let open = |name: &[u8]| {
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;
    use std::sync::mpsc::channel;
    use std::thread;

    /// From whatever place on a picture is dropped: what was sent ends between two sequences and between two characters, and
    /// modes, strings and queries are all sent, in their order.
    #[test]
    fn a_picture_is_dropped_between_its_sequences() {
        let picture = "\x1b[?2026h\x1b[2;3H\x1b[38;2;1;2;3m▄é\x1b[58:2::1:2:3mx\x1b[C\x1b[m\x1b[2J\x1b[?2026l\x1b[c";
        let (before, after) = ("\x1b[?1049h\x1b[>15u\x1b[?u", "\x1b]52;c;YQ==\x1b\\");
        let sent = [before, picture, after].concat();
        let kept = ["\x1b[?1049h", "\x1b[>15u", "\x1b[?u", "\x1b[?2026h", "\x1b[?2026l", "\x1b[c", after];
        for taken in 0..=sent.len() {
            let null = File::options().write(true).open("/dev/null").expect("there is always /dev/null");
            let mut output = Output { pending: sent.clone().into_bytes(), taken, ..Output::of(null, false) };
            output.drop_picture();
            let shown = if output.pending.is_empty() { sent.clone() } else { string(&output.pending) };
            let mut rest = &*shown;
            for sequence in kept {
                let at = rest.find(sequence).unwrap_or_else(|| panic!("{taken}: {sequence:?} in {shown:?}"));
                rest = &rest[at + sequence.len()..];
            }
            let (begun, rest) = shown.split_at(boundary(sent.as_bytes(), taken).min(shown.len()));
            assert!(sent.starts_with(begun) && !rest.contains(['▄', 'é', 'x', 'm', 'H', 'C']), "{taken}: {rest:?}");
        }
    }

    fn string(bytes: &[u8]) -> String {
        String::from_utf8(bytes.to_vec()).expect("no character is cut")
    }

    /// Where the terminal can only be had as the shell has it, blocking, a frame that it does not take stops nobody.
    #[test]
    fn a_terminal_that_blocks_is_not_waited_for() {
        let (mut master, slave) = pty_process::blocking::open().expect("a pseudo-terminal can be had");
        let slave = slave.as_fd().try_clone_to_owned().expect("a file descriptor can be doubled");
        let frame: Vec<u8> = (b'a'..=b'z').cycle().take(300_000).collect();
        let sent = frame.clone();
        let (done, wait) = channel();
        thread::spawn(move || {
            let mut output = Output::of(File::from(slave), true);
            output.send(&frame).expect("the terminal is there");
            let _ = done.send(output.is_pending());
            let finished = output.finish(Instant::now() + Duration::from_secs(10));
            let _ = done.send(finished);
        });
        let soon = Duration::from_secs(10);
        assert_eq!(wait.recv_timeout(soon), Ok(true), "nobody reads: something is left");
        let mut read = vec![0; sent.len()];
        master.read_exact(&mut read).expect("all of it comes");
        assert_eq!(wait.recv_timeout(soon), Ok(true), "all is sent");
        assert!(read == sent, "in order");
    }
}
