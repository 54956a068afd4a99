//! A large mesh that loads: what is reported and can be done meanwhile, and every way out.

#![cfg(feature = "test-hooks")]

use crate::mesh_writers::{ball, written};
use crate::pty::{self, Answer, Phases, SOON, Session, Size, Start, shows, until_in_time};
use rustix::process::Signal;
use std::fs;
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::PathBuf;
use std::process::Command;
use std::sync::LazyLock;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;
use tempfile::TempDir;
use termtrace::internals::mesh_file::MeshFile;
use termtrace::{CellMode, Scene};

const PROGRAM: &str = env!("CARGO_BIN_EXE_termtrace");

/// Returns a ball that is large enough to be sketched.
fn big_ball() -> Vec<u8> {
    static BALL: LazyLock<Vec<u8>> = LazyLock::new(|| written(&ball(150_000), "binary.stl"));
    BALL.clone()
}

/// A mesh that comes through a pipe when the test wants.
///
/// Until then a byte comes now and then, because a pipe that delivers nothing for a second is given up.
struct Source {
    folder: TempDir,
    rest: Sender<Vec<u8>>,
}

/// The time between two bytes of a mesh that does not end yet.
const NOW_AND_THEN: Duration = Duration::from_millis(100);

impl Source {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join("ball.stl");
        let made = Command::new("mkfifo").arg(&path).status();
        assert!(made.is_ok_and(|status| status.success()), "a pipe with a name can be made");
        let (rest, wanted) = channel::<Vec<u8>>();
        // Made before the pipe is opened: the child waits no longer than a second for its first byte.
        let ball = big_ball();
        std::thread::spawn(move || {
            // This waits for the child, which may leave in the middle.
            let mut pipe = fs::OpenOptions::new().write(true).open(path)?;
            // The balls of the tests begin alike.
            for (written, byte) in ball.into_iter().enumerate() {
                match wanted.recv_timeout(NOW_AND_THEN) {
                    Ok(whole) => return pipe.write_all(&whole[written..]),
                    Err(RecvTimeoutError::Timeout) => pipe.write_all(&[byte])?,
                    Err(RecvTimeoutError::Disconnected) => break,
                }
            }
            Ok(())
        });
        Self { folder, rest }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("ball.stl")
    }

    /// Sends the rest of the mesh.
    fn end(&mut self, whole: Vec<u8>) {
        self.rest.send(whole).expect("the child reads");
    }
}

/// Starts the view with a mesh of which next to nothing has come.
fn waiting(start: Start, source: &Source) -> Session {
    let mut session = start.arg(source.path()).says_when_it_rests().spawn();
    session.wait_for_text("reading ball.stl");
    session
}

fn program() -> Start {
    Start::new(PROGRAM)
}

/// Starts the view with a ball that is read, and holds the child before it is built.
fn sketched(start: Start, source: &mut Source, phases: &mut Phases) -> Session {
    let start = start.arg("--mesh-up").arg("y");
    let mut session = start.arg(source.path()).env("TERMTRACE_TEST_SOCKET", phases.path()).spawn();
    phases.wait_for_on("all modes", &mut session);
    phases.send(Answer::GoOn);
    source.end(big_ball());
    phases.wait_for_on("build", &mut session);
    session.wait_for("a sketch", SOON, |seen| has_picture(seen.screen()));
    session
}

/// Returns whether a picture covers all rows, with or without a panel on it.
fn has_picture(screen: &pty::Screen) -> bool {
    [0, 23].into_iter().all(|row| (0..80).all(|column| screen.cell(column, row).background != pty::Colour::Default))
}

/// Lets the child go on at all later phases.
fn pass(mut phases: Phases) {
    phases.send(Answer::GoOn);
}

const WAYS: [(&[u8], Option<Signal>); 6] = [
    (b"q", None),
    (b"\x03", None),
    (b"", Some(Signal::TERM)),
    (b"", Some(Signal::HUP)),
    (b"", Some(Signal::INT)),
    (b"", Some(Signal::QUIT)),
];

#[track_caller]
fn leave(session: &mut Session, (keys, signal): (&[u8], Option<Signal>)) {
    match signal {
        Some(signal) => session.signal(signal),
        None => session.send(keys),
    }
    let status = session.wait_exit(SOON);
    let code = if signal.is_some() { None } else { Some(0) };
    assert_eq!((status.code(), status.signal()), (code, signal.map(Signal::as_raw)));
    session.assert_clean();
    assert!(!session.seen().screen().is_alternate());
}

#[test]
fn the_view_can_be_left_while_it_reads() {
    for way in WAYS {
        let source = Source::new();
        leave(&mut waiting(program(), &source), way);
    }
}

/// While the pipe delivers next to nothing, nothing is written or computed; a key has nothing to
/// move.
#[test]
fn a_slow_pipe_causes_no_output_and_no_work() {
    let source = Source::new();
    let mut session = waiting(program(), &source);
    session.send(b"w");
    session.wait_for_rest();
    leave(&mut session, WAYS[0]);
}

