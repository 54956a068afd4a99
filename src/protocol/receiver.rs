//! Parsing of a terminal's bytes, and tracking of the replies that are still outstanding.

use super::outstanding::Outstanding;
use crate::input::{Input, Parser};
use std::time::Duration;

/// Timeout after which a lone `ESC` is the Escape key.
// 50 ms is usual in editors: longer than gaps within a sequence on most links, and too short to be noticed as a delay.
const ESCAPE_TIMEOUT: Duration = Duration::from_millis(50);
/// Timeout if a lone `ESC` is probably the first byte of a reply, or cannot be the Escape key
/// because all keys are sequences.
// A slow link may deliver a reply in two parts. They are less than a second apart, which is the longest plausible round
// trip.
const SEQUENCE_TIMEOUT: Duration = Duration::from_secs(1);

/// A parser of a terminal's bytes that also tracks outstanding replies and timeouts.
#[derive(Default)]
pub struct Receiver {
    parser: Parser,
    outstanding: Outstanding,
    /// Whether the terminal sends every key as a sequence.
    keys_are_sequences: bool,
    /// Time at which the last bytes arrived or the last timeout was handled.
    last_event: Duration,
}

impl Receiver {
    /// Records that `bytes` are sent at `now`. If they end with a query, its reply is outstanding.
    pub fn sent(&mut self, bytes: &[u8], now: Duration) {
        self.outstanding.sent(bytes, now);
    }

    /// Parses the bytes that arrive at `now` and returns the inputs.
    ///
    /// Without bytes it handles the timeout of an incomplete escape sequence, if that has passed.
    pub fn receive(&mut self, bytes: &[u8], now: Duration) -> Vec<Input> {
        let mut inputs = Vec::new();
        if !bytes.is_empty() {
            self.last_event = now;
            self.parser.feed(bytes, &mut inputs);
        } else if self.sequence_times_out_at(now).is_some_and(|due| due <= now) {
            self.last_event = now;
            self.parser.time_out(&mut inputs);
        }
        for input in &inputs {
            if let Input::Reply(reply) = input {
                self.outstanding.take(reply);
            }
        }
        inputs
    }

    /// Returns the time at which to call [`receive`](Self::receive) if no bytes arrive before.
    pub fn sequence_times_out_at(&self, now: Duration) -> Option<Duration> {
        let starts_sequence = self.keys_are_sequences || self.reply_time_left(now).is_some();
        let timeout = if starts_sequence { SEQUENCE_TIMEOUT } else { ESCAPE_TIMEOUT };
        self.parser.is_waiting().then_some(self.last_event + timeout)
    }

    /// Sets whether the terminal sends every key as a sequence.
    ///
    /// See [`Parser::set_keys_are_sequences`].
    pub fn set_keys_are_sequences(&mut self, keys_are_sequences: bool) {
        self.keys_are_sequences = keys_are_sequences;
        self.parser.set_keys_are_sequences(keys_are_sequences);
    }

    /// Returns the time left until outstanding replies time out.
    ///
    /// `None` if no reply is outstanding or the timeout has passed.
    pub fn reply_time_left(&self, now: Duration) -> Option<Duration> {
        self.outstanding.time_left(now)
    }

    /// Forgets the outstanding replies.
    pub fn forget_replies(&mut self) {
        self.outstanding.clear();
    }

    /// Forgets an incomplete sequence and all outstanding replies, after the terminal has been
    /// restored: the next bytes start a new stream.
    pub fn forget(&mut self) {
        self.forget_replies();
        // The parser is replaced, because the shell may have read the rest of an incomplete sequence.
        self.parser = Parser::new();
        self.keys_are_sequences = false;
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
