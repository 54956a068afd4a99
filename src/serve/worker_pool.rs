//! The threads that draw for all viewers, and share their time fairly among them.
//!
//! A turn is carried out by one thread from the input to the bytes: passing a frame of 0.1 ms to another thread would
//! take as long as tracing it. Each thread is a rayon pool of its own, so that parallel functions stay on that thread.

use super::HostedScene;
use super::audience::{Audience, Drawing, Follower, GuideLine};
use super::frame_window::FrameWindow;
use super::leave_reason::LeaveReason;
use super::lock::locked;
use super::metrics::Metrics;
use super::pictures::{Pictures, is_worth_sharing};
use super::roster::Roster;
use super::run_queue::{AfterTurn, RunQueue, SessionId, WorkKind};
use super::session_buffers::{ScreenSource, SessionBuffers};
use super::tour::{AudienceClass, AudienceLimits, Tour};
use super::viewer_session::{AudienceChange, Company, PendingInput, ViewerSession};
use crate::app::Tracer;
use crate::grid::{Grid, Size};
use crate::progress::Cancellation;
use crate::viewer::{FIRST_FRAME_MOTION, Frame, Job, TRACING_SHARE};
use std::collections::HashMap;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The time for which an audience rests after a panic.
const AFTER_PANIC: Duration = Duration::from_secs(1);

/// The niceness of the threads that draw, on systems where each thread has its own.
///
/// The thread of the sockets then runs as soon as it has something to do. Without it, 200 moving views on two cores
/// delayed frames and replies by up to 20 ms, which was taken for the time of the links, and 408 to 602 viewers a
/// second could connect, instead of 620 to 930.
#[cfg(target_os = "linux")]
const WORKER_NICENESS: i32 = 5;

/// A session, and the buffers between it and its connection.
struct PooledSession {
    id: SessionId,
    session: Mutex<ViewerSession>,
    buffers: Arc<SessionBuffers>,
    /// The CPU time of the last frame without tracing, in microseconds.
    untraced_micros: AtomicU64,
}

/// An audience, and the drawing of its frames.
struct PooledAudience {
    audience: Audience,
    drawing: Mutex<Drawing>,
}

/// The owner of a turn.
#[derive(Clone)]
enum TurnOwner {
    Session(Arc<PooledSession>),
    Audience(Arc<PooledAudience>),
}

/// The number of sessions that share the threads.
#[derive(Clone, Copy)]
struct Load {
    /// Those that run or are ready for a picture.
    pending: usize,
    /// Those that drew a frame lately.
    drawing: usize,
}

impl Load {
    /// Returns the number of sessions that share one of `threads`, at least 1.
    ///
    /// Between two frames of a session that draws all the time, each of the others has had as much time.
    fn per_thread(self, threads: usize) -> f64 {
        (self.pending.max(self.drawing) as f64 / threads as f64).max(1.0)
    }
}

#[derive(Default)]
struct PoolState {
    queue: RunQueue,
    /// The frames that sessions drew lately.
    frames: FrameWindow,
    sessions: HashMap<SessionId, Arc<PooledSession>>,
    /// The audiences, whose numbers are those of no session.
    audiences: HashMap<SessionId, Arc<PooledAudience>>,
    tour: Option<Arc<Tour>>,
    limits: AudienceLimits,
    next_id: SessionId,
    /// The number of audiences so far, whose numbers are counted from the largest one down.
    audience_count: u64,
    /// The number of threads that wait for work.
    resting: usize,
    /// The token that cancels the refinements in progress; it is replaced when it is used.
    refinements: Cancellation,
    /// Whether the threads should end.
    closed: bool,
}

/// The sessions, and the threads that serve them.
pub(super) struct WorkerPool {
    state: Mutex<PoolState>,
    ready: Condvar,
    start: Instant,
    threads: usize,
    pub(super) metrics: Metrics,
    /// The viewers as they see one another.
    pub(super) roster: Roster,
    /// The cache of pictures that several viewers see.
    pictures: Mutex<Pictures>,
    tracer: Tracer,
    /// The byte of input at which a turn panics, for a test.
    #[cfg(feature = "test-hooks")]
    pub(super) panics: std::sync::OnceLock<u8>,
}

impl WorkerPool {
    /// Starts `threads` threads that carry out the turns of sessions.
    ///
    /// Returns the pool and the handles of the threads.
    pub(super) fn start(threads: usize) -> io::Result<(Arc<Self>, Vec<JoinHandle<()>>)> {
        let pool = Arc::new(Self {
            state: Mutex::default(),
            ready: Condvar::new(),
            start: Instant::now(),
            threads,
            metrics: Metrics::default(),
            roster: Roster::default(),
            pictures: Mutex::default(),
            tracer: Tracer::new(threads),
            #[cfg(feature = "test-hooks")]
            panics: std::sync::OnceLock::new(),
        });
        let start_thread = |index| {
            let pool = Arc::clone(&pool);
            thread::Builder::new().name(format!("worker {index}")).spawn(move || pool.serve())
        };
        let threads = (0..threads).map(start_thread).collect::<io::Result<_>>()?;
        Ok((pool, threads))
    }

