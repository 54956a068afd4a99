//! The ledger of queries in flight: which reply belongs to which query, and which replies are missing.
//!
//! Terminals reply in order. So a reply with a number (a [`Tag`]'s) shows that those to all older queries are lost, and one
//! whose number is not in the ledger is late, doubled or foreign, and ignored. Replies without one (DA1's) are counted: each
//! belongs to the oldest query, until one was given up. A reply may then be that query's, late, or a newer one's (in TCP's
//! terms, retransmission ambiguity). The shortest round trip decides, and no estimate is made from it (Karn's algorithm).

use crate::protocol::Tag;
use std::collections::VecDeque;
use std::time::Duration;

/// The most queries that are remembered after they were given up: those sent while the first picture is on its way through
/// a very slow link, one each 150 to 200 ms for 10 s.
const MOST_GIVEN_UP: usize = 64;

/// What asks for the reply to a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Query {
    /// DA1.
    Counted,
    /// DECRQM of a mode that does not exist.
    Tagged(Tag),
    /// Both, and one reply suffices: whether the terminal answers the second kind is to be found out.
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

/// A query that has no reply yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct InFlight {
    pub(super) query: Query,
    pub(super) sent: Duration,
    /// How many bytes it ends: of a query alone, none that count.
    pub(super) bytes: usize,
    /// Whether a timeout has passed, and nothing was heard of it since.
    given_up: bool,
    /// Whether one ever has.
    late: bool,
}

/// The query that a reply belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Matched {
    pub(super) query: Query,
    pub(super) sent: Duration,
    pub(super) bytes: usize,
    /// The oldest query in flight before it whose reply is lost, and their bytes with its own: all of these have arrived.
    pub(super) run: (Duration, usize),
    /// Whether the reply to a query without a frame is among those that are lost.
    pub(super) lost_probe: bool,
    pub(super) trust: Trust,
}

/// What may be concluded from a match.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trust {
    /// The reply is that query's, and nothing before it was given up: round trip and rate.
    Sure,
    /// The reply is that query's, but older bytes may have been before it on a slow link: the round trip.
    AfterLoss,
    /// The reply is that query's, which had been given up: the timeout was spurious.
    Late,
    /// The reply may be an older query's: nothing but that the terminal replies.
    Doubtful,
}

/// The queries in flight, oldest first, and those given up.
#[derive(Debug)]
pub(super) struct Ledger {
    queries: VecDeque<InFlight>,
    last: Tag,
}

impl Default for Ledger {
    fn default() -> Self {
        Self { queries: VecDeque::new(), last: Tag::FIRST }
    }
}

impl Ledger {
    /// A tag that was not used for a while.
    pub(super) fn next_tag(&mut self) -> Tag {
        self.last = self.last.next();
        self.last
    }

    /// A query is sent now, behind so many bytes.
    pub(super) fn ask(&mut self, query: Query, bytes: usize, now: Duration) {
        self.queries.push_back(InFlight { query, sent: now, bytes, given_up: false, late: false });
    }

    /// Those that are not given up, oldest first.
    pub(super) fn live(&self) -> impl Iterator<Item = &InFlight> {
        self.queries.iter().filter(|query| !query.given_up)
    }

    /// The oldest that is not given up.
    pub(super) fn oldest(&self) -> Option<&InFlight> {
        self.live().next()
    }

    /// Whether a reply may belong to one that was given up.
    pub(super) fn is_ambiguous(&self) -> bool {
        self.queries.iter().any(|query| query.given_up && query.query.is_counted())
    }

    /// When the last one was sent.
    pub(super) fn newest(&self) -> Option<Duration> {
        self.queries.back().map(|query| query.sent)
    }

    /// The bytes that no reply has confirmed and no timeout has given up.
    pub(super) fn in_flight(&self) -> f64 {
        self.live().map(|query| query.bytes as f64).sum()
    }

    /// The timeout: what is in flight is not waited for any longer.
    pub(super) fn give_up(&mut self) {
        for query in &mut self.queries {
            (query.given_up, query.late) = (true, true);
        }
        let surplus = self.queries.len().saturating_sub(MOST_GIVEN_UP);
        self.queries.drain(..surplus);
    }

    /// The timeout was spurious: what is left is in flight after all (as after Eifel detection).
    pub(super) fn revive(&mut self) {
        for query in &mut self.queries {
            query.given_up = false;
        }
    }

    /// No reply will be matched to what was asked.
    pub(super) fn clear(&mut self) {
        self.queries.clear();
    }

    /// A reply with a number. `None`: it belongs to none of the queries.
    pub(super) fn take_tagged(&mut self, tag: Tag) -> Option<Matched> {
        let at = self.queries.iter().position(|query| query.query.tag() == Some(tag))?;
        Some(self.take(at))
    }

    /// The queries that replies without a number belong to, oldest first.
    pub(super) fn counted(&self) -> impl Iterator<Item = &InFlight> {
        self.queries.iter().filter(|query| query.query.is_counted())
    }

    /// A reply without a number, if it belongs to the oldest query.
    pub(super) fn take_oldest(&mut self) -> Option<Matched> {
        let at = self.queries.iter().position(|query| query.query.is_counted())?;
        Some(self.take(at))
    }

    /// A reply without a number, taken for that to the newest query that was sent by then.
    pub(super) fn take_newest_sent_by(&mut self, latest: Duration) -> Option<Matched> {
        let fits = |query: &InFlight| query.query.is_counted() && query.sent <= latest;
        let at = self.queries.iter().rposition(fits)?;
        Some(Matched { trust: Trust::Doubtful, ..self.take(at) })
    }

    /// Takes out the query and all older ones.
    fn take(&mut self, at: usize) -> Matched {
        let InFlight { query, sent, bytes, late, .. } = self.queries[at];
        let mut run = (sent, bytes);
        let mut trust = if late { Trust::Late } else { Trust::Sure };
        let mut lost_probe = false;
        for older in self.queries.drain(..=at).take(at) {
            lost_probe |= older.bytes == 0;
            if !older.given_up {
                run = (run.0.min(older.sent), run.1 + older.bytes);
            } else if !late {
                trust = Trust::AfterLoss;
            }
        }
        Matched { query, sent, bytes, run, lost_probe, trust }
    }
}
