//! A client's socket, which can be closed from outside at any time, and closes when the client
//! stalls.

use rustix::net::{Shutdown, shutdown, sockopt};
use std::collections::VecDeque;
use std::io::{self, Read};
use std::pin::Pin;
use std::sync::{Arc, Weak};
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::{Sleep, sleep};

/// The size of the operating system's send buffer for a client, in bytes.
// Without a limit the system buffers up to several megabytes for a client that does not read, all of them older than
// the newest frame.
const SEND_BUFFER: usize = 64 * 1024;

/// A client's socket.
pub(super) struct Socket {
    // Shared with `SocketCloser`, whose reference is weak, so that it does not keep the socket open.
    stream: Arc<TcpStream>,
    /// The bytes that were read from the stream before it was wrapped, and not yet from here.
    first: VecDeque<u8>,
    /// The longest time that a client may take no bytes while some wait to be sent.
    patience: Duration,
    /// The timer of `patience`, which runs while bytes wait and the client takes none.
    stalled: Option<Pin<Box<Sleep>>>,
}

/// A handle that closes a [`Socket`] which another task uses.
#[derive(Clone)]
pub(super) struct SocketCloser(Weak<TcpStream>);

impl SocketCloser {
    /// Closes the socket: reading ends, and writing fails.
    pub(super) fn close(&self) {
        if let Some(stream) = self.0.upgrade() {
            let _ = shutdown(&*stream, Shutdown::Both);
        }
    }
}

impl Socket {
    /// Wraps the stream of a new connection, from which `first` has been read, and sets its socket
    /// options.
    pub(super) fn new(stream: TcpStream, first: Vec<u8>, patience: Duration) -> Self {
        // Errors are ignored, because these options affect only the speed.
        let _ = stream.set_nodelay(true);
        let _ = sockopt::set_socket_send_buffer_size(&stream, SEND_BUFFER);
        // With keepalive a client's host that has vanished is noticed even if the server sends nothing.
        let _ = sockopt::set_socket_keepalive(&stream, true);
        let _ = sockopt::set_tcp_keepidle(&stream, Duration::from_secs(60));
        Self { stream: Arc::new(stream), first: first.into(), patience, stalled: None }
    }

    /// Returns a handle that closes the socket.
    pub(super) fn closer(&self) -> SocketCloser {
        SocketCloser(Arc::downgrade(&self.stream))
    }
}

impl AsyncRead for Socket {
    fn poll_read(mut self: Pin<&mut Self>, cx: &mut Context<'_>, buffer: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        if !self.first.is_empty() {
            let count = self.first.read(buffer.initialize_unfilled())?;
            buffer.advance(count);
            return Poll::Ready(Ok(()));
        }
        loop {
            ready!(self.stream.poll_read_ready(cx))?;
            match self.stream.try_read(buffer.initialize_unfilled()) {
                Ok(count) => {
                    buffer.advance(count);
                    return Poll::Ready(Ok(()));
                }
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
                Err(error) => return Poll::Ready(Err(error)),
            }
        }
    }
}

impl AsyncWrite for Socket {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        loop {
            if self.stream.poll_write_ready(cx)?.is_pending() {
                // The timer starts when a write blocks, and stops when the client takes any byte: a slow client does
                // not count as stalled.
                let patience = self.patience;
                let stalled = self.stalled.get_or_insert_with(|| Box::pin(sleep(patience)));
                ready!(stalled.as_mut().poll(cx));
                return Poll::Ready(Err(io::ErrorKind::TimedOut.into()));
            }
            match self.stream.try_write(bytes) {
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
                done => {
                    self.stalled = None;
                    return Poll::Ready(done);
                }
            }
        }
    }

    // The socket has no buffer of its own.
    fn poll_flush(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        // An error of `shutdown` is ignored, because it means that the connection has already ended.
        let _ = shutdown(&*self.stream, Shutdown::Write);
        Poll::Ready(Ok(()))
    }
}
