//! The link to a terminal: how much may be in flight, and when (congestion control).
//!
//! A query ends each frame. When its reply comes, the frame has arrived: so the replies tell the round-trip time and the
//! rate of the link, and how many bytes are in flight. No more than the bandwidth-delay product (the rate times the
//! shortest round trip) and one frame are ever in flight; more would only queue somewhere in between, and with it the
//! frame that shows the next key. (Both estimates age, as in BBR. The terminal's status, DSR 5, would be a shorter reply,
//! but st 0.9 does not give it.)
//!
//! A frame's bytes are written at once, so the link's rate shows in a single one: its bytes over what its round trip
//! takes longer than the shortest. Frames keep a seventh below that rate, so that queues drain, and the shortest round
//! trip stays to be seen.
//!
//! Replies get lost. The ledger matches those that come to their queries. Where none comes, a timeout ends the wait
//! (`Recovering`): a frame at a time goes out, until a reply comes or the terminal is taken for silent
//! (`Silent`). What the state decides:
//!
//! | State      | next frame                                  | query              | left by                               |
//! |------------|---------------------------------------------|--------------------|---------------------------------------|
//! | Unasked    | at the rate                                 | none               | nothing                               |
//! | Unheard    | when a reply or the timeout has come        | each frame, alone  | a reply, the timeout                  |
//! | Steady     | when the congestion window has room         | each frame, alone  | the timeout, a reply to another query |
//! | Recovering | when a reply or the timeout has come; small | each frame         | a reply, patience                     |
//! | Settling   | at the rate                                 | none               | no reply for a second                 |
//! | Silent     | at the rate, 30 a second                    | one at a time      | a reply                               |
//!
//! Pure: it is told the time, and reads and writes nothing.
//!
//! ```
//! use std::time::Duration;
//! use termtrace::internals::pace::Link;
//!
//! let ms = Duration::from_millis;
//! let mut link = Link::new(None, None, true);
//! let mut frame = b"a frame of some bytes".to_vec();
//! link.send(&mut frame, ms(0));
//! assert!(frame.ends_with(b"\x1b[c"), "a query ends it");
//! // Until its reply comes there is room for no other frame.
//! assert!(link.free_at(ms(1)) > ms(100));
//! link.answer(ms(3));
//! assert!(link.free_at(ms(4)) <= ms(4));
//! ```

use std::time::Duration;

mod alignment;
mod blind;
mod estimates;
mod ledger;
mod replies;

use estimates::Rate;
use replies::{Replies, State};

/// A link is slow that cannot bring so many screens a second.
const SMOOTH: f64 = 16.0;
/// How many frames a second there are at least on a slow link: what a frame may take is its share of the rate. The smaller
/// a frame is, the sooner its reply tells that the link has become slower, and the less is in flight until then.
const FRAMES_PER_SECOND: f64 = 36.0;
/// A frame may always take so many bytes: less tells too little of a rate that was thought too low.
const LEAST_BYTES: usize = 200;
/// So much of the rate is used: the rest is what an estimate may be too high by.
const SHARE: f64 = 0.86;
/// What is taken for the time of bytes whose time cannot be told.
const LONGEST: Duration = Duration::from_secs(1);
/// So late may bytes be sent without losing their share.
const CREDIT: Duration = Duration::from_millis(20);
/// Frames are at least this far apart.
const FRAME: Duration = Duration::from_micros(16_667);
/// And so far where the terminal answers nothing.
const SILENT_FRAME: Duration = Duration::from_micros(33_334);

/// A link, and what is known of it.
pub struct Link {
    max_rate: Option<f64>,
    frame: Duration,
    replies: Replies,
    /// How much of its share of the rate the last frame took.
    fill: f64,
    /// When all that was sent is through, at the rate that is kept.
    free_at: Duration,
    /// The same without credit.
    drained_at: Duration,
}

