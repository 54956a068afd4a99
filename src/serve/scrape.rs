//! The answers to requests for the counts, on an address of their own (`--metrics`).

use super::shared_state::SharedState;
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{sleep, timeout};

/// The longest time that a request for the counts may take.
const REQUEST_TIME: Duration = Duration::from_secs(2);
/// The most bytes of a request.
const MAX_REQUEST: usize = 8 * 1024;
/// Time to wait after an error of accepting a connection, such as too many open files.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// Answers requests for the counts, one after the other.
pub(super) async fn serve(state: Arc<SharedState>, listener: TcpListener) {
    loop {
        match listener.accept().await {
            Ok((stream, _)) => drop(timeout(REQUEST_TIME, answer(&stream, &state)).await),
            Err(_) => sleep(ACCEPT_PAUSE).await,
        }
    }
}

/// Answers one request, whatever it asks for.
async fn answer(stream: &TcpStream, state: &SharedState) -> io::Result<()> {
    let (mut request, mut part) = (Vec::new(), [0; 1024]);
    while !request.windows(4).any(|end| end == b"\r\n\r\n") {
        stream.readable().await?;
        match stream.try_read(&mut part) {
            Ok(0) => return Ok(()),
            Ok(count) => request.extend_from_slice(&part[..count]),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(error),
        }
        if request.len() > MAX_REQUEST {
            return Ok(());
        }
    }
    let text = state.metrics_text();
    let head = "HTTP/1.1 200 OK\r\nContent-Type: text/plain; version=0.0.4\r\nConnection: close";
    let response = format!("{head}\r\nContent-Length: {}\r\n\r\n{text}", text.len());
    let mut rest = response.as_bytes();
    while !rest.is_empty() {
        stream.writable().await?;
        match stream.try_write(rest) {
            Ok(count) => rest = &rest[count..],
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
