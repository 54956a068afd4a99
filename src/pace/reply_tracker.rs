//! The terminal's replies: what they show about the link, and what to do while replies are missing.

use super::alignment::Alignment;
use super::estimates::{BusyPeriod, FrameFloor, Rates, RoundTrip};
use super::initial_window::InitialWindow;
use super::ledger::{InFlight, Ledger, Matched, QueryKind, Validity};
use super::{FALLBACK_TRANSMISSION_TIME, FRAME_TIME};
use crate::protocol::{FENCE, Tag};
use std::time::Duration;

/// Time after a reply was due until it counts as missing, and frames no longer wait for it (the
/// retransmission timeout).
// A local terminal replies within milliseconds, or within 100 ms while it is busy. With this timeout the effect of a
// key that waits for a lost reply is visible within 250 ms, which `faults` tests. The timeout was 10 s while replies
// could only be counted, and one lost reply stopped the picture for 8 to 12 s.
const RTO_MARGIN: Duration = Duration::from_millis(150);
/// Time after a reply was due on a slow link until it counts as missing.
// Longer than on a fast link: a frame that is sent too early would queue behind others, and the replies of a link that
// has become ten times slower are 280 ms apart.
const SLOW_RTO_MARGIN: Duration = Duration::from_millis(300);
/// Time after the first frame until its reply counts as missing.
// With this timeout the effect of a key that is pressed at once is visible within 500 ms. With a shorter one, more
// would be sent to a terminal that is still busy starting.
const FIRST_RTO: Duration = Duration::from_millis(400);
/// Time after a timeout until a terminal that has replied before is considered silent: two more
/// timeouts.
const SILENCE_TIMEOUT: Duration = Duration::from_millis(300);
/// Time after a timeout until a terminal on a slow link that has replied before is considered
/// silent.
// Longer than on a fast link: if the terminal merely pauses, the frames that are sent to it would occupy a slow link
// for seconds.
const SLOW_SILENCE_TIMEOUT: Duration = Duration::from_secs(1);
/// Time after the first timeout until a terminal that has never replied is considered silent.
///
/// The terminal is then considered silent a second after the first frame: [`FIRST_RTO`] plus this time.
const FIRST_SILENCE_TIMEOUT: Duration = Duration::from_millis(600);
/// Time after a timeout until a terminal that has replied before is considered silent, while the
/// rate is unknown.
///
/// Until then small frames show the effect of keys (see [`InitialWindow`]).
// The first picture, of 15 KB, may still be on its way through a link of 2 KB/s, in which full frames would queue for
// minutes.
const UNKNOWN_RATE_SILENCE_TIMEOUT: Duration = Duration::from_secs(10);
/// Interval between queries to a terminal that is considered silent.
// A terminal that starts to reply gets the full frame rate again after at most this time.
const SILENT_QUERY_INTERVAL: Duration = Duration::from_millis(500);
/// Time without replies after which a resync ends: every outstanding reply has then arrived or
/// counts as lost.
// No query is sent during a resync, so a late reply cannot be taken for one to a new query.
const RESYNC_TIME: Duration = Duration::from_secs(1);
/// Shortest round trip from which on a terminal is not considered local.
// Longer than the 17 ms between two draws of a local terminal, shorter than most round trips over the internet.
const LOCAL_ROUND_TRIP: Duration = Duration::from_millis(20);
/// Time by which a reply may exceed the shortest round trip and still count as immediate.
const IMMEDIATE_REPLY_TOLERANCE: Duration = Duration::from_millis(10);
/// Least round trip that is ignored after a spurious timeout, because the terminal was probably
/// suspended.
const MAX_ROUND_TRIP: Duration = Duration::from_secs(1);

