//! Limits in time.
//!
//! Each is three times the promise, and one of three measurements is within it, as the machine may be busy.
//!
//! The figures themselves are taken by hand, from the output of these tests (`cargo test --test slow -- --nocapture
//! --test-threads 1`).

#![cfg(feature = "test-hooks")]

mod gravel;
mod mesh_writers;
#[path = "slow/paths.rs"]
mod paths;
mod pty;

use gravel::gravel;
use mesh_writers::{ball, written};
use pty::{
    Answer, Fault, Phases, SOON, Seen, Session, Size, Start, Which, best_of_three, picture_with, shows, within_limit,
};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use rustix::process::Signal;
use rustix::time::{ClockId, clock_gettime};
use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::ExitStatus;
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};
use tempfile::NamedTempFile;
use termtrace::internals::progress::Cancellation;
use termtrace::{Cancelled, CellMode, Render, Resolution, Sampling, Scene, SceneState, SceneView};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron");
const PROGRAM: &str = env!("CARGO_BIN_EXE_termtrace");

/// The longest time to leave a terminal that has stopped reading.
const MAX_STOPPED_TIME: Duration = Duration::from_secs(2);
/// The longest time to leave while a mesh is loading.
const MAX_LOADING_TIME: Duration = Duration::from_millis(200);
/// The longest time to leave a terminal that has never replied. A wait for a reply would take a
/// second.
const MAX_SILENT_TIME: Duration = Duration::from_millis(250);
/// The longest time until a key is seen while the terminal loses a reply, before the first reply
/// and after it.
const MAX_KEY_TIMES: [Duration; 2] = [Duration::from_millis(500), Duration::from_millis(250)];
/// The longest time to leave a terminal that has vanished.
const MAX_VANISHED_TIME: Duration = Duration::from_secs(1);
/// The most CPU time that this takes, in hundredths of a second.
const MAX_VANISHED_TICKS: u64 = 10;
/// The indices of the lost replies: those at the start, where the program knows least, and some
/// later ones.
const LOST_REPLIES: [usize; 11] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
/// The longest time until a saved scene is shown.
const MAX_RELOAD_TIME: Duration = Duration::from_millis(100);
/// The longest time until a cancelled render has ended.
const MAX_CANCEL_TIME: Duration = Duration::from_millis(50);
/// The longest CPU time of a draw call, for 95 of 100 calls.
///
/// The program of ratatui has one pane, traced in the background with the best samples, at 200x60 cells.
const MAX_DRAW_TIME: Duration = Duration::from_millis(5);
/// The longest time until a saved mesh is shown, in times that it takes to read and build it.
const MAX_MESH_RELOAD_RATIO: f64 = 1.2;

/// Waits for the exit, which has a limit.
#[track_caller]
fn exit_within(limit: Duration, what: &str, session: &mut Session) -> ExitStatus {
    let start = Instant::now();
    session.wait_until_gone(SOON);
    let took = start.elapsed();
    println!("{what}: left in {took:?}");
    within_limit(took < 3 * limit, format_args!("{what}: {took:?}"));
    session.wait_exit(SOON)
}

/// Leaves in the middle of a frame that is no longer read (Ctrl-S, a dead link), by a key, a signal
/// or a fault.
fn a_reader_that_stopped(what: &str, code: Option<i32>, act: impl FnOnce(&Session) -> Answer) -> ExitStatus {
    let mut phases = Phases::new();
    let start = Start::new(PROGRAM).arg(SCENE).size(Size::cells(300, 120));
    let mut session = start.env("TERMTRACE_TEST_SOCKET", phases.path()).spawn();
    session.stop_reading();
    phases.wait_for("frame");
    let answer = act(&session);
    phases.answer(answer);
    let status = exit_within(MAX_STOPPED_TIME, what, &mut session);
    assert_eq!(status.code(), code, "{what}");
    assert_eq!(session.termios_changes(), Vec::<String>::new(), "{what}");
    status
}

#[test]
fn a_reader_that_stopped_is_left_by_key() {
    best_of_three(|| {
        for key in [&b"q"[..], b"\x03"] {
            a_reader_that_stopped("key", Some(0), |session| {
                session.send(key);
                Answer::GoOn
            });
        }
    });
}

