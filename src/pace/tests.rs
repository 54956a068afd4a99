//! Tests of the link with a simulated connection: a rate, a round trip, and a terminal that replies
//! or does not.

use super::*;
use crate::protocol::FENCE;
use std::collections::VecDeque;

pub(super) const SCREEN: usize = 80 * 24 * 8;

pub(super) const fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

/// A frame, or a query without a frame, that has been sent.
pub(super) struct Sent {
    pub(super) at: Duration,
    pub(super) bytes: usize,
    /// Number of bytes that have not been transmitted yet.
    pub(super) left: f64,
    /// Time at which the last byte arrived.
    pub(super) seen: Option<Duration>,
    pub(super) is_frame: bool,
    /// Whether the bytes end with a query.
    pub(super) asks: bool,
}

/// A simulation of a program that sends a frame whenever it may, and of its connection to the
/// terminal.
pub(super) struct World {
    pub(super) link: Link,
    /// Bytes per second that the connection transmits.
    pub(super) rate: f64,
    pub(super) round_trip: Duration,
    /// Whether the terminal replies to queries.
    pub(super) replies: bool,
    /// Bytes of each frame that the program sends, cut to the link's limit if `obeys_limit`.
    pub(super) frame_bytes: usize,
    /// Whether frames obey the link's limit.
    pub(super) obeys_limit: bool,
    /// Share of the link's limit that frames use.
    pub(super) utilisation: f64,
    pub(super) now: Duration,
    /// Time at which the last frame was sent.
    pub(super) begun: Duration,
    pub(super) sent: Vec<Sent>,
    /// Arrival times of replies, with the bytes that they confirm.
    pub(super) replies_due: VecDeque<(Duration, usize)>,
    pub(super) in_flight: usize,
    /// Greatest number of bytes in flight so far, less the bandwidth-delay product and one frame.
    pub(super) excess: f64,
}

impl World {
    pub(super) fn new(rate: f64, round_trip: Duration) -> Self {
        Self {
            link: Link::new(None, None, true),
            rate,
            round_trip,
            replies: true,
            frame_bytes: SCREEN,
            obeys_limit: true,
            utilisation: 1.0,
            now: ms(1_000),
            begun: Duration::ZERO,
            sent: Vec::new(),
            replies_due: VecDeque::new(),
            in_flight: 0,
            excess: f64::MIN,
        }
    }

    pub(super) fn simulate(&mut self, time: Duration) {
        let end = self.now + time;
        while self.now < end {
            self.now += ms(1);
            self.transmit();
            self.receive();
            self.send();
        }
    }

    pub(super) fn ago(&self, milliseconds: u64) -> Duration {
        self.now.saturating_sub(ms(milliseconds))
    }

    /// Lets time pass in which bytes and replies arrive but nothing is sent.
    pub(super) fn rest(&mut self, time: Duration) {
        let end = self.now + time;
        while self.now < end {
            self.now += ms(1);
            self.transmit();
            self.receive();
        }
    }

    /// Transmits the bytes of one millisecond, in the order of sending.
    fn transmit(&mut self) {
        let mut room = self.rate / 1_000.0;
        for sent in self.sent.iter_mut().filter(|sent| sent.seen.is_none()) {
            let taken = room.min(sent.left);
            sent.left -= taken;
            room -= taken;
            if sent.left > 0.0 {
                break;
            }
            sent.seen = Some(self.now + self.round_trip / 2);
            if self.replies && sent.asks {
                self.replies_due.push_back((self.now + self.round_trip, sent.bytes));
            }
        }
    }

    fn receive(&mut self) {
        while self.replies_due.front().is_some_and(|reply| reply.0 <= self.now) {
            let Some((_, bytes)) = self.replies_due.pop_front() else { break };
            self.in_flight -= bytes;
            self.link.receive_attributes(self.now);
        }
    }

    fn send(&mut self) {
        if self.now < self.link.next_send_at(self.now).max(self.begun + self.link.min_frame_interval()) {
            return;
        }
        self.begun = self.now;
        let question = self.link.probe(self.now);
        if !question.is_empty() {
            self.push(question.len(), false, true);
        }
        let limit = self.link.limit(SCREEN, self.now);
        let most = limit.filter(|_| self.obeys_limit).map_or(self.frame_bytes, |limit| {
            let most = (limit.max_bytes as f64 * self.utilisation) as usize;
            most.min(self.frame_bytes)
        });
        let mut frame = vec![b'x'; most.saturating_sub(FENCE.len()).max(1)];
        self.link.send(&mut frame, self.now);
        let asks = frame.ends_with(FENCE);
        self.push(frame.len(), true, asks);
        let one_frame = (frame.len() as f64).max(self.rate / 15.0);
        let may_be = self.rate * self.round_trip.as_secs_f64() + one_frame;
        self.excess = self.excess.max(self.in_flight as f64 - may_be);
    }

