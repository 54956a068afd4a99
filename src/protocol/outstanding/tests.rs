use super::*;

const NOW: Duration = Duration::from_secs(1);

fn mode(mode: u16) -> Reply {
    Reply::Mode { mode, state: 0 }
}

#[test]
fn a_reply_to_a_tag_removes_all_older_queries() {
    let [first, second, third] = [Tag::FIRST, Tag::FIRST.next(), Tag::FIRST.next().next()];
    let mut outstanding = Outstanding::default();
    outstanding.sent(FENCE, NOW);
    for tag in [first, second, third] {
        outstanding.sent(&tag.query(), NOW);
    }
    // The reply to `second` arrives twice, before any reply to the fence or to `first`. The replies 700 and 2026 belong
    // to no query. The reply to the fence comes too late: a reply to a newer query has arrived.
    for reply in [mode(201), mode(201), mode(700), mode(2026), Reply::DeviceAttributes(vec![62])] {
        outstanding.take(&reply);
    }
    assert_eq!(outstanding.queries, [Query::Tag(third)]);
    outstanding.take(&mode(202));
    assert_eq!(outstanding.time_left(NOW), None);
}

#[test]
fn a_reply_times_out_3_seconds_after_its_query() {
    let mut outstanding = Outstanding::default();
    outstanding.sent(b"frame", NOW);
    assert_eq!(outstanding.time_left(NOW), None, "these bytes hold no query");
    outstanding.sent(b"frame\x1b[c", NOW);
    assert_eq!(outstanding.time_left(NOW + REPLY_TIMEOUT / 3), Some(2 * REPLY_TIMEOUT / 3));
    assert_eq!(outstanding.time_left(NOW + 2 * REPLY_TIMEOUT), None);
}

#[test]
fn the_number_of_recorded_queries_is_bounded() {
    let mut outstanding = Outstanding::default();
    for _ in 0..10 * MAX_QUERIES {
        outstanding.sent(FENCE, NOW);
    }
    assert_eq!(outstanding.queries.len(), MAX_QUERIES);
}
