//! The link to the terminal: how much may be sent, and when.

use std::time::Duration;

/// How many pictures a second there are at least: what a frame may take is its share of the rate.
const FRAMES_PER_SECOND: u32 = 10;

/// A link with a highest rate, or without.
pub(super) struct Link {
    /// Bytes per second.
    max_rate: Option<u32>,
    /// When all that was sent is through.
    free_at: Duration,
}

impl Link {
    pub(super) fn new(max_rate: Option<u32>) -> Self {
        Self { max_rate, free_at: Duration::ZERO }
    }

    /// When the next bytes may be sent.
    pub(super) fn free_at(&self) -> Duration {
        self.free_at
    }

    /// The most that a frame should take.
    pub(super) fn most_bytes(&self) -> Option<usize> {
        self.max_rate.map(|rate| (rate / FRAMES_PER_SECOND) as usize)
    }

    /// So many bytes have been sent.
    pub(super) fn count(&mut self, bytes: usize, now: Duration) {
        if let Some(rate) = self.max_rate {
            self.free_at = self.free_at.max(now) + Duration::from_secs_f64(bytes as f64 / f64::from(rate));
        }
    }
}
