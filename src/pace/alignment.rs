//! Detection of a misalignment: each reply without a number is matched to the query before its own,
//! because the reply to that query was lost.
//!
//! No timeout notices the loss while frames follow each other, but every round trip seems longer by the interval
//! between two frames. The estimated rate is then too low, frames are sent further apart, and the estimate falls again:
//! from 50 KB/s to 1 KB/s within seconds. A misalignment shows in replies that arrive exactly when those to the next
//! query are due; on a link that has merely become slower they do not.

use super::ledger::InFlight;
use super::{FALLBACK_TRANSMISSION_TIME, MIN_FRAME_BYTES};
use std::time::Duration;

/// Number of consecutive misaligned replies after which a reply counts as lost.
///
/// A reply is misaligned if it arrives when the reply to the second oldest query is due. The number is one more than
/// occur while a queue drains (see [`SECOND_QUERY_TOLERANCE`]).
// With three replies, a link that becomes ten times slower is taken for one that has lost a reply, and a key waits for
// 3.8 s. The same happens if a reply is also compared with the due times of queries newer than the second oldest.
const MIN_MISALIGNED_REPLIES: u32 = 4;
/// Greatest difference from the due time at which a reply may belong to the second oldest query.
///
/// While a queue drains by a seventh of the frame interval per frame, at most three consecutive replies are within this
/// tolerance.
const SECOND_QUERY_TOLERANCE: Duration = Duration::from_millis(5);
/// Greatest difference from the due time at which a reply may belong to the oldest query.
// Twice the tolerance for the second oldest query, so that a reply in doubt counts as the reply to the oldest: a false
// alarm costs a second without queries.
const OLDEST_QUERY_TOLERANCE: Duration = Duration::from_millis(10);

/// The evidence of a misalignment so far.
#[derive(Default)]
pub(super) struct Alignment {
    /// The last estimate of the rate in bytes per second that correctly predicted the arrival of a
    /// reply to the oldest query.
    ///
    /// After the loss of a reply this is an estimate from before the loss.
    rate: Option<f64>,
    /// Number of consecutive replies that arrived when the reply to the second oldest query was
    /// due.
    misaligned: u32,
}

impl Alignment {
    /// Compares the time of a reply with the times when replies to `queries`, the oldest first, are
    /// due.
    ///
    /// Returns whether this and the previous replies show that a reply was lost.
    pub(super) fn is_misaligned<'a>(
        &mut self,
        queries: impl IntoIterator<Item = &'a InFlight>,
        round_trip: Duration,
        rate: f64,
        now: Duration,
    ) -> bool {
        let is_on_time = |query: &InFlight, rate: f64, tolerance: Duration| {
            let takes = Duration::try_from_secs_f64(query.bytes as f64 / rate).unwrap_or(FALLBACK_TRANSMISSION_TIME);
            (query.sent + takes + round_trip).abs_diff(now) <= tolerance
        };
        let mut queries = queries.into_iter();
        if let Some(oldest) = queries.next() {
            if is_on_time(oldest, rate, OLDEST_QUERY_TOLERANCE) {
                self.rate = Some(rate);
            }
            let fits = |query: &InFlight, tolerance| {
                // If all replies so far were matched to the wrong query, the estimated rate is wrong. Small frames show
                // the misalignment nevertheless, because their transmission takes hardly any time at any rate.
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
