//! The hint in the lowest row: which keys to press, until the first one.

use crate::pty::{SOON, Session, Size, Start};
use std::fs;
use tempfile::TempDir;

const HINT: &str = "drag or WASD to move; v maps; x explain; ? keys; q quit";

fn start(scene: &str, size: Size) -> Start {
    Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(scene).env("TERMTRACE_HINT", "true").size(size)
}

fn leave(mut session: Session) {
    session.send(b"q");
    session.wait_exit(SOON);
}

#[test]
fn every_scene_and_mesh_opens_with_the_keys_to_press() {
    let mesh = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/teapot.obj");
    for scene in ["corridor", "tests/scenes/ball.ron", mesh] {
        let mut session = start(scene, Size::cells(80, 24)).spawn();
        session.wait_for_text(HINT);
        let rows = session.seen().screen().text();
        assert!(rows[..23].iter().all(|row| !row.contains("quit")), "{scene}: {rows:?}");
        leave(session);
    }
}

/// On a narrow screen parts of the hint are left out, and none is cut.
#[test]
fn the_hint_fits_into_forty_columns() {
    let mut session = start("corridor", Size::cells(40, 12)).spawn();
    session.wait_for_text(" drag or WASD to move; ? keys; q quit");
    leave(session);
}

#[test]
fn the_hint_goes_at_the_first_key_and_at_the_first_mouse_press() {
    for input in [&b"e"[..], b"\x1b[<0;40;12M"] {
        let mut session = start("corridor", Size::cells(80, 24)).spawn();
        session.wait_for_text(HINT);
        session.send(input);
        session.wait_for("the hint to go", SOON, |seen| !seen.screen().text().concat().contains("q quit"));
        leave(session);
    }
}

/// The file of settings turns the hint off; the keys named are those that are bound.
#[test]
fn settings_and_bindings_hold_for_the_hint() {
    let user = |name: &str, text: &str| -> TempDir {
        let home = tempfile::tempdir().expect("a folder can be made");
        let folder = home.path().join(".config/termtrace");
        fs::create_dir_all(&folder).expect("a folder can be made");
        fs::write(folder.join(name), text).expect("a file can be written");
        home
    };
    let home = user("keys.ron", r#"(always: { "z": Help, "?": None })"#);
    let mut session = start("corridor", Size::cells(80, 24)).env("HOME", home.path()).spawn();
    session.wait_for_text("z keys; q quit");
    leave(session);

    let home = user("config.ron", "(hint: false)");
    let start = start("corridor", Size::cells(80, 24)).env("HOME", home.path()).env("TERMTRACE_HINT", "");
    let mut session = start.says_when_it_rests().spawn();
    session.wait_for("a picture", SOON, |seen| seen.screen().text().concat().contains('▄'));
    session.wait_for_rest();
    assert!(!session.seen().screen().text().concat().contains("q quit"));
    leave(session);
}

const FEW_COLORS: &str = "256 colours; try --color truecolor";

/// Over ssh only `TERM` is set: the terminal is known by its replies, and where it is not, a line
/// says which flag to try.
#[test]
fn truecolor_is_found_by_the_terminals_name_or_the_flag_is_named() {
    for (replies, is_known) in [
        // Alacritty, kitty, tmux, and a terminal that identifies itself in no way.
        (&b"\x1b[>0;1100;1c"[..], true),
        (b"\x1bP>|kitty(0.26.5)\x1b\\\x1b[>1;4000;26c", true),
        (b"\x1bP>|tmux 3.3a\x1b\\\x1b[>84;0;0c", false),
        (b"", false),
    ] {
        let start = start("corridor", Size::cells(80, 24)).env("COLORTERM", "").mute();
        let mut session = start.spawn();
        session.wait_for("the queries", SOON, |seen| seen.has(b"\x1b[>q\x1b[>c") && seen.has(b"\x1b[c"));
        session.wait_for_text(HINT);
        session.send(&[replies, b"\x1b[?62c"].concat());
        if is_known {
            session.wait_for("24-bit colours", SOON, |seen| seen.has(b"38;2;"));
            assert!(!session.seen().screen().text().concat().contains("256 colours"));
        } else {
            session.wait_for_text(FEW_COLORS);
            session.wait_for_text(HINT);
        }
        leave(session);
    }
}