    fn push(&mut self, bytes: usize, is_frame: bool, asks: bool) {
        self.in_flight += if asks { bytes } else { 0 };
        self.sent.push(Sent { at: self.now, bytes, left: bytes as f64, seen: None, is_frame, asks });
    }

    /// Returns the time from a key press at `pressed` until a frame that shows its effect is
    /// visible.
    pub(super) fn key_delay(&self, pressed: Duration) -> Duration {
        let heard = pressed + self.round_trip / 2;
        let frame = self.sent.iter().find(|sent| sent.is_frame && sent.at > heard);
        frame.and_then(|frame| frame.seen).map_or(Duration::MAX, |seen| seen.saturating_sub(pressed))
    }

    /// Returns the median and the 99th percentile of [`key_delay`](Self::key_delay), for presses
    /// every 7 ms.
    pub(super) fn key_delays(&self, from: Duration, to: Duration) -> [Duration; 2] {
        let mut times: Vec<_> =
            (from.as_millis()..to.as_millis()).step_by(7).map(|at| self.key_delay(ms(at as u64))).collect();
        times.sort();
        [times[times.len() / 2], times[times.len() * 99 / 100]]
    }

    /// Returns the frames per second, and the share of the connection's rate that is used.
    pub(super) fn throughput(&self, from: Duration, to: Duration) -> [f64; 2] {
        let seconds = to.saturating_sub(from).as_secs_f64();
        let sent = || self.sent.iter().filter(|sent| (from..to).contains(&sent.at));
        let bytes: usize = sent().map(|sent| sent.bytes).sum();
        [sent().filter(|sent| sent.is_frame).count() as f64 / seconds, bytes as f64 / seconds / self.rate]
    }
}

#[test]
fn keys_are_visible_soon_at_full_throughput() {
    for (frame_bytes, obeys_limit, p50, p99) in [(SCREEN, true, 310, 400), (4_000, false, 420, 480)] {
        let mut world = World { frame_bytes, obeys_limit, ..World::new(50_000.0, ms(200)) };
        world.simulate(ms(3_000));
        world.excess = f64::MIN;
        let from = world.now;
        world.simulate(ms(40_000));
        let to = world.ago(2_000);
        let [median, worst] = world.key_delays(from, to);
        let [fps, share] = world.throughput(from, to);
        assert!(median <= ms(p50) && worst <= ms(p99), "{frame_bytes}: p50 {median:?} p99 {worst:?}");
        assert!(fps >= 10.0 && share >= 0.85, "{frame_bytes}: {fps} fps, {share} of the link");
        assert!(world.excess <= 0.0, "{frame_bytes}: {} bytes too many in flight", world.excess);
    }
}

/// Frames that use only a part of their limit, as the encoder's do, fill the link too.
#[test]
fn frames_below_their_share_fill_the_link_too() {
    for utilisation in [0.75, 0.8, 0.83, 0.9] {
        let mut world = World { utilisation, ..World::new(50_000.0, ms(200)) };
        world.simulate(ms(3_000));
        world.excess = f64::MIN;
        let from = world.now;
        world.simulate(ms(20_000));
        let [_, share] = world.throughput(from, world.now);
        assert!(share >= 0.86, "{share} of the link with {utilisation} of each frame");
        assert!(world.excess <= 0.0, "{} bytes too many in flight", world.excess);
    }
}

#[test]
fn any_link_is_used_and_never_overfilled() {
    for rate in [3_000.0, 20_000.0, 80_000.0, 200_000.0] {
        for round_trip in [5, 40, 90, 130, 350] {
            let mut world = World::new(rate, ms(round_trip));
            world.simulate(ms(12_000));
            world.excess = f64::MIN;
            let from = world.now;
            world.simulate(ms(20_000));
            let to = world.ago(3_000);
            let [_, worst] = world.key_delays(from, to);
            let [fps, share] = world.throughput(from, to);
            let what = format!("{rate} B/s, {round_trip} ms: p99 {worst:?}, {fps} fps, {share}");
            assert!(worst <= ms(round_trip + 200), "{what}");
            // Frames are sent whole: if the round trip is about as long as the transmission of a frame, the link is
            // idle for up to half of the time.
            assert!(fps >= 9.0 && share >= 0.58, "{what}");
            assert!(world.excess <= 0.0, "{what}: {} too many", world.excess);
        }
    }
}

