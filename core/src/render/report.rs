//! Progress reports of a render.

use crate::progress::Cancellation;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The time after a render's progress report at which the next is due, however small the progress.
// A render of 1920x1080 with best samples made 198 reports, at most 27 ms apart.
const REPORT_PERIOD: Duration = Duration::from_millis(10);

/// The progress since a report, as a fraction of the work, at which the next report is due.
// Half a percent gives even a render of a few milliseconds enough reports to draw a bar.
const REPORT_STEP: f32 = 0.005;

/// The progress of a render, and the callback that receives it.
pub struct TileReport<'a> {
    callback: &'a (dyn Fn(f32) -> ControlFlow<()> + Sync),
    token: Cancellation,
    /// The number of progress units of the whole render.
    total: u64,
    /// The progress units finished so far.
    // The mutex is locked during a report, so that reports from several threads come one at a time and in order.
    done: Mutex<Done>,
}

impl fmt::Debug for TileReport<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TileReport").field("total", &self.total).field("done", &self.done).finish_non_exhaustive()
    }
}

#[derive(Debug)]
struct Done {
    units: u64,
    reported: f32,
    at: Instant,
}

impl<'a> TileReport<'a> {
    /// Returns the progress of a render that has finished none of `total` units.
    ///
    /// `callback` gets the fraction done. If it returns `Break`, `token` is cancelled.
    pub(super) fn new(callback: &'a (dyn Fn(f32) -> ControlFlow<()> + Sync), token: Cancellation, total: u64) -> Self {
        Self { callback, token, total, done: Mutex::new(Done { units: 0, reported: 0.0, at: Instant::now() }) }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.token.is_cancelled()
    }

    /// Adds finished units, and calls the callback if a report is due.
    ///
    /// The end is not reported here, as only the caller that collects the results knows when all work is done.
    pub(super) fn add_finished(&self, units: u64) {
        // If the callback panics, the render ends. Until then, other threads may still lock the mutex, and must not
        // panic because it is poisoned.
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.units += units;
        let part = done.units as f32 / self.total as f32;
        if part < 1.0
            && (part - done.reported >= REPORT_STEP || done.at.elapsed() >= REPORT_PERIOD)
            && !self.is_cancelled()
        {
            self.call_callback(part);
            done.reported = part;
            done.at = Instant::now();
        }
    }

    fn call_callback(&self, done_share: f32) {
        if (self.callback)(done_share).is_break() {
            self.token.cancel();
        }
    }
}
