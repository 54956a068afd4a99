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

#[cfg(test)]
mod tests {
    use super::super::ledger::{Ledger, Query};
    use super::super::tests::ms;
    use super::*;

    /// Frames of 1,000 bytes are sent every 25 ms through 50 KB/s and 200 ms, and their replies
    /// arrive this much later than through an empty link. Returns the number of the reply that shows a loss, if any.
    fn shows_loss(frames: usize, later: impl Fn(usize) -> u64) -> Option<usize> {
        let mut alignment = Alignment::default();
        (0..frames).find(|&number| {
            let mut ledger = Ledger::default();
            let sent = (number..number + 8).map(|number| ms(25 * number as u64));
            sent.for_each(|sent| ledger.record(Query::Counted, 1_000, sent));
            let now = ms(25 * number as u64 + 220 + later(number));
            alignment.is_misaligned(ledger.counted(), ms(200), 50_000.0, now)
        })
    }

    #[test]
    fn replies_that_come_when_the_next_ones_should_show_a_loss() {
        assert_eq!(shows_loss(100, |_| 0), None);
        assert_eq!(shows_loss(100, |number| if number < 10 { 0 } else { 25 }), Some(13));
    }

    #[test]
    fn a_queue_that_drains_shows_no_loss() {
        for drains in 4..=20 {
            assert_eq!(
                shows_loss(100, |number| 200_u64.saturating_sub(drains * number as u64)),
                None,
                "{drains} ms a frame"
            );
        }
    }

    #[test]
    fn replies_that_are_later_still_show_no_loss() {
        for later in [12, 40, 100, 300] {
            assert_eq!(shows_loss(100, |number| if number < 10 { 0 } else { later }), None, "{later} ms");
        }
    }
}
