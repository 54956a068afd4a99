//! What each key does: one table.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// What a key can mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// The eye moves while the key is held.
    Move(Direction),
    /// The view turns while the key is held.
    Look(Turn),
    /// Back to the view at the start.
    Reset,
    /// The next of several scenes.
    NextScene,
    /// The one before.
    LastScene,
    /// The camera, as a line for a scene file, into the clipboard.
    CopyCamera,
    /// The view into the scene file's list of them.
    KeepView,
    /// The picture into a file.
    Export,
    /// The status line on or off.
    Status,
    /// The help on or off.
    Help,
    /// The help off.
    Close,
    /// The next view of the scene.
    NextView,
    /// The view before.
    LastView,
    /// Two views side by side, with a line between them, or one again.
    Compare,
    /// The line between two views moves.
    Wipe(Side),
    /// The explanation of a pixel on or off.
    Explain,
    /// The whole screen again, in case something else wrote on it.
    Redraw,
    /// Back to the shell, to come again.
    Suspend,
    /// Out.
    Quit,
}

impl Command {
    /// Whether it goes on as long as its key is held.
    pub fn moves(self) -> bool {
        matches!(self, Self::Move(_) | Self::Look(_))
    }
}

/// A direction as the camera sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along the view.
    Forward,
    /// Against it.
    Back,
    /// Against u.
    Left,
    /// Along u.
    Right,
    /// Along up.
    Up,
    /// Against up.
    Down,
}

/// A side of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

/// Where the view turns to, as the camera sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// About up.
    Left,
    /// About up.
    Right,
    /// About u.
    Up,
    /// About u.
    Down,
}

/// Keys and what they do: the one table that is asked when a key is pressed, and that the help shows.
pub struct Binding {
    /// The keys, each of which does it.
    pub keys: &'static [Key],
    /// How the help writes the keys.
    pub label: &'static str,
    /// What they do.
    pub command: Command,
    /// What the help says of it.
    pub does: &'static str,
}

/// A key: its code, as typed without Shift, and whether Ctrl is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// Which one.
    pub code: KeyCode,
    /// With Ctrl.
    pub ctrl: bool,
}

const fn letter(c: char) -> Key {
    Key { code: KeyCode::Char(c), ctrl: false }
}

const fn ctrl(c: char) -> Key {
    Key { code: KeyCode::Char(c), ctrl: true }
}

const fn named(code: KeyCode) -> Key {
    Key { code, ctrl: false }
}

const fn binding(keys: &'static [Key], label: &'static str, command: Command, does: &'static str) -> Binding {
    Binding { keys, label, command, does }
}

/// All bindings, in the order of the help.
pub const BINDINGS: &[Binding] = &[
    binding(&[letter('w')], "w", Command::Move(Direction::Forward), "move forward"),
    binding(&[letter('s')], "s", Command::Move(Direction::Back), "move back"),
    binding(&[letter('a')], "a", Command::Move(Direction::Left), "move left"),
    binding(&[letter('d')], "d", Command::Move(Direction::Right), "move right"),
    binding(&[letter('e'), named(KeyCode::PageUp)], "e PageUp", Command::Move(Direction::Up), "move up"),
    binding(&[letter('c'), named(KeyCode::PageDown)], "c PageDown", Command::Move(Direction::Down), "move down"),
    binding(&[named(KeyCode::Left), letter('h')], "Left h", Command::Look(Turn::Left), "look left"),
    binding(&[named(KeyCode::Right), letter('l')], "Right l", Command::Look(Turn::Right), "look right"),
    binding(&[named(KeyCode::Up), letter('k')], "Up k", Command::Look(Turn::Up), "look up"),
    binding(&[named(KeyCode::Down), letter('j')], "Down j", Command::Look(Turn::Down), "look down"),
    binding(&[letter('r')], "r", Command::Reset, "back to the first view"),
    binding(&[letter('v')], "v", Command::NextView, "next view: depth ..."),
    binding(&[letter('b')], "b", Command::LastView, "the view before"),
    binding(&[letter('|')], "|", Command::Compare, "compare two views"),
    binding(&[letter('<')], "<", Command::Wipe(Side::Left), "their line to the left"),
    binding(&[letter('>')], ">", Command::Wipe(Side::Right), "their line to the right"),
    binding(&[letter('n')], "n", Command::NextScene, "next scene"),
    binding(&[letter('p')], "p", Command::LastScene, "scene before"),
    binding(&[letter('o')], "o", Command::Export, "picture to a file"),
    binding(&[letter('y')], "y", Command::CopyCamera, "copy the camera"),
    binding(&[letter('Y')], "Y", Command::KeepView, "view into the scene file"),
    binding(&[letter('x')], "x", Command::Explain, "explain a pixel's ray"),
    binding(&[letter('i')], "i", Command::Status, "status line"),
    binding(&[letter('?')], "?", Command::Help, "this help"),
    binding(&[named(KeyCode::Esc)], "Esc", Command::Close, "close it"),
    binding(&[ctrl('l')], "Ctrl-L", Command::Redraw, "draw the screen again"),
    binding(&[ctrl('z')], "Ctrl-Z", Command::Suspend, "to the shell; fg comes back"),
    binding(&[letter('q'), ctrl('c')], "q Ctrl-C", Command::Quit, "leave"),
];

