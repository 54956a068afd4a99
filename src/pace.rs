//! Congestion control for the link to a terminal: how much may be in flight, and when to send.
//!
//! A query ends each frame. Its reply shows that the frame has arrived, and so gives the round-trip time, the rate of
//! the link, and the bytes in flight. At most the bandwidth-delay product (the rate times the shortest round trip) and
//! one frame are in flight; more would only queue somewhere in between, ahead of the frame that shows the next key.
//! (Both estimates age, as in BBR. The terminal's status report, DSR 5, would be a shorter reply, but st 0.9 does not
//! send it.)
//!
//! A frame is written at once, so each frame gives the link's rate: its bytes over the time by which its round trip
//! exceeds the shortest. Frames are sent at 6/7 of that rate, so that queues drain and the shortest round trip is
//! measured again.
//!
//! Replies get lost. The ledger matches replies to queries. If a reply is missing, a timeout ends the wait
//! (`Recovering`): frames are sent one at a time, until a reply arrives or the terminal is considered silent
//! (`Silent`). The state decides:
//!
//! | State      | next frame                          | query             | left by                               |
//! |------------|-------------------------------------|-------------------|---------------------------------------|
//! | Unqueried  | at the rate                         | none              | nothing                               |
//! | Unanswered | on a reply or the timeout           | each frame, alone | a reply, the timeout                  |
//! | Steady     | when the congestion window has room | each frame, alone | the timeout, a reply to another query |
//! | Recovering | on a reply or the timeout; small    | each frame        | a reply, the silence timeout          |
//! | Resyncing  | at the rate                         | none              | no reply for a second                 |
//! | Silent     | at the rate, 30 a second            | one at a time     | a reply                               |
//!
//! After a resync on a slow link, `Steady` has at most one query in flight until enough replies have arrived in order.
//! The frames in between end without one, and the next reply shows that they have arrived.
//!
//! Pure: the time is passed in, and there is no I/O.
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
//! link.receive_attributes(ms(3));
//! assert!(link.free_at(ms(4)) <= ms(4));
//! ```

use std::time::Duration;

mod alignment;
mod initial_window;
mod estimates;
mod ledger;
mod reply_tracker;

use estimates::Rate;
use reply_tracker::{ReplyTracker, State};

/// A link is slow if it transmits fewer than this many screens per second.
// Below about 16 pictures a second, motion is seen as a sequence of pictures.
const SMOOTH_SCREENS_PER_SECOND: f64 = 16.0;
/// Frames per second on a slow link, each of which may take this part of the rate.
// The smaller a frame, the sooner its reply shows that the link has become slower, and the less is in flight until
// then. After a tenfold drop of the rate, 36 frames a second with a gain of 0.86 recover in 1.73 to 1.94 s of simulated
// time; 16 a second with a gain of 0.95 took 1.9 to 2.4 s.
const SLOW_LINK_FRAME_RATE: f64 = 36.0;
/// Number of bytes that a frame may always take.
// Smaller frames cannot show that the rate was estimated too low: an estimate that had collapsed after unsolicited
// replies took seconds to recover.
const MIN_FRAME_BYTES: usize = 200;
/// Share of the estimated rate at which bytes are sent (the pacing gain of BBR).
// Below 1, so that queues drain and the shortest round trip can be measured again. Through a link of 50 KB/s and 200 ms
// 85.7 % are used with it, and the median key is visible after 303 ms.
const PACING_GAIN: f64 = 0.86;
/// Substitute for a transmission time that cannot be computed.
const MAX_TRANSMISSION_TIME: Duration = Duration::from_secs(1);
/// Pause whose unused share of the rate may be sent later.
// Frames are due up to a frame time (16.7 ms) late, because the loop waits for events; without credit, each delay would
// lose link time for good. A longer credit would allow bursts that queue.
const BURST_CREDIT: Duration = Duration::from_millis(20);
/// Least time between two frames: 60 a second.
// Most terminals draw at most this often; more frames would be encoded and parsed without being seen.
const FRAME_TIME: Duration = Duration::from_micros(16_667);
/// Least time between two frames if the terminal does not reply: 30 a second.
// Without replies nothing shows that it cannot keep up, so it gets half the rate.
const SILENT_FRAME_TIME: Duration = Duration::from_micros(33_334);

/// Congestion window in bytes on a slow link after a resync, until the round trip is known.
///
/// 80 ms of 50 KB/s. The rate may be wrong by then. With the window of that rate a lost first reply cost a key
/// 3.2 s instead of 1.4 s.
const RESYNC_WINDOW: f64 = 4_000.0;

