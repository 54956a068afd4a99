//! The server's counts and its health, as pages on an address of their own (`--metrics`).

use super::shared_state::SharedState;
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{sleep, timeout};

/// The longest time that a request may take.
const REQUEST_TIME: Duration = Duration::from_secs(2);
/// The most bytes of a request.
const MAX_REQUEST: usize = 8 * 1024;
/// Time to wait after an error of accepting a connection, such as too many open files.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// Answers requests, one after the other.
pub(super) async fn serve(state: Arc<SharedState>, listener: TcpListener) {
    loop {
        match listener.accept().await {
            Ok((stream, _)) => drop(timeout(REQUEST_TIME, answer(&stream, &state)).await),
            Err(_) => sleep(ACCEPT_PAUSE).await,
        }
    }
}

/// Answers one request.
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
    let (status, text) = match path(&request) {
        b"/" | b"/metrics" => ("200 OK", state.metrics_text()),
        b"/health" if state.drain_deadline().is_some() => ("503 Service Unavailable", "draining\n".to_owned()),
        b"/health" => ("200 OK", "ok\n".to_owned()),
        _ => ("404 Not Found", "the pages are /metrics and /health\n".to_owned()),
    };
    let head = format!("HTTP/1.1 {status}\r\nContent-Type: text/plain; version=0.0.4\r\nConnection: close");
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

/// Returns the path of a request such as `GET /metrics HTTP/1.1`, whose method does not matter.
fn path(request: &[u8]) -> &[u8] {
    let line = request.split(|&byte| byte == b'\r').next().unwrap_or_default();
    line.split(|&byte| byte == b' ').nth(1).unwrap_or_default()
}
