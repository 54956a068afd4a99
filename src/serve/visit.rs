//! One visit of a client, from the wait for a viewer's place to the last byte.

use super::client_terminal::ClientTerminal;
use super::leave_reason::LeaveReason;
use super::log_line::LogLine;
use super::metrics::Counter;
use super::run_queue::SessionId;
use super::session_buffers::{Outgoing, ScreenSource, SessionBuffers};
use super::shared_state::{Setup, SharedState, ViewerSlot};
use super::socket::SocketCloser;
use super::viewer_session::{SessionOptions, ViewerSession, VisitLimits};
use crate::grid::{Size, Window};
use crate::text::visible;
use bytes::Bytes;
use russh::ChannelId;
use russh::server::Handle;
use std::sync::Arc;
use std::task::Poll;
use std::time::Duration;
use tokio::time::{sleep, timeout};

/// The time within which a client that was told to leave has to close the connection.
// After a disconnect `russh` itself waits for the client to close, without a limit.
const CLOSING_TIME: Duration = Duration::from_secs(2);
/// The keys that leave the waiting room: q, Ctrl-C, Ctrl-D.
const LEAVING: &[u8] = b"q\x03\x04";

/// The user who has logged in.
#[derive(Clone, Debug, Default)]
pub(super) struct User {
    /// The login name that other viewers see, if the server shows names.
    pub(super) name: Option<Arc<str>>,
    /// Whether the user may lead the tour.
    pub(super) may_lead: bool,
}

/// One visit: the connection, and the client's channel.
pub(super) struct Visit {
    pub(super) state: Arc<SharedState>,
    /// The settings and scenes at the time of the client's request.
    pub(super) setup: Arc<Setup>,
    pub(super) buffers: Arc<SessionBuffers>,
    pub(super) closer: SocketCloser,
    /// The network that the client's address is in, for the log.
    pub(super) from: String,
    pub(super) user: User,
    /// The bytes that the client has taken.
    pub(super) sent: Counter,
    pub(super) handle: Handle,
    pub(super) channel: ChannelId,
}

impl Visit {
    /// Shows a scene until the user leaves.
    pub(super) async fn show(&self, scene: usize, terminal: &ClientTerminal, window: Window) {
        let mut window = window;
        let Some(_place) = self.wait_for_place(&mut window).await else {
            return self.end(1).await;
        };
        let (state, now) = (&self.state, self.state.pool.now());
        let Setup { settings, scenes, .. } = &*self.setup;
        let limits = VisitLimits { idle: settings.idle, ends: now + settings.session_max };
        let User { name: user, may_lead } = self.user.clone();
        let mut first = Vec::new();
        let has_tour = self.setup.tour.is_some() || state.pool.roster.leader().is_some();
        let options = SessionOptions {
            viewer: state.viewer_options(&self.setup, terminal, window.size.columns, may_lead),
            link: settings.link.clone(),
            follows_tour: has_tour && scene == 0,
            may_lead,
        };
        let session = ViewerSession::new(Arc::clone(scenes), scene, options, window, limits, now, &mut first);
        let Ok(session) = session else {
            return self.refuse("there is not enough memory for a window of this size").await;
        };
        self.buffers.send(first, None, None);
        let id = state.pool.add(session, Arc::clone(&self.buffers), user);
        self.buffers.set_session(id);
        if let Some(at) = state.drain_deadline() {
            self.buffers.set_drain_deadline(at);
        }
        let current = state.setup();
        if !Arc::ptr_eq(&current, &self.setup) {
            self.buffers.set_scenes(Arc::clone(&current.scenes));
        }
        // Input that arrived before `set_session` has not woken the session.
        state.pool.wake(id);
        let Size { columns, rows } = window.size;
        let name = &scenes[scene].name;
        let line = LogLine::event("view").with("viewer", id).with("from", &self.from).with("scene", name);
        state.log(&line.with("columns", columns).with("rows", rows));
        let ended = self.pass_bytes(id).await;
        let (reason, seconds) =
            (ended.map_or("hang_up", LeaveReason::name), state.pool.now().saturating_sub(now).as_secs());
        let line = LogLine::event("leave").with("viewer", id).with("reason", reason);
        state.log(&line.with("seconds", seconds).with("bytes", self.sent.get()));
        if let Some(reason) = ended {
            self.end(reason.exit_status()).await;
        } else {
            self.buffers.hang_up();
            state.pool.wake(id);
        }
    }

