//! What is turned on: raw mode, then the modes of the screen, mouse and keyboard; turned off the other way round.

use super::output::Output;
use super::replies::{await_last, is_in_background};
use super::{Signals, panics, rehearsal, signals};
use crate::input::Input;
use crate::protocol::{self, FENCE, Mode, Receiver};
use rustix::termios::{self, Action, OptionalActions, QueueSelector, Termios};
use std::fs::File;
use std::io;
use std::time::{Duration, Instant};

/// Everything that was turned on.
#[derive(Default)]
pub(super) struct Modes {
    /// The settings from before raw mode, which is the first to be turned on.
    before: Option<Box<Termios>>,
    on: protocol::Modes,
}

/// How long the terminal may take over the last bytes. One that has stopped reading (Ctrl-S, a dead link) is left without.
const PATIENCE: Duration = Duration::from_secs(1);

impl Modes {
    /// Raw mode, the alternate screen, no cursor, pastes in brackets, word of the focus and of the mouse. What is about to
    /// be turned on is listed first: half done is undone too.
    pub(super) fn turn_on(&mut self, keys: &File, output: &mut Output, signals: &Signals) -> io::Result<()> {
        wait_for_foreground(keys, signals)?;
        let before = termios::tcgetattr(keys)?;
        let mut raw = before.clone();
        raw.make_raw();
        self.before = Some(Box::new(before));
        panics::hold(true);
        termios::tcsetattr(keys, OptionalActions::Now, &raw)?;
        rehearsal::reach("raw mode")?;
        let mut bytes = Vec::new();
        for mode in Mode::ALL_TERMINALS {
            self.on.switch_on(mode, &mut bytes);
        }
        output.send(&bytes)?;
        rehearsal::reach("all modes")
    }

    /// Switches a mode on that is off.
    pub(super) fn switch_on(&mut self, mode: Mode, output: &mut Output) -> io::Result<()> {
        let mut bytes = Vec::new();
        self.on.switch_on(mode, &mut bytes);
        if bytes.is_empty() {
            return Ok(());
        }
        output.send(&bytes)?;
        if mode == Mode::Keyboard { rehearsal::reach("keyboard") } else { Ok(()) }
    }

    /// Turns everything off, newest first. What still waits of a picture is dropped, between two of its sequences, so that
    /// nothing is torn. What fails is passed over: the rest must be undone all the same. Replies that the receiver knows to
    /// be on their way are waited for. Keys are thrown away, unless they are to go to `typed`. Whether the terminal took it
    /// all; asked again, it did.
    pub(super) fn give_back(
        &mut self,
        keys: &File,
        output: &mut Output,
        mut receiver: Option<(&mut Receiver, Duration)>,
        mut typed: Option<&mut Vec<Input>>,
    ) -> bool {
        output.drop_picture();
        // It tells of releases until it has heard that it no longer should, and q is let go of about then. Its answer
        // comes after the last of them.
        let asks = self.on.are_on(Mode::Keyboard) && !is_in_background(keys);
        let mut off = Vec::new();
        self.on.switch_all_off(&mut off);
        output.put(&off);
        let Some(before) = self.before.take() else { return true };
        if asks {
            output.put(FENCE);
            if let Some((receiver, now)) = &mut receiver {
                receiver.sent(FENCE, *now);
            }
        }
        let deadline = Instant::now() + PATIENCE;
        let heard = output.finish(deadline);
        // A terminal that has stopped reading does not answer either.
        if let Some((receiver, now)) = receiver.filter(|_| heard) {
            let read = await_last(keys, receiver, now, deadline);
            if let Some(typed) = &mut typed {
                typed.extend(read);
            }
        }
        let flushes = typed.is_none();
        signals::in_the_background(|| restore(keys, &before, flushes));
        panics::hold(false);
        heard
    }
}

/// The settings of now are given back in the end, so they must be the shell's for its jobs, not those with which it reads
/// its next line. Whoever is told to end meanwhile does not wait any longer: that is the error.
fn wait_for_foreground(keys: &File, signals: &Signals) -> io::Result<()> {
    while is_in_background(keys) && signals::stop_for_output() {
        if signals.deadly().is_some() {
            return Err(io::ErrorKind::Interrupted.into());
        }
        if !signals.take_continued() {
            // Nobody is there who could continue us: so says what follows.
            break;
        }
    }
    // (It has output go on that a program has held up, on some systems also what Ctrl-S has.)
    termios::tcflow(keys, Action::OOn)?;
    // Nothing was on the screen that somebody could have written over.
    signals.take_continued();
    Ok(())
}

/// Keys that were meant for us are not left for the shell, if they are to be flushed. (TCSAFLUSH would do both, but it waits
/// for the output to be read, and a terminal stopped by Ctrl-S does not read.)
fn restore(keys: &File, before: &Termios, flushes: bool) {
    if flushes {
        let _ = termios::tcflush(keys, QueueSelector::IFlush);
    }
    let _ = termios::tcsetattr(keys, OptionalActions::Now, before);
}
