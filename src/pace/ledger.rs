//! The ledger of queries in flight: matches replies to queries and finds missing replies.
//!
//! Terminals reply in order. So a reply with a number (that of a [`Tag`]) shows that the replies to all older queries
//! are lost. A reply whose number is not in the ledger is late, a duplicate or foreign, and is ignored. Replies without
//! a number (those to DA1) are counted: each belongs to the oldest query, unless a query has timed out. In that case
//! the reply is either the late one to that query or one to a newer query (retransmission ambiguity in TCP): the
//! shortest round trip decides which, and no estimate is derived from the reply (Karn's algorithm).

use crate::protocol::Tag;
use std::collections::VecDeque;
use std::time::Duration;

/// Greatest number of queries that are kept after their timeout, because late replies may arrive
/// for them.
// While the first picture is on its way through a very slow link, a query is sent every 150 to 200 ms for 10 s. These
// are 50 to 67 queries, all of which may be answered late. (If 67 are sent, the oldest three are forgotten.)
const MAX_TIMED_OUT_QUERIES: usize = 64;

/// The kind of a query, which ends a frame or is sent without one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum QueryKind {
    /// DA1. Its reply has no number, so replies are counted.
    Counted,
    /// DECRQM of a nonexistent mode, whose number the terminal repeats in its reply.
    Tagged(Tag),
    /// DECRQM and DA1, to find out whether the terminal answers the former.
    Both(Tag),
}

impl QueryKind {
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
    pub(super) query: QueryKind,
    pub(super) sent: Duration,
    /// Number of bytes from the end of the previous query to the end of this one; 0 for a query
    /// without a frame.
    pub(super) bytes: usize,
    /// Time at which the first of the bytes that `bytes` counts was sent; `sent` if there are none.
    pub(super) first_sent: Duration,
    /// Whether the query has timed out, and no later reply has shown the timeout to be spurious.
    timed_out: bool,
    /// Whether the query has timed out, spuriously or not.
    late: bool,
}

/// A query and what its reply shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Matched {
    pub(super) query: QueryKind,
    pub(super) sent: Duration,
    pub(super) bytes: usize,
    /// All bytes that the reply confirms, and the time at which the first of them was sent.
    ///
    /// They include the bytes of older queries in flight, whose replies are lost.
    pub(super) acked: (Duration, usize),
    /// Whether the reply to an older query without a frame (a probe) was lost.
    pub(super) lost_probe: bool,
    pub(super) validity: Validity,
}

/// The certainty that a reply was matched to its query.
///
/// It decides which estimates the reply is a valid sample for (Karn's algorithm).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Validity {
    /// The reply belongs to this query, and no query before it has timed out.
    ///
    /// It gives the round trip and the rate.
    Exact,
    /// The reply belongs to this query, but bytes of older queries that have timed out may have
    /// delayed it.
    ///
    /// It gives the round trip only.
    AfterLoss,
    /// The reply belongs to this query and arrived after its timeout, which was therefore spurious.
    Spurious,
    /// The reply may belong to an older query, so it shows only that the terminal replies.
    Ambiguous,
}

/// The queries in flight, oldest first, and those that have timed out.
#[derive(Debug)]
pub(super) struct Ledger {
    queries: VecDeque<InFlight>,
    /// Bytes that no query follows yet: the time at which the first of them was sent, and their
    /// number.
    unqueried: Option<(Duration, usize)>,
    /// The tag of the last query that had one.
    last: Tag,
}

impl Default for Ledger {
    fn default() -> Self {
        Self { queries: VecDeque::new(), unqueried: None, last: Tag::FIRST }
    }
}

impl Ledger {
    /// Returns the tag for the next query.
    ///
    /// Tags are used in a cycle, so it is the one that has been unused for the longest time.
    pub(super) fn next_tag(&mut self) -> Tag {
        self.last = self.last.next();
        self.last
    }

    /// Records that a query is sent now, at the end of `bytes` bytes.
    pub(super) fn record(&mut self, query: QueryKind, bytes: usize, now: Duration) {
        let (first_sent, before) = self.unqueried.take().unwrap_or((now, 0));
        let bytes = before + bytes;
        self.queries.push_back(InFlight { query, sent: now, bytes, first_sent, timed_out: false, late: false });
    }

