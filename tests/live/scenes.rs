//! Scene files of the live view: several, none, and files that change while they are shown.

use crate::pty::{self, SOON, Session, Size, Start, shows};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use termtrace::{CellMode, Scene};

/// Returns a scene with a ball of that colour, seen from that eye.
pub(crate) fn ball(color: &str, eye: &str) -> String {
    format!(
        "(camera: (eye: {eye}, target: (0, 0, 0)), background: \"navy\", lights: [Point(position: (3, 4, 5), intensity: 40)],
        objects: [Sphere(center: (0, 0, 0), radius: 1, material: Diffuse(\"{color}\"))])"
    )
}

pub(crate) const EYE: &str = "(0, 0, 5)";

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder can be made"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file in place, as most programs do.
    fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        fs::write(self.path(name), text).expect("a file can be written");
        self.path(name)
    }

    /// Replaces a file by a rename, as editors do that never leave half a file behind.
    fn replace(&self, name: &str, text: impl AsRef<[u8]>) {
        let new = self.write("new~", text);
        fs::rename(new, self.path(name)).expect("a file can be renamed");
    }
}

pub(crate) fn program() -> Start {
    Start::new(env!("CARGO_BIN_EXE_termtrace")).says_when_it_rests()
}

/// Starts the view with these files.
fn looking(paths: &[&Path]) -> Session {
    let mut session = paths.iter().fold(program(), Start::arg).spawn();
    sees(&mut session, &fs::read_to_string(paths[0]).expect("it is there"));
    session
}

/// Waits for the picture of that scene.
#[track_caller]
pub(crate) fn sees(session: &mut Session, text: &str) {
    let scene = Scene::from_ron("wanted", text).expect("the scene is fine");
    let wanted = pty::picture(&scene, CellMode::HALF_BLOCK, termtrace::Size::new(80, 24), 2.0);
    session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
}

/// Shows the next or the previous scene, whose note then goes with a key that has no command.
fn turn_to(session: &mut Session, key: &[u8], color: &str) {
    session.send(key);
    session.wait_for_text(&format!("{color}.ron ("));
    session.send(b"\x1b[24~");
}

/// Returns whether the upper half of the screen shows that scene, whatever covers the lower one.
fn upper_half_shows(session: &mut Session, text: &str) -> bool {
    let scene = Scene::from_ron("wanted", text).expect("the scene is fine");
    let wanted = pty::picture(&scene, CellMode::HALF_BLOCK, termtrace::Size::new(80, 24), 2.0);
    (0..12 * 80).all(|at| {
        let shown = session.seen().screen().cell(at % 80, at / 80);
        let cell = wanted.at(at);
        let glyph = cell.glyph.to_string().chars().next().unwrap_or(' ');
        let wanted = pty::halves_of(glyph, cell.fg.into(), cell.bg.into());
        wanted.is_some() && pty::halves_of(shown.glyph, shown.foreground, shown.background) == wanted
    })
}

pub(crate) fn leave(session: &mut Session) -> String {
    let before = session.seen().bytes().len();
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
    String::from_utf8_lossy(&session.seen().bytes()[before..]).into_owned()
}

#[test]
fn a_changed_scene_is_shown_however_it_is_written() {
    let folder = Folder::new();
    let path = folder.write("ball.ron", ball("red", EYE));
    let mut session = looking(&[&path]);
    for color in ["lime", "gold"] {
        folder.write("ball.ron", ball(color, EYE));
        sees(&mut session, &ball(color, EYE));
        let renamed = ball("white", EYE);
        folder.replace("ball.ron", &renamed);
        sees(&mut session, &renamed);
    }
    // vim renames the old file first.
    fs::rename(&path, folder.path("ball.ron~")).expect("a file can be renamed");
    folder.write("ball.ron", ball("teal", EYE));
    fs::remove_file(folder.path("ball.ron~")).expect("a file can be removed");
    sees(&mut session, &ball("teal", EYE));
    assert!(!session.seen().has(b"no such file"), "what lasts a moment is no fault");
    leave(&mut session);
}

#[test]
fn a_broken_scene_keeps_its_picture_and_shows_its_error() {
    let folder = Folder::new();
    let path = folder.write("ball.ron", ball("red", EYE));
    let mut session = looking(&[&path]);
    folder.write("ball.ron", ball("red", EYE).replace("radius", "radus"));
    session.wait_for_text("unknown field \"radus\"; did you mean \"radius\"?");
    session.wait_for_text("^^^^^");
    let text = session.seen().screen().text();
    let caret = text.iter().position(|line| line.contains("^^^^^")).expect("a caret");
    assert_eq!(text[caret].find('^'), text[caret - 1].find("radus"), "{text:?}");
    assert!(caret == 23 || caret == 22, "at the bottom: {text:?}");
    assert!(upper_half_shows(&mut session, &ball("red", EYE)), "the picture stays");
    // The error of the next fault replaces it.
    folder.write("ball.ron", "(camera: (eye: (0, 0, 5)))");
    session.wait_for_text("missing field \"target\"");
    session.wait_for("the old fault to go", SOON, |seen| !seen.screen().text().concat().contains("radus"));
    folder.write("ball.ron", ball("lime", EYE));
    sees(&mut session, &ball("lime", EYE));
    leave(&mut session);
}

/// A pipe without a writer is an error like any other, and the view goes on.
#[test]
fn a_scene_that_becomes_a_pipe_is_an_error() {
    let folder = Folder::new();
    let path = folder.write("ball.ron", ball("red", EYE));
    let mut session = looking(&[&path]);
    let pipe = folder.path("pipe");
    nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::S_IRWXU).expect("a pipe can be made");
    fs::rename(pipe, &path).expect("a file can be replaced");
    session.wait_for_text("ball.ron: this pipe delivered nothing for a second");
    assert!(upper_half_shows(&mut session, &ball("red", EYE)), "the picture stays");
    leave(&mut session);
}

