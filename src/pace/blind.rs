//! What may be sent before the rate of the link is known, when the reply that would tell it is late: the terminal may be
//! near and the reply lost, or the first picture may still be on its way through a slow link. A key is to be seen soon in the
//! first case, and little to be queued in the second.

use std::time::Duration;

/// So many bytes may be sent until a reply comes: 40 ms of a link of 50 KB/s.
const MOST: usize = 2_000;
/// Of fewer bytes a frame shows nothing.
const LEAST: usize = 120;
/// Where the terminal has replied before, so many more follow each time this has passed: 3.3 KB/s. With the timeout of
/// 150 ms a key is then seen within 250 ms; with 200 ms one waited for 360 ms where DA1 is counted.
const DRIP: (usize, Duration) = (300, Duration::from_millis(90));

/// How much has been sent so.
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
    /// The most bytes that the next frame may take: half of what is left, so that it never is all.
    pub(super) fn most_bytes(&self) -> usize {
        if self.is_spent() { DRIP.0 } else { self.left / 2 }
    }

    /// When the next frame may be sent to a terminal that has replied before, or never has.
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

    /// Such a frame is sent now.
    pub(super) fn spend(&mut self, bytes: usize, now: Duration) {
        self.left = self.left.saturating_sub(bytes);
        self.last = now;
    }
}