/// The link recovers from a tenfold drop of its rate within 2 s, at any moment between two frames.
#[test]
fn a_link_that_becomes_ten_times_slower_is_kept_up_with() {
    let late = |phase: u64| {
        let mut world = World { utilisation: 0.93, ..World::new(50_000.0, ms(200)) };
        world.simulate(ms(10_000 + phase));
        world.rate /= 10.0;
        let dropped = world.now;
        world.simulate(ms(20_000));
        (0..15_000).rev().find(|&at| world.key_delay(dropped + ms(at)) > ms(400)).unwrap_or(0)
    };
    let mut late: Vec<_> = (0..70).step_by(5).map(late).collect();
    late.sort_unstable();
    // The drop is noticed a round trip and a frame later. The bytes that are sent until then, at 86 % of the old rate,
    // take 2 s at the new one.
    assert!(late[late.len() / 2] <= 1_850 && late[late.len() - 1] <= 2_000, "{late:?} ms");
}

#[test]
fn a_link_that_becomes_fast_is_fast_soon() {
    let mut world = World::new(20_000.0, ms(100));
    world.simulate(ms(5_000));
    assert!(world.link.slow_limit(SCREEN).is_some());
    world.rate = 1e8;
    world.simulate(ms(3_000));
    assert_eq!(world.link.slow_limit(SCREEN), None);
    let [fps, _] = world.throughput(world.ago(1_000), world.now);
    assert!(fps > 55.0, "{fps} fps");
}

/// A fast link does not count as slow if frames are small or the terminal replies only when it
/// draws.
#[test]
fn a_fast_link_is_never_slow() {
    for frame_bytes in [40, 700, SCREEN] {
        for round_trip in [0, 16, 30, 120] {
            let mut world = World { frame_bytes, ..World::new(1e7, ms(round_trip)) };
            world.simulate(ms(2_000));
            assert_eq!(world.link.slow_limit(SCREEN), None, "{frame_bytes} bytes, {round_trip} ms");
            let [fps, _] = world.throughput(world.ago(1_000), world.now);
            assert!(fps > if round_trip < 17 { 55.0 } else { 7.0 }, "{frame_bytes} bytes, {round_trip} ms: {fps} fps");
        }
    }
}

#[test]
fn a_pause_does_not_make_a_link_slow_for_long() {
    let mut world = World { frame_bytes: 2_000, ..World::new(1e7, ms(2)) };
    world.simulate(ms(1_000));
    world.rate = 1.0;
    world.simulate(ms(400));
    world.rate = 1e7;
    world.simulate(ms(100));
    assert_eq!(world.link.slow_limit(SCREEN), None);
}

/// After the first frame the second one waits 0.4 s for a reply, and soon there are 30 frames a
/// second.
#[test]
fn a_terminal_that_never_replies_gets_thirty_frames_a_second() {
    let mut world = World { replies: false, ..World::new(1e7, ms(2)) };
    world.simulate(ms(400));
    assert_eq!(world.sent.iter().filter(|sent| sent.is_frame).count(), 1);
    world.simulate(ms(2_600));
    let [fps, _] = world.throughput(world.ago(2_000), world.now);
    assert!((28.0..=30.1).contains(&fps), "{fps} fps");
    assert_eq!(world.link.slow_limit(SCREEN), None);
    assert!(world.link.replies.ledger.in_flight().count() <= 8, "few outstanding queries");
    // A terminal that starts to reply gets 60 frames a second.
    world.replies = true;
    world.simulate(ms(2_000));
    let [fps, _] = world.throughput(world.ago(1_000), world.now);
    assert!(fps > 55.0, "{fps} fps");
}

#[test]
fn a_terminal_that_falls_silent_is_waited_for_a_while() {
    let mut world = World::new(1e7, ms(20));
    world.simulate(ms(1_000));
    world.replies = false;
    world.simulate(ms(4_000));
    let [fps, _] = world.throughput(world.ago(2_000), world.now);
    assert!((28.0..=30.1).contains(&fps), "{fps} fps");
}

#[test]
fn a_lost_reply_is_forgotten() {
    let mut world = World { frame_bytes: 2_000, ..World::new(1e7, ms(20)) };
    world.simulate(ms(1_000));
    let lost = world.replies_due.pop_front();
    assert!(lost.is_some());
    world.simulate(ms(3_000));
    let [fps, _] = world.throughput(world.ago(1_000), world.now);
    assert!(fps > 25.0, "{fps} fps");
}

/// A link whose first reply arrives after the terminal is considered silent is used fully later.
#[test]
fn a_very_long_round_trip_is_taken_for_silence_only_at_first() {
    let mut world = World::new(200_000.0, ms(900));
    world.simulate(ms(5_000));
    world.rest(ms(5_000));
    world.simulate(ms(5_000));
    world.excess = f64::MIN;
    let from = world.now;
    world.simulate(ms(10_000));
    let to = world.ago(3_000);
    let [_, worst] = world.key_delays(from, to);
    let [fps, share] = world.throughput(from, to);
    assert!(worst <= ms(1_150), "{worst:?}");
    assert!(fps >= 10.0 && share >= 0.8, "{fps} fps, {share} of the link");
}