/// A pipe without a writer does not block: keys work, the error is reported, and the view ends.
#[test]
fn a_pipe_without_a_writer_is_reported_when_the_terminal_is_back() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("ball.stl");
    nix::unistd::mkfifo(&path, nix::sys::stat::Mode::S_IRWXU).expect("a pipe can be made");
    // The panel comes a tenth of a second after the start, if the machine is not too busy to show it before the error.
    until_in_time(|| {
        let mut session = program().arg(&path).spawn();
        assert_eq!(session.wait_exit(SOON).code(), Some(2));
        session.assert_clean();
        session.wait_for_text("ball.stl: this pipe delivered nothing for a second");
        session.seen().has(b"reading ball.stl")
    });
}

#[test]
fn the_view_can_be_left_while_it_builds() {
    for way in WAYS {
        let (mut source, mut phases) = (Source::new(), Phases::new());
        leave(&mut sketched(program(), &mut source, &mut phases), way);
    }
}

/// Returns the eye that the status line shows.
fn eye(seen: &pty::Seen) -> Option<String> {
    seen.screen().text().concat().rsplit("eye").next().map(str::to_owned)
}

/// Returns the picture of a scene that is whole.
fn picture(scene: &Scene, size: Size) -> termtrace::Grid {
    pty::picture(scene, CellMode::HALF_BLOCK, termtrace::Size::new(size.columns, size.rows), 2.0)
}

fn ball_scene() -> Scene {
    let mesh = MeshFile::from_bytes("ball.stl", &big_ball(), &mut |_| unreachable!("it names no file"));
    Scene::of_mesh(mesh.expect("it is a mesh")).expect("it has a size")
}

#[test]
fn a_sketch_can_be_looked_around_in_until_the_scene_is_there() {
    let (mut source, mut phases) = (Source::new(), Phases::new());
    let mut session = sketched(program(), &mut source, &mut phases);
    let wanted = picture(&ball_scene(), Size::cells(80, 24));
    assert!(!shows(session.seen().screen(), &wanted), "the sketch is coarse");
    // The eye flies in the sketch.
    session.send(b"i");
    session.wait_for_text(" sample");
    let before = eye(session.seen());
    session.send(b"w");
    session.wait_for("another view", SOON, |seen| eye(seen) != before);
    session.send(b"ri");
    phases.send(Answer::GoOn);
    phases.count_on("", &mut session, SOON, |seen| shows(seen.screen(), &wanted));
    phases.count_until_rest("", &mut session);
    drop(phases);
    assert!(shows(session.seen().screen(), &wanted), "at rest there is the scene");
    leave(&mut session, (b"q", None));
}

/// The whole scene is shown from the eye of its sketch.
#[test]
fn the_scene_is_seen_from_where_the_sketch_was() {
    let (mut source, mut phases) = (Source::new(), Phases::new());
    let mut session = sketched(program().arg("--reduced-motion"), &mut source, &mut phases);
    session.send(b"i");
    session.wait_for_text(" sample");
    let start = eye(session.seen());
    session.send(b"d");
    session.wait_for("a step", SOON, |seen| eye(seen) != start);
    let there = eye(session.seen());
    pass(phases);
    session.wait_for("the scene", SOON, |seen| !seen.screen().text().concat().contains('╯'));
    assert_eq!(eye(session.seen()), there);
    session.send(b"r");
    session.wait_for("the first view", SOON, |seen| eye(seen) != there);
    session.send(b"i");
    let home = picture(&ball_scene(), Size::cells(80, 24));
    session.wait_for("the first view", SOON, |seen| shows(seen.screen(), &home));
    leave(&mut session, (b"q", None));
}

/// A scene file whose mesh is large has a sketch and the same messages.
#[test]
fn a_scene_with_a_big_mesh_is_sketched_too() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fs::write(folder.path().join("ball.stl"), big_ball()).expect("a file can be written");
    let scene = folder.path().join("scene.ron");
    let text = r#"(
        camera: (eye: (0, 1, 4), target: (0, 0, 0)), background: "skyblue",
        lights: [Point(position: (3, 4, 5), intensity: 40)],
        objects: [Mesh(path: "ball.stl", material: Diffuse("tomato")), Sphere(center: (2, 0, 0), radius: 0.5)],
    )"#;
    fs::write(&scene, text).expect("a file can be written");
    let mut phases = Phases::new();
    let mut session = program().arg(&scene).env("TERMTRACE_TEST_SOCKET", phases.path()).spawn();
    phases.wait_for_on("build", &mut session);
    session.wait_for("a sketch", SOON, |seen| has_picture(seen.screen()));
    pass(phases);
    let wanted = picture(&Scene::load(&scene).expect("it is a scene"), Size::cells(80, 24));
    session.wait_for("the scene", SOON, |seen| shows(seen.screen(), &wanted));
    leave(&mut session, (b"q", None));
}

