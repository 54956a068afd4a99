//! Any file of keys: it is told what is wrong with it, or its table can be written, read again, and left.

use proptest::prelude::*;
use proptest::sample::{select, subsequence};
use termtrace::internals::control::{Bindings, Command, Key, Mode};

const KEYS: [&str; 14] = ["q", "Q", "w", "W", "Esc", "Ctrl-C", "Ctrl-Q", "Space", "PageUp", "F1", "é", "\\", "\"", "?"];

/// `mode: { [keys]: command }`, of which each part is one that there is.
fn line() -> impl Strategy<Value = (Mode, String)> {
    let commands: Vec<_> = Command::all().map(Command::name).chain(["None", "Quit", "Quit"]).collect();
    let keys = subsequence(KEYS.to_vec(), 1..3);
    (select(Mode::ALL.to_vec()), keys, select(commands))
        .prop_map(|(mode, keys, command)| (mode, format!("{keys:?}: {command}")))
}

fn file() -> impl Strategy<Value = String> {
    prop::collection::vec(line(), 0..5).prop_map(|lines| {
        let of = |mode: Mode| lines.iter().filter(move |(of, _)| *of == mode).map(|(_, line)| line.as_str());
        let modes = Mode::ALL.map(|mode| format!("{}: {{ {} }}", mode.name(), of(mode).collect::<Vec<_>>().join(", ")));
        format!("({})", modes.join(", "))
    })
}

/// What every key means in every mode.
fn meanings(bindings: &Bindings) -> Vec<Option<(Command, bool)>> {
    let keys = KEYS.map(|name| Key::from_name(name).expect("a key"));
    let meant = |mode| keys.map(|key| bindings.command(&[mode, Mode::Always], &key.pressed()));
    Mode::ALL.into_iter().flat_map(meant).collect()
}

proptest! {
    #[test]
    fn a_table_that_is_read_can_be_written_read_again_and_left(text in file()) {
        let Ok(bindings) = Bindings::from_ron("keys.ron", &text) else { return Ok(()) };
        for mode in [Mode::Fly, Mode::Orbit] {
            let modes = [mode, Mode::Always];
            prop_assert!(bindings.key_of(&modes, Command::Quit).is_some_and(|key| key != Key::ctrl('c')));
            prop_assert_eq!(bindings.command(&modes, &Key::ctrl('c').pressed()), Some((Command::Quit, false)));
        }
        let written = bindings.to_ron();
        let again = Bindings::from_ron("keys.ron", &written).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(meanings(&again), meanings(&bindings));
        prop_assert_eq!(again.to_ron(), written);
    }
}
