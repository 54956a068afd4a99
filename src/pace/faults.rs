//! Tests of the link with a simulated terminal that loses, duplicates, replaces and delays replies.

use super::reply_tracker::TagSupport;
use super::tests::ms;
use super::*;
use crate::protocol::FENCE;
use rayon::prelude::*;
use std::collections::VecDeque;

/// A fault of one reply, or of that reply and later ones.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ReplyFault {
    Lost,
    Doubled,
    /// A reply to a query that was never sent arrives instead.
    Foreign,
    Late(Duration),
    /// The reply is late, and no later reply arrives before it.
    HeldBack(Duration),
    /// The reply is lost, and so is every third one after it.
    EachThird,
    /// The reply is late, and so is every third one after it.
    EachThirdLate(Duration),
    /// The reply is lost, and so are all later ones.
    Stopped,
}

const FAULTS: [ReplyFault; 12] = [
    ReplyFault::Lost,
    ReplyFault::Doubled,
    ReplyFault::Foreign,
    ReplyFault::Late(ms(100)),
    ReplyFault::Late(ms(300)),
    ReplyFault::Late(ms(2_000)),
    ReplyFault::Late(ms(20_000)),
    ReplyFault::HeldBack(ms(300)),
    ReplyFault::HeldBack(ms(20_000)),
    ReplyFault::EachThird,
    ReplyFault::EachThirdLate(ms(400)),
    ReplyFault::Stopped,
];

/// A reply to DA1, or to DECRQM with the number of the mode.
#[derive(Clone, Copy, Debug)]
enum Reply {
    Attributes,
    Mode(u16),
}

/// A simulation of a program that sends a frame whenever it may, and of a terminal with a fault.
struct World {
    link: Link,
    /// Whether the terminal answers DECRQM, so that replies have numbers.
    tags: bool,
    /// Bytes per second that the link transmits.
    rate: f64,
    round_trip: Duration,
    fault: ReplyFault,
    /// Number of the first faulty reply, counted from 1.
    at: usize,
    /// Number of replies that the terminal has sent so far.
    replies: usize,
    now: Duration,
    /// Time at which the last frame was sent.
    begun: Duration,
    /// Time at which the link has transmitted all bytes.
    free_at: Duration,
    /// The frames: the time at which each was sent, its bytes, and the time at which it is visible.
    frames: Vec<(Duration, usize, Duration)>,
    /// The replies on their way, with their times of arrival.
    due: Vec<(Duration, Reply)>,
    /// Time before which no reply of the terminal arrives, as [`ReplyFault::HeldBack`] sets it.
    held_until: Duration,
    /// Time at which the first round trip was known.
    first_reply: Option<Duration>,
    /// Bytes of each frame that the program sends, unless the link's limit is lower.
    wanted: usize,
    /// Delay of the first reply, because the terminal is busy starting.
    start: Duration,
    /// Time for which the terminal draws after each frame, and reads nothing.
    draws: Duration,
}

const SCREEN: usize = 80 * 24 * 8;

impl World {
    fn new(tags: bool, fault: ReplyFault, at: usize) -> Self {
        Self {
            link: Link::new(None, None, true),
            tags,
            rate: 2e7,
            round_trip: ms(2),
            fault,
            at,
            replies: 0,
            now: ms(1_000),
            begun: Duration::ZERO,
            free_at: Duration::ZERO,
            frames: Vec::new(),
            due: Vec::new(),
            held_until: Duration::ZERO,
            first_reply: None,
            wanted: SCREEN,
            start: Duration::ZERO,
            draws: Duration::ZERO,
        }
    }

    fn with_slow_link(self) -> Self {
        Self { rate: 50_000.0, round_trip: ms(200), ..self }
    }

    fn simulate(&mut self, time: Duration) {
        let end = self.now + time;
        if self.replies == 0 && self.frames.is_empty() && self.tags {
            self.due.push((self.now + self.round_trip, Reply::Mode(200)));
        }
        while self.now < end {
            self.now += ms(1);
            let now = self.now;
            let come: Vec<_> = self.due.extract_if(.., |(at, _)| *at <= now).collect();
            for (_, reply) in come {
                match reply {
                    Reply::Attributes => self.link.receive_attributes(now),
                    Reply::Mode(mode) => drop(self.link.match_mode_reply(mode, now)),
                }
                if self.link.replies.round_trip.is_known() {
                    self.first_reply.get_or_insert(now);
                }
            }
            self.send();
        }
    }

