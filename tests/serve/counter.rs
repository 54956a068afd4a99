//! A client that only counts frames and bytes, so that many of them fit beside the server.

use crate::Place;
use crate::guest::{Anybody, log_in};
use russh::client::{Handle, Msg};
use russh::{Channel, ChannelMsg};
use std::collections::VecDeque;
use std::time::Duration;
use tokio::time::{Instant, timeout_at};

/// The end of a synchronized frame.
const FRAME_END: &[u8] = b"\x1b[?2026l";
/// The queries that end frames, and the replies of a terminal with synchronized frames.
const QUERIES: [(&[u8], &[u8]); 2] = [(b"\x1b[c", b"\x1b[?62;22c"), (b"\x1b[?2026$p", b"\x1b[?2026;2$y")];

/// A client in a terminal with all colours.
pub(crate) struct Counter {
    _session: Handle<Anybody>,
    pub(crate) channel: Channel<Msg>,
    /// The last bytes, in which a sequence may be incomplete.
    tail: Vec<u8>,
    pub(crate) frames: usize,
    pub(crate) bytes: usize,
    /// The time after which each query is answered.
    delay: Duration,
    answers: VecDeque<(Instant, &'static [u8])>,
}

impl Counter {
    /// Opens a view in a terminal of this size that answers after `delay`, and turns the scene.
    pub(crate) async fn enter(place: &impl Place, (columns, rows): (u32, u32), delay: Duration) -> Self {
        let session = log_in(place).await;
        let channel = session.channel_open_session().await.expect("a channel");
        channel.set_env(false, "COLORTERM", "truecolor").await.expect("it is sent");
        channel.request_pty(false, "xterm-256color", columns, rows, 0, 0, &[]).await.expect("it is sent");
        channel.request_shell(false).await.expect("it is sent");
        channel.data(&b"t"[..]).await.expect("it is sent");
        let (tail, answers) = (Vec::new(), VecDeque::new());
        Self { _session: session, channel, tail, frames: 0, bytes: 0, delay, answers }
    }

    /// Reads and answers until this time.
    pub(crate) async fn run_until(&mut self, end: Instant) {
        while Instant::now() < end {
            while let Some(&(_, answer)) = self.answers.front().filter(|(at, _)| *at <= Instant::now()) {
                self.answers.pop_front();
                self.channel.data(answer).await.expect("the connection is open");
            }
            let due = self.answers.front().map_or(end, |&(at, _)| at.min(end));
            match timeout_at(due, self.channel.wait()).await {
                Ok(Some(ChannelMsg::Data { data })) => self.take(&data),
                Ok(Some(_)) | Err(_) => {}
                Ok(None) => panic!("the server ended the view"),
            }
        }
    }

    fn take(&mut self, data: &[u8]) {
        self.bytes += data.len();
        self.tail.extend_from_slice(data);
        let mut at = 0;
        while let Some(next) = self.tail[at..].iter().position(|&byte| byte == 0x1b) {
            at += next;
            let rest = &self.tail[at..];
            let is_known = rest.starts_with(FRAME_END) || QUERIES.iter().any(|(query, _)| rest.starts_with(query));
            if rest.len() < QUERIES[1].0.len() && !is_known {
                break;
            }
            self.frames += usize::from(rest.starts_with(FRAME_END));
            let due = Instant::now() + self.delay;
            let replies = QUERIES.iter().filter(|(query, _)| rest.starts_with(query));
            self.answers.extend(replies.map(|&(_, reply)| (due, reply)));
            at += 1;
        }
        // Text without an escape sequence is counted; an incomplete sequence waits for the rest.
        let rest = self.tail[at..].iter().position(|&byte| byte == 0x1b).map_or(self.tail.len(), |next| at + next);
        self.tail.drain(..rest);
    }
}

/// Runs all clients side by side for this time. Returns the frames of each.
pub(crate) async fn run_all(counters: &mut Vec<Counter>, time: Duration) -> Vec<usize> {
    let end = Instant::now() + time;
    let running: Vec<_> = counters
        .drain(..)
        .map(|mut counter| {
            tokio::spawn(async move {
                let before = counter.frames;
                counter.run_until(end).await;
                (counter.frames - before, counter)
            })
        })
        .collect();
    let mut frames = Vec::new();
    for counter in running {
        let (count, counter) = counter.await.expect("no client panics");
        frames.push(count);
        counters.push(counter);
    }
    frames
}
