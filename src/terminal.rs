//! The single owner of the terminal. It switches off every mode that it has switched on, in reverse
//! order.
//!
//! Dropping a [`Terminal`] restores the terminal: on return, on an error, and while a panic unwinds. A signal that
//! would end the process ends the loop of [`app`](crate::app) instead, which drops the `Terminal` too; `main` then
//! raises the signal again with its default action. The terminal is also restored before a stop (Ctrl-Z, SIGTSTP) and
//! taken again afterwards. Panic messages are kept until the terminal is restored (see [`hold_panic_messages`]):
//! printed earlier, they would vanish with the alternate screen.
//!
//! `O_NONBLOCK` is a property of the open file description, which the shell shares and would find set after the program
//! has ended. So it is never set on an inherited descriptor: the terminal is opened a second time for writing. Keys and
//! signals are therefore handled even when the terminal has stopped reading.

use crate::capabilities::{self, CellShape};
use crate::grid::Size;
pub use crate::grid::Window;
use crate::input::Input;
use crate::protocol::{Receiver, TerminalMode};
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
mod fault_injection;
mod replies;
mod signals;

#[cfg(feature = "test-hooks")]
pub use fault_injection::inject_faults;
pub(crate) use fault_injection::{report_phase, report_phase_in_thread, take_worker_panic, try_report_idle};
use modes::Modes;
pub use output::stderr_accepts_message;
use output::{Output, timespec};
pub use panics::{hold_panic_messages, take_panic_messages};
pub use signals::{
    Signals, StopTarget, Waker, before_death, die_of, fail_large_writes, lower_thread_priority, without_signals,
};

/// A terminal in raw mode with the alternate screen: its input, output, modes and window size.
pub struct Terminal {
    keys: File,
    output: Output,
    modes: Modes,
}

/// The inputs that are readable when [`Terminal::wait`] returns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Readable {
    /// Whether bytes from the terminal can be read, or the terminal has hung up.
    pub keys: bool,
    /// Whether bytes from the wake pipe can be read.
    pub wake: bool,
}

impl Terminal {
    /// Takes control of the terminal.
    ///
    /// Switches on raw mode, the alternate screen, and reports of keys, mouse and focus.
    ///
    /// Frames go to standard output. Keys come from standard input, or from the controlling terminal if standard input
    /// is not a terminal. A process in the background waits here until it is in the foreground.
    ///
    /// # Errors
    /// If standard output is not a terminal, or if there is no terminal for keys or it cannot be set up; it is then in
    /// its original state.
    pub fn take(signals: &Signals) -> io::Result<Self> {
        let output = Output::open()?;
        let mut terminal = Self { keys: open_key_input()?, output, modes: Modes::default() };
        terminal.take_again(signals)?;
        Ok(terminal)
    }

    /// Takes control of the terminal again after [`restore`](Self::restore).
    ///
    /// # Errors
    /// If the terminal cannot be set up. Dropping `self` undoes the steps that succeeded.
    pub fn take_again(&mut self, signals: &Signals) -> io::Result<()> {
        self.modes.switch_on_universal(&self.keys, &mut self.output, signals)
    }

    /// Returns the window's current size, in cells and, where the terminal reports them, in pixels.
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn window(&self) -> io::Result<Window> {
        let window = termios::tcgetwinsize(self.output.file())?;
        let (columns, rows) = (window.ws_col, window.ws_row);
        // A terminal without a known size, such as a serial line, reports 0 by 0.
        let size = if columns == 0 || rows == 0 { Size::new(80, 24) } else { Size::new(columns, rows) };
        let aspect = capabilities::cell_aspect(columns, rows, window.ws_xpixel, window.ws_ypixel);
        let cell = CellShape { aspect, half_blocks: capabilities::half_blocks(rows, window.ws_ypixel) };
        let cell_pixels =
            cell.aspect.and(window.ws_xpixel.checked_div(columns).zip(window.ws_ypixel.checked_div(rows)));
        Ok(Window { size, cell, cell_pixels, is_part: false })
    }

