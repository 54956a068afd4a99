//! The live view on a real pseudo-terminal: keys and signals in, bytes and an exit status out.

use crate::pty::{self, Deadline, SOON, Session, Size, Start, shows, until_in_time, without_colors};
use rustix::process::Signal;
use std::fs::File;
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::time::{Duration, Instant};
use termtrace::internals::grid::HalfBlocks;
use termtrace::{CellMode, Colors, Encoder, Glyphs, Grid, Order, Scene};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/ball.ron");

fn program() -> Start {
    Start::new(env!("CARGO_BIN_EXE_termtrace")).says_when_it_rests()
}

fn termtrace() -> Start {
    program().arg(SCENE)
}

/// Returns the library's picture of the scene on such a screen.
fn picture(cell_mode: CellMode, size: Size) -> Grid {
    let scene = Scene::load(Path::new(SCENE)).expect("the scene is fine");
    let aspect = f32::from(size.cell.1) / f32::from(size.cell.0);
    pty::picture(&scene, cell_mode, termtrace::Size::new(size.columns, size.rows), aspect)
}

#[track_caller]
fn wait_for_picture(session: &mut Session, size: Size) {
    let wanted = picture(CellMode::HALF_BLOCK, size);
    session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
}

/// Starts the view and waits for its picture.
#[track_caller]
fn looking(start: Start) -> Session {
    let mut session = start.spawn();
    wait_for_picture(&mut session, Size::cells(80, 24));
    session
}

#[track_caller]
fn leave(session: &mut Session) -> String {
    let before = session.seen().bytes().len();
    session.send(b"q");
    let status = session.wait_exit(SOON);
    assert_eq!(status.code(), Some(0));
    session.assert_clean();
    String::from_utf8_lossy(&session.seen().bytes()[before..]).into_owned()
}

#[test]
fn the_picture_is_the_librarys_and_q_leaves() {
    let mut session = looking(termtrace());
    assert!(session.seen().screen().is_alternate());
    let said = leave(&mut session);
    assert!(!said.contains("camera:"), "the camera was not moved: {said}");
    assert!(!session.seen().screen().is_alternate());
}

#[test]
fn the_first_frame_comes_without_a_clear() {
    let mut session = looking(termtrace());
    let bytes = session.seen().bytes().to_vec();
    assert!(!bytes.windows(4).any(|window| window == b"\x1b[2J"), "no clear");
}

#[test]
fn the_first_frame_is_sent_in_the_order_that_is_asked_for() {
    for (flags, order) in [
        (&[][..], Order::Raster),
        (&["--order=color"], Order::Color),
        (&["--order=raster"], Order::Raster),
        (&["--compressed-link"], Order::Raster),
    ] {
        let mut wanted = Vec::new();
        let mut encoder = Encoder::new().with_order(order).with_half_blocks(HalfBlocks::Either);
        encoder.encode(&picture(CellMode::HALF_BLOCK, Size::cells(80, 24)), &mut wanted);
        // With the best samples the first frame is the last one, too. Where loading takes longer than 100 ms, as on a
        // busy machine, a panel comes before the picture.
        let look = |_| looking(flags.iter().fold(termtrace().arg("--samples=best"), Start::arg));
        let has_no_panel = |session: &mut Session| !session.seen().has("╭".as_bytes());
        let mut session = (0..50).map(look).find_map(|mut session| has_no_panel(&mut session).then_some(session));
        let session = session.as_mut().expect("some load takes less than 100 ms");
        assert!(session.seen().has(&wanted), "{flags:?}");
    }
}

