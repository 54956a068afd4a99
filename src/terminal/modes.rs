//! The terminal's modes: raw mode first, then those of screen, mouse and keyboard.
//!
//! They are switched off in reverse order.

use super::output::Output;
use super::replies::{await_last, is_in_background};
use super::{Signals, fault_injection, panics, signals};
use crate::input::Input;
use crate::protocol::{self, FENCE, Receiver, TerminalMode};
use rustix::termios::{self, Action, OptionalActions, QueueSelector, Termios};
use std::fs::File;
use std::io;
use std::time::{Duration, Instant};

/// The modes that are on.
#[derive(Default)]
pub(super) struct Modes {
    /// The settings before raw mode, which is switched on first.
    before: Option<Box<Termios>>,
    on: protocol::TerminalModes,
}

/// Timeout for the last bytes and replies.
// A terminal that has stopped reading (Ctrl-S, a dead link) delays the exit by this much and does not get the rest. A
// second is longer than the round trip of any usual link, after which a late reply would be typed into the shell.
const RESTORE_TIMEOUT: Duration = Duration::from_secs(1);

impl Modes {
    /// Switches on raw mode, the alternate screen, bracketed paste and reports of focus and mouse,
    /// and hides the cursor.
    ///
    /// Each mode is recorded before it is switched on, so that a failure half-way is undone as well.
    pub(super) fn switch_on_all(&mut self, keys: &File, output: &mut Output, signals: &Signals) -> io::Result<()> {
        wait_for_foreground(keys, signals)?;
        let before = termios::tcgetattr(keys)?;
        let mut raw = before.clone();
        raw.make_raw();
        self.before = Some(Box::new(before));
        panics::hold(true);
        termios::tcsetattr(keys, OptionalActions::Now, &raw)?;
        fault_injection::reach("raw mode")?;
        let mut bytes = Vec::new();
        for mode in TerminalMode::ALL_TERMINALS {
            self.on.switch_on(mode, &mut bytes);
        }
        output.send(&bytes)?;
        fault_injection::reach("all modes")
    }

    /// Switches on a mode unless it is on already.
    pub(super) fn switch_on(&mut self, mode: TerminalMode, output: &mut Output) -> io::Result<()> {
        let mut bytes = Vec::new();
        self.on.switch_on(mode, &mut bytes);
        if bytes.is_empty() {
            return Ok(());
        }
        output.send(&bytes)?;
        if mode == TerminalMode::Keyboard { fault_injection::reach("keyboard") } else { Ok(()) }
    }

    /// Switches off all modes, newest first, and waits for the replies that `receiver` knows to be
    /// outstanding.
    ///
    /// The unwritten rest of a frame is dropped at a sequence boundary, so that no sequence is cut in two. A step that
    /// fails does not keep the next ones from running. Unread keys are flushed, or appended to `typed` if given.
    /// Returns whether the terminal accepted all bytes; `true` if the modes are off already.
    pub(super) fn restore(
        &mut self,
        keys: &File,
        output: &mut Output,
        mut receiver: Option<(&mut Receiver, Duration)>,
        mut typed: Option<&mut Vec<Input>>,
    ) -> bool {
        output.drop_frame();
        // With the kitty keyboard protocol the terminal reports key releases until it has processed the sequence that
        // switches them off, and the release of `q` comes about then. The reply to a fence follows the last report.
        let needs_fence = self.on.is_on(TerminalMode::Keyboard) && !is_in_background(keys);
        let mut off = Vec::new();
        self.on.switch_all_off(&mut off);
        output.put(&off);
        let Some(before) = self.before.take() else { return true };
        if needs_fence {
            output.put(FENCE);
            if let Some((receiver, now)) = &mut receiver {
                receiver.sent(FENCE, *now);
            }
        }
        let deadline = Instant::now() + RESTORE_TIMEOUT;
        let is_drained = output.drain(deadline);
        // A terminal that has stopped reading does not reply either.
        if let Some((receiver, now)) = receiver.filter(|_| is_drained) {
            let read = await_last(keys, receiver, now, deadline);
            if let Some(typed) = &mut typed {
                typed.extend(read);
            }
        }
        let flushes = typed.is_none();
        signals::in_the_background(|| restore_settings(keys, &before, flushes));
        panics::hold(false);
        is_drained
    }
}

/// Waits until the process is in the foreground of its terminal.
///
/// The settings found now are restored at the end, so they must be the ones that the shell sets for its jobs, not those
/// with which its line editor reads.
///
/// # Errors
/// `Interrupted`, if a signal asks the process to end meanwhile.
fn wait_for_foreground(keys: &File, signals: &Signals) -> io::Result<()> {
    while is_in_background(keys) && signals::stop_for_output() {
        if signals.deadly().is_some() {
            return Err(io::ErrorKind::Interrupted.into());
        }
        if !signals.take_continued() {
            // The process group is orphaned: no shell can continue it. The next call then fails with EIO.
            break;
        }
    }
    // TCOON: resumes output that another program has suspended; on some systems also after Ctrl-S.
    termios::tcflow(keys, Action::OOn)?;
    // Discards a SIGCONT from before the first frame: there is nothing to draw again.
    signals.take_continued();
    Ok(())
}

/// Restores the settings, after flushing unread keys if `flushes`, so that the shell does not get
/// them.
///
/// TCSAFLUSH would do both in one call, but it first waits until all output is transmitted, which a terminal stopped by
/// Ctrl-S never does.
fn restore_settings(keys: &File, before: &Termios, flushes: bool) {
    if flushes {
        let _ = termios::tcflush(keys, QueueSelector::IFlush);
    }
    let _ = termios::tcsetattr(keys, OptionalActions::Now, before);
}
