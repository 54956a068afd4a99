//! A link between a program's terminal and a far terminal, with a delay, a rate and replies.

use crate::pty::{Screen, Session, Start};
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// The query that ends each frame.
const QUERY: &[u8] = b"\x1b[c";
/// The reply of the far terminal: an xterm's.
const REPLY: &[u8] = b"\x1b[?64;1;2;6;9;15;16;17;18;21;22;28c";
/// The number of bytes that the link passes on at once.
const PIECE_BYTES: usize = 64;

/// The properties of a link.
#[derive(Clone, Copy)]
pub(crate) struct Link {
    /// The rate in bytes per second.
    pub(crate) rate: f64,
    /// The way there and back.
    pub(crate) round_trip: Duration,
    /// Whether the far terminal replies to queries.
    pub(crate) answers: bool,
}

/// A frame that has come to the far end.
pub(crate) struct Frame {
    /// The time at which its last byte was sent.
    pub(crate) sent: Duration,
    /// The time at which its last byte arrived.
    pub(crate) at: Duration,
    pub(crate) bytes: usize,
    /// The lowest line of the screen.
    pub(crate) status: String,
}

/// A program at the near end of a link, and a terminal at the far one.
pub(crate) struct Relay {
    pub(crate) session: Session,
    pub(crate) link: Link,
    start: Instant,
    /// The number of bytes that the link has taken from the program.
    taken: usize,
    /// The number of bytes whose queries have replies.
    answered: usize,
    /// The queue of the link: pieces, with the times at which they were sent.
    ///
    /// A piece is passed on at the rate of that time.
    waiting: VecDeque<(Duration, Vec<u8>)>,
    /// The time at which the link is free for the next piece.
    free_at: Duration,
    /// The pieces on their way: arrival, time of sending, bytes.
    there: VecDeque<(Duration, Duration, Vec<u8>)>,
    /// Keys and answers on their way back, and how many bytes each answers.
    back: VecDeque<(Duration, Vec<u8>, usize)>,
    arrived: Vec<u8>,
    screen: Screen,
    /// All frames up to now.
    pub(crate) frames: Vec<Frame>,
    /// The most bytes in flight beyond what may be, since this was last set to zero.
    pub(crate) excess: f64,
}

impl Relay {
    pub(crate) fn start(program: Start, link: Link) -> Self {
        Self {
            session: program.mute().spawn(),
            link,
            start: Instant::now(),
            taken: 0,
            answered: 0,
            waiting: VecDeque::new(),
            free_at: Duration::ZERO,
            there: VecDeque::new(),
            back: VecDeque::new(),
            arrived: Vec::new(),
            screen: Screen::new(80, 24),
            frames: Vec::new(),
            excess: 0.0,
        }
    }

    pub(crate) fn now(&self) -> Duration {
        self.start.elapsed()
    }

    pub(crate) fn since(&self, then: Duration) -> Duration {
        self.now().saturating_sub(then)
    }

    /// Returns the number of bytes that the program has written.
    pub(crate) fn taken(&self) -> usize {
        self.taken
    }

    /// Returns the screen of the far terminal.
    pub(crate) fn screen(&self) -> &Screen {
        &self.screen
    }

    /// A key is pressed at the far end.
    pub(crate) fn press(&mut self, key: &[u8]) {
        let at = self.now() + self.link.round_trip / 2;
        self.back.push_back((at, key.to_vec(), 0));
    }

    /// Passes on until the condition holds; whether it did in time.
    pub(crate) fn run(&mut self, limit: Duration, mut done: impl FnMut(&Self) -> bool) -> bool {
        let deadline = self.now() + limit;
        loop {
            self.take();
            self.pass_on();
            self.arrive();
            self.go_back();
            if done(self) {
                return true;
            }
            let now = self.now();
            if now >= deadline {
                return false;
            }
            // What waits comes no sooner than that; when it has begun is known afterwards too.
            let waiting = self.waiting.front().map(|_| self.free_at + self.link.round_trip / 2);
            let next = [self.there.front().map(|piece| piece.0), waiting, self.back.front().map(|bytes| bytes.0)];
            let next = next.into_iter().flatten().min().unwrap_or(deadline).min(deadline);
            let taken = self.taken;
            self.session.sees(next.saturating_sub(now), |seen| seen.bytes().len() != taken);
        }
    }

    /// Takes what the program has written.
    fn take(&mut self) {
        let now = self.now();
        let bytes = self.session.seen().bytes()[self.taken..].to_vec();
        if bytes.is_empty() {
            return;
        }
        self.waiting.extend(bytes.chunks(PIECE_BYTES).map(|piece| (now, piece.to_vec())));
        self.taken += bytes.len();
        // One frame: a terminal's bytes may come in pieces.
        let may_be = self.link.rate * (self.link.round_trip.as_secs_f64() + 1.0 / 15.0);
        self.excess = self.excess.max((self.taken - self.answered) as f64 - may_be);
    }

    /// Begins with all pieces whose turn has come.
    fn pass_on(&mut self) {
        let now = self.now();
        while self.waiting.front().is_some_and(|piece| self.free_at.max(piece.0) <= now) {
            let Some((sent, piece)) = self.waiting.pop_front() else { break };
            let takes = Duration::from_secs_f64(piece.len() as f64 / self.link.rate);
            self.free_at = self.free_at.max(sent) + takes;
            self.there.push_back((self.free_at + self.link.round_trip / 2, sent, piece));
        }
    }

    fn arrive(&mut self) {
        while self.there.front().is_some_and(|piece| piece.0 <= self.start.elapsed()) {
            let Some((at, sent, piece)) = self.there.pop_front() else { break };
            for byte in piece {
                self.arrived.push(byte);
                if self.arrived.ends_with(QUERY) {
                    let frame = std::mem::take(&mut self.arrived);
                    self.show(&frame, sent, at);
                }
            }
        }
    }

    fn show(&mut self, frame: &[u8], sent: Duration, at: Duration) {
        self.screen.feed(frame);
        if self.link.answers {
            let back = at + self.link.round_trip / 2;
            self.back.push_back((back, REPLY.to_vec(), frame.len()));
            // Keys and answers in the order in which they were sent.
            self.back.make_contiguous().sort_by_key(|bytes| bytes.0);
        }
        if frame.len() > QUERY.len() {
            let status = self.screen.text().pop().unwrap_or_default();
            self.frames.push(Frame { sent, at, bytes: frame.len(), status });
        }
    }

    fn go_back(&mut self) {
        while self.back.front().is_some_and(|bytes| bytes.0 <= self.start.elapsed()) {
            let Some((_, bytes, answers)) = self.back.pop_front() else { break };
            self.session.send(&bytes);
            self.answered += answers;
        }
    }
}