/// Delay of a reply beyond its due time that shows that a slow link has become slower.
// Until a reply is that late, frames are sent at the old rate. With a margin of 50 ms, recovery from a tenfold drop of
// the rate takes 1.65 to 1.87 s of simulated time; with 100 ms it took 1.73 to 1.94 s.
const LATE_REPLY_MARGIN: Duration = Duration::from_millis(50);
/// Least rate in bytes per second that is assumed after the first resync.
// After a pause, the rate computed from the bytes that have arrived since the first query is too low. At 7,500 bytes
// per second a frame has about 200 bytes (36 frames a second), the least that shows a rate to be too low.
const MIN_RESYNC_RATE: f64 = 7_500.0;
/// Number of replies that must arrive in order after a resync until several queries may be in
/// flight again.
///
/// With a terminal that loses one reply in 20, 41 % of a link of 50 KB/s are used; with 8 replies it was 25 %.
const SERIAL_REPLIES: u32 = 16;
/// Interval between queries without a frame, which measure the link's round trip while frames are
/// sent.
// Such a query costs 3 to 8 bytes. Queries that end frames cannot replace it: their transmission time would be taken
// for a part of the round trip, and after five seconds the estimated rate was 190 KB/s instead of 50.
const PROBE_INTERVAL: Duration = Duration::from_secs(1);
/// Number of bytes delivered after which an estimated rate is relied on even if it is only a lower
/// bound.
// About four screens of 80x24 cells: within these bytes, the rate of a slow link would have been measured as its limit.
const MIN_DELIVERED_BYTES: f64 = 60_000.0;

/// The queries in flight, and what the replies so far show about the terminal and the link.
pub(super) struct ReplyTracker {
    pub(super) state: ReplyState,
    pub(super) ledger: Ledger,
    alignment: Alignment,
    pub(super) tag_support: TagSupport,
    /// Whether the DA1 reply to a [`QueryKind::Both`] is due; the DECRQM was answered.
    awaits_second_reply: bool,
    /// Time of the last reply, if any.
    pub(super) last_reply: Option<Duration>,
    /// Number of replies that must still arrive in order until several queries may be in flight
    /// again.
    serial_replies: u32,
    /// Time of the last query without a frame.
    last_probe: Option<Duration>,
    pub(super) round_trip: RoundTrip,
    pub(super) rates: Rates,
    busy_period: BusyPeriod,
    pub(super) frame_floor: FrameFloor,
    /// Number of bytes known to have arrived since the estimates were dropped last, which limits
    /// the window (slow start).
    pub(super) delivered: f64,
    /// Time of the first query since the estimates were dropped last.
    begun: Option<Duration>,
    /// Whether the link was slow when the limit on a frame's bytes was last computed.
    slow: bool,
    pub(super) initial_window: InitialWindow,
}

/// Whether the terminal replies in time, and how its replies are matched to queries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ReplyState {
    /// No queries are sent, because the terminal might print them.
    Unqueried,
    /// No reply has arrived yet, and none is missing.
    Unanswered,
    /// Replies arrive in time.
    Steady,
    /// A reply is missing: frames are sent one at a time, until `until`, when the terminal is
    /// considered silent.
    Recovering { until: Duration },
    /// The state in which it is unknown to which query the next reply belongs: no query is sent
    /// until replies stop. Contains the time of the last reply.
    Resyncing { last_reply: Duration },
    /// The terminal is considered silent.
    Silent,
}

/// Whether the terminal answers DECRQM of a nonexistent mode and repeats its number, so that
/// replies have numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TagSupport {
    /// The terminal has answered no DECRQM, and might print it.
    Unknown,
    /// The terminal has answered a DECRQM, but perhaps does not answer one of a nonexistent mode.
    ///
    /// The reply to a [`QueryKind::Both`] will show whether it does.
    Possible,
    /// The terminal answers DECRQM of a nonexistent mode, and repeats the number of the mode.
    Known,
}

impl ReplyTracker {
    pub(super) fn new(may_ask: bool) -> Self {
        Self {
            state: if may_ask { ReplyState::Unanswered } else { ReplyState::Unqueried },
            ledger: Ledger::default(),
            alignment: Alignment::default(),
            tag_support: TagSupport::Unknown,
            awaits_second_reply: false,
            last_reply: None,
            serial_replies: 0,
            last_probe: None,
            round_trip: RoundTrip::default(),
            rates: Rates::default(),
            busy_period: BusyPeriod::default(),
            frame_floor: FrameFloor::default(),
            delivered: 0.0,
            begun: None,
            slow: false,
            initial_window: InitialWindow::default(),
        }
    }

    pub(super) fn is_slow(&self) -> bool {
        self.slow
    }

    pub(super) fn set_slow(&mut self, slow: bool) {
        self.slow = slow;
        if !slow {
            self.frame_floor = FrameFloor::default();
        }
    }

    /// Appends a query without a frame, whose round trip contains no transmission time, and records
    /// it.
    pub(super) fn append_probe(&mut self, bytes: &mut Vec<u8>, now: Duration) {
        self.last_probe = Some(now);
        self.append_query(bytes, false, now);
    }

