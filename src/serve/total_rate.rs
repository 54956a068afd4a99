//! The limit on the bytes per second of all viewers together.
//!
//! Pure: the time is a parameter.

use std::time::Duration;

/// The time by which a part may be sent before its turn, so that timers do not round short waits
/// up.
const EARLY: Duration = Duration::from_millis(2);

/// A queue of parts of output that are sent one after the other at the total rate.
///
/// Each viewer has at most one part in the queue, and parts are small, so all viewers that send get about the same
/// rate.
#[derive(Debug)]
pub(super) struct TotalRate {
    bytes_per_second: f64,
    free_at: Duration,
}

impl TotalRate {
    /// The most bytes of a part.
    pub(super) const MAX_PART: usize = 1024;

    /// Returns an empty queue.
    pub(super) fn new(bytes_per_second: u32) -> Self {
        Self { bytes_per_second: f64::from(bytes_per_second), free_at: Duration::ZERO }
    }

    /// Puts a part of this size at the end of the queue, and returns how long it has to wait.
    pub(super) fn reserve_wait(&mut self, bytes: usize, now: Duration) -> Duration {
        let start = self.free_at.max(now);
        self.free_at = start + Duration::from_secs_f64(bytes as f64 / self.bytes_per_second);
        start.saturating_sub(now + EARLY)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
