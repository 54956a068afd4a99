//! What each key does, mode by mode: one table.

use super::command::{Command, Direction, Side, Toward};
use super::key::Key;
use crate::export::Format;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// What the keys are for. Several modes hold at a time, the topmost first: what one does not bind is left to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// The eye flies.
    Fly,
    /// The eye goes around what it looks at.
    Orbit,
    /// A pixel is explained; above fly or orbit.
    Explain,
    /// A light is held; above all of these.
    Light,
    /// The user is asked what the picture is to be written as; a key that does not answer takes the question away.
    Export,
    /// The user is asked whether the view is to be written into the scene's file; likewise.
    Keep,
    /// Below fly or orbit, whichever it is.
    Always,
}

impl Mode {
    /// All of them, in the order of the help.
    pub const ALL: [Self; 7] =
        [Self::Fly, Self::Orbit, Self::Explain, Self::Light, Self::Export, Self::Keep, Self::Always];

    /// What it is called where a person binds keys.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fly => "fly",
            Self::Orbit => "orbit",
            Self::Explain => "explain",
            Self::Light => "light",
            Self::Export => "export",
            Self::Keep => "keep",
            Self::Always => "always",
        }
    }

    /// Whether the command can mean anything in it: answers are for questions.
    pub fn takes(self, command: Command) -> bool {
        match self {
            Self::Export => matches!(command, Command::Write(_) | Command::No),
            Self::Keep => matches!(command, Command::Yes | Command::No),
            _ => !command.answers(),
        }
    }

    /// The mode of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }
}

/// Keys of a mode, and what they do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// When.
    pub mode: Mode,
    /// Each of them does it. None: it cannot be asked for.
    pub keys: Vec<Key>,
    /// What they do.
    pub command: Command,
}

impl Binding {
    /// How the help writes the keys.
    pub fn label(&self) -> String {
        self.keys.iter().map(Key::to_string).collect::<Vec<_>>().join(" ")
    }
}

/// What all keys do: the one table that is asked when a key is pressed, and that the help shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bindings {
    rows: Vec<Binding>,
}

/// Those that the program comes with.
impl Default for Bindings {
    fn default() -> Self {
        let row = |&(mode, keys, command): &Row| Binding { mode, keys: keys.to_vec(), command };
        let write = |&format: &Format| Binding {
            mode: Mode::Export,
            keys: vec![letter(format.key())],
            command: Command::Write(format),
        };
        Self { rows: Format::ALL.iter().map(write).chain(BUILT_IN.iter().map(row)).collect() }
    }
}

