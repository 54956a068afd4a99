//! The link to the terminal: how much may be sent, and when.
//!
//! The terminal is asked what it is ([`FENCE`]) after each frame. When the answer comes, the frame is through: so the
//! answers tell how long the way there and back takes, how many bytes a second the link delivers, and how many are in
//! flight. No more than its rate times its shortest round trip, and one frame, are ever in flight; more would only wait
//! somewhere in between, and with it the frame that shows the next key. (Both estimates age, as in the congestion control
//! BBR. The terminal's status, DSR 5, would be a shorter answer, but st 0.9 does not tell it.)
//!
//! A frame's bytes are written at once, so the link's rate shows in a single one: its bytes over what its round trip
//! takes longer than the shortest. Frames keep a seventh below that rate, so that what has piled up somewhere runs off,
//! and the shortest round trip stays to be seen.
//!
//! Pure: it is told the time, and reads and writes nothing.

use crate::terminal::FENCE;
use std::collections::VecDeque;
use std::time::Duration;

mod estimates;

use estimates::{Busy, Rate, Rates, RoundTrip};

/// A link is slow that cannot bring so many screens a second.
const SMOOTH: f64 = 16.0;
/// How many frames a second there are at least on a slow link: what a frame may take is its share of the rate. The smaller
/// a frame is, the sooner its answer tells that the link has become slower, and the less is in flight until then.
const FRAMES_PER_SECOND: f64 = 36.0;
/// A frame may always take so many bytes: less tells too little of a rate that was thought too low.
const LEAST_BYTES: usize = 200;
/// So much of the rate is used: the rest is what an estimate may be too high by.
const SHARE: f64 = 0.86;
/// So late may bytes be sent without losing their share.
const CREDIT: Duration = Duration::from_millis(20);
/// Frames are at least this far apart.
const FRAME: Duration = Duration::from_micros(16_667);
/// And so far where the terminal answers nothing.
const SILENT_FRAME: Duration = Duration::from_micros(33_334);
/// How long nothing is sent to a terminal that has never answered, after the first frame.
const FIRST_PATIENCE: Duration = Duration::from_millis(500);
/// How much later than expected an answer may be before it is taken for lost.
const PATIENCE: Duration = Duration::from_secs(1);
/// The same where nothing is known of the rate yet: a whole screen may take long.
const LONG_PATIENCE: Duration = Duration::from_secs(10);
/// So many late answers may be waited for.
const MOST_LOST: usize = 16;
/// How much later than expected an answer of a slow link is when the link must have become slower.
const LATE: Duration = Duration::from_millis(50);
/// How far apart questions alone are, while frames are sent.
const PROBE: Duration = Duration::from_secs(1);

/// A link, and what is known of it.
pub(super) struct Link {
    max_rate: Option<f64>,
    frame: Duration,
    /// Not answered yet, oldest first.
    asked: VecDeque<Question>,
    /// How many were given up: their answers may be late.
    lost: usize,
    /// Nobody can say which answers belong to which questions: none is asked until no more answers come. When the last
    /// one came.
    settling: Option<Duration>,
    far_end: FarEnd,
    /// When it was last heard, if it ever was.
    heard: Option<Duration>,
    probed: Option<Duration>,
    round_trip: RoundTrip,
    rates: Rates,
    busy: Busy,
    slow: bool,
    /// How much of its share of the rate the last frame took.
    fill: f64,
    /// When all that was sent is through, at the rate that is kept.
    free_at: Duration,
    /// The same without credit.
    drained_at: Duration,
}

/// What is known of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FarEnd {
    /// It answers, or has not had the time to.
    Answers,
    /// It is taken for one that does not answer.
    Silent,
    /// It is not to be asked: it might print the question.
    NotAsked,
}

/// A question on its way, or its answer.
#[derive(Clone, Copy)]
struct Question {
    sent: Duration,
    /// How many bytes it ends: of a question alone, none that count.
    bytes: usize,
}

/// What a frame may take on a slow link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slow {
    /// The link's rate in bytes per second.
    pub(super) rate: f64,
    /// The most bytes that a frame should take.
    pub(super) most_bytes: usize,
}

impl Link {
    /// A link that is to carry at most so many bytes and frames a second, to a terminal that may be asked, or not.
    pub(super) fn new(max_rate: Option<u32>, max_frames: Option<f32>, may_ask: bool) -> Self {
        Self {
            max_rate: max_rate.map(f64::from),
            frame: max_frames.map_or(FRAME, |fps| FRAME.max(Duration::from_secs_f32(1.0 / fps))),
            asked: VecDeque::new(),
            lost: 0,
            settling: None,
            far_end: if may_ask { FarEnd::Answers } else { FarEnd::NotAsked },
            heard: None,
            probed: None,
            round_trip: RoundTrip::default(),
            rates: Rates::default(),
            busy: Busy::default(),
            slow: false,
            fill: 0.0,
            free_at: Duration::ZERO,
            drained_at: Duration::ZERO,
        }
    }

