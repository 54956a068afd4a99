//! Windows of any size: a picture takes bounded memory, whatever size a terminal reports.

use crate::pty::{SOON, Session, Start};
use rustix::termios::{Winsize, tcsetwinsize};
use std::fs;
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_termtrace");

/// Returns a folder with `empty.ron`, of which a million pixels are traced in a moment.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), background: \"teal\")";
    fs::write(folder.path().join("empty.ron"), text).expect("a file can be written");
    folder
}

/// Starts the program in that folder, after a command of the shell, and waits for its first output.
fn looking(folder: &TempDir, before: &str) -> Session {
    let script = format!("cd '{}'; {before} exec '{PROGRAM}' empty.ron", folder.path().display());
    let mut session = Start::shell(&script).spawn();
    session.wait_for("the picture", SOON, |seen| seen.has(b"\x1b[48;2;0;128;128m"));
    session
}

/// Reports another size of the window, for which the tests' own screen makes no cells.
fn claim(session: &Session, columns: u16, rows: u16) {
    let size = Winsize { ws_col: columns, ws_row: rows, ws_xpixel: 0, ws_ypixel: 0 };
    tcsetwinsize(session.terminal(), size).expect("a terminal can be resized");
}

/// The most memory that the program has had, in bytes.
#[cfg(target_os = "linux")]
fn peak(session: &Session) -> u64 {
    let status = fs::read_to_string(format!("/proc/{}/status", session.pid().as_raw_nonzero())).expect("it runs");
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"));
    peak.expect("the peak is told").parse::<u64>().expect("a number") * 1024
}

#[test]
fn a_window_of_any_size_shows_a_picture_of_bounded_size() {
    let folder = folder();
    let mut session = looking(&folder, "");
    for (columns, rows) in [(65_535, 65_535), (10_000, 5_000)] {
        let before = session.seen().bytes().len();
        claim(&session, columns, rows);
        let told = format!("of the window's {columns}x{rows} cells");
        session.wait_for("the limit is told", SOON, |seen| seen.has_after(before, told.as_bytes()));
        // Cells outside the picture are erased in the terminal's own colours.
        assert!(session.seen().has_after(before, b"\x1b[m\x1b[2J"));
    }
    #[cfg(target_os = "linux")]
    assert!(peak(&session) < 600_000_000, "{} bytes", peak(&session));
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

/// Leaving does not wait for the unread rest of a large picture.
#[test]
fn leaving_does_not_wait_for_a_large_picture() {
    let folder = folder();
    let mut session = looking(&folder, "");
    session.stop_reading();
    claim(&session, 65_535, 65_535);
    session.send(b"q");
    session.start_reading();
    let before = session.seen().bytes().len();
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
    assert!(session.seen().bytes().len() - before < 200_000, "a picture of a million cells was dropped");
}

/// A window for whose picture there is not enough memory is an error message.
#[cfg(target_os = "linux")]
#[test]
fn too_little_memory_for_a_window_is_an_error_message() {
    let folder = folder();
    let mut session = looking(&folder, "ulimit -v 450000;");
    claim(&session, 2000, 600);
    assert_eq!(session.wait_exit(SOON).code(), Some(1));
    session.assert_clean();
    let said = String::from_utf8_lossy(session.seen().bytes()).into_owned();
    assert!(said.contains("there is not enough memory for a picture of "), "{said:?}");
}