    /// Returns the time of all viewers' clock.
    ///
    /// It starts at `FIRST_FRAME_MOTION` instead of 0, because a key counts as held for that time before its press.
    pub(super) fn now(&self) -> Duration {
        FIRST_FRAME_MOTION + self.start.elapsed()
    }

    /// Adds a session, of a viewer with this login name if the server shows names.
    pub(super) fn add(
        &self,
        mut session: ViewerSession,
        buffers: Arc<SessionBuffers>,
        name: Option<Arc<str>>,
    ) -> SessionId {
        let id = {
            let mut state = locked(&self.state);
            state.next_id += 1;
            state.next_id - 1
        };
        // Without the lock of the pool, which all threads need, because this may copy a scene.
        session.enter(&Company { roster: &self.roster, id }, name);
        let mut state = locked(&self.state);
        state.sessions.insert(
            id,
            Arc::new(PooledSession { id, session: Mutex::new(session), buffers, untraced_micros: AtomicU64::new(0) }),
        );
        state.queue.add(id);
        self.metrics.visits.add(1);
        self.wake_or_preempt(&mut state);
        id
    }

    /// Makes a session ready, because it has input or its bytes have been sent.
    pub(super) fn wake(&self, id: SessionId) {
        let mut state = locked(&self.state);
        state.queue.wake(id);
        self.wake_or_preempt(&mut state);
    }

    /// Tells all sessions the time at which the server ends.
    pub(super) fn drain(&self, at: Duration) {
        self.tell_all(|buffers| buffers.set_drain_deadline(at));
    }

    /// Tells all sessions the scenes that replace those they have.
    pub(super) fn replace_scenes(&self, scenes: &Arc<[HostedScene]>) {
        self.tell_all(|buffers| buffers.set_scenes(Arc::clone(scenes)));
    }

    fn tell_all(&self, tell: impl Fn(&SessionBuffers)) {
        let mut state = locked(&self.state);
        let ids: Vec<_> = state.sessions.iter().map(|(&id, pooled)| (tell(&pooled.buffers), id).1).collect();
        for id in ids {
            state.queue.wake(id);
        }
        self.ready.notify_all();
    }

    /// Returns the number of sessions.
    pub(super) fn session_count(&self) -> usize {
        locked(&self.state).sessions.len()
    }

    /// Returns the number of sessions that follow the tour or a viewer.
    pub(super) fn follower_count(&self) -> usize {
        locked(&self.state).audiences.values().map(|pooled| pooled.audience.len()).sum()
    }

    /// Sets the path of the tour that the server gives, and the limits of all audiences.
    pub(super) fn set_tour(&self, tour: Option<Arc<Tour>>, limits: AudienceLimits) {
        let mut state = locked(&self.state);
        (state.tour, state.limits) = (tour, limits);
    }

    /// Adds a follower to the audience of a class.
    fn follow(&self, class: AudienceClass) -> Follower {
        let mut state = locked(&self.state);
        if let Some(pooled) = state.audiences.values().find(|pooled| pooled.audience.class == class) {
            return pooled.audience.follow();
        }
        let (audience, drawing) = (Audience::new(class), Mutex::new(Drawing::new(&class)));
        let follower = audience.follow();
        let id = SessionId::MAX - state.audience_count;
        state.audience_count += 1;
        state.audiences.insert(id, Arc::new(PooledAudience { audience, drawing }));
        state.queue.add(id);
        self.wake_or_preempt(&mut state);
        follower
    }

    /// Ends the threads.
    pub(super) fn close(&self) {
        locked(&self.state).closed = true;
        self.ready.notify_all();
    }

    /// Makes sessions ready, because others have done what they have to be told.
    fn wake_all(&self, state: &mut PoolState, ids: Vec<SessionId>) {
        for id in ids {
            state.queue.wake(id);
            self.wake_or_preempt(state);
        }
    }

    /// Wakes a resting thread; if there is none, interrupts the refinements.
    fn wake_or_preempt(&self, state: &mut PoolState) {
        if state.resting > 0 {
            self.ready.notify_one();
        } else {
            std::mem::take(&mut state.refinements).cancel();
        }
    }

