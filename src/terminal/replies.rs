//! Waiting for replies that are outstanding when the terminal is restored.

use super::fault_injection;
use super::output::timespec;
use crate::input::Input;
use crate::protocol::Receiver;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::{process, termios};
use std::fs::File;
use std::io::Read;
use std::time::{Duration, Instant};

/// Reads the terminal until the last outstanding reply or the deadline, and returns the keys,
/// mouse events and replies that it has read.
///
/// Otherwise the shell would take these replies for typed text, as it does if they arrive after the deadline. `now` is
/// the receiver's time at the call.
pub(super) fn read_until_last_reply(
    mut tty: &File,
    receiver: &mut Receiver,
    now: Duration,
    deadline: Instant,
) -> Vec<Input> {
    let mut inputs = Vec::new();
    if is_in_background(tty) {
        return inputs;
    }
    let start = Instant::now();
    let mut buffer = [0; 4096];
    while let Some(reply_time_left) = receiver.reply_time_left(now + start.elapsed()) {
        let left = deadline.saturating_duration_since(Instant::now()).min(reply_time_left);
        if left.is_zero() {
            break;
        }
        match poll(&mut [PollFd::new(&tty, PollFlags::IN)], Some(&timespec(left))) {
            Ok(0) | Err(rustix::io::Errno::INTR) => continue,
            Ok(_) => {}
            Err(_) => break,
        }
        match tty.read(&mut buffer) {
            Ok(count) if count > 0 => {
                fault_injection::count_read(count);
                inputs.extend(receiver.receive(&buffer[..count], now + start.elapsed()));
            }
            // The terminal has hung up.
            _ => break,
        }
    }
    inputs
}

/// Returns whether this process is in the background, so that reading the terminal would stop it.
pub(super) fn is_in_background(keys: &File) -> bool {
    termios::tcgetpgrp(keys).is_ok_and(|foreground| foreground != process::getpgrp())
}
