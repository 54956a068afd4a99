use super::*;
use crate::capabilities::CellMode;

fn all_modes() -> [Vec<KeyMode>; 4] {
    let under = |mode| vec![mode, KeyMode::Always];
    let above = |mode| vec![mode, KeyMode::Fly, KeyMode::Always];
    [under(KeyMode::Fly), under(KeyMode::Orbit), above(KeyMode::Explain), above(KeyMode::Light)]
}

/// Returns the text of all pages of the help on a screen of this size.
fn shown(keymap: &Keymap, modes: &[KeyMode], columns: u16, rows: u16) -> String {
    let screen = Rect::new(0, 0, columns, rows);
    let help = Help::new(keymap, modes, screen);
    let mut text = String::new();
    for page in 0..help.pages() {
        let area = help.area(page, screen);
        assert!(area.right() <= columns && area.bottom() <= rows);
        let mut buffer = Buffer::empty(area);
        help.draw(page, Theme::of(CellMode::HALF_BLOCK), area, &mut buffer);
        for y in area.top()..area.bottom() {
            text.extend((area.left()..area.right()).map(|x| buffer[(x, y)].symbol()));
            text.push('\n');
        }
    }
    text
}

/// Every key and its description is on one of the pages, on every screen that is large enough for
/// panels.
#[test]
fn all_of_it_is_shown_wherever_there_is_room_for_panels() {
    let keymap = Keymap::default();
    for modes in all_modes() {
        for (columns, rows) in [(80, 24), (200, 60), (40, 12), (41, 24), (300, 12)] {
            let text = shown(&keymap, &modes, columns, rows);
            for (keys, description) in key_rows(&keymap, &modes) {
                let line = text.lines().any(|line| line.contains(&keys) && line.contains(description));
                assert!(line, "{keys} {description} in {columns}x{rows}:\n{text}");
            }
        }
    }
    for (columns, rows) in [(1, 1), (4, 2), (5, 3), (39, 11)] {
        shown(&keymap, &[KeyMode::Fly, KeyMode::Always], columns, rows);
    }
}

#[test]
fn it_goes_by_what_is_bound() {
    let mut keymap = Keymap::default();
    keymap.bind(KeyMode::Fly, Key::letter('8'), Some(Command::Move(Direction::Forward)));
    keymap.bind(KeyMode::Fly, Key::letter('w'), None);
    keymap.bind(KeyMode::Always, Key::letter('o'), None);
    let text = shown(&keymap, &[KeyMode::Fly, KeyMode::Always], 80, 24);
    assert!(text.contains("8        ") && text.contains("move forward"), "{text}");
    assert!(!text.contains("save picture"), "{text}");
    assert_eq!(key_names(&keymap, &[KeyMode::Fly], &[Command::Move(Direction::Forward)]).as_deref(), Some("8"));
    assert_eq!(key_names(&keymap, &[KeyMode::Fly, KeyMode::Always], &[Command::Export]), None);
}

/// A key bound in a higher mode is not listed for the lower one.
#[test]
fn a_key_is_told_of_once() {
    let text = shown(&Keymap::default(), &[KeyMode::Explain, KeyMode::Fly, KeyMode::Always], 80, 24);
    assert_eq!(text.matches("Left").count(), 1, "{text}");
    assert!(text.contains("│ Left      cursor to the left"), "{text}");
}

#[test]
fn the_line_has_as_much_as_fits() {
    let keymap = Keymap::default();
    let fly = [KeyMode::Fly, KeyMode::Always];
    let whole = " fly   ? help   q quit   Tab orbit   wasd move   arrows look   x explain";
    assert_eq!(status_line(&keymap, &fly, 80), whole);
    assert_eq!(status_line(&keymap, &fly, 40), " fly   ? help   q quit   Tab orbit");
    let explain = status_line(&keymap, &[KeyMode::Explain, KeyMode::Orbit, KeyMode::Always], 80);
    assert_eq!(explain, " explain   ? help   q quit   arrows move cursor   PageUp PageDown scroll");
}
