//! What the replies say, and what follows when they do not come.

use super::alignment::Alignment;
use super::blind::Blind;
use super::estimates::{Busy, Rates, RoundTrip};
use super::ledger::{InFlight, Ledger, Matched, Query, Trust};
use super::{FRAME, LONGEST};
use crate::protocol::{FENCE, Tag};
use std::time::Duration;

/// How much later than expected a reply may come before a frame is sent without it. A local terminal replies within some
/// milliseconds, and within 100 while it is busy; with this a key that waits for the timeout is seen within 250 ms.
const TIMEOUT: Duration = Duration::from_millis(150);
/// The same for a slow link, where a frame sent too early queues behind others: a link that becomes ten times slower
/// has its replies 280 ms apart.
const SLOW_TIMEOUT: Duration = Duration::from_millis(300);
/// How many times this is doubled while it is not known whether it was too short: 2.4 s.
const MOST_BACKOFF: u32 = 3;
/// The same after the first frame, if nothing was heard before: a key pressed at once is seen within 500 ms.
const FIRST_TIMEOUT: Duration = Duration::from_millis(400);
/// How long the terminal may be silent after a timeout until it is taken for one that does not reply: two timeouts more.
const PATIENCE: Duration = Duration::from_millis(300);
/// The same for a slow link. What is sent without replies to one that only stands still for a moment queues there.
const SLOW_PATIENCE: Duration = Duration::from_secs(1);
/// The same if nothing was ever heard: with [`FIRST_TIMEOUT`] a second after the first frame.
const FIRST_PATIENCE: Duration = Duration::from_millis(600);
/// The same if the rate is not known yet: the first picture may be on its way through a link of 2 KB/s, which full frames
/// without replies would fill for minutes. Until then small ones show keys (see [`Blind`]).
const BLIND_PATIENCE: Duration = Duration::from_secs(10);
/// How long a query waits for its reply in a terminal that is silent.
const SILENT_TIMEOUT: Duration = Duration::from_millis(500);
/// How long no reply may come until all are in.
const SETTLED: Duration = Duration::from_secs(1);
/// A terminal whose shortest round trip is below this is near: which of several late replies comes first does not matter.
const NEAR: Duration = Duration::from_millis(20);
/// So much later than its shortest round trip a reply comes at once.
const AT_ONCE: Duration = Duration::from_millis(10);
/// A reply that comes so late is of a terminal that stood still, and no round trip.
const STOOD_STILL: Duration = Duration::from_secs(1);

/// How much later than expected a reply of a slow link is when the link must have become slower.
const LATE: Duration = Duration::from_millis(50);
/// How far apart queries alone are, while frames are sent.
const PROBE: Duration = Duration::from_secs(1);
/// After so many bytes a rate is relied on that was never found to be the link's limit: four frames.
const TRUSTED: f64 = 60_000.0;

/// What was asked, what the replies tell of the link, and what follows when they do not come.
pub(super) struct Replies {
    pub(super) state: State,
    pub(super) ledger: Ledger,
    alignment: Alignment,
    pub(super) tagging: Tagging,
    /// Whether the second reply to a query of both kinds is to come.
    echo: bool,
    /// When a reply last came, if one ever did.
    pub(super) heard: Option<Duration>,
    /// How many times in a row a timeout may have been too short.
    backoff: u32,
    /// When a query was last sent without a frame.
    probed: Option<Duration>,
    pub(super) round_trip: RoundTrip,
    pub(super) rates: Rates,
    busy: Busy,
    /// How many bytes are known to have arrived since the terminal was silent (slow start).
    pub(super) delivered: f64,
    /// Whether the link was slow when that was last found out.
    slow: bool,
    pub(super) blind: Blind,
}

/// What is known of the terminal's replies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// The terminal is not to be asked: it might print the query.
    Unasked,
    /// No reply has come yet, and none is late.
    Unheard,
    /// Replies come when they should.
    Steady,
    /// A reply is late: a frame at a time. When the terminal is taken for silent.
    Recovering { until: Duration },
    /// Which replies belong to which queries is not known: none is asked until no more replies come. When the last came.
    Settling { heard: Duration },
    /// The terminal is taken for one that does not reply.
    Silent,
}

/// Whether the terminal repeats the number of a mode that does not exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tagging {
    /// It has reported no mode at all, and might print the query.
    Unknown,
    /// It reports modes; this one is asked for when in doubt.
    Possible,
    /// It does.
    Known,
}

