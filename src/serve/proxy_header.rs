//! The header of the PROXY protocol, by which a load balancer tells the address of its client.

use proxy_header::{Error, ParseConfig, ProxyHeader};
use std::io;
use std::net::IpAddr;
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::time::timeout;

/// The longest time in which the header has to arrive.
const HEADER_TIME: Duration = Duration::from_secs(2);

/// The most bytes of a header.
// One of version 1 has at most 107. Those of version 2 that HAProxy sends by itself have 28, or 52 for IPv6; its
// optional fields fit, too.
const MAX_HEADER: usize = 512;

/// The header of a connection: the client's address, and the bytes that have been read after it.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct ReadHeader {
    /// The client's address; `None` for a connection of the load balancer itself, such as a check.
    pub(super) client: Option<IpAddr>,
    /// The client's first bytes.
    pub(super) rest: Vec<u8>,
}

/// Reads the header at the start of a connection; `None` if none arrives in time.
pub(super) async fn read(stream: &TcpStream) -> Option<ReadHeader> {
    timeout(HEADER_TIME, read_all(stream)).await.ok()?
}

async fn read_all(stream: &TcpStream) -> Option<ReadHeader> {
    let (mut bytes, mut part) = (Vec::new(), [0; MAX_HEADER]);
    loop {
        stream.readable().await.ok()?;
        match stream.try_read(&mut part) {
            Ok(0) => return None,
            Ok(count) => bytes.extend_from_slice(&part[..count]),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => continue,
            Err(_) => return None,
        }
        match parse(&bytes) {
            Ok((client, length)) => return Some(ReadHeader { client, rest: bytes.split_off(length) }),
            Err(Error::BufferTooShort) if bytes.len() < MAX_HEADER => {}
            Err(_) => return None,
        }
    }
}

/// Returns the client's address and the length of the header.
fn parse(bytes: &[u8]) -> Result<(Option<IpAddr>, usize), Error> {
    let config = ParseConfig { include_tlvs: false, ..ParseConfig::default() };
    let (header, length) = ProxyHeader::parse(bytes, config)?;
    Ok((header.proxied_address().map(|address| address.source.ip()), length))
}