/// A link to a terminal, with its estimates and the times at which it may be sent more.
pub struct Link {
    max_rate: Option<f64>,
    frame: Duration,
    replies: ReplyTracker,
    /// Share of its limit that the last frame used.
    utilisation: f64,
    /// Time at which everything sent has been transmitted at the used rate.
    free_at: Duration,
    /// That time without credit for earlier pauses.
    drained_at: Duration,
}

/// Limits on a frame on a link that is slow or of unknown rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The link's rate in bytes per second, if it is slow.
    pub rate: Option<f64>,
    /// Limit on the bytes of a frame.
    pub max_bytes: usize,
}

impl Link {
    /// Returns a link with limits on bytes and frames per second, to a terminal that tolerates
    /// queries or does not.
    pub fn new(max_rate: Option<u32>, max_frames: Option<f32>, may_ask: bool) -> Self {
        Self {
            max_rate: max_rate.map(f64::from),
            frame: max_frames.map_or(FRAME_TIME, |fps| FRAME_TIME.max(Duration::from_secs_f32(1.0 / fps))),
            replies: ReplyTracker::new(may_ask),
            utilisation: 0.0,
            free_at: Duration::ZERO,
            drained_at: Duration::ZERO,
        }
    }

    /// Records a reply to DA1.
    pub fn receive_attributes(&mut self, now: Duration) {
        self.replies.receive_attributes(now);
    }

    /// Records a report of a mode.
    ///
    /// Returns whether it is the reply to a query in flight: a duplicate, a late one, or one to another query is not.
    pub fn receive_mode(&mut self, mode: u16, now: Duration) -> bool {
        self.replies.receive_mode(mode, now)
    }

    /// Forgets the queries in flight, because another program has had the terminal.
    pub fn forget_queries(&mut self) {
        self.replies.forget_queries();
    }

    /// Returns the least time between two frames.
    pub fn frame_time(&self) -> Duration {
        if self.replies.is_responsive() { self.frame } else { self.frame.max(SILENT_FRAME_TIME) }
    }

    /// Returns the number of frames per second on a slow link.
    fn frames_per_second(&self) -> f64 {
        SLOW_LINK_FRAME_RATE.min(1.0 / self.frame_time().as_secs_f64())
    }

    /// Returns each such frame's share of a rate, in bytes.
    fn frame_bytes(&self, rate: Rate) -> f64 {
        rate.bytes_per_second / self.frames_per_second()
    }

    /// Returns the time at which the next bytes may be sent, if no reply arrives before.
    pub fn free_at(&self, now: Duration) -> Duration {
        // A query alone measures the link's round trip, so it must not wait in a queue behind other bytes.
        let free_at = if self.replies.is_probe_due(now) { self.drained_at } else { self.free_at };
        free_at.max(self.has_room_at(now))
    }

    /// Returns the time at which another frame may be sent, if no reply arrives before.
    fn has_room_at(&self, now: Duration) -> Duration {
        match self.replies.state {
            State::Resyncing { .. } if self.replies.lacks_rate() => self.replies.initial_window.opens_at(true),
            State::Unqueried | State::Silent | State::Resyncing { .. } => Duration::ZERO,
            State::Recovering { until } => {
                let opens_at = if self.replies.lacks_rate() {
                    self.replies.initial_window.opens_at(self.replies.last_reply.is_some())
                } else {
                    Duration::ZERO
                };
                opens_at.max(self.replies.times_out_at().unwrap_or_default()).min(until)
            }
            State::Unanswered | State::Steady => self.window_opens_at(now),
        }
    }

    /// Returns the time at which the congestion window has room for another frame, if no reply
    /// arrives before.
    fn window_opens_at(&self, now: Duration) -> Duration {
        let Some(times_out_at) = self.replies.times_out_at() else { return Duration::ZERO };
        if self.replies.is_late(now) {
            times_out_at
        } else if self.replies.ledger.bytes_in_flight() <= self.congestion_window() {
            Duration::ZERO
        } else if self.has_room_beside_largest() {
            self.replies.idle_at()
        } else {
            times_out_at
        }
    }

    /// Returns the limits for a frame sent now, on a link for screens of `screen` bytes.
    ///
    /// `None` without limits.
    pub fn limit(&mut self, screen: usize, now: Duration) -> Option<Limit> {
        self.replies.check_timeouts(now);
        let initial =
            self.replies.lacks_rate().then(|| Limit { rate: None, max_bytes: self.replies.initial_window.max_bytes() });
        self.slow_limit(screen).or(initial)
    }

