//! Scenes that move by themselves.

use crate::pty::{SOON, Session, Size, Start};

const RIPPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/formulas/ripples.ron");

fn started(flag: &str) -> Session {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(RIPPLES).size(Size::cells(40, 12));
    let start = if flag.is_empty() { start } else { start.arg(flag) };
    let mut session = start.says_when_it_rests().spawn();
    session.wait_for("a picture", SOON, |seen| seen.screen().text().concat().contains('▀'));
    session
}

fn leave(mut session: Session) {
    session.send(b"q");
    session.wait_exit(SOON);
    session.assert_clean();
}

#[test]
fn a_scene_that_moves_plays_until_it_is_paused() {
    let mut session = started("");
    for _ in 0..5 {
        let frames = session.seen().bytes().len();
        session.wait_for("the next frame", SOON, |seen| seen.bytes().len() > frames);
    }
    session.send(b" ");
    session.wait_for_text("paused at");
    // A key without a binding ends the note.
    session.send(b"\x1b[24~");
    session.wait_for_rest();
    session.send(b" ");
    session.wait_for_text("playing");
    for _ in 0..3 {
        let frames = session.seen().bytes().len();
        session.wait_for("the next frame", SOON, |seen| seen.bytes().len() > frames);
    }
    leave(session);
}

#[test]
fn the_length_of_an_animation_is_told_when_its_mesh_is_opened() {
    let mesh = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/odd_meshes/s4_rise.gltf");
    for (flag, text) in
        [("", "an animation of 2 s; Space pauses it"), ("--reduced-motion", "; --reduced-motion pauses")]
    {
        let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(mesh).size(Size::cells(60, 12));
        let start = if flag.is_empty() { start } else { start.arg(flag) };
        let mut session = start.says_when_it_rests().spawn();
        session.wait_for_text(text);
        leave(session);
    }
}

#[test]
fn a_scene_stands_still_where_motion_is_reduced() {
    let mut session = started("--reduced-motion");
    session.wait_for_rest();
    session.send(b" ");
    session.wait_for_text("nothing moves: --reduced-motion");
    // A key without a binding ends the note.
    session.send(b"\x1b[24~");
    session.wait_for_rest();
    leave(session);
}
