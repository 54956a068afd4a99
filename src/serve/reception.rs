//! One visit of a client, from the wait for a viewer's place to the last byte.

use super::client_terminal::ClientTerminal;
use super::house::{House, Place};
use super::line::{Line, Outgoing, locked};
use super::seat::{Seat, Stay};
use super::socket::Kick;
use super::total_rate::TotalRate;
use crate::grid::Window;
use crate::text::visible;
use russh::ChannelId;
use russh::server::Handle;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{sleep, timeout};

/// The largest number of bytes in one SSH message to a client.
// The buffer of a connection never shrinks: it keeps the size of the largest message.
const MAX_MESSAGE: usize = 8 * 1024;
/// The time within which a client that was told to leave has to close the connection.
// After a disconnect `russh` itself waits for the client to close, without a limit.
const CLOSING_TIME: Duration = Duration::from_secs(2);
/// The keys that leave the waiting room: q, Ctrl-C, Ctrl-D.
const LEAVING: &[u8] = b"q\x03\x04";

/// One visit: the connection, and the client's channel.
pub(super) struct Reception {
    pub(super) house: Arc<House>,
    pub(super) line: Arc<Line>,
    pub(super) kick: Kick,
    pub(super) handle: Handle,
    pub(super) channel: ChannelId,
}

impl Reception {
    /// Shows a scene until the user leaves.
    pub(super) async fn show(&self, scene: usize, terminal: &ClientTerminal, window: Window) {
        let mut window = window;
        let Some(_place) = self.wait_for_place(&mut window).await else {
            return self.end(1).await;
        };
        let (house, now) = (&self.house, self.house.stage.now());
        let settings = &house.settings;
        let stay = Stay { idle: settings.idle, ends: now + settings.session_max };
        let options = house.viewer_options(terminal, window.size.columns);
        let mut first = Vec::new();
        let scenes = Arc::clone(&house.scenes);
        let seat = Seat::new(scenes, scene, (options, settings.link.clone()), window, stay, now, &mut first);
        let Ok(seat) = seat else {
            return self.refuse("there is not enough memory for a window of this size").await;
        };
        self.line.send(first, None);
        let id = house.stage.add(seat, Arc::clone(&self.line));
        self.line.set_seat(id);
        if let Some(at) = house.drained_at() {
            self.line.drain(at);
        }
        // Input that arrived before `set_seat` has not woken the seat.
        house.stage.wake(id);
        while let Some(Outgoing { bytes, ended }) = self.line.outgoing().await {
            if !self.send(&bytes).await {
                break;
            }
            self.line.record_sent();
            match ended {
                Some(status) => return self.end(status).await,
                None => house.stage.wake(id),
            }
        }
        self.line.hang_up();
        house.stage.wake(id);
    }

    /// Waits for a free place, and meanwhile tells the user how many visitors are ahead.
    ///
    /// Returns `None` if the user leaves, the server drains, or too many visitors wait.
    async fn wait_for_place(&self, window: &mut Window) -> Option<Place> {
        let mut changes = self.house.changes.subscribe();
        let Some(visitor) = self.house.queue_up() else {
            self.send(b"full, and many wait; come back later\r\n").await;
            return None;
        };
        let mut told = None;
        loop {
            // The changes so far are marked as seen before the checks, so that a change during the checks ends the wait
            // below.
            changes.mark_unchanged();
            if self.house.drained_at().is_some() {
                self.send(b"\r\x1b[Kthe server restarts; come back soon\r\n").await;
                return None;
            }
            let ahead = match visitor.take_place() {
                Ok(place) => {
                    if told.is_some() {
                        self.send(b"\r\x1b[K").await;
                    }
                    return Some(place);
                }
                Err(ahead) => ahead,
            };
            // The number is only printed if it is new: each change wakes all who wait, and most changes do not affect
            // the number.
            if told.replace(ahead) != Some(ahead) {
                let text = format!("\r\x1b[Kfull, {ahead} ahead of you; q leaves");
                self.send(text.as_bytes()).await;
            }
            first_of(changes.changed(), self.line.roused()).await;
            let arrived = self.line.take_arrived();
            *window = arrived.window.unwrap_or(*window);
            if self.line.is_hung_up() || arrived.bytes.iter().any(|byte| LEAVING.contains(byte)) {
                self.send(b"\r\x1b[K").await;
                return None;
            }
        }
    }

    /// Prints a text and ends the visit.
    pub(super) async fn print(&self, text: &str) {
        self.send(text.as_bytes()).await;
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
    async fn send(&self, bytes: &[u8]) -> bool {
        let House { total_rate, stage, .. } = &*self.house;
        for message in bytes.chunks(if total_rate.is_some() { TotalRate::MAX_PART } else { MAX_MESSAGE }) {
            if let Some(rate) = total_rate {
                let wait = locked(rate).enqueue(message.len(), stage.now());
                if !wait.is_zero() {
                    sleep(wait).await;
                }
            }
            let sent = timeout(self.house.settings.patience, self.handle.data(self.channel, message.to_vec())).await;
            if !matches!(sent, Ok(Ok(()))) {
                self.kick.kick();
                return false;
            }
            stage.metrics.bytes.add(message.len() as u64);
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
        self.kick.kick();
    }
}

/// Waits for the first of two events.
async fn first_of<A, B>(first: impl Future<Output = A>, second: impl Future<Output = B>) {
    let (mut first, mut second) = (std::pin::pin!(first), std::pin::pin!(second));
    std::future::poll_fn(|cx| {
        if first.as_mut().poll(cx).is_ready() || second.as_mut().poll(cx).is_ready() {
            std::task::Poll::Ready(())
        } else {
            std::task::Poll::Pending
        }
    })
    .await;
}