    /// Returns whether at most the bandwidth-delay product is in flight beside one large frame,
    /// which was sent at a higher rate. The next frame then need not wait for the whole round trip of its reply.
    fn has_room_beside_largest(&self) -> bool {
        let Some(rate) = self.replies.rates.best().filter(|_| self.is_slow()) else { return false };
        let largest = self.replies.ledger.in_flight().map(|query| query.bytes as f64).fold(0.0, f64::max);
        self.replies.ledger.bytes_in_flight() - largest + self.utilisation * self.frame_bytes(rate)
            <= self.bandwidth_delay_product(rate)
    }

    /// Returns the rate of a link that is slow for screens of this many bytes, and a frame's limit.
    pub fn slow_limit(&mut self, screen: usize) -> Option<Limit> {
        let limit = self.max_rate.unwrap_or(f64::INFINITY);
        let measured = self.replies.rates.best();
        let smooth = screen as f64 * SMOOTH_SCREENS_PER_SECOND;
        let rate = measured.map_or(f64::INFINITY, |rate| rate.bytes_per_second).min(limit);
        // Hysteresis: slow once a screen does not fit, fast once two do, unchanged in between. A change of the order of
        // cells and of their quality costs bytes each time.
        let is_sure = limit < smooth || measured.is_some_and(|rate| rate.is_limit);
        let slow = rate < smooth && is_sure || rate < 2.0 * smooth && self.is_slow();
        self.replies.set_slow(slow);
        let max_bytes = MIN_FRAME_BYTES.max((rate / self.frames_per_second()) as usize);
        slow.then_some(Limit { rate: Some(rate), max_bytes })
    }

    /// Returns whether the link was slow at the last check.
    pub fn is_slow(&self) -> bool {
        self.replies.is_slow()
    }

    /// Appends a query to a frame that is sent now.
    pub fn send(&mut self, frame: &mut Vec<u8>, now: Duration) {
        self.replies.check_timeouts(now);
        if self.replies.queries_frames() {
            self.replies.append_query(frame, true, now);
        } else if self.replies.state == State::Steady {
            self.replies.ledger.record_unqueried(frame.len(), now);
        }
        self.replies.spend(frame.len(), now);
        self.utilisation = self.replies.rates.best().map_or(0.0, |rate| frame.len() as f64 / self.frame_bytes(rate));
        self.record_sent(frame.len(), now);
    }

    /// Returns a query without a frame if one is due; otherwise no bytes.
    ///
    /// Its round trip is the link's own, whatever the rate.
    pub fn probe(&mut self, now: Duration) -> Vec<u8> {
        self.replies.check_timeouts(now);
        let mut bytes = Vec::new();
        if self.replies.is_probe_due(now) {
            self.replies.probe(&mut bytes, now);
            self.record_sent(bytes.len(), now);
        }
        bytes
    }

    /// Returns the congestion window: the bytes in flight up to which another frame is sent.
    fn congestion_window(&self) -> f64 {
        let Some(rate) = self.replies.rates.best() else { return 0.0 };
        // Other frames may use what a frame leaves of its share: without this, a fifth of the link was idle.
        let spare = if self.is_slow() { ((1.0 - self.utilisation) * self.frame_bytes(rate)).max(0.0) } else { 0.0 };
        // The first replies may mislead if one of them is lost or duplicated: the window at most doubles with each
        // round trip, as in TCP's slow start.
        let is_known = !self.is_slow() || self.replies.round_trip.is_known();
        let window = if is_known { self.bandwidth_delay_product(rate) + spare } else { RESYNC_WINDOW };
        window.min(self.replies.delivered)
    }

    /// Returns the bytes on their way that do not wait in a queue.
    fn bandwidth_delay_product(&self, rate: Rate) -> f64 {
        rate.bytes_per_second * self.replies.round_trip.shortest().as_secs_f64()
    }

    fn record_sent(&mut self, bytes: usize, now: Duration) {
        let measured = self.replies.rates.best().filter(|rate| rate.is_limit || self.is_slow());
        // Without replies, an estimate that is too low would never be corrected.
        let share = if matches!(self.replies.state, State::Resyncing { .. }) { PACING_GAIN / 2.0 } else { PACING_GAIN };
        let measured = measured.map_or(f64::INFINITY, |rate| share * rate.bytes_per_second);
        let rate = measured.min(self.max_rate.unwrap_or(f64::INFINITY));
        let takes = Duration::try_from_secs_f64(bytes as f64 / rate).unwrap_or(MAX_TRANSMISSION_TIME);
        self.free_at = self.free_at.max(now.saturating_sub(BURST_CREDIT)) + takes;
        self.drained_at = self.drained_at.max(now) + takes;
    }
}

#[cfg(all(test, unit_tests))]
mod faults;
#[cfg(all(test, unit_tests))]
mod tests;