    /// Carries out the turns of sessions, one after the other, until the pool is closed.
    fn serve(&self) {
        #[cfg(target_os = "linux")]
        let _ = rustix::process::nice(WORKER_NICENESS);
        // Makes this thread a rayon pool. Without it, each `rayon::join` would run on the global pool.
        let rayon_pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
        // The cells of the frame that is drawn. Each moving viewer would need 30 kB of 160 for a grid of their own.
        let mut grid = Grid::new(Size::new(0, 0));
        while let Some((id, owner, load, token)) = self.next_turn() {
            // CPU time, because on a busy machine the elapsed time would charge a session for the turns of others.
            let started = cpu_time();
            let mut turn = || match &owner {
                TurnOwner::Session(pooled) => self.take_turn(pooled, load, &token, &mut grid),
                TurnOwner::Audience(pooled) => self.draw_for(id, pooled, load, &token),
            };
            let turned = catch_unwind(AssertUnwindSafe(|| match &rayon_pool {
                Ok(pool) => pool.install(&mut turn),
                Err(_) => turn(),
            }));
            let next = turned.unwrap_or_else(|_| {
                // The panic hook has already printed the message. The panic may have left the grid in the session.
                grid = Grid::new(Size::new(0, 0));
                self.metrics.panics.add(1);
                match &owner {
                    // Only this viewer ends, with a clean terminal.
                    TurnOwner::Session(pooled) => {
                        let mut out = Vec::new();
                        locked(&pooled.session).abandon(&mut out);
                        pooled.buffers.send(out, Some(ScreenSource::Session), Some(LeaveReason::Fault));
                        AfterTurn::End
                    }
                    // The followers stay. A later view may be drawn without a panic.
                    TurnOwner::Audience(pooled) => {
                        *locked(&pooled.drawing) = Drawing::new(&pooled.audience.class);
                        pooled.audience.start_again();
                        AfterTurn::Sleep(Some(self.now() + AFTER_PANIC))
                    }
                }
            });
            if next == AfterTurn::End {
                // Before the lock, as freeing a picture and the last copy of its scene may take long.
                self.tracer.release(id);
            }
            let cost = cpu_time().saturating_sub(started);
            self.metrics.turn_micros.add(u64::try_from(cost.as_micros()).unwrap_or(0));
            let mut state = locked(&self.state);
            // All followers pay for the frames of their audience together.
            let sharers = if let TurnOwner::Audience(pooled) = &owner { pooled.audience.len() } else { 1 };
            // An audience ends with its last follower, and only here, under the lock under which one joins.
            let next = if sharers == 0 { AfterTurn::End } else { next };
            state.queue.finish(id, cost / u32::try_from(sharers.max(1)).unwrap_or(u32::MAX), next);
            if next == AfterTurn::End {
                if state.sessions.remove(&id).is_some() {
                    let told = self.roster.leave(id, state.tour.is_some());
                    self.wake_all(&mut state, told);
                }
                state.audiences.remove(&id);
            }
        }
    }

    /// Waits for the next turn, and returns its owner, the load, and the token that cancels
    /// refinements.
    ///
    /// `None` if the pool is closed.
    fn next_turn(&self) -> Option<(SessionId, TurnOwner, Load, Cancellation)> {
        let mut state = locked(&self.state);
        loop {
            if state.closed {
                return None;
            }
            let now = self.now();
            if let Some(id) = state.queue.take(now) {
                let load = Load { pending: state.queue.load(), drawing: state.frames.session_count(now) };
                let token = state.refinements.clone();
                let session = || state.sessions.get(&id).cloned().map(TurnOwner::Session);
                let audience = || state.audiences.get(&id).cloned().map(TurnOwner::Audience);
                if let Some(owner) = session().or_else(audience) {
                    return Some((id, owner, load, token));
                }
                state.queue.finish(id, Duration::ZERO, AfterTurn::End);
                continue;
            }
            state.resting += 1;
            let timeout = state.queue.next_timer().map(|at| at.saturating_sub(now));
            state = match timeout {
                Some(timeout) => self.ready.wait_timeout(state, timeout).unwrap_or_else(PoisonError::into_inner).0,
                None => self.ready.wait(state).unwrap_or_else(PoisonError::into_inner),
            };
            state.resting -= 1;
        }
    }

