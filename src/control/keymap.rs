//! The keymap: for each mode, the commands of its keys.

use super::command::{Command, Direction, ScreenSide, Toward};
use super::key::Key;
use crate::export::Format;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::sync::Arc;

/// A mode, in which keys have commands of their own.
///
/// Several modes are active at a time. A key that the topmost one does not bind is looked up in the next one below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KeyMode {
    /// Keys fly the eye.
    Fly,
    /// Keys orbit the eye about the target.
    Orbit,
    /// The explanation of a pixel is open. This mode is above `Fly` and `Orbit`.
    Explain,
    /// A light is selected for moving. This mode is above `Fly`, `Orbit` and `Explain`.
    Light,
    /// Image order and object order are compared. This mode is above `Fly` and `Orbit`.
    Orders,
    /// A dialog asks for the format of an export. Any key without an answer dismisses it.
    Export,
    /// A dialog asks whether to save the view to the scene file.
    ///
    /// Any key without an answer dismisses it.
    Keep,
    /// Always active, below `Fly` and `Orbit`.
    Always,
}

impl KeyMode {
    /// All modes, in the order of the help.
    pub const ALL: [Self; 8] =
        [Self::Fly, Self::Orbit, Self::Explain, Self::Light, Self::Orders, Self::Export, Self::Keep, Self::Always];

    /// Returns the name of the mode in the user's keymap and in panels.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fly => "fly",
            Self::Orbit => "orbit",
            Self::Explain => "explain",
            Self::Light => "light",
            Self::Orders => "orders",
            Self::Export => "export",
            Self::Keep => "keep",
            Self::Always => "always",
        }
    }

    /// Returns whether a command can be bound in the mode.
    ///
    /// Commands that answer a dialog can be bound only in that dialog's mode, and no others there.
    pub fn takes(self, command: Command) -> bool {
        match self {
            Self::Export => matches!(command, Command::Write(_) | Command::No),
            Self::Keep => matches!(command, Command::Yes | Command::No),
            // All other modes belong to no dialog and bind no answers.
            _ => !command.answers_dialog(),
        }
    }

    /// Returns the mode with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }
}

/// The keys of a command in a mode.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// The mode in which the keys are bound.
    pub mode: KeyMode,
    /// The keys; empty if the user has unbound them all.
    pub keys: Vec<Key>,
    /// The command that each of the keys runs.
    pub command: Command,
}

impl Binding {
    /// Returns the names of the keys, separated by blanks, for the help.
    pub fn key_names(&self) -> String {
        self.keys.iter().map(Key::to_string).collect::<Vec<_>>().join(" ")
    }
}

/// The keymap that key presses are looked up in and that the help lists.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keymap {
    // Shared by all viewers of a server: a table takes about 10 KB.
    bindings: Arc<Vec<Binding>>,
}

/// Returns the built-in keymap.
impl Default for Keymap {
    fn default() -> Self {
        let row = |&(mode, keys, command): &BuiltInBinding| Binding { mode, keys: keys.to_vec(), command };
        let write = |&format: &Format| Binding {
            mode: KeyMode::Export,
            keys: vec![letter(format.key())],
            command: Command::Write(format),
        };
        // The formats come first, so that the export dialog lists them before the key that cancels it.
        let bindings = Format::ALL.iter().map(write).chain(BUILT_IN.iter().map(row)).collect();
        Self { bindings: Arc::new(bindings) }
    }
}

