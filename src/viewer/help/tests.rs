use super::*;
use crate::capabilities::CellMode;

fn all_modes() -> [Vec<KeyMode>; 4] {
    let under = |mode| vec![mode, KeyMode::Always];
    let above = |mode| vec![mode, KeyMode::Fly, KeyMode::Always];
    [under(KeyMode::Fly), under(KeyMode::Orbit), above(KeyMode::Explain), above(KeyMode::Light)]
}

/// Returns the help with the rows that contain `filter`.
fn help(keymap: &Keymap, modes: &[KeyMode], filter: &str, screen: Rect) -> Help {
    let states = [(Command::Turntable, "off".to_owned())];
    Help::new(&rows(keymap, modes, &states, filter), modes, filter, screen)
}

/// Returns the text of all pages on a screen of this size.
fn shown(help: &Help, screen: Rect) -> String {
    let mut text = String::new();
    for page in 0..help.pages.len() {
        let area = help.area(page, screen);
        assert!(area.right() <= screen.width && area.bottom() <= screen.height);
        let mut buffer = Buffer::empty(area);
        help.draw(page, Theme::for_cell_mode(CellMode::HALF_BLOCK), area, &mut buffer);
        for y in area.top()..area.bottom() {
            text.extend((area.left()..area.right()).map(|x| buffer[(x, y)].symbol()));
            text.push('\n');
        }
    }
    text
}

const SCREEN: Rect = Rect::new(0, 0, 80, 24);

#[test]
fn all_of_it_is_shown_wherever_there_is_room_for_panels() {
    let keymap = Keymap::default();
    for modes in all_modes() {
        for (columns, lines) in [(80, 24), (200, 60), (40, 12), (41, 24), (300, 12)] {
            let screen = Rect::new(0, 0, columns, lines);
            let text = shown(&help(&keymap, &modes, "", screen), screen);
            for rows::Row { keys, does, .. } in rows(&keymap, &modes, &[], "") {
                let line = text.lines().any(|line| line.contains(&keys) && line.contains(&does));
                assert!(line, "{keys} {does} in {columns}x{lines}:\n{text}");
            }
            let turns = text.contains("Space next page") && text.contains("q close");
            assert!(turns || !text.contains("page 1 of"), "{text}");
        }
    }
    for (columns, lines) in [(3, 1), (4, 2), (5, 3), (39, 11)] {
        let screen = Rect::new(0, 0, columns, lines);
        shown(&help(&keymap, &[KeyMode::Fly, KeyMode::Always], "", screen), screen);
    }
}

/// Every key in force is in some row of the help, and so is every command that has a key.
#[test]
fn each_group_lists_its_keys() {
    let keymap = Keymap::default();
    let text = shown(&help(&keymap, &[KeyMode::Fly, KeyMode::Always], "", SCREEN), SCREEN);
    for line in [
        "WASD                   move",
        "e c PageUp PageDown  up, down",
        "arrows HJKL  look around",
        "v b  next, previous map",
        "1..9         go to view 1-9",
        ", Backspace  view before",
        "q Ctrl-C  quit",
        "right drag    shift the view",
        "( )  shift rectangle",
        "{ }  tilt rectangle",
        "turntable on or off (off)",
    ] {
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words(&text).contains(&words(line)), "{line} in\n{text}");
    }
    for heading in ["Move", "Look", "Views", "Maps", "Light", "Files", "Program", "Mouse"] {
        let is_heading = |line: &str| line.split(['│', ' ']).any(|word| word == heading);
        assert!(text.lines().any(is_heading), "{heading} in\n{text}");
    }
}

