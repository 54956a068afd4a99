//! Captions of scenes, the tour through the built-in ones, folders, and scenes without light.

use crate::pty::{SOON, Session, Size, Start};
use std::fs;

fn start(arguments: &[&str], size: Size) -> Session {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).size(size);
    arguments.iter().fold(start, Start::arg).says_when_it_rests().spawn()
}

#[track_caller]
fn leave(session: &mut Session) {
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

#[track_caller]
fn wait_for_no(session: &mut Session, words: &str) {
    session.wait_for(&format!("no {words}"), SOON, |seen| !seen.screen().text().concat().contains(words));
}

#[track_caller]
fn turn_to_the_last_page(session: &mut Session) {
    for _ in 0..20 {
        if session.seen().screen().text().concat().contains("' hides this") {
            break;
        }
        let before = session.seen().bytes().len();
        session.send(b"'");
        session.wait_for("the next page", SOON, |seen| seen.bytes().len() > before);
        session.wait_for_rest();
    }
    session.wait_for_text("' hides this");
}

#[test]
fn the_tour_shows_each_scene_with_its_caption_in_three_rows() {
    let mut session = start(&["tour"], Size::cells(80, 24));
    session.wait_for_text(" 1 of ");
    session.wait_for_text("Look at: the edge of a shadow");
    session.wait_for_text("V from outside; I both orders");
    session.send(b"n");
    session.wait_for_text(" 2 of ");
    let rows = session.seen().screen().text();
    assert!(rows[..20].iter().all(|row| !row.contains(char::is_alphabetic)), "{rows:?}");
    turn_to_the_last_page(&mut session);
    session.wait_for_text("also for those that others hide.");
    session.send(b"p");
    session.wait_for_text(" 1 of ");
    leave(&mut session);
}

/// The line about few colours takes a row of its own below the caption.
#[test]
fn the_line_about_colours_covers_no_caption() {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).size(Size::cells(80, 24));
    let mut session = start.arg("tour").env("TERMTRACE_HINT", "true").env("COLORTERM", "").spawn();
    session.wait_for_text("256 colours; try --color truecolor");
    let rows = session.seen().screen().text();
    assert!(rows[21].contains(" 1 of ") && rows[22].contains("256 colours"), "{rows:?}");
    leave(&mut session);
}

#[test]
fn a_key_hides_captions_and_shows_them() {
    let mut session = start(&["tour"], Size::cells(80, 100));
    session.wait_for_text("' hides this");
    session.send(b"'");
    wait_for_no(&mut session, "Look at");
    // The next scene has no caption either.
    session.send(b"n'");
    session.wait_for_text("Keys: I builds it slowly in both orders");
    leave(&mut session);
}

/// The captions of the views from outside replace that of the scene, which returns after them.
#[test]
fn views_from_outside_have_captions_of_their_own() {
    let mut session = start(&["tour"], Size::cells(80, 24));
    session.wait_for_text("V from outside");
    for (words, next) in [
        ("o is the eye; u points to the right, v up", "V moves the first camera"),
        ("Now the keys move the first camera", "V vanishing points"),
        ("Parallel lines meet in their vanishing point", "V ordinary view"),
        ("Three spheres", "V from outside"),
    ] {
        session.send(b"V");
        session.wait_for_text(words);
        session.wait_for_text(next);
    }
    for views in ["V", "VVV"] {
        session.send(views.as_bytes());
        session.wait_for_text("Esc leaves");
        session.send(b"\x1b");
        session.wait_for_text("Three spheres");
    }
    leave(&mut session);
}

#[test]
fn outside_a_tour_a_note_names_the_key_of_the_caption() {
    let mut session = start(&["bare"], Size::cells(80, 24));
    session.send(b"V");
    session.wait_for_text("keys move the second eye; ' explains; V next");
    session.send(b"'");
    session.wait_for_text("The tracer from outside: o is the eye");
    leave(&mut session);
}

#[test]
fn a_small_screen_shows_a_caption_in_pages() {
    let mut session = start(&["tour"], Size::cells(40, 12));
    session.wait_for_text("' more (1 of ");
    turn_to_the_last_page(&mut session);
    session.send(b"'");
    wait_for_no(&mut session, "hides this");
    leave(&mut session);
}

#[test]
fn outside_a_tour_a_caption_is_shown_on_request() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let camera = "camera: (eye: (0, 0, 5), target: (0, 0, 0))";
    let path = folder.path().join("x.ron");
    fs::write(&path, format!("// A comment.\n(caption: \"A field wins.\", {camera}, background: \"navy\")"))
        .expect("written");
    let mut session = start(&[path.to_str().expect("UTF-8")], Size::cells(80, 24));
    session.wait_for_rest();
    assert!(!session.seen().screen().text().concat().contains("A field"));
    session.send(b"'");
    session.wait_for_text("A field wins.");
    fs::write(&path, format!("({camera}, background: \"navy\")")).expect("written");
    wait_for_no(&mut session, "A field");
    session.send(b"'");
    session.wait_for_text("this scene has no caption");
    leave(&mut session);
}

#[test]
fn a_folder_opens_its_scenes_in_turn() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    for (name, color) in [("b.ron", "navy"), ("a.ron", "maroon")] {
        let scene = format!("// {color}\n(camera: (eye: (0, 0, 5), target: (0, 0, 0)), background: \"{color}\")");
        fs::write(folder.path().join(name), scene).expect("written");
    }
    let mut session = start(&[folder.path().to_str().expect("UTF-8")], Size::cells(80, 24));
    session.wait_for_rest();
    session.send(b"'");
    session.wait_for_text("maroon");
    session.send(b"n");
    session.wait_for_text("navy");
    leave(&mut session);
}

#[test]
fn a_new_scene_is_opened() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("my.ron");
    let mut session = start(&["new", path.to_str().expect("UTF-8")], Size::cells(80, 24));
    session.wait_for_rest();
    session.send(b"'");
    session.wait_for_text("A scene to start from");
    assert!(path.exists());
    leave(&mut session);
}

#[test]
fn a_scene_without_light_says_so_until_a_key_is_pressed() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("dark.ron");
    let dark = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1)])";
    fs::write(&path, dark).expect("written");
    let mut session = start(&[path.to_str().expect("UTF-8")], Size::cells(80, 24));
    session.wait_for_text("no lights and no ambient light: the picture is black");
    session.send(b"i");
    wait_for_no(&mut session, "no lights");
    leave(&mut session);
}