    /// Returns whether a frame sent now ends with a query.
    pub(super) fn frame_ends_with_query(&self) -> bool {
        match self.state {
            ReplyState::Unanswered | ReplyState::Recovering { .. } => true,
            ReplyState::Steady => self.may_query(),
            // A silent terminal gets the next query only after the timeout of the last one.
            ReplyState::Silent => self.ledger.oldest().is_none(),
            ReplyState::Unqueried | ReplyState::Resyncing { .. } => false,
        }
    }

    /// Returns whether a query may be sent now.
    ///
    /// After a resync on a slow link at most one query is in flight, so that replies without a number cannot be matched
    /// to the wrong query. Each mismatch makes the round trip seem longer and the rate lower: with every third reply
    /// lost, the estimate of 50 KB/s fell to 0.8 KB/s and a key took 936 ms, instead of 492 ms with this limit.
    fn may_query(&self) -> bool {
        !self.slow || self.serial_replies == 0 || self.ledger.oldest().is_none()
    }

    /// Subtracts bytes that are sent now from the budget of `initial_window`, if replies are
    /// missing and the rate is unknown.
    pub(super) fn spend_initial_window(&mut self, bytes: usize, now: Duration) {
        if self.uses_initial_window() {
            self.initial_window.spend(bytes, now);
        }
    }

    pub(super) fn is_responsive(&self) -> bool {
        !matches!(self.state, ReplyState::Unqueried | ReplyState::Silent)
    }

    /// Returns whether replies are missing and the rate is unknown, so that [`InitialWindow`]
    /// limits the next frame.
    pub(super) fn uses_initial_window(&self) -> bool {
        matches!(self.state, ReplyState::Recovering { .. } | ReplyState::Resyncing { .. }) && !self.knows_rate()
    }

    /// Returns whether the estimated rate can be relied on.
    ///
    /// A lower bound of the rate can be relied on once [`MIN_DELIVERED_BYTES`] have arrived.
    pub(super) fn knows_rate(&self) -> bool {
        self.rates.best().is_some_and(|rate| rate.is_limit || self.delivered >= MIN_DELIVERED_BYTES)
    }

    /// Returns whether the reply to the oldest query on a slow link is late.
    ///
    /// If so, the link is slower than estimated, and further bytes would only queue.
    pub(super) fn is_late(&self, now: Duration) -> bool {
        self.slow && self.ledger.oldest().is_some_and(|oldest| now > self.reply_due_at(oldest) + LATE_REPLY_MARGIN)
    }

    /// Returns the time at which the reply to `oldest`, the oldest query in flight, is expected.
    pub(super) fn reply_due_at(&self, oldest: &InFlight) -> Duration {
        self.transmitted_at(self.busy_period.transmitted_until(), oldest) + self.round_trip.expected()
    }

    /// Returns the estimated time at which the link has transmitted everything in flight.
    pub(super) fn idle_at(&self) -> Duration {
        self.ledger
            .in_flight()
            .fold(self.busy_period.transmitted_until(), |free_at, query| self.transmitted_at(free_at, query))
    }

    /// Returns the time at which a link that is free at `free_at` has transmitted `query` and the
    /// bytes before it.
    pub(super) fn transmitted_at(&self, free_at: Duration, query: &InFlight) -> Duration {
        (free_at.max(query.first_sent) + self.transmission_time(query.bytes)).max(query.sent)
    }

    /// Returns the time that the link takes to transmit this many bytes; zero if the rate is
    /// unknown.
    pub(super) fn transmission_time(&self, bytes: usize) -> Duration {
        let rate = self.rates.best().map_or(f64::INFINITY, |rate| rate.bytes_per_second);
        Duration::try_from_secs_f64(bytes as f64 / rate).unwrap_or(FALLBACK_TRANSMISSION_TIME)
    }

    pub(super) fn is_probe_due(&self, now: Duration) -> bool {
        let asks = matches!(self.state, ReplyState::Unanswered | ReplyState::Steady);
        asks && self.may_query() && self.last_probe.is_none_or(|last| now >= last + PROBE_INTERVAL)
    }

    /// Appends a query to `bytes`, which are sent now, and records it.
    ///
    /// The number of bytes is recorded as well if they are a frame.
    pub(super) fn append_query(&mut self, bytes: &mut Vec<u8>, is_frame: bool, now: Duration) {
        let query = self.next_query();
        // The DECRQM goes first: if the reply to the DA1 comes alone, the terminal does not answer a DECRQM.
        if let QueryKind::Tagged(tag) | QueryKind::Both(tag) = query {
            bytes.extend_from_slice(&tag.query());
        }
        if let QueryKind::Counted | QueryKind::Both(_) = query {
            bytes.extend_from_slice(FENCE);
        }
        self.begun.get_or_insert(now);
        self.ledger.record(query, if is_frame { bytes.len() } else { 0 }, now);
    }

