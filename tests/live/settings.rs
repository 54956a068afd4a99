//! The user's own settings and keys in the live view, and the texts about keys.

use crate::pty::{SOON, Session, Size, Start, without_colors};
use std::fs;
use tempfile::TempDir;

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron");

/// Returns the folder of a user with these files.
fn user(files: &[(&str, &str)]) -> TempDir {
    let home = tempfile::tempdir().expect("a folder can be made");
    let folder = home.path().join(".config/termtrace");
    fs::create_dir_all(&folder).expect("a folder can be made");
    for (name, text) in files {
        fs::write(folder.join(name), text).expect("a file can be written");
    }
    home
}

/// Starts the program with this user's files.
fn start(home: &TempDir, flags: &[&str]) -> Session {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).env("HOME", home.path()).size(Size::cells(80, 24));
    flags.iter().fold(start.arg(SCENE), Start::arg).spawn()
}

/// Starts the program without a user's files on a screen of that size.
fn looking(columns: u16, rows: u16) -> Session {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(SCENE).size(Size::cells(columns, rows));
    let mut session = start.says_when_it_rests().spawn();
    wait_for_picture(&mut session);
    session
}

fn wait_for_picture(session: &mut Session) {
    session.wait_for("a picture", SOON, |seen| seen.screen().text().concat().contains(['▄', '▀']));
}

/// Waits until the screen no longer has these words.
#[track_caller]
fn wait_for_no(session: &mut Session, words: &str) {
    session.wait_for(&format!("no {words}"), SOON, |seen| !seen.screen().text().concat().contains(words));
}

/// Leaves with that key; whether the camera was moved.
#[track_caller]
fn leave_moved(session: &mut Session, key: &[u8]) -> bool {
    let before = session.seen().bytes().len();
    session.send(key);
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
    String::from_utf8_lossy(&session.seen().bytes()[before..]).contains("camera:")
}

/// Waits until the last row of the screen has these words.
#[track_caller]
fn wait_for_last(session: &mut Session, words: &str) {
    session.wait_for(words, SOON, |seen| seen.screen().text().last().is_some_and(|row| row.contains(words)));
}

#[track_caller]
fn leave(session: &mut Session) {
    leave_moved(session, b"q");
}

#[test]
fn flags_and_variables_override_the_settings_file() {
    let home = user(&[("config.ron", "(map: depth)")]);
    for (flags, legend) in [(&[][..], "depth:"), (&["--map=normal"], "normal:")] {
        let mut session = start(&home, flags);
        wait_for_last(&mut session, legend);
        leave(&mut session);
    }
    let program = Start::new(env!("CARGO_BIN_EXE_termtrace")).env("HOME", home.path()).arg(SCENE);
    let mut session = program.env("TERMTRACE_MAP", "shadow").spawn();
    wait_for_last(&mut session, "shadow:");
    leave(&mut session);
    // The status line has the last row to itself: no legend, so it is the shaded picture.
    let mut session = start(&home, &["--no-config"]);
    wait_for_picture(&mut session);
    session.send(b"i");
    wait_for_last(&mut session, " sample");
    assert!(!session.seen().screen().text().concat().contains("depth:"));
    leave(&mut session);
}

/// Errors of settings and keys are reported before the terminal is touched.
#[test]
fn a_wrong_settings_file_is_reported_first() {
    let home = user(&[("config.ron", "(\n    mpa: depth,\n    fps: 0,\n)")]);
    let mut session = start(&home, &[]);
    assert_eq!(session.wait_exit(SOON).code(), Some(2));
    session.assert_clean();
    let said = without_colors(session.seen().bytes());
    assert!(said.contains("config.ron:2:5: unknown setting \"mpa\"; did you mean \"map\"?"), "{said}");
    assert!(said.contains("config.ron:3:10: expected frames per second"), "{said}");
    assert!(!said.contains('\x1b'), "{said}");
}

#[test]
fn user_keys_work_and_are_shown_in_the_help() {
    let keys = r#"(fly: { "8": MoveForward, "w": None }, always: { "Q": Quit, "q": None, "?": None, "F1": Help })"#;
    let home = user(&[("keys.ron", keys)]);
    let mut session = start(&home, &["--reduced-motion"]);
    wait_for_picture(&mut session);
    session.send(b"wq?i");
    session.wait_for_text("fly   F1 help   Q quit");
    session.send(b"\x1bOP");
    session.wait_for("its help", SOON, |seen| {
        let text = seen.screen().text();
        text.iter().any(|row| row.contains("8 a s d") && row.contains(" move "))
    });
    session.send(b" ");
    session.wait_for("its second page", SOON, |seen| {
        seen.screen().text().iter().any(|row| row.contains("F1") && row.contains("this help"))
    });
    session.send(b"\x1b");
    wait_for_no(&mut session, "this help");
    session.wait_for_text("eye 0.00 2.10 6.30");
    session.send(b"8");
    session.wait_for_text("eye 0.00 1.98 5.67");
    assert!(leave_moved(&mut session, b"Q"));
    let mut session = start(&home, &["--no-config"]);
    wait_for_picture(&mut session);
    leave(&mut session);
}

