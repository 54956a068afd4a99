//! Whether replies are still on their way.

use super::output::timespec;
use super::query::{FENCE, Tag};
use crate::input::{Input, Parser, Reply};
use rustix::event::{PollFd, PollFlags, poll};
use rustix::{process, termios};
use std::collections::VecDeque;
use std::fs::File;
use std::io::Read;
use std::time::{Duration, Instant};

/// A terminal that has not answered after this time is taken for one that does not answer.
const LATEST: Duration = Duration::from_secs(3);

/// The most queries that are remembered: those of [`LATEST`] at 60 frames a second, and as many again.
const MOST: usize = 360;

/// What ended some bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Query {
    Fence,
    Tag(Tag),
}

/// Notes the queries sent, and reads along to see them answered.
#[derive(Default)]
pub(super) struct Unanswered {
    parser: Parser,
    /// Those whose replies are to come, oldest first.
    queries: VecDeque<Query>,
    /// When the last of them was sent.
    asked: Option<Instant>,
}

impl Unanswered {
    /// These bytes are sent now.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        let fence = bytes.ends_with(FENCE).then_some(Query::Fence);
        if let Some(query) = fence.or_else(|| Tag::at_end_of(bytes).map(Query::Tag)) {
            if self.queries.len() == MOST {
                self.queries.pop_front();
            }
            self.queries.push_back(query);
            self.asked = Some(Instant::now());
        }
    }

    /// The terminal has sent these bytes.
    pub(super) fn hear(&mut self, bytes: &[u8]) {
        let mut inputs = Vec::new();
        self.parser.feed(bytes, &mut inputs);
        for input in &inputs {
            match input {
                Input::Reply(Reply::DeviceAttributes(_)) => self.take(Query::Fence),
                &Input::Reply(Reply::Mode { mode, .. }) => {
                    if let Some(tag) = Tag::of_mode(mode) {
                        self.take(Query::Tag(tag));
                    }
                }
                _ => {}
            }
        }
    }

    /// The oldest such query is answered. Terminals answer in order: replies to older ones do not come any more.
    fn take(&mut self, answered: Query) {
        if let Some(at) = self.queries.iter().position(|&query| query == answered) {
            self.queries.drain(..=at);
        }
    }

    /// How much longer replies may come, if they may.
    pub(super) fn patience(&self) -> Option<Duration> {
        let left = self.asked.filter(|_| !self.queries.is_empty())? + LATEST;
        left.checked_duration_since(Instant::now())
    }

    /// Reads what comes up to the last answer, at most until the deadline, so that none is left for the shell. It gets those
    /// that come later: they are waited for no longer. Returns what was read.
    pub(super) fn drain(&mut self, keys: &File, deadline: Instant) -> Vec<u8> {
        let mut read = Vec::new();
        if !is_in_background(keys) {
            self.read_up_to_last(keys, deadline, &mut read);
        }
        self.queries.clear();
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

    /// A terminal may be given back more than once.
    #[test]
    fn the_count_starts_anew_when_the_terminal_is_given_back() {
        let mut unanswered = Unanswered::default();
        unanswered.send(FENCE);
        unanswered.send(b"frame\x1b[c");
        assert_eq!(unanswered.queries.len(), 2);
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

    #[test]
    fn the_reply_to_a_tag_is_the_last_of_all_before_it() {
        let [first, second, third] = [Tag::FIRST, Tag::FIRST.next(), Tag::FIRST.next().next()];
        let mut unanswered = Unanswered::default();
        unanswered.send(FENCE);
        for tag in [first, second, third] {
            unanswered.send(&tag.query());
        }
        // The fence's reply and that to the first are lost; another comes twice, and one is foreign.
        unanswered.hear(b"\x1b[?201;0$y\x1b[?201;0$y\x1b[?700;0$y\x1b[?2026;2$y\x1b[?62c");
        assert_eq!(unanswered.queries, [Query::Tag(third)]);
        unanswered.hear(b"\x1b[?202;0$y");
        assert_eq!(unanswered.patience(), None);
    }
}
