//! Any file of keys has an error, or gives a table that can be written, read again, and left.

use proptest::prelude::*;
use proptest::sample::{select, subsequence};
use termtrace::internals::control::{Command, Key, KeyMode, Keymap};

const KEYS: [&str; 14] = ["q", "Q", "w", "W", "Esc", "Ctrl-C", "Ctrl-Q", "Space", "PageUp", "F1", "é", "\\", "\"", "?"];

/// Returns a valid line `mode: { [keys]: command }`.
fn line() -> impl Strategy<Value = (KeyMode, String)> {
    let commands: Vec<_> = Command::all().map(Command::name).chain(["None", "Quit", "Quit"]).collect();
    let keys = subsequence(KEYS.to_vec(), 1..3);
    (select(KeyMode::ALL.to_vec()), keys, select(commands))
        .prop_map(|(mode, keys, command)| (mode, format!("{keys:?}: {command}")))
}

fn file() -> impl Strategy<Value = String> {
    prop::collection::vec(line(), 0..5).prop_map(|lines| {
        let of = |mode: KeyMode| lines.iter().filter(move |(of, _)| *of == mode).map(|(_, line)| line.as_str());
        let modes =
            KeyMode::ALL.map(|mode| format!("{}: {{ {} }}", mode.name(), of(mode).collect::<Vec<_>>().join(", ")));
        format!("({})", modes.join(", "))
    })
}

/// Returns the command of every key in every mode.
fn meanings(keymap: &Keymap) -> Vec<Option<(Command, bool)>> {
    let keys = KEYS.map(|name| Key::from_name(name).expect("a key"));
    let meant = |mode| keys.map(|key| keymap.command(&[mode, KeyMode::Always], &key.pressed()));
    KeyMode::ALL.into_iter().flat_map(meant).collect()
}

proptest! {
    #[test]
    fn a_table_that_is_read_can_be_written_read_again_and_left(text in file()) {
        let Ok(keymap) = Keymap::from_ron("keys.ron", &text) else { return Ok(()) };
        for mode in [KeyMode::Fly, KeyMode::Orbit] {
            let modes = [mode, KeyMode::Always];
            // `key_of` would not do: of two keys with Ctrl it returns the first, which is Ctrl-C.
            let quits = |name| {
                let key = Key::from_name(name).expect("a key");
                keymap.command(&modes, &key.pressed()) == Some((Command::Quit, false))
            };
            prop_assert!(KEYS.into_iter().any(|name| name != "Ctrl-C" && quits(name)));
            prop_assert_eq!(keymap.command(&modes, &Key::ctrl('c').pressed()), Some((Command::Quit, false)));
        }
        let written = keymap.to_ron();
        let again = Keymap::from_ron("keys.ron", &written).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(meanings(&again), meanings(&keymap));
        prop_assert_eq!(again.to_ron(), written);
    }
}
