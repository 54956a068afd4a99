//! The counts of what the server does, for an operator: `--metrics`, in the text format of Prometheus.
//!
//! No label has an address or a name of a user.

use super::house::House;
use super::limits::Refusal;
use std::fmt::Write;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{sleep, timeout};

/// The longest time that a request for the counts may take.
const REQUEST_TIME: Duration = Duration::from_secs(2);
/// The most bytes of a request.
const MAX_REQUEST: usize = 8 * 1024;

/// A count that only grows.
#[derive(Debug, Default)]
pub(super) struct Count(AtomicU64);

impl Count {
    pub(super) fn add(&self, more: u64) {
        self.0.fetch_add(more, Ordering::Relaxed);
    }

    fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// The counts since the start of the server.
#[derive(Debug, Default)]
pub(super) struct Metrics {
    pub(super) connections: Count,
    pub(super) logins: Count,
    /// The refused connections, by [`Refusal`].
    refused: [Count; 3],
    pub(super) visits: Count,
    pub(super) frames: Count,
    pub(super) bytes: Count,
    /// The pictures that were traced.
    pub(super) traced: Count,
    /// The pictures that had been traced for another viewer.
    pub(super) shared: Count,
    /// The turns that ended with a panic.
    pub(super) panics: Count,
    /// The CPU time of all turns, in microseconds.
    pub(super) turn_micros: Count,
}

impl Metrics {
    pub(super) fn refuse(&self, refusal: Refusal) {
        self.refused[refusal as usize].add(1);
    }

    /// Returns the counts as text, after the current values of `gauges`: name, meaning, value.
    pub(super) fn text(&self, gauges: &[(&str, &str, usize)]) -> String {
        let mut text = String::new();
        for (name, meaning, value) in gauges {
            let _ = writeln!(text, "# HELP termtrace_{name} {meaning}.\n# TYPE termtrace_{name} gauge");
            let _ = writeln!(text, "termtrace_{name} {value}");
        }
        let mut sum = |name: &str, meaning: &str, rows: &[(&str, &Count)]| {
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
        let [busy, address, rate] = &self.refused;
        let reasons = [("{reason=\"busy\"}", busy), ("{reason=\"address\"}", address), ("{reason=\"rate\"}", rate)];
        sum("connections_total", "Connections that were accepted", &[("", &self.connections)]);
        sum("refused_total", "Connections that were refused", &reasons);
        sum("logins_total", "Connections that have logged in", &[("", &self.logins)]);
        sum("visits_total", "Views that were opened", &[("", &self.visits)]);
        sum("frames_total", "Frames that were drawn", &[("", &self.frames)]);
        sum("sent_bytes_total", "Bytes for terminals, before encryption", &[("", &self.bytes)]);
        let pictures = [("{from=\"tracer\"}", &self.traced), ("{from=\"memory\"}", &self.shared)];
        sum("pictures_total", "Pictures, traced or of another viewer", &pictures);
        sum("panics_total", "Views that a fault of the server ended", &[("", &self.panics)]);
        sum("turn_cpu_seconds_total", "CPU time of tracing and drawing", &[("", &self.turn_micros)]);
        text
    }
}

/// Answers requests for the counts, one after the other.
pub(super) async fn serve(house: Arc<House>, listener: TcpListener) {
    loop {
        match listener.accept().await {
            Ok((stream, _)) => drop(timeout(REQUEST_TIME, answer(&stream, &house)).await),
            Err(_) => sleep(super::ACCEPT_PAUSE).await,
        }
    }
}

/// Answers one request, whatever it asks for.
async fn answer(stream: &TcpStream, house: &House) -> io::Result<()> {
    let (mut request, mut part) = (Vec::new(), [0; 1024]);
    while !request.windows(4).any(|end| end == b"\r\n\r\n") {
        stream.readable().await?;
        match stream.try_read(&mut part) {
            Ok(0) => return Ok(()),
            Ok(count) => request.extend_from_slice(&part[..count]),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(error),
        }
        if request.len() > MAX_REQUEST {
            return Ok(());
        }
    }
    let text = house.metrics_text();
    let head = "HTTP/1.1 200 OK\r\nContent-Type: text/plain; version=0.0.4\r\nConnection: close";
    let response = format!("{head}\r\nContent-Length: {}\r\n\r\n{text}", text.len());
    let mut rest = response.as_bytes();
    while !rest.is_empty() {
        stream.writable().await?;
        match stream.try_write(rest) {
            Ok(count) => rest = &rest[count..],
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
