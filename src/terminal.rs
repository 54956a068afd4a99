//! The one owner of the terminal: what it turns on it turns off again, in reverse order, whatever happens.
//!
//! The terminal is given back when [`Terminal`] is dropped: on return, on an error, while a panic unwinds. Signals
//! that would end the process end the loop of [`app`](crate::app) instead, and so drop it too; `main` then lets the
//! signal do its work. Before a stop (Ctrl-Z, SIGTSTP) it is given back, and taken again after. Messages of panics are
//! kept until the terminal is back (see [`hold_panic_messages`]), or they would vanish with the alternate screen.
//!
//! `O_NONBLOCK` is never set on what is shared with the shell, which would find it set after us: the screen is opened
//! a second time for that. So a terminal that has stopped reading never keeps us from hearing keys and signals.

use crate::capabilities::{self, CellShape};
use crate::grid::Size;
pub use crate::grid::Window;
use crate::input::Input;
use crate::protocol::{Mode, Receiver};
use base64::Engine;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::fd::{AsFd, BorrowedFd};
use rustix::termios;
use std::fs::File;
use std::io::{self, IsTerminal, Read};
use std::time::Duration;

mod modes;
mod output;
mod panics;
mod rehearsal;
mod replies;
mod signals;

use modes::Modes;
pub use output::stderr_is_read;
use output::{Output, timespec};
pub use panics::{hold_panic_messages, take_panic_messages};
#[cfg(feature = "test-hooks")]
pub use rehearsal::rehearse;
pub(crate) use rehearsal::{reach, reach_beside, rest, take_worker_panic};
pub use signals::{Signals, Stopped, Waker, before_death, die_of, fail_large_writes, without_signals};

/// A terminal in raw mode with the alternate screen, to be read, written and asked for its size.
pub struct Terminal {
    keys: File,
    output: Output,
    modes: Modes,
}

/// What woke [`Terminal::wait`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Woken {
    /// There are bytes from the terminal, or it is gone.
    pub keys: bool,
    /// The wake pipe has something to say.
    pub wake: bool,
}

impl Terminal {
    /// Takes the terminal over: the picture goes to standard output; keys come from standard input, or from the
    /// controlling terminal where standard input is something else. In the background it waits to be in the foreground.
    ///
    /// # Errors
    /// If either is not a terminal, or cannot be set up; it is then as it was.
    pub fn take(signals: &Signals) -> io::Result<Self> {
        let output = Output::open()?;
        let mut terminal = Self { keys: keys_file()?, output, modes: Modes::default() };
        terminal.take_again(signals)?;
        Ok(terminal)
    }

    /// Takes the terminal over after [`give_back`](Self::give_back).
    ///
    /// # Errors
    /// If it cannot be set up; what was done is undone when this is dropped.
    pub fn take_again(&mut self, signals: &Signals) -> io::Result<()> {
        self.modes.turn_on(&self.keys, &mut self.output, signals)
    }

    /// The window's size now.
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn window(&self) -> io::Result<Window> {
        let window = termios::tcgetwinsize(self.output.file())?;
        let (columns, rows) = (window.ws_col, window.ws_row);
        // A terminal that nobody told its size has none.
        let size = if columns == 0 || rows == 0 { Size::new(80, 24) } else { Size::new(columns, rows) };
        let aspect = capabilities::cell_aspect(columns, rows, window.ws_xpixel, window.ws_ypixel);
        let cell = CellShape { aspect, halves_meet: capabilities::halves_meet(rows, window.ws_ypixel) };
        let cell_pixels =
            cell.aspect.and(window.ws_xpixel.checked_div(columns).zip(window.ws_ypixel.checked_div(rows)));
        Ok(Window { size, cell, cell_pixels })
    }

