//! The limits on connections and viewers, in total and from one address.
//!
//! Pure: the time is a parameter.

use std::collections::{HashMap, VecDeque};
use std::net::IpAddr;
use std::time::Duration;

/// The largest number of connections that have not logged in yet.
// A handshake costs 0.3 to 0.36 ms of CPU time, and a silent connection keeps its place for the whole login time.
const MAX_LOGGING_IN: usize = 64;
/// The largest number of connections from one address that have not logged in yet.
// One address must not take all of `MAX_LOGGING_IN`.
const MAX_LOGGING_IN_PER_ADDRESS: usize = 8;
/// Burst size of a token bucket of new connections per address; each [`REFILL_TIME`] adds a token.
const BURST: f64 = 20.0;
const REFILL_TIME: Duration = Duration::from_millis(200);
/// The largest number of addresses that a [`ConnectionLimiter`] remembers.
///
/// All others share one allowance, so that an attacker with many addresses does not make the table grow.
const MAX_REMEMBERED: usize = 10_000;

/// The addresses that are counted as one client: an IPv4 address, or a /64 network of IPv6.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Origin {
    V4([u8; 4]),
    // A client in an IPv6 network can use any of its 2^64 addresses.
    V6([u8; 8]),
    /// All addresses beyond [`MAX_REMEMBERED`], counted together.
    Others,
}

impl Origin {
    fn of(address: IpAddr) -> Self {
        match address.to_canonical() {
            IpAddr::V4(address) => Self::V4(address.octets()),
            IpAddr::V6(address) => {
                let [a, b, c, d, e, f, g, h, ..] = address.octets();
                Self::V6([a, b, c, d, e, f, g, h])
            }
        }
    }
}

/// Returns the network of an address, which does not identify a user, for logs: `192.0.2.0/24`.
pub(super) fn anonymized(address: IpAddr) -> String {
    match Origin::of(address) {
        Origin::V4([a, b, c, _]) => format!("{a}.{b}.{c}.0/24"),
        Origin::V6([a, b, c, d, e, f, ..]) => {
            let group = |high, low| u16::from_be_bytes([high, low]);
            format!("{:x}:{:x}:{:x}::/48", group(a, b), group(c, d), group(e, f))
        }
        Origin::Others => String::new(),
    }
}

/// The connections from one origin, and its allowance: the tokens left for new connections.
#[derive(Clone, Copy, Debug)]
struct OriginCounts {
    connected: usize,
    logging_in: usize,
    allowance: f64,
    seen: Duration,
}

/// The reason why a connection is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// The server has too many connections, in total or logging in.
    Busy,
    /// This address has too many connections, in total or logging in.
    Address,
    /// Too many new connections from this address in a short time.
    Rate,
    /// A load balancer sent no header with the address of its client.
    Header,
}

impl Refusal {
    /// Returns the name of the reason in the log and the counts.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Busy => "busy",
            Self::Address => "address",
            Self::Rate => "rate",
            Self::Header => "header",
        }
    }
}

/// A connection that the [`ConnectionLimiter`] has admitted and counts.
#[derive(Debug)]
pub(super) struct Admission {
    origin: Origin,
    logging_in: bool,
}

/// The counts of connections, in total and by origin, by which new ones are admitted or refused.
#[derive(Debug)]
pub(super) struct ConnectionLimiter {
    per_address: usize,
    total: usize,
    connected: usize,
    logging_in: usize,
    origins: HashMap<Origin, OriginCounts>,
}

impl ConnectionLimiter {
    /// Returns a limiter of `total` connections, and of `per_address` from one address.
    pub(super) fn new(total: usize, per_address: usize) -> Self {
        Self { per_address, total, connected: 0, logging_in: 0, origins: HashMap::new() }
    }

    /// Replaces the limits. Connections above them stay.
    pub(super) fn set_limits(&mut self, total: usize, per_address: usize) {
        (self.total, self.per_address) = (total, per_address);
    }