impl Replies {
    pub(super) fn new(may_ask: bool) -> Self {
        Self {
            state: if may_ask { State::Unheard } else { State::Unasked },
            ledger: Ledger::default(),
            alignment: Alignment::default(),
            tagging: Tagging::Unknown,
            echo: false,
            heard: None,
            backoff: 0,
            probed: None,
            round_trip: RoundTrip::default(),
            rates: Rates::default(),
            busy: Busy::default(),
            delivered: 0.0,
            slow: false,
            blind: Blind::default(),
        }
    }

    pub(super) fn is_slow(&self) -> bool {
        self.slow
    }

    pub(super) fn set_slow(&mut self, slow: bool) {
        self.slow = slow;
    }

    /// Puts a query behind nothing: its round trip is the link's own.
    pub(super) fn probe(&mut self, bytes: &mut Vec<u8>, now: Duration) {
        self.probed = Some(now);
        self.ask(bytes, false, now);
    }

    /// Whether a frame that is sent now ends with a query.
    pub(super) fn asks(&self) -> bool {
        match self.state {
            State::Unheard | State::Steady | State::Recovering { .. } => true,
            // The next one only when the last is given up.
            State::Silent => self.ledger.oldest().is_none(),
            State::Unasked | State::Settling { .. } => false,
        }
    }

    /// Notes bytes that are sent, if that is done without knowing how much the link takes.
    pub(super) fn spend(&mut self, bytes: usize, now: Duration) {
        if self.is_blind() {
            self.blind.spend(bytes, now);
        }
    }

    pub(super) fn answers(&self) -> bool {
        !matches!(self.state, State::Unasked | State::Silent)
    }

    /// Whether what is sent now is sent without knowing how much the link takes.
    pub(super) fn is_blind(&self) -> bool {
        matches!(self.state, State::Recovering { .. } | State::Settling { .. }) && !self.knows_rate()
    }

    /// Whether the rate may be relied on: a rate that was never reached is, when enough has arrived at it.
    pub(super) fn knows_rate(&self) -> bool {
        self.rates.best().is_some_and(|rate| rate.is_limit || self.delivered >= TRUSTED)
    }

    /// Whether a reply of a slow link is late: the link is slower than it seemed, and what is sent before it is known
    /// how much would only wait.
    pub(super) fn is_late(&self, now: Duration) -> bool {
        self.slow && self.ledger.oldest().is_some_and(|oldest| now > self.due(oldest) + LATE)
    }

    /// When the reply to the oldest query in flight should come.
    pub(super) fn due(&self, oldest: &InFlight) -> Duration {
        self.passes(self.busy.until(), oldest) + self.round_trip.expected()
    }

    /// When the link has passed on all that is in flight, as far as the replies tell.
    pub(super) fn passed_at(&self) -> Duration {
        self.ledger.live().fold(self.busy.until(), |free_at, query| self.passes(free_at, query))
    }

    /// When the link, if it is free then, has passed on what ends with a query.
    pub(super) fn passes(&self, free_at: Duration, query: &InFlight) -> Duration {
        free_at.max(query.sent) + self.takes(query.bytes)
    }

    /// How long the link takes over so many bytes; no time if its rate is not known.
    pub(super) fn takes(&self, bytes: usize) -> Duration {
        let rate = self.rates.best().map_or(f64::INFINITY, |rate| rate.bytes_per_second);
        Duration::try_from_secs_f64(bytes as f64 / rate).unwrap_or(LONGEST)
    }

    pub(super) fn is_probe_due(&self, now: Duration) -> bool {
        let asks = matches!(self.state, State::Unheard | State::Steady);
        asks && self.probed.is_none_or(|last| now >= last + PROBE)
    }

    /// Puts a query behind bytes that are sent now, and takes note of it, with how many they are if they are a frame.
    pub(super) fn ask(&mut self, bytes: &mut Vec<u8>, is_frame: bool, now: Duration) {
        let query = self.query();
        if let Query::Tagged(tag) | Query::Both(tag) = query {
            bytes.extend_from_slice(&tag.query());
        }
        if let Query::Counted | Query::Both(_) = query {
            bytes.extend_from_slice(FENCE);
        }
        self.ledger.ask(query, if is_frame { bytes.len() } else { 0 }, now);
    }

