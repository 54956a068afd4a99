//! The limit on the bytes per second of all viewers together.
//!
//! Pure: it is told the time.

use std::time::Duration;

/// The greatest time by which bytes may be sent early, so that short waits are not rounded up.
const EARLY: Duration = Duration::from_millis(2);

/// A queue of parts to send, each of which takes its time at the total rate.
///
/// Each viewer has at most one part in it, and parts are small, so all viewers that send have about the same rate.
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
    pub(super) fn enqueue(&mut self, bytes: usize, now: Duration) -> Duration {
        let start = self.free_at.max(now);
        self.free_at = start + Duration::from_secs_f64(bytes as f64 / self.bytes_per_second);
        start.saturating_sub(now + EARLY)
    }
}

#[cfg(all(test, unit_tests))]
mod tests {
    use super::*;

    #[test]
    fn parts_follow_each_other_at_the_rate() {
        let mut rate = TotalRate::new(100_000);
        let now = Duration::from_secs(5);
        assert_eq!(rate.enqueue(1000, now), Duration::ZERO);
        // Of the second's part the time of the first one is 10 ms.
        assert_eq!(rate.enqueue(500, now), Duration::from_millis(8));
        assert_eq!(rate.enqueue(1000, now), Duration::from_millis(13));
        // A pause is not made up for.
        assert_eq!(rate.enqueue(1000, 2 * now), Duration::ZERO);
        assert_eq!(rate.enqueue(1000, 2 * now), Duration::from_millis(8));
    }
}
