//! Every way out of the live view, in every phase: the terminal is as before, and the reason is
//! told.

#![cfg(feature = "test-hooks")]

use crate::pty::{self, Answer, Deadline, Phases, SOON, Seen, Session, Size, Start};
use rustix::process::{Signal, kill_process};
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;
use std::time::Duration;
use termtrace::internals::control::AGAIN_TIME;

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron");
const PROGRAM: &str = env!("CARGO_BIN_EXE_termtrace");

/// A way out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Key(&'static [u8]),
    Fault(Answer),
    Death(Signal),
    /// The stop key, and `fg`.
    StopKey,
    StopSignal,
}

impl Way {
    fn stops(self) -> bool {
        matches!(self, Self::StopKey | Self::StopSignal)
    }
}

/// The phase of the child at which it has to leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// In raw mode, with nothing sent yet.
    RawMode,
    /// All modes are sent, and no frame.
    AllModes,
    /// The terminal has taken a part of a frame, and no more.
    MidFrame,
    /// The window is being resized.
    Storm,
    /// The kitty keyboard protocol is queried, and has no reply.
    Keyboard,
}

impl Phase {
    fn name(self) -> &'static str {
        match self {
            Self::RawMode => "raw mode",
            Self::AllModes => "all modes",
            Self::MidFrame => "frame",
            Self::Storm => "resize",
            Self::Keyboard => "keyboard",
        }
    }

    /// Returns the size of the terminal. No pseudo-terminal takes a frame of the larger size in one
    /// go.
    fn size(self) -> Size {
        if self == Self::MidFrame { Size::cells(300, 120) } else { Size::cells(80, 24) }
    }
}

/// Defines the tests of a way out, one for each phase.
macro_rules! ways_out {
    ($($name:ident: $way:expr;)*) => {$(
        mod $name {
            use super::*;

            #[test]
            fn in_raw_mode_with_nothing_sent() {
                leave($way, Phase::RawMode);
            }

            #[test]
            fn before_the_first_frame() {
                leave($way, Phase::AllModes);
            }

            #[test]
            fn in_mid_frame() {
                leave($way, Phase::MidFrame);
            }

            #[test]
            fn in_a_storm_of_resizes() {
                leave($way, Phase::Storm);
            }

            #[test]
            fn with_the_keyboard_pushed() {
                leave_with_keyboard($way, Phase::Keyboard);
            }

            #[test]
            fn with_the_keyboard_pushed_in_mid_frame() {
                leave_with_keyboard($way, Phase::MidFrame);
            }

            #[test]
            fn with_the_keyboard_pushed_in_a_storm_of_resizes() {
                leave_with_keyboard($way, Phase::Storm);
            }
        }
    )*};
}

ways_out! {
    q: Way::Key(b"q");
    ctrl_c: Way::Key(b"\x03");
    error_return: Way::Fault(Answer::Error);
    panic_in_main: Way::Fault(Answer::Panic);
    panic_in_a_worker: Way::Fault(Answer::WorkerPanic);
    sigterm: Way::Death(Signal::TERM);
    sighup: Way::Death(Signal::HUP);
    sigint: Way::Death(Signal::INT);
    sigquit: Way::Death(Signal::QUIT);
    sigusr1: Way::Death(Signal::USR1);
    stop_by_sigtstp: Way::StopSignal;
    stop_by_the_ctrl_z_key: Way::StopKey;
}

fn leave(way: Way, phase: Phase) {
    let mut phases = Phases::new();
    let mut session = start(way, phase, &phases).spawn();
    let storm = (phase == Phase::Storm).then(|| session.storm());
    if phase == Phase::MidFrame {
        session.stop_reading();
    }
    phases.wait_for(phase.name());
    go(way, phase, &mut session, phases, storm);
}

/// Leaves on a terminal that has the kitty keyboard protocol pushed.
fn leave_with_keyboard(way: Way, phase: Phase) {
    let mut phases = Phases::new();
    let mut session = start(way, phase, &phases).kitty().spawn();
    phases.wait_for_on(Phase::Keyboard.name(), &mut session);
    let storm = (phase == Phase::Storm).then(|| session.storm());
    if phase == Phase::MidFrame {
        session.stop_reading();
        // The first frame may have gone out.
        session.send(b"\x1b[108;5u");
    }
    if phase != Phase::Keyboard {
        phases.send(Answer::GoOn);
        phases.wait_for(phase.name());
    }
    go(way, phase, &mut session, phases, storm);
}

