//! Abuse by clients: the rows of the table in docs/serve.md, by their numbers.

use crate::guest::{Anybody, Guest, connect, log_in};
use crate::program::Program;
use crate::{Hosting, Place, run, until};
use russh::client;
use russh::client::AuthResult;
use russh::{ChannelMsg, MethodKind};
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpSocket, TcpStream};
use tokio::time::{sleep, timeout};

/// Returns a connection from another address of this machine.
pub(crate) async fn dial_from(host: [u8; 4], place: &impl Place) -> TcpStream {
    let socket = TcpSocket::new_v4().expect("a socket");
    socket.bind((host, 0).into()).expect("all of 127/8 are addresses of this machine");
    socket.connect(place.address()).await.expect("a connection")
}

#[test]
fn row_01_no_password_is_asked_for() {
    let hosting = Hosting::start(|settings| settings.authorized_keys = Some(Vec::new()));
    run(async {
        let mut session = connect(&hosting).await;
        let AuthResult::Failure { remaining_methods, .. } = session.authenticate_none("root").await.expect("an answer")
        else {
            panic!("only keys are let in");
        };
        assert_eq!(remaining_methods.iter().collect::<Vec<_>>(), [&MethodKind::PublicKey]);
        let answer = session.authenticate_password("root", "toor").await.expect("an answer");
        assert!(!answer.success());
    });
}

#[test]
fn row_02_a_command_is_a_scene_or_nothing() {
    let hosting = Hosting::usual();
    run(async {
        let long = "x".repeat(3000);
        for command in ["../../etc/passwd", "x;id", "three_spheres; id", "/bin/sh", "\x1b[2J", &long] {
            let mut guest = Guest::without_terminal(&hosting, (80, 24)).await;
            guest.ask(Some(command)).await;
            assert_eq!(guest.leave().await, Some(2), "{command}");
            let message = String::from_utf8_lossy(&guest.errors).into_owned();
            assert!(message.starts_with("error: a command is the name of a scene, or --list"), "{message}");
            assert!(guest.bytes.is_empty());
        }
        // More than a packet may have: at most this connection ends.
        let mut guest = Guest::without_terminal(&hosting, (80, 24)).await;
        let _ = guest.channel.exec(true, "x".repeat(300 * 1024)).await;
        assert_ne!(guest.leave().await, Some(0));
        assert!(guest.bytes.is_empty());
        Guest::enter(&hosting).await.see_picture().await;
    });
}

#[test]
fn row_03_nothing_is_forwarded() {
    let hosting = Hosting::usual();
    run(async {
        let mut guest = Guest::enter(&hosting).await;
        guest.see_picture().await;
        let port = u32::from(hosting.address().port());
        assert!(guest.session.channel_open_direct_tcpip("127.0.0.1", port, "127.0.0.1", 1).await.is_err());
        assert!(guest.session.channel_open_direct_streamlocal("/run/x").await.is_err());
        assert!(guest.session.channel_open_x11("127.0.0.1", 1).await.is_err());
        assert!(guest.session.channel_open_session().await.is_err(), "a second channel");
        assert!(guest.session.tcpip_forward("127.0.0.1", 0).await.is_err());
        guest.channel.agent_forward(false).await.expect("it is sent");
        // The view goes on.
        guest.send(b"i").await;
        guest.see_text("three_spheres").await;

        let mut other = Guest::without_terminal(&hosting, (80, 24)).await;
        other.channel.request_subsystem(true, "sftp").await.expect("it is sent");
        assert!(matches!(other.channel.wait().await, Some(ChannelMsg::Failure)));
    });
}

#[test]
fn row_04_silent_connections_are_closed_and_block_no_others() {
    let hosting = Hosting::start(|settings| settings.login_time = Duration::from_secs(3));
    run(async {
        let mut silent = Vec::new();
        for number in 0..100 {
            silent.push(dial_from([127, 0, 1, number], &hosting).await);
        }
        // Half a banner is as good as none.
        silent[0].write_all(b"SSH-2.0-").await.expect("it is taken");
        let closed = async {
            for stream in &mut silent {
                let mut bytes = Vec::new();
                let _ = stream.read_to_end(&mut bytes).await;
            }
        };
        timeout(crate::PATIENCE, closed).await.expect("all are closed");
        Guest::enter(&hosting).await.see_picture().await;
    });
}

#[test]
fn row_04_silent_connections_block_only_their_own_address() {
    let hosting = Hosting::usual();
    run(async {
        let mut silent = Vec::new();
        for _ in 0..500 {
            silent.push(dial_from([127, 0, 4, 1], &hosting).await);
        }
        let mut times = Vec::new();
        for _ in 0..3 {
            let asked = Instant::now();
            Guest::enter(&hosting).await.see_picture().await;
            times.push(asked.elapsed());
        }
        // A second is promised of a machine without other work.
        println!("beside 500 silent connections a picture takes {times:?}");
        assert!(times.iter().any(|&time| time < Duration::from_secs(10)), "{times:?}");
    });
}

