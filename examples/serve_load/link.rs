//! A slow link between a visitor and the server.

use std::time::{Duration, Instant};
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream};
use tokio::net::TcpStream;
use tokio::sync::mpsc;
use tokio::time::sleep_until;

/// Bytes per second of a slow link, each way.
const LINK_RATE: f64 = 50_000.0;
/// The time that a byte takes through it, each way.
const LINK_DELAY: Duration = Duration::from_millis(100);
/// The size of a packet, and how many wait for the link.
const PACKET: (usize, usize) = (1024, 48);

/// Connects through a slow link.
pub(crate) async fn link_to(address: &str) -> Option<DuplexStream> {
    let (near, far) = tokio::io::duplex(16 * 1024);
    let (from_server, to_server) = TcpStream::connect(address).await.ok()?.into_split();
    let (from_client, to_client) = tokio::io::split(far);
    tokio::task::spawn_local(pass(from_server, to_client));
    tokio::task::spawn_local(pass(from_client, to_server));
    Some(near)
}

/// Passes bytes on at the rate of the link and after its delay.
async fn pass(mut from: impl AsyncReadExt + Unpin + 'static, mut to: impl AsyncWriteExt + Unpin + 'static) {
    let (under_way, mut arriving) = mpsc::unbounded_channel::<(Instant, Vec<u8>)>();
    let (queue, mut queued) = mpsc::channel::<Vec<u8>>(PACKET.1);
    tokio::task::spawn_local(async move {
        let mut free_at = Instant::now();
        while let Some(packet) = queued.recv().await {
            free_at = free_at.max(Instant::now()) + Duration::from_secs_f64(packet.len() as f64 / LINK_RATE);
            sleep_until(free_at.into()).await;
            let _ = under_way.send((free_at + LINK_DELAY, packet));
        }
    });
    tokio::task::spawn_local(async move {
        while let Some((due, packet)) = arriving.recv().await {
            sleep_until(due.into()).await;
            if to.write_all(&packet).await.is_err() {
                return;
            }
        }
    });
    let mut packet = [0; PACKET.0];
    while let Ok(count @ 1..) = from.read(&mut packet).await {
        if queue.send(packet[..count].to_vec()).await.is_err() {
            return;
        }
    }
}
