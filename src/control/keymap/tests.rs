use super::*;
use std::collections::HashSet;

const FLY: &[KeyMode] = &[KeyMode::Fly, KeyMode::Always];

fn press(c: char) -> KeyEvent {
    KeyEvent::new(KeyCode::Char(c), KeyModifiers::NONE)
}

fn meant(event: &KeyEvent) -> Option<(Command, bool)> {
    Keymap::default().command(FLY, event)
}

/// Returns all keys bound in `modes`, which are active together and must not hide each other's
/// keys.
fn keys_of(keymap: &Keymap, modes: &[KeyMode]) -> Vec<Key> {
    let rows = modes.iter().flat_map(|&mode| keymap.of(mode));
    rows.flat_map(|row| row.keys.iter().copied()).collect()
}

#[test]
fn no_two_bindings_collide() {
    let keymap = Keymap::default();
    for modes in [
        FLY,
        &[KeyMode::Orbit, KeyMode::Always],
        &[KeyMode::Explain],
        &[KeyMode::Light],
        &[KeyMode::Orders],
        &[KeyMode::Export],
        &[KeyMode::Keep],
    ] {
        let mut seen = HashSet::new();
        for key in keys_of(&keymap, modes) {
            assert!(seen.insert(key), "{key} is bound twice in {modes:?}");
        }
        // Shift with a letter makes its command faster, so no other command may be bound to the capital letter.
        let rows = modes.iter().flat_map(|&mode| keymap.of(mode)).filter(|row| row.command.has_faster());
        for key in rows.flat_map(|row| &row.keys) {
            if let KeyCode::Char(c) = key.code {
                assert!(!seen.contains(&Key::letter(c.to_ascii_uppercase())), "Shift-{key} in {modes:?}");
            }
        }
    }
}

#[test]
fn no_binding_needs_a_key_that_plain_terminals_do_not_send() {
    for key in keys_of(&Keymap::default(), &KeyMode::ALL) {
        assert!(key.is_unambiguous(), "{key}");
    }
}

#[test]
fn each_mode_has_a_name_and_keys() {
    for mode in KeyMode::ALL {
        assert_eq!(KeyMode::from_name(mode.name()), Some(mode));
        assert!(Keymap::default().of(mode).count() > 0, "{mode:?}");
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
    assert_eq!(fast(KeyCode::Char('/')), Some((Command::Help, false)), "a terminal that tells only where the key is");
    assert_eq!(meant(&press('/')), None);
    assert_eq!(fast(KeyCode::Char('y')), Some((Command::KeepView, false)));
    assert_eq!(meant(&press('Q')), None, "a capital that moves nothing is free");
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
        assert_eq!(Keymap::default().command(&[KeyMode::Export], &press(format.key())), Some((command, false)));
        assert_eq!(Command::from_name(format.command()), Some(command));
    }
}

#[test]
fn a_key_that_a_mode_does_not_bind_goes_to_the_next_mode() {
    let keymap = Keymap::default();
    let explain = [KeyMode::Explain, KeyMode::Orbit, KeyMode::Always];
    let code = |code: KeyCode| keymap.command(&explain, &code.into()).map(|(command, _)| command);
    assert_eq!(code(KeyCode::Left), Some(Command::Point(Toward::Left)));
    assert_eq!(code(KeyCode::Char('h')), Some(Command::Around(Toward::Left)));
    assert_eq!(code(KeyCode::Char('q')), Some(Command::Quit));
    assert_eq!(keymap.command(&[KeyMode::Keep], &press('q')), None);
}

#[test]
fn keys_are_bound_anew() {
    let mut keymap = Keymap::default();
    keymap.bind(KeyMode::Fly, Key::letter('w'), Some(Command::Move(Direction::Back)));
    keymap.bind(KeyMode::Fly, Key::letter('W'), Some(Command::Nearer));
    keymap.bind(KeyMode::Always, Key::letter('x'), None);
    let command = |c| keymap.command(FLY, &press(c)).map(|(command, _)| command);
    assert_eq!(
        [command('w'), command('s'), command('W')],
        [Some(Command::Move(Direction::Back)), Some(Command::Move(Direction::Back)), Some(Command::Nearer)]
    );
    assert_eq!(command('x'), None);
}

#[test]
fn removed_commands_have_no_key() {
    let mut keymap = Keymap::default();
    keymap.remove(&[Command::Export, Command::Suspend]);
    assert_eq!(keymap.command(&[KeyMode::Fly, KeyMode::Always], &press('o')), None);
    let removed = |row: &Binding| row.command == Command::Suspend;
    assert!(!keymap.bindings().iter().any(removed) && Keymap::default().bindings().iter().any(removed));
}
