use super::*;

#[test]
fn parts_follow_each_other_at_the_rate() {
    let mut rate = TotalRate::new(100_000);
    let now = Duration::from_secs(5);
    assert_eq!(rate.reserve_wait(1000, now), Duration::ZERO);
    // The first part takes 10 ms, so the second one waits 10 ms less `EARLY`.
    assert_eq!(rate.reserve_wait(500, now), Duration::from_millis(8));
    assert_eq!(rate.reserve_wait(1000, now), Duration::from_millis(13));
    // The time of a pause is not credited: the second part waits again.
    assert_eq!(rate.reserve_wait(1000, 2 * now), Duration::ZERO);
    assert_eq!(rate.reserve_wait(1000, 2 * now), Duration::from_millis(8));
}