    /// Returns the kind of query to send next.
    ///
    /// A terminal that repeats numbers gets a DECRQM; once it is silent it gets a DA1 as well, because another terminal
    /// that does not answer a DECRQM may have taken its place, as after a detach. A terminal that perhaps repeats
    /// numbers gets both while replies are missing. In all other cases the query is a DA1.
    pub(super) fn next_query(&mut self) -> QueryKind {
        let doubts = matches!(self.state, ReplyState::Recovering { .. } | ReplyState::Silent);
        match self.tag_support {
            TagSupport::Known if self.state != ReplyState::Silent => QueryKind::Tagged(self.ledger.next_tag()),
            TagSupport::Possible | TagSupport::Known if doubts => QueryKind::Both(self.ledger.next_tag()),
            _ => QueryKind::Counted,
        }
    }

    /// Forgets the queries in flight, and ends a recovery or resync.
    ///
    /// Called when another program has had the terminal, and at the end of a resync.
    pub(super) fn forget_queries(&mut self) {
        self.ledger.clear();
        self.awaits_second_reply = false;
        if matches!(self.state, ReplyState::Recovering { .. } | ReplyState::Resyncing { .. }) {
            self.state = ReplyState::Steady;
        }
    }

    /// Records a reply to DA1.
    pub(super) fn receive_attributes(&mut self, now: Duration) {
        if let ReplyState::Resyncing { last_reply } = &mut self.state {
            *last_reply = now;
        }
        if std::mem::take(&mut self.awaits_second_reply) {
            return;
        }
        // A reply without an outstanding query, such as a duplicate, is ignored.
        let Some(oldest) = self.ledger.counted_queries().next().map(|oldest| oldest.sent) else { return };
        if self.is_misaligned(now) {
            return self.resync(now);
        }
        let first = self.last_reply.replace(now).is_none();
        let in_order = !self.ledger.is_counted_reply_ambiguous()
            || self.state != ReplyState::Silent && (first || self.is_reply_to_first_frame(now));
        let is_unclear = if in_order { self.is_reply_too_early(oldest, now) } else { self.slow };
        if is_unclear {
            return self.resync(now);
        }
        let matched = if in_order {
            self.ledger.match_oldest()
        } else {
            // For a local terminal any round trip is plausible, because the shortest one so far may stem from its busy
            // start. Without this exception, an immediate reply seemed too early for the newest query and was matched
            // to one that had timed out long before: 786 bytes in 156 ms then made a local terminal look like a link of
            // 5 KB/s.
            let least =
                if self.is_local() { Duration::ZERO } else { self.round_trip.shortest().mul_f64(0.9).min(FRAME_TIME) };
            let latest = now.saturating_sub(least);
            self.ledger.match_newest_sent_by(latest)
        };
        if matched.is_some_and(|matched| matches!(matched.query, QueryKind::Both(_))) {
            // The reply to the DA1 half came without one to the DECRQM half, which the terminal has therefore ignored.
            self.tag_support = TagSupport::Possible;
        }
        self.apply_reply(matched, now);
    }

    /// Drops the estimate of the round trip because the route may have changed, and lets the window
    /// grow from zero.
    fn restart_slow_start(&mut self) {
        self.round_trip.invalidate();
        (self.delivered, self.begun) = (0.0, None);
    }

    /// Records a reply to DECRQM with the number of a mode.
    ///
    /// Returns whether the reply answers a query in flight; a duplicate, a late reply or a reply to another program's
    /// query does not.
    pub(super) fn match_mode_reply(&mut self, mode: u16, now: Duration) -> bool {
        if self.tag_support == TagSupport::Unknown {
            self.tag_support = TagSupport::Possible;
        }
        let Some(tag) = Tag::of_mode(mode) else { return false };
        let matched = self.ledger.match_tagged(tag);
        if matched.is_some() || tag == Tag::FIRST {
            self.tag_support = TagSupport::Known;
        }
        if let Some(Matched { query, .. }) = matched {
            self.awaits_second_reply = matches!(query, QueryKind::Both(_));
            self.last_reply = Some(now);
            self.apply_reply(matched, now);
        }
        matched.is_some()
    }

