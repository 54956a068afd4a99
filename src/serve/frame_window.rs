//! The number of sessions that draw frames at the same time.
//!
//! Pure: the time is a parameter.

use super::run_queue::SessionId;
use std::collections::VecDeque;
use std::collections::hash_map::{Entry, HashMap};
use std::time::Duration;

/// The time for which a session counts after a frame.
///
/// All sessions whose views move draw in this time, even on a server that is far too busy. With 0.2 s, sessions that
/// drew five frames a second did not count, and did not get the coarser frames that would have made them faster.
const WINDOW: Duration = Duration::from_secs(1);

/// The frames of the last [`WINDOW`], by session.
#[derive(Debug, Default)]
pub(super) struct FrameWindow {
    frames: VecDeque<(Duration, SessionId)>,
    /// The number of frames of each session, which is never 0.
    counts: HashMap<SessionId, u32>,
}

impl FrameWindow {
    /// Records a frame that a session has drawn.
    pub(super) fn record(&mut self, id: SessionId, now: Duration) {
        self.frames.push_back((now, id));
        *self.counts.entry(id).or_default() += 1;
    }

    /// Returns the number of sessions that have drawn in the last [`WINDOW`].
    pub(super) fn session_count(&mut self, now: Duration) -> usize {
        while let Some(&(_, id)) = self.frames.front().filter(|(at, _)| *at + WINDOW < now) {
            self.frames.pop_front();
            if let Entry::Occupied(mut count) = self.counts.entry(id) {
                *count.get_mut() -= 1;
                if *count.get() == 0 {
                    count.remove();
                }
            }
        }
        self.counts.len()
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
