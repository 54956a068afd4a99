//! Reading the user's keymap from RON, as changes of the built-in keymap, and writing a keymap as
//! RON.

use super::{Command, Key, KeyMode, Keymap};
use crate::scene_text::{self, Faults, Field, SceneError, Span, SyntaxNode, Value, clipped, quoted};
use crate::text::{closest, listed};
use std::collections::HashSet;
use std::fmt::Write;

/// The key that always quits the program, so that no keymap can make quitting impossible.
const ALWAYS_QUITS: Key = Key::ctrl('c');

impl Keymap {
    /// Returns the built-in keymap with the changes in `text`.
    ///
    /// For each mode, `text` maps a key or a list of keys to a command, or to `None` to unbind. `name` is the file's
    /// name in messages.
    ///
    /// ```
    /// use crossterm::event::KeyCode;
    /// use termtrace::internals::control::{Keymap, Command, KeyMode};
    ///
    /// let text = r#"(
    ///     fly: { "8": MoveForward, ["2", "Home"]: MoveBack, "w": None },
    ///     always: { "Q": Quit },
    /// )"#;
    /// let keymap = Keymap::from_ron("keys.ron", text)?;
    /// let meant = keymap.command(&[KeyMode::Fly, KeyMode::Always], &KeyCode::Char('Q').into());
    /// assert_eq!(meant, Some((Command::Quit, false)));
    /// # Ok::<(), termtrace::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// The first syntax error; without one, all other errors: unknown modes, commands and keys, keys that not every
    /// terminal sends, keys bound twice or hidden by another mode's binding, and a keymap in which no key quits.
    pub fn from_ron(name: &str, text: &str) -> Result<Self, SceneError> {
        scene_text::read(name, text, "file of keys is ()", |root, faults| {
            let entries = entries(root, faults);
            let mut keymap = Self::default();
            // All entries are bound before any is checked, because whether one is hidden depends on the others.
            for entry in &entries {
                keymap.bind(entry.mode, entry.key, entry.command);
            }
            keymap.check(&entries, faults);
            faults.is_empty().then_some(keymap)
        })
    }

    /// Writes the whole keymap as RON, with a comment on each command.
    ///
    /// [`from_ron`](Self::from_ron) reads it back.
    pub fn to_ron(&self) -> String {
        let mut text = "(\n".to_owned();
        for mode in KeyMode::ALL {
            let _ = writeln!(text, "    {}: {{", mode.name());
            // Unbound keys are written as `None` below: without these entries, reading would restore their built-in
            // bindings.
            for row in self.of(mode).filter(|row| !row.keys.is_empty()) {
                let entry = format!("{}: {},", keys_as_ron(&row.keys), row.command.name());
                let _ = writeln!(text, "        {entry:<36}// {}", row.command.description());
            }
            for key in self.unbound_keys(mode) {
                let _ = writeln!(text, "        {}: None,", keys_as_ron(&[key]));
            }
            text.push_str("    },\n");
        }
        text + ")\n"
    }

    /// Returns the keys that the built-in keymap binds in `mode` and this one does not.
    fn unbound_keys(&self, mode: KeyMode) -> Vec<Key> {
        let bound: HashSet<_> = self.of(mode).flat_map(|row| &row.keys).copied().collect();
        let built_in = Self::default();
        built_in.of(mode).flat_map(|row| row.keys.clone()).filter(|key| !bound.contains(key)).collect()
    }

    /// Reports entries that have no effect, and a keymap in which no key but [`ALWAYS_QUITS`]
    /// quits.
    fn check(&self, entries: &[KeymapEntry], faults: &mut Faults) {
        for (i, entry) in entries.iter().enumerate() {
            let KeymapEntry { mode, key, .. } = *entry;
            if entries[..i].iter().any(|before| (before.mode, before.key) == (mode, key)) {
                faults.add(entry.span, || format!("{} is bound twice in {}", quoted_key(key), mode.name()));
            } else if key == ALWAYS_QUITS && entry.command != Some(Command::Quit) {
                faults.add(entry.span, || format!("{} always quits", quoted_key(key)));
            } else {
                self.check_is_reached(entry, entries, faults);
            }
        }
        if !self.can_be_left() {
            let built_in = Self::default();
            let takes_it = |entry: &&KeymapEntry| {
                built_in.of(KeyMode::Always).any(|row| row.command == Command::Quit && row.keys.contains(&entry.key))
            };
            // Reported at the last entry that rebinds a built-in key of `Quit`, or at the start of the file if no entry
            // does.
            let span = entries.iter().rev().find(takes_it).map(|entry| entry.span).unwrap_or_default();
            let message = "no key but Ctrl-C quits: bind one to Quit in always";
            faults.add(span, || message.to_owned());
        }
    }

    /// Reports an entry of `always` that a binding of a higher mode hides, unless the file itself
    /// contains that binding and so intends it.
    fn check_is_reached(&self, entry: &KeymapEntry, entries: &[KeymapEntry], faults: &mut Faults) {
        let KeymapEntry { mode: KeyMode::Always, key, command: Some(command), span } = *entry else { return };
        // `Explain`, `Light`, `Orders` and the dialogs are not checked: they hide keys on purpose while active.
        for above in [KeyMode::Fly, KeyMode::Orbit] {
            let hides = |other: &KeymapEntry| other.mode == above && [key, key.without_shift()].contains(&other.key);
            let meant = self.command(&[above, KeyMode::Always], &key.pressed()).map(|(meant, _)| meant);
            if let Some(meant) = meant.filter(|&meant| meant != command && !entries.iter().any(hides)) {
                let (key, above, meant) = (quoted_key(key), above.name(), meant.name());
                faults.add(span, || format!("{key} is {meant} in {above}, which takes precedence over always"));
                return;
            }
        }
    }