    /// Sends the session's bytes until it ends, and returns the reason; `None` if the connection
    /// has ended.
    ///
    /// While the client follows the tour, sends the tour's bytes too.
    async fn pass_bytes(&self, id: SessionId) -> Option<LeaveReason> {
        let mut source = ScreenSource::Session;
        loop {
            let outgoing = match &mut source {
                ScreenSource::Session => self.buffers.outgoing().await,
                ScreenSource::Tour(follower) => match either(self.buffers.outgoing(), follower.next_bytes()).await {
                    Either::First(outgoing) => outgoing,
                    Either::Second(bytes) => {
                        if !self.send(bytes).await {
                            return None;
                        }
                        self.state.pool.metrics.tour_sent.add(1);
                        continue;
                    }
                },
            };
            let Outgoing { bytes, source: next_source, ended } = outgoing?;
            source = next_source.unwrap_or(source);
            if !self.send(bytes).await {
                return None;
            }
            self.buffers.record_sent();
            if ended.is_some() {
                return ended;
            }
            self.state.pool.wake(id);
        }
    }

    /// Waits for a free place, and meanwhile tells the user how many visitors are ahead.
    ///
    /// Returns `None` if the user leaves, the server drains, or too many visitors wait.
    async fn wait_for_place(&self, window: &mut Window) -> Option<ViewerSlot> {
        let mut changes = self.state.changes.subscribe();
        let Some(visitor) = self.state.queue_up() else {
            self.send(&b"full, and many wait; come back later\r\n"[..]).await;
            return None;
        };
        let mut told = None;
        loop {
            // The changes so far are marked as seen before the checks, so that a change during the checks ends the wait
            // below.
            changes.mark_unchanged();
            if self.state.drain_deadline().is_some() {
                self.send(&b"\r\x1b[Kthe server restarts; come back soon\r\n"[..]).await;
                return None;
            }
            let ahead = match visitor.take_place() {
                Ok(place) => {
                    if told.is_some() {
                        self.send(&b"\r\x1b[K"[..]).await;
                    }
                    return Some(place);
                }
                Err(ahead) => ahead,
            };
            // The number is only printed if it is new: each change wakes all who wait, and most changes do not affect
            // the number.
            if told.replace(ahead) != Some(ahead) {
                let text = format!("\r\x1b[Kfull, {ahead} ahead of you; q leaves");
                self.send(text).await;
            }
            either(changes.changed(), self.buffers.wait_for_wake()).await;
            let input = self.buffers.take_input();
            *window = input.window.unwrap_or(*window);
            if self.buffers.is_hung_up() || input.bytes.iter().any(|byte| LEAVING.contains(byte)) {
                self.send(&b"\r\x1b[K"[..]).await;
                return None;
            }
        }
    }

    /// Prints a text and ends the visit.
    pub(super) async fn print(&self, text: &str) {
        self.send(text.to_owned()).await;
        self.end(0).await;
    }

    /// Prints an error message and ends the visit.
    pub(super) async fn refuse(&self, message: &str) {
        let message = format!("error: {}\r\n", visible(message));
        // Stream 1 is the standard error of a client's command.
        let _ = self.handle.extended_data(self.channel, 1, message.into_bytes()).await;
        self.end(2).await;
    }

    /// Sends bytes, and returns whether the connection has taken them.
    ///
    /// A client is disconnected if its SSH window has no room for the bytes for too long. (A client that does not read
    /// its socket at all is noticed by `Socket`.)
    async fn send(&self, bytes: impl Into<Bytes>) -> bool {
        let (state, patience, mut bytes) = (&self.state, self.setup.settings.patience, bytes.into());
        while !bytes.is_empty() {
            // The parts share the memory of the whole.
            let message = bytes.split_to(bytes.len().min(state.max_message()));
            let length = message.len();
            let wait = state.reserve_wait(length);
            if !wait.is_zero() {
                sleep(wait).await;
            }
            let sent = timeout(patience, self.handle.data(self.channel, message)).await;
            if !matches!(sent, Ok(Ok(()))) {
                self.closer.close();
                return false;
            }
            self.sent.add(length as u64);
            state.pool.metrics.bytes.add(length as u64);
        }
        true
    }

    /// Ends the visit, and the connection if the client does not.
    async fn end(&self, status: u32) {
        let ending = async {
            let _ = self.handle.exit_status_request(self.channel, status).await;
            let _ = self.handle.eof(self.channel).await;
            let _ = self.handle.close(self.channel).await;
        };
        // With a timeout, because these messages wait for room in the connection's queue, and a stalled client never
        // makes any.
        let _ = timeout(CLOSING_TIME, ending).await;
        sleep(CLOSING_TIME).await;
        self.closer.close();
    }
}

/// The result of the first of two futures.
enum Either<A, B> {
    First(A),
    Second(B),
}

/// Waits for the first of two futures, and drops the other one.
async fn either<A, B>(first: impl Future<Output = A>, second: impl Future<Output = B>) -> Either<A, B> {
    let (mut first, mut second) = (std::pin::pin!(first), std::pin::pin!(second));
    std::future::poll_fn(|cx| {
        if let Poll::Ready(first) = first.as_mut().poll(cx) {
            return Poll::Ready(Either::First(first));
        }
        second.as_mut().poll(cx).map(Either::Second)
    })
    .await
}
