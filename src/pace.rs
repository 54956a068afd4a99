//! Congestion control for the link to a terminal: how much may be in flight, and when to send.
//!
//! A query ends each frame. Its reply shows that the frame has arrived, and so gives the round-trip time, the rate of
//! the link, and the bytes in flight. At most the bandwidth-delay product (the rate times the shortest round trip) and
//! one frame are in flight; more bytes would only queue on the way, ahead of the frame that shows the effect of the
//! next key. (Old samples of the rate and the round trip are dropped, as in BBR. A status report, DSR 5, would be a
//! shorter reply than the one to DA1, but st 0.9 does not send it.)
//!
//! A frame is written at once, so each frame gives the link's rate: its bytes divided by the time by which its round
//! trip exceeds the shortest. Frames are sent at 6/7 of that rate, so that queues drain and the shortest round trip can
//! be measured again.
//!
//! Replies may get lost. The ledger matches replies to queries. If a reply is missing, a timeout ends the wait for it
//! (`Recovering`): frames are sent one at a time, until a reply arrives or the terminal is considered silent
//! (`Silent`). The state determines when frames are sent and which of them end with a query:
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
//! The frames sent meanwhile end without a query; the reply to the next query shows that they have arrived.
//!
//! Pure: it reads no clock and does no I/O; the time is passed in.
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
//! assert!(link.next_send_at(ms(1)) > ms(100));
//! link.receive_attributes(ms(3));
//! assert!(link.next_send_at(ms(4)) <= ms(4));
//! ```

use std::time::Duration;

mod alignment;
mod initial_window;
mod estimates;
mod ledger;
mod reply_tracker;

use estimates::Rate;
use reply_tracker::{ReplyState, ReplyTracker};

/// A link is slow if it transmits fewer than this many screens per second.
// Below about 16 pictures a second, motion is seen as a sequence of pictures.
const SMOOTH_SCREENS_PER_SECOND: f64 = 16.0;
/// Frames per second on a slow link; a frame has at most a 36th of the bytes that the link
/// transmits in a second.
// The smaller a frame, the sooner its reply shows that the link has become slower, and the fewer bytes are in flight by
// then. After a tenfold drop of the rate, 36 frames a second with a gain of 0.86 recover in 1.73 to 1.94 s of simulated
// time; 16 a second with a gain of 0.95 took 1.9 to 2.4 s.
const SLOW_LINK_FRAME_RATE: f64 = 36.0;
/// Number of bytes that a frame may always have, however low the estimated rate is; a terminal that
/// draws slowly gets more (see [`FrameFloor`](estimates::FrameFloor)).
// With a lower limit, frames would be too small to show that the rate was estimated too low: an estimate that had
// collapsed after unsolicited replies then took seconds to recover. With a limit of 300, keys on a link of 3 KB/s were
// visible after up to 0.31 s, and up to 0.81 s if replies are late.
//
// With at least 1,000 bytes each, and fewer frames, keys are visible later still, and a frame is out of date for
// longer: at any time a terminal of 80x24 cells then shows the bench's motions with 19.2 dB instead of 22.3 at 5 KB/s,
// with 22.4 instead of 24.9 at 10 KB/s; at 200x60 with 0.2 to 0.6 dB less.
const MIN_FRAME_BYTES: usize = 200;
/// Share of the estimated rate at which bytes are sent (the pacing gain of BBR).
// A gain below 1 drains queues, so that the shortest round trip can be measured again. With this gain 85.7 % of a link
// of 50 KB/s and 200 ms are used, and the effect of a key is visible after 303 ms in the median.
const PACING_GAIN: f64 = 0.86;
/// Transmission time to assume if the computed one is not a valid duration, as for a rate of zero.
const FALLBACK_TRANSMISSION_TIME: Duration = Duration::from_secs(1);
/// Limit on the time without sending that is made up for by sending sooner afterwards.
// The loop may send a frame up to a frame time (16.7 ms) after it is due; without credit for that, each delay would
// lose link time for good. A longer credit would allow bursts that queue.
const BURST_CREDIT: Duration = Duration::from_millis(20);
/// Least time between two frames: 60 a second.
// Most terminals draw at most this often; further frames would be encoded and parsed without being seen.
const FRAME_TIME: Duration = Duration::from_micros(16_667);
/// Least time between two frames if the terminal does not reply: 30 a second.
// Without replies nothing shows whether the terminal keeps up, so it gets half as many frames.
const SILENT_FRAME_TIME: Duration = Duration::from_micros(33_334);

/// Congestion window in bytes on a slow link after a resync (a pause in the queries, because
/// replies were lost), until the round trip is known: 80 ms of 50 KB/s.
///
/// The rate estimated before the resync may be wrong. With a window computed from it, the effect of a key was visible
/// after 3.2 s instead of 1.4 s if the first reply was lost.
const RESYNC_WINDOW: f64 = 4_000.0;

