use super::*;
use crate::control::Direction;
use crossterm::event::KeyCode;

const FORWARD: Command = Command::Move(Direction::Forward);

fn meant(keymap: &Keymap, mode: KeyMode, key: Key) -> Option<Command> {
    keymap.command(&[mode, KeyMode::Always], &key.pressed()).map(|(command, _)| command)
}

/// Returns the position and message of each error in a faulty keymap.
fn faults(text: &str) -> Vec<String> {
    let error = Keymap::from_ron("keys.ron", text).expect_err(text);
    error.reports().iter().map(|report| format!("{}:{} {}", report.line, report.column, report.message)).collect()
}

#[test]
fn keys_are_added_replaced_and_freed() {
    let text = r#"( // mine
            fly: { "8": MoveForward, ["z", "Home"]: MoveUp, "w": None, "s": Some(Status) },
            orbit: { "Ctrl-F": Reset },
            explain: { "Space": ScrollDown },
            export: { "g": WritePng, "p": None },
            always: { "Q": Quit, "\\": Compare, "\"": Compare, "x": None },
        )"#;
    let keymap = Keymap::from_ron("keys.ron", text).unwrap_or_else(|error| panic!("{error}"));
    let fly = |key| meant(&keymap, KeyMode::Fly, key);
    assert_eq!([fly(Key::letter('8')), fly(Key::letter('w'))], [Some(FORWARD), None]);
    let up = Some(Command::Move(Direction::Up));
    assert_eq!([fly(Key::letter('z')), fly(Key::named(KeyCode::Home)), fly(Key::letter('e'))], [up; 3]);
    assert_eq!(fly(Key::letter('s')), Some(Command::Status));
    assert_eq!([fly(Key::letter('q')), fly(Key::letter('Q'))], [Some(Command::Quit); 2]);
    assert_eq!([fly(Key::letter('\\')), fly(Key::letter('"'))], [Some(Command::Compare); 2]);
    assert_eq!(fly(Key::letter('x')), None);
    assert_eq!([fly(Key::ctrl('f')), meant(&keymap, KeyMode::Orbit, Key::ctrl('f'))], [None, Some(Command::Reset)]);
    assert_eq!(meant(&keymap, KeyMode::Explain, Key::letter(' ')), Some(Command::ScrollDown));
    assert_eq!(meant(&keymap, KeyMode::Keep, Key::letter('n')), Some(Command::No));
    assert_eq!(meant(&keymap, KeyMode::Export, Key::letter('g')).map(Command::name), Some("WritePng"));
}

/// Writes the built-in and a changed keymap as RON, and reads them back, so that users can start
/// from such a file.
#[test]
fn a_written_keymap_is_read_back() {
    let changes = r#"(fly: { ["8", "\\", "\""]: MoveForward, "w": None }, always: { "x": None, "z": Explain })"#;
    for text in ["()", changes] {
        let keymap = Keymap::from_ron("keys.ron", text).unwrap_or_else(|error| panic!("{error}"));
        let written = keymap.to_ron();
        let again = Keymap::from_ron("keys.ron", &written).unwrap_or_else(|error| panic!("{error}\n{written}"));
        assert_eq!(again.to_ron(), written);
        for mode in KeyMode::ALL {
            for key in (' '..='~').map(Key::letter).chain(('a'..='z').map(Key::ctrl)) {
                assert_eq!(meant(&again, mode, key), meant(&keymap, mode, key), "{key} in {mode:?}\n{written}");
            }
        }
    }
    let written = Keymap::default().to_ron();
    let lines: Vec<_> = written.lines().collect();
    assert_eq!(lines[..3], ["(", "    fly: {", r#"        "w": MoveForward,                   // move forward"#]);
    assert!(lines.contains(&r#"        ["q", "Ctrl-C"]: Quit,              // quit"#), "{written}");
}

#[test]
fn all_errors_are_reported_at_once() {
    let text = r#"(
    flying: {},
    fly: {
        "PgUp": MoveUp,
        "Pageup": MoveUp,
        "Ctrl-I": MoveUp,
        8: MoveUp,
        "8": MovForward,
        "9": Dance,
        "7": "MoveUp",
        ["6", "6"]: MoveUp,
        "5": WritePng,
    },
    keep: { "z": MoveUp },
    always: { "w": Status, "Ctrl-C": None },
    explain: [],
    fly: {},
)"#;
    assert_eq!(
        faults(text),
        [
            "2:5 there is no mode \"flying\"; there are fly, orbit, explain, light, orders, export, keep and always",
            "4:9 \"PgUp\" is not a key that every terminal sends: a character, Ctrl- and a letter but H, I, J and \
                 M, or a name such as PageUp, Space or F1",
            "5:9 there is no key \"Pageup\"; did you mean \"PageUp\"?",
            "6:9 \"Ctrl-I\" is not a key that every terminal sends: a character, Ctrl- and a letter but H, I, J \
                 and M, or a name such as PageUp, Space or F1",
            "7:9 expected a key in quotes, as in \"w\", or a list of keys",
            "8:14 there is no command MovForward; did you mean MoveForward?",
            "9:14 there is no command Dance",
            "10:14 expected a command without quotes, such as MoveForward, or None",
            "11:15 \"6\" is bound twice in fly",
            "12:14 WritePng has no meaning in fly",
            "14:18 MoveUp has no meaning in keep",
            "15:15 \"w\" is MoveForward in fly, which takes precedence over always",
            "15:28 \"Ctrl-C\" always quits",
            "16:14 expected modes with their keys, as in (fly: { \"8\": MoveForward })",
            "17:5 duplicate mode \"fly\"",
        ]
    );
    assert_eq!(faults("[]"), ["1:1 expected modes with their keys, as in (fly: { \"8\": MoveForward })"]);
}

/// Checks that `always` cannot bind the capital of a movement key, which is that key with Shift.
#[test]
fn a_binding_that_a_higher_mode_hides_is_refused() {
    assert_eq!(
        faults(r#"(always: { "W": Status })"#),
        ["1:12 \"W\" is MoveForward in fly, which takes precedence over always"]
    );
    for text in [
        r#"(fly: { "w": None }, orbit: { "w": None }, always: { "w": Status })"#,
        r#"(fly: { "w": MoveBack }, orbit: { "w": MoveBack }, always: { "w": Status })"#,
        r#"(fly: { "v": MoveBack })"#,
    ] {
        assert!(Keymap::from_ron("keys.ron", text).is_ok(), "{text}");
    }
}

#[test]
fn a_keymap_needs_a_key_that_quits() {
    let caught = "no key but Ctrl-C quits: bind one to Quit in always";
    assert_eq!(faults(r#"(always: { "q": None })"#), [format!("1:12 {caught}")]);
    assert_eq!(faults(r#"(always: { "q": Status })"#), [format!("1:12 {caught}")]);
    assert!(Keymap::from_ron("keys.ron", r#"(always: { "q": None, "Q": Quit })"#).is_ok());
    assert!(Keymap::from_ron("keys.ron", r#"(always: { ["q", "Ctrl-C"]: Quit })"#).is_ok());
    // A key bound to Quit in `always` does not quit in `fly` if `fly` binds it to another command.
    assert_eq!(faults(r#"(fly: { "q": Status })"#), [format!("1:9 {caught}")]);
}