    /// Sends a frame or queries, in a single write if the terminal accepts all of it.
    ///
    /// The rest is written during [`wait`](Self::wait). The caller reports any queries among the bytes to its
    /// [`Receiver`].
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.output.send(bytes)
    }

    /// Switches on a mode that not every terminal supports, until the terminal is restored.
    ///
    /// Sends nothing if the mode is already on.
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn switch_on(&mut self, mode: TerminalMode) -> io::Result<()> {
        self.modes.switch_on(mode, &mut self.output)
    }

    /// Copies `text` to the user's clipboard by OSC 52, which the terminal may ignore.
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn copy(&mut self, text: &str) -> io::Result<()> {
        let encoded = base64::engine::general_purpose::STANDARD.encode(text);
        self.output.send(format!("\x1b]52;c;{encoded}\x1b\\").as_bytes())
    }

    /// Returns whether a part of the last frame has not been written yet.
    pub fn is_sending(&self) -> bool {
        self.output.is_pending()
    }

    /// Restores the terminal and reads outstanding replies, which the shell would take for typed
    /// text.
    ///
    /// Waits for at most a second. Returns whether the terminal accepted all bytes: if not, it has stopped reading, and
    /// writing to it would block.
    pub fn restore(&mut self, receiver: &mut Receiver, now: Duration) -> bool {
        let is_drained = self.modes.restore(&self.keys, &mut self.output, Some((&mut *receiver, now)), None);
        receiver.forget();
        is_drained
    }

    /// Restores the terminal after a stop that could not be caught (SIGSTOP), and returns the input
    /// read meanwhile.
    ///
    /// Unlike [`restore`](Self::restore) it does not flush unread input: the program continues and reads it.
    pub fn restore_keeping_input(&mut self, receiver: &mut Receiver, now: Duration) -> Vec<Input> {
        let mut typed = Vec::new();
        self.modes.restore(&self.keys, &mut self.output, Some((&mut *receiver, now)), Some(&mut typed));
        receiver.forget_replies();
        typed
    }

    /// Reads the bytes that have arrived. An empty slice means that the terminal has hung up.
    ///
    /// # Errors
    /// If the terminal is gone.
    pub fn read<'a>(&mut self, buffer: &'a mut [u8]) -> io::Result<&'a [u8]> {
        loop {
            match self.keys.read(buffer) {
                Ok(count) => {
                    fault_injection::count_read(count);
                    return Ok(&buffer[..count]);
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// Sleeps until keys arrive, the wake pipe is readable, or the terminal accepts pending bytes.
    ///
    /// Writes what the terminal accepts. Returns after `timeout` at the latest; `None` waits without a limit.
    ///
    /// # Errors
    /// If the terminal is gone, or polling fails.
    pub fn wait(&mut self, wake: BorrowedFd<'_>, timeout: Option<Duration>) -> io::Result<Readable> {
        // Without pending bytes the output is polled for a hang-up only, which poll always reports.
        let sending = if self.is_sending() { PollFlags::OUT } else { PollFlags::empty() };
        let mut fds = [
            PollFd::new(&self.keys, PollFlags::IN),
            PollFd::from_borrowed_fd(wake, PollFlags::IN),
            PollFd::new(self.output.file(), sending),
        ];
        let timeout = timeout.map(timespec);
        let readable = match poll(&mut fds, timeout.as_ref()) {
            // The wait was interrupted by a signal: its handler has written to the wake pipe, which the next call finds
            // readable.
            Err(rustix::io::Errno::INTR) => Readable::default(),
            Err(error) => return Err(error.into()),
            // Keys may come from another terminal than the output's, so only this check notices that the output's
            // terminal has hung up.
            Ok(_) if fds[2].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL) => {
                return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the terminal is gone"));
            }
            Ok(_) => Readable { keys: !fds[0].revents().is_empty(), wake: !fds[1].revents().is_empty() },
        };
        self.output.write_pending()?;
        Ok(readable)
    }
}

impl Drop for Terminal {
    /// Restores the terminal without waiting for replies.
    ///
    /// A caller whose [`Receiver`] knows of outstanding replies calls [`restore`](Terminal::restore) first.
    fn drop(&mut self) {
        self.modes.restore(&self.keys, &mut self.output, None, None);
    }
}

/// Opens the source of keys: standard input if it is a terminal, otherwise the controlling
/// terminal.
fn open_key_input() -> io::Result<File> {
    if io::stdin().is_terminal() {
        return Ok(File::from(io::stdin().as_fd().try_clone_to_owned()?));
    }
    File::open("/dev/tty")
        .map_err(|error| io::Error::new(error.kind(), format!("no terminal to read keys from: {error}")))
}