/// A mesh and its texture are files of the scene, even while one of them is missing.
#[test]
fn a_changed_mesh_is_shown() {
    let folder = Folder::new();
    let square = |size: f32| {
        format!("v -{size} -{size} 0\nv {size} -{size} 0\nv {size} {size} 0\nv -{size} {size} 0\nf 1 2 3 4\n")
    };
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, objects: [Mesh(path: \"square.obj\")])";
    folder.write("square.obj", square(1.0));
    let path = folder.write("square.ron", text);
    let sees = |session: &mut Session| {
        let scene = Scene::load(&path).expect("the scene is fine");
        let wanted = pty::picture(&scene, CellMode::HALF_BLOCK, termtrace::Size::new(80, 24), 2.0);
        session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
    };
    let mut session = program().arg(&path).spawn();
    sees(&mut session);
    folder.replace("square.obj", square(0.5));
    sees(&mut session);
    fs::remove_file(folder.path("square.obj")).expect("a file can be removed");
    folder.replace("square.ron", text);
    session.wait_for_text("square.obj");
    folder.write("square.obj", square(1.5));
    sees(&mut session);
    // The mesh names another texture now.
    folder.write("square.obj", format!("mtllib square.mtl\nusemtl m\n{}", square(1.0)));
    session.wait_for_text("square.mtl");
    folder.write("square.mtl", "newmtl m\nKd 1 0 0\n");
    sees(&mut session);
    folder.write("square.mtl", "newmtl m\nKd 0 1 0\n");
    sees(&mut session);
    leave(&mut session);
}

/// Waits until some cell is green, and none red.
#[track_caller]
fn sees_another_color(session: &mut Session) {
    session.wait_for("a ball of lime", SOON, |seen| {
        let cells = (0..24).flat_map(|row| (0..80).map(move |column| (column, row)));
        let colors = cells.map(|(column, row)| seen.screen().cell(column, row).background);
        let is = |wanted: fn(u8, u8) -> bool| {
            move |color: &pty::Colour| matches!(*color, pty::Colour::Rgb(red, green, _) if wanted(red, green))
        };
        let colors: Vec<_> = colors.collect();
        colors.iter().any(is(|red, green| green > 100 && red < 50)) && !colors.iter().any(is(|red, _| red > 100))
    });
}

/// The user's view stays, unless the view in the file changes.
#[test]
fn a_reload_keeps_the_view() {
    let folder = Folder::new();
    let path = folder.write("ball.ron", ball("red", EYE));
    let mut session = looking(&[&path]);
    session.send(b"d");
    // This waits for the end of the motion.
    session.wait_for_rest();
    folder.write("ball.ron", ball("lime", EYE));
    sees_another_color(&mut session);
    session.send(b"i");
    session.wait_for_text(" sample");
    let status = session.seen().screen().text()[23].clone();
    assert!(!status.contains("eye 0.00 0.00 5.00"), "{status}");
    folder.write("ball.ron", ball("lime", "(0, 1, 6)"));
    session.wait_for_text("eye 0.00 1.00 6.00");
    session.send(b"i");
    sees(&mut session, &ball("lime", "(0, 1, 6)"));
    assert!(!leave(&mut session).contains("camera:"), "this is where the file looks from");
}

/// Changes of other files in the folder, and writes without a change, have no effect.
#[test]
fn changes_of_other_files_are_ignored() {
    let folder = Folder::new();
    let path = folder.write("ball.ron", ball("red", EYE));
    let mut session = looking(&[&path]);
    session.wait_for_rest();
    // The system reports changes in their order: those of other files before that of the scene.
    for color in ["lime", "gold", "teal", "red"] {
        let loads = session.loads();
        folder.write("other.ron", "(");
        fs::read(&path).expect("it can be read");
        folder.replace("third.ron", "(");
        folder.write("ball.ron", ball(color, EYE));
        sees(&mut session, &ball(color, EYE));
        session.wait_for_rest();
        assert_eq!(session.loads(), loads + 1, "only the scene is read again");
    }
    leave(&mut session);
}

#[test]
fn several_scenes_are_shown_in_turn() {
    let folder = Folder::new();
    let [red, lime, gold] =
        ["red", "lime", "gold"].map(|color| folder.write(&format!("{color}.ron"), ball(color, EYE)));
    let mut session = looking(&[&red, &lime, &gold]);
    for (key, color) in [(b"n", "lime"), (b"n", "gold"), (b"n", "red"), (b"p", "gold"), (b"p", "lime")] {
        turn_to(&mut session, key, color);
        sees(&mut session, &ball(color, EYE));
    }
    // The scene that is shown is the one that is watched.
    folder.write("lime.ron", ball("teal", EYE));
    sees(&mut session, &ball("teal", EYE));
    // Each scene keeps its view.
    session.send(b"d");
    session.wait_for_rest();
    turn_to(&mut session, b"n", "gold");
    sees(&mut session, &ball("gold", EYE));
    session.send(b"pi");
    session.wait_for("the moved eye", SOON, |seen| {
        let status = &seen.screen().text()[23];
        status.contains("eye") && !status.contains("eye 0.00 0.00 5.00")
    });
    assert!(leave(&mut session).contains("camera:"));
}

#[test]
fn a_broken_scene_among_several_is_reported_and_skipped() {
    let folder = Folder::new();
    let red = folder.write("red.ron", ball("red", EYE));
    let broken = folder.write("broken.ron", "(camera: 5)");
    let missing = folder.path("missing.ron");
    let mut session = looking(&[&red, &broken, &missing]);
    session.send(b"n");
    session.wait_for_text("broken.ron:1:10: expected a camera");
    session.send(b"n");
    session.wait_for_text("missing.ron: there is no such file");
    // The missing file may be written later.
    folder.write("missing.ron", ball("lime", EYE));
    sees(&mut session, &ball("lime", EYE));
    turn_to(&mut session, b"n", "red");
    sees(&mut session, &ball("red", EYE));
    leave(&mut session);
}

#[test]
fn the_built_in_scene_is_the_default() {
    let mut session = program().env("TERMTRACE_HINT", "true").spawn();
    session.wait_for_text("termtrace FILE opens yours");
    // The message stays until the first key, here one without a binding.
    session.send(b"\x1b[24~");
    sees(&mut session, include_str!("../../scenes/three_spheres.ron"));
    leave(&mut session);
}

/// On a small screen the error is hidden and the picture has all rows.
#[test]
fn errors_are_hidden_on_a_small_screen() {
    let folder = Folder::new();
    let path = folder.write("ball.ron", ball("red", EYE));
    let mut session = looking(&[&path]);
    folder.write("ball.ron", "(camera: 5)");
    session.wait_for_text("expected a camera");
    session.resize(Size::cells(39, 24));
    session.wait_for("the picture alone", SOON, |seen| !seen.screen().text().concat().contains("camera"));
    session.resize(Size::cells(80, 24));
    session.wait_for_text("expected a camera");
    leave(&mut session);
}