    /// Returns whether, in flight and in orbit, some key besides [`ALWAYS_QUITS`] quits.
    fn can_be_left(&self) -> bool {
        let leaves =
            |above, key: Key| self.command(&[above, KeyMode::Always], &key.pressed()) == Some((Command::Quit, false));
        let rows = self.bindings().iter().filter(|row| row.command == Command::Quit);
        let keys: Vec<_> = rows.flat_map(|row| row.keys.clone()).filter(|&key| key != ALWAYS_QUITS).collect();
        [KeyMode::Fly, KeyMode::Orbit].into_iter().all(|above| keys.iter().any(|&key| leaves(above, key)))
    }
}

/// An entry of the file: a key in a mode, and its command, or `None` to unbind it.
struct KeymapEntry {
    mode: KeyMode,
    key: Key,
    /// Position of the key in the file.
    span: Span,
    command: Option<Command>,
}

fn quoted_key(key: Key) -> String {
    format!("\"{key}\"")
}

/// Formats keys as RON: one as `"w"`, several as `["Up", "k"]`.
fn keys_as_ron(keys: &[Key]) -> String {
    let keys: Vec<_> = keys.iter().map(|key| format!("{:?}", key.to_string())).collect();
    if let [only] = &keys[..] { only.clone() } else { format!("[{}]", keys.join(", ")) }
}

/// Reads the entries of `(mode: { key: command, ... }, ...)`.
fn entries(root: &SyntaxNode<'_>, faults: &mut Faults) -> Vec<KeymapEntry> {
    const FORM: &str = "modes with their keys, as in (fly: { \"8\": MoveForward })";
    let Some(fields) = root.fields() else {
        faults.add(root.head(), || format!("expected {FORM}"));
        return Vec::new();
    };
    let mut entries = Vec::new();
    for (i, Field { name, value }) in fields.iter().enumerate() {
        if fields[..i].iter().any(|before| before.name.text == name.text) {
            faults.add(name.span, || format!("duplicate mode {}", quoted(name.text)));
        }
        match (KeyMode::from_name(name.text), &value.value) {
            // The keys of an unknown mode are not checked: their errors would only follow from this one.
            (None, _) => faults.add(name.span, || unknown_mode(name.text)),
            (Some(mode), Value::Map(pairs)) => {
                for (keys, command) in pairs {
                    let keys = keys_of(keys, faults);
                    let command = match command.word() {
                        // `None` unbinds the keys.
                        Some("None") => None,
                        _ => match command_of(mode, command, faults) {
                            None => continue,
                            command => command,
                        },
                    };
                    entries.extend(keys.into_iter().map(|(key, span)| KeymapEntry { mode, key, span, command }));
                }
            }
            (Some(_), _) => faults.add(value.head(), || format!("expected {FORM}")),
        }
    }
    entries
}

fn unknown_mode(name: &str) -> String {
    let known = KeyMode::ALL.map(KeyMode::name);
    match closest(name, known) {
        Some(meant) => format!("there is no mode {}; did you mean \"{meant}\"?", quoted(name)),
        None => format!("there is no mode {}; there are {}", quoted(name), listed(&known)),
    }
}

/// Reads a key or a list of keys, each with its position.
fn keys_of(node: &SyntaxNode<'_>, faults: &mut Faults) -> Vec<(Key, Span)> {
    match &node.value {
        Value::List(items) => items.iter().filter_map(|item| Some((key_of(item, faults)?, item.span))).collect(),
        _ => key_of(node, faults).map(|key| (key, node.span)).into_iter().collect(),
    }
}

fn key_of(node: &SyntaxNode<'_>, faults: &mut Faults) -> Option<Key> {
    // Keys are quoted in the file, because most of them are not identifiers in RON.
    let Value::String(name) = &node.value else {
        faults.add(node.head(), || "expected a key in quotes, as in \"w\", or a list of keys".to_owned());
        return None;
    };
    let key = Key::from_name(name);
    if key.is_none() {
        faults.add(node.span, || match closest(name, Key::names()) {
            Some(meant) => format!("there is no key {}; did you mean \"{meant}\"?", quoted(name)),
            // Without a similar name, the message lists the forms of key names, which the user may not know.
            None => format!(
                "{} is not a key that every terminal sends: a character, Ctrl- and a letter but H, I, J and M, or a \
                 name such as PageUp, Space or F1",
                quoted(name)
            ),
        });
    }
    key
}

/// Reads a command, which must be one that can be bound in `mode`.
fn command_of(mode: KeyMode, node: &SyntaxNode<'_>, faults: &mut Faults) -> Option<Command> {
    let Some(word) = node.word() else {
        let expected = "expected a command without quotes, such as MoveForward, or None";
        faults.add(node.head(), || expected.to_owned());
        return None;
    };
    let Some(command) = Command::from_name(word) else {
        let meant = closest(word, Command::all().map(Command::name));
        let meant = meant.map(|meant| format!("; did you mean {meant}?")).unwrap_or_default();
        faults.add(node.span, || format!("there is no command {}{meant}", clipped(word)));
        return None;
    };
    if !mode.takes(command) {
        faults.add(node.span, || format!("{word} has no meaning in {}", mode.name()));
        return None;
    }
    Some(command)
}

#[cfg(all(test, unit_tests))]
mod tests;
