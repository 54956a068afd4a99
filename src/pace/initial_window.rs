//! Limits on the bytes sent while the rate of the link is unknown, because the first reply is late.
//!
//! Either the terminal is near and the reply was lost, and the effect of keys should be visible soon; or the first
//! picture is still on its way through a slow link, and little should be queued behind it.

use std::time::Duration;

/// Greatest number of bytes in all frames that are sent until a reply arrives.
// A link of 50 KB/s transmits these bytes in 40 ms, and one of 2 KB/s, the slowest considered, in a second.
const INITIAL_BYTES: usize = 2_000;
/// Least useful size of a frame in bytes.
// Smaller frames change too few cells to show the effect of a key.
const MIN_USEFUL_BYTES: usize = 120;
/// Bytes that may be sent every [`REFILL_INTERVAL`] once [`INITIAL_BYTES`] are spent, to a terminal
/// that has replied before. This is 3.3 KB/s.
const REFILL_BYTES: usize = 300;
/// Time between two frames of [`REFILL_BYTES`].
///
/// With this interval and a timeout of 150 ms, the effect of a key is visible within 250 ms. With an interval of 200 ms
/// it took 360 ms if the terminal replies to DA1 only.
const REFILL_INTERVAL: Duration = Duration::from_millis(90);

/// The budget of bytes that may be sent before the rate is known.
pub(super) struct InitialWindow {
    left: usize,
    last_sent: Duration,
}

impl Default for InitialWindow {
    fn default() -> Self {
        Self { left: INITIAL_BYTES, last_sent: Duration::ZERO }
    }
}

impl InitialWindow {
    /// Returns the greatest number of bytes of the next frame.
    ///
    /// This is half of the budget that is left, so that the frames of later keys get some of it too.
    pub(super) fn next_frame_max_bytes(&self) -> usize {
        if self.is_spent() { REFILL_BYTES } else { self.left / 2 }
    }

    /// Returns the time at which the next frame may be sent.
    ///
    /// Once the budget is spent, only a terminal that `has_replied` before gets further frames, at intervals.
    pub(super) fn opens_at(&self, has_replied: bool) -> Duration {
        match self.is_spent() {
            false => Duration::ZERO,
            true if has_replied => self.last_sent + REFILL_INTERVAL,
            true => Duration::MAX,
        }
    }

    fn is_spent(&self) -> bool {
        self.left / 2 < MIN_USEFUL_BYTES
    }

    /// Records that a frame of this many bytes is sent now.
    pub(super) fn spend(&mut self, bytes: usize, now: Duration) {
        self.left = self.left.saturating_sub(bytes);
        self.last_sent = now;
    }
}
