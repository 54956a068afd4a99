//! The server behind a load balancer: addresses by the PROXY protocol.

use crate::abuse::dial_from;
use crate::guest::{Anybody, Guest};
use crate::program::{ListeningProcess, Program, termtrace};
use crate::{Hosting, Place, run, until};
use russh::client;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;

/// The address of the load balancer.
const BALANCER: [u8; 4] = [127, 0, 9, 1];

fn behind_balancer(per_address: usize) -> Hosting {
    Hosting::start(|settings| {
        settings.proxies = vec!["127.0.9.0/24".parse().expect("a network")];
        settings.max_per_address = per_address;
    })
}

/// Returns a header of version 2 for a connection that is forwarded from this address.
fn version_2(client: [u8; 4]) -> Vec<u8> {
    let mut header = b"\r\n\r\n\0\r\nQUIT\n\x21\x11\0\x0c".to_vec();
    header.extend_from_slice(&client);
    header.extend_from_slice(&[127, 0, 0, 1, 0x13, 0x88, 0x08, 0xae]);
    header
}

/// Connects from the load balancer, and sends a header.
async fn forward(hosting: &Hosting, header: &[u8]) -> TcpStream {
    let mut stream = dial_from(BALANCER, hosting).await;
    stream.write_all(header).await.expect("it is taken");
    stream
}

/// Opens a view over a connection.
async fn enter(stream: TcpStream) -> Result<Guest, russh::Error> {
    let mut session = client::connect_stream(Arc::default(), stream, Anybody::default()).await?;
    session.authenticate_none("anybody").await?;
    let mut guest = Guest::on(session, (80, 24)).await;
    guest.channel.request_pty(true, "xterm-256color", 80, 24, 0, 0, &[]).await?;
    guest.ask(None).await;
    guest.see_picture().await;
    Ok(guest)
}

/// Returns the bytes that come before the connection is closed.
async fn read_to_end(mut stream: TcpStream) -> Vec<u8> {
    let mut bytes = Vec::new();
    // A closed connection with unread bytes is reset, which is an error of reading.
    let _ = stream.read_to_end(&mut bytes).await;
    bytes
}

#[test]
fn clients_behind_a_balancer_are_counted_by_their_own_address() {
    let hosting = behind_balancer(1);
    run(async {
        let first = forward(&hosting, b"PROXY TCP4 203.0.113.9 127.0.0.1 5000 2222\r\n").await;
        let _first = enter(first).await.expect("a first client");
        let _second = enter(forward(&hosting, &version_2([198, 51, 100, 7])).await).await.expect("of another address");
        let sixth = b"PROXY TCP6 2001:db8:7::1 ::1 5000 2222\r\n";
        let _third = enter(forward(&hosting, sixth).await).await.expect("of another address");
        let again = forward(&hosting, &version_2([203, 0, 113, 9])).await;
        assert!(read_to_end(again).await.is_empty(), "an address has one connection");
        // A connection of the load balancer itself, such as a check, has the load balancer's address.
        let mut check = forward(&hosting, b"\r\n\r\n\0\r\nQUIT\n\x20\0\0\0").await;
        let mut greeting = [0; 17];
        check.read_exact(&mut greeting).await.expect("a greeting");
        assert_eq!(&greeting, b"SSH-2.0-termtrace");
    });
    let expected = ["view viewer=0 from=203.0.113.0/24", "view viewer=1 from=198.51.100.0/24"];
    let log = hosting.log();
    assert!(log.iter().zip(expected).all(|(line, event)| line.starts_with(&format!("event={event}"))), "{log:?}");
    assert!(log.iter().any(|line| line.contains("viewer=2 from=2001:db8:7::/48 ")), "{log:?}");
    assert!(log.iter().any(|line| line == "event=refused from=203.0.113.0/24 reason=address"), "{log:?}");
}

#[test]
fn a_header_may_come_in_pieces_and_with_the_clients_bytes() {
    let hosting = behind_balancer(10);
    run(async {
        let mut stream = forward(&hosting, b"P").await;
        for byte in b"ROXY TCP4 203.0.113.9 127.0.0.1 5000 2222\r\n" {
            stream.write_all(&[*byte]).await.expect("it is taken");
            stream.flush().await.expect("it is sent");
            tokio::task::yield_now().await;
        }
        enter(stream).await.expect("a client");
        let mut both = version_2([203, 0, 113, 9]);
        both.extend_from_slice(b"SSH-2.0-together\r\n");
        let mut stream = forward(&hosting, &both).await;
        // After both greetings the server sends its algorithms, whose names are plain text.
        let mut answer = Vec::new();
        while !answer.windows(10).any(|window| window == b"mlkem768x2") {
            assert!(stream.read_buf(&mut answer).await.is_ok_and(|count| count > 0), "{answer:?}");
        }
    });
}

#[test]
fn a_balancer_without_a_header_is_refused() {
    let hosting = behind_balancer(10);
    let long = [b"\r\n\r\n\0\r\nQUIT\n\x21\x11\xff\xff".to_vec(), vec![0; 2000]].concat();
    let headers: [&[u8]; 6] = [
        b"SSH-2.0-OpenSSH_9.2\r\n",
        b"PROXY TCP4 x 127.0.0.1 5000 2222\r\n",
        &[b'P'; 600],
        b"\r\n\r\n\0\r\nQUIT\n\x31\x11\0\x0c",
        &long,
        // Nothing at all, for the longest time that a header may take.
        b"",
    ];
    run(async {
        for header in headers {
            assert!(read_to_end(forward(&hosting, header).await).await.is_empty(), "{header:?}");
        }
        until("all refusals are in the log", || hosting.log().len() == headers.len()).await;
    });
    let log = hosting.log();
    assert!(log.iter().all(|line| line == "event=refused from=127.0.9.0/24 reason=header"), "{log:?}");
}

