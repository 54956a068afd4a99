//! Tracking of queries whose replies have not arrived.

use super::query::{FENCE, Tag};
use crate::input::Reply;
use std::collections::VecDeque;
use std::time::Duration;

/// Time after the last query at which the terminal is assumed not to reply.
// While replies are outstanding, a lone ESC is reported later, and quitting waits for them. The longest round trip to
// be expected of a link (a satellite) is below one second.
const REPLY_TIMEOUT: Duration = Duration::from_secs(3);

/// Limit on the number of recorded queries.
///
/// It is twice the number sent within [`REPLY_TIMEOUT`] at 60 frames a second, one per frame.
const MAX_QUERIES: usize = 360;

/// A recorded query: the fence (DA1), or a numbered query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Query {
    Fence,
    Tag(Tag),
}

/// The queries whose replies have not arrived, for timeouts.
///
/// Terminals reply in order: a reply shows that no reply to an older query will come.
#[derive(Clone, Debug, Default)]
pub struct Outstanding {
    /// The queries in the order in which they were sent.
    queries: VecDeque<Query>,
    /// The time at which the last query was sent.
    last_sent: Duration,
}

impl Outstanding {
    /// Records that `bytes` are sent at `now`, with the query at their end, if any.
    pub fn sent(&mut self, bytes: &[u8], now: Duration) {
        let fence = bytes.ends_with(FENCE).then_some(Query::Fence);
        if let Some(query) = fence.or_else(|| Tag::at_end_of(bytes).map(Query::Tag)) {
            // At the limit the oldest query is dropped, because a reply to it is the least likely.
            if self.queries.len() == MAX_QUERIES {
                self.queries.pop_front();
            }
            self.queries.push_back(query);
            self.last_sent = now;
        }
    }

    /// Removes the query that `reply` answers and all older ones.
    ///
    /// A reply that matches no outstanding query changes nothing.
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

    /// Returns the time left until outstanding replies time out.
    ///
    /// `None` if no reply is outstanding or the timeout has passed.
    pub fn time_left(&self, now: Duration) -> Option<Duration> {
        self.queries.back()?;
        (self.last_sent + REPLY_TIMEOUT).checked_sub(now)
    }

    /// Forgets all queries.
    pub fn clear(&mut self) {
        self.queries.clear();
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