#[test]
fn a_reader_that_stopped_is_left_by_signal() {
    best_of_three(|| {
        for signal in [Signal::TERM, Signal::HUP, Signal::INT, Signal::QUIT] {
            let status = a_reader_that_stopped("signal", None, |session| {
                session.signal(signal);
                Answer::GoOn
            });
            assert_eq!(status.signal(), Some(signal.as_raw()));
        }
    });
}

/// Standard error is the terminal too: the message must not wait for it.
#[test]
fn a_reader_that_stopped_is_left_by_fault() {
    best_of_three(|| {
        for (fault, code) in [(Answer::Error, 1), (Answer::Panic, 101), (Answer::WorkerPanic, 101)] {
            a_reader_that_stopped("fault", Some(code), |_| fault);
        }
    });
}

/// Returns the clock ticks of CPU of a process and its dead children; a hundred are a second.
#[cfg(target_os = "linux")]
fn ticks(session: &Session) -> u64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", session.pid().as_raw_nonzero())).expect("it is there");
    let fields: Vec<&str> = stat.rsplit(") ").next().expect("after the name").split(' ').collect();
    fields[11..15].iter().map(|ticks| ticks.parse::<u64>().expect("user and system time")).sum()
}

/// Removes the terminal. The process ends, whether it handles the signal or not.
#[cfg(target_os = "linux")]
fn a_terminal_that_vanishes(what: &str, hears: bool, before: impl FnOnce(&mut Session)) {
    let what = format!("{what}, SIGHUP {}", if hears { "heard" } else { "ignored" });
    vanish(&what, hears, if hears { looking() } else { looking_without_sighup() }, before);
}

#[cfg(target_os = "linux")]
fn vanish(what: &str, hears: bool, start: Start, before: impl FnOnce(&mut Session)) {
    let mut session = start.spawn();
    session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 1_000);
    session.sees(Duration::from_millis(200), |_| false);
    before(&mut session);
    let used = ticks(&session);
    session.vanish();
    let status = exit_within(MAX_VANISHED_TIME, what, &mut session);
    let used = ticks(&session) - used;
    println!("{what}: {used} ticks, {status}");
    within_limit(used < 3 * MAX_VANISHED_TICKS, format_args!("{what}: {used} ticks"));
    let (code, signal) = if hears { (None, Some(Signal::HUP.as_raw())) } else { (Some(1), None) };
    assert_eq!((status.code(), status.signal()), (code, signal), "{what}");
}

#[cfg(target_os = "linux")]
fn looking() -> Start {
    Start::new(PROGRAM).arg(SCENE)
}

