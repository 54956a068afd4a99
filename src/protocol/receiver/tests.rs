use super::*;
use crate::protocol::FENCE;
use crossterm::event::{Event, KeyCode};

const ESCAPE: &[u8] = b"\x1b";

fn escape() -> [Input; 1] {
    [Input::Event(Event::Key(KeyCode::Esc.into()))]
}

/// Checks that after `forget_replies`, even twice, a late reply does not count as the reply to a
/// newer query.
#[test]
fn replies_forgotten_at_a_restore_do_not_count_later() {
    let mut receiver = Receiver::default();
    receiver.sent(FENCE, Duration::ZERO);
    receiver.sent(b"frame\x1b[c", Duration::ZERO);
    receiver.forget();
    assert_eq!(receiver.reply_time_left(Duration::ZERO), None);
    // A late reply matches no query, and the reply to a new query is still outstanding.
    receiver.receive(b"\x1b[?62c", Duration::ZERO);
    receiver.sent(FENCE, Duration::ZERO);
    assert!(receiver.reply_time_left(Duration::ZERO).is_some());
    receiver.receive(b"\x1b[?62c", Duration::ZERO);
    assert_eq!(receiver.reply_time_left(Duration::ZERO), None);
}

#[test]
fn a_lone_escape_is_the_key_after_its_timeout() {
    let mut receiver = Receiver::default();
    assert_eq!(receiver.sequence_times_out_at(Duration::ZERO), None);
    assert_eq!(receiver.receive(ESCAPE, Duration::ZERO), []);
    let due = receiver.sequence_times_out_at(Duration::ZERO).expect("it waits");
    assert_eq!(receiver.receive(&[], due.mul_f32(0.9)), []);
    assert_eq!(receiver.receive(&[], due), escape());
    assert_eq!(receiver.sequence_times_out_at(due), None);
}

#[test]
fn a_lone_escape_times_out_later_where_a_reply_may_follow() {
    let (mut asked, mut kitty) = (Receiver::default(), Receiver::default());
    asked.sent(FENCE, Duration::ZERO);
    kitty.set_keys_are_sequences(true);
    for receiver in [&mut asked, &mut kitty] {
        receiver.receive(ESCAPE, Duration::ZERO);
        assert_eq!(receiver.sequence_times_out_at(Duration::ZERO), Some(SEQUENCE_TIMEOUT));
    }
}