#[test]
fn ctrl_c_leaves() {
    let mut session = looking(termtrace());
    session.send(b"\x03");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

#[test]
fn a_signal_gives_the_terminal_back_and_ends_the_program() {
    for signal in [Signal::TERM, Signal::HUP, Signal::INT, Signal::QUIT] {
        let mut session = looking(termtrace());
        session.signal(signal);
        assert_eq!(session.wait_exit(SOON).signal(), Some(signal.as_raw()), "{signal:?}");
        session.assert_clean();
    }
}

/// Returns the eye of the `camera:` line that is printed on leaving.
fn eye_in(said: &str) -> [f32; 3] {
    let numbers = said.split("eye: (").nth(1).and_then(|rest| rest.split(')').next()).expect("an eye point is printed");
    let numbers: Vec<f32> = numbers.split(", ").map(|n| n.parse().expect("a number")).collect();
    numbers.try_into().expect("three numbers")
}

#[test]
fn a_press_moves_the_eye_for_its_time_and_the_camera_is_printed() {
    let mut session = looking(termtrace());
    session.send(b"w");
    // The scene's eye is at distance 5: the speed is 2.5 a second, a tap is 0.15 s of it, and its first frame shows a
    // sixtieth of a second already.
    session.send(b"i");
    session.wait_for_text("eye 0.00 1.00");
    let moved = 2.5 * 1.0 / 60.0;
    let said = leave(&mut session);
    let eye = eye_in(&said);
    // `i` ends the motion soon after its start.
    assert!(eye[2] < 5.0 - 0.9 * moved && eye[2] > 4.5, "{said}");
    assert_eq!([eye[0], eye[1]], [0.0, 1.0]);
    // The same as flags, in a comment, so that all of it can be pasted into a scene file.
    assert!(said.contains("// your last view, for a scene file or as flags:"), "{said}");
    assert!(said.contains(&format!("// --eye 0,1,{} --target 0,1,", eye[2])) && said.contains(" --fov 45"), "{said}");
}

#[test]
fn a_tap_is_a_small_step_of_the_same_length_every_time() {
    let mut session = looking(termtrace());
    session.send(b"w");
    let end = 5.0 - 2.5 * (0.15 + 1.0 / 60.0);
    session.wait_for_rest();
    let eye = eye_in(&leave(&mut session));
    assert!((eye[2] - end).abs() < 0.001, "{eye:?}, expected {end}");
}

#[test]
fn reset_brings_the_first_view_back_and_quiet_is_quiet() {
    let mut session = looking(termtrace());
    session.send(b"d");
    let wanted = picture(CellMode::HALF_BLOCK, Size::cells(80, 24));
    session.wait_for("another picture", SOON, |seen| !shows(seen.screen(), &wanted));
    session.send(b"r");
    wait_for_picture(&mut session, Size::cells(80, 24));
    assert!(!leave(&mut session).contains("camera:"));

    let mut session = looking(termtrace().arg("--quiet"));
    session.send(b"d");
    session.wait_for("another picture", SOON, |seen| !shows(seen.screen(), &wanted));
    assert!(!leave(&mut session).contains("camera:"));
}

#[test]
fn help_shows_every_group_is_filtered_and_goes_away() {
    let mut session = looking(termtrace());
    session.send(b"?");
    for text in ["Move", "WASD", "Space next page", "q close"] {
        session.wait_for_text(text);
    }
    session.send(b" ");
    for text in ["Mouse", "double click"] {
        session.wait_for_text(text);
    }
    session.send(b"turn");
    session.wait_for_text("keys: fly /turn");
    session.wait_for_text("turntable on or off (off)");
    session.wait_for("only what matches", SOON, |seen| !seen.screen().text().concat().contains("WASD"));
    session.send(b"\x1b");
    session.wait_for_text("WASD");
    // Neither the eye has moved nor the program ended.
    session.send(b"q");
    wait_for_picture(&mut session, Size::cells(80, 24));
    session.send(b"?");
    session.wait_for_text("first view");
    session.send(b"\x1b");
    wait_for_picture(&mut session, Size::cells(80, 24));
    leave(&mut session);
}

/// Inside an object every pixel has its colour: a line says why, and which keys help.
#[test]
fn a_line_says_when_nothing_is_visible() {
    let mut session = looking(termtrace().arg("--reduced-motion"));
    // Ten steps of a tenth of the way to the middle of the ball.
    session.send(b"wwwwwwwwww");
    session.wait_for_text("inside object ");
    session.wait_for_text("): r first view, f frame all");
    session.send(b"r");
    wait_for_picture(&mut session, Size::cells(80, 24));
    session.send(b"k".repeat(12).as_slice());
    session.wait_for_text("nothing in view: r first view, f frame all");
    leave(&mut session);
}

#[test]
fn the_status_line_shows_size_and_eye() {
    let mut session = looking(termtrace());
    session.send(b"i");
    for text in ["ball.ron", "80x24", " 64 samples", " ms", "eye 0.00 1.00 5.00"] {
        session.wait_for_text(text);
    }
    session.send(b"i");
    wait_for_picture(&mut session, Size::cells(80, 24));
    leave(&mut session);
}

/// At rest every cell has its exact colour.
#[test]
fn any_quality_is_exact_at_rest() {
    for quality in ["exact", "equal", "fast"] {
        let mut session = looking(termtrace().arg("--quality").arg(quality));
        session.send(b"d");
        let wanted = picture(CellMode::HALF_BLOCK, Size::cells(80, 24));
        session.wait_for("another picture", SOON, |seen| !shows(seen.screen(), &wanted));
        session.send(b"r");
        session.wait_for_rest();
        assert!(shows(session.seen().screen(), &wanted), "{quality}: at rest");
        leave(&mut session);
    }
}

/// Differences that are not visible are not sent.
///
/// Steps are of one size whatever the machine does meanwhile, and frames are counted by the queries that end them:
/// where the machine is busy, replies are late and a frame ends with no query, or a pause between two steps is long
/// enough for frames of the resting picture. The steps are then taken again, from the same view.
#[test]
fn invisible_differences_are_not_sent_while_moving() {
    let [exact, equal] = ["exact", "equal"].map(|quality| {
        let mut session = looking(termtrace().arg("--reduced-motion").arg("--quality").arg(quality));
        // On a busy machine a frame may carry more than one step, or a refined picture: the lesser of two counts.
        let per_frame = (0..40).filter_map(|_| bytes_per_frame(&mut session)).take(2).min();
        leave(&mut session);
        per_frame.expect("each frame ends with a query")
    });
    assert!(equal * 3 < exact * 2, "{equal} bytes a frame against {exact}");
}

/// Returns the bytes of a frame while the eye takes six steps; `None` unless six queries are sent.
fn bytes_per_frame(session: &mut Session) -> Option<usize> {
    // All counts begin at the same view.
    session.send(b"r");
    session.wait_for_rest();
    let before = session.seen().bytes().len();
    let queries = |bytes: &[u8]| bytes.windows(3).filter(|bytes| *bytes == b"\x1b[c").count();
    for _ in 0..6 {
        let frames = queries(session.seen().bytes());
        session.send(b"a");
        if !session.sees(SOON / 60, |seen| queries(seen.bytes()) > frames) {
            return None;
        }
    }
    let moving = &session.seen().bytes()[before..];
    (queries(moving) == 6).then_some(moving.len() / 6)
}

/// `tests/slow.rs` tests that the rate is kept, with the other limits in time.
#[test]
fn at_a_low_rate_all_arrives_in_the_end() {
    for quality in ["exact", "equal"] {
        let mut session = termtrace().arg("--max-rate").arg("60k").arg("--quality").arg(quality).spawn();
        session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 1_000);
        session.send(b"d");
        session.send(b"r");
        wait_for_picture(&mut session, Size::cells(80, 24));
        leave(&mut session);
    }
}

