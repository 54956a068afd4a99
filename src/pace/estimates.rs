//! Estimates of the shortest round trip and of the rate. Both use recent samples only, because
//! links change.

use super::MIN_FRAME_BYTES;
use std::collections::VecDeque;
use std::time::Duration;

/// Length of the intervals that the shortest round trip is taken from: the current interval and
/// the one before.
// BBR keeps its minimum for 10 s. An outdated minimum delays keys, so the intervals are short; but while frames follow
// each other, only one round trip a second is measured without a queue, and an interval should contain several: five.
const ROUND_TRIP_INTERVAL: Duration = Duration::from_secs(5);
/// Age at which a sample of the rate is dropped when a newer one is recorded.
// The estimate is the maximum of the samples, which ignores frames that were delayed elsewhere. A real drop of the rate
// is noticed at once nevertheless: the first late reply drops all higher samples.
const RATE_AGE: Duration = Duration::from_millis(500);
/// Least transmission time of a frame whose rate counts as the link's limit.
///
/// A frame that is transmitted in less time gives only a lower bound of the rate.
// Terminals that draw 60 times a second delay replies by up to 17 ms, which must not be taken for transmission time.
const MIN_SERVICE_TIME: Duration = Duration::from_millis(20);
/// Greatest error of a measured time, because of the clock and the scheduler.
const JITTER: Duration = Duration::from_millis(5);
/// Factor by which the bytes and times of earlier frames decay with each frame in the mean rate.
// A slow link transmits a frame in about 28 ms, so a jitter of 5 ms changes the rate of a single frame by a quarter.
// With the mean over several frames, recovery from a tenfold drop of the rate became faster by 0.2 s.
const SMOOTHING: f64 = 0.75;
/// Least number of bytes of a frame from which the rate is estimated; at low rates a fiftieth of
/// the bytes per second suffices.
// The round trips of smaller frames consist of jitter and the terminal's own delay.
const MIN_SAMPLE_BYTES: f64 = 512.0;

/// Least service time of a frame (transmission and drawing) at which [`FrameFloor`] is doubled.
// On a slow link, a frame that is larger than the floor takes 28 ms (36 frames a second). A longer time means that the
// terminal is drawing.
const MIN_DRAWING_TIME: Duration = Duration::from_millis(50);
/// Time for which [`FrameFloor`] does not grow after larger frames have taken longer.
// Each attempt to grow costs time: on a near link of 3 KB/s, one frame in two seconds takes 133 ms instead of 67.
const FLOOR_PAUSE: Duration = Duration::from_secs(2);
/// Greatest number of doublings of [`FrameFloor`]: to 51 kB, half a picture of 200x60 cells.
const MAX_DOUBLINGS: u32 = 8;

/// The estimate of the shortest round trip.
#[derive(Default)]
pub(super) struct RoundTrip {
    /// The shortest round trip of the previous interval and of the current one.
    shortest: [Option<Duration>; 2],
    /// Time at which the current interval of [`ROUND_TRIP_INTERVAL`] began.
    since: Duration,
    /// The last estimate before [`invalidate`](Self::invalidate).
    last_estimate: Duration,
}

impl RoundTrip {
    /// Records a round trip; `is_own` is whether it is the link's own, without transmission of a
    /// frame.
    ///
    /// Only a round trip of the link's own starts a new interval. Otherwise, if only replies to frames arrived during
    /// an interval, the transmission time of frames would be taken for a part of the link's round trip, and the rate
    /// for a very high one.
    pub(super) fn record(&mut self, round_trip: Duration, is_own: bool, now: Duration) {
        if is_own && now.saturating_sub(self.since) >= ROUND_TRIP_INTERVAL {
            self.shortest = [self.shortest[1], None];
            self.since = now;
        }
        self.shortest[1] = Some(self.shortest[1].map_or(round_trip, |shortest| shortest.min(round_trip)));
    }