type BuiltInBinding = (KeyMode, &'static [Key], Command);

const fn letter(c: char) -> Key {
    Key::letter(c)
}

const LEFT: &[Key] = &[Key::named(KeyCode::Left), letter('h')];
const RIGHT: &[Key] = &[Key::named(KeyCode::Right), letter('l')];
const UP: &[Key] = &[Key::named(KeyCode::Up), letter('k')];
const DOWN: &[Key] = &[Key::named(KeyCode::Down), letter('j')];
const HIGHER: &[Key] = &[letter('e'), Key::named(KeyCode::PageUp)];
const LOWER: &[Key] = &[letter('c'), Key::named(KeyCode::PageDown)];

/// The built-in bindings in the order of the help, except those of [`Format`]s, whose keys are in
/// the table of export formats.
// The left hand moves by WASD while the right hand turns by the arrows; hjkl replace the arrows on keyboards without
// them. Explanation and light bind the arrows only, so that hjkl and WASD still move the eye. No binding needs Alt,
// which window managers and multiplexers use themselves. What function keys do can also be done with other keys, more
// slowly.
const BUILT_IN: &[BuiltInBinding] = &[
    (KeyMode::Fly, &[letter('w')], Command::Move(Direction::Forward)),
    (KeyMode::Fly, &[letter('s')], Command::Move(Direction::Back)),
    (KeyMode::Fly, &[letter('a')], Command::Move(Direction::Left)),
    (KeyMode::Fly, &[letter('d')], Command::Move(Direction::Right)),
    (KeyMode::Fly, HIGHER, Command::Move(Direction::Up)),
    (KeyMode::Fly, LOWER, Command::Move(Direction::Down)),
    (KeyMode::Fly, LEFT, Command::Look(Toward::Left)),
    (KeyMode::Fly, RIGHT, Command::Look(Toward::Right)),
    (KeyMode::Fly, UP, Command::Look(Toward::Up)),
    (KeyMode::Fly, DOWN, Command::Look(Toward::Down)),
    (KeyMode::Orbit, LEFT, Command::Around(Toward::Left)),
    (KeyMode::Orbit, RIGHT, Command::Around(Toward::Right)),
    (KeyMode::Orbit, UP, Command::Around(Toward::Up)),
    (KeyMode::Orbit, DOWN, Command::Around(Toward::Down)),
    (KeyMode::Orbit, &[letter('w')], Command::Nearer),
    (KeyMode::Orbit, &[letter('s')], Command::Farther),
    (KeyMode::Orbit, &[letter('a')], Command::Move(Direction::Left)),
    (KeyMode::Orbit, &[letter('d')], Command::Move(Direction::Right)),
    (KeyMode::Orbit, HIGHER, Command::Move(Direction::Up)),
    (KeyMode::Orbit, LOWER, Command::Move(Direction::Down)),
    (KeyMode::Explain, &[Key::named(KeyCode::Left)], Command::Point(Toward::Left)),
    (KeyMode::Explain, &[Key::named(KeyCode::Right)], Command::Point(Toward::Right)),
    (KeyMode::Explain, &[Key::named(KeyCode::Up)], Command::Point(Toward::Up)),
    (KeyMode::Explain, &[Key::named(KeyCode::Down)], Command::Point(Toward::Down)),
    (KeyMode::Explain, &[Key::named(KeyCode::PageUp)], Command::ScrollUp),
    (KeyMode::Explain, &[Key::named(KeyCode::PageDown)], Command::ScrollDown),
    (KeyMode::Light, &[Key::named(KeyCode::Left)], Command::MoveLight(Toward::Left)),
    (KeyMode::Light, &[Key::named(KeyCode::Right)], Command::MoveLight(Toward::Right)),
    (KeyMode::Light, &[Key::named(KeyCode::Up)], Command::MoveLight(Toward::Up)),
    (KeyMode::Light, &[Key::named(KeyCode::Down)], Command::MoveLight(Toward::Down)),
    (KeyMode::Light, &[Key::named(KeyCode::PageUp)], Command::LightFarther),
    (KeyMode::Light, &[Key::named(KeyCode::PageDown)], Command::LightNearer),
    (KeyMode::Light, &[letter('r')], Command::LightBack),
    (KeyMode::Orders, &[letter(' ')], Command::BuildPause),
    (KeyMode::Orders, &[letter('+'), letter('=')], Command::BuildFaster),
    (KeyMode::Orders, &[letter('-')], Command::BuildSlower),
    (KeyMode::Orders, &[letter('r')], Command::BuildAgain),
    (KeyMode::Export, &[Key::named(KeyCode::Esc)], Command::No),
    (KeyMode::Keep, &[letter('y')], Command::Yes),
    (KeyMode::Keep, &[letter('n'), Key::named(KeyCode::Esc)], Command::No),
    (KeyMode::Always, &[Key::named(KeyCode::Tab)], Command::ChangeMode),
    (KeyMode::Always, &[letter('f')], Command::FrameAll),
    (KeyMode::Always, &[letter('[')], Command::Narrower),
    (KeyMode::Always, &[letter(']')], Command::Wider),
    (KeyMode::Always, &[letter('&')], Command::ShiftLeft),
    (KeyMode::Always, &[letter('*')], Command::ShiftRight),
    (KeyMode::Always, &[letter('(')], Command::ShiftDown),
    (KeyMode::Always, &[letter(')')], Command::ShiftUp),
    (KeyMode::Always, &[letter(';')], Command::TiltLeft),
    (KeyMode::Always, &[letter(':')], Command::TiltRight),
    (KeyMode::Always, &[letter('{')], Command::TiltDown),
    (KeyMode::Always, &[letter('}')], Command::TiltUp),
    (KeyMode::Always, &[letter('t')], Command::Turntable),
    (KeyMode::Always, &[letter(' ')], Command::Pause),
    (KeyMode::Always, &[letter('1')], Command::View(1)),
    (KeyMode::Always, &[letter('2')], Command::View(2)),
    (KeyMode::Always, &[letter('3')], Command::View(3)),
    (KeyMode::Always, &[letter('4')], Command::View(4)),
    (KeyMode::Always, &[letter('5')], Command::View(5)),
    (KeyMode::Always, &[letter('6')], Command::View(6)),
    (KeyMode::Always, &[letter('7')], Command::View(7)),
    (KeyMode::Always, &[letter('8')], Command::View(8)),
    (KeyMode::Always, &[letter('9')], Command::View(9)),
    (KeyMode::Always, &[letter('m')], Command::SaveView),
    (KeyMode::Always, &[letter('r')], Command::Reset),
    (KeyMode::Always, &[letter(','), Key::named(KeyCode::Backspace)], Command::ViewBack),
    (KeyMode::Always, &[letter('.')], Command::ViewForward),
    (KeyMode::Always, &[letter('v')], Command::NextMap),
    (KeyMode::Always, &[letter('b')], Command::LastMap),
    (KeyMode::Always, &[letter('|')], Command::Compare),
    (KeyMode::Always, &[letter('<')], Command::Wipe(ScreenSide::Left)),
    (KeyMode::Always, &[letter('>')], Command::Wipe(ScreenSide::Right)),
    (KeyMode::Always, &[letter('n')], Command::NextScene),
    (KeyMode::Always, &[letter('p')], Command::LastScene),
    (KeyMode::Always, &[letter('o')], Command::Export),
    (KeyMode::Always, &[letter('O')], Command::ExportLarge),
    (KeyMode::Always, &[letter('R')], Command::Record),
    (KeyMode::Always, &[letter('y')], Command::CopyCamera),
    (KeyMode::Always, &[letter('Y')], Command::KeepView),
    (KeyMode::Always, &[letter('x')], Command::Explain),
    (KeyMode::Always, &[letter('g')], Command::Light),
    (KeyMode::Always, &[letter('i')], Command::Status),
    (KeyMode::Always, &[letter('\'')], Command::Caption),
    (KeyMode::Always, &[letter('z')], Command::TurnMesh),
    (KeyMode::Always, &[Key::named(KeyCode::F(5))], Command::Front),
    (KeyMode::Always, &[Key::named(KeyCode::F(6))], Command::FromRight),
    (KeyMode::Always, &[Key::named(KeyCode::F(7))], Command::FromAbove),
    (KeyMode::Always, &[letter('#')], Command::Wireframe),
    (KeyMode::Always, &[letter('B')], Command::NextGlyphs),
    (KeyMode::Always, &[letter('X')], Command::Axes),
    (KeyMode::Always, &[letter('V')], Command::Outside),
    (KeyMode::Always, &[letter('I')], Command::Orders),
    (KeyMode::Always, &[letter('M')], Command::Metadata),
    (KeyMode::Always, &[letter('?')], Command::Help),
    (KeyMode::Always, &[Key::named(KeyCode::Esc)], Command::Close),
    (KeyMode::Always, &[Key::ctrl('l')], Command::Redraw),
    (KeyMode::Always, &[Key::ctrl('z')], Command::Suspend),
    (KeyMode::Always, &[letter('q'), Key::ctrl('c')], Command::Quit),
];

impl Keymap {
    /// Returns all bindings, in the order of the help.
    pub fn bindings(&self) -> &[Binding] {
        &self.bindings
    }

    /// Returns the bindings of a mode, in the order of the help.
    pub fn of(&self, mode: KeyMode) -> impl Iterator<Item = &Binding> {
        self.bindings.iter().filter(move |row| row.mode == mode)
    }

    /// Binds a key to a command in a mode, instead of the key's previous command; `None` unbinds
    /// it.
    pub fn bind(&mut self, mode: KeyMode, key: Key, command: Option<Command>) {
        let bindings = Arc::make_mut(&mut self.bindings);
        for row in bindings.iter_mut().filter(|row| row.mode == mode) {
            row.keys.retain(|bound| *bound != key);
        }
        // The key is added to the command's binding, so that the help lists all keys of the command in one line.
        let Some(command) = command else { return };
        match bindings.iter_mut().find(|row| (row.mode, row.command) == (mode, command)) {
            Some(row) => row.keys.push(key),
            None => bindings.push(Binding { mode, keys: vec![key], command }),
        }
    }

    /// Unbinds all keys of these commands, which the help then does not list.
    pub fn remove(&mut self, commands: &[Command]) {
        Arc::make_mut(&mut self.bindings).retain(|row| !commands.contains(&row.command));
    }

    /// Returns the command of a key event in `modes`, the topmost first, and whether Shift makes
    /// the command faster.
    pub fn command(&self, modes: &[KeyMode], event: &KeyEvent) -> Option<(Command, bool)> {
        // Keys with these modifiers are shortcuts of the window manager, which the kitty keyboard protocol also
        // reports.
        if event.modifiers.intersects(KeyModifiers::SUPER | KeyModifiers::HYPER | KeyModifiers::META) {
            return None;
        }
        let typed = Key::typed(event);
        let has_character = matches!(typed.code, KeyCode::Char(_));
        // If the key types a character, Shift is already contained in it.
        let shift = event.modifiers.contains(KeyModifiers::SHIFT) && !has_character;
        modes.iter().find_map(|&mode| {
            let exactly = self.bound(mode, typed).map(|command| (command, shift && command.has_faster()));
            // A capital letter without a binding counts as the letter with Shift, if Shift makes that letter's command
            // faster.
            let with_shift = || self.bound(mode, typed.without_shift()).filter(|command| command.has_faster());
            exactly.or_else(|| with_shift().map(|command| (command, true)))
        })
    }

    /// Returns a key that runs a command in `modes`, for messages.
    ///
    /// It is the first key of the command that no higher mode binds to another one, preferably without Ctrl.
    pub fn key_of(&self, modes: &[KeyMode], command: Command) -> Option<Key> {
        let rows = modes.iter().flat_map(|&mode| self.of(mode)).filter(|row| row.command == command);
        let does = |key: &&Key| self.command(modes, &key.pressed()).is_some_and(|(meant, _)| meant == command);
        // A key without Ctrl is preferred because a single letter is read faster in a message.
        rows.flat_map(|row| &row.keys).filter(does).min_by_key(|key| key.ctrl).copied()
    }

    fn bound(&self, mode: KeyMode, key: Key) -> Option<Command> {
        self.of(mode).find(|row| row.keys.contains(&key)).map(|row| row.command)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