/// Every text that names a key names the bound one.
#[test]
fn every_text_names_the_bound_keys() {
    let keys = r#"(explain: { "Space": ScrollDown, "PageDown": None }, always: { "Q": Quit, "q": None, "F1": Help, "?": None })"#;
    let home = user(&[("keys.ron", keys)]);
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).env("HOME", home.path());
    let mut session = start.env("TERMTRACE_HINT", "true").spawn();
    wait_for_last(&mut session, "F1 keys; Q quit");
    session.send(b"\t");
    wait_for_last(&mut session, "orbit; F1 shows its keys");
    session.send(b"x");
    session.wait_for_text(": PageUp Space ");
    session.send(b"          ");
    session.wait_for_text("cell (40, 12), ");
    leave_moved(&mut session, b"Q");
}

#[test]
fn wrong_keys_are_reported_first() {
    let home = user(&[("keys.ron", "(fly: { \"Up\": MovForward })")]);
    let mut session = start(&home, &[]);
    assert_eq!(session.wait_exit(SOON).code(), Some(2));
    let said = without_colors(session.seen().bytes());
    assert!(said.contains("keys.ron:1:15: there is no command MovForward; did you mean MoveForward?"), "{said}");
    assert!(!said.contains('\x1b'), "{said}");
}

/// Help that does not fit on the screen has pages.
#[test]
fn the_help_has_pages_where_the_screen_is_small() {
    let mut session = looking(40, 12);
    let mut told = String::new();
    let mut page = 0;
    session.send(b"?");
    // Turned by each of these keys.
    for key in [&b" "[..], b"\x1b[6~", b"\x1b[C", b"\x1b[B"].into_iter().cycle() {
        page += 1;
        session.wait_for_text(&format!("keys: fly, page {page} of "));
        session.wait_for_text("Space next page; q close");
        // The title is the first row of the frame: the others may still be on their way.
        session.wait_for_rest();
        told += &session.seen().screen().text().concat();
        if told.contains(&format!("page {page} of {page} ")) {
            break;
        }
        session.send(key);
    }
    session.send(b"q");
    wait_for_no(&mut session, "keys: fly");
    for text in ["WASD", "look around", "view before", "next, previous map", "move a light", "quit", "double click"] {
        assert!(told.contains(text), "{text} in {told}");
    }
    leave(&mut session);
}

#[test]
fn below_40x12_panels_are_hidden_and_their_keys_off() {
    let mut session = looking(20, 10);
    session.send(b"?");
    wait_for_last(&mut session, "help needs 40x12");
    // It fades by itself.
    wait_for_no(&mut session, "help");
    session.send(b"m");
    wait_for_last(&mut session, "save view as 1-9?");
    session.send(b"\x1b");
    wait_for_no(&mut session, "view");
    session.send(b"o");
    wait_for_last(&mut session, "save: p a t s h Esc");
    // A wider line has the meanings, too.
    session.resize(Size::cells(60, 10));
    wait_for_last(&mut session, "save: p png a ansi t text s svg h html");
    session.resize(Size::cells(20, 10));
    // Until then the resized screen may show no question, and Escape with the next key would be one key with Alt.
    wait_for_last(&mut session, "save: p a t s h Esc");
    session.send(b"\x1b");
    wait_for_no(&mut session, "save:");
    // The cursor of an explanation that cannot be seen takes no key: the eye looks to the left.
    session.send(b"x");
    wait_for_last(&mut session, "explain needs 40x12");
    session.send(b"\x1b[D");
    session.wait_for_rest();
    assert!(leave_moved(&mut session, b"q"));
    let mut session = looking(80, 24);
    session.send(b"x");
    session.wait_for_text("closest hit:");
    session.send(b"\x1b[D");
    session.wait_for_rest();
    assert!(!leave_moved(&mut session, b"q"));
}

#[test]
fn the_status_line_shows_the_mode_and_its_keys() {
    let mut session = looking(80, 24);
    session.send(b"i");
    let row = |session: &mut Session, words: &str| {
        session.wait_for(words, SOON, |seen| seen.screen().text()[22].trim_end() == words);
    };
    row(&mut session, " fly   ? help   q quit   Tab orbit   wasd move   arrows look   x explain");
    wait_for_last(&mut session, "three_spheres.ron");
    session.send(b"\t");
    row(&mut session, " orbit   ? help   q quit   Tab fly   arrows turn   ws distance   x explain");
    session.send(b"x");
    row(&mut session, " explain   ? help   q quit   arrows move cursor   PageUp PageDown turn pages");
    leave(&mut session);
}

#[test]
fn escape_closes_the_topmost_panel() {
    let mut session = looking(80, 24);
    session.send(b"x");
    session.wait_for_text("closest hit:");
    session.send(b"?");
    session.wait_for_text("keys: explain, fly");
    session.send(b"\x1b");
    wait_for_no(&mut session, "keys: explain");
    session.wait_for_text("closest hit:");
    session.send(b"\x1b");
    wait_for_no(&mut session, "closest hit:");
    leave(&mut session);
}

/// Ctrl-C leaves while a question is open, too: it is no answer.
#[test]
fn ctrl_c_always_leaves() {
    for key in [&b"o"[..], b"Y", b"?", b"x"] {
        let mut session = looking(80, 24);
        let before = session.seen().bytes().len();
        session.send(key);
        session.wait_for("an answer", SOON, |seen| seen.bytes().len() > before);
        leave_moved(&mut session, b"\x03");
    }
}