#[test]
fn row_05_a_storm_is_refused_and_others_are_let_in() {
    let hosting = Hosting::usual();
    run(async {
        let mut streams = Vec::new();
        for _ in 0..500 {
            streams.push(dial_from([127, 0, 2, 1], &hosting).await);
        }
        until("most are refused", || hosting.log().len() > 450).await;
        let log = hosting.log();
        assert!(
            log.iter().all(|line| line.starts_with("event=refused from=127.0.2.0/24 reason=")),
            "{:?}",
            log.first()
        );
        Guest::enter(&hosting).await.see_picture().await;
    });
}

#[test]
fn row_07_a_client_that_takes_nothing_is_shown_out() {
    let hosting = Hosting::start(|settings| settings.patience = Duration::from_secs(3));
    run(async {
        let mut guest = Guest::enter_with_little_room(&hosting).await;
        guest.see_picture().await;
        guest.send(b"t").await;
        // A channel that is not read blocks its connection, in this client too.
        until("the viewer is gone", || hosting.server.viewers() == 0).await;
    });
}

#[test]
fn row_09_any_size_is_drawn_and_many_are_one() {
    let hosting = Hosting::usual();
    run(async {
        let mut huge = Guest::without_terminal(&hosting, (500, 200)).await;
        huge.channel.request_pty(true, "xterm", u32::MAX, u32::MAX, u32::MAX, u32::MAX, &[]).await.expect("sent");
        huge.ask(None).await;
        huge.see_picture().await;
        let mut none = Guest::without_terminal(&hosting, (80, 24)).await;
        none.channel.request_pty(true, "xterm", 0, 0, 0, 0, &[]).await.expect("sent");
        none.ask(None).await;
        none.see_picture().await;
        for size in 0..10_000 {
            none.channel.window_change(1 + size % 300, 1 + size % 100, 0, 0).await.expect("sent");
        }
        none.resize_screen(90, 30);
        none.channel.window_change(90, 30, 0, 0).await.expect("sent");
        none.see("the last size", |guest| guest.text().get(29).is_some_and(|row| row.contains("q quits"))).await;
    });
}

#[test]
fn row_10_variables_are_few() {
    let hosting = Hosting::usual();
    run(async {
        let mut guest = Guest::without_terminal(&hosting, (80, 24)).await;
        for number in 0..10_000 {
            guest.channel.set_env(false, format!("LC_{number}"), "x").await.expect("sent");
        }
        guest.channel.set_env(false, "LD_PRELOAD", "evil.so").await.expect("sent");
        guest.channel.request_pty(false, "xterm\x1b[31m\n../../x", 80, 24, 0, 0, &[]).await.expect("sent");
        guest.ask(None).await;
        guest.see("a picture without colours", |guest| guest.has("q quits")).await;
        assert!(std::env::var_os("LC_9999").is_none() && !guest.has("evil"));
    });
}

#[test]
fn row_11_a_name_reaches_no_log() {
    let hosting = Hosting::usual();
    run(async {
        let mut session = connect(&hosting).await;
        let name = "root\x1b[2J\n2026 accepted";
        assert!(session.authenticate_none(name).await.expect("an answer").success());
        drop(session);
        drop(log_in(&hosting).await);
        assert!(hosting.log().iter().all(|line| !line.contains(char::is_control) && !line.contains("accepted")));
    });
}

#[test]
fn row_12_floods_of_input_raise_no_rate_and_block_no_key() {
    let hosting = Hosting::start(|settings| settings.max_frames = 10.0);
    run(async {
        let mut guest = Guest::enter(&hosting).await;
        guest.see_picture().await;
        // Many forged replies, and a key whose answer is longer than the key.
        let paste = b"\x1b[?62;22c\x1b[1;1R\x1b[?200;0$yy".repeat(10_000);
        guest.send(&paste).await;
        guest.send(b"\x1b").await;
        sleep(Duration::from_millis(100)).await;
        guest.send(b"\x03").await;
        assert_eq!(guest.leave().await, Some(0));
        guest.assert_clean();
    });
}

