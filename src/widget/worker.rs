//! The thread that traces the pictures of a pane, so that no draw call waits for one.

use super::shot::{Shot, Shown, Tracer};
use crate::progress::Cancellation;
use std::any::Any;
use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

/// The draw thread's side.
pub(super) struct Worker {
    desk: Arc<Desk>,
    thread: Option<JoinHandle<()>>,
}

/// What lies between both threads.
#[derive(Default)]
struct Desk {
    post: Mutex<Post>,
    /// Notified of a new order.
    ordered: Condvar,
}

#[derive(Default)]
struct Post {
    /// The next shot. A newer one takes its place.
    wanted: Option<Shot>,
    /// The token of the shot in work.
    token: Cancellation,
    /// Whether a picture of the shot in work has been delivered: the rest is given up for a newer one.
    is_refining: bool,
    /// The newest picture that has not been taken.
    done: Option<Shown>,
    /// What the thread panicked with.
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
                // The next draw call goes on with the panic.
                if !is_waking.get() {
                    wake();
                }
            }
        })?;
        Ok(Self { desk, thread: Some(thread) })
    }

    /// Orders a shot in the place of one that has not been begun.
    pub(super) fn want(&self, shot: Shot) {
        let mut post = self.desk.lock();
        post.wanted = Some(shot);
        if post.is_refining {
            post.token.cancel();
        }
        self.desk.ordered.notify_one();
    }

    /// Takes the newest picture that has been finished since the last call.
    ///
    /// # Panics
    /// With what the thread panicked with.
    pub(super) fn take(&self) -> Option<Shown> {
        let mut post = self.desk.lock();
        if let Some(panic) = post.panic.take() {
            drop(post);
            // The panic hook has printed its message already.
            resume_unwind(panic);
        }
        post.done.take()
    }

    /// Returns whether no shot waits to be begun.
    #[cfg(test)]
    pub(super) fn is_in_work(&self) -> bool {
        self.desk.lock().wanted.is_none()
    }
}

impl Drop for Worker {
    /// Gives the shot in work up, and waits for the thread: 256 rays of each thread that traces.
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
        // No code that can panic runs while it is held.
        self.post.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the next shot; `None` when there will be no more.
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
            // A shot that was given up leaves what it has delivered.
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
