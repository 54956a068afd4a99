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
    let page = export::html(&grid, 2.0).replace("<title>termtrace</title>", "<title>ball</title>");
    assert_eq!(read(&folder, "ball.html"), page);
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
    session.wait_for_text("saved as view 1 in ball.ron");
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

/// Returns the width and height of a PNG, from its header.
fn size_of_png(png: &[u8]) -> [u32; 2] {
    assert!(png.starts_with(b"\x89PNG"));
    [16, 20].map(|at| u32::from_be_bytes(png[at..at + 4].try_into().expect("four bytes")))
}

/// The large picture is the wanted view in the window's shape, and has a new name each time.
#[test]
fn a_large_picture_is_written_in_the_background() {
    let folder = folder();
    let mut session = looking(&folder);
    for name in ["ball.png", "ball-2.png"] {
        session.send(b"O");
        session.wait_for_text("Esc cancels");
        session.wait_for_text(&format!("written: {name}"));
        session.wait_for("no progress", SOON, |seen| !seen.screen().text().concat().contains("Esc cancels"));
    }
    let png = fs::read(folder.path().join("ball.png")).expect("it is there");
    // 80 by 24 cells of aspect 2.
    assert_eq!(size_of_png(&png), [1920, 1152]);
    let program = env!("CARGO_BIN_EXE_termtrace");
    let flags = "frame ball.ron --pixels 1920x1152 --samples best -o same.png";
    let script = format!("cd '{}' && '{program}' {flags}", folder.path().display());
    assert_eq!(Start::shell(&script).spawn().wait_exit(SOON).code(), Some(0));
    assert!(png == fs::read(folder.path().join("same.png")).expect("it is there"), "the same picture as a frame's");
    leave(&mut session);
}

/// A scene whose large picture takes long: many lights, and shadows of many balls.
fn slow_text() -> String {
    let lights: Vec<_> = (0..60).map(|i| format!("Point(position: ({i}, 9, 5), intensity: 1)")).collect();
    let balls: Vec<_> =
        (0..400).map(|i| format!("Sphere(center: ({}, {}, 0), radius: 0.2)", i % 20 - 10, i / 20 - 10)).collect();
    format!(
        "(camera: (eye: (0, 0, 20), target: (0, 0, 0)), lights: [{}], objects: [{}])",
        lights.join(", "),
        balls.join(", ")
    )
}

/// Keys are answered while a large picture is traced. Esc cancels it, and quitting leaves no file.
#[test]
fn a_large_picture_can_be_cancelled() {
    let folder = folder();
    fs::write(folder.path().join("slow.ron"), slow_text()).expect("a file can be written");
    let mut session = started(&folder, "slow.ron --reduced-motion");
    session.wait_for("the picture", SOON, |seen| seen.screen().text().concat().contains('▄'));
    session.send(b"O");
    session.wait_for_text("large picture");
    session.send(b"O");
    session.wait_for_text("a large picture is being made");
    session.send(b"v");
    session.wait_for_text("lambert: n.l");
    session.send(b"\x1b");
    session.wait_for_text("large picture cancelled");
    session.send(b"vvvvvvvvO");
    session.wait_for_text("large picture");
    leave(&mut session);
    let mut names: Vec<_> = fs::read_dir(folder.path())
        .expect("the folder is there")
        .map(|entry| entry.expect("it can be read").file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["ball.ron", "slow.ron"]);
}

/// A recording has the screens of the session, from a whole first one to the shown cursor.
#[test]
fn the_session_is_recorded() {
    let folder = folder();
    let mut session = looking(&folder);
    session.send(b"R");
    session.wait_for_text("recording the session");
    session.send(b"i");
    session.wait_for_text("samples");
    session.send(b"R");
    session.wait_for_text("written: ball.cast");
    let cast = read(&folder, "ball.cast");
    let mut terminal = avt::Terminal::new(80, 24).expect("a screen has cells");
    let mut lines = cast.lines();
    assert_eq!(lines.next(), Some(r#"{"version":2,"width":80,"height":24}"#));
    let (mut last, mut output) = (0.0, String::new());
    for line in lines {
        let (time, kind, text): (f64, String, String) = serde_json::from_str(line).expect("an event");
        assert!(time >= last && kind == "o", "{line}");
        (last, output) = (time, text);
        terminal.feed(&output);
        assert!(!output.contains("\x1b[c") && !output.contains("$p"), "no queries: {output:?}");
    }
    assert_eq!(output, "\x1b[m\x1b[?25h");
    let row = |row| terminal.screen().line(row).expect("a row").cells().iter().map(avt::Cell::char).collect::<String>();
    let shown: Vec<_> = (0..24).map(row).collect();
    assert!(shown[0].contains("REC") && shown.concat().contains("samples"), "{shown:#?}");
    assert!(shown[12].contains('▄'), "{shown:#?}");
    // A signal ends a recording as the key does.
    session.send(b"R");
    session.wait_for_text("recording the session");
    session.signal(rustix::process::Signal::TERM);
    session.wait_exit(SOON);
    assert!(read(&folder, "ball-2.cast").ends_with("\"\\u001b[m\\u001b[?25h\"]\n"));
    assert_eq!(fs::read_dir(folder.path()).expect("the folder is there").count(), 3);
}

/// A full disk ends a recording with a message, and leaves nothing.
#[test]
fn a_full_disk_ends_a_recording() {
    let folder = folder();
    let program = env!("CARGO_BIN_EXE_termtrace");
    let limits = "trap '' XFSZ && ulimit -f 4";
    let script = format!("cd '{}' && {limits} && exec '{program}' ball.ron", folder.path().display());
    let mut session = Start::shell(&script).spawn();
    sees_all(&mut session, TEXT);
    session.send(b"R");
    session.wait_for_text("the recording ended and was not kept: File too large");
    assert_eq!(fs::read_dir(folder.path()).expect("the folder is there").count(), 1);
    leave(&mut session);
}
