//! The ledger of queries in flight: matches replies to queries and finds missing replies.
//!
//! Terminals reply in order. So a reply with a number (a [`Tag`]'s) shows that the replies to all older queries are
//! lost; one whose number is not in the ledger is late, a duplicate or foreign, and is ignored. Replies without a
//! number (DA1's) are counted: each belongs to the oldest query, unless one has timed out. A reply may then be that
//! query's, late, or a newer one's (retransmission ambiguity in TCP). The shortest round trip decides, and no estimate
//! is derived from it (Karn's algorithm).

use crate::protocol::Tag;
use std::collections::VecDeque;
use std::time::Duration;

/// Limit on the queries kept after their timeout.
// While the first picture is on its way through a very slow link, one query is sent every 150 to 200 ms for 10 s, all
// of which may be answered late.
const MAX_TIMED_OUT_QUERIES: usize = 64;

/// The kind of query behind a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Query {
    /// DA1.
    Counted,
    /// DECRQM of a nonexistent mode.
    Tagged(Tag),
    /// Both, either of which may be answered, to find out whether the terminal answers the second
    /// kind.
    Both(Tag),
}

impl Query {
    fn tag(self) -> Option<Tag> {
        match self {
            Self::Counted => None,
            Self::Tagged(tag) | Self::Both(tag) => Some(tag),
        }
    }

    fn is_counted(self) -> bool {
        !matches!(self, Self::Tagged(_))
    }
}

/// A query without a reply so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct InFlight {
    pub(super) query: Query,
    pub(super) sent: Duration,
    /// Number of bytes since the previous query; 0 for a query alone.
    pub(super) bytes: usize,
    /// Sending time of the first of these bytes.
    pub(super) first_sent: Duration,
    /// Whether its timeout has passed, and no later reply has shown that to be spurious.
    timed_out: bool,
    /// Whether its timeout has ever passed.
    late: bool,
}

/// The match of a reply to a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Matched {
    pub(super) query: Query,
    pub(super) sent: Duration,
    pub(super) bytes: usize,
    /// Sending time of the oldest query in flight before it whose reply is lost, and the bytes up
    /// to this one: all of them have arrived.
    pub(super) acked: (Duration, usize),
    /// Whether the reply to a query without a frame is among the lost ones.
    pub(super) lost_probe: bool,
    pub(super) validity: Validity,
}

/// The estimates for which a matched reply is a valid sample (Karn's algorithm).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Validity {
    /// The reply is this query's, and no query before it has timed out.
    ///
    /// It gives round trip and rate.
    Exact,
    /// The reply is this query's, but older bytes may precede it on a slow link.
    ///
    /// It gives the round trip.
    AfterLoss,
    /// The reply is this query's, after its timeout, which was spurious.
    Spurious,
    /// The reply may be an older query's: it shows only that the terminal replies.
    Ambiguous,
}

/// The queries in flight, oldest first, and those that have timed out.
#[derive(Debug)]
pub(super) struct Ledger {
    queries: VecDeque<InFlight>,
    /// Sending time and number of the bytes that no query follows yet.
    unqueried: Option<(Duration, usize)>,
    last: Tag,
}

impl Default for Ledger {
    fn default() -> Self {
        Self { queries: VecDeque::new(), unqueried: None, last: Tag::FIRST }
    }
}

impl Ledger {
    /// Returns a tag that has not been used for a while.
    pub(super) fn next_tag(&mut self) -> Tag {
        self.last = self.last.next();
        self.last
    }

    /// Records a query that is sent now behind this many bytes.
    pub(super) fn record(&mut self, query: Query, bytes: usize, now: Duration) {
        let (first_sent, before) = self.unqueried.take().unwrap_or((now, 0));
        let bytes = before + bytes;
        self.queries.push_back(InFlight { query, sent: now, bytes, first_sent, timed_out: false, late: false });
    }