/// What a frame may take on a link that is slow, or of unknown rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The link's rate in bytes per second, if it is slow.
    pub rate: Option<f64>,
    /// The most bytes that a frame should take.
    pub most_bytes: usize,
}

impl Link {
    /// A link that is to carry at most so many bytes and frames a second, to a terminal that may be asked, or not.
    pub fn new(max_rate: Option<u32>, max_frames: Option<f32>, may_ask: bool) -> Self {
        Self {
            max_rate: max_rate.map(f64::from),
            frame: max_frames.map_or(FRAME, |fps| FRAME.max(Duration::from_secs_f32(1.0 / fps))),
            replies: Replies::new(may_ask),
            fill: 0.0,
            free_at: Duration::ZERO,
            drained_at: Duration::ZERO,
        }
    }

    /// The terminal has answered DA1.
    pub fn answer(&mut self, now: Duration) {
        self.replies.answer(now);
    }

    /// The terminal has reported a mode. Whether it is the reply to a query in flight: one that comes twice, or too late,
    /// or that something else has asked for is none.
    pub fn answer_mode(&mut self, mode: u16, now: Duration) -> bool {
        self.replies.answer_mode(mode, now)
    }

    /// What was asked will not be answered: another program had the terminal in between.
    pub fn forget(&mut self) {
        self.replies.forget();
    }

    /// How far apart frames are at least.
    pub fn frame_time(&self) -> Duration {
        if self.replies.answers() { self.frame } else { self.frame.max(SILENT_FRAME) }
    }

    /// How many frames a second there are on a slow link.
    fn frames_per_second(&self) -> f64 {
        FRAMES_PER_SECOND.min(1.0 / self.frame_time().as_secs_f64())
    }

    /// The bytes of a rate for each of them.
    fn share(&self, rate: Rate) -> f64 {
        rate.bytes_per_second / self.frames_per_second()
    }

    /// When the next bytes may be sent, if nothing is heard until then.
    pub fn free_at(&self, now: Duration) -> Duration {
        // A query alone is to wait behind nothing.
        let free_at = if self.replies.is_probe_due(now) { self.drained_at } else { self.free_at };
        free_at.max(self.has_room_at(now))
    }

    /// When there is room for another frame, if nothing is heard until then.
    fn has_room_at(&self, now: Duration) -> Duration {
        match self.replies.state {
            State::Settling { .. } if self.replies.is_blind() => self.replies.blind.opens_at(true),
            State::Unasked | State::Silent | State::Settling { .. } => Duration::ZERO,
            State::Recovering { until } => {
                let opens_at = if self.replies.is_blind() {
                    self.replies.blind.opens_at(self.replies.heard.is_some())
                } else {
                    Duration::ZERO
                };
                opens_at.max(self.replies.times_out_at().unwrap_or_default()).min(until)
            }
            State::Unheard | State::Steady => self.window_opens_at(now),
        }
    }

    /// When the congestion window has room for another frame, if nothing is heard until then.
    fn window_opens_at(&self, now: Duration) -> Duration {
        let Some(times_out_at) = self.replies.times_out_at() else { return Duration::ZERO };
        if self.replies.is_late(now) {
            times_out_at
        } else if self.replies.ledger.in_flight() <= self.window() {
            Duration::ZERO
        } else if self.has_room_beside_largest() {
            self.replies.passed_at()
        } else {
            times_out_at
        }
    }

    /// What a frame that is sent now may take, if it may not take as much as it likes, on a link for screens of so many
    /// bytes.
    pub fn limit(&mut self, screen: usize, now: Duration) -> Option<Limit> {
        self.replies.look_at_clock(now);
        let blind = self.replies.is_blind().then(|| Limit { rate: None, most_bytes: self.replies.blind.most_bytes() });
        self.slow(screen).or(blind)
    }