/// What the key means, and whether Shift makes it faster.
pub fn command(key: &KeyEvent) -> Option<(Command, bool)> {
    let shift = key.modifiers.contains(KeyModifiers::SHIFT);
    let ctrl = key.modifiers.contains(KeyModifiers::CONTROL);
    // Keys of the window manager: only terminals that tell of everything tell of them.
    if key.modifiers.intersects(KeyModifiers::SUPER | KeyModifiers::HYPER | KeyModifiers::META) {
        return None;
    }
    let code = match unshifted(key.code) {
        // A terminal that does not tell what Shift makes of a key: it is so on most keyboards.
        KeyCode::Char('/') if shift => KeyCode::Char('?'),
        code => code,
    };
    let capital = code != key.code || shift;
    if let (KeyCode::Char(letter), true) = (code, capital)
        && let Some(own) = bound(Key { code: KeyCode::Char(letter.to_ascii_uppercase()), ctrl })
        && letter.is_ascii_lowercase()
    {
        return Some((own.command, false));
    }
    let found = bound(Key { code, ctrl })?;
    let moves = found.command.moves();
    // Capitals of letters that do not move are free for other commands.
    let is_letter = matches!(code, KeyCode::Char(c) if c.is_ascii_lowercase());
    (moves || ctrl || !is_letter || !capital).then_some((found.command, moves && capital))
}

fn bound(key: Key) -> Option<&'static Binding> {
    BINDINGS.iter().find(|binding| binding.keys.contains(&key))
}

/// A terminal sends a capital; a capital is its letter with Shift.
pub(super) fn unshifted(code: KeyCode) -> KeyCode {
    match code {
        KeyCode::Char(c) => KeyCode::Char(c.to_ascii_lowercase()),
        code => code,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    fn press(c: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(c), KeyModifiers::NONE)
    }

    #[test]
    fn no_key_is_bound_twice() {
        let mut seen = HashSet::new();
        for key in BINDINGS.iter().flat_map(|binding| binding.keys) {
            assert!(seen.insert(format!("{key:?}")), "{key:?} is bound twice");
        }
        // Shift makes movement faster: no other command may be the capital of one of its letters.
        for binding in BINDINGS.iter().filter(|binding| binding.command.moves()) {
            for key in binding.keys {
                if let KeyCode::Char(letter) = key.code {
                    let capital = Key { code: KeyCode::Char(letter.to_ascii_uppercase()), ctrl: key.ctrl };
                    assert!(!BINDINGS.iter().any(|other| other.keys.contains(&capital)), "{capital:?}");
                }
            }
        }
    }

    #[test]
    fn keys_mean_what_the_table_says() {
        let fast = |code| command(&KeyEvent::new(code, KeyModifiers::SHIFT));
        assert_eq!(command(&press('w')), Some((Command::Move(Direction::Forward), false)));
        assert_eq!(command(&press('W')), Some((Command::Move(Direction::Forward), true)));
        assert_eq!(fast(KeyCode::Char('W')), Some((Command::Move(Direction::Forward), true)));
        assert_eq!(fast(KeyCode::Left), Some((Command::Look(Turn::Left), true)));
        assert_eq!(fast(KeyCode::PageUp), Some((Command::Move(Direction::Up), true)));
        assert_eq!(command(&press('?')), Some((Command::Help, false)));
        assert_eq!(fast(KeyCode::Char('?')), Some((Command::Help, false)), "however it is typed");
        assert_eq!(
            fast(KeyCode::Char('/')),
            Some((Command::Help, false)),
            "a terminal that tells only where the key is"
        );
        assert_eq!(command(&press('/')), None);
        assert_eq!(command(&press('R')), None, "a capital that moves nothing is free");
        for modifiers in [KeyModifiers::SUPER, KeyModifiers::HYPER, KeyModifiers::META] {
            assert_eq!(command(&KeyEvent { modifiers, ..press('q') }), None, "the window manager's");
        }
        assert_eq!(command(&KeyEvent::new(KeyCode::Char('w'), KeyModifiers::CONTROL)), None);
        assert_eq!(command(&KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)), Some((Command::Quit, false)));
    }
}