    fn send(&mut self) {
        if self.now < self.link.next_send_at(self.now).max(self.begun + self.link.min_frame_interval()) {
            return;
        }
        self.begun = self.now;
        let probe = self.link.probe(self.now);
        self.transmit(&probe);
        let limit = self.link.limit(SCREEN, self.now).map_or(self.wanted, |limit| limit.max_bytes.min(self.wanted));
        let mut frame = vec![b'x'; limit - 11];
        self.link.send(&mut frame, self.now);
        let seen = self.transmit(&frame);
        self.free_at += self.draws;
        self.frames.push((self.now, frame.len(), seen));
    }

    /// Transmits bytes, replies to their queries, and returns the time at which the bytes are
    /// visible.
    fn transmit(&mut self, bytes: &[u8]) -> Duration {
        self.free_at = self.free_at.max(self.now) + Duration::from_secs_f64(bytes.len() as f64 / self.rate);
        let at = self.free_at + self.round_trip;
        let tagged = bytes.strip_suffix(FENCE).unwrap_or(bytes);
        if let Some(query) = tagged.last_chunk::<8>().filter(|query| query.ends_with(b"$p") && self.tags) {
            let digits = query[3..6].iter().fold(0, |number, digit| 10 * number + u16::from(digit - b'0'));
            self.schedule_reply(Reply::Mode(digits), at);
        }
        if bytes.ends_with(FENCE) {
            self.schedule_reply(Reply::Attributes, at);
        }
        self.free_at + self.round_trip / 2
    }

    fn schedule_reply(&mut self, reply: Reply, at: Duration) {
        self.replies += 1;
        let at = if self.replies == 1 { at + self.start } else { at };
        let third = self.replies >= self.at && (self.replies - self.at).is_multiple_of(3);
        let mut due = vec![(at, reply)];
        match self.fault {
            ReplyFault::EachThird if third => due.clear(),
            ReplyFault::EachThirdLate(late) if third => due[0].0 += late,
            ReplyFault::Stopped if self.replies >= self.at => due.clear(),
            _ if self.replies != self.at => {}
            ReplyFault::Lost => due.clear(),
            ReplyFault::Doubled => due.push((at, reply)),
            ReplyFault::Foreign => due[0].1 = Reply::Mode(7),
            ReplyFault::Late(late) => due[0].0 += late,
            ReplyFault::HeldBack(late) => self.held_until = at + late,
            _ => {}
        }
        self.due.extend(due.into_iter().map(|(at, reply)| (at.max(self.held_until), reply)));
        self.due.sort_by_key(|(at, _)| *at);
    }

    /// Returns the longest time until the effect of a key is visible, for keys pressed between
    /// `start` and `end`.
    fn worst_key_delay(&self, start: Duration, end: Duration) -> Duration {
        let keys = (start.as_millis()..end.as_millis()).map(|at| ms(at as u64));
        let mut frames: VecDeque<_> = self.frames.iter().collect();
        keys.map(|pressed| {
            while frames.front().is_some_and(|frame| frame.0 < pressed + self.round_trip / 2) {
                frames.pop_front();
            }
            frames.front().map_or(Duration::MAX, |frame| frame.2.saturating_sub(pressed))
        })
        .max()
        .unwrap_or_default()
    }
}

/// Calls `worst` with every fault of each of the first 40 replies, with and without numbers in
/// replies.
///
/// # Panics
/// If a returned time is longer than `limit`.
fn check_each_fault(limit: Duration, worst: impl Fn(bool, ReplyFault, usize) -> Duration + Sync) {
    let cases: Vec<_> = [true, false].into_iter().flat_map(|tags| FAULTS.map(|fault| (tags, fault))).collect();
    let check = |&(tags, fault): &(bool, ReplyFault)| {
        let worst = |at| (worst(tags, fault, at), at);
        let (time, at) = (1..=40).map(worst).max().expect("there are replies");
        (time > limit).then(|| format!("with numbers: {tags}, {fault:?} at {at}: {time:?}"))
    };
    let late: Vec<_> = cases.par_iter().filter_map(check).collect();
    assert!(late.is_empty(), "longer than {limit:?}:\n{}", late.join("\n"));
}