fn start(way: Way, phase: Phase, phases: &Phases) -> Start {
    let start = if way.stops() { job() } else { Start::new(PROGRAM).arg(SCENE) };
    start.env("TERMTRACE_TEST_SOCKET", phases.path()).size(phase.size())
}

/// Leaves a child that waits in that phase.
fn go(way: Way, phase: Phase, session: &mut Session, phases: Phases, storm: Option<pty::Storm>) {
    act(way, session);
    phases.answer(if let Way::Fault(answer) = way { answer } else { Answer::GoOn });
    if phase == Phase::MidFrame {
        session.start_reading();
    }
    if way.stops() {
        come_back(session, storm);
    } else {
        let status = session.wait_exit(SOON);
        drop(storm);
        check_end(way, status, session);
    }
}

/// Types a key or sends a signal; a fault is the answer to the phase.
fn act(way: Way, session: &mut Session) {
    match way {
        Way::Key(key) => press(key, session),
        Way::Fault(_) => {}
        Way::Death(signal) => session.signal(signal),
        Way::StopKey => press(b"\x1a", session),
        Way::StopSignal => {
            // The job's group has its leader's number.
            kill_process(session.foreground_group(), Signal::TSTP).expect("a job takes signals");
        }
    }
}

/// Presses a key as the terminal encodes it now.
fn press(key: &'static [u8], session: &mut Session) {
    let keyboard = session.seen().modes().keyboard_flags() > 0;
    session.send(match key {
        b"q" if keyboard => b"\x1b[113u",
        b"\x03" if keyboard => b"\x1b[99;5u",
        b"\x1a" if keyboard => b"\x1b[122;5u",
        key => key,
    });
}

fn check_end(way: Way, status: ExitStatus, session: &mut Session) {
    session.assert_clean();
    assert!(!session.seen().screen().is_alternate());
    let (code, signal, message) = match way {
        Way::Fault(Answer::Error) => (Some(1), None, Some("terminal: a test asked for an error")),
        Way::Fault(Answer::Panic) => (Some(101), None, Some("a test asked for a panic in the loop")),
        Way::Fault(_) => (Some(101), None, Some("a test asked for a panic in a worker")),
        Way::Death(signal) => (None, Some(signal.as_raw()), None),
        _ => (Some(0), None, None),
    };
    assert_eq!((status.code(), status.signal()), (code, signal));
    if let Some(message) = message {
        check_message(message, session);
    }
}

/// Asserts that the message comes once, after the terminal is restored, and is readable.
fn check_message(message: &str, session: &mut Session) {
    let seen = session.seen();
    let told = String::from_utf8_lossy(seen.bytes()).into_owned();
    assert_eq!(told.matches(message).count(), 1, "{told:?}");
    assert!(told.rfind("\x1b[?") < told.find(message), "told before the terminal is given back");
    let shown = seen.screen().text().concat();
    assert!(shown.contains(message), "{shown}");
}

/// Starts a shell with job control.
///
/// It prints how its job ended or stopped, and continues it when Return is pressed.
fn job() -> Start {
    job_of(&format!("'{PROGRAM}' '{SCENE}'"))
}

fn job_of(command: &str) -> Start {
    Start::shell(&format!(
        "set -m; {command}; echo \"status <$?>\"; read line; fg >/dev/null; echo \"ended <$?>\"; read line"
    ))
}

/// Continues a stopped job, which has given the terminal back: it shows the whole picture at the
/// new size, and leaves.
fn come_back(session: &mut Session, storm: Option<pty::Storm>) {
    session.wait_for_text("status <148>");
    drop(storm);
    session.assert_clean();
    let keyboard = session.seen().has(b"\x1b[>15u");
    let (size, before) = (Size::cells(70, 20), session.seen().bytes().len());
    session.resize(size);
    session.send(b"\n");
    session.wait_for("the picture", SOON, |seen| shows_all(seen.bytes().get(before..).unwrap_or(&[]), size));
    if keyboard {
        session.wait_for("the keyboard pushed again", SOON, |seen| seen.modes().keyboard_flags() == 15);
    }
    press(b"q", session);
    session.wait_for_text("ended <0>");
    session.assert_clean();
}

