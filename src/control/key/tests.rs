use super::*;

#[test]
fn keys_are_read_as_they_are_written() {
    let characters = (' '..='~').map(Key::letter);
    let with_ctrl = ('a'..='z').map(Key::ctrl).filter(|key| key.is_unambiguous());
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
    for name in ["", "Ctrl-", "Ctrl-I", "Ctrl-H", "Ctrl-Left", "Ctrl-1", "F13", "F0", "Shift-w", "ww", "\u{1b}", "left"]
    {
        assert_eq!(Key::from_name(name), None, "{name}");
    }
}
