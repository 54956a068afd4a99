//! Estimates of the shortest round trip and the rate, both of the last moments, because links
//! change.

use std::collections::VecDeque;
use std::time::Duration;

/// The age of the shortest round trip: it is kept for this long at least, and twice this at most.
// BBR keeps it for 10 s. Here a key waits if it is outdated, and while frames follow each other only one round trip a
// second is measured without a queue: five samples an age.
const ROUND_TRIP_AGE: Duration = Duration::from_secs(5);
/// Time for which the highest rate is kept if there are others.
// The maximum over it ignores frames that were delayed elsewhere; a real drop of the rate is noticed at once by the
// first late reply, which drops all higher rates.
const RATE_AGE: Duration = Duration::from_millis(500);
/// A frame with less transmission time was not limited by the link.
///
/// It gives a lower bound of the rate only.
// Terminals that draw 60 times a second delay replies by up to 17 ms, which must not look like transmission.
const MIN_SERVICE_TIME: Duration = Duration::from_millis(20);
/// Part of a short time that may be jitter of the clock and the scheduler.
const JITTER: Duration = Duration::from_millis(5);
/// Weight of previous measurements.
// A frame of a slow link is transmitted in about 28 ms, so that its rate alone varies by a quarter with the jitter of
// 5 ms. Pooled over several frames, recovery from a tenfold drop became faster by 0.2 s.
const SMOOTHING: f64 = 0.75;
/// Least number of bytes for a frame to give the rate, unless the rate is so low that even those
/// take long.
// Round trips of smaller frames consist of jitter and of the terminal's own delay.
const MIN_SAMPLE_BYTES: f64 = 512.0;

/// The shortest round trip.
#[derive(Default)]
pub(super) struct RoundTrip {
    /// The shortest of the previous age and of the current one.
    shortest: [Option<Duration>; 2],
    /// Start of the current age.
    since: Duration,
    /// The estimate before it was dropped.
    before: Duration,
}

impl RoundTrip {
    /// Records a round trip, which is the link's own if nothing was sent with the query that takes
    /// time to transmit. Only such a round trip starts a new age: if the replies to all queries alone were lost for a
    /// while, the transmission time of frames would seem to be part of the link's round trip, and the rate that of a
    /// link which transmits in no time.
    pub(super) fn take(&mut self, round_trip: Duration, is_own: bool, now: Duration) {
        if is_own && now.saturating_sub(self.since) >= ROUND_TRIP_AGE {
            self.shortest = [self.shortest[1], None];
            self.since = now;
        }
        self.shortest[1] = Some(self.shortest[1].map_or(round_trip, |shortest| shortest.min(round_trip)));
    }

    /// Drops the estimate because the route may have changed; it remains the expected value.
    pub(super) fn invalidate(&mut self) {
        *self = Self { before: self.expected(), ..Self::default() };
    }

    /// Returns the expected round trip, from the last estimate.
    pub(super) fn expected(&self) -> Duration {
        self.shortest.into_iter().flatten().min().unwrap_or(self.before)
    }

    /// Returns whether there is an estimate.
    pub(super) fn is_known(&self) -> bool {
        self.shortest[1].is_some()
    }

    /// Returns whether a round trip is so short that the reply must belong to another query.
    pub(super) fn is_implausible(&self, round_trip: Duration) -> bool {
        round_trip + JITTER < self.shortest().mul_f64(0.9)
    }

    /// Returns the estimate; zero without one.
    pub(super) fn shortest(&self) -> Duration {
        self.shortest.into_iter().flatten().min().unwrap_or_default()
    }
}

/// A busy period: back-to-back transmission.
///
/// Times are arrivals of replies minus one full round trip.
#[derive(Default)]
pub(super) struct BusyPeriod {
    since: Duration,
    until: Duration,
    bytes: usize,
}

impl BusyPeriod {
    /// Records that bytes sent at `sent` have been transmitted.
    ///
    /// Returns the bytes and the time that give the rate. Bytes that waited behind others count only together with
    /// them: alone they would seem slower than they were.
    pub(super) fn take(&mut self, sent: Duration, bytes: usize, passed: Duration) -> (usize, Duration) {
        if sent + MIN_SERVICE_TIME >= self.until {
            (self.since, self.bytes) = (sent, 0);
        }
        self.until = passed;
        self.bytes += bytes;
        (self.bytes, passed.saturating_sub(self.since))
    }

    /// Returns the time of the last known transmission.
    pub(super) fn until(&self) -> Duration {
        self.until
    }
}

/// A transmission rate: the link's limit, or a lower bound of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rate {
    pub(super) bytes_per_second: f64,
    /// Whether it is the link's limit; otherwise a lower bound.
    pub(super) is_limit: bool,
}

/// The rates of the last frames.
#[derive(Default)]
pub(super) struct Rates {
    /// The samples, each with its time.
    rates: VecDeque<(Duration, Rate)>,
    /// The decaying sums of bytes and time behind the last rate.
    ///
    /// Empty if that was not the link's limit.
    last: (f64, Duration),
}

impl Rates {
    /// Records a transmission of bytes in a time, beyond the round trip.
    ///
    /// If it is late, the rate has fallen, and higher ones are dropped.
    pub(super) fn take(&mut self, bytes: usize, service: Duration, is_late: bool, now: Duration) {
        let bytes = bytes as f64;
        // One of the previous rates is kept even after a pause.
        let (best, limit) = (self.best(), self.limit());
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

    /// Drops rates that may stem from mismatched replies: only low ones are kept, if there are any.
    pub(super) fn keep_limits(&mut self) {
        if self.rates.iter().any(|(_, rate)| rate.is_limit) {
            self.rates.retain(|(_, rate)| rate.is_limit);
        }
    }

    /// Returns the highest rate of the last moments that did not exceed the link's limit.
    ///
    /// A sudden increase is not believed: an unsolicited reply causes one, and sending at twice the rate would queue
    /// seconds of data.
    fn limit(&self) -> f64 {
        let limits = self.rates.iter().filter(|(_, rate)| rate.is_limit).map(|(_, rate)| rate.bytes_per_second);
        limits.reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// Returns the highest rate of the last moments.
    pub(super) fn best(&self) -> Option<Rate> {
        let rates = self.rates.iter().map(|&(_, rate)| rate);
        rates.max_by(|a, b| a.bytes_per_second.total_cmp(&b.bytes_per_second))
    }
}
