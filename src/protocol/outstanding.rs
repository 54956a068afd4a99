//! The replies that are outstanding.

use super::query::{FENCE, Tag};
use crate::input::Reply;
use std::collections::VecDeque;
use std::time::Duration;

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

/// The queries that end what was sent, until their replies come.
///
/// Terminals answer in order: a reply shows that no reply to an older query will come.
#[derive(Clone, Debug, Default)]
pub struct Outstanding {
    /// Oldest first.
    queries: VecDeque<Query>,
    /// When the last of them was sent.
    asked: Duration,
}

impl Outstanding {
    /// These bytes are sent now: notes the query that they end with, if they end with one.
    pub fn sent(&mut self, bytes: &[u8], now: Duration) {
        let fence = bytes.ends_with(FENCE).then_some(Query::Fence);
        if let Some(query) = fence.or_else(|| Tag::at_end_of(bytes).map(Query::Tag)) {
            if self.queries.len() == MOST {
                self.queries.pop_front();
            }
            self.queries.push_back(query);
            self.asked = now;
        }
    }

    /// A reply has come; one to no query that is outstanding changes nothing.
    pub fn take(&mut self, reply: &Reply) {
        let answered = match reply {
            Reply::DeviceAttributes(_) => Some(Query::Fence),
            &Reply::Mode { mode, .. } => Tag::of_mode(mode).map(Query::Tag),
            _ => None,
        };
        if let Some(at) = answered.and_then(|answered| self.queries.iter().position(|&query| query == answered)) {
            self.queries.drain(..=at);
        }
    }

    /// How much longer replies may come: `None` if none is outstanding, or the last is overdue.
    pub fn patience(&self, now: Duration) -> Option<Duration> {
        self.queries.back()?;
        (self.asked + LATEST).checked_sub(now)
    }

    /// Waits for none of these replies any more.
    pub fn clear(&mut self) {
        self.queries.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOW: Duration = Duration::from_secs(1);

    fn mode(mode: u16) -> Reply {
        Reply::Mode { mode, state: 0 }
    }

    #[test]
    fn the_reply_to_a_tag_is_the_last_of_all_before_it() {
        let [first, second, third] = [Tag::FIRST, Tag::FIRST.next(), Tag::FIRST.next().next()];
        let mut outstanding = Outstanding::default();
        outstanding.sent(FENCE, NOW);
        for tag in [first, second, third] {
            outstanding.sent(&tag.query(), NOW);
        }
        // The fence's reply and that to the first are lost; another comes twice, and one is foreign.
        for reply in [mode(201), mode(201), mode(700), mode(2026), Reply::DeviceAttributes(vec![62])] {
            outstanding.take(&reply);
        }
        assert_eq!(outstanding.queries, [Query::Tag(third)]);
        outstanding.take(&mode(202));
        assert_eq!(outstanding.patience(NOW), None);
    }

    #[test]
    fn a_terminal_that_does_not_answer_is_waited_for_3_seconds() {
        let mut outstanding = Outstanding::default();
        outstanding.sent(b"frame", NOW);
        assert_eq!(outstanding.patience(NOW), None, "nothing was asked");
        outstanding.sent(b"frame\x1b[c", NOW);
        assert_eq!(outstanding.patience(NOW + LATEST / 3), Some(2 * LATEST / 3));
        assert_eq!(outstanding.patience(NOW + 2 * LATEST), None);
    }

    #[test]
    fn no_more_queries_are_remembered_than_can_be_answered_in_time() {
        let mut outstanding = Outstanding::default();
        for _ in 0..10 * MOST {
            outstanding.sent(FENCE, NOW);
        }
        assert_eq!(outstanding.queries.len(), MOST);
    }
}
