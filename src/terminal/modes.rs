//! The terminal's modes: raw mode first, then those of screen, mouse and keyboard; switched off in
//! reverse order.

use super::output::Output;
use super::replies::{is_in_background, read_until_last_reply};
use super::{Signals, fault_injection, panics, signals};
use crate::input::Input;
use crate::protocol::{self, FENCE, Receiver, TerminalMode};
use rustix::termios::{self, Action, OptionalActions, QueueSelector, Termios};
use std::fs::File;
use std::io;
use std::time::{Duration, Instant};

/// The terminal modes that are on.
#[derive(Default)]
pub(super) struct Modes {
    /// The terminal's settings before raw mode; `None` if it is off.
    before: Option<Box<Termios>>,
    /// The modes that escape sequences have switched on.
    on: protocol::TerminalModes,
}

/// Greatest time that restoring the terminal waits for it to accept the last bytes and to reply.
// A terminal that has stopped reading (Ctrl-S, a dead link) delays the exit by this time. It is longer than the round
// trip of usual links, because the shell would take a later reply for typed text.
const RESTORE_TIMEOUT: Duration = Duration::from_secs(1);

impl Modes {
    /// Switches on raw mode and all modes that every terminal supports, such as the alternate
    /// screen.
    ///
    /// Each mode is recorded before it is switched on, so that a failure half-way is undone as well.
    pub(super) fn switch_on_universal(
        &mut self,
        keys: &File,
        output: &mut Output,
        signals: &Signals,
    ) -> io::Result<()> {
        wait_for_foreground(keys, signals)?;
        let before = termios::tcgetattr(keys)?;
        let mut raw = before.clone();
        raw.make_raw();
        self.before = Some(Box::new(before));
        // Set before raw mode is switched on, so that the message of a panic in between is kept until the terminal is
        // restored.
        panics::set_held(true);
        termios::tcsetattr(keys, OptionalActions::Now, &raw)?;
        fault_injection::report_phase("raw mode")?;
        let mut bytes = Vec::new();
        for mode in TerminalMode::ALL_TERMINALS {
            self.on.switch_on(mode, &mut bytes);
        }
        output.send(&bytes)?;
        fault_injection::report_phase("all modes")
    }

    /// Switches on a mode unless it is on already.
    pub(super) fn switch_on(&mut self, mode: TerminalMode, output: &mut Output) -> io::Result<()> {
        let mut bytes = Vec::new();
        self.on.switch_on(mode, &mut bytes);
        if bytes.is_empty() {
            return Ok(());
        }
        output.send(&bytes)?;
        if mode == TerminalMode::Keyboard { fault_injection::report_phase("keyboard") } else { Ok(()) }
    }

    /// Switches off all modes, newest first, and waits for the outstanding replies of `receiver`.
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
        // switches them off, and the user releases `q` about then. The reply to a fence follows the last report.
        let needs_fence = self.on.is_on(TerminalMode::Keyboard) && !is_in_background(keys);
        let mut off = Vec::new();
        self.on.switch_all_off(&mut off);
        output.append(&off);
        let Some(before) = self.before.take() else { return true };
        if needs_fence {
            output.append(FENCE);
            if let Some((receiver, now)) = &mut receiver {
                receiver.sent(FENCE, *now);
            }
        }
        let deadline = Instant::now() + RESTORE_TIMEOUT;
        let is_drained = output.drain(deadline);
        // A terminal that has stopped reading does not reply, so its replies are not waited for.
        if let Some((receiver, now)) = receiver.filter(|_| is_drained) {
            let read = read_until_last_reply(keys, receiver, now, deadline);
            if let Some(typed) = &mut typed {
                typed.extend(read);
            }
        }
        let flushes = typed.is_none();
        signals::with_sigttou_blocked(|| restore_settings(keys, &before, flushes));
        panics::set_held(false);
        is_drained
    }
}

/// Waits until the process is in the foreground of its terminal.
///
/// The settings at that time are restored at the end, so they must be those that the shell sets for its jobs, not those
/// of the shell's line editor.
///
/// # Errors
/// `Interrupted`, if a signal asks the process to end during the wait.
fn wait_for_foreground(keys: &File, signals: &Signals) -> io::Result<()> {
    while is_in_background(keys) && signals::stop_for_output() {
        if signals.deadly().is_some() {
            return Err(io::ErrorKind::Interrupted.into());
        }
        if !signals.take_continued() {
            // The process group is orphaned, so that no shell can continue it. `tcflow` below then fails with EIO.
            break;
        }
    }
    // TCOON resumes output that another program, or on some systems Ctrl-S, has suspended.
    termios::tcflow(keys, Action::OOn)?;
    // Discards a SIGCONT from before the first frame, because there is nothing to draw again.
    signals.take_continued();
    Ok(())
}

/// Restores the terminal's settings; if `flushes`, discards unread keys first, so that the shell
/// does not get them.
///
/// TCSAFLUSH would do both in one call, but first waits until all output is transmitted, for ever after Ctrl-S.
fn restore_settings(keys: &File, before: &Termios, flushes: bool) {
    if flushes {
        let _ = termios::tcflush(keys, QueueSelector::IFlush);
    }
    // An error of `tcsetattr` is ignored, because it means that the terminal is gone.
    let _ = termios::tcsetattr(keys, OptionalActions::Now, before);
}
