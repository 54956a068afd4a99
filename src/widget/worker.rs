//! The background thread that traces the pictures of a pane.

use super::shot::{Shot, Shown, Tracer};
use crate::progress::Cancellation;
use std::any::Any;
use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

/// The drawing thread's handle of the background thread.
pub(super) struct Worker {
    desk: Arc<Desk>,
    thread: Option<JoinHandle<()>>,
}

/// The state shared by both threads.
#[derive(Default)]
struct Desk {
    post: Mutex<Post>,
    /// Notified of a new request.
    ordered: Condvar,
}

#[derive(Default)]
struct Post {
    /// The next shot, replaced by a newer one.
    wanted: Option<Shot>,
    /// The token of the shot in progress.
    token: Cancellation,
    /// Whether a picture of the shot in progress has been delivered, so that a newer shot cancels the rest.
    is_refining: bool,
    /// The newest picture that has not been taken.
    done: Option<Shown>,
    /// The payload of a panic in the thread.
    panic: Option<Box<dyn Any + Send>>,
    is_closed: bool,
}

impl Worker {
    /// Starts the thread, which calls `wake` after each picture.
    pub(super) fn start(wake: impl Fn() + Send + 'static) -> io::Result<Self> {
        let desk = Arc::new(Desk::default());
        let own = Arc::clone(&desk);
        let thread = thread::Builder::new().name("termtrace pane".to_owned()).spawn(move || {
            let is_waking = Cell::new(false);
            let wake = || {
                is_waking.set(true);
                wake();
                is_waking.set(false);
            };
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| own.trace_all(&wake))) {
                own.lock().panic = Some(panic);
                // The next draw call continues the panic.
                if !is_waking.get() {
                    wake();
                }
            }
        })?;
        Ok(Self { desk, thread: Some(thread) })
    }

    /// Requests a shot, which replaces one that has not been started.
    pub(super) fn want(&self, shot: Shot) {
        let mut post = self.desk.lock();
        post.wanted = Some(shot);
        if post.is_refining {
            post.token.cancel();
        }
        self.desk.ordered.notify_one();
    }

    /// Takes the newest picture finished since the last call.
    ///
    /// # Panics
    /// With the payload of a panic in the thread.
    pub(super) fn take(&self) -> Option<Shown> {
        let mut post = self.desk.lock();
        if let Some(panic) = post.panic.take() {
            drop(post);
            // The panic hook has already printed the message.
            resume_unwind(panic);
        }
        post.done.take()
    }

    /// Returns whether no request is waiting.
    #[cfg(test)]
    pub(super) fn is_in_work(&self) -> bool {
        self.desk.lock().wanted.is_none()
    }
}

impl Drop for Worker {
    /// Cancels the shot in progress and joins the thread, which takes the time of 256 rays on each tracing thread.
    fn drop(&mut self) {
        let mut post = self.desk.lock();
        post.is_closed = true;
        post.token.cancel();
        drop(post);
        self.desk.ordered.notify_one();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Desk {
    fn lock(&self) -> MutexGuard<'_, Post> {
        // No code that can panic runs while the lock is held.
        self.post.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the next shot; `None` when the state is dropped.
    fn next(&self) -> Option<(Shot, Cancellation)> {
        let mut post = self.lock();
        loop {
            if post.is_closed {
                return None;
            }
            if let Some(shot) = post.wanted.take() {
                post.token = Cancellation::default();
                post.is_refining = false;
                return Some((shot, post.token.clone()));
            }
            post = self.ordered.wait(post).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn trace_all(&self, wake: &impl Fn()) {
        let mut tracer = Tracer::default();
        while let Some((shot, token)) = self.next() {
            // The pictures delivered before a cancel stay valid.
            let _ = tracer.trace_in_steps(shot, &token, |shown| {
                self.deliver(shown);
                wake();
            });
        }
    }

    fn deliver(&self, shown: Shown) {
        let mut post = self.lock();
        post.is_refining = !shown.is_final;
        if post.is_refining && post.wanted.is_some() {
            post.token.cancel();
        }
        post.done = Some(shown);
    }
}
