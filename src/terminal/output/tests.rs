use super::*;
use std::io::Read;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::thread;

/// Wherever a frame is cut, no sequence is cut, and all modes, strings and queries are kept in
/// order.
#[test]
fn a_frame_is_dropped_at_a_sequence_boundary() {
    let picture = "\x1b[?2026h\x1b[2;3H\x1b[38;2;1;2;3m▄é\x1b[58:2::1:2:3mx\x1b[C\x1b[m\x1b[2J\x1b[?2026l\x1b[c";
    let (before, after) = ("\x1b[?1049h\x1b[>15u\x1b[?u", "\x1b]52;c;YQ==\x1b\\");
    let sent = [before, picture, after].concat();
    let kept = ["\x1b[?1049h", "\x1b[>15u", "\x1b[?u", "\x1b[?2026h", "\x1b[?2026l", "\x1b[c", after];
    for written in 0..=sent.len() {
        let null = File::options().write(true).open("/dev/null").expect("there is always /dev/null");
        let mut output = Output { pending: sent.clone().into_bytes(), written, ..Output::new(null, false) };
        output.drop_frame();
        let shown = if output.pending.is_empty() { sent.clone() } else { string(&output.pending) };
        let mut rest = &*shown;
        for sequence in kept {
            let at = rest.find(sequence).unwrap_or_else(|| panic!("{written}: {sequence:?} in {shown:?}"));
            rest = &rest[at + sequence.len()..];
        }
        let (begun, rest) = shown.split_at(next_boundary(sent.as_bytes(), written).min(shown.len()));
        assert!(sent.starts_with(begun) && !rest.contains(['▄', 'é', 'x', 'm', 'H', 'C']), "{written}: {rest:?}");
    }
}

fn string(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("no character is cut")
}

/// The wait for a terminal goes on after signals, such as those of a window that is resized.
#[test]
fn signals_do_not_end_the_wait_for_a_terminal() {
    use nix::sys::pthread::{pthread_kill, pthread_self};
    use signal_hook::consts::SIGWINCH;

    let caught = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(SIGWINCH, Arc::clone(&caught)).expect("a handler can be set");
    let (near, mut far) = UnixStream::pair().expect("sockets can be had");
    near.set_nonblocking(true).expect("a socket has flags");
    while (&near).write(&[0; 4096]).is_ok() {}
    let waiting = pthread_self();
    thread::scope(|scope| {
        scope.spawn(move || {
            for _ in 0..20 {
                pthread_kill(waiting, nix::sys::signal::Signal::SIGWINCH).expect("the thread waits");
                while !caught.swap(false, Ordering::SeqCst) {
                    thread::yield_now();
                }
            }
            far.set_nonblocking(true).expect("a socket has flags");
            while far.read(&mut [0; 4096]).is_ok() {}
            // Returns the far end, so that it is closed only after the wait: a closed socket counts as writable, too.
            far
        });
        assert!(is_writable(&near, Duration::from_secs(60)));
    });
}

/// A frame larger than the terminal's buffer does not block the sender, even in blocking mode.
#[test]
fn sending_to_a_blocking_terminal_does_not_block() {
    let (mut master, slave) = pty_process::blocking::open().expect("a pseudo-terminal can be had");
    let slave = slave.as_fd().try_clone_to_owned().expect("a file descriptor can be doubled");
    let frame: Vec<u8> = (b'a'..=b'z').cycle().take(300_000).collect();
    let sent = frame.clone();
    let (done, wait) = channel();
    thread::spawn(move || {
        let mut output = Output::new(File::from(slave), true);
        output.send(&frame).expect("the terminal is there");
        let _ = done.send(output.is_pending());
        let is_drained = output.drain(Instant::now() + Duration::from_secs(10));
        let _ = done.send(is_drained);
    });
    let soon = Duration::from_secs(10);
    assert_eq!(wait.recv_timeout(soon), Ok(true), "without a reader, bytes stay pending");
    let mut read = vec![0; sent.len()];
    master.read_exact(&mut read).expect("all of it comes");
    assert_eq!(wait.recv_timeout(soon), Ok(true), "all bytes are written");
    assert!(read == sent, "the bytes arrive in order");
}
