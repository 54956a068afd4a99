//! The modes that are switched on, in order, and the bytes that switch each on and off.

use crossterm::event::{self, KeyboardEnhancementFlags};
use crossterm::{Command, cursor, style, terminal};

/// A mode of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The alternate screen (1049), whose contents vanish when it is switched off.
    AlternateScreen,
    /// The pen's colours. Nothing switches them on: the picture sets them, and the shell must not inherit them.
    Colors,
    /// No cursor (25).
    HiddenCursor,
    /// Brackets around what is pasted (2004).
    BracketedPaste,
    /// Reports of the focus (1004).
    FocusChange,
    /// Reports of the mouse's buttons and wheel, and of its motion while a button is held (1002). (crossterm's command
    /// asks for motion without a button too: many events that mean nothing here.)
    Mouse,
    /// Mouse reports in SGR form (1006): coordinates of any size, and which button is released.
    MouseSgr,
    /// Mouse reports in pixels (1016).
    MousePixels,
    /// The kitty keyboard protocol: every key as a sequence, with its release, and with what Shift makes of it. It is
    /// pushed on that protocol's stack, with a query for the flags that are then set.
    Keyboard,
}

const KEYBOARD: KeyboardEnhancementFlags = KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
    .union(KeyboardEnhancementFlags::REPORT_EVENT_TYPES)
    .union(KeyboardEnhancementFlags::REPORT_ALTERNATE_KEYS)
    .union(KeyboardEnhancementFlags::REPORT_ALL_KEYS_AS_ESCAPE_CODES);

/// The query for the flags of the kitty keyboard protocol that are set.
const KEYBOARD_QUERY: &str = "\x1b[?u";

impl Mode {
    /// The modes of the live view that every terminal knows or ignores, in the order in which they are switched on.
    pub const ALL_TERMINALS: [Self; 7] = [
        Self::AlternateScreen,
        Self::Colors,
        Self::HiddenCursor,
        Self::BracketedPaste,
        Self::FocusChange,
        Self::Mouse,
        Self::MouseSgr,
    ];

    fn on(self) -> String {
        match self {
            Self::AlternateScreen => ansi(terminal::EnterAlternateScreen),
            Self::Colors => String::new(),
            Self::HiddenCursor => ansi(cursor::Hide),
            Self::BracketedPaste => ansi(event::EnableBracketedPaste),
            Self::FocusChange => ansi(event::EnableFocusChange),
            Self::Mouse => "\x1b[?1002h".to_owned(),
            Self::MouseSgr => "\x1b[?1006h".to_owned(),
            Self::MousePixels => "\x1b[?1016h".to_owned(),
            Self::Keyboard => ansi(event::PushKeyboardEnhancementFlags(KEYBOARD)) + KEYBOARD_QUERY,
        }
    }

    fn off(self) -> String {
        match self {
            Self::AlternateScreen => ansi(terminal::LeaveAlternateScreen),
            Self::Colors => ansi(style::ResetColor),
            Self::HiddenCursor => ansi(cursor::Show),
            Self::BracketedPaste => ansi(event::DisableBracketedPaste),
            Self::FocusChange => ansi(event::DisableFocusChange),
            Self::Mouse => "\x1b[?1002l".to_owned(),
            Self::MouseSgr => "\x1b[?1006l".to_owned(),
            Self::MousePixels => "\x1b[?1016l".to_owned(),
            Self::Keyboard => ansi(event::PopKeyboardEnhancementFlags),
        }
    }
}

/// The modes that are switched on, oldest first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Modes {
    on: Vec<Mode>,
}

impl Modes {
    /// Appends the bytes that switch a mode on, and lists it; no bytes if it is listed already.
    ///
    /// To be called before the bytes are sent: what was only sent in part is switched off too.
    pub fn switch_on(&mut self, mode: Mode, bytes: &mut Vec<u8>) {
        if !self.are_on(mode) {
            self.on.push(mode);
            bytes.extend_from_slice(mode.on().as_bytes());
        }
    }

    /// Whether a mode is switched on.
    pub fn are_on(&self, mode: Mode) -> bool {
        self.on.contains(&mode)
    }

    /// Appends the bytes that switch all modes off, newest first.
    pub fn switch_all_off(&mut self, bytes: &mut Vec<u8>) {
        for mode in self.on.drain(..).rev() {
            bytes.extend_from_slice(mode.off().as_bytes());
        }
    }
}

/// A command's escape sequence.
fn ansi(command: impl Command) -> String {
    let mut text = String::new();
    command.write_ansi(&mut text).expect("writing to memory does not fail");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEYOND: [Mode; 2] = [Mode::MousePixels, Mode::Keyboard];

    #[test]
    fn modes_are_switched_off_in_reverse_order() {
        let (mut modes, mut on, mut off) = (Modes::default(), Vec::new(), Vec::new());
        let all: Vec<_> = Mode::ALL_TERMINALS.into_iter().chain(BEYOND).collect();
        for &mode in &all {
            modes.switch_on(mode, &mut on);
        }
        modes.switch_all_off(&mut off);
        let expected: String = all.iter().rev().map(|mode| mode.off()).collect();
        assert_eq!(String::from_utf8_lossy(&off), expected);
        assert_eq!(modes, Modes::default());
    }

    #[test]
    fn a_mode_is_switched_on_and_off_once() {
        let (mut modes, mut bytes) = (Modes::default(), Vec::new());
        modes.switch_on(Mode::MousePixels, &mut bytes);
        modes.switch_on(Mode::MousePixels, &mut bytes);
        assert!(modes.are_on(Mode::MousePixels) && !modes.are_on(Mode::Keyboard));
        modes.switch_all_off(&mut bytes);
        modes.switch_all_off(&mut bytes);
        assert_eq!(bytes, b"\x1b[?1016h\x1b[?1016l");
    }
}