/// The panel fits, and is drawn again at another size and after a stop.
#[test]
fn the_panel_fits_any_screen() {
    let source = Source::new();
    let mut session = waiting(program().size(Size::cells(20, 5)), &source);
    for size in [Size::cells(80, 24), Size::cells(20, 5), Size::cells(200, 60)] {
        let before = session.seen().bytes().len();
        session.resize(size);
        session.wait_for("the panel", SOON, |seen| {
            let mut screen = pty::Screen::new(size.columns, size.rows);
            screen.feed(&seen.bytes()[before..]);
            let text = screen.text();
            let line = text.iter().position(|line| line.contains("│ reading ball.stl"));
            line.is_some_and(|line| text[line - 1].contains('╭') && text[line + 2].contains('╯'))
        });
    }
    session.resize(Size::cells(1, 1));
    leave(&mut session, (b"q", None));
}

#[test]
fn the_view_can_be_stopped_while_it_reads() {
    let source = Source::new();
    let path = source.path();
    let script =
        format!("set -m; '{PROGRAM}' '{}'; echo \"status <$?>\"; read line; fg >/dev/null; echo ended", path.display());
    let mut session = Start::shell(&script).spawn();
    session.wait_for_text("reading ball.stl");
    session.send(b"\x1a");
    session.wait_for_text("status <148>");
    session.assert_clean();
    session.send(b"\n");
    session.wait_for_text("reading ball.stl");
    session.send(b"q");
    session.wait_for_text("ended");
    session.assert_clean();
}

/// The terminal is given back; then one line of error follows, and exit code 2.
#[test]
fn errors_of_a_mesh_are_reported_when_the_terminal_is_back() {
    let mut wrong = big_ball();
    // More than one facet in a hundred.
    for facet in wrong[84..].chunks_exact_mut(50).skip(1000).step_by(50) {
        facet[12..16].copy_from_slice(&f32::NAN.to_le_bytes());
    }
    let mut source = Source::new();
    let mut session = waiting(program(), &source);
    source.end(wrong.clone());
    assert_eq!(session.wait_exit(SOON).code(), Some(2));
    session.assert_clean();
    let folder = tempfile::tempdir().expect("a folder can be made");
    fs::write(folder.path().join("ball.stl"), wrong).expect("a file can be written");
    let plain = Command::new(PROGRAM).arg(folder.path().join("ball.stl")).output().expect("it starts");
    assert_eq!(plain.status.code(), Some(2));
    let message = String::from_utf8(plain.stderr).expect("it is text");
    let message = message.trim_end().split("ball.stl: ").nth(1).expect("it names the file");
    let told = String::from_utf8_lossy(session.seen().bytes()).into_owned();
    assert_eq!(told.matches(message).count(), 1, "{told}");
    assert!(told.rfind("\x1b[?") < told.find(message), "told before the terminal is given back");
}

/// The picture is there, and only its changes are not.
#[test]
fn a_file_that_cannot_be_watched_is_reported() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("x.ron");
    fs::write(&path, include_str!("../../scenes/three_spheres.ron")).expect("a file can be written");
    let mut phases = Phases::new();
    let mut session = program().arg(&path).env("TERMTRACE_TEST_SOCKET", phases.path()).spawn();
    phases.wait_for_on("watching", &mut session);
    phases.answer(Answer::Error);
    session.wait_for_text("changes to the scene's files will not be noticed: a test asked for an error");
    // A key without a binding ends the note.
    session.send(b"\x1b[24~");
    let wanted = picture(&Scene::load(&path).expect("it is a scene"), Size::cells(80, 24));
    session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
    leave(&mut session, (b"q", None));
}

#[test]
fn a_panic_while_it_builds_is_reported_when_the_terminal_is_back() {
    let (mut source, mut phases) = (Source::new(), Phases::new());
    let mut session = sketched(program(), &mut source, &mut phases);
    phases.answer(Answer::Panic);
    assert_eq!(session.wait_exit(SOON).code(), Some(101));
    session.assert_clean();
    let told = String::from_utf8_lossy(session.seen().bytes()).into_owned();
    assert!(told.rfind("\x1b[?") < told.find("a test asked for a panic"), "{told}");
}

/// A mesh that loads in a moment is shown without a panel. On a busy machine a moment may be too
/// short.
#[test]
fn a_small_mesh_comes_without_a_panel() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("ball.stl");
    fs::write(&path, written(&ball(2_000), "binary.stl")).expect("a file can be written");
    let mesh = Scene::of_mesh(MeshFile::load(&path).expect("it is a mesh")).expect("it has a size");
    let wanted = picture(&mesh, Size::cells(80, 24));
    let comes_alone = || {
        let mut session = program().arg("--mesh-up").arg("y").arg(&path).spawn();
        session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
        !["ing ball.stl", "building"].iter().any(|text| session.seen().has(text.as_bytes()))
    };
    assert!((0..10).any(|_| comes_alone()));
}