/// Returns whether a terminal that gets only these bytes shows a picture in every cell.
///
/// The scene has no black in it.
fn shows_all(bytes: &[u8], size: Size) -> bool {
    let mut screen = pty::Screen::new(size.columns, size.rows);
    screen.feed(bytes);
    let cells = (0..size.rows).flat_map(|row| (0..size.columns).map(move |column| (column, row)));
    screen.is_alternate()
        && cells.into_iter().all(|(column, row)| {
            let cell = screen.cell(column.into(), row.into());
            cell.background != pty::Colour::Default
        })
}

fn looking() -> Session {
    looking_of(Start::new(PROGRAM).arg(SCENE))
}

fn looking_of(start: Start) -> Session {
    let mut session = start.spawn();
    session.wait_for("the picture", SOON, |seen| shows_all(seen.bytes(), Size::cells(80, 24)));
    session
}

/// Returns the next random number of a seed (xorshift).
fn random(seed: &mut u32) -> u32 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 17;
    *seed ^= *seed << 5;
    *seed
}

/// Kills fifty programs at random times, from before the start to the middle of a flight.
fn kill_at_random_times(signal: Signal) {
    let mut seed = 0x5eed_0000 + signal.as_raw().unsigned_abs();
    let times: Vec<_> = (0..50).map(|_| Duration::from_micros(u64::from(random(&mut seed) % 150_000))).collect();
    // Two run at once: most of the time is spent on waiting, and the output of more would not be read in time on a busy
    // machine.
    std::thread::scope(|scope| {
        for times in times.chunks(25) {
            scope.spawn(|| times.iter().for_each(|&time| kill_after(time, signal)));
        }
    });
}

/// Kills a program in flight at that time after its start.
fn kill_after(time: Duration, signal: Signal) {
    let mut session = Start::new(PROGRAM).arg(SCENE).spawn();
    session.send(b"w");
    session.sees(time, |_| false);
    session.signal(signal);
    let status = session.wait_exit(SOON);
    assert_eq!(status.signal(), Some(signal.as_raw()), "after {time:?}");
    // The terminal itself echoes what was typed before raw mode was on.
    session.assert_clean();
    assert!(!session.seen().screen().is_alternate());
    assert!(session.seen().screen().cursor().is_some());
}

#[test]
fn fifty_kills_by_sigterm() {
    kill_at_random_times(Signal::TERM);
}

#[test]
fn fifty_kills_by_sighup() {
    kill_at_random_times(Signal::HUP);
}

#[test]
fn fifty_kills_by_sigint() {
    kill_at_random_times(Signal::INT);
}

#[test]
fn fifty_kills_by_sigquit() {
    kill_at_random_times(Signal::QUIT);
}