    /// Records that bytes are sent now without a query; the reply to the next query confirms them.
    pub(super) fn record_unqueried(&mut self, bytes: usize, now: Duration) {
        let (_, unqueried) = self.unqueried.get_or_insert((now, 0));
        *unqueried += bytes;
    }

    /// Returns the queries that have not timed out, oldest first.
    pub(super) fn in_flight(&self) -> impl Iterator<Item = &InFlight> {
        self.queries.iter().filter(|query| !query.timed_out)
    }

    /// Returns the oldest query that has not timed out, if any.
    pub(super) fn oldest(&self) -> Option<&InFlight> {
        self.in_flight().next()
    }

    /// Returns whether a reply without a number may belong to a query that has timed out.
    pub(super) fn is_counted_reply_ambiguous(&self) -> bool {
        self.queries.iter().any(|query| query.timed_out && query.query.is_counted())
    }

    /// Returns the time at which the newest unanswered query was sent; `None` if there is none.
    pub(super) fn newest_sent_at(&self) -> Option<Duration> {
        self.queries.back().map(|query| query.sent)
    }

    /// Returns the number of bytes that are neither confirmed by a reply nor timed out.
    pub(super) fn bytes_in_flight(&self) -> f64 {
        let unqueried = self.unqueried.map_or(0, |(_, bytes)| bytes);
        self.in_flight().map(|query| query.bytes as f64).sum::<f64>() + unqueried as f64
    }

    /// Marks all queries as timed out, and forgets the oldest beyond [`MAX_TIMED_OUT_QUERIES`].
    pub(super) fn time_out_all(&mut self) {
        for query in &mut self.queries {
            (query.timed_out, query.late) = (true, true);
        }
        let surplus = self.queries.len().saturating_sub(MAX_TIMED_OUT_QUERIES);
        self.queries.drain(..surplus);
    }

    /// Marks all queries as in flight again, because a reply has shown their timeout to be
    /// spurious.
    ///
    /// (Eifel detection in TCP has the same effect.)
    pub(super) fn undo_timeout(&mut self) {
        for query in &mut self.queries {
            query.timed_out = false;
        }
    }

    /// Forgets all queries, and the bytes that no query follows yet.
    pub(super) fn clear(&mut self) {
        self.queries.clear();
        self.unqueried = None;
    }

    /// Matches a reply with a number to its query; `None` if there is no such query.
    pub(super) fn match_tagged(&mut self, tag: Tag) -> Option<Matched> {
        let at = self.queries.iter().position(|query| query.query.tag() == Some(tag))?;
        Some(self.remove_through(at))
    }

    /// Returns the queries that replies without a number may belong to, oldest first.
    pub(super) fn counted_queries(&self) -> impl Iterator<Item = &InFlight> {
        self.queries.iter().filter(|query| query.query.is_counted())
    }

    /// Matches a reply without a number to the oldest query that it may belong to.
    pub(super) fn match_oldest(&mut self) -> Option<Matched> {
        let at = self.queries.iter().position(|query| query.query.is_counted())?;
        Some(self.remove_through(at))
    }

    /// Matches a reply without a number to the newest query that was sent at `latest` or before.
    pub(super) fn match_newest_sent_by(&mut self, latest: Duration) -> Option<Matched> {
        let fits = |query: &InFlight| query.query.is_counted() && query.sent <= latest;
        let at = self.queries.iter().rposition(fits)?;
        Some(Matched { validity: Validity::Ambiguous, ..self.remove_through(at) })
    }

    /// Removes the query at this index and all older ones, whose replies are lost, and returns what
    /// its reply shows.
    fn remove_through(&mut self, index: usize) -> Matched {
        let InFlight { query, sent, bytes, first_sent, late, .. } = self.queries[index];
        let mut acked = (first_sent, bytes);
        let mut validity = if late { Validity::Spurious } else { Validity::Exact };
        let mut lost_probe = false;
        for older in self.queries.drain(..=index).take(index) {
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