/// The two half blocks are mixed only where cells have an even number of pixel rows.
#[test]
fn the_upper_half_is_used_where_it_meets_the_lower_one() {
    let even = Size::cells(80, 24);
    for (size, mixes) in [(even, true), (even.of_pixels(10, 19), false), (even.of_pixels(0, 0), false)] {
        let mut session = termtrace().size(size).spawn();
        session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 1_000);
        session.wait_for_rest();
        assert_eq!(session.seen().has("▀".as_bytes()), mixes, "{:?}", size.cell);
        // A resize may change it.
        let before = session.seen().bytes().len();
        let resized = Size::cells(90, 24).of_pixels(10, 21);
        session.resize(resized);
        wait_for_picture(&mut session, resized);
        let after = String::from_utf8_lossy(&session.seen().bytes()[before..]).into_owned();
        assert!(after.contains('▄') && !after.contains('▀'), "{:?}", size.cell);
        leave(&mut session);
    }
}

#[test]
fn at_rest_nothing_is_sent() {
    let mut session = looking(termtrace());
    session.wait_for_rest();
    let bytes = session.seen().bytes().len();
    live_elsewhere();
    assert_eq!(session.seen().bytes().len(), bytes, "bytes at rest");
    leave(&mut session);
}

/// Starts another live view, waits for its picture and leaves it, so that time passes.
fn live_elsewhere() {
    leave(&mut looking(termtrace()));
}

