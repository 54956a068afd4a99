//! Limits on sending before the rate of the link is known, while the reply that would give it is
//! late. The terminal may be near and the reply lost, or the first picture may still be on its way through a slow link:
//! keys should be visible soon in the first case, and little should be queued in the second.

use std::time::Duration;

/// Bytes that may be sent until a reply arrives.
// 40 ms of a link of 50 KB/s. One of 2 KB/s, the slowest considered, drains them in a second.
const INITIAL_BYTES: usize = 2_000;
/// Least useful size of a frame in bytes.
// Smaller frames change too few cells to show the effect of a key.
const MIN_USEFUL_BYTES: usize = 120;
/// Bytes that each [`REFILL_INTERVAL`] adds once the window is spent, for a terminal that has
/// replied before: 3.3 KB/s.
const REFILL_BYTES: usize = 300;
/// Interval between refills.
///
/// With the timeout of 150 ms a key is then visible within 250 ms; with refills every 200 ms one waited for 360 ms
/// where DA1 is counted.
const REFILL_INTERVAL: Duration = Duration::from_millis(90);

/// The budget of bytes sent before the rate is known.
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
    /// Returns the limit on the next frame in bytes.
    ///
    /// This is half of the rest, so that a later key has some left too.
    pub(super) fn max_bytes(&self) -> usize {
        if self.is_spent() { REFILL_BYTES } else { self.left / 2 }
    }

    /// Returns the time at which the next frame may be sent, for a terminal that has replied before
    /// or has not.
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

    /// Records that such a frame is sent now.
    pub(super) fn spend(&mut self, bytes: usize, now: Duration) {
        self.left = self.left.saturating_sub(bytes);
        self.last_sent = now;
    }
}
