//! Limits on waiting that are not used up while the machine stands still.

use std::time::{Duration, Instant};

/// The end of a wait, counted in time in which the harness ran.
///
/// A virtual machine may stand still for ten seconds (while it is saved, or its host is busy); afterwards the clock has
/// gone on, but the child has had no time to do what is waited for.
pub(crate) struct Deadline {
    left: Duration,
    looked: Instant,
}

/// The most time between two looks that counts.
const LONGEST_STEP: Duration = Duration::from_millis(100);

impl Deadline {
    /// Returns the end of a wait that begins now.
    pub(crate) fn after(limit: Duration) -> Self {
        Self { left: limit, looked: Instant::now() }
    }

    /// Returns whether the limit is used up. To be asked at each look.
    pub(crate) fn has_passed(&mut self) -> bool {
        let now = Instant::now();
        self.left = self.left.saturating_sub((now - self.looked).min(LONGEST_STEP));
        self.looked = now;
        self.left.is_zero()
    }

    /// The time of the next look, if nothing happens before.
    pub(crate) fn next_look(&self) -> Instant {
        self.looked + self.left.min(LONGEST_STEP)
    }
}
