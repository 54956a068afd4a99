//! A key that something can be bound to, and how a person writes it.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::fmt;

/// A key: its code, as the terminal's user types it (`?`, not Shift and `/`), and whether Ctrl is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// Which one. A letter may be a capital, but not with Ctrl.
    pub code: KeyCode,
    /// With Ctrl.
    pub ctrl: bool,
}

/// What keys without a character of their own are called.
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
    /// The key that types this character.
    pub const fn letter(c: char) -> Self {
        Self { code: KeyCode::Char(c), ctrl: false }
    }

    /// The key of this small letter, with Ctrl.
    pub const fn ctrl(c: char) -> Self {
        Self { code: KeyCode::Char(c), ctrl: true }
    }

    /// A key without a character of its own.
    pub const fn named(code: KeyCode) -> Self {
        Self { code, ctrl: false }
    }

    /// The key that a person calls so: a character, `Ctrl-` and a letter, or a name such as `PageUp`, `Space` or `F1`.
    /// Nothing where plain terminals send no such key: [`is_plain`](Self::is_plain).
    pub fn from_name(name: &str) -> Option<Self> {
        let key = match name.strip_prefix(CTRL) {
            Some(letter) => Self { ctrl: true, ..Self::from_bare_name(&letter.to_ascii_lowercase())? },
            None => Self::from_bare_name(name)?,
        };
        key.is_plain().then_some(key)
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

    /// What keys without a character of their own are called.
    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        NAMED.iter().map(|&(name, _)| name).chain([SPACE])
    }

    /// Whether every terminal sends it, as itself: none without the kitty keyboard protocol can tell Ctrl-I from Tab,
    /// nor Ctrl and an arrow from the arrow.
    pub fn is_plain(self) -> bool {
        match self.code {
            // Ctrl-H is Backspace, I is Tab, J and M are Enter.
            KeyCode::Char(c) if self.ctrl => c.is_ascii_lowercase() && !matches!(c, 'h' | 'i' | 'j' | 'm'),
            KeyCode::Char(c) => !c.is_control(),
            KeyCode::F(1..=12) => !self.ctrl,
            code => !self.ctrl && NAMED.iter().any(|&(_, named)| named == code),
        }
    }

    /// What a plain terminal tells when it is pressed.
    pub fn pressed(self) -> KeyEvent {
        KeyEvent::new(self.code, if self.ctrl { KeyModifiers::CONTROL } else { KeyModifiers::NONE })
    }

    /// What was typed.
    pub(super) fn typed(event: &KeyEvent) -> Self {
        let shift = event.modifiers.contains(KeyModifiers::SHIFT);
        let ctrl = event.modifiers.contains(KeyModifiers::CONTROL);
        let code = match event.code {
            KeyCode::Char(c) if ctrl => KeyCode::Char(c.to_ascii_lowercase()),
            // A terminal that does not tell what Shift makes of a key: it is so on most keyboards.
            KeyCode::Char('/') if shift => KeyCode::Char('?'),
            KeyCode::Char(c) if shift => KeyCode::Char(c.to_ascii_uppercase()),
            code => code,
        };
        Self { code, ctrl }
    }

    /// A capital is its letter with Shift.
    pub(super) fn without_shift(self) -> Self {
        Self { code: unshifted(self.code), ..self }
    }
}

/// A terminal sends a capital; a capital is its letter with Shift.
pub(super) fn unshifted(code: KeyCode) -> KeyCode {
    match code {
        KeyCode::Char(c) => KeyCode::Char(c.to_ascii_lowercase()),
        code => code,
    }
}

/// As [`Key::from_name`] reads it.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_as_they_are_written() {
        let characters = (' '..='~').map(Key::letter);
        let with_ctrl = ('a'..='z').map(Key::ctrl).filter(|key| key.is_plain());
        let named = NAMED.map(|(_, code)| Key::named(code));
        let functions = (1..=12).map(|number| Key::named(KeyCode::F(number)));
        for key in characters.chain(with_ctrl).chain(named).chain(functions) {
            assert_eq!(Key::from_name(&key.to_string()), Some(key), "{key}");
        }
        assert_eq!(Key::from_name("Ctrl-l"), Some(Key::ctrl('l')));
        assert_eq!(Key::from_name("é"), Some(Key::letter('é')));
    }

    #[test]
    fn keys_that_only_some_terminals_send_are_none() {
        for name in
            ["", "Ctrl-", "Ctrl-I", "Ctrl-H", "Ctrl-Left", "Ctrl-1", "F13", "F0", "Shift-w", "ww", "\u{1b}", "left"]
        {
            assert_eq!(Key::from_name(name), None, "{name}");
        }
    }
}