    /// The next query. In doubt it is of both kinds: another terminal may have taken the place of the one that was there.
    pub(super) fn query(&mut self) -> Query {
        let doubts = matches!(self.state, State::Recovering { .. } | State::Silent);
        match self.tagging {
            Tagging::Known if self.state != State::Silent => Query::Tagged(self.ledger.next_tag()),
            Tagging::Possible | Tagging::Known if doubts => Query::Both(self.ledger.next_tag()),
            _ => Query::Counted,
        }
    }

    /// What was asked will not be answered: another program had the terminal in between.
    pub(super) fn forget(&mut self) {
        self.ledger.clear();
        self.echo = false;
        if matches!(self.state, State::Recovering { .. } | State::Settling { .. }) {
            self.state = State::Steady;
        }
    }

    /// The terminal has answered DA1.
    pub(super) fn answer(&mut self, now: Duration) {
        if let State::Settling { heard } = &mut self.state {
            *heard = now;
        }
        if std::mem::take(&mut self.echo) {
            return;
        }
        // A reply that no query is waiting for, such as one that came twice, tells nothing.
        let Some(oldest) = self.ledger.counted().next().map(|oldest| oldest.sent) else { return };
        if self.is_behind(now) {
            return self.settle(now);
        }
        let first = self.heard.replace(now).is_none();
        let in_order =
            !self.ledger.is_ambiguous() || self.state != State::Silent && (first || self.is_first_pictures(now));
        if !in_order && self.slow {
            self.backoff = MOST_BACKOFF.min(self.backoff + 1);
        }
        let is_unclear = if in_order { self.is_too_early(oldest, now) } else { self.slow };
        if is_unclear {
            return self.settle(now);
        }
        let matched = if in_order {
            self.ledger.take_oldest()
        } else {
            // The shortest round trip of one that is near may be that of the start, while it was busy.
            let least =
                if self.is_near() { Duration::ZERO } else { self.round_trip.shortest().mul_f64(0.9).min(FRAME) };
            let latest = now.saturating_sub(least);
            self.ledger.take_newest_sent_by(latest)
        };
        if matched.is_some_and(|matched| matches!(matched.query, Query::Both(_))) {
            // It has passed over the tag.
            self.tagging = Tagging::Possible;
        }
        self.take(matched, now);
    }

    /// The way may be another: the window grows from nothing.
    fn start_slowly(&mut self) {
        self.round_trip.doubt();
        self.delivered = 0.0;
    }

    /// The terminal has reported a mode. Whether it is the reply to a query in flight: one that comes twice, or too late,
    /// or that something else has asked for is none.
    pub(super) fn answer_mode(&mut self, mode: u16, now: Duration) -> bool {
        if self.tagging == Tagging::Unknown {
            self.tagging = Tagging::Possible;
        }
        let Some(tag) = Tag::of_mode(mode) else { return false };
        let matched = self.ledger.take_tagged(tag);
        if matched.is_some() || tag == Tag::FIRST {
            self.tagging = Tagging::Known;
        }
        if let Some(Matched { query, .. }) = matched {
            self.echo = matches!(query, Query::Both(_));
            self.heard = Some(now);
            self.take(matched, now);
        }
        matched.is_some()
    }

    /// Whether a reply without a number that comes now shows that one of a slow link was lost. Between frames that follow each
    /// other no timeout does.
    fn is_behind(&mut self, now: Duration) -> bool {
        let Some(rate) = self.rates.best().filter(|_| self.slow && !self.ledger.is_ambiguous()) else { return false };
        let round_trip = self.round_trip.shortest();
        self.alignment.is_behind(self.ledger.counted(), round_trip, rate.bytes_per_second, now)
    }

    /// Whether a reply that comes now is that of another query: or the way has become shorter.
    fn is_too_early(&self, sent: Duration, now: Duration) -> bool {
        self.round_trip.is_far_above(now.saturating_sub(sent))
    }

    /// Whether a reply that comes now, and may be late, is that to the first picture rather than to what was sent last:
    /// through a slow link it takes long, and the reply of a terminal that is near comes at once.
    fn is_first_pictures(&self, now: Duration) -> bool {
        let comes_at_once = |sent: Duration| now <= sent + self.round_trip.shortest() + AT_ONCE;
        let is_lasts = self.is_near() && self.ledger.newest().is_some_and(comes_at_once);
        self.rates.best().is_none() && !is_lasts
    }

    fn is_near(&self) -> bool {
        self.round_trip.is_known() && self.round_trip.shortest() < NEAR
    }