/// Returns the clock ticks of CPU that a process has used.
#[cfg(target_os = "linux")]
fn ticks(session: &Session) -> u64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", session.pid().as_raw_nonzero())).expect("it runs");
    let fields: Vec<&str> = stat.rsplit(") ").next().expect("after the name").split(' ').collect();
    fields[11].parse::<u64>().expect("user time") + fields[12].parse::<u64>().expect("system time")
}

#[cfg(target_os = "linux")]
#[test]
fn at_rest_nothing_is_computed() {
    // The scene has a folder of its own: the watcher reports every file that is opened in it.
    let folder = tempfile::tempdir().expect("a folder can be made");
    let scene = folder.path().join("ball.ron");
    std::fs::copy(SCENE, &scene).expect("a file can be copied");
    let mut session = looking(program().arg(scene));
    session.wait_for_rest();
    // Tracing threads run on for a moment after the last frame before they sleep.
    let mut deadline = Deadline::after(SOON);
    let mut before = switches(&session);
    loop {
        live_elsewhere();
        let now = switches(&session);
        if now == before {
            break;
        }
        assert!(!deadline.has_passed(), "threads wake up at rest");
        before = now;
    }
    leave(&mut session);
}

/// Returns the number of context switches of a process: each time that a thread slept or waited.
#[cfg(target_os = "linux")]
fn switches(session: &Session) -> u64 {
    let threads = std::fs::read_dir(format!("/proc/{}/task", session.pid().as_raw_nonzero())).expect("it runs");
    let status = threads.map(|thread| std::fs::read_to_string(thread.expect("it runs").path().join("status")));
    let status = status.map(|status| status.expect("no thread ends at rest"));
    let of_thread = |status: String| -> u64 {
        let lines = status.lines().filter_map(|line| line.split_once("ctxt_switches:"));
        lines.map(|(_, count)| count.trim().parse::<u64>().expect("a number")).sum()
    };
    status.map(of_thread).sum()
}

/// A held key that changes nothing (Up at the pole) is looked at once a frame, and renders nothing.
#[cfg(target_os = "linux")]
#[test]
fn a_held_key_that_changes_nothing_costs_nothing() {
    let mut session = termtrace().arg("--eye").arg("0,9,0.1").arg("--target").arg("0,99,0.11").spawn();
    session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 1_000);
    session.send(b"k");
    // The eye goes up to the pole.
    session.wait_for_rest();
    let bytes = session.seen().bytes().len();
    let at_the_pole = (0..3).map(|_| ticks_of_keys(&mut session, b"k")).min().expect("three are counted");
    assert_eq!(session.seen().bytes().len(), bytes, "frames at the pole");
    // On a slow machine a look takes longer, and so does a frame.
    let moving = ticks_of_keys(&mut session, b"d");
    assert!(at_the_pole <= (moving / 4).max(8), "{at_the_pole} ticks at the pole, {moving} of a moving eye");
    leave(&mut session);
}

/// Returns the clock ticks of CPU that twenty presses of a key cost, up to the next rest.
#[cfg(target_os = "linux")]
fn ticks_of_keys(session: &mut Session, key: &[u8]) -> u64 {
    let before = ticks(session);
    for _ in 0..20 {
        session.send(key);
        session.wait_until_read();
    }
    session.wait_for_rest();
    ticks(session) - before
}

