//! What a terminal sends, cut into inputs once, and the replies among it that are still to come.

use super::outstanding::Outstanding;
use crate::input::{Input, Parser};
use std::time::Duration;

/// How long the rest of a key's escape sequence may take before a lone Escape is taken for the key.
const ESCAPE_WAIT: Duration = Duration::from_millis(50);
/// The same where a lone Escape is no key: the first byte of a reply may come alone.
const REPLY_WAIT: Duration = Duration::from_secs(1);

/// Parses the bytes of a terminal, and strikes off the replies that were outstanding.
#[derive(Default)]
pub struct Receiver {
    parser: Parser,
    outstanding: Outstanding,
    /// Whether the terminal writes every key as a sequence.
    keys_are_sequences: bool,
    /// When bytes last came, or were waited for in vain.
    heard: Duration,
}

impl Receiver {
    /// Notes the query that these bytes end with, if they end with one.
    pub fn sent(&mut self, bytes: &[u8], now: Duration) {
        self.outstanding.sent(bytes, now);
    }

    /// Returns what bytes say that come now. Without any, time has passed: where the rest of an escape sequence is overdue,
    /// what there is of it is taken for all of it.
    pub fn hear(&mut self, bytes: &[u8], now: Duration) -> Vec<Input> {
        let mut inputs = Vec::new();
        if !bytes.is_empty() {
            self.heard = now;
            self.parser.feed(bytes, &mut inputs);
        } else if self.escape_due(now).is_some_and(|due| due <= now) {
            self.heard = now;
            self.parser.give_up_waiting(&mut inputs);
        }
        for input in &inputs {
            if let Input::Reply(reply) = input {
                self.outstanding.take(reply);
            }
        }
        inputs
    }

    /// When [`hear`](Self::hear) is to be called if nothing comes until then.
    pub fn escape_due(&self, now: Duration) -> Option<Duration> {
        let is_no_key = self.keys_are_sequences || self.patience(now).is_some();
        let wait = if is_no_key { REPLY_WAIT } else { ESCAPE_WAIT };
        self.parser.is_waiting().then_some(self.heard + wait)
    }

    /// Whether the terminal writes every key as a sequence from now on: see [`Parser::set_keys_are_sequences`].
    pub fn set_keys_are_sequences(&mut self, keys_are_sequences: bool) {
        self.keys_are_sequences = keys_are_sequences;
        self.parser.set_keys_are_sequences(keys_are_sequences);
    }

    /// How much longer replies may come: `None` if none is outstanding, or the last is overdue.
    pub fn patience(&self, now: Duration) -> Option<Duration> {
        self.outstanding.patience(now)
    }

    /// Waits for no reply any more.
    pub fn forget_replies(&mut self) {
        self.outstanding.clear();
    }

    /// Forgets half a sequence and all outstanding replies: the terminal was given back, and what comes from it next is a
    /// new beginning.
    pub fn forget(&mut self) {
        self.forget_replies();
        self.parser = Parser::new();
        self.keys_are_sequences = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::FENCE;
    use crossterm::event::{Event, KeyCode};

    const ESCAPE: &[u8] = b"\x1b";

    fn escape() -> [Input; 1] {
        [Input::Event(Event::Key(KeyCode::Esc.into()))]
    }

    /// A terminal may be given back more than once.
    #[test]
    fn what_was_asked_before_is_not_waited_for_again() {
        let mut receiver = Receiver::default();
        receiver.sent(FENCE, Duration::ZERO);
        receiver.sent(b"frame\x1b[c", Duration::ZERO);
        receiver.forget();
        assert_eq!(receiver.patience(Duration::ZERO), None);
        // What is late then answers nothing, and what is asked then has a reply of its own.
        receiver.hear(b"\x1b[?62c", Duration::ZERO);
        receiver.sent(FENCE, Duration::ZERO);
        assert!(receiver.patience(Duration::ZERO).is_some());
        receiver.hear(b"\x1b[?62c", Duration::ZERO);
        assert_eq!(receiver.patience(Duration::ZERO), None);
    }

    #[test]
    fn a_lone_escape_is_the_key_when_its_rest_is_overdue() {
        let mut receiver = Receiver::default();
        assert_eq!(receiver.escape_due(Duration::ZERO), None);
        assert_eq!(receiver.hear(ESCAPE, Duration::ZERO), []);
        let due = receiver.escape_due(Duration::ZERO).expect("it waits");
        assert_eq!(receiver.hear(&[], due.mul_f32(0.9)), []);
        assert_eq!(receiver.hear(&[], due), escape());
        assert_eq!(receiver.escape_due(due), None);
    }

    #[test]
    fn the_rest_is_waited_for_longer_where_it_may_be_a_reply() {
        let (mut asked, mut kitty) = (Receiver::default(), Receiver::default());
        asked.sent(FENCE, Duration::ZERO);
        kitty.set_keys_are_sequences(true);
        for receiver in [&mut asked, &mut kitty] {
            receiver.hear(ESCAPE, Duration::ZERO);
            assert_eq!(receiver.escape_due(Duration::ZERO), Some(REPLY_WAIT));
        }
    }
}
