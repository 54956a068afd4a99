//! The order in which the sessions of viewers get CPU time: fair shares of time, not of frames.
//!
//! Start-time fair queueing: a session whose turn took long waits for its next turn until all other sessions have had
//! as much time. So a viewer with a large window, or with a link that makes frames expensive, only lowers its own frame
//! rate. A session that has rested starts level with the others and gets a head start, so that a key press waits for
//! about one round at most. Refinements run only when nothing else is ready. Pure: it reads no clock.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// The number of a session; numbers are never used again.
pub(super) type SessionId = u64;

/// The time by which a session that has rested starts before the queue's virtual time.
///
/// It is about the time of one frame of 80x24 cells. A session with a head start is served before those that take turns
/// all the time. Its share does not grow, because it never starts before the virtual time at which its last turn ended.
const HEAD_START: Duration = Duration::from_millis(1);

/// The kind of work that a session waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum WorkKind {
    /// Input, or a new picture.
    Picture,
    /// More samples for a picture at rest.
    Refinement,
}

/// The state in which a turn leaves its session: ready for another turn, asleep, or ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AfterTurn {
    /// The session is ready for another turn, for this kind of work.
    Turn(WorkKind),
    /// The session sleeps until this time or until it is woken; `None`: only until it is woken.
    Sleep(Option<Duration>),
    /// The visit has ended: the session gets no more turns.
    End,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SessionState {
    Asleep(Option<Duration>),
    Ready(WorkKind, Duration),
    /// The session's turn is being carried out.
    Running {
        /// The virtual time at which the turn started.
        start: Duration,
        /// Whether the session was woken during this turn.
        woken: bool,
    },
}

#[derive(Debug)]
struct QueuedSession {
    /// The virtual time at which the session's last turn ended.
    finish: Duration,
    state: SessionState,
}

/// The sessions that are ready, asleep or running.
#[derive(Debug, Default)]
pub(super) struct RunQueue {
    sessions: BTreeMap<SessionId, QueuedSession>,
    // The ready sessions in the order of their turns: pictures before refinements, then by virtual start. The session's
    // number makes entries unique.
    ready: BTreeSet<(WorkKind, Duration, SessionId)>,
    timers: BTreeSet<(Duration, SessionId)>,
    /// The virtual time of the queue: the latest virtual start of a turn for a picture.
    virtual_time: Duration,
    running: usize,
}

impl RunQueue {
    /// Adds a session, which is ready at once.
    pub(super) fn add(&mut self, id: SessionId) {
        self.sessions.insert(id, QueuedSession { finish: self.virtual_time, state: SessionState::Asleep(None) });
        self.wake(id);
    }

    /// Makes a session ready, because it has input or its bytes have been sent.
    pub(super) fn wake(&mut self, id: SessionId) {
        let Some(session) = self.sessions.get_mut(&id) else { return };
        match session.state {
            SessionState::Running { start, .. } => session.state = SessionState::Running { start, woken: true },
            SessionState::Ready(WorkKind::Picture, _) => {}
            SessionState::Asleep(_) | SessionState::Ready(..) => {
                let rested = self.virtual_time.saturating_sub(HEAD_START);
                let start = session.finish.max(rested);
                self.set(id, SessionState::Ready(WorkKind::Picture, start));
            }
        }
    }

    /// Starts a turn at `now`, and returns its session; `None` if no session is ready.
    ///
    /// The session runs until [`finish`](Self::finish).
    pub(super) fn take(&mut self, now: Duration) -> Option<SessionId> {
        while let Some(&(_, id)) = self.timers.first().filter(|(at, _)| *at <= now) {
            self.wake(id);
        }
        let &(kind, start, id) = self.ready.first()?;
        // Refinements do not advance the virtual time: their virtual start may be far ahead of the pictures', and
        // sessions that have rested would start too late.
        if kind == WorkKind::Picture {
            self.virtual_time = self.virtual_time.max(start);
        }
        self.set(id, SessionState::Running { start, woken: false });
        self.running += 1;
        Some(id)
    }

    /// Ends the turn of a session, which took the CPU time `cost`.
    pub(super) fn finish(&mut self, id: SessionId, cost: Duration, next: AfterTurn) {
        self.running = self.running.saturating_sub(1);
        let Some(session) = self.sessions.get_mut(&id) else { return };
        let SessionState::Running { start, woken } = session.state else { return };
        let finish = start + cost;
        session.finish = finish;
        match next {
            AfterTurn::End => drop(self.sessions.remove(&id)),
            // Input that came during the turn has not been taken, so the session may not sleep.
            _ if woken => self.set(id, SessionState::Ready(WorkKind::Picture, finish)),
            AfterTurn::Turn(kind) => self.set(id, SessionState::Ready(kind, finish)),
            AfterTurn::Sleep(until) => self.set(id, SessionState::Asleep(until)),
        }
    }

    /// Returns the time of the next timer.
    pub(super) fn next_timer(&self) -> Option<Duration> {
        self.timers.first().map(|&(at, _)| at)
    }

    /// Returns the number of sessions that are running or ready for a new picture.
    pub(super) fn load(&self) -> usize {
        self.running + self.ready.range(..(WorkKind::Refinement, Duration::ZERO, 0)).count()
    }

    fn set(&mut self, id: SessionId, state: SessionState) {
        let Some(session) = self.sessions.get_mut(&id) else { return };
        match session.state {
            SessionState::Asleep(Some(at)) => drop(self.timers.remove(&(at, id))),
            SessionState::Ready(kind, start) => drop(self.ready.remove(&(kind, start, id))),
            SessionState::Asleep(None) | SessionState::Running { .. } => {}
        }
        match state {
            SessionState::Asleep(Some(at)) => drop(self.timers.insert((at, id))),
            SessionState::Ready(kind, start) => drop(self.ready.insert((kind, start, id))),
            SessionState::Asleep(None) | SessionState::Running { .. } => {}
        }
        session.state = state;
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
