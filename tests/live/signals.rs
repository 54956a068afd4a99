//! Every signal whose default ends the process ends the live view and gives the terminal back
//! first.

use crate::pty::{SOON, Session, Start, picture, shows};
use rustix::process::Signal;
use std::os::unix::process::ExitStatusExt;
use std::process::Command;
use termtrace::{CellMode, Scene, Size};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron");
const PROGRAM: &str = env!("CARGO_BIN_EXE_termtrace");

fn looking(start: Start) -> Session {
    let mut session = start.spawn();
    let scene = Scene::from_ron("three_spheres.ron", include_str!("../../scenes/three_spheres.ron"));
    let wanted = picture(&scene.expect("the scene is fine"), CellMode::HALF_BLOCK, Size::new(80, 24), 2.0);
    session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
    session
}

/// Sends a signal by its number: of real-time signals there are no names.
fn send(session: &Session, signal: i32) {
    let pid = session.pid().as_raw_nonzero().to_string();
    let kill = Command::new("sh").args(["-c", &format!("kill -{signal} {pid}")]).status();
    assert!(kill.expect("there is a shell").success(), "signal {signal}");
}

/// Returns the signals that end a process by default and are not in the matrix of `leaving`.
fn endings() -> Vec<i32> {
    let named = [
        Signal::USR1,
        Signal::USR2,
        Signal::ALARM,
        Signal::VTALARM,
        Signal::PROF,
        Signal::XCPU,
        Signal::TRAP,
        Signal::SYS,
        Signal::ABORT,
        Signal::FPE,
        Signal::ILL,
    ];
    let mut endings = named.map(Signal::as_raw).to_vec();
    #[cfg(target_os = "linux")]
    {
        endings.extend([Signal::IO, Signal::POWER, Signal::STKFLT].map(Signal::as_raw));
        // The first and the last real-time signal, and one between.
        endings.extend([34, 50, 64]);
    }
    endings
}

#[test]
fn every_signal_that_ends_a_program_gives_the_terminal_back() {
    for signal in endings() {
        let mut session = looking(Start::new(PROGRAM).arg(SCENE));
        send(&session, signal);
        let status = session.wait_exit(SOON);
        assert_eq!(status.signal(), Some(signal), "{status}");
        session.assert_clean();
        assert!(!session.seen().screen().is_alternate(), "signal {signal}");
    }
}

/// The first signal decides, whatever other signals are pending when the program ends.
#[test]
fn the_first_of_several_signals_ends_the_program() {
    let mut session = looking(Start::new(PROGRAM).arg(SCENE));
    session.signal(Signal::STOP);
    session.wait_stopped(SOON);
    for signal in endings() {
        send(&session, signal);
    }
    session.signal(Signal::CONT);
    let status = session.wait_exit(SOON);
    assert!(status.signal().is_some_and(|signal| endings().contains(&signal)), "{status}");
    session.assert_clean();
}

#[cfg(target_os = "linux")]
#[test]
fn signals_that_the_parent_ignores_stay_ignored() {
    let ignored = [Signal::USR1, Signal::ALARM, Signal::IO].map(Signal::as_raw);
    let names = ignored.map(|signal| signal.to_string()).join(" ");
    let mut session = looking(Start::shell(&format!("trap '' {names}; exec '{PROGRAM}' '{SCENE}'")));
    for signal in ignored {
        send(&session, signal);
    }
    // It still does what keys ask for.
    session.send(b"i");
    session.wait_for_text("eye");
    send(&session, Signal::USR2.as_raw());
    assert_eq!(session.wait_exit(SOON).signal(), Some(Signal::USR2.as_raw()));
    session.assert_clean();
}

/// A key that was typed while the program was stopped by SIGSTOP, or just after, is not lost.
///
/// It does not matter whether replies are outstanding.
#[test]
fn keys_typed_around_a_sigstop_are_read() {
    let plain: [&[u8]; 2] = [b"q", b"\x03"];
    let kitty: [&[u8]; 2] = [b"\x1b[113u", b"\x1b[99;5u"];
    for (is_mute, is_kitty, [q, ctrl_c]) in [(true, false, plain), (false, false, plain), (false, true, kitty)] {
        for (key, while_stopped) in [(q, true), (ctrl_c, true), (q, false)] {
            let start = Start::new(PROGRAM).arg(SCENE);
            let start = if is_mute { start.mute() } else { start };
            let mut session = looking(if is_kitty { start.kitty() } else { start });
            session.signal(Signal::STOP);
            session.wait_stopped(SOON);
            if while_stopped {
                session.send(key);
            }
            session.signal(Signal::CONT);
            if !while_stopped {
                session.send(key);
            }
            let status = session.wait_exit(SOON);
            // The terminal itself may have taken Ctrl-C, while it was given back.
            assert!(status.code() == Some(0) || key == ctrl_c && status.signal() == Some(2), "{status}");
            session.assert_clean();
        }
    }
}

/// Signals that a program ignores by default do not end it.
#[test]
fn harmless_signals_do_not_end_the_program() {
    let mut session = looking(Start::new(PROGRAM).arg(SCENE));
    for signal in [Signal::CHILD, Signal::URG] {
        session.signal(signal);
    }
    session.send(b"i");
    session.wait_for_text("eye");
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

/// A write beyond the limit on the size of files is an error message, in the live view and outside.
#[test]
fn the_limit_on_the_size_of_files_is_an_error_message() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let limited = |arguments: &str| {
        let folder = folder.path().display();
        Start::shell(&format!("cd '{folder}'; ulimit -f 1; exec '{PROGRAM}' {arguments} '{SCENE}'"))
    };
    let mut session = looking(limited(""));
    session.send(b"o");
    session.wait_for_text("save picture as");
    session.send(b"p");
    session.wait_for_text("File too large");
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
    let mut session = limited("frame -o big.png --pixels 400x400").spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(1));
    session.wait_for_text("File too large");
}