#[test]
fn row_16_garbage_ends_its_own_connection_only() {
    let hosting = Hosting::start(|settings| settings.max_per_address = 1000);
    run(async {
        let mut guest = Guest::enter(&hosting).await;
        guest.see_picture().await;
        let mut seed = 1_u64;
        for number in 0..300 {
            let mut stream = dial_from([127, 0, 3, 1], &hosting).await;
            if number % 2 == 0 {
                let _ = stream.write_all(b"SSH-2.0-x\r\n").await;
            }
            let mut garbage = [0_u8; 4096];
            for byte in &mut garbage {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                *byte = (seed >> 33) as u8;
            }
            let _ = stream.write_all(&garbage).await;
        }
        guest.send(b"i").await;
        guest.see_text("three_spheres").await;
    });
}

/// Passes bytes on in both directions, but for one bit of what the client sends, which is flipped.
async fn flip_a_bit(listener: TcpListener, server: SocketAddr, at: usize) {
    let (client, _) = listener.accept().await.expect("the client");
    let server = TcpStream::connect(server).await.expect("the server");
    let (mut from_client, mut to_client) = client.into_split();
    let (mut from_server, mut to_server) = server.into_split();
    let replies = tokio::spawn(async move { tokio::io::copy(&mut from_server, &mut to_client).await });
    let (mut passed, mut part) = (0, [0; 1024]);
    while let Ok(count @ 1..) = from_client.read(&mut part).await {
        if let Some(byte) = at.checked_sub(passed).and_then(|at| part[..count].get_mut(at)) {
            *byte ^= 1 << (at % 8);
        }
        passed += count;
        if to_server.write_all(&part[..count]).await.is_err() {
            break;
        }
    }
    replies.abort();
}

#[test]
fn row_16_a_changed_handshake_ends_its_own_connection_only() {
    let program = Program::start(&["three_spheres", "--max-per-address", "1000"]);
    run(async {
        let mut guest = Guest::enter(&program).await;
        guest.see_picture().await;
        // A handshake of this client has about 2,500 bytes; the login follows.
        for at in (0..3000).step_by(61) {
            let listener = TcpListener::bind("127.0.0.1:0").await.expect("a port");
            let address = listener.local_addr().expect("an address");
            let passing = tokio::spawn(flip_a_bit(listener, program.address(), at));
            let config = Arc::new(client::Config::default());
            let visit = async {
                let mut session = client::connect(config, address, Anybody::default()).await?;
                session.authenticate_none("anybody").await
            };
            let _ = timeout(Duration::from_millis(300), visit).await;
            passing.abort();
        }
        guest.send(b"i").await;
        guest.see_text("three_spheres").await;
    });
    assert!(!program.errors().contains("panicked"), "{}", program.errors());
}

#[test]
fn row_20_a_panic_ends_one_view() {
    let hosting = Hosting::usual();
    hosting.server.panic_at(b'%');
    run(async {
        let mut others = Vec::new();
        for _ in 0..4 {
            let mut guest = Guest::enter(&hosting).await;
            guest.see_picture().await;
            others.push(guest);
        }
        let mut guest = Guest::enter(&hosting).await;
        guest.see_picture().await;
        guest.send(b"%").await;
        assert_eq!(guest.leave().await, Some(1));
        guest.assert_clean();
        assert!(guest.has("a fault of the server ended this view"));
        for mut guest in others {
            guest.send(b"i").await;
            guest.see_text("three_spheres").await;
        }
    });
}

#[test]
fn row_23_one_who_was_told_to_leave_and_stays_is_shown_out() {
    let hosting = Hosting::usual();
    run(async {
        let mut guest = Guest::enter(&hosting).await;
        guest.see_picture().await;
        guest.send(b"q").await;
        guest.leave().await;
        // The client keeps its connection.
        until("the connection is closed", || guest.session.is_closed()).await;
    });
}

/// The shell that gets the terminal back must not read replies as typed text.
#[test]
fn row_25_no_reply_is_left_for_the_shell() {
    let hosting = Hosting::usual();
    run(async {
        let (mut delays, mut tries) = ([30, 150, 400].into_iter().peekable(), 0);
        while let Some(&delay) = delays.peek() {
            let mut guest = Guest::without_terminal(&hosting, (80, 24)).await;
            guest.delay = Duration::from_millis(delay);
            guest.channel.request_pty(true, "xterm-256color", 80, 24, 0, 0, &[]).await.expect("a terminal");
            guest.ask(None).await;
            guest.see_picture().await;
            guest.send(b"t").await;
            let before = guest.bytes.len();
            guest.see("a moving picture", |guest| guest.bytes.len() > before + 3000).await;
            guest.send(b"q").await;
            let left = Instant::now();
            assert_eq!(guest.leave().await, Some(0));
            // The server waits for a second, which is too short if this client is not scheduled for as long.
            tries += 1;
            let is_late = left.elapsed() > Duration::from_millis(900) && tries < 10;
            assert!(guest.unanswered() == 0 || is_late, "with answers after {delay} ms");
            delays.next_if(|_| guest.unanswered() == 0);
        }
    });
}
