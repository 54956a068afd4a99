//! The user's own files in the live view.

use crate::pty::{SOON, Session, Size, Start};
use std::fs;
use tempfile::TempDir;

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron");

/// A user who has these files.
fn user(files: &[(&str, &str)]) -> TempDir {
    let home = tempfile::tempdir().expect("a folder can be made");
    let folder = home.path().join(".config/termtrace");
    fs::create_dir_all(&folder).expect("a folder can be made");
    for (name, text) in files {
        fs::write(folder.join(name), text).expect("a file can be written");
    }
    home
}

/// What this user starts.
fn start(home: &TempDir, flags: &[&str]) -> Session {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).env("HOME", home.path()).size(Size::cells(80, 24));
    flags.iter().fold(start.arg(SCENE), Start::arg).spawn()
}

/// The last row of the screen has this.
#[track_caller]
fn wait_for_last(session: &mut Session, words: &str) {
    session.wait_for(words, SOON, |seen| seen.screen().text().last().is_some_and(|row| row.contains(words)));
}

#[track_caller]
fn leave(session: &mut Session) {
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

#[test]
fn what_the_file_sets_holds_unless_a_flag_or_a_variable_says_otherwise() {
    let home = user(&[("config.ron", "(view: depth)")]);
    for (flags, legend) in [(&[][..], "depth:"), (&["--view=normal"], "normal:")] {
        let mut session = start(&home, flags);
        wait_for_last(&mut session, legend);
        leave(&mut session);
    }
    let program = Start::new(env!("CARGO_BIN_EXE_termtrace")).env("HOME", home.path()).arg(SCENE);
    let mut session = program.env("TERMTRACE_VIEW", "shadow").spawn();
    wait_for_last(&mut session, "shadow:");
    leave(&mut session);
    // The status line has the last row to itself: no legend, so it is the shaded view.
    let mut session = start(&home, &["--no-config"]);
    session.wait_for("a picture", SOON, |seen| seen.screen().text().concat().contains('▄'));
    session.send(b"i");
    wait_for_last(&mut session, "rays/s");
    assert!(!session.seen().screen().text().concat().contains("depth:"));
    leave(&mut session);
}

/// Before the terminal is touched.
#[test]
fn a_file_that_is_wrong_is_told_of_before_anything_else() {
    let home = user(&[("config.ron", "(\n    veiw: depth,\n    fps: 0,\n)")]);
    let mut session = start(&home, &[]);
    assert_eq!(session.wait_exit(SOON).code(), Some(2));
    session.assert_clean();
    let said = String::from_utf8_lossy(session.seen().bytes()).into_owned();
    assert!(said.contains("config.ron:2:5: unknown setting \"veiw\"; did you mean \"view\"?"), "{said}");
    assert!(said.contains("config.ron:3:10: expected frames per second"), "{said}");
    assert!(!said.contains('\x1b'), "{said}");
}