#[test]
fn it_goes_by_what_is_bound() {
    let mut keymap = Keymap::default();
    keymap.bind(KeyMode::Fly, Key::letter('8'), Some(Command::Move(Direction::Forward)));
    keymap.bind(KeyMode::Fly, Key::letter('w'), None);
    keymap.bind(KeyMode::Fly, Key::letter('4'), Some(Command::Move(Direction::Left)));
    keymap.bind(KeyMode::Always, Key::letter('o'), None);
    let fly = [KeyMode::Fly, KeyMode::Always];
    let text = shown(&help(&keymap, &fly, "", SCREEN), SCREEN);
    // A direction with two keys cannot share a row with directions that have one key each.
    for row in ["8 ", "a 4 "] {
        assert!(text.contains(row), "{text}");
    }
    assert!(text.contains("move forward") && text.contains("move left") && !text.contains("WASD"), "{text}");
    assert!(!text.contains("save picture"), "{text}");
    assert_eq!(key_names(&keymap, &[KeyMode::Fly], &[Command::Move(Direction::Forward)]).as_deref(), Some("8"));
    assert_eq!(key_names(&keymap, &fly, &[Command::Export]), None);
}

/// A key that a higher mode binds is not listed for the modes below it.
#[test]
fn a_key_is_told_of_once() {
    let modes = [KeyMode::Explain, KeyMode::Fly, KeyMode::Always];
    let text = shown(&help(&Keymap::default(), &modes, "", SCREEN), SCREEN);
    assert_eq!(text.matches("arrows").count(), 1, "{text}");
    assert!(text.contains("HJKL     look around") && text.contains("e c    up, down"), "{text}");
}

#[test]
fn typing_filters_and_keys_turn_pages() {
    let (keymap, modes) = (Keymap::default(), [KeyMode::Fly, KeyMode::Always]);
    let small = Rect::new(0, 0, 40, 12);
    let mut panel = HelpPanel::new(Vec::new());
    let press = |panel: &mut HelpPanel, code: KeyCode| {
        let meant = keymap.command(&modes, &code.into()).map(|(command, _)| command);
        let key = panel.effect(code, meant);
        panel.take_key(key, &keymap, &modes, small)
    };
    let title = |panel: &HelpPanel| panel.laid_out(&keymap, &modes, small).title(panel.page);
    for (code, page) in
        [(KeyCode::Char(' '), 1), (KeyCode::PageDown, 2), (KeyCode::Left, 1), (KeyCode::Up, 0), (KeyCode::Up, 0)]
    {
        assert!(press(&mut panel, code));
        assert_eq!(panel.page, page, "{code:?}");
    }
    for c in "/map".chars() {
        assert!(press(&mut panel, KeyCode::Char(c)));
    }
    assert_eq!(title(&panel), " keys: fly /map ");
    let text = shown(&panel.laid_out(&keymap, &modes, small), small);
    assert!(text.contains("v b") && text.contains("compare two maps") && !text.contains("WASD"), "{text}");
    for c in " q?".chars() {
        assert!(press(&mut panel, KeyCode::Char(c)), "part of the filter");
    }
    assert!(shown(&panel.laid_out(&keymap, &modes, small), small).contains("no key does this"));
    assert!(press(&mut panel, KeyCode::Backspace) && title(&panel).contains("/map q "));
    assert!(press(&mut panel, KeyCode::Esc) && title(&panel).contains("page 1 of"), "Esc shows all again");
    assert!(!press(&mut panel, KeyCode::Esc) && !press(&mut panel, KeyCode::Char('q')), "and closes");
    let pages = panel.laid_out(&keymap, &modes, small).pages.len();
    assert!(pages > 2);
    assert_eq!((0..pages).map(|_| press(&mut panel, KeyCode::Char('?'))).filter(|open| !open).count(), 1);
}

#[test]
fn the_line_has_as_much_as_fits() {
    let keymap = Keymap::default();
    let fly = [KeyMode::Fly, KeyMode::Always];
    let whole = " fly   ? help   q quit   Tab orbit   wasd move   arrows look   x explain";
    assert_eq!(status_line(&keymap, &fly, 80), whole);
    assert_eq!(status_line(&keymap, &fly, 40), " fly   ? help   q quit   Tab orbit");
    let explain = status_line(&keymap, &[KeyMode::Explain, KeyMode::Orbit, KeyMode::Always], 80);
    assert_eq!(explain, " explain   ? help   q quit   arrows move cursor   PageUp PageDown turn pages");
}