    /// Sends a frame or queries, in one write where the terminal takes them whole. What it does not take at once goes
    /// out while [`wait`](Self::wait) waits. The caller tells its [`Receiver`] of queries among them.
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.output.send(bytes)
    }

    /// Switches a mode on that not every terminal knows, until the terminal is given back. A mode that is on stays on, and
    /// nothing is sent.
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn switch_on(&mut self, mode: Mode) -> io::Result<()> {
        self.modes.switch_on(mode, &mut self.output)
    }

    /// Gives the user's clipboard a text, where the terminal lets programs do that (OSC 52).
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn copy(&mut self, text: &str) -> io::Result<()> {
        let encoded = base64::engine::general_purpose::STANDARD.encode(text);
        self.output.send(format!("\x1b]52;c;{encoded}\x1b\\").as_bytes())
    }

    /// Whether the terminal has not taken the last frame yet.
    pub fn is_sending(&self) -> bool {
        self.output.is_pending()
    }

    /// Gives the terminal back, as dropping it does, and waits for the replies that are outstanding, for as long as it does
    /// for the last bytes to be taken, so that the shell is not sent them. Whether it took all that was sent: one that has
    /// stopped reading is left after a second, and is not to be written to any more.
    pub fn give_back(&mut self, receiver: &mut Receiver, now: Duration) -> bool {
        let is_taken = self.modes.give_back(&self.keys, &mut self.output, Some((&mut *receiver, now)), None);
        receiver.forget();
        is_taken
    }

    /// Gives the terminal back to whoever had it while the program was stopped without a word; returns what was typed
    /// meanwhile. What is typed from then on stays to be read: no shell is to be spared it.
    pub fn hand_over(&mut self, receiver: &mut Receiver, now: Duration) -> Vec<Input> {
        let mut typed = Vec::new();
        self.modes.give_back(&self.keys, &mut self.output, Some((&mut *receiver, now)), Some(&mut typed));
        receiver.forget_replies();
        typed
    }

    /// The bytes that are there. None at all: the terminal is gone.
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn read<'a>(&mut self, buffer: &'a mut [u8]) -> io::Result<&'a [u8]> {
        loop {
            match self.keys.read(buffer) {
                Ok(count) => {
                    rehearsal::count_read(count);
                    return Ok(&buffer[..count]);
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// Sleeps until there are keys or the wake pipe is readable, at most for `timeout`, or for ever without one; also
    /// until the terminal takes more of what is being sent.
    ///
    /// # Errors
    /// If the terminal is gone, or the operating system refuses.
    pub fn wait(&mut self, wake: BorrowedFd<'_>, timeout: Option<Duration>) -> io::Result<Woken> {
        // Without anything to send, only its end is told of the screen.
        let sending = if self.is_sending() { PollFlags::OUT } else { PollFlags::empty() };
        let mut fds = [
            PollFd::new(&self.keys, PollFlags::IN),
            PollFd::from_borrowed_fd(wake, PollFlags::IN),
            PollFd::new(self.output.file(), sending),
        ];
        let timeout = timeout.map(timespec);
        let woken = match poll(&mut fds, timeout.as_ref()) {
            // A signal: what it was is in the wake pipe, and the next call finds it there.
            Err(rustix::io::Errno::INTR) => Woken::default(),
            Err(error) => return Err(error.into()),
            // The keys may come from another terminal, which knows nothing of the screen's end.
            Ok(_) if fds[2].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL) => {
                return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the terminal is gone"));
            }
            Ok(_) => Woken { keys: !fds[0].revents().is_empty(), wake: !fds[1].revents().is_empty() },
        };
        self.output.push()?;
        Ok(woken)
    }
}

impl Drop for Terminal {
    /// Gives the terminal back without waiting for replies: who knows of any has given it back before.
    fn drop(&mut self) {
        self.modes.give_back(&self.keys, &mut self.output, None, None);
    }
}

/// Standard input if it is a terminal, else the controlling one.
fn keys_file() -> io::Result<File> {
    if io::stdin().is_terminal() {
        return Ok(File::from(io::stdin().as_fd().try_clone_to_owned()?));
    }
    File::open("/dev/tty")
        .map_err(|error| io::Error::new(error.kind(), format!("no terminal to read keys from: {error}")))
}