/// Frames are at least a sixtieth of a second apart, however small and fast they are.
#[test]
fn no_more_than_sixty_frames_are_shown_in_a_second() {
    let size = Size::cells(80, 3);
    let mut session = termtrace().size(size).spawn();
    wait_for_picture(&mut session, size);
    session.send(b"i");
    let end = format!("{:.2}", 5.0 - 2.5 * (0.15 + 1.0 / 60.0));
    let mut frames_of_a_tap = || {
        session.wait_for_text("eye 0.00 1.00 5.00");
        session.wait_for_rest();
        session.send(b"w");
        // The status line shows the eye: a frame is another eye.
        let mut eyes = std::collections::HashSet::new();
        session.wait_for("the end of the tap", SOON, |seen| {
            let text = seen.screen().text().concat();
            eyes.insert(text.rsplit("eye").next().map(str::to_owned));
            text.contains(&format!("eye 0.00 1.00 {end}"))
        });
        session.send(b"r");
        eyes.len()
    };
    // A tap takes 0.3 s, in which sixty frames a second are 18. A busy machine shows fewer, never more.
    let enough = (0..10).map(|_| frames_of_a_tap()).any(|frames| {
        assert!(frames <= 20, "{frames} frames of a tap");
        frames >= 5
    });
    assert!(enough, "fewer than five frames of each tap");
    leave(&mut session);
}

/// Keys that draw whole frames.
const WHOLE_FRAMES: &[u8] = b"\x0cd\x0ca";

/// Leaving works on a terminal that has stopped reading (Ctrl-S, a dead link).
#[test]
fn a_terminal_that_does_not_read_is_left() {
    std::thread::scope(|scope| {
        for signal in [None, Some(Signal::TERM)] {
            scope.spawn(move || leave_a_terminal_that_does_not_read(signal));
        }
    });
}

/// Leaves by that signal, or by a key.
fn leave_a_terminal_that_does_not_read(signal: Option<Signal>) {
    let mut session = looking(termtrace());
    session.fill(WHOLE_FRAMES);
    match signal {
        Some(signal) => session.signal(signal),
        None => session.send(b"q"),
    }
    let status = session.wait_exit(SOON);
    let code = if signal.is_none() { Some(0) } else { None };
    assert_eq!((status.code(), status.signal()), (code, signal.map(Signal::as_raw)));
    assert_eq!(session.termios_changes(), Vec::<String>::new());
}

/// A frame that takes long is cancelled.
#[test]
fn a_slow_frame_does_not_delay_leaving() {
    use std::fmt::Write as _;
    let mut scene = String::from("(camera: (eye: (0, 0, 30), target: (0, 0, 0)), objects: [");
    for n in 0..20_000 {
        let _ = write!(scene, "Sphere(center: ({}, {}, {}), radius: 0.1),", n % 40 - 20, n / 40 % 40 - 20, n / 1600);
    }
    scene.push_str("])");
    let mut file = tempfile::NamedTempFile::new().expect("a file can be made");
    file.write_all(scene.as_bytes()).expect("a file can be written");
    let mut session = program().arg(file.path()).size(Size::cells(400, 200)).spawn();
    session.wait_for("the terminal to be taken", SOON, |seen| seen.screen().is_alternate());
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

/// Modes are undone in the reverse order: the cursor first, then the colours, then the screen.
#[test]
fn modes_are_undone_in_reverse_order() {
    let mut session = looking(termtrace());
    let said = leave(&mut session);
    let places = ["\x1b[?2004l", "\x1b[?25h", "\x1b[0m", "\x1b[?1049l"].map(|off| said.rfind(off));
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?}: {said:?}");
}

/// Keys that are unread when the program leaves are not left for the shell.
#[test]
fn unread_keys_are_not_left_for_the_shell() {
    until_in_time(|| {
        let mut session = looking(termtrace());
        session.fill(WHOLE_FRAMES);
        let asked = Instant::now();
        session.send(b"q");
        // The program leaves and waits a second for the terminal to take the last bytes. It reads no more keys.
        session.wait_for_no_reader();
        session.send(b"rm -r precious\r");
        if asked.elapsed() > Duration::from_millis(800) || session.look_for_exit().is_some() {
            return false;
        }
        session.wait_exit(SOON);
        assert_eq!(String::from_utf8_lossy(&session.typed_ahead()), "");
        true
    });
}

#[test]
fn pasted_text_presses_no_keys() {
    let mut session = looking(termtrace());
    session.send(b"\x1b[200~q\x03wasd\x1b[201~");
    let wanted = picture(CellMode::HALF_BLOCK, Size::cells(80, 24));
    session.wait_for_rest();
    assert!(shows(session.seen().screen(), &wanted), "the paste moved the eye");
    leave(&mut session);
}