    /// The terminal replies, to this query if to one.
    fn take(&mut self, matched: Option<Matched>, now: Duration) {
        let Some(matched) = matched else { return };
        self.blind = Blind::default();
        self.delivered += matched.run.1 as f64;
        if matched.lost_probe {
            self.probed = None;
        }
        if matched.trust == Trust::Late {
            self.ledger.revive();
        }
        // What has arrived is not known in doubt, and without a rate too much might be on its way.
        let is_blind = matched.trust == Trust::Doubtful && !self.knows_rate();
        self.state = if is_blind { State::Recovering { until: self.silent_at(now) } } else { State::Steady };
        let had_round_trip = self.round_trip.is_known();
        self.take_round_trip(matched, now);
        let tells_rate = matches!(matched.trust, Trust::Sure | Trust::Late);
        // The first round trip of a link whose rate is known says nothing more of the rate.
        if tells_rate && (had_round_trip || self.rates.best().is_none()) {
            self.take_rate(matched, now);
        }
    }

    fn take_round_trip(&mut self, matched: Matched, now: Duration) {
        let round_trip = now.saturating_sub(matched.sent);
        match matched.trust {
            Trust::Doubtful => return,
            Trust::Late if round_trip >= STOOD_STILL => return,
            Trust::Sure => self.backoff = 0,
            _ => {}
        }
        self.round_trip.take(round_trip, matched.bytes == 0 || !self.slow, now);
    }

    fn take_rate(&mut self, matched: Matched, now: Duration) {
        // Frames are close together on a slow link, so that what is known of the last is known of all.
        let (sent, bytes) = if self.slow { matched.run } else { (matched.sent, matched.bytes) };
        let passed = now.saturating_sub(self.round_trip.shortest());
        let is_late = self.slow && passed > self.busy.until().max(sent) + self.takes(bytes) + LATE;
        let (bytes, service) = self.busy.take(sent, bytes, passed);
        self.rates.take(bytes, service, is_late, now);
    }

    /// Begins anew when all replies are in. Until then what is sent goes by the rate alone, if it is that of a slow link;
    /// another may be a misunderstanding.
    fn settle(&mut self, now: Duration) {
        self.ledger.clear();
        self.alignment = Alignment::default();
        if self.slow {
            self.rates.doubt();
        } else {
            (self.rates, self.blind) = Default::default();
            self.start_slowly();
        }
        self.state = State::Settling { heard: now };
    }

    /// When the oldest query in flight is given up, if there is one (the retransmission timeout).
    pub(super) fn times_out_at(&self) -> Option<Duration> {
        let oldest = self.ledger.oldest()?;
        Some(match self.heard {
            None if self.state == State::Unheard => oldest.sent + FIRST_TIMEOUT,
            None => oldest.sent + FIRST_PATIENCE / 2,
            Some(heard) => heard.max(self.due(oldest)) + self.timeout(),
        })
    }

    /// How much later than expected a reply may come.
    fn timeout(&self) -> Duration {
        if self.slow { SLOW_TIMEOUT * (1 << self.backoff) } else { TIMEOUT }
    }

    /// When a terminal that has not replied in time, which is seen then, is taken for silent.
    fn silent_at(&self, since: Duration) -> Duration {
        let round_trip = self.round_trip.expected();
        since
            + match () {
                () if self.heard.is_none() => FIRST_PATIENCE,
                () if self.slow => self.timeout().max(SLOW_PATIENCE) + 4 * round_trip,
                () if self.knows_rate() => PATIENCE + round_trip,
                () => BLIND_PATIENCE,
            }
    }

    /// Waits no longer for replies that do not come.
    pub(super) fn look_at_clock(&mut self, now: Duration) {
        match self.state {
            State::Unheard | State::Steady | State::Recovering { .. } => {
                if self.times_out_at().is_some_and(|at| now >= at) {
                    self.ledger.give_up();
                    if !matches!(self.state, State::Recovering { .. }) {
                        self.state = State::Recovering { until: self.silent_at(now) };
                    }
                }
            }
            State::Silent => {
                if self.ledger.oldest().is_some_and(|oldest| now >= oldest.sent + SILENT_TIMEOUT) {
                    self.ledger.give_up();
                }
            }
            State::Settling { heard } if now >= heard + SETTLED + self.round_trip.shortest() => {
                self.forget();
                self.round_trip.doubt();
                self.probed = None;
            }
            State::Unasked | State::Settling { .. } => {}
        }
        if let State::Recovering { until } = self.state
            && now >= until
        {
            self.ledger.give_up();
            self.start_slowly();
            self.state = State::Silent;
        }
    }
}
