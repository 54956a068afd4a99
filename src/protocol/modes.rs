//! The terminal modes that are on, in order, and the bytes that switch each on and off.

use crossterm::event::{self, KeyboardEnhancementFlags};
use crossterm::{Command, cursor, style, terminal};

/// A mode of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TerminalMode {
    /// The alternate screen (1049), whose contents are lost when it is switched off.
    AlternateScreen,
    /// Colours of the pen that frames have set, and that the shell must not inherit.
    ///
    /// No bytes switch this mode on; switching it off resets the colours.
    Colors,
    /// A hidden cursor (25).
    HiddenCursor,
    /// Bracketed paste (2004).
    BracketedPaste,
    /// Reports of focus changes (1004).
    FocusChange,
    /// Reports of mouse buttons, wheel and drags (1002). Motion without a button (1003), which
    /// crossterm's command also requests, would wake the event loop for nothing.
    Mouse,
    /// Mouse reports in SGR form (1006): coordinates of any size, and the button of a release.
    MouseSgr,
    /// Mouse reports in pixels (1016).
    MousePixels,
    /// The kitty keyboard protocol: every key as a sequence, with its release and its shifted
    /// character. Its flags are pushed on the protocol's stack and then queried.
    Keyboard,
}

const KEYBOARD: KeyboardEnhancementFlags = KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
    .union(KeyboardEnhancementFlags::REPORT_EVENT_TYPES)
    .union(KeyboardEnhancementFlags::REPORT_ALTERNATE_KEYS)
    .union(KeyboardEnhancementFlags::REPORT_ALL_KEYS_AS_ESCAPE_CODES);

/// The query for the flags of the kitty keyboard protocol that are set.
// Keys that arrive before the reply to this query are in the legacy encoding, later keys in that of the protocol.
const KEYBOARD_QUERY: &str = "\x1b[?u";

impl TerminalMode {
    /// The modes of the live view that every terminal supports or ignores, in the order in which
    /// they are switched on.
    // The alternate screen is first, so that the cursor, for example, is hidden there and not on the shell's screen.
    pub const ALL_TERMINALS: [Self; 7] = [
        Self::AlternateScreen,
        Self::Colors,
        Self::HiddenCursor,
        Self::BracketedPaste,
        Self::FocusChange,
        Self::Mouse,
        Self::MouseSgr,
    ];

    fn on_sequence(self) -> String {
        match self {
            Self::AlternateScreen => ansi_sequence(terminal::EnterAlternateScreen),
            // Frames set colours themselves, so only switching off needs bytes.
            Self::Colors => String::new(),
            Self::HiddenCursor => ansi_sequence(cursor::Hide),
            Self::BracketedPaste => ansi_sequence(event::EnableBracketedPaste),
            Self::FocusChange => ansi_sequence(event::EnableFocusChange),
            Self::Mouse => "\x1b[?1002h".to_owned(),
            Self::MouseSgr => "\x1b[?1006h".to_owned(),
            Self::MousePixels => "\x1b[?1016h".to_owned(),
            Self::Keyboard => ansi_sequence(event::PushKeyboardEnhancementFlags(KEYBOARD)) + KEYBOARD_QUERY,
        }
    }

    fn off_sequence(self) -> String {
        match self {
            Self::AlternateScreen => ansi_sequence(terminal::LeaveAlternateScreen),
            Self::Colors => ansi_sequence(style::ResetColor),
            Self::HiddenCursor => ansi_sequence(cursor::Show),
            Self::BracketedPaste => ansi_sequence(event::DisableBracketedPaste),
            Self::FocusChange => ansi_sequence(event::DisableFocusChange),
            Self::Mouse => "\x1b[?1002l".to_owned(),
            Self::MouseSgr => "\x1b[?1006l".to_owned(),
            Self::MousePixels => "\x1b[?1016l".to_owned(),
            Self::Keyboard => ansi_sequence(event::PopKeyboardEnhancementFlags),
        }
    }
}

/// The modes that are switched on, oldest first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TerminalModes {
    on: Vec<TerminalMode>,
}

impl TerminalModes {
    /// Records a mode as on and appends the bytes that switch it on.
    ///
    /// Appends nothing if it is on already.
    ///
    /// Call this before sending the bytes, so that a mode whose bytes were sent in part is switched off too.
    pub fn switch_on(&mut self, mode: TerminalMode, bytes: &mut Vec<u8>) {
        if !self.is_on(mode) {
            self.on.push(mode);
            bytes.extend_from_slice(mode.on_sequence().as_bytes());
        }
    }

    /// Returns whether a mode is on.
    pub fn is_on(&self, mode: TerminalMode) -> bool {
        self.on.contains(&mode)
    }

    /// Appends the bytes that switch all modes off, newest first.
    pub fn switch_all_off(&mut self, bytes: &mut Vec<u8>) {
        // In reverse order, so that each mode is switched off in the state in which it was switched on.
        for mode in self.on.drain(..).rev() {
            bytes.extend_from_slice(mode.off_sequence().as_bytes());
        }
    }
}

/// Returns the escape sequence of a crossterm command.
fn ansi_sequence(command: impl Command) -> String {
    let mut text = String::new();
    command.write_ansi(&mut text).expect("writing to memory does not fail");
    text
}

#[cfg(all(test, unit_tests))]
mod tests;