    /// Returns whether a reply without a number that arrives now shows that an earlier one was lost
    /// on a slow link.
    fn is_misaligned(&mut self, now: Duration) -> bool {
        let is_decidable = self.slow && !self.ledger.is_counted_reply_ambiguous();
        let Some(rate) = self.rates.best().filter(|_| is_decidable) else { return false };
        let round_trip = self.round_trip.shortest();
        self.alignment.is_misaligned(self.ledger.counted_queries(), round_trip, rate.bytes_per_second, now)
    }

    /// Returns whether a reply that arrives now is too early for a query sent at `query_sent`.
    ///
    /// Such a reply belongs to another query, or the route has become shorter.
    fn is_reply_too_early(&self, query_sent: Duration, now: Duration) -> bool {
        self.round_trip.is_too_short(now.saturating_sub(query_sent))
    }

    /// Returns whether a reply, which may be late, answers the query after the first picture rather
    /// than the last query.
    ///
    /// A local terminal replies to the last query at once; the reply to the first picture may take long on a slow link.
    fn is_reply_to_first_frame(&self, now: Duration) -> bool {
        let comes_at_once = |sent: Duration| now <= sent + self.round_trip.shortest() + IMMEDIATE_REPLY_TOLERANCE;
        let is_lasts = self.is_local() && self.ledger.newest_sent_at().is_some_and(comes_at_once);
        self.rates.best().is_none() && !is_lasts
    }

    fn is_local(&self) -> bool {
        self.round_trip.is_known() && self.round_trip.shortest() < LOCAL_ROUND_TRIP
    }

    /// Updates the state and the estimates by a reply; does nothing if it matches no query.
    fn apply_reply(&mut self, matched: Option<Matched>, now: Duration) {
        let Some(matched) = matched else { return };
        self.initial_window = InitialWindow::default();
        self.delivered += matched.acked.1 as f64;
        if matched.lost_probe {
            self.last_probe = None;
        }
        if matched.validity == Validity::Spurious {
            self.ledger.undo_timeout();
        }
        // An ambiguous reply does not show how many bytes have arrived, and while the rate is unknown too many might be
        // in flight.
        let is_rate_unknown = matched.validity == Validity::Ambiguous && !self.knows_rate();
        self.state =
            if is_rate_unknown { ReplyState::Recovering { until: self.silent_at(now) } } else { ReplyState::Steady };
        let had_round_trip = self.round_trip.is_known();
        self.record_round_trip(matched, now);
        let tells_rate = matches!(matched.validity, Validity::Exact | Validity::Spurious);
        // The first round trip after the estimate was dropped is itself the shortest one, so that the transmission time
        // computed from it would be zero.
        if tells_rate && (had_round_trip || self.rates.best().is_none()) {
            self.record_rate(matched, now);
        }
    }

    fn record_round_trip(&mut self, matched: Matched, now: Duration) {
        let round_trip = now.saturating_sub(matched.sent);
        match matched.validity {
            Validity::Ambiguous => return,
            Validity::Spurious if round_trip >= MAX_ROUND_TRIP => return,
            Validity::Exact => self.serial_replies = self.serial_replies.saturating_sub(1),
            _ => {}
        }
        self.round_trip.record(round_trip, matched.bytes == 0 || !self.slow, now);
    }

    fn record_rate(&mut self, matched: Matched, now: Duration) {
        // On a slow link frames follow each other without a pause, so that frames whose replies are lost were
        // transmitted directly before this one and count together with it.
        let (sent, bytes) = if self.slow { matched.acked } else { (matched.sent, matched.bytes) };
        let passed = now.saturating_sub(self.round_trip.shortest());
        let is_late = self.slow
            && passed
                > self.busy_period.transmitted_until().max(sent) + self.transmission_time(bytes) + LATE_REPLY_MARGIN;
        let (bytes, service) = self.busy_period.extend(sent, bytes, passed);
        if self.shows_drawing_time(matched.validity) {
            self.frame_floor.record(bytes, service, now);
        }
        self.rates.record(bytes, service, is_late, now);
    }

    /// Returns whether the reply to a frame shows for how long a near terminal has drawn it.
    ///
    /// `validity` says how certainly the reply belongs to the frame's query.
    fn shows_drawing_time(&self, validity: Validity) -> bool {
        // If the round trip is long, a small frame takes long because the link is slow, not because the terminal draws.
        // While the first picture is on its way, a reply without a number may be matched to the wrong query: at 5 KB/s
        // the frame floor then grew to 6 kB.
        let is_matched = self.tag_support == TagSupport::Known || self.delivered >= MIN_DELIVERED_BYTES;
        self.slow && self.is_local() && is_matched && validity == Validity::Exact
    }

