//! What is turned on, in order, and how each is turned off.

use super::output::Output;
use super::unanswered::{Unanswered, is_in_background};
use super::{FENCE, Signals, panics, rehearsal, signals};
use crossterm::event::{self, KeyboardEnhancementFlags};
use crossterm::{Command, cursor, style, terminal};
use rustix::termios::{self, Action, OptionalActions, QueueSelector, Termios};
use std::fs::File;
use std::io;
use std::time::{Duration, Instant};

/// Everything that was turned on, oldest first.
pub(super) struct Modes {
    on: Vec<Mode>,
}

/// One thing that was turned on: what turns it off.
enum Mode {
    /// Raw mode: the settings from before.
    Raw(Box<Termios>),
    /// A mode of the screen: the bytes that end it.
    Screen(String),
    /// The keyboard as the kitty protocol has it, on that protocol's stack.
    Keyboard,
}

/// Every key as a sequence, with its release, and with what Shift makes of it.
const KEYBOARD: KeyboardEnhancementFlags = KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
    .union(KeyboardEnhancementFlags::REPORT_EVENT_TYPES)
    .union(KeyboardEnhancementFlags::REPORT_ALTERNATE_KEYS)
    .union(KeyboardEnhancementFlags::REPORT_ALL_KEYS_AS_ESCAPE_CODES);
/// Asks which flags of the kitty keyboard protocol are on.
const WHICH_KEYBOARD: &str = "\x1b[?u";

/// Word of the mouse's buttons and wheel, and of its ways while a button is held. (crossterm's command asks for its ways
/// without a button, too: many events that mean nothing here.)
const BUTTONS: (&str, &str) = ("\x1b[?1002h", "\x1b[?1002l");
/// With numbers of any size, and of which button is let go.
const SGR: (&str, &str) = ("\x1b[?1006h", "\x1b[?1006l");
/// The same with places in pixels.
const PIXELS: (&str, &str) = ("\x1b[?1016h", "\x1b[?1016l");

/// How long the terminal may take over the last bytes. One that has stopped reading (Ctrl-S, a dead link) is left without.
const PATIENCE: Duration = Duration::from_secs(1);

impl Modes {
    /// Nothing is turned on yet.
    pub(super) fn none() -> Self {
        Self { on: Vec::new() }
    }

    /// Raw mode, the alternate screen, no cursor, pastes in brackets, word of the focus and of the mouse. What is about to be turned on is
    /// listed first: half done is undone too.
    pub(super) fn turn_on(&mut self, keys: &File, output: &mut Output, signals: &Signals) -> io::Result<()> {
        wait_for_foreground(keys, signals)?;
        let before = termios::tcgetattr(keys)?;
        let mut raw = before.clone();
        raw.make_raw();
        self.on.push(Mode::Raw(Box::new(before)));
        panics::hold(true);
        termios::tcsetattr(keys, OptionalActions::Now, &raw)?;
        rehearsal::reach("raw mode")?;
        let mut turn_on = String::new();
        self.list(&mut turn_on, terminal::EnterAlternateScreen, terminal::LeaveAlternateScreen);
        // Nothing to turn on: the pen is the picture's, and no colour is left for the shell.
        self.on.push(Mode::Screen(ansi(style::ResetColor)));
        self.list(&mut turn_on, cursor::Hide, cursor::Show);
        self.list(&mut turn_on, event::EnableBracketedPaste, event::DisableBracketedPaste);
        self.list(&mut turn_on, event::EnableFocusChange, event::DisableFocusChange);
        for (on, off) in [BUTTONS, SGR] {
            self.on.push(Mode::Screen(off.to_owned()));
            turn_on.push_str(on);
        }
        output.send(turn_on.as_bytes())?;
        rehearsal::reach("all modes")
    }

    /// Places of the mouse in pixels, once.
    pub(super) fn count_pixels(&mut self, output: &mut Output) -> io::Result<()> {
        let (on, off) = PIXELS;
        if self.on.iter().any(|mode| matches!(mode, Mode::Screen(known) if known == off)) {
            return Ok(());
        }
        self.on.push(Mode::Screen(off.to_owned()));
        output.send(on.as_bytes())
    }

    /// The kitty keyboard protocol, once, with the question whether it is on.
    pub(super) fn push_keyboard(&mut self, output: &mut Output) -> io::Result<()> {
        if self.has_keyboard() {
            return Ok(());
        }
        self.on.push(Mode::Keyboard);
        let push = ansi(event::PushKeyboardEnhancementFlags(KEYBOARD));
        output.send((push + WHICH_KEYBOARD).as_bytes())?;
        rehearsal::reach("keyboard")
    }

    pub(super) fn has_keyboard(&self) -> bool {
        self.on.iter().any(|mode| matches!(mode, Mode::Keyboard))
    }

    fn list(&mut self, turn_on: &mut String, on: impl Command, off: impl Command) {
        self.on.push(Mode::Screen(ansi(off)));
        turn_on.push_str(&ansi(on));
    }

    /// Turns everything off, newest first. What still waits of a picture is dropped, between two of its sequences, so that
    /// nothing is torn. What fails is passed over: the rest must be undone all the same. Replies that are on their way are
    /// waited for. Keys are thrown away, unless they are to go to `typed`. Whether the terminal took it all; asked again,
    /// it did.
    pub(super) fn give_back(
        &mut self,
        keys: &File,
        output: &mut Output,
        unanswered: &mut Unanswered,
        mut typed: Option<&mut Vec<u8>>,
    ) -> bool {
        output.drop_picture();
        let deadline = Instant::now() + PATIENCE;
        let mut heard = true;
        // It tells of releases until it has heard that it no longer should, and q is let go of about then. Its answer
        // comes after the last of them.
        let asks = self.has_keyboard() && !is_in_background(keys);
        while let Some(mode) = self.on.pop() {
            match mode {
                Mode::Screen(off) => output.put(off.as_bytes()),
                Mode::Keyboard => output.put(ansi(event::PopKeyboardEnhancementFlags).as_bytes()),
                Mode::Raw(before) => {
                    if asks {
                        output.put(FENCE);
                        unanswered.send(FENCE);
                    }
                    heard = output.finish(deadline);
                    // A terminal that has stopped reading does not answer either.
                    if heard {
                        let read = unanswered.drain(keys, deadline);
                        if let Some(typed) = &mut typed {
                            typed.extend(read);
                        }
                    }
                    let flushes = typed.is_none();
                    signals::in_the_background(|| restore(keys, &before, flushes));
                }
            }
        }
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

/// A command's escape sequence.
fn ansi(command: impl Command) -> String {
    let mut text = String::new();
    command.write_ansi(&mut text).expect("writing to memory does not fail");
    text
}
