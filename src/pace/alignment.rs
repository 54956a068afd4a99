//! Detection of a misalignment: replies without a number are counted one query behind, because one
//! of them was lost.
//!
//! No timeout notices the loss while frames follow each other: each reply is matched to the query before its own, and
//! every round trip seems longer by the interval between two frames. The estimated rate is then too low, frames are
//! sent further apart, and the estimate falls again: from 50 KB/s to 1 KB/s within seconds. The sign of it is that
//! replies arrive exactly when those to the next query are due; on a link that has become slower they do not.

use super::ledger::InFlight;
use super::{MAX_TRANSMISSION_TIME, MIN_FRAME_BYTES};
use std::time::Duration;

/// Number of consecutive replies at the time of the next query's until one is considered lost.
///
/// This is one more than occur while a queue drains (see [`SECOND_QUERY_TOLERANCE`]).
// With three, a link that becomes ten times slower is taken for one that has lost a reply, and a key waits for 3.8 s.
// The same happens if newer queries than the second oldest are compared.
const MIN_MISALIGNED_REPLIES: u32 = 4;
/// Tolerance for a reply to the second oldest query.
///
/// A queue that drains by a seventh of the interval between two frames stays within it for three of them.
const SECOND_QUERY_TOLERANCE: Duration = Duration::from_millis(5);
/// Tolerance for a reply to the oldest query.
// Twice that for the second oldest: in doubt the count is right, because a false alarm costs a second of silence.
const OLDEST_QUERY_TOLERANCE: Duration = Duration::from_millis(10);

/// The evidence for a misalignment.
#[derive(Default)]
pub(super) struct Alignment {
    /// The last estimate in bytes per second by which a reply to the oldest query was on time.
    ///
    /// This is the estimate from before the loss.
    rate: Option<f64>,
    /// Number of consecutive replies at the time of the one to the second oldest query.
    misaligned: u32,
}

impl Alignment {
    /// Counts a reply that arrives now while these queries are in flight, oldest first.
    ///
    /// Returns whether this and the previous replies show that one is lost.
    pub(super) fn is_misaligned<'a>(
        &mut self,
        queries: impl IntoIterator<Item = &'a InFlight>,
        round_trip: Duration,
        rate: f64,
        now: Duration,
    ) -> bool {
        let is_on_time = |query: &InFlight, rate: f64, tolerance: Duration| {
            let takes = Duration::try_from_secs_f64(query.bytes as f64 / rate).unwrap_or(MAX_TRANSMISSION_TIME);
            (query.sent + takes + round_trip).abs_diff(now) <= tolerance
        };
        let mut queries = queries.into_iter();
        if let Some(oldest) = queries.next() {
            if is_on_time(oldest, rate, OLDEST_QUERY_TOLERANCE) {
                self.rate = Some(rate);
            }
            let fits = |query: &InFlight, tolerance| {
                // The rate may be known from misaligned replies alone. Small frames then show that it is not the
                // link's.
                let is_small = query.bytes <= MIN_FRAME_BYTES;
                is_on_time(query, self.rate.unwrap_or(rate), tolerance)
                    || is_small && is_on_time(query, f64::INFINITY, tolerance)
            };
            let is_misaligned = !fits(oldest, OLDEST_QUERY_TOLERANCE)
                && queries.next().is_some_and(|next| fits(next, SECOND_QUERY_TOLERANCE));
            self.misaligned = if is_misaligned { self.misaligned + 1 } else { 0 };
        }
        self.misaligned >= MIN_MISALIGNED_REPLIES
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