#[test]
fn no_key_waits_longer_than_250_ms_once_a_local_terminal_has_replied() {
    check_each_fault(ms(250), |tags, fault, at| {
        let mut world = World::new(tags, fault, at);
        world.simulate(ms(25_000));
        world.worst_key_delay(world.first_reply.unwrap_or(ms(2_000)), ms(25_500))
    });
}

#[test]
fn no_key_waits_longer_than_500_ms_before_a_local_terminal_has_replied() {
    check_each_fault(ms(500), |tags, fault, at| {
        let mut world = World::new(tags, fault, at);
        world.simulate(ms(3_000));
        world.worst_key_delay(ms(1_000), world.first_reply.unwrap_or(ms(3_000)))
    });
}

/// Even if the first round trip is longer than the others and frames are small, lost replies do not
/// make the estimated rate low.
#[test]
fn a_near_terminal_that_loses_replies_is_not_taken_for_a_slow_link() {
    check_each_fault(ms(250), |tags, fault, at| {
        let mut world = World { wanted: 800, start: ms(3), round_trip: ms(1), ..World::new(tags, fault, at) };
        world.simulate(ms(5_000));
        let limit = world.link.replies.rates.best().filter(|rate| rate.is_limit);
        assert_eq!(limit, None, "with numbers: {tags}, {fault:?} at {at}");
        world.worst_key_delay(world.first_reply.unwrap_or(ms(2_000)), ms(5_500))
    });
}

#[test]
fn little_is_sent_between_the_first_picture_and_the_first_reply() {
    for tags in [true, false] {
        let mut world = World::new(tags, ReplyFault::Stopped, 1);
        world.simulate(ms(1_000));
        let sent: usize = world.frames[1..].iter().map(|frame| frame.1).sum();
        assert!(world.frames.len() > 1 && sent <= 2_000, "{sent} bytes");
    }
}

/// While the first picture is on its way through a slow link little is sent, and later keys are
/// visible in time.
#[test]
fn the_first_picture_of_a_slow_link_is_waited_for() {
    for tags in [true, false] {
        let mut world = World::new(tags, ReplyFault::Doubled, 1_000_000).with_slow_link();
        world.simulate(ms(500));
        let sent: usize = world.frames[1..].iter().map(|frame| frame.1).sum();
        assert!(sent <= 2_000, "{sent} bytes");
        world.simulate(ms(5_000));
        assert!(world.worst_key_delay(ms(4_000), ms(5_500)) <= ms(350));
    }
}

/// Returns whether a fault of one of the first replies makes the rate of a slow link unmeasurable.
///
/// From that reply on, all replies are missing or more than a second late.
fn hides_rate(fault: ReplyFault) -> bool {
    matches!(fault, ReplyFault::HeldBack(late) if late > ms(1_000)) || fault == ReplyFault::Stopped
}

/// Without faults the effect of a key is visible after 310 ms, or 400 ms at worst; a fault may cost
/// two round trips more.
///
/// Silence from the first or second reply on is left out: nothing then shows that the link is slow.
#[test]
fn no_key_waits_much_longer_on_a_slow_link() {
    check_each_fault(ms(800), |tags, fault, at| {
        if at <= 2 && hides_rate(fault) {
            return Duration::ZERO;
        }
        let mut world = World::new(tags, fault, at).with_slow_link();
        world.simulate(ms(25_000));
        world.worst_key_delay(ms(4_000), ms(25_000))
    });
}

#[test]
fn a_terminal_that_replies_again_gets_all_frames_again() {
    for tags in [true, false] {
        for late in [300, 5_000] {
            let mut world = World::new(tags, ReplyFault::HeldBack(ms(late)), 30);
            world.simulate(ms(late + 3_000));
            let since = world.now.saturating_sub(ms(1_000));
            let frames = world.frames.iter().filter(|frame| frame.0 >= since).count();
            assert!(frames >= 55, "tags {tags}, held {late} ms: {frames} frames a second");
            assert_eq!(world.link.replies.state, ReplyState::Steady);
        }
    }
}