    /// Admits and counts a new connection, or returns the reason to refuse it.
    pub(super) fn enter(&mut self, address: IpAddr, now: Duration) -> Result<Admission, Refusal> {
        // A high `per_address` raises the limits on logins too, so that one machine can run a load test.
        let most_logging_in = MAX_LOGGING_IN_PER_ADDRESS.max(self.per_address / 2);
        if self.connected >= self.total || self.logging_in >= MAX_LOGGING_IN.max(self.per_address / 2) {
            return Err(Refusal::Busy);
        }
        let origin = self.remembered_or_others(Origin::of(address), now);
        let burst = BURST.max(self.per_address as f64);
        let counts = self.origins.entry(origin).or_insert(OriginCounts {
            connected: 0,
            logging_in: 0,
            allowance: burst,
            seen: now,
        });
        let refilled = now.saturating_sub(counts.seen).as_secs_f64() / REFILL_TIME.as_secs_f64();
        counts.allowance = (counts.allowance + refilled).min(burst);
        counts.seen = now;
        if counts.connected >= self.per_address || counts.logging_in >= most_logging_in {
            return Err(Refusal::Address);
        }
        if counts.allowance < 1.0 {
            return Err(Refusal::Rate);
        }
        counts.allowance -= 1.0;
        counts.connected += 1;
        counts.logging_in += 1;
        self.connected += 1;
        self.logging_in += 1;
        Ok(Admission { origin, logging_in: true })
    }

    /// Records that a connection has logged in.
    pub(super) fn log_in(&mut self, entry: &mut Admission) {
        if std::mem::take(&mut entry.logging_in) {
            self.logging_in -= 1;
            if let Some(counts) = self.origins.get_mut(&entry.origin) {
                counts.logging_in -= 1;
            }
        }
    }

    /// Records that a connection has ended.
    pub(super) fn leave(&mut self, mut entry: Admission) {
        self.log_in(&mut entry);
        self.connected -= 1;
        if let Some(counts) = self.origins.get_mut(&entry.origin) {
            counts.connected -= 1;
        }
    }

    /// Returns `origin`, or [`Origin::Others`] if it is new and there is no room for another one.
    fn remembered_or_others(&mut self, origin: Origin, now: Duration) -> Origin {
        if self.origins.len() >= MAX_REMEMBERED && !self.origins.contains_key(&origin) {
            // An origin not seen for the duration `refilled` has its full allowance again, so forgetting the origin
            // changes nothing.
            let refilled = REFILL_TIME * BURST as u32;
            self.origins.retain(|_, counts| counts.connected > 0 || counts.seen + refilled > now);
            if self.origins.len() >= MAX_REMEMBERED {
                return Origin::Others;
            }
        }
        origin
    }
}

/// The places for viewers, and the visitors who wait for a place, in the order of their arrival.
#[derive(Debug)]
pub(super) struct Places {
    most: usize,
    taken: usize,
    waiting: VecDeque<u64>,
    next: u64,
}

impl Places {
    /// Returns the places for `most` viewers, all of them free.
    pub(super) fn new(most: usize) -> Self {
        Self { most, taken: 0, waiting: VecDeque::new(), next: 0 }
    }

    /// Sets the number of places. Viewers above it stay.
    pub(super) fn set_most(&mut self, most: usize) {
        self.most = most;
    }

    /// Adds a visitor to the end of the queue, and returns its number; `None` if too many wait.
    pub(super) fn join(&mut self) -> Option<u64> {
        // Each waiting client costs a connection, and each freed place wakes all of them.
        if self.waiting.len() >= self.most.max(16) {
            return None;
        }
        self.next += 1;
        self.waiting.push_back(self.next);
        Some(self.next)
    }

    /// Takes a place if one is free for this visitor; otherwise returns how many visitors are
    /// ahead.
    pub(super) fn take(&mut self, visitor: u64) -> Result<(), usize> {
        // A linear search is enough, because the length of the queue is limited.
        let ahead = self.waiting.iter().position(|&waiting| waiting == visitor).unwrap_or(0);
        if self.taken + ahead >= self.most {
            return Err(ahead);
        }
        self.give_up(visitor);
        self.taken += 1;
        Ok(())
    }

    /// Returns the number of visitors in the queue.
    pub(super) fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Removes a visitor from the queue.
    pub(super) fn give_up(&mut self, visitor: u64) {
        self.waiting.retain(|&waiting| waiting != visitor);
    }

    /// Frees a place.
    pub(super) fn free(&mut self) {
        self.taken = self.taken.saturating_sub(1);
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