#[cfg(target_os = "linux")]
fn looking_without_sighup() -> Start {
    Start::shell(&format!("trap '' HUP; exec '{PROGRAM}' '{SCENE}'"))
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_vanishes_at_rest_is_left() {
    best_of_three(|| {
        for hears in [true, false] {
            a_terminal_that_vanishes("at rest", hears, |_| {});
        }
    });
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_vanishes_in_flight_is_left() {
    best_of_three(|| {
        for hears in [true, false] {
            a_terminal_that_vanishes("in flight", hears, |session| session.send(b"w"));
        }
    });
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_vanishes_in_mid_frame_is_left() {
    best_of_three(|| {
        for hears in [true, false] {
            a_terminal_that_vanishes("in mid-frame", hears, |session| {
                session.stop_reading();
                session.send(b"\x0c");
                session.wait_for_no_reader();
            });
        }
    });
}

/// The screen vanishes; the keys come from another terminal, which stays.
///
/// The leader of the session, here a shell, gets more signals.
#[cfg(target_os = "linux")]
#[test]
fn a_screen_that_vanishes_while_the_keys_stay() {
    best_of_three(|| {
        let keys = Start::shell("read line").spawn();
        let start = Start::shell(&format!("trap '' HUP; '{PROGRAM}' '{SCENE}'; exit $?"));
        vanish("the screen alone", false, start.stdin(keys.terminal()), |_| {});
    });
}

/// A mesh that does not come does not delay leaving.
#[test]
fn a_mesh_that_does_not_come_is_left() {
    best_of_three(|| {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join("x.ply");
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(made.is_ok_and(|status| status.success()), "a pipe with a name can be made");
        for (key, signal) in [(&b"q"[..], None), (b"\x03", None), (b"", Some(Signal::TERM))] {
            let mut session = Start::new(PROGRAM).arg(&path).spawn();
            let pipe = std::fs::OpenOptions::new().write(true).open(&path).expect("it is read");
            session.wait_for_text("reading x.ply");
            match signal {
                Some(signal) => session.signal(signal),
                None => session.send(key),
            }
            let status = exit_within(MAX_LOADING_TIME, "while it reads", &mut session);
            assert_eq!(status.signal(), signal.map(Signal::as_raw));
            drop(pipe);
        }
    });
}

/// Replaces a file at once, as editors do, and returns the time until the middle of the screen
/// changes.
fn reload(session: &mut Session, path: &Path, contents: &[u8]) -> Duration {
    let new = path.with_extension("new");
    std::fs::write(&new, contents).expect("a file can be written");
    let middle = |seen: &Seen| seen.screen().cell(40, 12);
    let before = middle(session.seen());
    let start = Instant::now();
    std::fs::rename(new, path).expect("a file can be renamed");
    session.wait_for("another picture", SOON, |seen| middle(seen) != before);
    start.elapsed()
}

/// Returns a scene that shows a mesh in that colour.
fn scene_of_mesh(color: &str) -> String {
    format!(
        "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, background: \"navy\",
        objects: [Mesh(path: \"ball.stl\", material: Diffuse(\"{color}\"))])"
    )
}

/// Returns the text of a scene with one ball of a colour.
fn scene_of_ball(color: &str) -> String {
    format!(
        "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, background: \"navy\",
        objects: [Sphere(center: (0, 0, 0), radius: 1, material: Diffuse(\"{color}\"))])"
    )
}

#[test]
fn a_saved_scene_is_shown_soon() {
    best_of_three(|| {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join("ball.ron");
        std::fs::write(folder.path().join("ball.stl"), written(&ball(200), "binary.stl"))
            .expect("a file can be written");
        std::fs::write(&path, scene_of_mesh("white")).expect("a file can be written");
        let mut session = Start::new(PROGRAM).arg(&path).spawn();
        session.wait_for("the ball", SOON, |seen| seen.screen().cell(40, 12) != seen.screen().cell(0, 0));
        for color in ["red", "lime", "gold", "white", "red", "lime", "gold", "white"] {
            let took = reload(&mut session, &path, scene_of_mesh(color).as_bytes());
            println!("a saved scene: seen after {took:?}");
            within_limit(took < 3 * MAX_RELOAD_TIME, format_args!("{took:?}"));
        }
    });
}

/// Returns a scene of `count` balls that cannot be seen, and one that can, in that colour.
#[cfg(target_os = "linux")]
fn balls(count: usize, color: &str) -> String {
    let balls = "Sphere(center: (9, 9, 9), radius: 0.1),\n".repeat(count);
    format!(
        "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, background: \"navy\",
        objects: [{balls} Sphere(center: (0, 0, 0), radius: 1, material: Diffuse(\"{color}\"))])"
    )
}

/// The most memory that a process has had, and what it has now, in kB.
#[cfg(target_os = "linux")]
fn memory(session: &Session) -> [f64; 2] {
    let status = std::fs::read_to_string(format!("/proc/{}/status", session.pid().as_raw_nonzero())).expect("it runs");
    ["VmHWM:", "VmRSS:"].map(|name| {
        let line = status.lines().find_map(|line| line.strip_prefix(name)).expect("the line is there");
        line.trim().trim_end_matches(" kB").parse().expect("a number")
    })
}

/// Returns the memory while a large scene is saved that many times, and after it.
#[cfg(target_os = "linux")]
fn saved(times: usize) -> [f64; 2] {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("balls.ron");
    std::fs::write(&path, balls(0, "white")).expect("a file can be written");
    let mut session = Start::new(PROGRAM).arg(&path).spawn();
    session.wait_for("the ball", SOON, |seen| seen.screen().cell(40, 12) != seen.screen().cell(0, 0));
    let middle = |seen: &Seen| seen.screen().cell(40, 12);
    let before = middle(session.seen());
    for save in 1..=times {
        std::fs::write(&path, balls(100_000, if save == times { "lime" } else { "white" }))
            .expect("a file can be written");
        if save < times {
            session.sees(Duration::from_millis(30), |_| false);
        }
    }
    session.wait_for("another picture", SOON, |seen| middle(seen) != before);
    session.sees(Duration::from_millis(500), |_| false);
    memory(&session)
}

/// A large scene that is saved again and again while it is read is read once at a time, and its
/// memory used again.
#[cfg(target_os = "linux")]
#[test]
fn many_saves_take_the_memory_of_one() {
    // The least of three, because the allocator keeps memory for each thread that has worked: by chance up to 1.9 times
    // as much stayed in one session as in another one with as many saves.
    let least = |times| {
        let of_two =
            |[most, now]: [f64; 2], [other_most, other_now]: [f64; 2]| [most.min(other_most), now.min(other_now)];
        (0..3).map(|_| saved(times)).reduce(of_two).expect("three sessions")
    };
    let (one, many) = (least(1), least(30));
    println!("kB at most and afterwards: {one:?} for one save, {many:?} for 30");
    // 1.2 times is promised for what stays, and .88 measured for 12 MB of text; as everywhere here, three times that
    // excess. (Of a scene this small the allocator's own share varies: 1.21 was seen.)
    assert!(many[0] < 2.0 * one[0] && many[1] < 1.6 * one[1], "{one:?} {many:?}");
}

/// A saved mesh is shown after the time that it takes to read and build it, which is that of
/// `check`.
#[test]
fn a_saved_mesh_is_shown_once_it_is_built() {
    best_of_three(|| {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let (path, mesh) = (folder.path().join("ball.ron"), folder.path().join("ball.stl"));
        let [here, away] = [0.0, 9.0].map(|x| {
            let mut ball = ball(400_000);
            ball.positions.iter_mut().for_each(|position| position.x += x);
            written(&ball, "binary.stl")
        });
        std::fs::write(&mesh, &here).expect("a file can be written");
        std::fs::write(&path, scene_of_mesh("white")).expect("a file can be written");
        let mut session = Start::new(PROGRAM).arg(&path).spawn();
        session.wait_for("the ball", SOON, |seen| seen.screen().cell(40, 12) != seen.screen().cell(0, 0));
        for contents in [&away, &here, &away, &here] {
            let took = reload(&mut session, &mesh, contents);
            let start = Instant::now();
            let checked = std::process::Command::new(PROGRAM).arg("check").arg(&path).output();
            assert!(checked.is_ok_and(|output| output.status.success()));
            let built = start.elapsed();
            println!("a saved mesh: seen after {took:?}, read and built in {built:?}");
            within_limit(
                took < built.mul_f64(3.0 * MAX_MESH_RELOAD_RATIO) + 3 * MAX_RELOAD_TIME,
                format_args!("{took:?}, built in {built:?}"),
            );
        }
    });
}

/// Returns the coordinates of the eye in the figures that `i` shows.
fn eye(seen: &Seen) -> Option<String> {
    let text = seen.screen().text();
    text.iter().find_map(|line| Some(line.split_once("· eye ")?.1.trim_end().to_owned()))
}

/// Returns the time until the slowest key press is seen, with faults of replies up to the `last`
/// one.
fn slowest_key(reports_modes: bool, fault: Fault, which: Which, last: usize) -> Duration {
    let start = Start::new(PROGRAM).arg(SCENE).arg("--reduced-motion").with_fault(fault, which);
    let start = if reports_modes { start.reports_modes() } else { start };
    let mut session = start.spawn();
    session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 1_000);
    let (mut slowest, mut presses) = (Duration::ZERO, 0);
    while session.replies() < last + 6 {
        let before = eye(session.seen());
        let pressed = Instant::now();
        session.send(if presses == 0 { b"i" } else { b"d" });
        session.wait_for("key to be seen", SOON, |seen| eye(seen).is_some_and(|eye| Some(eye) != before));
        slowest = slowest.max(pressed.elapsed());
        presses += 1;
        assert!(presses < 200, "the terminal is no longer asked");
    }
    session.send(b"q");
    session.wait_exit(SOON);
    session.assert_clean();
    slowest
}

/// A key waits for no reply that is lost, doubled, garbled or late, whichever it is.
#[test]
fn a_lost_reply_does_not_delay_a_key() {
    let faults = [Fault::Lost, Fault::Doubled, Fault::Garbled, Fault::Late(Duration::from_secs(20))];
    let which: Vec<_> = LOST_REPLIES.map(Which::Only).into_iter().chain([Which::EachThirdFrom(1)]).collect();
    for (reports_modes, fault) in [true, false].into_iter().flat_map(|modes| faults.map(|fault| (modes, fault))) {
        let wait = |which| match which {
            Which::Only(reply) => slowest_key(reports_modes, fault, which, reply),
            Which::EachThirdFrom(_) => slowest_key(reports_modes, fault, which, 12),
        };
        // Side by side, because they mostly wait; but few, because each begins with a picture.
        for which in which.chunks(6) {
            best_of_three(|| {
                let waits: Vec<_> = std::thread::scope(|scope| {
                    let sessions: Vec<_> = which.iter().map(|&which| scope.spawn(move || wait(which))).collect();
                    sessions.into_iter().map(|session| session.join().expect("keys are seen")).collect()
                });
                println!("reports modes: {reports_modes}, {fault:?}, {which:?}: {waits:.0?}");
                // Until the second reply the terminal has not replied to a frame.
                let limit =
                    |which| MAX_KEY_TIMES[usize::from(!matches!(which, Which::Only(1 | 2) | Which::EachThirdFrom(_)))];
                within_limit(
                    which.iter().zip(&waits).all(|(&which, &wait)| wait < 3 * limit(which)),
                    format_args!("{waits:?}"),
                );
            });
        }
    }
}

const LARGE: Size = Size { columns: 120, rows: 40, cell: (10, 20) };

/// Starts a session in which a refinement has just begun.
fn refining(scene: &NamedTempFile) -> (Session, Phases) {
    let mut phases = Phases::new();
    let start = Start::new(PROGRAM).arg(scene.path()).size(LARGE);
    let mut session = start.env("TERMTRACE_TEST_SOCKET", phases.path()).spawn();
    phases.wait_for_on("refinement", &mut session);
    (session, phases)
}

/// A long refinement is given up at a key press.
#[test]
fn a_key_does_not_wait_for_a_refinement() {
    best_of_three(|| {
        let scene = gravel();
        let loaded = Scene::load(scene.path()).unwrap_or_else(|error| panic!("{error}"));
        let cells = termtrace::Size::new(LARGE.columns, LARGE.rows);
        let wanted = picture_with(Sampling::BEST, &loaded, CellMode::HALF_BLOCK, cells, 2.0);
        let (mut session, phases) = refining(&scene);
        let start = Instant::now();
        phases.answer(Answer::GoOn);
        session.wait_for("the end", 6 * SOON, |seen| shows(seen.screen(), &wanted));
        let refined = start.elapsed();

        let (mut session, phases) = refining(&scene);
        let before = session.seen().bytes().len();
        session.send(b"w");
        let start = Instant::now();
        phases.answer(Answer::GoOn);
        // The bytes are more than a query.
        session.wait_for("another picture", 6 * SOON, |seen| seen.bytes().len() > before + 1_000);
        let seen = start.elapsed();

        let (mut session, phases) = refining(&scene);
        session.send(b"q");
        let start = Instant::now();
        phases.answer(Answer::GoOn);
        assert_eq!(session.wait_exit(6 * SOON).code(), Some(0));
        let left = start.elapsed();
        println!("refined in {refined:?}, a key seen in {seen:?}, left in {left:?}");
        within_limit(seen * 4 < refined, format_args!("a key was seen after {seen:?} of {refined:?}"));
        within_limit(left * 4 < refined, format_args!("left after {left:?} of {refined:?}"));
    });
}

/// The limit of `--max-rate` is kept, and used.
#[test]
fn the_rate_is_kept() {
    best_of_three(|| {
        for quality in ["exact", "equal"] {
            let start = Start::new(PROGRAM).arg(SCENE).arg("--max-rate").arg("20k").arg("--quality").arg(quality);
            let mut session = start.spawn();
            session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 1_000);
            // The first frame is through.
            session.sees(Duration::from_secs(2), |_| false);
            let (before, start) = (session.seen().bytes().len(), Instant::now());
            for _ in 0..20 {
                session.send(b"d");
                session.sees(Duration::from_millis(100), |_| false);
            }
            let bytes = session.seen().bytes().len() - before;
            let rate = bytes as f64 / start.elapsed().as_secs_f64();
            println!("{quality}: {rate:.0} bytes a second");
            // With a frame that has just been sent; a third of the least, as everywhere here.
            within_limit((5_000.0 / 3.0..35_000.0).contains(&rate), format_args!("{quality}: {rate} bytes a second"));
        }
    });
}

/// A terminal that has replied to all queries is left without waiting for another reply.
#[test]
fn a_terminal_that_has_sent_all_replies_is_left_at_once() {
    best_of_three(|| {
        let mut session = Start::new(PROGRAM).arg(SCENE).says_when_it_rests().spawn();
        session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 1_000);
        session.wait_for_rest();
        session.send(b"q");
        exit_within(MAX_SILENT_TIME, "all answered", &mut session);
        session.assert_clean();
    });
}

/// A terminal that has not replied for three seconds is not waited for.
#[test]
fn a_terminal_that_has_never_replied_is_left_at_once() {
    best_of_three(|| {
        let mut session = Start::new(PROGRAM).arg(SCENE).mute().says_when_it_rests().spawn();
        session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 1_000);
        // The three seconds are those after the last query, which is sent with the last refinement.
        session.wait_for_rest();
        session.sees(Duration::from_millis(3_200), |_| false);
        session.send(b"q");
        exit_within(MAX_SILENT_TIME, "never answered", &mut session);
        session.assert_clean();
    });
}

/// A cancel ends a render in any phase, of a picture of 10 million pixels.
#[test]
fn a_cancelled_render_ends_at_once() {
    best_of_three(|| {
        let scene = Scene::load(Path::new(SCENE)).expect("the scene is fine");
        let each = Sampling::Each(NonZeroU32::new(4).expect("4 is not 0"));
        for sampling in [Sampling::Coarse, each, Sampling::BEST] {
            for part in [0.02, 0.3, 0.6, 0.9] {
                let (token, cancelled) = (Cancellation::default(), OnceLock::new());
                let cancel = |done| {
                    if done >= part {
                        cancelled.get_or_init(|| {
                            token.cancel();
                            Instant::now()
                        });
                    }
                    ControlFlow::Continue(())
                };
                let render = Render::new(&scene).resolution(Resolution::square(4000, 2500)).sampling(sampling);
                assert_eq!(render.cancelled_by(&token).on_progress(cancel).run(), Err(Cancelled));
                let took = cancelled.get().expect("it was cancelled").elapsed();
                println!("{sampling:?} cancelled at {part}: given up in {took:?}");
                within_limit(took < 3 * MAX_CANCEL_TIME, format_args!("{sampling:?} at {part}: {took:?}"));
            }
        }
    });
}

/// The CPU time of the draw thread is measured.
///
/// On a busy machine a draw call may last longer although it traces nothing.
#[test]
fn a_draw_call_with_a_pane_in_the_background_is_short() {
    best_of_three(|| {
        let scene = Scene::load(Path::new(SCENE)).expect("a scene");
        let (wake, woken) = channel();
        let mut state = SceneState::new(scene.camera()).in_background(move || _ = wake.send(()));
        let view = SceneView::new(&scene).sampling(Sampling::BEST);
        let mut terminal = Terminal::new(TestBackend::new(200, 60)).expect("a backend without errors");
        let cpu = || Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).expect("it is not negative");
        let mut draws: Vec<_> = (0..100)
            .map(|_| {
                state.orbit(0.01, 0.0);
                let start = cpu();
                terminal
                    .draw(|frame| frame.render_stateful_widget(&view, frame.area(), &mut state))
                    .expect("no errors");
                let took = cpu().saturating_sub(start);
                // So each has a new picture to show, and the next one is being traced.
                woken.recv().expect("the thread is there");
                took
            })
            .collect();
        draws.sort_unstable();
        println!("a draw call: {:?}, the 95th of 100 {:?}", draws[50], draws[95]);
        within_limit(draws[95] < 3 * MAX_DRAW_TIME, format_args!("{:?}", draws[95]));
    });
}
