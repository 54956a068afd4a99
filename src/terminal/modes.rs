//! What is turned on, in order, and how each is turned off.

use super::panics;
use crossterm::{Command, cursor, style, terminal};
use rustix::termios::{self, OptionalActions, QueueSelector, Termios};
use std::fs::File;
use std::io::{self, Write};

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
}

impl Modes {
    /// Raw mode, the alternate screen, no cursor.
    pub(super) fn take(keys: &File, screen: &File) -> io::Result<Self> {
        let mut modes = Self { on: Vec::new() };
        let taken = modes.turn_on(keys, screen);
        if taken.is_err() {
            modes.give_back(keys, &mut &*screen);
        }
        taken.map(|()| modes)
    }

    fn turn_on(&mut self, keys: &File, mut screen: &File) -> io::Result<()> {
        let before = termios::tcgetattr(keys)?;
        let mut raw = before.clone();
        raw.make_raw();
        // What is about to be turned on is listed first: half done is undone too.
        self.on.push(Mode::Raw(Box::new(before)));
        panics::hold(true);
        termios::tcsetattr(keys, OptionalActions::Now, &raw)?;
        // The pen is reset when the alternate screen ends, so that no colour is left for the shell.
        self.on.push(Mode::Screen(ansi(terminal::LeaveAlternateScreen)));
        self.on.push(Mode::Screen(ansi(style::ResetColor)));
        self.on.push(Mode::Screen(ansi(cursor::Show)));
        screen.write_all((ansi(terminal::EnterAlternateScreen) + &ansi(cursor::Hide)).as_bytes())
    }

    /// Turns everything off, newest first. What fails is passed over: the rest must be undone all the same.
    pub(super) fn give_back(&mut self, keys: &File, screen: &mut impl Write) {
        while let Some(mode) = self.on.pop() {
            match mode {
                Mode::Screen(off) => drop(screen.write_all(off.as_bytes())),
                Mode::Raw(before) => {
                    // Keys that were meant for us are not left for the shell. (TCSAFLUSH would do both, but it waits
                    // for the output to be read, and a terminal stopped by Ctrl-S does not read.)
                    let _ = termios::tcflush(keys, QueueSelector::IFlush);
                    let _ = termios::tcsetattr(keys, OptionalActions::Now, &before);
                }
            }
        }
        panics::hold(false);
    }
}

/// A command's escape sequence.
fn ansi(command: impl Command) -> String {
    let mut text = String::new();
    command.write_ansi(&mut text).expect("writing to memory does not fail");
    text
}
