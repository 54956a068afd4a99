//! Progress reports of a render.

use crate::progress::Cancellation;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Limit on the time between two reports, as far as batches end within it: the receiver can cancel only when it is
/// called.
const MAX_REPORT_PERIOD: Duration = Duration::from_millis(10);

/// Progress after which a report is made before that time, as a part of the whole, so that a short render has reports
/// too.
const MIN_REPORT_STEP: f32 = 0.005;

/// A receiver of progress reports, and the amount of work done.
pub struct Report<'a> {
    callback: &'a (dyn Fn(f32) -> ControlFlow<()> + Sync),
    token: Cancellation,
    /// The total number of units.
    total: u64,
    /// Locked during a report, so that reports come one at a time and in order, from whichever thread.
    done: Mutex<Done>,
}

impl fmt::Debug for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Report").field("total", &self.total).field("done", &self.done).finish_non_exhaustive()
    }
}

#[derive(Debug)]
struct Done {
    units: u64,
    reported: f32,
    at: Instant,
}

impl<'a> Report<'a> {
    /// Reports to `callback` the parts of a number of units, from 0 on. The token is cancelled when it returns `Break`.
    pub(super) fn new(callback: &'a (dyn Fn(f32) -> ControlFlow<()> + Sync), token: Cancellation, total: u64) -> Self {
        Self { callback, token, total, done: Mutex::new(Done { units: 0, reported: 0.0, at: Instant::now() }) }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.token.is_cancelled()
    }

    /// Adds finished units, and reports if it is time. The end is not reported here: only the caller that gathers the
    /// results knows when all is done.
    pub(super) fn add(&self, units: u64) {
        // A receiver that panics ends the render; other threads may still get here before that.
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.units += units;
        let part = done.units as f32 / self.total as f32;
        if part < 1.0
            && (part - done.reported >= MIN_REPORT_STEP || done.at.elapsed() >= MAX_REPORT_PERIOD)
            && !self.is_cancelled()
        {
            self.call(part);
            done.reported = part;
            done.at = Instant::now();
        }
    }

    fn call(&self, part: f32) {
        if (self.callback)(part).is_break() {
            self.token.cancel();
        }
    }
}