#[test]
fn redraw_repairs_a_screen_that_another_program_wrote_on() {
    let mut session = looking(termtrace());
    let before = session.seen().bytes().len();
    session.send(b"\x0c");
    session.wait_for("a whole frame", SOON, |seen| seen.bytes().len() > before + 80 * 24);
    // A fresh terminal that gets only these bytes shows the whole picture.
    let mut fresh = pty::Screen::new(80, 24);
    let wanted = picture(CellMode::HALF_BLOCK, Size::cells(80, 24));
    session.wait_for("the end of it", SOON, |seen| {
        fresh = pty::Screen::new(80, 24);
        fresh.feed(&seen.bytes()[before..]);
        shows(&fresh, &wanted)
    });
    leave(&mut session);
}

#[test]
fn a_resize_keeps_the_pictures_shape() {
    let mut session = looking(termtrace());
    for size in [Size::cells(100, 30), Size::cells(31, 40), Size::cells(80, 24).of_pixels(9, 20), Size::cells(1, 1)] {
        session.resize(size);
        wait_for_picture(&mut session, size);
    }
    leave(&mut session);
}

#[test]
fn any_size_works() {
    for size in [Size::cells(1, 1), Size::cells(2, 1), Size::cells(1, 3), Size::cells(300, 120)] {
        let mut session = termtrace().size(size).spawn();
        wait_for_picture(&mut session, size);
        let before = session.seen().bytes().len();
        session.send(b"i?");
        session.wait_for("panels", SOON, |seen| seen.bytes().len() > before);
        // It closes the help, whose only page this is.
        session.send(b"?");
        leave(&mut session);
    }
}

#[test]
fn the_flag_sets_the_cell_aspect_that_the_terminal_does_not_report() {
    let mut session = termtrace().arg("--cell-aspect").arg("2.2").size(Size::cells(80, 24).of_pixels(0, 0)).spawn();
    wait_for_picture(&mut session, Size::cells(80, 24).of_pixels(10, 22));
    leave(&mut session);
    let mut session = termtrace().size(Size::cells(80, 24).of_pixels(0, 0)).spawn();
    wait_for_picture(&mut session, Size::cells(80, 24).of_pixels(1, 2));
    leave(&mut session);
}

/// Asserts the cell kind that an environment and flags select, with help and status line over it.
#[track_caller]
fn assert_cells(environment: &[(&str, &str)], flags: &[&str], glyphs: Glyphs, colors: Colors) -> Session {
    let start = environment.iter().fold(termtrace(), |start, (name, value)| start.env(name, value));
    let mut session = flags.iter().fold(start, Start::arg).spawn();
    let wanted = picture(CellMode { glyphs, colors }, Size::cells(80, 24));
    let what = format!("{glyphs:?} in {colors:?} with {environment:?} and {flags:?}");
    session.wait_for(&what, SOON, |seen| shows(seen.screen(), &wanted));
    session.send(b"i");
    session.wait_for_text(" sample");
    session.send(b"?");
    session.wait_for_text("WASD");
    session.send(b"q");
    session
}

/// Returns whether the bytes have an SGR sequence.
fn has_sgr(bytes: &[u8]) -> bool {
    let sequences = bytes.split(|&byte| byte == 0x1b).skip(1);
    sequences.into_iter().any(|sequence: &[u8]| {
        let end = sequence.iter().position(u8::is_ascii_alphabetic);
        end.is_some_and(|end| sequence[end] == b'm')
    })
}

#[test]
fn without_colour_no_sgr_is_sent() {
    for (environment, flags, glyphs) in [
        (&[("NO_COLOR", "1")][..], &[][..], Glyphs::Ascii),
        (&[("TERM", "dumb"), ("COLORTERM", "")], &[], Glyphs::Ascii),
        (&[("FORCE_COLOR", "0")], &[], Glyphs::Ascii),
        (&[], &["--color=never"], Glyphs::Ascii),
        (&[], &["--color=never", "--glyphs=ramp"], Glyphs::Ramp),
        (&[], &["--color=never", "--glyphs=half"], Glyphs::Half),
    ] {
        let mut session = assert_cells(environment, flags, glyphs, Colors::None);
        let seen = session.seen();
        assert_eq!(seen.bytes().is_ascii(), glyphs != Glyphs::Half, "{environment:?} {flags:?}");
        assert!(!has_sgr(seen.bytes()), "{environment:?} {flags:?}");
        leave(&mut session);
    }
}

