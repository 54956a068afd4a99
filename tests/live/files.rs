//! Files that the live view writes: pictures, cameras, and views in the scene's file.

use crate::pty::{self, SOON, Session, Start, shows};
use std::fs;
use std::path::Path;
use tempfile::TempDir;
use termtrace::internals::scene::with_view;
use termtrace::{CellMode, Scene, export};

const TEXT: &str = "// Mine.
(
    camera: (eye: (0, 1, 5), target: (0, 0, 0)), // from in front
    lights: [Point(position: (3, 4, 5), intensity: 40)],
    objects: [Sphere(center: (0, 0, 0), radius: 1, material: Diffuse(\"tomato\"))],
)
";

/// Returns a folder with `ball.ron`, in which the program runs.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fs::write(folder.path().join("ball.ron"), TEXT).expect("a file can be written");
    folder
}

fn looking(folder: &TempDir) -> Session {
    let mut session = started(folder, "ball.ron");
    sees_all(&mut session, TEXT);
    session
}

fn started(folder: &TempDir, arguments: &str) -> Session {
    let program = env!("CARGO_BIN_EXE_termtrace");
    let script = format!("cd '{}' && exec '{program}' {arguments}", folder.path().display());
    Start::shell(&script).spawn()
}

/// Waits for the picture of the scene without anything over it.
#[track_caller]
fn sees_all(session: &mut Session, text: &str) {
    let wanted = grid(text);
    session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
}

fn grid(text: &str) -> termtrace::Grid {
    let scene = Scene::from_ron("wanted", text).expect("the scene is fine");
    pty::picture(&scene, CellMode::HALF_BLOCK, termtrace::Size::new(80, 24), 2.0)
}

fn leave(session: &mut Session) {
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

fn read(folder: &TempDir, name: &str) -> String {
    String::from_utf8_lossy(&fs::read(folder.path().join(name)).expect(name)).into_owned()
}

#[test]
fn the_picture_is_written_in_five_formats_and_never_over_a_file() {
    let folder = folder();
    let mut session = looking(&folder);
    for (key, name) in [
        ("p", "ball.png"),
        ("a", "ball.ansi"),
        ("t", "ball.txt"),
        ("s", "ball.svg"),
        ("h", "ball.html"),
        ("s", "ball-2.svg"),
    ] {
        session.send(b"o");
        session.wait_for_text("save picture as");
        session.send(key.as_bytes());
        session.wait_for_text(&format!("written: {name}"));
    }
    // The saved picture has no panels.
    let grid = grid(TEXT);
    assert_eq!(read(&folder, "ball.svg"), export::svg(&grid, 2.0));
    assert_eq!(read(&folder, "ball-2.svg"), read(&folder, "ball.svg"));
    assert_eq!(read(&folder, "ball.html"), export::html(&grid, 2.0));
    assert_eq!(read(&folder, "ball.ansi").into_bytes(), export::ansi(&grid));
    let text = read(&folder, "ball.txt");
    assert!(text.lines().count() == 24 && text.contains('*') && text.is_ascii(), "{text}");
    assert!(fs::read(folder.path().join("ball.png")).is_ok_and(|png| png.starts_with(b"\x89PNG")));
    // Any other key answers no.
    session.send(b"o");
    session.wait_for_text("save picture as");
    session.send(b"\x1b");
    sees_all(&mut session, TEXT);
    assert_eq!(fs::read_dir(folder.path()).expect("the folder is there").count(), 7);
    leave(&mut session);
}

/// A full disk gives an error in the middle of the file.
#[test]
fn a_full_disk_leaves_no_picture_and_the_old_scene() {
    let folder = folder();
    // The scene is longer than the limit of files.
    let text = format!("// {}\n{TEXT}", "x".repeat(4000));
    fs::write(folder.path().join("ball.ron"), &text).expect("a file can be written");
    let limits = "trap '' XFSZ && ulimit -f 2";
    let program = env!("CARGO_BIN_EXE_termtrace");
    let script = format!("cd '{}' && {limits} && exec '{program}' ball.ron", folder.path().display());
    let mut session = Start::shell(&script).spawn();
    sees_all(&mut session, TEXT);
    session.send(b"o");
    session.wait_for_text("save picture as");
    session.send(b"s");
    session.wait_for_text("could not write the picture: File too large");
    session.send(b"Y");
    session.wait_for_text("  yes");
    session.send(b"y");
    session.wait_for_text("scene file left unchanged: File too large");
    assert_eq!(read(&folder, "ball.ron"), text);
    assert_eq!(fs::read_dir(folder.path()).expect("the folder is there").count(), 1);
    leave(&mut session);
}

#[test]
fn a_view_is_written_into_the_scene_after_a_yes() {
    let folder = folder();
    let mut session = started(&folder, "ball.ron --eye 2,1,4");
    sees_all(&mut session, &TEXT.replace("0, 1, 5", "2, 1, 4"));
    for no in ["n", "\x1b", "x"] {
        session.send(b"Y");
        session.wait_for_text("ball.ron");
        session.send(no.as_bytes());
        session.wait_for("no question", SOON, |seen| !seen.screen().text().concat().contains("ball.ron"));
        assert_eq!(read(&folder, "ball.ron"), TEXT);
    }
    session.send(b"Y");
    session.wait_for_text("  yes");
    session.send(b"y");
    session.wait_for_text("view saved to the scene file");
    let scene = Scene::load(&folder.path().join("ball.ron")).expect("it is a scene");
    assert_eq!(scene.views().len(), 1);
    assert_eq!(scene.views()[0].pose().eye, glam::Vec3::new(2.0, 1.0, 4.0));
    assert_eq!(Some(read(&folder, "ball.ron")), with_view(TEXT, &scene.views()[0]));
    leave(&mut session);
}

#[test]
fn a_scene_that_has_changed_is_left_alone() {
    let folder = folder();
    let mut session = looking(&folder);
    session.send(b"Y");
    session.wait_for_text("  yes");
    let changed = TEXT.replace("Mine", "Changed");
    fs::write(folder.path().join("ball.ron"), &changed).expect("a file can be written");
    session.send(b"y");
    session.wait_for_text("it has changed in the meantime");
    assert_eq!(read(&folder, "ball.ron"), changed);
    leave(&mut session);
}

#[test]
fn the_camera_is_copied() {
    let folder = folder();
    let mut session = looking(&folder);
    session.send(b"y");
    session.wait_for_text("camera copied");
    let line = format!("{},", Scene::from_ron("x", TEXT).expect("a scene").camera().to_ron());
    let encoded = base64(line.as_bytes());
    assert!(session.seen().has(format!("\x1b]52;c;{encoded}\x1b\\").as_bytes()));
    leave(&mut session);
}

fn base64(bytes: &[u8]) -> String {
    use base64::Engine;
    base64::engine::general_purpose::STANDARD.encode(bytes)
}

/// A built-in scene has no file to keep a view in.
#[test]
fn a_built_in_scene_saves_no_view() {
    let program = Path::new(env!("CARGO_BIN_EXE_termtrace"));
    let mut session = Start::new(program).env("TERMTRACE_HINT", "true").spawn();
    session.wait_for_text("termtrace FILE opens yours");
    session.send(b"Y");
    session.wait_for_text("this scene has no scene file to save views to");
    leave(&mut session);
}
