//! The threads that draw for all viewers, and share their time fairly among them.
//!
//! A turn is carried out by one thread from the input to the bytes: passing a frame of 0.1 ms to another thread would
//! take as long as tracing it. Each thread is a rayon pool of its own, so that parallel functions stay on that thread.

use super::line::{Line, locked};
use super::metrics::Metrics;
use super::pictures::{Pictures, is_shared};
use super::run_queue::{Class, Next, RunQueue, SeatId};
use super::seat::{Arrived, Seat};
use crate::app::Tracer;
use crate::progress::Cancellation;
use crate::viewer::{FIRST_FRAME_MOTION, Frame, Job};
use std::collections::HashMap;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// A seat, and the buffers between it and its connection.
struct Staged {
    seat: Mutex<Seat>,
    line: Arc<Line>,
}

#[derive(Default)]
struct Shared {
    queue: RunQueue,
    seats: HashMap<SeatId, Arc<Staged>>,
    next_id: SeatId,
    /// The number of threads that wait for work.
    resting: usize,
    /// The token that cancels the refinements in progress; it is replaced when it is used.
    refinements: Cancellation,
    /// Whether the threads should end.
    closed: bool,
}

/// The seats, and the threads that serve them.
pub(super) struct Stage {
    shared: Mutex<Shared>,
    ready: Condvar,
    start: Instant,
    threads: usize,
    pub(super) metrics: Metrics,
    /// The cache of pictures that several viewers see.
    pictures: Mutex<Pictures>,
    /// The byte of input at which a turn panics, for a test.
    #[cfg(feature = "test-hooks")]
    pub(super) panics: std::sync::OnceLock<u8>,
}

impl Stage {
    /// Starts `threads` threads that carry out the turns of seats, and returns the stage with their
    /// handles.
    pub(super) fn start(threads: usize) -> io::Result<(Arc<Self>, Vec<JoinHandle<()>>)> {
        let stage = Arc::new(Self {
            shared: Mutex::default(),
            ready: Condvar::new(),
            start: Instant::now(),
            threads,
            metrics: Metrics::default(),
            pictures: Mutex::default(),
            #[cfg(feature = "test-hooks")]
            panics: std::sync::OnceLock::new(),
        });
        let start_thread = |index| {
            let stage = Arc::clone(&stage);
            thread::Builder::new().name(format!("stage {index}")).spawn(move || stage.serve())
        };
        let threads = (0..threads).map(start_thread).collect::<io::Result<_>>()?;
        Ok((stage, threads))
    }

    /// Returns the time of all viewers' clock.
    ///
    /// It starts at `FIRST_FRAME_MOTION` instead of 0, because a key counts as held for that time before its press.
    pub(super) fn now(&self) -> Duration {
        FIRST_FRAME_MOTION + self.start.elapsed()
    }

    /// Adds a seat.
    pub(super) fn add(&self, seat: Seat, line: Arc<Line>) -> SeatId {
        let mut shared = locked(&self.shared);
        let id = shared.next_id;
        shared.next_id += 1;
        shared.seats.insert(id, Arc::new(Staged { seat: Mutex::new(seat), line }));
        shared.queue.add(id);
        self.metrics.visits.add(1);
        self.rouse(&mut shared);
        id
    }

    /// Makes a seat ready, because it has input or its bytes have been sent.
    pub(super) fn wake(&self, id: SeatId) {
        let mut shared = locked(&self.shared);
        shared.queue.wake(id);
        self.rouse(&mut shared);
    }

    /// Tells all seats the time at which the server ends.
    pub(super) fn drain(&self, at: Duration) {
        let mut shared = locked(&self.shared);
        let ids: Vec<_> = shared.seats.iter().map(|(&id, staged)| (staged.line.drain(at), id).1).collect();
        for id in ids {
            shared.queue.wake(id);
        }
        self.ready.notify_all();
    }

    /// Returns the number of seats.
    pub(super) fn seat_count(&self) -> usize {
        locked(&self.shared).queue.len()
    }

    /// Ends the threads.
    pub(super) fn close(&self) {
        locked(&self.shared).closed = true;
        self.ready.notify_all();
    }

    /// Wakes a resting thread; if there is none, interrupts the refinements.
    fn rouse(&self, shared: &mut Shared) {
        if shared.resting > 0 {
            self.ready.notify_one();
        } else {
            std::mem::take(&mut shared.refinements).cancel();
        }
    }