    /// Whether no more than the rate times the round trip is in flight beside one large frame: one that was sent at a higher
    /// rate. The next one need not wait until its answer has come all the way back.
    fn has_room_beside_largest(&self) -> bool {
        let Some(rate) = self.replies.rates.best().filter(|_| self.is_slow()) else { return false };
        let largest = self.replies.ledger.live().map(|query| query.bytes as f64).fold(0.0, f64::max);
        self.replies.ledger.in_flight() - largest + self.fill * self.share(rate) <= self.bandwidth_delay_product(rate)
    }

    /// Whether the link is slow for screens of so many bytes, and what a frame may take then.
    pub fn slow(&mut self, screen: usize) -> Option<Limit> {
        let limit = self.max_rate.unwrap_or(f64::INFINITY);
        let measured = self.replies.rates.best();
        let smooth = screen as f64 * SMOOTH;
        let rate = measured.map_or(f64::INFINITY, |rate| rate.bytes_per_second).min(limit);
        // Slow as soon as a screen does not fit, and fast when two do: in between it stays what it was.
        let is_sure = limit < smooth || measured.is_some_and(|rate| rate.is_limit);
        let slow = rate < smooth && is_sure || rate < 2.0 * smooth && self.is_slow();
        self.replies.set_slow(slow);
        let most_bytes = LEAST_BYTES.max((rate / self.frames_per_second()) as usize);
        slow.then_some(Limit { rate: Some(rate), most_bytes })
    }

    /// Whether it was slow when that was last asked.
    pub fn is_slow(&self) -> bool {
        self.replies.is_slow()
    }

    /// Puts a query behind the bytes of a frame that is sent now.
    pub fn send(&mut self, frame: &mut Vec<u8>, now: Duration) {
        self.replies.look_at_clock(now);
        if self.replies.asks() {
            self.replies.ask(frame, true, now);
        }
        self.replies.spend(frame.len(), now);
        self.fill = self.replies.rates.best().map_or(0.0, |rate| frame.len() as f64 / self.share(rate));
        self.count(frame.len(), now);
    }

    /// A query without a frame, if it is time for one, or nothing: its round trip is the link's own, whatever the rate.
    pub fn probe(&mut self, now: Duration) -> Vec<u8> {
        self.replies.look_at_clock(now);
        let mut bytes = Vec::new();
        if self.replies.is_probe_due(now) {
            self.replies.probe(&mut bytes, now);
            self.count(bytes.len(), now);
        }
        bytes
    }

    /// The congestion window: how much may be in flight before another frame.
    fn window(&self) -> f64 {
        let Some(rate) = self.replies.rates.best() else { return 0.0 };
        // What a frame leaves of its share others may use.
        let spare = if self.is_slow() { ((1.0 - self.fill) * self.share(rate)).max(0.0) } else { 0.0 };
        // The first replies may be misleading, if one of them is lost or comes twice: the window at most doubles with each
        // round trip, as in TCP's slow start.
        (self.bandwidth_delay_product(rate) + spare).min(self.replies.delivered)
    }

    /// How much is on the way there and back, of what waits nowhere.
    fn bandwidth_delay_product(&self, rate: Rate) -> f64 {
        rate.bytes_per_second * self.replies.round_trip.shortest().as_secs_f64()
    }

    fn count(&mut self, bytes: usize, now: Duration) {
        let measured = self.replies.rates.best().filter(|rate| rate.is_limit || self.is_slow());
        // Without replies nobody would notice that it was thought too high.
        let share = if matches!(self.replies.state, State::Settling { .. }) { SHARE / 2.0 } else { SHARE };
        let measured = measured.map_or(f64::INFINITY, |rate| share * rate.bytes_per_second);
        let rate = measured.min(self.max_rate.unwrap_or(f64::INFINITY));
        let takes = Duration::try_from_secs_f64(bytes as f64 / rate).unwrap_or(LONGEST);
        self.free_at = self.free_at.max(now.saturating_sub(CREDIT)) + takes;
        self.drained_at = self.drained_at.max(now) + takes;
    }
}

#[cfg(test)]
mod faults;
#[cfg(test)]
mod tests;