type Row = (Mode, &'static [Key], Command);

const fn letter(c: char) -> Key {
    Key::letter(c)
}

const LEFT: &[Key] = &[Key::named(KeyCode::Left), letter('h')];
const RIGHT: &[Key] = &[Key::named(KeyCode::Right), letter('l')];
const UP: &[Key] = &[Key::named(KeyCode::Up), letter('k')];
const DOWN: &[Key] = &[Key::named(KeyCode::Down), letter('j')];
const HIGHER: &[Key] = &[letter('e'), Key::named(KeyCode::PageUp)];
const LOWER: &[Key] = &[letter('c'), Key::named(KeyCode::PageDown)];

/// In the order of the help. What writes a picture is bound to the keys of the [`Format`]s, before them.
const BUILT_IN: &[Row] = &[
    (Mode::Fly, &[letter('w')], Command::Move(Direction::Forward)),
    (Mode::Fly, &[letter('s')], Command::Move(Direction::Back)),
    (Mode::Fly, &[letter('a')], Command::Move(Direction::Left)),
    (Mode::Fly, &[letter('d')], Command::Move(Direction::Right)),
    (Mode::Fly, HIGHER, Command::Move(Direction::Up)),
    (Mode::Fly, LOWER, Command::Move(Direction::Down)),
    (Mode::Fly, LEFT, Command::Look(Toward::Left)),
    (Mode::Fly, RIGHT, Command::Look(Toward::Right)),
    (Mode::Fly, UP, Command::Look(Toward::Up)),
    (Mode::Fly, DOWN, Command::Look(Toward::Down)),
    (Mode::Orbit, LEFT, Command::Around(Toward::Left)),
    (Mode::Orbit, RIGHT, Command::Around(Toward::Right)),
    (Mode::Orbit, UP, Command::Around(Toward::Up)),
    (Mode::Orbit, DOWN, Command::Around(Toward::Down)),
    (Mode::Orbit, &[letter('w')], Command::Nearer),
    (Mode::Orbit, &[letter('s')], Command::Farther),
    (Mode::Orbit, &[letter('a')], Command::Move(Direction::Left)),
    (Mode::Orbit, &[letter('d')], Command::Move(Direction::Right)),
    (Mode::Orbit, HIGHER, Command::Move(Direction::Up)),
    (Mode::Orbit, LOWER, Command::Move(Direction::Down)),
    (Mode::Explain, &[Key::named(KeyCode::Left)], Command::Point(Toward::Left)),
    (Mode::Explain, &[Key::named(KeyCode::Right)], Command::Point(Toward::Right)),
    (Mode::Explain, &[Key::named(KeyCode::Up)], Command::Point(Toward::Up)),
    (Mode::Explain, &[Key::named(KeyCode::Down)], Command::Point(Toward::Down)),
    (Mode::Explain, &[Key::named(KeyCode::PageUp)], Command::ScrollUp),
    (Mode::Explain, &[Key::named(KeyCode::PageDown)], Command::ScrollDown),
    (Mode::Light, &[Key::named(KeyCode::Left)], Command::MoveLight(Toward::Left)),
    (Mode::Light, &[Key::named(KeyCode::Right)], Command::MoveLight(Toward::Right)),
    (Mode::Light, &[Key::named(KeyCode::Up)], Command::MoveLight(Toward::Up)),
    (Mode::Light, &[Key::named(KeyCode::Down)], Command::MoveLight(Toward::Down)),
    (Mode::Light, &[Key::named(KeyCode::PageUp)], Command::LightFarther),
    (Mode::Light, &[Key::named(KeyCode::PageDown)], Command::LightNearer),
    (Mode::Light, &[letter('r')], Command::LightBack),
    (Mode::Export, &[Key::named(KeyCode::Esc)], Command::No),
    (Mode::Keep, &[letter('y')], Command::Yes),
    (Mode::Keep, &[letter('n'), Key::named(KeyCode::Esc)], Command::No),
    (Mode::Always, &[Key::named(KeyCode::Tab)], Command::ChangeMode),
    (Mode::Always, &[letter('f')], Command::Frame),
    (Mode::Always, &[letter('[')], Command::Narrower),
    (Mode::Always, &[letter(']')], Command::Wider),
    (Mode::Always, &[letter('t')], Command::Turntable),
    (Mode::Always, &[letter('1')], Command::View(1)),
    (Mode::Always, &[letter('2')], Command::View(2)),
    (Mode::Always, &[letter('3')], Command::View(3)),
    (Mode::Always, &[letter('4')], Command::View(4)),
    (Mode::Always, &[letter('5')], Command::View(5)),
    (Mode::Always, &[letter('6')], Command::View(6)),
    (Mode::Always, &[letter('7')], Command::View(7)),
    (Mode::Always, &[letter('8')], Command::View(8)),
    (Mode::Always, &[letter('9')], Command::View(9)),
    (Mode::Always, &[letter('m')], Command::SaveView),
    (Mode::Always, &[letter('r')], Command::Reset),
    (Mode::Always, &[letter('v')], Command::NextMap),
    (Mode::Always, &[letter('b')], Command::LastMap),
    (Mode::Always, &[letter('|')], Command::Compare),
    (Mode::Always, &[letter('<')], Command::Wipe(Side::Left)),
    (Mode::Always, &[letter('>')], Command::Wipe(Side::Right)),
    (Mode::Always, &[letter('n')], Command::NextScene),
    (Mode::Always, &[letter('p')], Command::LastScene),
    (Mode::Always, &[letter('o')], Command::Export),
    (Mode::Always, &[letter('y')], Command::CopyCamera),
    (Mode::Always, &[letter('Y')], Command::KeepView),
    (Mode::Always, &[letter('x')], Command::Explain),
    (Mode::Always, &[letter('g')], Command::Light),
    (Mode::Always, &[letter('i')], Command::Status),
    (Mode::Always, &[letter('?')], Command::Help),
    (Mode::Always, &[Key::named(KeyCode::Esc)], Command::Close),
    (Mode::Always, &[Key::ctrl('l')], Command::Redraw),
    (Mode::Always, &[Key::ctrl('z')], Command::Suspend),
    (Mode::Always, &[letter('q'), Key::ctrl('c')], Command::Quit),
];

impl Bindings {
    /// What each mode binds, in the order of the help.
    pub fn rows(&self) -> &[Binding] {
        &self.rows
    }

    /// What one mode binds.
    pub fn of(&self, mode: Mode) -> impl Iterator<Item = &Binding> {
        self.rows.iter().filter(move |row| row.mode == mode)
    }

    /// From now on the key does that in that mode, or nothing; whatever it did before.
    pub fn bind(&mut self, mode: Mode, key: Key, command: Option<Command>) {
        for row in self.rows.iter_mut().filter(|row| row.mode == mode) {
            row.keys.retain(|bound| *bound != key);
        }
        let Some(command) = command else { return };
        match self.rows.iter_mut().find(|row| (row.mode, row.command) == (mode, command)) {
            Some(row) => row.keys.push(key),
            None => self.rows.push(Binding { mode, keys: vec![key], command }),
        }
    }

    /// What the key means in these modes, the topmost first, and whether Shift asks for more of it.
    pub fn command(&self, modes: &[Mode], event: &KeyEvent) -> Option<(Command, bool)> {
        // Keys of the window manager: only terminals that tell of everything tell of them.
        if event.modifiers.intersects(KeyModifiers::SUPER | KeyModifiers::HYPER | KeyModifiers::META) {
            return None;
        }
        let typed = Key::typed(event);
        let has_character = matches!(typed.code, KeyCode::Char(_));
        let shift = event.modifiers.contains(KeyModifiers::SHIFT) && !has_character;
        modes.iter().find_map(|&mode| {
            let exactly = self.bound(mode, typed).map(|command| (command, shift && command.has_faster()));
            // A capital that is not bound itself is its letter with Shift.
            let with_shift = || self.bound(mode, typed.without_shift()).filter(|command| command.has_faster());
            exactly.or_else(|| with_shift().map(|command| (command, true)))
        })
    }

    /// A key that does it in these modes, if one does: the first, and one without Ctrl where there is any.
    pub fn key_of(&self, modes: &[Mode], command: Command) -> Option<Key> {
        let rows = modes.iter().flat_map(|&mode| self.of(mode)).filter(|row| row.command == command);
        let does = |key: &&Key| self.command(modes, &key.pressed()).is_some_and(|(meant, _)| meant == command);
        rows.flat_map(|row| &row.keys).filter(does).min_by_key(|key| key.ctrl).copied()
    }

    fn bound(&self, mode: Mode, key: Key) -> Option<Command> {
        self.of(mode).find(|row| row.keys.contains(&key)).map(|row| row.command)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    const FLY: &[Mode] = &[Mode::Fly, Mode::Always];

    fn press(c: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(c), KeyModifiers::NONE)
    }

    fn meant(event: &KeyEvent) -> Option<(Command, bool)> {
        Bindings::default().command(FLY, event)
    }

    /// The keys of what holds at the same time, and is not meant to hide what is below it.
    fn keys_of(bindings: &Bindings, modes: &[Mode]) -> Vec<Key> {
        let rows = modes.iter().flat_map(|&mode| bindings.of(mode));
        rows.flat_map(|row| row.keys.iter().copied()).collect()
    }

    #[test]
    fn no_two_bindings_collide() {
        let bindings = Bindings::default();
        for modes in
            [FLY, &[Mode::Orbit, Mode::Always], &[Mode::Explain], &[Mode::Light], &[Mode::Export], &[Mode::Keep]]
        {
            let mut seen = HashSet::new();
            for key in keys_of(&bindings, modes) {
                assert!(seen.insert(key), "{key} is bound twice in {modes:?}");
            }
            // Shift makes movement faster: no other command may be the capital of one of its letters.
            let rows = modes.iter().flat_map(|&mode| bindings.of(mode)).filter(|row| row.command.has_faster());
            for key in rows.flat_map(|row| &row.keys) {
                if let KeyCode::Char(c) = key.code {
                    assert!(!seen.contains(&Key::letter(c.to_ascii_uppercase())), "Shift-{key} in {modes:?}");
                }
            }
        }
    }

    #[test]
    fn no_binding_needs_a_key_that_plain_terminals_do_not_send() {
        for key in keys_of(&Bindings::default(), &Mode::ALL) {
            assert!(key.is_plain(), "{key}");
        }
    }

    #[test]
    fn each_mode_has_a_name_and_keys() {
        for mode in Mode::ALL {
            assert_eq!(Mode::from_name(mode.name()), Some(mode));
            assert!(Bindings::default().of(mode).count() > 0, "{mode:?}");
        }
    }

    #[test]
    fn keys_mean_what_the_table_says() {
        let with = |code, modifiers| meant(&KeyEvent::new(code, modifiers));
        let fast = |code| with(code, KeyModifiers::SHIFT);
        assert_eq!(meant(&press('w')), Some((Command::Move(Direction::Forward), false)));
        assert_eq!(meant(&press('W')), Some((Command::Move(Direction::Forward), true)));
        assert_eq!(fast(KeyCode::Char('W')), Some((Command::Move(Direction::Forward), true)));
        assert_eq!(fast(KeyCode::Char('w')), Some((Command::Move(Direction::Forward), true)));
        assert_eq!(fast(KeyCode::Left), Some((Command::Look(Toward::Left), true)));
        assert_eq!(fast(KeyCode::PageUp), Some((Command::Move(Direction::Up), true)));
        assert_eq!(meant(&press('?')), Some((Command::Help, false)));
        assert_eq!(fast(KeyCode::Char('?')), Some((Command::Help, false)), "however it is typed");
        assert_eq!(
            fast(KeyCode::Char('/')),
            Some((Command::Help, false)),
            "a terminal that tells only where the key is"
        );
        assert_eq!(meant(&press('/')), None);
        assert_eq!(fast(KeyCode::Char('y')), Some((Command::KeepView, false)));
        assert_eq!(meant(&press('R')), None, "a capital that moves nothing is free");
        for modifiers in [KeyModifiers::SUPER, KeyModifiers::HYPER, KeyModifiers::META] {
            assert_eq!(meant(&KeyEvent { modifiers, ..press('q') }), None, "the window manager's");
        }
        assert_eq!(with(KeyCode::Char('w'), KeyModifiers::CONTROL), None);
        assert_eq!(with(KeyCode::Char('c'), KeyModifiers::CONTROL), Some((Command::Quit, false)));
    }

    #[test]
    fn each_format_has_a_key_and_a_command() {
        for &format in Format::ALL {
            let command = Command::Write(format);
            assert_eq!(Bindings::default().command(&[Mode::Export], &press(format.key())), Some((command, false)));
            assert_eq!(Command::from_name(format.command()), Some(command));
        }
    }

    #[test]
    fn what_a_mode_does_not_bind_is_left_to_the_next() {
        let bindings = Bindings::default();
        let explain = [Mode::Explain, Mode::Orbit, Mode::Always];
        let code = |code: KeyCode| bindings.command(&explain, &code.into()).map(|(command, _)| command);
        assert_eq!(code(KeyCode::Left), Some(Command::Point(Toward::Left)));
        assert_eq!(code(KeyCode::Char('h')), Some(Command::Around(Toward::Left)));
        assert_eq!(code(KeyCode::Char('q')), Some(Command::Quit));
        assert_eq!(bindings.command(&[Mode::Keep], &press('q')), None);
    }

    #[test]
    fn keys_are_bound_anew() {
        let mut bindings = Bindings::default();
        bindings.bind(Mode::Fly, Key::letter('w'), Some(Command::Move(Direction::Back)));
        bindings.bind(Mode::Fly, Key::letter('W'), Some(Command::Nearer));
        bindings.bind(Mode::Always, Key::letter('x'), None);
        let command = |c| bindings.command(FLY, &press(c)).map(|(command, _)| command);
        assert_eq!(
            [command('w'), command('s'), command('W')],
            [Some(Command::Move(Direction::Back)), Some(Command::Move(Direction::Back)), Some(Command::Nearer)]
        );
        assert_eq!(command('x'), None);
    }
}