    /// Gives up matching replies to queries until no more replies arrive.
    ///
    /// The rate of a slow link is kept, because frames are sent at that rate meanwhile. Other estimates may stem from
    /// replies matched to wrong queries, and are dropped.
    // Rejected: to drop only the query whose reply was lost. A reply that is merely late then counts twice, as lost and
    // as the reply to another query, and a key waits for 1.8 s.
    fn resync(&mut self, now: Duration) {
        self.ledger.clear();
        self.alignment = Alignment::default();
        self.frame_floor = FrameFloor::default();
        if self.slow {
            self.rates.drop_lower_bounds();
            if self.serial_replies == 0 && self.delivered < MIN_DELIVERED_BYTES {
                // If the first reply is lost, the reply to the first picture is matched to the first query. The round
                // trip then seems longer by the picture's transmission: a link of 50 KB/s was estimated at 137 KB/s,
                // each resync kept this estimate, and from then on a key took up to 1.4 s. While the program waited
                // for replies, the link was idle for at most half of the time since the first query, so the link's rate
                // is at most twice the bytes that arrived divided by this time.
                let arrived = self.delivered / now.saturating_sub(self.begun.unwrap_or_default()).as_secs_f64();
                self.rates.cap((2.0 * arrived).max(MIN_RESYNC_RATE));
            }
            self.serial_replies = SERIAL_REPLIES;
        } else {
            (self.rates, self.initial_window) = Default::default();
            self.restart_slow_start();
        }
        self.state = ReplyState::Resyncing { last_reply: now };
    }

    /// Returns the time at which the reply to the oldest query in flight counts as missing; `None`
    /// without such a query.
    pub(super) fn times_out_at(&self) -> Option<Duration> {
        let oldest = self.ledger.oldest()?;
        Some(match self.last_reply {
            None if self.state == ReplyState::Unanswered => oldest.sent + FIRST_RTO,
            None => oldest.sent + FIRST_SILENCE_TIMEOUT / 2,
            Some(last_reply) => last_reply.max(self.reply_due_at(oldest)) + self.timeout(),
        })
    }

    /// Returns the time after a reply was due until it counts as missing.
    fn timeout(&self) -> Duration {
        if self.slow { SLOW_RTO_MARGIN } else { RTO_MARGIN }
    }

    /// Returns the time at which a terminal that last replied, or timed out, at `since` is
    /// considered silent.
    fn silent_at(&self, since: Duration) -> Duration {
        let round_trip = self.round_trip.expected();
        since
            + match () {
                () if self.last_reply.is_none() => FIRST_SILENCE_TIMEOUT,
                () if self.slow => SLOW_SILENCE_TIMEOUT + 4 * round_trip,
                () if self.knows_rate() => SILENCE_TIMEOUT + round_trip,
                () => UNKNOWN_RATE_SILENCE_TIMEOUT,
            }
    }

    /// Updates the state at `now`: times out missing replies, and ends a recovery or resync.
    pub(super) fn check_timeouts(&mut self, now: Duration) {
        match self.state {
            ReplyState::Unanswered | ReplyState::Steady | ReplyState::Recovering { .. } => {
                if self.times_out_at().is_some_and(|at| now >= at) {
                    self.ledger.time_out_all();
                    if !matches!(self.state, ReplyState::Recovering { .. }) {
                        self.state = ReplyState::Recovering { until: self.silent_at(now) };
                    }
                }
            }
            ReplyState::Silent => {
                if self.ledger.oldest().is_some_and(|oldest| now >= oldest.sent + SILENT_QUERY_INTERVAL) {
                    self.ledger.time_out_all();
                }
            }
            ReplyState::Resyncing { last_reply } if now >= last_reply + RESYNC_TIME + self.round_trip.shortest() => {
                self.forget_queries();
                self.round_trip.invalidate();
                self.last_probe = None;
            }
            ReplyState::Unqueried | ReplyState::Resyncing { .. } => {}
        }
        if let ReplyState::Recovering { until } = self.state
            && now >= until
        {
            self.ledger.time_out_all();
            self.restart_slow_start();
            self.state = ReplyState::Silent;
        }
    }
}