#[test]
fn without_utf8_the_picture_is_coloured_spaces() {
    let mut session = assert_cells(&[("LC_ALL", "C")], &[], Glyphs::Spaces, Colors::Truecolor);
    assert!(session.seen().bytes().is_ascii());
    assert!(has_sgr(session.seen().bytes()));
    leave(&mut session);
}

#[test]
fn the_colours_are_those_of_the_environment_or_the_flag() {
    for (environment, flags, colors) in [
        (&[("COLORTERM", "")][..], &[][..], Colors::Indexed256),
        (&[("COLORTERM", ""), ("TERM", "linux")], &[], Colors::SIXTEEN),
        (&[("COLORTERM", ""), ("TERM", "dumb"), ("CLICOLOR_FORCE", "1")], &[], Colors::SIXTEEN),
        (&[("NO_COLOR", "1")], &["--color=always"], Colors::Truecolor),
        (&[], &["--color=256"], Colors::Indexed256),
        (&[], &["--color=16"], Colors::SIXTEEN),
        (&[("COLORTERM", "")], &["--color=truecolor"], Colors::Truecolor),
    ] {
        let mut session = assert_cells(environment, flags, Glyphs::Half, colors);
        leave(&mut session);
    }
}

#[test]
fn the_scene_may_come_from_standard_input() {
    let scene = File::open(SCENE).expect("the scene is there");
    let mut session = looking(program().arg("-").stdin(scene));
    leave(&mut session);
}

/// The scene is read to its end before keys are.
#[test]
fn the_scene_may_be_typed() {
    let mut session = program().arg("-").spawn();
    let text = std::fs::read(SCENE).expect("the scene is there");
    session.send(&text);
    session.wait_until_read();
    assert!(!session.seen().screen().is_alternate());
    session.send(b"\x04");
    wait_for_picture(&mut session, Size::cells(80, 24));
    leave(&mut session);
}

#[test]
fn a_wrong_scene_is_reported_without_touching_the_terminal() {
    let mut file = tempfile::NamedTempFile::new().expect("a file can be made");
    file.write_all(b"(camera: (eye: (0, 0, 5), target: (0, 0, 5)))").expect("a file can be written");
    let mut session = program().arg(file.path()).spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(2));
    session.assert_clean();
    assert!(!without_colors(session.seen().bytes()).contains('\x1b'), "no escape sequence but for colours");
    session.wait_for_text("the same point");
}

#[test]
fn output_that_is_no_terminal_gets_one_plain_frame() {
    let file = tempfile::NamedTempFile::new().expect("a file can be made");
    let mut session = termtrace().stdout(file.reopen().expect("it can be opened again")).spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
    assert!(session.seen().bytes().is_empty(), "nothing goes to the terminal");
    let text = std::fs::read_to_string(file.path()).expect("text");
    assert_eq!(text, termtrace::text_frame(&Scene::load(Path::new(SCENE)).unwrap(), termtrace::Size::new(80, 24)));
}

/// `O_NONBLOCK` would stay on the shared terminal after the program, where the shell would find it.
#[cfg(target_os = "linux")]
#[test]
fn the_shared_terminal_never_gets_nonblocking() {
    const O_NONBLOCK: u32 = 0o4000;
    let mut session = looking(termtrace());
    for fd in 0..3 {
        let path = format!("/proc/{}/fdinfo/{fd}", session.pid().as_raw_nonzero());
        let info = std::fs::read_to_string(path).expect("it runs");
        let flags = info.lines().find_map(|line| line.strip_prefix("flags:")).expect("flags are told");
        let flags = u32::from_str_radix(flags.trim(), 8).expect("octal");
        assert_eq!(flags & O_NONBLOCK, 0, "file descriptor {fd}");
    }
    leave(&mut session);
}
