//! The limits on the backend's lossy frames: the quality, and the bytes that a rate allows.

use crate::encode::{Allowance, Quality};
use std::time::Duration;

/// Time by which the bytes sent may be ahead of the rate.
// This time bounds the delay of a frame. At 30 frames per second, each frame may use about a third of it.
const MAX_AHEAD: Duration = Duration::from_millis(100);

/// The quality of frames, the program's clock, and the bandwidth cap with its use so far.
pub(super) struct Limits {
    quality: Quality,
    clock: Box<dyn FnMut() -> Duration + Send + Sync>,
    bytes_per_second: Option<f64>,
    now: Duration,
    /// The time at which a link of the rate `bytes_per_second` has delivered everything sent.
    free_at: Duration,
}

impl Limits {
    pub(super) fn new(quality: Quality, clock: Box<dyn FnMut() -> Duration + Send + Sync>) -> Self {
        Self { quality, clock, bytes_per_second: None, now: Duration::ZERO, free_at: Duration::ZERO }
    }

    pub(super) fn with_max_rate(self, bytes_per_second: u32) -> Self {
        Self { bytes_per_second: Some(f64::from(bytes_per_second.max(1))), ..self }
    }

    /// Returns the limits on a frame that is sent now.
    pub(super) fn allowance(&mut self) -> Allowance {
        self.now = (self.clock)();
        let left = (self.now + MAX_AHEAD).saturating_sub(self.free_at).min(MAX_AHEAD);
        let max_bytes = self.bytes_per_second.map(|rate| (rate * left.as_secs_f64()) as usize);
        Allowance { quality: self.quality, now: self.now, max_bytes }
    }

    /// Records the number of bytes of the frame that [`allowance`](Self::allowance) was for.
    pub(super) fn record_sent(&mut self, bytes: usize) {
        if let Some(rate) = self.bytes_per_second {
            self.free_at = self.free_at.max(self.now) + Duration::from_secs_f64(bytes as f64 / rate);
        }
    }

    /// Returns the earliest time at which cells that are due at `due` may be sent within the rate.
    // A frame is not sent before half of `MAX_AHEAD` is unused again, so that it has room for more than a few cells.
    pub(super) fn due_within_rate(&self, due: Duration) -> Duration {
        due.max(self.free_at.saturating_sub(MAX_AHEAD / 2))
    }
}
