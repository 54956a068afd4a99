//! The keys of the keymap, and their names.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::fmt;

/// A key of the keymap: the character as typed (`?`, not Shift and `/`) or another key code, and
/// whether Ctrl is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// The key code. A letter may be a capital, but not with Ctrl.
    pub code: KeyCode,
    /// Whether Ctrl is held.
    pub ctrl: bool,
}

/// Names of the keys that type no character.
// Spelt as on keyboards and in other programs. Case matters, so that files and help have a single spelling.
const NAMED: [(&str, KeyCode); 14] = [
    ("Left", KeyCode::Left),
    ("Right", KeyCode::Right),
    ("Up", KeyCode::Up),
    ("Down", KeyCode::Down),
    ("PageUp", KeyCode::PageUp),
    ("PageDown", KeyCode::PageDown),
    ("Home", KeyCode::Home),
    ("End", KeyCode::End),
    ("Insert", KeyCode::Insert),
    ("Delete", KeyCode::Delete),
    ("Enter", KeyCode::Enter),
    ("Tab", KeyCode::Tab),
    ("Backspace", KeyCode::Backspace),
    ("Esc", KeyCode::Esc),
];

const SPACE: &str = "Space";
const CTRL: &str = "Ctrl-";

impl Key {
    /// Returns the key that types the character `c`.
    pub const fn letter(c: char) -> Self {
        Self { code: KeyCode::Char(c), ctrl: false }
    }

    /// Returns the key of the lower-case letter `c` with Ctrl.
    pub const fn ctrl(c: char) -> Self {
        Self { code: KeyCode::Char(c), ctrl: true }
    }

    /// Returns the key with this code, without Ctrl.
    pub const fn named(code: KeyCode) -> Self {
        Self { code, ctrl: false }
    }

    /// Parses a key: a character, `Ctrl-` and a letter, or a name such as `PageUp`, `Space` or
    /// `F1`.
    ///
    /// `None` for an unknown name, and for a key that not every terminal sends (see
    /// [`is_unambiguous`](Self::is_unambiguous)).
    pub fn from_name(name: &str) -> Option<Self> {
        // `Ctrl-L` and `Ctrl-l` are the same key: the control character has no case.
        let key = match name.strip_prefix(CTRL) {
            Some(letter) => Self { ctrl: true, ..Self::from_bare_name(&letter.to_ascii_lowercase())? },
            None => Self::from_bare_name(name)?,
        };
        key.is_unambiguous().then_some(key)
    }

    fn from_bare_name(name: &str) -> Option<Self> {
        let mut chars = name.chars();
        if let (Some(c), None) = (chars.next(), chars.next()) {
            return Some(Self::letter(c));
        }
        let function =
            || name.strip_prefix('F')?.parse().ok().filter(|number| (1..=12).contains(number)).map(KeyCode::F);
        let named = || NAMED.iter().find(|(known, _)| *known == name).map(|&(_, code)| code);
        let code = if name == SPACE { Some(KeyCode::Char(' ')) } else { named().or_else(function) };
        code.map(Self::named)
    }

    /// Returns the names of keys, to suggest the closest one for a misspelt name.
    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        NAMED.iter().map(|&(name, _)| name).chain([SPACE])
    }

    /// Returns whether every terminal sends the key unambiguously.
    ///
    /// Without the kitty keyboard protocol, terminals send the same byte for Ctrl-I and Tab, and some send the same
    /// sequence for an arrow with and without Ctrl.
    pub fn is_unambiguous(self) -> bool {
        match self.code {
            // Ctrl with H, I, J or M sends the same byte as Backspace, Tab or Enter.
            KeyCode::Char(c) if self.ctrl => c.is_ascii_lowercase() && !matches!(c, 'h' | 'i' | 'j' | 'm'),
            KeyCode::Char(c) => !c.is_control(),
            // F13 and up have no common encoding.
            KeyCode::F(1..=12) => !self.ctrl,
            code => !self.ctrl && NAMED.iter().any(|&(_, named)| named == code),
        }
    }

    /// Returns the event of a press of the key on a terminal without the kitty keyboard protocol.
    pub fn pressed(self) -> KeyEvent {
        KeyEvent::new(self.code, if self.ctrl { KeyModifiers::CONTROL } else { KeyModifiers::NONE })
    }

    /// Returns the key of an event. If the terminal reports a character and Shift separately, the
    /// result is the shifted character: the capital letter, or `?` for `/`, as on most layouts.
    pub(super) fn typed(event: &KeyEvent) -> Self {
        let shift = event.modifiers.contains(KeyModifiers::SHIFT);
        let ctrl = event.modifiers.contains(KeyModifiers::CONTROL);
        let code = match event.code {
            // With Ctrl both cases are one key: without the kitty protocol, terminals send the same byte for them.
            KeyCode::Char(c) if ctrl => KeyCode::Char(c.to_ascii_lowercase()),
            KeyCode::Char('/') if shift => KeyCode::Char('?'),
            KeyCode::Char(c) if shift => KeyCode::Char(c.to_ascii_uppercase()),
            code => code,
        };
        Self { code, ctrl }
    }

    /// Returns the key with a capital letter replaced by the lower-case one.
    pub(super) fn without_shift(self) -> Self {
        Self { code: unshifted(self.code), ..self }
    }
}

/// Returns the code with a capital letter, which terminals send for Shift and a letter, replaced by
/// the lower-case one.
pub(super) fn unshifted(code: KeyCode) -> KeyCode {
    match code {
        KeyCode::Char(c) => KeyCode::Char(c.to_ascii_lowercase()),
        code => code,
    }
}

/// Writes the name that [`Key::from_name`] parses.
impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.code {
            KeyCode::Char(c) if self.ctrl => write!(f, "{CTRL}{}", c.to_ascii_uppercase()),
            KeyCode::Char(' ') => f.pad(SPACE),
            KeyCode::Char(c) => write!(f, "{c}"),
            KeyCode::F(number) => write!(f, "F{number}"),
            code => match NAMED.iter().find(|(_, named)| *named == code) {
                Some((name, _)) => f.pad(name),
                None => write!(f, "{code:?}"),
            },
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