    fn take_turn(&self, pooled: &PooledSession, load: Load, token: &Cancellation, grid: &mut Grid) -> AfterTurn {
        let buffers = &pooled.buffers;
        if buffers.is_hung_up() {
            return AfterTurn::End;
        }
        let mut session = locked(&pooled.session);
        let share = load.per_thread(self.threads);
        // The first picture of a visit is never interrupted, because the screen is empty until it is drawn.
        let never = Cancellation::default();
        let untraced = Duration::from_micros(pooled.untraced_micros.load(Ordering::Relaxed));
        let (started, mut traced) = (cpu_time(), Duration::ZERO);
        let mut trace = |job: &Job, may_interrupt: bool| -> Option<Frame> {
            let token = if may_interrupt { token } else { &never };
            let before = cpu_time();
            let frame = self.picture(pooled.id, job, token);
            let trace = cpu_time().saturating_sub(before);
            traced += trace;
            let mut frame = frame?;
            // A picture that was traced for another viewer counts as if it had been traced for this one.
            let trace = trace.max(frame.trace);
            // The time is that of whole frames: as long as tracing alone counted, some of 200 viewers got 30 coarse
            // frames a second, others 14 fine ones.
            // The quality control compares it with the share of a frame that tracing may take.
            frame.interval = (trace + untraced).mul_f64(share * TRACING_SHARE);
            Some(frame)
        };
        let mut out = Vec::new();
        let input = PendingInput { tour: self.tour(), ..buffers.take_input() };
        #[cfg(feature = "test-hooks")]
        assert!(
            !self.panics.get().is_some_and(|key| input.bytes.contains(key)),
            "a test asked for a panic in a session"
        );
        // If every ready session has a thread, the turn may refine: that delays no picture of another viewer.
        let kind = if load.pending <= self.threads { WorkKind::Refinement } else { WorkKind::Picture };
        let company = Company { roster: &self.roster, id: pooled.id };
        let state = (buffers.is_sending(), kind);
        session.swap_grid(grid);
        let next = session.take_turn((&input, &company), state, &|| self.now(), &mut trace, &mut out);
        session.swap_grid(grid);
        let drawn = session.take_drawn();
        self.metrics.frames.add(drawn);
        if drawn > 0 {
            locked(&self.state).frames.record(pooled.id, self.now());
            let untraced = cpu_time().saturating_sub(started + traced);
            pooled.untraced_micros.store(u64::try_from(untraced.as_micros()).unwrap_or(u64::MAX), Ordering::Relaxed);
        }
        let told = session.take_told();
        if !told.is_empty() {
            self.wake_all(&mut locked(&self.state), told);
        }
        let source = session.take_audience_change().map(|change| match change {
            AudienceChange::Follow(class) => {
                self.tracer.release(pooled.id);
                ScreenSource::Tour(self.follow(class))
            }
            AudienceChange::Leave => ScreenSource::Session,
        });
        buffers.send(out, source, session.leave_reason().filter(|_| next == AfterTurn::End));
        next
    }

    fn tour(&self) -> Option<Arc<Tour>> {
        locked(&self.state).tour.clone()
    }

    /// Draws the next frame of a guide's view for an audience.
    fn draw_for(
        &self,
        id: SessionId,
        PooledAudience { audience, drawing }: &PooledAudience,
        load: Load,
        token: &Cancellation,
    ) -> AfterTurn {
        if audience.len() == 0 {
            // A follower who changes the size of the window leaves audiences behind, which cost no picture.
            return AfterTurn::Turn(WorkKind::Picture);
        }
        let (guide, now) = (audience.class.guide, self.now());
        let (tour, limits, watching) = {
            let state = locked(&self.state);
            (state.tour.clone(), state.limits, state.sessions.len())
        };
        let Some(view) = self.roster.view(guide, tour.as_deref(), now) else {
            // The guide may show something again; if not, the followers leave by themselves.
            return AfterTurn::Sleep(Some(limits.next_frame_at(now, 0)));
        };
        let line = GuideLine { title: self.roster.title(guide), watching };
        // A refinement waits for a time at which it delays no viewer, as those of sessions do.
        let refine = Some(token).filter(|_| load.pending <= self.threads);
        let (next, has_drawn) = locked(drawing).draw(audience, (view, line), (limits, now), refine);
        self.metrics.tour_drawn.add(has_drawn.into());
        if has_drawn {
            locked(&self.state).frames.record(id, self.now());
        }
        AfterTurn::Sleep(Some(next))
    }

    /// Returns the picture of a session's job, or `None` if it is cancelled.
    ///
    /// The picture may have been traced for another viewer.
    fn picture(&self, id: SessionId, job: &Job, token: &Cancellation) -> Option<Frame> {
        let is_worth_sharing = is_worth_sharing(job);
        if is_worth_sharing && let Some(kept) = locked(&self.pictures).get(job) {
            self.metrics.shared.add(1);
            self.tracer.release(id);
            return Some(Frame { shot: job.shot, refines: job.refines, ..Frame::clone(&kept) });
        }
        let frame = self.tracer.trace_for(id, job, token).ok()?;
        self.metrics.traced.add(1);
        if is_worth_sharing {
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

#[cfg(all(test, unit_tests))]
mod tests;