    /// Drops the estimate because the route may have changed; [`expected`](Self::expected) still
    /// returns it.
    pub(super) fn invalidate(&mut self) {
        *self = Self { last_estimate: self.expected(), ..Self::default() };
    }

    /// Returns the estimated shortest round trip, or the last estimate before it was dropped.
    pub(super) fn expected(&self) -> Duration {
        self.shortest.into_iter().flatten().min().unwrap_or(self.last_estimate)
    }

    /// Returns whether the shortest round trip is known: recorded since the estimate was dropped
    /// last.
    pub(super) fn is_known(&self) -> bool {
        self.shortest[1].is_some()
    }

    /// Returns whether a round trip is too short for the link, so that the reply must belong to
    /// another query.
    pub(super) fn is_too_short(&self, round_trip: Duration) -> bool {
        round_trip + JITTER < self.shortest().mul_f64(0.9)
    }

    /// Returns the estimated shortest round trip; zero if it is unknown.
    pub(super) fn shortest(&self) -> Duration {
        self.shortest.into_iter().flatten().min().unwrap_or_default()
    }
}

/// A busy period: a time in which the link transmitted bytes without a pause.
///
/// Bytes count as transmitted one shortest round trip before their reply arrives.
#[derive(Default)]
pub(super) struct BusyPeriod {
    since: Duration,
    until: Duration,
    bytes: usize,
}

impl BusyPeriod {
    /// Records that bytes sent at `sent` had been transmitted at `passed`, and returns the bytes
    /// and duration of the busy period so far, which give the rate.
    ///
    /// Bytes that queued behind others are counted together with those: alone they would seem to be transmitted more
    /// slowly.
    pub(super) fn extend(&mut self, sent: Duration, bytes: usize, passed: Duration) -> (usize, Duration) {
        if sent + MIN_SERVICE_TIME >= self.until {
            (self.since, self.bytes) = (sent, 0);
        }
        self.until = passed;
        self.bytes += bytes;
        (self.bytes, passed.saturating_sub(self.since))
    }

    /// Returns the time at which the last confirmed bytes had been transmitted.
    pub(super) fn transmitted_until(&self) -> Duration {
        self.until
    }
}

/// A transmission rate: the link's limit, or a lower bound of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rate {
    pub(super) bytes_per_second: f64,
    /// Whether the rate is the link's limit; otherwise it is a lower bound of the limit.
    pub(super) is_limit: bool,
}

/// The number of bytes that a frame may always have, however low the estimated rate is.
///
/// It is doubled for as long as frames of this size take hardly longer than those of half the size.
// A terminal that draws for 0.2 s after each frame delays the reply to the next one by that time, whatever its size.
// Without the floor, the delay was taken for transmission: frames became smaller, and the estimated rate with them. If
// it drew for 70 ms or longer, a near terminal got 1 % of what it could draw; now it gets a quarter or more.
#[derive(Default)]
pub(super) struct FrameFloor {
    /// Number of doublings of [`MIN_FRAME_BYTES`] in the bytes that a frame may have at any rate.
    doublings: u32,
    /// Service time of a frame before the last doubling, with which the next frame's is compared.
    service_before_doubling: Option<Duration>,
    /// Time until which the floor is not doubled again, because frames took longer after it was
    /// doubled last.
    waits_until: Duration,
}

impl FrameFloor {
    /// Returns the number of bytes that a frame may always have.
    pub(super) fn guaranteed_bytes(&self) -> usize {
        MIN_FRAME_BYTES << self.doublings
    }