#[test]
fn row_29_an_address_that_is_no_balancer_cannot_claim_another_one() {
    let hosting = behind_balancer(1);
    run(async {
        // The first client sends nothing, so that it keeps the address's only place: the server would close a
        // connection whose greeting is a header, and admit another one.
        let mut first = dial_from([127, 0, 8, 1], &hosting).await;
        first.read_exact(&mut [0; 17]).await.expect("a greeting");
        for client in 1..=2 {
            let mut stream = dial_from([127, 0, 8, 1], &hosting).await;
            let header = format!("PROXY TCP4 203.0.113.{client} 127.0.0.1 5000 2222\r\n");
            // The connection may be closed already.
            let _ = stream.write_all(header.as_bytes()).await;
            assert!(read_to_end(stream).await.is_empty(), "the address has a connection");
        }
        Guest::enter(&hosting).await.see_picture().await;
    });
    let log = hosting.log();
    let refused = |line: &&String| *line == "event=refused from=127.0.8.0/24 reason=address";
    assert_eq!(log.iter().filter(refused).count(), 2, "{log:?}");
    assert!(!log.iter().any(|line| line.contains("203.0.113")), "{log:?}");
}

#[test]
fn networks_are_checked() {
    for network in ["10.0.0.0/33", "example.org", "10.0.0.0/8,"] {
        let output = termtrace(&["three_spheres", "--proxy-protocol", network]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains("network"), "{message}");
    }
}

/// Starts `haproxy` before these replicas; `None` if it is not installed.
///
/// Its settings are those of `docs/serve.md` but for addresses and times.
fn haproxy(folder: &std::path::Path, replicas: &[&Program]) -> Option<ListeningProcess> {
    if Command::new("haproxy").arg("-v").output().is_err() {
        eprintln!("skipped: there is no haproxy");
        return None;
    }
    let documented = include_str!("../../docs/serve.md").split("```text\nfrontend visitors").nth(1);
    let documented = documented.and_then(|rest| rest.split("```").next()).expect("an example");
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address");
    let [one, two] = [0, 1].map(|at| replicas[at].address().to_string());
    let config = format!("frontend visitors{documented}").replace(":22\n", &format!("{address}\n"));
    let config = config.replace("10.0.0.11:2222", &one).replace("10.0.0.12:2222", &two);
    // The time of a check is otherwise that between two, which a busy machine may miss.
    let config =
        config.replace("inter 2s", "inter 100ms").replace("timeout server", "timeout check 20s\n    timeout server");
    let path = folder.join("haproxy.cfg");
    std::fs::write(&path, config).expect("a file");
    // The port is free again, for HAProxy.
    drop(listener);
    let mut command = Command::new("haproxy");
    command.arg("-db").arg("-f").arg(path).stdout(Stdio::null()).stderr(Stdio::null());
    Some(ListeningProcess { child: command.spawn().expect("it runs"), address })
}

/// Returns the number of views that a replica has opened.
fn views(replica: &Program) -> usize {
    replica.errors().lines().filter(|line| line.starts_with("event=view ")).count()
}

/// Waits until a replica can be reached through `haproxy`.
async fn until_up(haproxy: &ListeningProcess) {
    let end = Instant::now() + crate::PATIENCE;
    while Instant::now() < end {
        if let Ok(mut stream) = TcpStream::connect(haproxy.address).await {
            let mut greeting = [0; 8];
            if stream.read_exact(&mut greeting).await.is_ok() {
                return;
            }
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    panic!("no replica can be reached");
}

#[test]
fn one_replica_behind_haproxy_drains_while_viewers_stay_on_the_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["three_spheres", "--listen", "127.0.0.1:0", "--proxy-protocol", "127.0.0.0/8"];
    let arguments = [&arguments[..], &["--max-per-address", "100"]].concat();
    let first = Program::start_in("exec", &arguments);
    // The second one gets a copy of the first one's host key, whose path is its fourth argument.
    let second = Program::start_in(&format!("cp -p {} \"$4\"; exec", first.key().display()), &arguments);
    let Some(haproxy) = haproxy(folder.path(), &[&first, &second]) else { return };
    run(async {
        until_up(&haproxy).await;
        // Some on each, as they come.
        let (mut on_first, mut on_second) = (Vec::new(), Vec::new());
        while on_first.len() < 2 || on_second.len() < 2 {
            assert!(on_first.len() + on_second.len() < 20, "all visitors come to one replica");
            let before = views(&first);
            let mut guest = Guest::enter(&haproxy).await;
            guest.see_picture().await;
            if views(&first) > before { &mut on_first } else { &mut on_second }.push(guest);
        }
        first.terminate();
        for guest in &mut on_first {
            guest.see_text("the server restarts: you leave in").await;
        }
        // New visitors get in at once, on the other one.
        let before = views(&second);
        for _ in 0..4 {
            Guest::enter(&haproxy).await.see_picture().await;
        }
        until("they are on the second one", || views(&second) == before + 4).await;
        // Those of the first one leave in their time, and those of the second one notice nothing.
        for mut guest in on_first {
            guest.send(b"q").await;
            assert_eq!(guest.leave().await, Some(0));
            guest.assert_clean();
        }
        for guest in &mut on_second {
            guest.send(b"i").await;
            guest.see_text("q quit").await;
            assert!(!guest.has("restarts"));
        }
    });
    let hosts = |program: &Program| std::fs::read(program.key()).expect("a key");
    assert_eq!(hosts(&first), hosts(&second));
}
