//! Counts of connections, refusals, views, frames and bytes, for an operator.
//!
//! No label contains an address or the name of a user.

use super::limits::Refusal;
use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};

/// A count that only grows.
#[derive(Debug, Default)]
pub(super) struct Counter(AtomicU64);

impl Counter {
    pub(super) fn add(&self, more: u64) {
        self.0.fetch_add(more, Ordering::Relaxed);
    }

    pub(super) fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// The counts since the start of the server.
#[derive(Debug, Default)]
pub(super) struct Metrics {
    pub(super) connections: Counter,
    pub(super) logins: Counter,
    /// The refused connections, by [`Refusal`].
    refused: [Counter; 4],
    pub(super) visits: Counter,
    pub(super) frames: Counter,
    pub(super) bytes: Counter,
    /// The frames of the tour that were drawn, once for each audience.
    pub(super) tour_drawn: Counter,
    /// The frames of the tour that were sent, once for each follower.
    pub(super) tour_sent: Counter,
    /// The pictures that were traced.
    pub(super) traced: Counter,
    /// The pictures that were reused because they had been traced for another viewer.
    pub(super) shared: Counter,
    /// The turns that ended with a panic.
    pub(super) panics: Counter,
    /// The CPU time of all turns, in microseconds.
    pub(super) turn_micros: Counter,
}

impl Metrics {
    pub(super) fn refuse(&self, refusal: Refusal) {
        self.refused[refusal as usize].add(1);
    }

    /// Returns the counts in the text format of Prometheus, after `gauges`.
    ///
    /// A gauge is a name, a meaning and the current value.
    pub(super) fn text(&self, gauges: &[(&str, &str, usize)]) -> String {
        let mut text = String::new();
        for (name, meaning, value) in gauges {
            let _ = writeln!(text, "# HELP termtrace_{name} {meaning}.\n# TYPE termtrace_{name} gauge");
            let _ = writeln!(text, "termtrace_{name} {value}");
        }
        let mut sum = |name: &str, meaning: &str, rows: &[(&str, &Counter)]| {
            let _ = writeln!(text, "# HELP termtrace_{name} {meaning}.\n# TYPE termtrace_{name} counter");
            for (label, count) in rows {
                let _ = match count.get() {
                    micros if name.ends_with("seconds_total") => {
                        writeln!(text, "termtrace_{name}{label} {}", micros as f64 / 1e6)
                    }
                    count => writeln!(text, "termtrace_{name}{label} {count}"),
                };
            }
        };
        let [busy, address, rate, header] = &self.refused;
        let reasons = [
            ("{reason=\"busy\"}", busy),
            ("{reason=\"address\"}", address),
            ("{reason=\"rate\"}", rate),
            ("{reason=\"header\"}", header),
        ];
        sum("connections_total", "Connections that were accepted", &[("", &self.connections)]);
        sum("refused_total", "Connections that were refused", &reasons);
        sum("logins_total", "Connections that have logged in", &[("", &self.logins)]);
        sum("visits_total", "Views that were opened", &[("", &self.visits)]);
        sum("frames_total", "Frames that were drawn", &[("", &self.frames)]);
        sum("sent_bytes_total", "Bytes for terminals, before encryption", &[("", &self.bytes)]);
        let tour = [("{at=\"drawn\"}", &self.tour_drawn), ("{at=\"sent\"}", &self.tour_sent)];
        sum("tour_frames_total", "Frames of the tour: drawn for an audience, and sent to followers", &tour);
        let pictures = [("{from=\"tracer\"}", &self.traced), ("{from=\"memory\"}", &self.shared)];
        sum("pictures_total", "Pictures, traced or of another viewer", &pictures);
        sum("panics_total", "Views that a fault of the server ended", &[("", &self.panics)]);
        sum("turn_cpu_seconds_total", "CPU time of tracing and drawing", &[("", &self.turn_micros)]);
        text
    }
}