    /// How far apart frames are at least.
    pub(super) fn frame_time(&self) -> Duration {
        if self.answers() { self.frame } else { self.frame.max(SILENT_FRAME) }
    }

    /// How many frames a second there are on a slow link.
    fn frames_per_second(&self) -> f64 {
        FRAMES_PER_SECOND.min(1.0 / self.frame_time().as_secs_f64())
    }

    /// The bytes of a rate for each of them.
    fn share(&self, rate: Rate) -> f64 {
        rate.bytes_per_second / self.frames_per_second()
    }

    fn answers(&self) -> bool {
        self.far_end == FarEnd::Answers
    }

    /// When the next bytes may be sent, if nothing is heard until then.
    pub(super) fn free_at(&self, now: Duration) -> Duration {
        // A question alone is to wait behind nothing.
        let free_at = if self.is_probe_due(now) { self.drained_at } else { self.free_at };
        free_at.max(if self.answers() { self.has_room_at(now) } else { Duration::ZERO })
    }

    /// When there is room for another frame, if nothing is heard until then.
    fn has_room_at(&self, now: Duration) -> Duration {
        if self.is_late(now) {
            self.patience_ends()
        } else if self.in_flight() <= self.window() {
            Duration::ZERO
        } else if self.has_room_beside_largest() {
            self.passed_at()
        } else {
            self.patience_ends()
        }
    }

    /// Whether an answer of a slow link is late: the link is slower than it seemed, and what is sent before it is known
    /// how much would only wait.
    fn is_late(&self, now: Duration) -> bool {
        let due = |oldest: &Question| self.passes(self.busy.until(), oldest) + self.round_trip.shortest();
        self.slow && self.asked.front().is_some_and(|oldest| now > due(oldest) + LATE)
    }

    /// Whether no more than the rate times the round trip is in flight beside one large frame: one that was sent at a higher
    /// rate. The next one need not wait until its answer has come all the way back.
    fn has_room_beside_largest(&self) -> bool {
        let Some(rate) = self.rates.best().filter(|_| self.slow) else { return false };
        let largest = self.asked.iter().map(|question| question.bytes as f64).fold(0.0, f64::max);
        self.in_flight() - largest + self.fill * self.share(rate) <= self.on_the_way(rate)
    }

    /// When the link has passed on all that was asked, as far as the answers tell.
    fn passed_at(&self) -> Duration {
        self.asked.iter().fold(self.busy.until(), |free_at, question| self.passes(free_at, question))
    }

    /// When the link, if it is free then, has passed on what ends with a question.
    fn passes(&self, free_at: Duration, question: &Question) -> Duration {
        let rate = self.rates.best().map_or(f64::INFINITY, |rate| rate.bytes_per_second);
        let takes = Duration::try_from_secs_f64(question.bytes as f64 / rate).unwrap_or(PATIENCE);
        free_at.max(question.sent) + takes
    }

    /// Whether the link is slow for screens of so many bytes, and what a frame may take then.
    pub(super) fn slow(&mut self, screen: usize) -> Option<Slow> {
        let limit = self.max_rate.unwrap_or(f64::INFINITY);
        let measured = self.rates.best();
        let smooth = screen as f64 * SMOOTH;
        let rate = measured.map_or(f64::INFINITY, |rate| rate.bytes_per_second).min(limit);
        // Slow as soon as a screen does not fit, and fast when two do: in between it stays what it was.
        let is_sure = limit < smooth || measured.is_some_and(|rate| rate.is_limit);
        self.slow = rate < smooth && is_sure || rate < 2.0 * smooth && self.slow;
        self.slow.then(|| Slow { rate, most_bytes: LEAST_BYTES.max((rate / self.frames_per_second()) as usize) })
    }

    /// Whether it was slow when that was last asked.
    pub(super) fn is_slow(&self) -> bool {
        self.slow
    }

    /// Puts a question behind the bytes of a frame that is sent now.
    pub(super) fn send(&mut self, frame: &mut Vec<u8>, now: Duration) {
        self.look_at_clock(now);
        let asks = match self.far_end {
            FarEnd::Answers => self.settling.is_none(),
            // It is asked again only when the last question is given up.
            FarEnd::Silent => self.asked.is_empty(),
            FarEnd::NotAsked => false,
        };
        if asks {
            frame.extend_from_slice(FENCE);
            self.asked.push_back(Question { sent: now, bytes: frame.len() });
        }
        self.fill = self.rates.best().map_or(0.0, |rate| frame.len() as f64 / self.share(rate));
        self.count(frame.len(), now);
    }