/// After a storm of resizes the picture is whole, at the last size.
#[test]
fn a_storm_of_resizes_leaves_a_whole_picture() {
    let mut session = looking();
    let (storm, before) = (session.storm(), session.seen().bytes().len());
    session.wait_for("frames of other sizes", SOON, |seen| seen.bytes().len() > before + 100_000);
    drop(storm);
    let (size, before) = (Size::cells(71, 21), session.seen().bytes().len());
    session.resize(size);
    session.wait_for("the picture", SOON, |seen| shows_all_at_the_end(&seen.bytes()[before..], size));
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

/// Returns whether a terminal that was on the alternate screen before shows a picture in every
/// cell.
fn shows_all_at_the_end(bytes: &[u8], size: Size) -> bool {
    shows_all(&[b"\x1b[?1049h", bytes].concat(), size)
}

/// SIGSTOP gives no notice, and a SIGCONT may come without a stop: both redraw the whole screen.
#[test]
fn a_continue_draws_everything_anew() {
    for stop in [true, false] {
        let mut session = looking();
        let before = session.seen().bytes().len();
        if stop {
            session.signal(Signal::STOP);
            session.wait_stopped(SOON);
        }
        session.signal(Signal::CONT);
        session.wait_for("the picture", SOON, |seen| shows_all(&seen.bytes()[before..], Size::cells(80, 24)));
        session.send(b"q");
        assert_eq!(session.wait_exit(SOON).code(), Some(0));
        session.assert_clean();
    }
}

/// Without a process that could continue it (a terminal that runs it without a shell) it goes on by
/// itself.
#[test]
fn without_a_shell_ctrl_z_does_not_hang() {
    for start in [Start::new(PROGRAM).arg(SCENE), Start::shell(&format!("trap '' TSTP; exec '{PROGRAM}' '{SCENE}'"))] {
        let mut session = looking_of(start);
        let before = session.seen().bytes().len();
        session.send(b"\x1a");
        session.wait_for("the picture", SOON, |seen| shows_all(&seen.bytes()[before..], Size::cells(80, 24)));
        session.send(b"q");
        assert_eq!(session.wait_exit(SOON).code(), Some(0));
        session.assert_clean();
    }
}

/// The key stops the whole process group, as the terminal itself would: the shell waits for all of
/// it.
#[test]
fn ctrl_z_stops_the_whole_group() {
    let mut session = job_of(&format!("sh -c \"'{PROGRAM}' '{SCENE}'; echo inner\"")).spawn();
    session.wait_for("the picture", SOON, |seen| shows_all(seen.bytes(), Size::cells(80, 24)));
    session.send(b"\x1a");
    come_back(&mut session, None);
    session.wait_for_text("inner");
}

/// The keyboard's reply has come before the stop; giving the terminal back reads it and waits for
/// no other.
#[test]
fn a_stop_waits_for_no_second_reply() {
    let mut phases = Phases::new();
    let start = job().env("TERMTRACE_TEST_SOCKET", phases.path()).size(Size::cells(80, 4));
    let mut session = start.kitty().spawn();
    phases.wait_for_on(Phase::Keyboard.name(), &mut session);
    session.wait_for("the question, which is answered", SOON, |seen| seen.has(b"\x1b[>15u\x1b[?u"));
    act(Way::StopSignal, &mut session);
    // Both are known when the program is continued.
    session.sees(Duration::from_millis(100), |_| false);
    phases.answer(Answer::GoOn);
    come_back(&mut session, None);
}

/// A job that is stopped again and again is continued each time.
#[test]
fn a_job_can_be_stopped_and_continued_again_and_again() {
    let rounds = 5;
    let script =
        format!("set -m; '{PROGRAM}' '{SCENE}'; while echo \"status <$?>\"; read line; do fg >/dev/null; done");
    let mut session = Start::shell(&script).spawn();
    let mut before = 0;
    for _ in 0..rounds {
        session.wait_for("the picture", SOON, |seen| shows_all(&seen.bytes()[before..], Size::cells(80, 24)));
        session.send(b"w\x1a");
        session.wait_for("the shell", SOON, |seen| seen.bytes().ends_with(b"status <148>\r\n"));
        session.assert_clean();
        before = session.seen().bytes().len();
        session.send(b"\n");
    }
}

/// A stopped job that is killed leaves the terminal alone: the shell has it.
#[test]
fn a_stopped_job_can_be_killed() {
    let script = format!(
        "set -m; '{PROGRAM}' '{SCENE}'; echo \"status <$?>\"; read line; kill %1; kill -CONT %1; \
         while wait %1; s=$?; [ $s = 148 ]; do sleep 0.05; done; echo \"ended <$s>\"; read line"
    );
    let mut session = looking_of(Start::shell(&script));
    session.send(b"\x1a");
    session.wait_for_text("status <148>");
    let before = session.seen().bytes().len();
    session.send(b"\n");
    session.wait_for_text("ended <143>");
    let said = String::from_utf8_lossy(&session.seen().bytes()[before..]).into_owned();
    assert!(!said.contains('\x1b'), "{said:?}");
    session.assert_clean();
}

/// After SIGSTOP the terminal is as it was. A kill still restores it, although the shell has it by
/// then.
#[test]
fn a_job_stopped_in_flight_can_be_killed() {
    let stopped = 128 + Signal::STOP.as_raw();
    let script = format!(
        "set -m; '{PROGRAM}' '{SCENE}'; echo \"status <$?>\"; read line; kill %1; kill -CONT %1; \
         while wait %1; s=$?; [ $s = {stopped} ]; do sleep 0.05; done; echo \"ended <$s>\"; read line"
    );
    let mut session = looking_of(Start::shell(&script));
    kill_process(session.foreground_group(), Signal::STOP).expect("a job takes signals");
    // The shell writes over the picture, wherever the cursor is.
    session.wait_for("the shell", SOON, |seen| seen.has(format!("status <{stopped}>").as_bytes()));
    session.send(b"\n");
    session.wait_for_text(&format!("ended <{}>", 128 + Signal::TERM.as_raw()));
    session.assert_clean();
}

/// Shell commands that wait until the job in the background is stopped, and then print so.
const PARKED: &str = "until ps -o stat= -p $! | grep -q '^T'; do sleep 0.01; done; echo parked";

/// In the background it does not touch the terminal before it is in the foreground; after `bg` too.
#[test]
fn a_program_in_the_background_leaves_the_terminal_alone() {
    let script = format!(
        "set -m; '{PROGRAM}' '{SCENE}' & {PARKED}; read line; jobs; fg >/dev/null; echo \"status <$?>\"; read line; bg; \
         {PARKED}; read line; fg >/dev/null; echo \"ended <$?>\"; read line"
    );
    let mut session = Start::shell(&script).spawn();
    session.wait_for_text("parked");
    assert!(!session.seen().has(b"\x1b"), "escapes from the background");
    session.assert_clean();
    session.send(b"\n");
    session.wait_for("the picture", SOON, |seen| shows_all(seen.bytes(), Size::cells(80, 24)));
    session.send(b"\x1a");
    session.wait_for_text("status <148>");
    let before = session.seen().bytes().len();
    session.send(b"\n");
    session.wait_for("it to be parked again", SOON, |seen| seen.has_after(before, b"parked"));
    assert!(!session.seen().bytes()[before..].contains(&0x1b), "after bg");
    session.assert_clean();
    session.send(b"\n");
    session.wait_for("the picture", SOON, |seen| shows_all(&seen.bytes()[before..], Size::cells(80, 24)));
    // The job was continued twice, and has taken the terminal once: giving it back drops keys.
    let leaves = |seen: &Seen| seen.has_after(before, b"\x1b[?1049l");
    session.send(b"i");
    session.wait_for_text(" sample");
    assert!(!leaves(session.seen()), "taken a second time");
    session.send(b"q");
    session.wait_for_text("ended <0>");
    session.assert_clean();
}

/// A signal there ends it without waiting for the terminal any longer.
#[test]
fn a_program_killed_in_the_background_ends() {
    let stopped = 128 + Signal::TTOU.as_raw();
    for arguments in [format!("'{SCENE}'"), "doctor".to_owned()] {
        let script = format!(
            "set -m; '{PROGRAM}' {arguments} & {PARKED}; read line; jobs; kill %1; kill -CONT %1; \
             while wait %1; s=$?; [ $s = {stopped} ]; do sleep 0.05; done; echo \"ended <$s>\"; read line"
        );
        let mut session = Start::shell(&script).spawn();
        session.wait_for_text("parked");
        session.send(b"\n");
        session.wait_for_text(&format!("ended <{}>", 128 + Signal::TERM.as_raw()));
        assert!(!session.seen().has(b"\x1b"), "it was never ours");
        session.assert_clean();
    }
}

/// A whole job stops: its shell would not notice a part of it, and never continue it.
#[test]
fn in_the_background_the_whole_job_stops() {
    let script =
        format!("set -m; ('{PROGRAM}' '{SCENE}'; echo \"ended <$?>\") & {PARKED}; read line; jobs; fg; read line");
    let mut session = Start::shell(&script).spawn();
    session.wait_for_text("parked");
    session.send(b"\n");
    // This goes to standard error: on the screen the picture would soon cover it.
    session.wait_for("the stop", SOON, |seen| seen.has(b"Stopped"));
    session.wait_for("the picture", SOON, |seen| shows_all(seen.bytes(), Size::cells(80, 24)));
    session.send(b"q");
    session.wait_for_text("ended <0>");
    session.assert_clean();
}

/// Restores the settings that it found when it came to the foreground.
///
/// It was started in the background while the shell read a line with settings of its own.
#[test]
fn the_settings_given_back_are_those_of_the_foreground() {
    let script = format!(
        "set -m; foreground=$(stty -g); stty -icanon; '{PROGRAM}' '{SCENE}' & {PARKED}; read line; stty \"$foreground\"; \
         fg >/dev/null; echo \"ended <$?>\"; read line"
    );
    let mut session = Start::shell(&script).spawn();
    session.wait_for_text("parked");
    assert!(!session.seen().has(b"\x1b"), "escapes from the background");
    session.send(b"\n");
    session.wait_for("the picture", SOON, |seen| shows_all(seen.bytes(), Size::cells(80, 24)));
    session.send(b"q");
    session.wait_for_text("ended <0>");
    session.assert_clean();
}

/// Keys that were held before a stop or a loss of the focus are not held afterwards.
#[test]
fn no_key_is_stuck() {
    let mut session = job().spawn();
    session.wait_for("the picture", SOON, |seen| shows_all(seen.bytes(), Size::cells(80, 24)));
    // (Another key would end the motion, Ctrl-Z too.)
    session.send(b"iw");
    session.wait_for_text("eye");
    act(Way::StopSignal, &mut session);
    session.wait_for_text("status <148>");
    let before = session.seen().bytes().len();
    // The motion would be over now.
    session.sees(AGAIN_TIME, |_| false);
    session.send(b"\n");
    session.wait_for("the picture", SOON, |seen| shows_all(&seen.bytes()[before..], Size::cells(80, 24)));
    stands_still(&mut session);
    // The tap has moved the eye until the stop, at most to its end at 4.58.
    let eye = eye_line(session.seen());
    let forward: f32 = eye.split_whitespace().nth(2).and_then(|z| z.parse().ok()).expect("the eye's third number");
    assert!(forward > 4.5, "{eye}");
    session.send(b"W\x1b[O");
    stands_still(&mut session);
}

/// Waits until the eye stands still for longer than a tap. With a stuck key it never does.
#[track_caller]
fn stands_still(session: &mut Session) {
    let mut deadline = Deadline::after(SOON);
    let mut last = eye_line(session.seen());
    while session.sees(Duration::from_millis(400), |seen| eye_line(seen) != last) {
        assert!(!deadline.has_passed(), "the eye does not stand still");
        last = eye_line(session.seen());
    }
}

fn eye_line(seen: &Seen) -> String {
    let text = seen.screen().text().concat();
    text.rsplit_once("eye").expect("the status line shows the eye").1.to_owned()
}

/// A signal that is ignored when the program starts stays ignored.
#[cfg(target_os = "linux")]
#[test]
fn ignored_signals_stay_ignored() {
    let script = format!("trap '' HUP INT QUIT; exec '{PROGRAM}' '{SCENE}'");
    let mut session = looking_of(Start::shell(&script));
    for signal in [Signal::HUP, Signal::INT, Signal::QUIT] {
        session.signal(signal);
    }
    let before = session.seen().bytes().len();
    session.send(b"\x0c");
    session.wait_for("the picture", SOON, |seen| shows_all_at_the_end(&seen.bytes()[before..], Size::cells(80, 24)));
    session.signal(Signal::TERM);
    assert_eq!(session.wait_exit(SOON).signal(), Some(Signal::TERM.as_raw()));
    session.assert_clean();
}

/// The number of write calls that a process has made.
#[cfg(target_os = "linux")]
fn writes(session: &Session) -> u64 {
    let io = std::fs::read_to_string(format!("/proc/{}/io", session.pid().as_raw_nonzero())).expect("it runs");
    let count = io.lines().find_map(|line| line.strip_prefix("syscw: ")).expect("writes are counted");
    count.parse().expect("a number")
}

/// Ctrl-L draws a picture that is there already, in one write.
///
/// A pseudo-terminal takes some ten thousand bytes at once: of a larger frame it takes a part, and the rest in as few
/// writes as it wants. On a busy machine replies are late, and small frames take the place of one: then the key is
/// pressed again.
#[cfg(target_os = "linux")]
#[test]
fn a_frame_is_one_write() {
    let mut session = Start::new(PROGRAM).arg(SCENE).size(Size::cells(40, 8)).says_when_it_rests().spawn();
    session.wait_for("the picture", SOON, |seen| shows_all(seen.bytes(), Size::cells(40, 8)));
    session.wait_for_rest();
    // Threads that start beside the first picture write, too: their wakes of the loop are over when a key is handled.
    let bytes = session.seen().bytes().len();
    session.send(b"\x0c");
    session.wait_for("a frame", SOON, |seen| seen.bytes().len() > bytes + 2_000);
    session.wait_for_rest();
    for key in [&b"\x0c"[..], b"i", b"\x0c"] {
        let is_one = (0..20).any(|_| {
            let (before, bytes) = (writes(&session), session.seen().bytes().len());
            session.send(key);
            session.wait_for("a frame", SOON, |seen| seen.bytes().len() > bytes);
            session.wait_for_rest();
            if key == b"\x0c" {
                assert!(session.seen().bytes().len() - bytes > 2_000, "a whole frame");
            }
            writes(&session) - before == 1
        });
        assert!(is_one, "{}", key.escape_ascii());
    }
    session.send(b"q");
    session.wait_exit(SOON);
}

/// Runs the program with redirections of a shell.
///
/// Returns the exit status, and all that was written to the standard streams and the terminal.
fn run_with(redirections: &str) -> (Option<i32>, String) {
    let mut session = Start::shell(&format!("export NO_COLOR=1; exec '{PROGRAM}' '{SCENE}' {redirections}")).spawn();
    let status = session.wait_exit(SOON);
    session.assert_clean();
    (status.code(), String::from_utf8_lossy(session.seen().bytes()).into_owned())
}

#[test]
fn standard_output_that_is_no_terminal_gets_one_plain_frame_or_a_line_of_error() {
    let file = tempfile::NamedTempFile::new().expect("a file can be made");
    let path = file.path().display();
    for (redirections, code, says) in [
        (format!(">{path}"), 0, ""),
        (format!("</dev/null >{path} 2>&1"), 0, ""),
        ("| cat >/dev/null".to_owned(), 0, ""),
        (">&-".to_owned(), 0, ""),
        ("<&- >&- 2>&-".to_owned(), 0, ""),
        ("| :".to_owned(), 0, ""),
    ] {
        assert_eq!(run_with(&redirections), (Some(code), says.to_owned()), "{redirections}");
        let written = std::fs::read_to_string(file.path()).expect("text");
        assert!(!written.contains('\x1b'), "{redirections}");
    }
    assert_eq!(std::fs::read_to_string(file.path()).expect("text").lines().count(), 24);
    let (code, said) = run_with("| cat");
    assert_eq!((code, said.lines().count(), said.contains('\x1b')), (Some(0), 24, false));
    let (code, said) = run_with("--color=always | cat");
    assert!(code == Some(0) && said.contains("\x1b[38;2;"), "asked for");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported_in_one_line() {
    let (code, said) = run_with(">/dev/full");
    assert_eq!((code, said.as_str()), (Some(1), "error: standard output: No space left on device\r\n"));
}

/// Without a terminal for keys there is one line of error, and no mode is turned on.
#[cfg(target_os = "linux")]
#[test]
fn without_a_terminal_for_keys_there_is_one_line_of_error() {
    let mut session = Start::shell(&format!("NO_COLOR=1 setsid -w '{PROGRAM}' '{SCENE}' </dev/null")).spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(1));
    session.assert_clean();
    let said = String::from_utf8_lossy(session.seen().bytes()).into_owned();
    assert!(said.starts_with("error: terminal: no terminal to read keys from") && !said.contains('\x1b'), "{said}");
    assert_eq!(said.lines().count(), 1);
    // With a terminal for keys it needs no controlling terminal.
    let mut session = looking_of(Start::shell(&format!("setsid -w '{PROGRAM}' '{SCENE}'")));
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}