#[test]
fn a_lost_reply_is_known_as_soon_as_the_next_one_comes() {
    let mut link = Link::new(None, None, true);
    link.replies.tag_support = TagSupport::Known;
    for at in [0, 10, 20] {
        link.send(&mut b"frame".to_vec(), ms(at));
    }
    assert_eq!(link.replies.ledger.in_flight().count(), 3);
    assert!(link.match_mode_reply(202, ms(12)));
    assert_eq!(link.replies.ledger.in_flight().count(), 1);
    // A reply that is late, a duplicate, one to no query, and one of an existing mode.
    for mode in [201, 202, 700, 2026] {
        assert!(!link.match_mode_reply(mode, ms(13)));
    }
    assert!(link.match_mode_reply(203, ms(22)));
    assert_eq!((link.replies.ledger.in_flight().count(), link.replies.state), (0, ReplyState::Steady));
}

/// A query without a frame whose reply was lost is sent again at once, and not after a second.
#[test]
fn a_lost_query_without_a_frame_is_sent_again() {
    let mut link = Link::new(None, None, true);
    link.replies.tag_support = TagSupport::Known;
    assert_ne!(link.probe(ms(0)), b"");
    link.send(&mut b"frame".to_vec(), ms(0));
    assert_eq!(link.probe(ms(1)), b"");
    assert!(link.match_mode_reply(202, ms(2)), "the reply to the frame");
    assert_ne!(link.probe(ms(3)), b"");
    assert!(link.match_mode_reply(203, ms(4)));
    assert_eq!(link.probe(ms(5)), b"", "that one was answered");
}

/// If another terminal takes the place of the first, as after a detach, queries go back to DA1.
#[test]
fn a_terminal_that_no_longer_repeats_numbers_is_asked_without() {
    let mut world = World::new(true, ReplyFault::HeldBack(ms(3_000)), 30);
    world.simulate(ms(2_000));
    world.tags = false;
    world.simulate(ms(8_000));
    assert_eq!(world.link.replies.tag_support, TagSupport::Possible);
    let since = world.now.saturating_sub(ms(1_000));
    assert!(world.frames.iter().filter(|frame| frame.0 >= since).count() >= 55);
}

/// On a slow link that loses replies without numbers, only one query is in flight, so that the
/// estimated rate is right.
#[test]
fn after_a_loss_one_query_is_in_flight_on_a_slow_link() {
    let mut world = World::new(false, ReplyFault::EachThird, 5).with_slow_link();
    world.simulate(ms(4_000));
    for _ in 0..6_000 {
        world.simulate(ms(1));
        let replies = &world.link.replies;
        assert!(replies.state != ReplyState::Steady || replies.ledger.in_flight().count() <= 1, "at {:?}", world.now);
    }
    let rate = world.link.replies.rates.best().map(|rate| rate.bytes_per_second);
    assert!(rate.is_some_and(|rate| (20_000.0..=55_000.0).contains(&rate)), "{rate:?} of 50 KB/s");
}

/// A near terminal that draws for a fixed time after each frame is not taken for a slow link: it
/// gets large frames.
#[test]
fn a_near_terminal_that_draws_slowly_gets_large_frames() {
    for (tags, draws) in [(true, 80), (false, 80), (true, 150), (false, 150), (true, 300)] {
        let mut world = World { draws: ms(draws), ..World::new(tags, ReplyFault::Doubled, usize::MAX) };
        world.simulate(ms(20_000));
        let since = world.now.saturating_sub(ms(5_000));
        let sent: usize = world.frames.iter().filter(|frame| frame.0 >= since).map(|frame| frame.1).sum();
        let could = SCREEN * 5_000 / draws as usize;
        assert!(5 * sent > could, "tags {tags}, draws for {draws} ms: {sent} bytes of {could}");
    }
}

/// The frames of a near link that is slow stay small.
#[test]
fn a_near_link_that_is_slow_gets_small_frames() {
    for (tags, rate) in [(true, 3_000.0), (false, 3_000.0), (true, 11_500.0), (false, 11_500.0)] {
        let mut world = World { rate, ..World::new(tags, ReplyFault::Doubled, usize::MAX) };
        world.simulate(ms(30_000));
        let worst = world.worst_key_delay(ms(15_000), ms(30_000));
        assert!(worst < ms(250), "tags {tags}, {rate} bytes per second: {worst:?}");
    }
}
