//! The terminal's replies to the child's queries, and their faults on the way.

use super::Modes;
use std::time::{Duration, Instant};

/// The query that every terminal answers.
const DA1: &[u8] = b"\x1b[c";

/// The query for the flags of the kitty keyboard protocol.
const KEYBOARD: &[u8] = b"\x1b[?u";

/// A fault of a reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// The reply never comes.
    Lost,
    /// The reply comes twice.
    Doubled,
    /// A reply to another query comes in its place.
    Garbled,
    /// The reply comes this much later than the replies behind it.
    Late(Duration),
}

/// Which replies have a fault, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Which {
    /// One reply.
    Only(usize),
    /// This reply and each third after it.
    EachThirdFrom(usize),
}

impl Which {
    fn includes(self, reply: usize) -> bool {
        match self {
            Self::Only(only) => reply == only,
            Self::EachThirdFrom(first) => reply >= first && (reply - first).is_multiple_of(3),
        }
    }
}

/// The queries that the terminal answers, and its replies.
pub(super) struct Replies {
    /// The byte of the output from which on queries have no reply; `None` if none are answered.
    pub(super) unanswered: Option<usize>,
    pub(super) kitty: bool,
    /// Whether the terminal reports modes (DECRQM), none of which it knows.
    pub(super) modes: bool,
    pub(super) fault: Option<(Fault, Which)>,
    /// The number of replies to DA1 and about modes that were due.
    pub(super) count: usize,
    late: Vec<(Instant, Vec<u8>)>,
}

impl Default for Replies {
    fn default() -> Self {
        Self { unanswered: Some(0), kitty: false, modes: false, fault: None, count: 0, late: Vec::new() }
    }
}

impl Replies {
    /// Returns the replies to the queries in the output that have none yet, and the late ones that
    /// are due.
    pub(super) fn to(&mut self, output: &[u8]) -> Vec<u8> {
        let mut replies = self.take_due(Instant::now());
        let Some(from) = self.unanswered else { return replies };
        let mut unanswered = from;
        for at in from..output.len() {
            let rest = &output[at..];
            if rest.starts_with(DA1) {
                unanswered = at + DA1.len();
                self.reply(b"\x1b[?62;22c".to_vec(), &mut replies);
            } else if self.kitty && rest.starts_with(KEYBOARD) {
                unanswered = at + KEYBOARD.len();
                let flags = Modes::after(&output[..at]).keyboard_flags();
                replies.extend_from_slice(format!("\x1b[?{flags}u").as_bytes());
            } else if let Some(mode) = self.modes.then(|| mode_asked_for(rest)).flatten() {
                unanswered = at + mode.len() + 5;
                self.reply([b"\x1b[?", mode, b";0$y"].concat(), &mut replies);
            }
        }
        self.unanswered = Some(unanswered);
        replies
    }

    fn reply(&mut self, reply: Vec<u8>, replies: &mut Vec<u8>) {
        self.count += 1;
        let fault = self.fault.filter(|(_, which)| which.includes(self.count)).map(|(fault, _)| fault);
        match fault {
            None => replies.extend(reply),
            Some(Fault::Lost) => {}
            Some(Fault::Doubled) => replies.extend(reply.repeat(2)),
            Some(Fault::Garbled) => replies.extend_from_slice(b"\x1b[?7;1$y"),
            Some(Fault::Late(late)) => self.late.push((Instant::now() + late, reply)),
        }
    }

    fn take_due(&mut self, now: Instant) -> Vec<u8> {
        self.late.extract_if(.., |(due, _)| *due <= now).flat_map(|(_, reply)| reply).collect()
    }

    /// Returns when the next late reply is due, if there is one.
    pub(super) fn next_due(&self) -> Option<Instant> {
        self.late.iter().map(|(due, _)| *due).min()
    }
}

/// Returns the digits of the private mode that a query (DECRQM) at the start of these bytes has.
fn mode_asked_for(bytes: &[u8]) -> Option<&[u8]> {
    let digits = bytes.strip_prefix(b"\x1b[?")?;
    let end = digits.iter().position(|byte| !byte.is_ascii_digit())?;
    digits[end..].starts_with(b"$p").then_some(&digits[..end])
}