/// After 40 unsolicited replies and a pause, key delays and throughput are as before.
#[test]
fn unsolicited_replies_do_no_lasting_harm() {
    let mut world = World::new(50_000.0, ms(200));
    world.simulate(ms(5_000));
    for _ in 0..40 {
        world.link.receive_attributes(world.now);
        world.simulate(ms(37));
    }
    // Until there is a pause, each reply may be matched to the wrong frame.
    world.rest(ms(5_000));
    world.simulate(ms(7_000));
    let from = world.now;
    world.simulate(ms(10_000));
    let to = world.ago(2_000);
    let [_, worst] = world.key_delays(from, to);
    let [fps, share] = world.throughput(from, to);
    assert!(worst <= ms(400), "{worst:?}");
    assert!(fps >= 10.0 && share >= 0.8, "{fps} fps, {share} of the link");
}

#[test]
fn a_longer_round_trip_is_noticed() {
    let mut world = World::new(50_000.0, ms(100));
    world.simulate(ms(5_000));
    world.round_trip = ms(300);
    world.simulate(ms(15_000));
    let from = world.now;
    world.simulate(ms(10_000));
    let to = world.ago(2_000);
    let [fps, share] = world.throughput(from, to);
    assert!(fps >= 10.0 && share >= 0.8, "{fps} fps, {share} of the link");
}

#[test]
fn a_shorter_round_trip_is_noticed() {
    for (rate, round_trip) in [(50_000.0, 20), (50_000.0, 1), (200_000.0, 5), (1e8, 20), (1e8, 1)] {
        let mut world = World::new(50_000.0, ms(200));
        world.simulate(ms(5_000));
        (world.rate, world.round_trip) = (rate, ms(round_trip));
        // Frames are sent in bursts, as when keys are pressed.
        for _ in 0..12 {
            world.simulate(ms(190));
            world.rest(ms(30));
        }
        let shortest = world.link.replies.round_trip.shortest();
        assert!(shortest <= ms(round_trip + 30), "{shortest:?} of {round_trip} ms");
        assert_eq!(world.link.slow_limit(SCREEN).is_some(), rate < 1e6, "{rate} B/s, {round_trip} ms");
    }
}

/// After the round trip became shorter, key times and throughput are about those of a link whose
/// round trip was always that short.
#[test]
fn a_slightly_shorter_round_trip_is_used_fully() {
    for round_trip in [150, 100, 50] {
        let [[now, now_share], [always, share]] = [200, round_trip].map(|before| {
            let mut world = World::new(50_000.0, ms(before));
            world.simulate(ms(5_000));
            world.round_trip = ms(round_trip);
            world.simulate(ms(5_000));
            let from = world.now;
            world.simulate(ms(20_000));
            let to = world.ago(2_000);
            let [_, worst] = world.key_delays(from, to);
            let [_, share] = world.throughput(from, to);
            [worst.as_secs_f64(), share]
        });
        assert!(now <= 1.1 * always && now_share >= 0.95 * share, "{now}, {now_share} for {always}, {share}");
    }
}

/// A link that has become fast is noticed when frames become large, although small ones do not show
/// it.
#[test]
fn an_old_limit_does_not_last() {
    let mut world = World::new(100_000.0, ms(20));
    world.simulate(ms(3_000));
    world.rate = 1e8;
    (world.frame_bytes, world.obeys_limit) = (700, false);
    world.simulate(ms(5_000));
    (world.frame_bytes, world.obeys_limit) = (SCREEN, true);
    world.simulate(ms(1_000));
    assert_eq!(world.link.slow_limit(SCREEN), None);
}

#[test]
fn caps_are_kept() {
    for rate in [5_000, 50_000, 200_000, 1_000_000] {
        let mut world = World { link: Link::new(Some(rate), None, true), ..World::new(1e8, ms(10)) };
        world.simulate(ms(3_000));
        let [_, share] = world.throughput(world.ago(2_000), world.now);
        let share = share * 1e8 / f64::from(rate);
        let most = SCREEN as f64 * 60.0 / f64::from(rate);
        assert!((0.95 * most.min(1.0)..=1.05).contains(&share), "{share} of {rate} B/s");
    }
    for cap in [5.0, 24.0, 60.0] {
        let mut world = World { link: Link::new(None, Some(cap), true), ..World::new(1e8, ms(1)) };
        world.simulate(ms(3_000));
        let [fps, _] = world.throughput(world.ago(2_000), world.now);
        assert!((0.9 * f64::from(cap)..=1.05 * f64::from(cap)).contains(&fps), "{fps} fps of {cap}");
    }
}
