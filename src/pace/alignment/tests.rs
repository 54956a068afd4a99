use super::super::ledger::{Ledger, QueryKind};
use super::super::tests::ms;
use super::*;

/// Simulates frames of 1,000 bytes every 25 ms on a link of 50 KB/s and 200 ms, and returns the
/// number of the reply that shows a loss, if any.
///
/// `later` returns the milliseconds by which the reply with this number is late.
fn shows_loss(frames: usize, later: impl Fn(usize) -> u64) -> Option<usize> {
    let mut alignment = Alignment::default();
    (0..frames).find(|&number| {
        let mut ledger = Ledger::default();
        let sent = (number..number + 8).map(|number| ms(25 * number as u64));
        sent.for_each(|sent| ledger.record(QueryKind::Counted, 1_000, sent));
        let now = ms(25 * number as u64 + 220 + later(number));
        alignment.is_misaligned(ledger.counted_queries(), ms(200), 50_000.0, now)
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