    /// Records the service time of a frame of this many bytes.
    pub(super) fn record(&mut self, bytes: usize, service: Duration, now: Duration) {
        let floor = self.guaranteed_bytes();
        // Only a frame of about this size tells whether a larger one would take longer.
        if !(floor / 2..2 * floor).contains(&bytes) {
            return;
        }
        // Twice the bytes took much longer: the link is slow, and not just the drawing.
        if self.service_before_doubling.take().is_some_and(|before| service > before.mul_f64(1.5)) {
            self.doublings = self.doublings.saturating_sub(1);
            self.waits_until = now + FLOOR_PAUSE;
        } else if service >= MIN_DRAWING_TIME && now >= self.waits_until && self.doublings < MAX_DOUBLINGS {
            self.service_before_doubling = Some(service);
            self.doublings += 1;
        }
    }
}

/// The estimate of the rate, from samples of the last frames.
#[derive(Default)]
pub(super) struct Rates {
    /// The samples, each with the time at which it was recorded.
    rates: VecDeque<(Duration, Rate)>,
    /// The decaying sums of bytes and times whose quotient is the last sample.
    ///
    /// Both are zero if the last sample was only a lower bound of the rate.
    last: (f64, Duration),
}

impl Rates {
    /// Records that transmitting `bytes` took the time `service`, and derives a sample of the rate.
    ///
    /// If the reply `is_late`, the rate has fallen, and all higher samples are dropped.
    pub(super) fn record(&mut self, bytes: usize, service: Duration, is_late: bool, now: Duration) {
        let bytes = bytes as f64;
        // The estimate is read before old samples are removed, so that it survives a pause.
        let (best, limit) = (self.best(), self.highest_limit());
        if bytes < best.map_or(MIN_SAMPLE_BYTES, |best| MIN_SAMPLE_BYTES.min(best.bytes_per_second / 50.0)) {
            return;
        }
        self.rates.retain(|&(at, _)| now.saturating_sub(at) < RATE_AGE);
        let before = std::mem::take(&mut self.last);
        let rate = if service >= MIN_SERVICE_TIME {
            let (more, longer) = if is_late { Default::default() } else { before };
            let (bytes, service) = (bytes + more, service + longer);
            self.last = (SMOOTHING * bytes, service.mul_f64(SMOOTHING));
            let bytes_per_second = bytes / service.as_secs_f64();
            self.rates.retain(|(_, rate)| !is_late || rate.bytes_per_second <= bytes_per_second);
            Rate { bytes_per_second, is_limit: true }
        } else {
            let shown = (bytes / (service + JITTER).as_secs_f64()).min(2.0 * limit);
            let shown = Rate { bytes_per_second: shown, is_limit: false };
            best.filter(|best| best.bytes_per_second >= shown.bytes_per_second).unwrap_or(shown)
        };
        self.rates.push_back((now, rate));
    }

    /// Drops the samples that are only lower bounds, unless all are, because mismatched replies may
    /// have caused them.
    pub(super) fn drop_lower_bounds(&mut self) {
        if self.rates.iter().any(|(_, rate)| rate.is_limit) {
            self.rates.retain(|(_, rate)| rate.is_limit);
        }
    }

    /// Lowers all samples to at most this many bytes per second.
    pub(super) fn cap(&mut self, bytes_per_second: f64) {
        for (_, rate) in &mut self.rates {
            rate.bytes_per_second = rate.bytes_per_second.min(bytes_per_second);
        }
        self.last = Default::default();
    }

    /// Returns the highest sample in bytes per second that was the link's limit; infinite if there
    /// is none.
    ///
    /// A new lower bound may be at most twice as high: an unsolicited reply makes the rate seem much higher, and
    /// sending at that rate would queue seconds of data.
    fn highest_limit(&self) -> f64 {
        let limits = self.rates.iter().filter(|(_, rate)| rate.is_limit).map(|(_, rate)| rate.bytes_per_second);
        limits.reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// Returns the estimated rate: the highest of the recent samples.
    pub(super) fn best(&self) -> Option<Rate> {
        let rates = self.rates.iter().map(|&(_, rate)| rate);
        rates.max_by(|a, b| a.bytes_per_second.total_cmp(&b.bytes_per_second))
    }
}
