//! What the answers say of a link: its shortest round trip and its rate. Both are of the last moments: links change.

use std::collections::VecDeque;
use std::time::Duration;

/// For so long at least, and at most twice that, the shortest round trip is remembered.
const ROUND_TRIP_AGE: Duration = Duration::from_secs(5);
/// For so long the highest rate is, if there are others.
const RATE_AGE: Duration = Duration::from_millis(500);
/// A frame that takes less than this has not been held up by the link's rate: all that is sure is that it is no less.
const SHORT: Duration = Duration::from_millis(20);
/// So much of a short time may be chance.
const CHANCE: Duration = Duration::from_millis(5);
/// So much of what was told before counts with what is told now: what is chance in one frame is little in several.
const MEMORY: f64 = 0.75;
/// A frame of fewer bytes says nothing of the rate, unless the rate is so low that it takes long.
const TELLING: f64 = 512.0;

/// The shortest round trip.
#[derive(Default)]
pub(super) struct RoundTrip {
    /// The shortest of the age before this one, and of this one.
    shortest: [Option<Duration>; 2],
    /// When this age began.
    since: Duration,
    /// What was known before it was doubted.
    before: Duration,
}

impl RoundTrip {
    /// Takes a round trip, which is the link's own if nothing was sent with the query that took as long as its bytes do. No
    /// other begins an age: if the replies to all queries alone were lost for a while, the time that frames take to be sent
    /// would seem to be the link's, and the rate to be that of a link which sends them in no time.
    pub(super) fn take(&mut self, round_trip: Duration, is_own: bool, now: Duration) {
        if is_own && now.saturating_sub(self.since) >= ROUND_TRIP_AGE {
            self.shortest = [self.shortest[1], None];
            self.since = now;
        }
        self.shortest[1] = Some(self.shortest[1].map_or(round_trip, |shortest| shortest.min(round_trip)));
    }

    /// The way may be another: what was known is no more than expected.
    pub(super) fn doubt(&mut self) {
        *self = Self { before: self.expected(), ..Self::default() };
    }

    /// What a reply is expected to take, from what was known last.
    pub(super) fn expected(&self) -> Duration {
        self.shortest.into_iter().flatten().min().unwrap_or(self.before)
    }

    /// Whether anything is known.
    pub(super) fn is_known(&self) -> bool {
        self.shortest[1].is_some()
    }

    /// Whether one so short is that of another question.
    pub(super) fn is_far_above(&self, round_trip: Duration) -> bool {
        round_trip + CHANCE < self.shortest().mul_f64(0.9)
    }

    /// Zero if nothing is known.
    pub(super) fn shortest(&self) -> Duration {
        self.shortest.into_iter().flatten().min().unwrap_or_default()
    }
}

/// The time for which the link has passed on without a pause what waited for it. When bytes were passed on is told as if
/// all of the round trip lay behind that.
#[derive(Default)]
pub(super) struct Busy {
    since: Duration,
    until: Duration,
    bytes: usize,
}

impl Busy {
    /// Bytes that were sent then have been passed on; how many tell of the rate, and how long those took. Bytes that have
    /// waited behind others tell of it only with them: alone they would seem slower than they were.
    pub(super) fn take(&mut self, sent: Duration, bytes: usize, passed: Duration) -> (usize, Duration) {
        if sent + SHORT >= self.until {
            (self.since, self.bytes) = (sent, 0);
        }
        self.until = passed;
        self.bytes += bytes;
        (self.bytes, passed.saturating_sub(self.since))
    }

    /// When the last byte was passed on that is known of.
    pub(super) fn until(&self) -> Duration {
        self.until
    }
}

/// A rate, and what it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rate {
    pub(super) bytes_per_second: f64,
    /// Whether the link does not deliver more; otherwise nobody has tried yet.
    pub(super) is_limit: bool,
}

/// The rates of the last frames.
#[derive(Default)]
pub(super) struct Rates {
    /// With the time of each.
    rates: VecDeque<(Duration, Rate)>,
    /// The bytes that told the last of them, and how long they took, fading; none if that was not the link's limit.
    last: (f64, Duration),
}

impl Rates {
    /// So many bytes took so long, beside the round trip; if that is late, the rate has fallen, and no higher one holds.
    pub(super) fn take(&mut self, bytes: usize, service: Duration, is_late: bool, now: Duration) {
        let bytes = bytes as f64;
        // Of those before, also after a pause.
        let (best, limit) = (self.best(), self.limit());
        if bytes < best.map_or(TELLING, |best| TELLING.min(best.bytes_per_second / 50.0)) {
            return;
        }
        self.rates.retain(|&(at, _)| now.saturating_sub(at) < RATE_AGE);
        let before = std::mem::take(&mut self.last);
        let rate = if service >= SHORT {
            let (more, longer) = if is_late { Default::default() } else { before };
            let (bytes, service) = (bytes + more, service + longer);
            self.last = (MEMORY * bytes, service.mul_f64(MEMORY));
            let bytes_per_second = bytes / service.as_secs_f64();
            self.rates.retain(|(_, rate)| !is_late || rate.bytes_per_second <= bytes_per_second);
            Rate { bytes_per_second, is_limit: true }
        } else {
            let shown = (bytes / (service + CHANCE).as_secs_f64()).min(2.0 * limit);
            let shown = Rate { bytes_per_second: shown, is_limit: false };
            best.filter(|best| best.bytes_per_second >= shown.bytes_per_second).unwrap_or(shown)
        };
        self.rates.push_back((now, rate));
    }

    /// Round trips may have been taken for those of others: only what seemed slow is believed, if anything did.
    pub(super) fn doubt(&mut self) {
        if self.rates.iter().any(|(_, rate)| rate.is_limit) {
            self.rates.retain(|(_, rate)| rate.is_limit);
        }
    }

    /// The highest that the link did not exceed in the last moments. Not even one that seems faster at once may be: an
    /// answer that nobody asked for makes it seem so, and more than twice the rate would pile up for seconds.
    fn limit(&self) -> f64 {
        let limits = self.rates.iter().filter(|(_, rate)| rate.is_limit).map(|(_, rate)| rate.bytes_per_second);
        limits.reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// The highest of the last moments.
    pub(super) fn best(&self) -> Option<Rate> {
        let rates = self.rates.iter().map(|&(_, rate)| rate);
        rates.max_by(|a, b| a.bytes_per_second.total_cmp(&b.bytes_per_second))
    }
}