/// A link to a terminal: what its replies show, and when it may be sent more bytes.
pub struct Link {
    max_rate: Option<f64>,
    min_frame_interval: Duration,
    replies: ReplyTracker,
    /// Share of its allowed bytes that the last frame used.
    utilisation: f64,
    /// Time at which everything sent has been transmitted, less the credit for an earlier pause.
    ///
    /// It is computed with the sending rate: the estimated rate times [`PACING_GAIN`], at most `max_rate`.
    free_at: Duration,
    /// Time at which everything sent has been transmitted, computed with the sending rate.
    drained_at: Duration,
}

/// The limit on the bytes of a frame, for a link that is slow or whose rate is unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The link's rate in bytes per second, if it is slow.
    pub rate: Option<f64>,
    /// Greatest number of bytes of the frame.
    pub max_bytes: usize,
}

impl Link {
    /// Returns a link with the user's limits on bytes and frames per second.
    ///
    /// `may_ask` is whether the terminal tolerates queries.
    pub fn new(max_rate: Option<u32>, max_frames: Option<f32>, may_ask: bool) -> Self {
        Self {
            max_rate: max_rate.map(f64::from),
            min_frame_interval: max_frames.map_or(FRAME_TIME, |fps| FRAME_TIME.max(Duration::from_secs_f32(1.0 / fps))),
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

    /// Records a reply to DECRQM with the number of a mode.
    ///
    /// Returns whether the reply answers a query in flight; a duplicate, a late reply or a reply to another program's
    /// query does not.
    pub fn match_mode_reply(&mut self, mode: u16, now: Duration) -> bool {
        self.replies.match_mode_reply(mode, now)
    }

    /// Forgets the queries in flight, because another program has had the terminal.
    pub fn forget_queries(&mut self) {
        self.replies.forget_queries();
    }

    /// Returns the least time between two frames.
    pub fn min_frame_interval(&self) -> Duration {
        if self.replies.is_responsive() {
            self.min_frame_interval
        } else {
            self.min_frame_interval.max(SILENT_FRAME_TIME)
        }
    }

    /// Returns the number of frames per second that are sent on a slow link.
    fn slow_link_frame_rate(&self) -> f64 {
        SLOW_LINK_FRAME_RATE.min(1.0 / self.min_frame_interval().as_secs_f64())
    }

    /// Returns the greatest number of bytes of a frame on a slow link of this rate.
    fn max_frame_bytes(&self, rate: Rate) -> f64 {
        rate.bytes_per_second / self.slow_link_frame_rate()
    }

    /// Returns the time at which the next bytes may be sent, if no reply arrives before.
    pub fn next_send_at(&self, now: Duration) -> Duration {
        // A query without a frame measures the link's round trip, so it is not sent while other bytes may be queued.
        let free_at = if self.replies.is_probe_due(now) { self.drained_at } else { self.free_at };
        free_at.max(self.replies_allow_frame_at(now))
    }

    /// Returns the time from which the state of the replies allows another frame, if no reply
    /// arrives before.
    fn replies_allow_frame_at(&self, now: Duration) -> Duration {
        match self.replies.state {
            ReplyState::Resyncing { .. } if self.replies.uses_initial_window() => {
                self.replies.initial_window.opens_at(true)
            }
            ReplyState::Unqueried | ReplyState::Silent | ReplyState::Resyncing { .. } => Duration::ZERO,
            ReplyState::Recovering { until } => {
                let opens_at = if self.replies.uses_initial_window() {
                    self.replies.initial_window.opens_at(self.replies.last_reply.is_some())
                } else {
                    Duration::ZERO
                };
                opens_at.max(self.replies.times_out_at().unwrap_or_default()).min(until)
            }
            ReplyState::Unanswered | ReplyState::Steady => self.window_opens_at(now),
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
        } else if self.has_room_without_largest() {
            self.replies.idle_at()
        } else {
            times_out_at
        }
    }

    /// Returns the limit on a frame sent now, or `None` if there is none; a whole screen has about
    /// `screen` bytes.
    pub fn limit(&mut self, screen: usize, now: Duration) -> Option<Limit> {
        self.replies.check_timeouts(now);
        let initial = self
            .replies
            .uses_initial_window()
            .then(|| Limit { rate: None, max_bytes: self.replies.initial_window.next_frame_max_bytes() });
        self.slow_limit(screen).or(initial)
    }

    /// Returns whether the bytes in flight and the next frame, without the largest frame in flight,
    /// are at most the bandwidth-delay product.
    ///
    /// A frame that was sent before the rate fell may be too large. The next frame need not wait for the reply to that
    /// one.
    fn has_room_without_largest(&self) -> bool {
        let Some(rate) = self.replies.rates.best().filter(|_| self.is_slow()) else { return false };
        let largest = self.replies.ledger.in_flight().map(|query| query.bytes as f64).fold(0.0, f64::max);
        self.replies.ledger.bytes_in_flight() - largest + self.utilisation * self.max_frame_bytes(rate)
            <= self.bandwidth_delay_product(rate)
    }

    /// Returns the limit on a frame if the link is too slow to show screens of `screen` bytes
    /// smoothly.
    ///
    /// Also records whether the link is slow, for [`is_slow`](Self::is_slow).
    pub fn slow_limit(&mut self, screen: usize) -> Option<Limit> {
        let limit = self.max_rate.unwrap_or(f64::INFINITY);
        let measured = self.replies.rates.best();
        let smooth = screen as f64 * SMOOTH_SCREENS_PER_SECOND;
        let rate = measured.map_or(f64::INFINITY, |rate| rate.bytes_per_second).min(limit);
        // Hysteresis: a link becomes slow below the rate `smooth` and fast above twice that rate, because each change
        // switches the order of cells and their quality, which costs bytes.
        let is_sure = limit < smooth || measured.is_some_and(|rate| rate.is_limit);
        let slow = rate < smooth && is_sure || rate < 2.0 * smooth && self.is_slow();
        self.replies.set_slow(slow);
        let floor = self.replies.frame_floor.guaranteed_bytes().min((limit / self.slow_link_frame_rate()) as usize);
        let max_bytes = MIN_FRAME_BYTES.max(floor).max((rate / self.slow_link_frame_rate()) as usize);
        slow.then_some(Limit { rate: Some(rate), max_bytes })
    }

    /// Returns whether the link was slow at the last check.
    pub fn is_slow(&self) -> bool {
        self.replies.is_slow()
    }

    /// Records that a frame is sent now, and appends the query that it is to end with, if any.
    pub fn send(&mut self, frame: &mut Vec<u8>, now: Duration) {
        self.replies.check_timeouts(now);
        if self.replies.frame_ends_with_query() {
            self.replies.append_query(frame, true, now);
        } else if self.replies.state == ReplyState::Steady {
            self.replies.ledger.record_unqueried(frame.len(), now);
        }
        self.replies.spend_initial_window(frame.len(), now);
        self.utilisation =
            self.replies.rates.best().map_or(0.0, |rate| frame.len() as f64 / self.max_frame_bytes(rate));
        self.advance_send_times(frame.len(), now);
    }

    /// Returns the bytes of a query without a frame if such a query is due; otherwise no bytes.
    ///
    /// The round trip of such a query contains no transmission time, however low the link's rate is.
    pub fn probe(&mut self, now: Duration) -> Vec<u8> {
        self.replies.check_timeouts(now);
        let mut bytes = Vec::new();
        if self.replies.is_probe_due(now) {
            self.replies.append_probe(&mut bytes, now);
            self.advance_send_times(bytes.len(), now);
        }
        bytes
    }

    /// Returns the congestion window: another frame is sent while at most this many bytes are in
    /// flight.
    fn congestion_window(&self) -> f64 {
        let Some(rate) = self.replies.rates.best() else { return 0.0 };
        // Bytes that the last frame was allowed but did not use are added to the window: without them, a fifth of the
        // link was idle.
        let spare = if self.is_slow() { ((1.0 - self.utilisation) * self.max_frame_bytes(rate)).max(0.0) } else { 0.0 };
        // The first replies may mislead if one of them is lost or duplicated: the window at most doubles with each
        // round trip, as in TCP's slow start.
        let is_known = !self.is_slow() || self.replies.round_trip.is_known();
        let window = if is_known { self.bandwidth_delay_product(rate) + spare } else { RESYNC_WINDOW };
        window.min(self.replies.delivered)
    }

    /// Returns the bytes that a link of this rate has in flight when it is fully used and nothing
    /// queues.
    fn bandwidth_delay_product(&self, rate: Rate) -> f64 {
        rate.bytes_per_second * self.replies.round_trip.shortest().as_secs_f64()
    }

    /// Advances `free_at` and `drained_at` by the time that bytes sent now take at the sending
    /// rate.
    fn advance_send_times(&mut self, bytes: usize, now: Duration) {
        let measured = self.replies.rates.best().filter(|rate| rate.is_limit || self.is_slow());
        // During a resync no reply corrects an estimate that is too high, so only half of the usual share is sent.
        let share =
            if matches!(self.replies.state, ReplyState::Resyncing { .. }) { PACING_GAIN / 2.0 } else { PACING_GAIN };
        let measured = measured.map_or(f64::INFINITY, |rate| share * rate.bytes_per_second);
        let rate = measured.min(self.max_rate.unwrap_or(f64::INFINITY));
        let takes = Duration::try_from_secs_f64(bytes as f64 / rate).unwrap_or(FALLBACK_TRANSMISSION_TIME);
        self.free_at = self.free_at.max(now.saturating_sub(BURST_CREDIT)) + takes;
        self.drained_at = self.drained_at.max(now) + takes;
    }
}

#[cfg(all(test, unit_tests))]
mod faults;
#[cfg(all(test, unit_tests))]
mod tests;
