//! The replies that are outstanding, on a real terminal.

use super::output::timespec;
use crate::input::{Input, Parser};
use crate::protocol::Outstanding;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::{process, termios};
use std::fs::File;
use std::io::Read;
use std::time::{Duration, Instant};

/// Notes the queries sent, and reads along to see them answered.
pub(super) struct Unanswered {
    parser: Parser,
    outstanding: Outstanding,
    start: Instant,
}

impl Unanswered {
    /// Nothing was asked yet.
    pub(super) fn new() -> Self {
        Self { parser: Parser::new(), outstanding: Outstanding::default(), start: Instant::now() }
    }

    /// These bytes are sent now.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        self.outstanding.sent(bytes, self.start.elapsed());
    }

    /// The terminal has sent these bytes.
    pub(super) fn hear(&mut self, bytes: &[u8]) {
        let mut inputs = Vec::new();
        self.parser.feed(bytes, &mut inputs);
        for input in &inputs {
            if let Input::Reply(reply) = input {
                self.outstanding.take(reply);
            }
        }
    }

    /// How much longer replies may come, if they may.
    pub(super) fn patience(&self) -> Option<Duration> {
        self.outstanding.patience(self.start.elapsed())
    }

    /// Reads what comes up to the last answer, at most until the deadline, so that none is left for the shell. It gets those
    /// that come later: they are waited for no longer. Returns what was read.
    pub(super) fn drain(&mut self, keys: &File, deadline: Instant) -> Vec<u8> {
        let mut read = Vec::new();
        if !is_in_background(keys) {
            self.read_up_to_last(keys, deadline, &mut read);
        }
        self.outstanding.clear();
        read
    }

    fn read_up_to_last(&mut self, mut keys: &File, deadline: Instant, read: &mut Vec<u8>) {
        let mut buffer = [0; 4096];
        while let Some(patience) = self.patience() {
            let left = deadline.saturating_duration_since(Instant::now()).min(patience);
            if left.is_zero() {
                return;
            }
            match poll(&mut [PollFd::new(&keys, PollFlags::IN)], Some(&timespec(left))) {
                Ok(0) | Err(rustix::io::Errno::INTR) => continue,
                Ok(_) => {}
                Err(_) => return,
            }
            match keys.read(&mut buffer) {
                Ok(count) if count > 0 => {
                    self.hear(&buffer[..count]);
                    read.extend_from_slice(&buffer[..count]);
                }
                // It is gone.
                _ => return,
            }
        }
    }
}

/// Whether the terminal is another job's now: reading it would stop us.
pub(super) fn is_in_background(keys: &File) -> bool {
    termios::tcgetpgrp(keys).is_ok_and(|foreground| foreground != process::getpgrp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::FENCE;

    /// A terminal may be given back more than once.
    #[test]
    fn the_count_starts_anew_when_the_terminal_is_given_back() {
        let mut unanswered = Unanswered::new();
        unanswered.send(FENCE);
        unanswered.send(b"frame\x1b[c");
        let gone = File::open("/dev/null").expect("there is always /dev/null");
        unanswered.drain(&gone, Instant::now());
        assert_eq!(unanswered.patience(), None, "nobody waits for what is lost");
        // What is late then is nobody's answer, and what is asked then has its own.
        unanswered.hear(b"\x1b[?62c");
        unanswered.send(FENCE);
        assert!(unanswered.patience().is_some());
        unanswered.hear(b"\x1b[?62c");
        assert_eq!(unanswered.patience(), None);
    }
}