    /// Records bytes that are sent now without a query.
    ///
    /// The reply to the next query shows that they have arrived.
    pub(super) fn record_unqueried(&mut self, bytes: usize, now: Duration) {
        let (_, unqueried) = self.unqueried.get_or_insert((now, 0));
        *unqueried += bytes;
    }

    /// Returns the queries that have not timed out, oldest first.
    pub(super) fn in_flight(&self) -> impl Iterator<Item = &InFlight> {
        self.queries.iter().filter(|query| !query.timed_out)
    }

    /// Returns the oldest query that has not timed out.
    pub(super) fn oldest(&self) -> Option<&InFlight> {
        self.in_flight().next()
    }

    /// Returns whether a reply may belong to a query that has timed out.
    pub(super) fn is_ambiguous(&self) -> bool {
        self.queries.iter().any(|query| query.timed_out && query.query.is_counted())
    }

    /// Returns the time at which the last query was sent.
    pub(super) fn last_sent(&self) -> Option<Duration> {
        self.queries.back().map(|query| query.sent)
    }

    /// Returns the bytes that are neither confirmed by a reply nor timed out.
    pub(super) fn bytes_in_flight(&self) -> f64 {
        let unqueried = self.unqueried.map_or(0, |(_, bytes)| bytes);
        self.in_flight().map(|query| query.bytes as f64).sum::<f64>() + unqueried as f64
    }

    /// Records a timeout: all queries in flight time out.
    pub(super) fn time_out_all(&mut self) {
        for query in &mut self.queries {
            (query.timed_out, query.late) = (true, true);
        }
        let surplus = self.queries.len().saturating_sub(MAX_TIMED_OUT_QUERIES);
        self.queries.drain(..surplus);
    }

    /// Records that the timeout was spurious.
    ///
    /// The remaining queries are in flight after all (as after Eifel detection).
    pub(super) fn undo_timeout(&mut self) {
        for query in &mut self.queries {
            query.timed_out = false;
        }
    }

    /// Forgets all queries.
    pub(super) fn clear(&mut self) {
        self.queries.clear();
        self.unqueried = None;
    }

    /// Matches a reply with a number. `None` if it belongs to no query.
    pub(super) fn match_tagged(&mut self, tag: Tag) -> Option<Matched> {
        let at = self.queries.iter().position(|query| query.query.tag() == Some(tag))?;
        Some(self.take(at))
    }

    /// Returns the queries that replies without a number may belong to, oldest first.
    pub(super) fn counted(&self) -> impl Iterator<Item = &InFlight> {
        self.queries.iter().filter(|query| query.query.is_counted())
    }

    /// Matches a reply without a number to the oldest query, if it belongs to that.
    pub(super) fn match_oldest(&mut self) -> Option<Matched> {
        let at = self.queries.iter().position(|query| query.query.is_counted())?;
        Some(self.take(at))
    }

    /// Matches a reply without a number to the newest query sent by `sent`.
    pub(super) fn match_newest_sent_by(&mut self, latest: Duration) -> Option<Matched> {
        let fits = |query: &InFlight| query.query.is_counted() && query.sent <= latest;
        let at = self.queries.iter().rposition(fits)?;
        Some(Matched { validity: Validity::Ambiguous, ..self.take(at) })
    }

    /// Removes the query at this index and all older ones.
    fn take(&mut self, at: usize) -> Matched {
        let InFlight { query, sent, bytes, first_sent, late, .. } = self.queries[at];
        let mut acked = (first_sent, bytes);
        let mut validity = if late { Validity::Spurious } else { Validity::Exact };
        let mut lost_probe = false;
        for older in self.queries.drain(..=at).take(at) {
            lost_probe |= older.bytes == 0;
            if !older.timed_out {
                acked = (acked.0.min(older.first_sent), acked.1 + older.bytes);
            } else if !late {
                validity = Validity::AfterLoss;
            }
        }
        Matched { query, sent, bytes, acked, lost_probe, validity }
    }
}
