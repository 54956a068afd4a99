//! How near to what was drawn a frame is, and what it may take.

use crate::encode::{Allowance, Quality};
use std::time::Duration;

/// So much of the rate may be ahead of its time: a frame of a program that draws seldom is not held back for longer,
/// and one that draws 30 times a second has a third of it for each frame.
const MAX_AHEAD: Duration = Duration::from_millis(100);

/// A quality, the time, and what is left of a rate.
pub(super) struct Limits {
    quality: Quality,
    clock: Box<dyn FnMut() -> Duration + Send + Sync>,
    bytes_per_second: Option<f64>,
    now: Duration,
    /// When everything that was sent is through at that rate.
    free_at: Duration,
}

impl Limits {
    pub(super) fn new(quality: Quality, clock: Box<dyn FnMut() -> Duration + Send + Sync>) -> Self {
        Self { quality, clock, bytes_per_second: None, now: Duration::ZERO, free_at: Duration::ZERO }
    }

    pub(super) fn with_max_rate(self, bytes_per_second: u32) -> Self {
        Self { bytes_per_second: Some(f64::from(bytes_per_second.max(1))), ..self }
    }

    /// What a frame that is sent now may differ in and take.
    pub(super) fn allowance(&mut self) -> Allowance {
        self.now = (self.clock)();
        let left = (self.now + MAX_AHEAD).saturating_sub(self.free_at).min(MAX_AHEAD);
        let max_bytes = self.bytes_per_second.map(|rate| (rate * left.as_secs_f64()) as usize);
        Allowance { quality: self.quality, now: self.now, max_bytes }
    }

    /// That frame has taken so many bytes.
    pub(super) fn record_sent(&mut self, bytes: usize) {
        if let Some(rate) = self.bytes_per_second {
            self.free_at = self.free_at.max(self.now) + Duration::from_secs_f64(bytes as f64 / rate);
        }
    }

    /// When what the encoder has due then may be sent: once half of what may be ahead is free again.
    pub(super) fn due(&self, due: Duration) -> Duration {
        due.max(self.free_at.saturating_sub(MAX_AHEAD / 2))
    }
}
