//! Progress reports of a render.

use crate::progress::Cancellation;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The longest time between two reports, as far as batches end in it: by its answer to a report the receiver can cancel, and
/// is to be asked often enough.
const PERIOD: Duration = Duration::from_millis(10);

/// How much more has to be done for a report before that time, as a part of all: so a short render has its reports, too.
const STEP: f32 = 0.005;

/// A receiver of reports, and how much of the work is done.
pub struct Report<'a> {
    hear: &'a (dyn Fn(f32) -> ControlFlow<()> + Sync),
    token: Cancellation,
    /// All units of the work.
    total: u64,
    /// Held during a report, so that reports come one at a time and in order, whichever threads they come from.
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
    told: f32,
    at: Instant,
}

impl<'a> Report<'a> {
    /// Reports to `hear`, from 0 on, parts of that number of units. The token is cancelled when it answers `Break`.
    pub(super) fn new(hear: &'a (dyn Fn(f32) -> ControlFlow<()> + Sync), token: Cancellation, total: u64) -> Self {
        Self { hear, token, total, done: Mutex::new(Done { units: 0, told: 0.0, at: Instant::now() }) }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.token.is_cancelled()
    }

    /// Notes that more units are done, and tells of it when it is time to. The whole is not told of here: only who gathers
    /// the results knows when all is done.
    pub(super) fn add(&self, units: u64) {
        // A receiver that panics ends the render; other threads may come here once more before that.
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.units += units;
        let part = done.units as f32 / self.total as f32;
        if part < 1.0 && (part - done.told >= STEP || done.at.elapsed() >= PERIOD) && !self.is_cancelled() {
            self.tell(part);
            done.told = part;
            done.at = Instant::now();
        }
    }

    fn tell(&self, part: f32) {
        if (self.hear)(part).is_break() {
            self.token.cancel();
        }
    }
}
