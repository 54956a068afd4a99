//! Limits on sending before the rate of the link is known, while the reply that would give it is late. The terminal may
//! be near and the reply lost, or the first picture may still be on its way through a slow link: keys should be visible
//! soon in the first case, and little should be queued in the second.

use std::time::Duration;

/// Bytes that may be sent until a reply arrives: 40 ms of a link of 50 KB/s.
const MOST: usize = 2_000;
/// Least useful size of a frame in bytes.
const LEAST: usize = 120;
/// Interval after which as many bytes more may be sent to a terminal that has replied before: 3.3 KB/s. With the
/// timeout of 150 ms a key is then visible within 250 ms; with 200 ms one waited for 360 ms where DA1 is counted.
const DRIP: (usize, Duration) = (300, Duration::from_millis(90));

/// The amount sent without knowing the rate.
pub(super) struct Blind {
    left: usize,
    last: Duration,
}

impl Default for Blind {
    fn default() -> Self {
        Self { left: MOST, last: Duration::ZERO }
    }
}

impl Blind {
    /// Returns the limit on the next frame: half of what is left, so that something always is.
    pub(super) fn most_bytes(&self) -> usize {
        if self.is_spent() { DRIP.0 } else { self.left / 2 }
    }

    /// Returns the time at which the next frame may be sent, for a terminal that has replied before or has not.
    pub(super) fn opens_at(&self, has_replied: bool) -> Duration {
        match self.is_spent() {
            false => Duration::ZERO,
            true if has_replied => self.last + DRIP.1,
            true => Duration::MAX,
        }
    }

    fn is_spent(&self) -> bool {
        self.left / 2 < LEAST
    }

    /// Records that such a frame is sent now.
    pub(super) fn spend(&mut self, bytes: usize, now: Duration) {
        self.left = self.left.saturating_sub(bytes);
        self.last = now;
    }
}
