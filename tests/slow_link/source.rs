//! A source of frames of one size, which has always another: it goes by the program's own [`Link`].

use rustix::event::{PollFd, PollFlags, poll};
use std::fs::File;
use std::io::{Read, Write};
use std::time::{Duration, Instant};
use termtrace::internals::input::{Input, Parser, Reply};
use termtrace::internals::pace::Link;

/// The bytes of a frame, with its question.
const FRAME_BYTES: usize = 4_000;

/// Writes frames to a terminal in raw mode, until it reads `q` or the terminal is gone.
///
/// Each frame has the eye after all keys up to then.
pub(crate) fn run(mut terminal: File) {
    let mut link = Link::new(None, None, true);
    let (start, mut parser, mut begun) = (Instant::now(), Parser::new(), Duration::ZERO);
    let mut eye = [0, 0];
    loop {
        let next = link.next_send_at(start.elapsed()).max(begun + link.min_frame_interval());
        let left = next.saturating_sub(start.elapsed());
        if left.is_zero() {
            begun = start.elapsed();
            // It tells how the link is found, and has what frames may take settled.
            let slow = link.slow_limit(80 * 24 * 8).is_some();
            let mut bytes = link.probe(begun);
            let mut frame = frame(eye, slow);
            link.send(&mut frame, begun);
            bytes.extend(frame);
            if terminal.write_all(&bytes).is_err() {
                return;
            }
            continue;
        }
        let timeout = left.try_into().expect("a frame is near");
        let mut polled = [PollFd::new(&terminal, PollFlags::IN)];
        if !matches!(poll(&mut polled, Some(&timeout)), Ok(1..)) {
            continue;
        }
        let mut buffer = [0; 4096];
        let Ok(count @ 1..) = terminal.read(&mut buffer) else { return };
        let mut inputs = Vec::new();
        parser.feed(&buffer[..count], &mut inputs);
        for input in inputs {
            match input {
                Input::Reply(Reply::DeviceAttributes(_)) => link.receive_attributes(start.elapsed()),
                Input::Event(event) => match event.as_key_press_event().and_then(|key| key.code.as_char()) {
                    Some('a') => eye[0] -= 1,
                    Some('d') => eye[0] += 1,
                    Some('w') => eye[1] -= 1,
                    Some('s') => eye[1] += 1,
                    _ => return,
                },
                Input::Reply(_) => {}
            }
        }
    }
}

/// Returns a frame without its query: a status line, and spaces whose colours are not visible.
fn frame(eye: [i32; 2], slow: bool) -> Vec<u8> {
    let link = if slow { "slow link" } else { "" };
    let status = format!("\x1b[24;1H {link} eye {}.00 1.00 {}.00\x1b[K", eye[0], 5 + eye[1]);
    let spaces = " ".repeat(FRAME_BYTES - b"\x1b[c".len() - b"\x1b[1;1H".len() - status.len());
    format!("\x1b[1;1H{spaces}{status}").into_bytes()
}