    /// Carries out the turns of seats, one after the other, until the stage is closed.
    fn serve(&self) {
        // Makes this thread a rayon pool. Without it, each `rayon::join` would run on the global pool.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
        let mut tracer = Tracer::default();
        while let Some((id, staged, load, token)) = self.next_turn() {
            // CPU time, because on a busy machine the elapsed time would charge a seat for the turns of others.
            let started = cpu_time();
            let mut turn = || self.take_turn(&staged, load, &token, &mut tracer);
            let turned = catch_unwind(AssertUnwindSafe(|| match &pool {
                Ok(pool) => pool.install(&mut turn),
                Err(_) => turn(),
            }));
            let next = turned.unwrap_or_else(|_| {
                // The panic hook has already printed the message. Only this viewer ends, with a clean terminal. The
                // tracer is replaced, because the panic may have left it in an invalid state.
                tracer = Tracer::default();
                self.metrics.panics.add(1);
                let mut out = Vec::new();
                locked(&staged.seat).abandon(&mut out);
                staged.line.send(out, Some(1));
                Next::End
            });
            let cost = cpu_time().saturating_sub(started);
            self.metrics.turn_micros.add(u64::try_from(cost.as_micros()).unwrap_or(0));
            let mut shared = locked(&self.shared);
            shared.queue.finish(id, cost, next);
            if next == Next::End {
                shared.seats.remove(&id);
            }
        }
    }

    /// Waits for the next turn, and returns its seat, the load, and the token that cancels
    /// refinements.
    ///
    /// The load is the number of seats that run or are ready for a picture. `None` if the stage is closed.
    fn next_turn(&self) -> Option<(SeatId, Arc<Staged>, usize, Cancellation)> {
        let mut shared = locked(&self.shared);
        loop {
            if shared.closed {
                return None;
            }
            let now = self.now();
            if let Some(id) = shared.queue.take(now) {
                let (load, token) = (shared.queue.load(), shared.refinements.clone());
                if let Some(staged) = shared.seats.get(&id) {
                    return Some((id, Arc::clone(staged), load, token));
                }
                shared.queue.finish(id, Duration::ZERO, Next::End);
                continue;
            }
            shared.resting += 1;
            let timeout = shared.queue.next_timer().map(|at| at.saturating_sub(now));
            shared = match timeout {
                Some(timeout) => self.ready.wait_timeout(shared, timeout).unwrap_or_else(PoisonError::into_inner).0,
                None => self.ready.wait(shared).unwrap_or_else(PoisonError::into_inner),
            };
            shared.resting -= 1;
        }
    }

    fn take_turn(&self, staged: &Staged, load: usize, token: &Cancellation, tracer: &mut Tracer) -> Next {
        let line = &staged.line;
        if line.is_hung_up() {
            return Next::End;
        }
        let mut seat = locked(&staged.seat);
        let share = (load as f64 / self.threads as f64).max(1.0);
        // The first picture of a visit is never interrupted, because the screen is empty until it is drawn.
        let never = Cancellation::default();
        let mut trace = |job: &Job, may_interrupt: bool| -> Option<Frame> {
            let token = if may_interrupt { token } else { &never };
            let mut frame = self.picture(job, token, tracer)?;
            // The trace time is scaled up if there are more seats than threads, because the viewer chooses the number
            // of samples by that time.
            frame.trace = frame.trace.mul_f64(share);
            Some(frame)
        };
        let mut out = Vec::new();
        let arrived: Arrived = line.take_arrived();
        #[cfg(feature = "test-hooks")]
        assert!(
            !self.panics.get().is_some_and(|key| arrived.bytes.contains(key)),
            "a test asked for a panic in a seat"
        );
        // If every ready seat has a thread, the turn may refine: that delays no picture of another viewer.
        let class = if load <= self.threads { Class::Refinement } else { Class::Picture };
        let next = seat.take_turn(&arrived, (line.is_sending(), class), &|| self.now(), &mut trace, &mut out);
        self.metrics.frames.add(seat.take_drawn());
        line.send(out, (next == Next::End).then_some(0));
        next
    }

    /// Returns the picture of a job, or `None` if it is cancelled.
    ///
    /// The picture may have been traced for another viewer.
    fn picture(&self, job: &Job, token: &Cancellation, tracer: &mut Tracer) -> Option<Frame> {
        let is_shared = is_shared(job);
        if is_shared && let Some(kept) = locked(&self.pictures).get(job) {
            self.metrics.shared.add(1);
            return Some(Frame { shot: job.shot, refines: job.refines, ..Frame::clone(&kept) });
        }
        let frame = tracer.trace_for_any(job, token).ok()?;
        self.metrics.traced.add(1);
        if is_shared {
            locked(&self.pictures).keep(Arc::new(frame.clone()));
        }
        Some(frame)
    }
}

/// Returns the CPU time of this thread.
fn cpu_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.try_into().unwrap_or(0), time.tv_nsec.try_into().unwrap_or(0))
}
