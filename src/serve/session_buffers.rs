//! The exchange between a connection and its viewer session: input one way, bytes the other.
//!
//! Both sides hold a lock only to move bytes, so the thread of the sockets never waits for a picture.

use super::HostedScene;
use super::audience::Follower;
use super::leave_reason::LeaveReason;
use super::lock::locked;
use super::run_queue::SessionId;
use super::viewer_session::PendingInput;
use crate::grid::Window;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;
use tokio::sync::Notify;

/// The size of a part of the input in bytes; at most two parts wait for a session's turn.
///
/// While two parts wait, the connection is not read.
// Keys and replies take a few bytes; only a paste is longer.
const MAX_INPUT: usize = 4096;

/// The size of the outbox in bytes above which the session takes no input.
// More than one frame: an exact redraw of 80x24 cells takes 44 kB.
const MAX_OUTPUT: usize = 64 * 1024;

/// The buffers between a connection and its session: input in one direction, bytes to send in the
/// other.
#[derive(Debug, Default)]
pub(super) struct SessionBuffers {
    inbox: Mutex<Inbox>,
    /// Notified when the session has taken the input, and when the connection has ended.
    taken: Notify,
    outbox: Mutex<Outbox>,
    /// Notified when there are bytes to send, when the connection or the session has ended, and by
    /// [`wake_task`](Self::wake_task).
    filled: Notify,
    session: OnceLock<SessionId>,
    /// Notified when the client has logged in, and when the connection has ended.
    pub(super) logged_in: Notify,
    /// Notified when the client has asked for a view, and when the connection has ended.
    pub(super) asked: Notify,
}

#[derive(Debug, Default)]
struct Inbox {
    pending: PendingInput,
    hung_up: bool,
}

#[derive(Debug, Default)]
struct Outbox {
    bytes: Vec<u8>,
    /// Whether bytes are being sent.
    sending: bool,
    /// The source of the screen's content from now on, if it has changed.
    source: Option<ScreenSource>,
    /// The reason why the session has ended, if it has.
    ended: Option<LeaveReason>,
}

/// The source of what a client's screen shows.
#[derive(Debug)]
pub(super) enum ScreenSource {
    /// The session of the client.
    Session,
    /// The tour.
    Tour(Follower),
}

/// The bytes that a connection is to send next.
#[derive(Debug)]
pub(super) struct Outgoing {
    pub(super) bytes: Vec<u8>,
    /// The source of the screen's content after the bytes, if it has changed.
    pub(super) source: Option<ScreenSource>,
    /// The reason why the session has ended, if these are the last bytes.
    pub(super) ended: Option<LeaveReason>,
}

impl SessionBuffers {
    /// Appends input that arrives at `now`.
    ///
    /// The input is appended in parts. Each part waits until there is room for it beside those that the session has not
    /// taken yet.
    pub(super) async fn push(&self, bytes: &[u8], now: Duration) {
        for part in bytes.chunks(MAX_INPUT) {
            loop {
                // Created before the lock is taken, so that the wait also ends if the session takes the input between
                // the check and the wait.
                let taken = self.taken.notified();
                {
                    let mut inbox = locked(&self.inbox);
                    if inbox.hung_up {
                        return;
                    }
                    if inbox.pending.bytes.len() + part.len() <= 2 * MAX_INPUT {
                        inbox.pending.bytes.extend_from_slice(part);
                        inbox.pending.at = now;
                        break;
                    }
                }
                taken.await;
            }
        }
    }

    /// Sets the window's new size; of several sizes before a turn only the last one counts.
    pub(super) fn resize(&self, window: Window) {
        locked(&self.inbox).pending.window = Some(window);
    }

    /// Tells the session the time at which the server ends.
    pub(super) fn set_drain_deadline(&self, at: Duration) {
        locked(&self.inbox).pending.drain_deadline = Some(at);
    }

    /// Tells the session the scenes that replace those it has.
    pub(super) fn set_scenes(&self, scenes: Arc<[HostedScene]>) {
        locked(&self.inbox).pending.scenes = Some(scenes);
    }

    /// Records that the connection has ended.
    pub(super) fn hang_up(&self) {
        locked(&self.inbox).hung_up = true;
        self.taken.notify_waiters();
        for waiting in [&self.filled, &self.logged_in, &self.asked] {
            waiting.notify_one();
        }
    }

    /// Returns whether the connection has ended.
    pub(super) fn is_hung_up(&self) -> bool {
        locked(&self.inbox).hung_up
    }

    /// Takes the input that has arrived, but none while more than [`MAX_OUTPUT`] bytes wait to be
    /// sent.
    ///
    /// Handling input would add more bytes.
    pub(super) fn take_input(&self) -> PendingInput {
        if locked(&self.outbox).bytes.len() > MAX_OUTPUT {
            return PendingInput::default();
        }
        let input = std::mem::take(&mut locked(&self.inbox).pending);
        self.taken.notify_waiters();
        input
    }

    /// Returns whether bytes are to be sent or being sent.
    pub(super) fn is_sending(&self) -> bool {
        let outbox = locked(&self.outbox);
        outbox.sending || !outbox.bytes.is_empty()
    }

    /// Appends bytes to those to send.
    ///
    /// `source` is the source of the screen's content after them, if it changes; `ended` the reason of the end, if they
    /// are the last ones.
    pub(super) fn send(&self, mut bytes: Vec<u8>, source: Option<ScreenSource>, ended: Option<LeaveReason>) {
        if bytes.is_empty() && source.is_none() && ended.is_none() {
            return;
        }
        let mut outbox = locked(&self.outbox);
        if outbox.bytes.is_empty() {
            // The common case, because the viewer draws only after all earlier bytes have been sent.
            outbox.bytes = bytes;
        } else {
            outbox.bytes.append(&mut bytes);
        }
        outbox.source = source.or(outbox.source.take());
        outbox.ended = ended;
        // The lock is released before the notification, so that the woken task need not wait for it.
        drop(outbox);
        self.filled.notify_one();
    }

    /// Waits for bytes to send. `None` if the connection has ended.
    pub(super) async fn outgoing(&self) -> Option<Outgoing> {
        loop {
            if self.is_hung_up() {
                return None;
            }
            {
                let mut outbox = locked(&self.outbox);
                outbox.sending = !outbox.bytes.is_empty();
                if outbox.sending || outbox.source.is_some() || outbox.ended.is_some() {
                    let (bytes, source) = (std::mem::take(&mut outbox.bytes), outbox.source.take());
                    return Some(Outgoing { bytes, source, ended: outbox.ended });
                }
            }
            self.filled.notified().await;
        }
    }

    /// Records that the bytes of [`outgoing`](Self::outgoing) have been sent.
    pub(super) fn record_sent(&self) {
        locked(&self.outbox).sending = false;
    }

    /// Records the number of the connection's session.
    pub(super) fn set_session(&self, id: SessionId) {
        // This never fails: a connection has only one session in its life.
        let _ = self.session.set(id);
    }

    /// Returns the number of the connection's session, if it has one.
    pub(super) fn session(&self) -> Option<SessionId> {
        self.session.get().copied()
    }

    /// Wakes the connection's task, which waits for a place and has no session yet.
    pub(super) fn wake_task(&self) {
        self.filled.notify_one();
    }

    /// Waits for [`wake_task`](Self::wake_task), or until the connection has ended.
    pub(super) async fn wait_for_wake(&self) {
        self.filled.notified().await;
    }
}
