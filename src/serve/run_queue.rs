//! The order in which seats get CPU time: fair shares of time, not of frames.
//!
//! Start-time fair queueing: a seat whose turn took long waits for its next turn until all other seats have had as much
//! time. So a viewer with a large window, or with a link that makes frames expensive, only lowers its own frame rate. A
//! seat that has rested starts level with the others and gets a head start, so that a key press waits for about one
//! round at most. Refinements run only when nothing else is ready. Pure: it reads no clock.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// The number of a seat; numbers are never used again.
pub(super) type SeatId = u64;

/// The time by which a seat that has rested starts before the queue's virtual time.
///
/// It is about the time of one frame of 80x24 cells. A seat with a head start is served before those that take turns
/// all the time. Its share does not grow, because it never starts before the virtual time at which its last turn ended.
const HEAD_START: Duration = Duration::from_millis(1);

/// The kind of work that a seat waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Class {
    /// Input, or a new picture.
    Picture,
    /// More samples for a picture at rest.
    Refinement,
}

/// The state in which a turn leaves its seat: ready for another turn, asleep, or ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The seat is ready for another turn, for this kind of work.
    Turn(Class),
    /// The seat sleeps until this time or until it is woken; `None`: only until it is woken.
    Sleep(Option<Duration>),
    /// The visit has ended: the seat gets no more turns.
    End,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Asleep(Option<Duration>),
    Ready(Class, Duration),
    /// The seat's turn is being carried out.
    Running {
        /// The virtual time at which the turn started.
        start: Duration,
        /// Whether the seat was woken during this turn.
        woken: bool,
    },
}

#[derive(Debug)]
struct Seat {
    /// The virtual time at which the seat's last turn ended.
    finish: Duration,
    state: State,
}

/// The seats that are ready, asleep or running.
#[derive(Debug, Default)]
pub(super) struct RunQueue {
    seats: BTreeMap<SeatId, Seat>,
    // The ready seats in the order of their turns: pictures before refinements, then by virtual start. The seat's
    // number makes entries unique.
    ready: BTreeSet<(Class, Duration, SeatId)>,
    timers: BTreeSet<(Duration, SeatId)>,
    /// The virtual time of the queue: the latest virtual start of a turn for a picture.
    virtual_time: Duration,
    running: usize,
}

impl RunQueue {
    /// Adds a seat, which is ready at once.
    pub(super) fn add(&mut self, id: SeatId) {
        self.seats.insert(id, Seat { finish: self.virtual_time, state: State::Asleep(None) });
        self.wake(id);
    }

    /// Makes a seat ready, because it has input or its bytes have been sent.
    pub(super) fn wake(&mut self, id: SeatId) {
        let Some(seat) = self.seats.get_mut(&id) else { return };
        match seat.state {
            State::Running { start, .. } => seat.state = State::Running { start, woken: true },
            State::Ready(Class::Picture, _) => {}
            State::Asleep(_) | State::Ready(..) => {
                let rested = self.virtual_time.saturating_sub(HEAD_START);
                let start = seat.finish.max(rested);
                self.set(id, State::Ready(Class::Picture, start));
            }
        }
    }

    /// Returns the seat whose turn it is at `now`, if any; it runs until [`finish`](Self::finish).
    pub(super) fn take(&mut self, now: Duration) -> Option<SeatId> {
        while let Some(&(_, id)) = self.timers.first().filter(|(at, _)| *at <= now) {
            self.wake(id);
        }
        let &(class, start, id) = self.ready.first()?;
        // Refinements do not advance the virtual time: their virtual start may be far ahead of the pictures', and seats
        // that have rested would start too late.
        if class == Class::Picture {
            self.virtual_time = self.virtual_time.max(start);
        }
        self.set(id, State::Running { start, woken: false });
        self.running += 1;
        Some(id)
    }

    /// Ends the turn of a seat, which took the CPU time `cost`.
    pub(super) fn finish(&mut self, id: SeatId, cost: Duration, next: Next) {
        self.running = self.running.saturating_sub(1);
        let Some(seat) = self.seats.get_mut(&id) else { return };
        let State::Running { start, woken } = seat.state else { return };
        let finish = start + cost;
        seat.finish = finish;
        match next {
            Next::End => drop(self.seats.remove(&id)),
            // Input that came during the turn has not been taken, so the seat may not sleep.
            _ if woken => self.set(id, State::Ready(Class::Picture, finish)),
            Next::Turn(class) => self.set(id, State::Ready(class, finish)),
            Next::Sleep(until) => self.set(id, State::Asleep(until)),
        }
    }

    /// Returns the time of the next timer.
    pub(super) fn next_timer(&self) -> Option<Duration> {
        self.timers.first().map(|&(at, _)| at)
    }

    /// Returns the number of seats that are running or ready for a new picture.
    pub(super) fn load(&self) -> usize {
        self.running + self.ready.range(..(Class::Refinement, Duration::ZERO, 0)).count()
    }

    /// Returns the number of seats.
    pub(super) fn len(&self) -> usize {
        self.seats.len()
    }

    fn set(&mut self, id: SeatId, state: State) {
        let Some(seat) = self.seats.get_mut(&id) else { return };
        match seat.state {
            State::Asleep(Some(at)) => drop(self.timers.remove(&(at, id))),
            State::Ready(class, start) => drop(self.ready.remove(&(class, start, id))),
            State::Asleep(None) | State::Running { .. } => {}
        }
        match state {
            State::Asleep(Some(at)) => drop(self.timers.insert((at, id))),
            State::Ready(class, start) => drop(self.ready.insert((class, start, id))),
            State::Asleep(None) | State::Running { .. } => {}
        }
        seat.state = state;
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
