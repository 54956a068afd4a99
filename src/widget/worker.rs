//! The background thread that traces the pictures of a pane.

use super::shot::{PaneTracer, RenderedShot, Shot};
use crate::progress::Cancellation;
use std::any::Any;
use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

/// The drawing thread's handle of the background thread.
pub(super) struct PaneWorker {
    shared: Arc<SharedJob>,
    thread: Option<JoinHandle<()>>,
}

/// The data shared by the drawing thread and the worker.
#[derive(Default)]
struct SharedJob {
    state: Mutex<SharedState>,
    /// Notified of a new request.
    request_added: Condvar,
}

/// The current request, the newest picture and the state of the worker.
// Slots instead of channels, because a newer request or picture replaces an older one.
#[derive(Default)]
struct SharedState {
    /// The shot to trace next.
    requested: Option<Shot>,
    /// The token that cancels the shot in progress.
    token: Cancellation,
    /// Whether a picture of the shot in progress has been delivered.
    // A newer request cancels the shot only after its first picture: otherwise a camera in motion would never get one.
    is_refining: bool,
    /// The newest picture that has not been taken.
    finished: Option<RenderedShot>,
    /// The payload of a panic in the thread.
    panic: Option<Box<dyn Any + Send>>,
    /// Whether the `SceneState` that owns the thread has been dropped.
    is_closed: bool,
}

impl PaneWorker {
    /// Starts the thread, which calls `wake` after each picture.
    pub(super) fn start(wake: impl Fn() + Send + 'static) -> io::Result<Self> {
        let shared = Arc::new(SharedJob::default());
        let own = Arc::clone(&shared);
        let thread = thread::Builder::new().name("termtrace pane".to_owned()).spawn(move || {
            // Whether `wake` is running: if it panics, it must not be called again.
            let is_waking = Cell::new(false);
            let wake = || {
                is_waking.set(true);
                wake();
                is_waking.set(false);
            };
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| own.trace_all(&wake))) {
                own.lock().panic = Some(panic);
                // Wakes the application, whose next draw call resumes the panic.
                if !is_waking.get() {
                    wake();
                }
            }
        })?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Requests a shot, which replaces one that has not been started.
    pub(super) fn request(&self, shot: Shot) {
        let mut state = self.shared.lock();
        state.requested = Some(shot);
        // A first picture is never cancelled: while the camera moves, none would be finished.
        if state.is_refining {
            state.token.cancel();
        }
        self.shared.request_added.notify_one();
    }

    /// Takes the newest picture finished since the last call.
    ///
    /// # Panics
    /// With the payload of a panic in the thread.
    pub(super) fn take_finished(&self) -> Option<RenderedShot> {
        let mut state = self.shared.lock();
        if let Some(panic) = state.panic.take() {
            drop(state);
            // The panic hook has already printed the message.
            resume_unwind(panic);
        }
        state.finished.take()
    }

    /// Returns whether the thread has taken the last request.
    #[cfg(test)]
    pub(super) fn has_taken_request(&self) -> bool {
        self.shared.lock().requested.is_none()
    }
}

impl Drop for PaneWorker {
    /// Cancels the shot in progress and joins the thread.
    // The wait is short: each tracing thread only finishes its current batch, of at most 256 rays.
    fn drop(&mut self) {
        let mut state = self.shared.lock();
        state.is_closed = true;
        state.token.cancel();
        drop(state);
        // The thread is joined, so that it does not use the scene's memory or call `wake` afterwards.
        self.shared.request_added.notify_one();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl SharedJob {
    fn lock(&self) -> MutexGuard<'_, SharedState> {
        // No code that can panic runs while the lock is held, so it is never poisoned.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the next shot; `None` when the `SceneState` has been dropped.
    fn next(&self) -> Option<(Shot, Cancellation)> {
        let mut state = self.lock();
        loop {
            if state.is_closed {
                return None;
            }
            if let Some(shot) = state.requested.take() {
                // A cancelled token stays cancelled, so each shot has its own.
                state.token = Cancellation::default();
                state.is_refining = false;
                return Some((shot, state.token.clone()));
            }
            state = self.request_added.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn trace_all(&self, wake: &impl Fn()) {
        // One tracer for all shots keeps its cache of mixed colours.
        let mut tracer = PaneTracer::default();
        while let Some((shot, token)) = self.next() {
            // A cancellation is no error: pictures that were delivered before it stay valid.
            let _ = tracer.trace_progressively(shot, &token, |shown| {
                self.deliver(shown);
                wake();
            });
        }
    }

    fn deliver(&self, shown: RenderedShot) {
        let mut state = self.lock();
        state.is_refining = !shown.is_final;
        // If a newer shot was requested before this first picture was finished, the refinement is cancelled now.
        if state.is_refining && state.requested.is_some() {
            state.token.cancel();
        }
        state.finished = Some(shown);
    }
}