    /// A question without a frame, if it is time for one, or nothing: its round trip is the link's own, whatever the
    /// rate.
    pub(super) fn probe(&mut self, now: Duration) -> &'static [u8] {
        self.look_at_clock(now);
        if !self.is_probe_due(now) {
            return &[];
        }
        self.probed = Some(now);
        self.asked.push_back(Question { sent: now, bytes: 0 });
        self.count(FENCE.len(), now);
        FENCE
    }

    fn is_probe_due(&self, now: Duration) -> bool {
        let asks = self.answers() && self.settling.is_none();
        asks && self.probed.is_none_or(|last| now >= last + PROBE)
    }

    /// The terminal has answered.
    pub(super) fn answer(&mut self, now: Duration) {
        if self.far_end == FarEnd::NotAsked {
            return;
        }
        self.far_end = FarEnd::Answers;
        self.heard = Some(now);
        if self.settling.is_some() {
            self.settling = Some(now);
            return;
        }
        let Some(&question) = self.asked.front() else { return self.take_stray() };
        let round_trip = now.saturating_sub(question.sent);
        // The way has become shorter, or it is the answer to another question, or to none.
        let is_early = self.round_trip.is_far_above(round_trip);
        if is_early && self.lost > 0 {
            return self.take_stray();
        }
        let is_known = self.round_trip.is_known();
        if is_early || self.lost > 0 && !is_known {
            return self.settle(now);
        }
        let is_late = self.is_late(now);
        self.asked.pop_front();
        self.round_trip.take(round_trip, now);
        // The first round trip of a link whose rate is known says nothing more of the rate.
        if is_known || self.rates.best().is_none() {
            let passed = now.saturating_sub(self.round_trip.shortest());
            let (bytes, service) = self.busy.take(question.sent, question.bytes, passed);
            self.rates.take(bytes, service, is_late, now);
        }
    }

    /// Begins anew when all answers are in. Until then what is sent goes by the rate alone; of a link whose rate is not
    /// known, the next question is asked at once.
    fn settle(&mut self, now: Duration) {
        if self.rates.best().is_some() {
            self.asked.clear();
            self.rates.doubt();
            self.settling = Some(now);
        } else {
            self.lose_all();
            self.take_stray();
        }
    }

    /// An answer to a question that was given up, or to none.
    fn take_stray(&mut self) {
        self.lost = self.lost.saturating_sub(1);
    }

    fn lose_all(&mut self) {
        self.lost = MOST_LOST.min(self.lost + self.asked.len());
        self.asked.clear();
    }

    /// What was asked will not be answered: the terminal was somebody else's in between.
    pub(super) fn forget(&mut self) {
        self.asked.clear();
        self.lost = 0;
        self.settling = None;
    }

    fn in_flight(&self) -> f64 {
        self.asked.iter().map(|question| question.bytes as f64).sum()
    }

    /// How much may be in flight before another frame.
    fn window(&self) -> f64 {
        let Some(rate) = self.rates.best() else { return 0.0 };
        // What a frame leaves of its share others may use.
        let spare = if self.slow { ((1.0 - self.fill) * self.share(rate)).max(0.0) } else { 0.0 };
        self.on_the_way(rate) + spare
    }

    /// How much is on the way there and back, of what waits nowhere.
    fn on_the_way(&self, rate: Rate) -> f64 {
        rate.bytes_per_second * self.round_trip.shortest().as_secs_f64()
    }

    /// When the oldest question is taken for lost.
    fn patience_ends(&self) -> Duration {
        let Some(oldest) = self.asked.front() else { return Duration::MAX };
        let patience = match self.rates.best() {
            Some(rate) => {
                let expected = self.in_flight() / rate.bytes_per_second;
                PATIENCE + 4 * (self.round_trip.shortest() + Duration::try_from_secs_f64(expected).unwrap_or(PATIENCE))
            }
            None if self.heard.is_some() => LONG_PATIENCE,
            None => FIRST_PATIENCE,
        };
        self.heard.map_or(oldest.sent, |heard| heard.max(oldest.sent)) + patience
    }

    /// Waits no longer for answers that do not come: they are lost, or there are none, or the way is another.
    fn look_at_clock(&mut self, now: Duration) {
        if now >= self.patience_ends() {
            self.lose_all();
            self.far_end = FarEnd::Silent;
            self.round_trip = RoundTrip::default();
        }
        if self.settling.is_some_and(|last| now >= last + PATIENCE + self.round_trip.shortest()) {
            self.forget();
            self.round_trip = RoundTrip::default();
            self.probed = None;
        }
    }

    fn count(&mut self, bytes: usize, now: Duration) {
        let measured = self.rates.best().filter(|rate| rate.is_limit || self.slow);
        let measured = measured.map_or(f64::INFINITY, |rate| SHARE * rate.bytes_per_second);
        let rate = measured.min(self.max_rate.unwrap_or(f64::INFINITY));
        let takes = Duration::try_from_secs_f64(bytes as f64 / rate).unwrap_or(PATIENCE);
        self.free_at = self.free_at.max(now.saturating_sub(CREDIT)) + takes;
        self.drained_at = self.drained_at.max(now) + takes;
    }
}

#[cfg(test)]
mod tests;
