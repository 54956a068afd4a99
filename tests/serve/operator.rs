//! The server for its operator: flags, file of settings, counts, signals and unit of systemd.

use crate::counter::{Counter, run_all};
use crate::guest::{Anybody, Guest, connect, connect_as};
use crate::openssh::free_port;
use crate::program::{ListeningProcess, Program, termtrace};
use crate::pty::{SOON, Start};
use crate::sharing::{TRIES, are_alike, counting};
use crate::together::rest_of_all;
use crate::{Hosting, Place, run, until};
use russh::keys::ssh_key::private::{Ed25519Keypair, KeypairData};
use russh::keys::{PrivateKey, PrivateKeyWithHashAlg};
use rustix::process::Signal;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::Duration;
use tempfile::TempDir;

pub(crate) fn folder_with(name: &str, text: &str) -> (TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    fs::write(&path, text).expect("a file");
    (folder, path.to_str().expect("UTF-8").to_owned())
}

#[test]
fn an_address_for_everyone_needs_public() {
    for address in ["0.0.0.0:0", "[::]:0", "192.0.2.1:22"] {
        let output = termtrace(&["three_spheres", "--listen", address, "--host-key", "/nonexistent/key"]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        let expected = format!("--listen {address}: other machines can reach this address; --public allows that");
        assert!(message.contains(&expected), "{message}");
    }
    let program = Program::start_in("exec", &["three_spheres", "--listen", "0.0.0.0:0", "--public"]);
    run(async { Guest::enter(&program).await.see_picture().await });
}

#[test]
fn counts_are_for_the_servers_own_machine() {
    let output = termtrace(&["three_spheres", "--metrics", "192.0.2.1:9100", "--host-key", "/nonexistent/key"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    let expected =
        "other machines could read the counts at this address; use one of this machine, such as 127.0.0.1:9100";
    assert!(message.contains(expected), "{message}");
}

#[test]
fn a_file_has_settings_and_flags_go_before_it() {
    let settings = r#"(listen: "127.0.0.1:0", max_viewers: 1, link: "https://example.org/of-the-file", fps: 20)"#;
    let (_folder, path) = folder_with("serve.ron", settings);
    let flags = ["three_spheres", "--config", &path, "--link", "https://example.org/of-the-flag"];
    let program = Program::start_in("exec", &flags);
    run(async {
        let mut first = Guest::enter(&program).await;
        first.see_text("https://example.org/of-the-flag").await;
        Guest::enter(&program).await.see_text("full, 0 ahead of you").await;
    });
    let faults = [
        (r#"(listen: "0.0.0.0:0")"#, "--public allows that"),
        ("(max_viewer: 3)", "max_viewer"),
        ("(idle: \"soon\")", "90s, 10m or 1h"),
        ("(", "serve.ron:1"),
    ];
    for (text, expected) in faults {
        let (_folder, path) = folder_with("serve.ron", text);
        let output = termtrace(&["three_spheres", "--config", &path]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}: {message}");
        assert!(message.contains(expected), "{text}: {message}");
    }
}

pub(crate) fn key(seed: u8) -> PrivateKey {
    let keys = Ed25519Keypair::from_seed(&[seed; 32]);
    PrivateKey::new(KeypairData::Ed25519(keys), "a visitor").expect("a key")
}

#[test]
fn row_01_only_the_keys_of_a_file_are_let_in() {
    let known = key(1).public_key().to_openssh().expect("a line");
    let (_folder, path) = folder_with("keys", &format!("# visitors\n\n{known}\n"));
    let program = Program::start(&["three_spheres", "--authorized-keys", &path]);
    run(async {
        let knock = async |seed| {
            let mut session = connect(&program).await;
            let key = PrivateKeyWithHashAlg::new(Arc::new(key(seed)), None);
            session.authenticate_publickey("anybody", key).await.expect("an answer").success()
        };
        assert!(knock(1).await, "this key is in the file");
        assert!(!knock(2).await, "this key is not");
        assert!(!connect(&program).await.authenticate_none("anybody").await.expect("an answer").success());
    });
    let (_folder, path) = folder_with("keys", "ssh-ed25519 AAAA broken\n");
    let output = termtrace(&["three_spheres", "--authorized-keys", &path]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(1) && message.contains("line 1: no public key"), "{message}");
}

#[test]
fn a_banner_goes_before_the_login_and_controls_nothing() {
    let (_folder, path) = folder_with("banner", "Welcome\n\x1b[31mred\x1b]0;title\x07\n");
    let program = Program::start(&["three_spheres", "--banner", &path]);
    run(async {
        let client = Anybody::default();
        let banner = Arc::clone(&client.banner);
        assert!(connect_as(&program, client).await.authenticate_none("x").await.expect("an answer").success());
        let banner = banner.lock().expect("no holder of this lock panics").clone();
        assert!(banner.starts_with("Welcome\r\n") && banner.contains("red"), "{banner:?}");
        assert!(!banner.contains(['\x1b', '\x07']), "{banner:?}");
    });
    let (_folder, path) = folder_with("banner", &"x".repeat(5000));
    let output = termtrace(&["three_spheres", "--banner", &path]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(1) && message.contains("at most 4096 bytes"), "{message}");
}

/// The texts have escape sequences and bidirectional controls, and 10 KB.
#[test]
fn row_30_names_banners_and_links_control_nothing() {
    const HOSTILE: &str = "\x1b]0;title\x07\x1b[2J\u{9b}31m\u{202e}\u{2066}evil\u{200b}";
    let long = HOSTILE.to_owned() + &"x".repeat(10_000);
    let scene = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1)])";
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(format!("{HOSTILE}.ron"));
    fs::write(&path, scene).expect("a file");
    let banner = folder.path().join("banner");
    fs::write(&banner, format!("{HOSTILE}\n").repeat(20)).expect("a file");
    let [path, banner] = [path, banner].map(|path| path.to_str().expect("UTF-8").to_owned());
    let program = Program::start(&[&path, "--banner", &banner, "--link", &long]);
    let is_hostile = |text: &str| {
        let parts = ["\x1b]0;", "\x07", "\x1b[2J", "\u{9b}", "\u{202e}", "\u{2066}", "\u{200b}"];
        parts.into_iter().find(|part| text.contains(part)).map(|part| format!("{part:?} in {text:?}"))
    };
    run(async {
        let client = Anybody::default();
        let heard = Arc::clone(&client.banner);
        let mut session = connect_as(&program, client).await;
        assert!(session.authenticate_none(&long).await.expect("an answer").success());
        assert_eq!(is_hostile(&heard.lock().expect("no holder of this lock panics")), None);
        let mut guest = Guest::on(session, (80, 24)).await;
        guest.channel.request_pty(true, &long, 80, 24, 0, 0, &[]).await.expect("a terminal");
        guest.ask(None).await;
        // The link is cut, so that the keys beside it have room.
        guest.see_text("evil").await;
        assert!(guest.text().iter().any(|row| row.contains("q quits")), "{:?}", guest.text());
        guest.send(b"i").await;
        guest.see_text("q quit").await;
        guest.send(b"q").await;
        assert_eq!(guest.leave().await, Some(0));
        guest.assert_clean();
        assert_eq!(is_hostile(&String::from_utf8_lossy(&guest.bytes)), None);

        let mut list = Guest::without_terminal(&program, (80, 24)).await;
        list.ask(Some("--list")).await;
        list.see("the list", |guest| guest.has("evil")).await;
        assert_eq!(is_hostile(&String::from_utf8_lossy(&list.bytes)), None);
        let mut other = Guest::without_terminal(&program, (80, 24)).await;
        other.ask(Some(&long)).await;
        other.leave().await;
        assert_eq!(is_hostile(&String::from_utf8_lossy(&other.errors)), None);
    });
    let log = program.errors();
    assert!(log.lines().any(|line| line.starts_with("event=view ")), "{log}");
    assert_eq!(is_hostile(&log), None);
}

#[test]
fn all_viewers_together_have_a_rate_and_share_it() {
    const RATE: u32 = 200_000;
    let _counting = counting();
    let hosting = Hosting::start(|settings| settings.max_rate_total = Some(RATE));
    run(async {
        let mut counters = Vec::new();
        for _ in 0..4 {
            counters.push(Counter::enter(&hosting, (80, 24), Duration::ZERO).await);
        }
        run_all(&mut counters, Duration::from_secs(2)).await;
        let mut seen: Vec<Vec<usize>> = Vec::new();
        // Bytes that were sent before the interval and arrive in it are counted: a fifth more is allowed.
        let is_shared =
            |bytes: &Vec<usize>| bytes.iter().sum::<usize>() < 4 * RATE as usize * 12 / 10 && are_alike(bytes);
        while !seen.last().is_some_and(is_shared) {
            assert!(seen.len() < TRIES, "{seen:?}");
            let before: Vec<_> = counters.iter().map(|counter| counter.bytes).collect();
            run_all(&mut counters, Duration::from_secs(4)).await;
            seen.push(counters.iter().zip(before).map(|(counter, before)| counter.bytes - before).collect());
        }
    });
}

/// Returns the value of a row of the counts.
pub(crate) fn value(counts: &str, name: &str) -> Option<f64> {
    counts.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' ')?.parse().ok())
}

/// Returns the status and the body of a page of the server.
fn page(hosting: &Hosting, path: &str) -> (String, String) {
    let mut stream = TcpStream::connect(hosting.server.metrics_address().expect("an address")).expect("it listens");
    stream.write_all(format!("GET {path} HTTP/1.1\r\nHost: x\r\n\r\n").as_bytes()).expect("it is taken");
    let mut response = String::new();
    stream.read_to_string(&mut response).expect("text");
    let (head, body) = response.split_once("\r\n\r\n").expect("a body");
    let status = head.lines().next().and_then(|line| line.strip_prefix("HTTP/1.1 ")).expect("a status");
    (status.to_owned(), body.to_owned())
}

pub(crate) fn counts(hosting: &Hosting) -> String {
    let (status, counts) = page(hosting, "/metrics");
    assert_eq!(status, "200 OK", "{counts}");
    counts
}

#[test]
fn row_19_the_log_has_events_and_truncated_addresses() {
    let hosting = Hosting::start(|settings| settings.max_per_address = 2);
    run(async {
        let mut guest = Guest::enter_with(&hosting, (90, 30), Some("corridor")).await;
        guest.see_picture().await;
        let mut other = Guest::enter(&hosting).await;
        other.see_picture().await;
        let mut refused = tokio::net::TcpStream::connect(hosting.address()).await.expect("the socket is accepted");
        let _ = tokio::io::AsyncReadExt::read_to_end(&mut refused, &mut Vec::new()).await;
        guest.send(b"q").await;
        assert_eq!(guest.leave().await, Some(0));
        until("the end of the view is in the log", || hosting.log().len() == 4).await;
        drop(other);
        until("the end of the connection is in the log", || hosting.log().len() == 5).await;
    });
    let log = hosting.log();
    let expected = [
        "event=view viewer=0 from=127.0.0.0/24 scene=corridor columns=90 rows=30",
        "event=view viewer=1 from=127.0.0.0/24 scene=three_spheres columns=80 rows=24",
        "event=refused from=127.0.0.0/24 reason=address",
        "event=leave viewer=0 reason=quit seconds=",
        "event=leave viewer=1 reason=hang_up seconds=",
    ];
    assert!(log.iter().zip(expected).all(|(line, start)| line.starts_with(start)), "{log:?}");
}

#[test]
fn the_health_check_fails_while_draining() {
    let hosting = Hosting::start(|settings| settings.metrics = Some(([127, 0, 0, 1], 0).into()));
    assert_eq!(page(&hosting, "/health"), ("200 OK".to_owned(), "ok\n".to_owned()));
    assert_eq!(page(&hosting, "/other").0, "404 Not Found");
    run(async {
        let mut guest = Guest::enter(&hosting).await;
        guest.see_picture().await;
        hosting.server.drain();
        guest.see_text("the server restarts: you leave in").await;
        assert_eq!(page(&hosting, "/health"), ("503 Service Unavailable".to_owned(), "draining\n".to_owned()));
        assert_eq!(value(&counts(&hosting), "termtrace_draining"), Some(1.0));
        guest.send(b"q").await;
        assert_eq!(guest.leave().await, Some(0));
    });
}

#[test]
fn row_19_the_counts_can_be_read_and_contain_no_names() {
    let hosting = Hosting::start(|settings| {
        settings.metrics = Some(([127, 0, 0, 1], 0).into());
        settings.max_per_address = 2;
    });
    let before = counts(&hosting);
    assert_eq!(value(&before, "termtrace_viewers"), Some(0.0));
    run(async {
        let mut guests = Vec::new();
        for _ in 0..2 {
            let mut guest = Guest::enter(&hosting).await;
            guest.see_picture().await;
            guests.push(guest);
        }
        let mut refused = tokio::net::TcpStream::connect(hosting.address()).await.expect("the socket is accepted");
        let _ = tokio::io::AsyncReadExt::read_to_end(&mut refused, &mut Vec::new()).await;
    });
    let after = counts(&hosting);
    for (name, least) in [
        ("termtrace_connections_total", 2.0),
        ("termtrace_refused_total{reason=\"address\"}", 1.0),
        ("termtrace_logins_total", 2.0),
        ("termtrace_visits_total", 2.0),
        ("termtrace_frames_total", 2.0),
        ("termtrace_sent_bytes_total", 5000.0),
        ("termtrace_pictures_total{from=\"tracer\"}", 1.0),
        ("termtrace_turn_cpu_seconds_total", 0.0001),
    ] {
        assert!(value(&after, name).is_some_and(|value| value >= least), "{name}: {after}");
    }
    assert_eq!(value(&after, "termtrace_panics_total"), Some(0.0));
    assert!(!after.contains("127.0.0.1") && !after.contains("anybody"), "{after}");
    let output = termtrace(&["three_spheres", "--metrics", "0.0.0.0:9100"]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
}

#[test]
fn row_26_equal_pictures_are_traced_once() {
    let hosting = Hosting::start(|settings| settings.metrics = Some(([127, 0, 0, 1], 0).into()));
    let traced = || value(&counts(&hosting), "termtrace_pictures_total{from=\"tracer\"}");
    run(async {
        let mut first = Guest::enter(&hosting).await;
        first.see_picture().await;
        rest_of_all(&hosting, &mut [&mut first]).await;
        let before = traced();
        let mut second = Guest::enter(&hosting).await;
        second.see_picture().await;
        second.see("the final picture", |guest| guest.text() == first.text()).await;
        assert_eq!(traced(), before, "{}", counts(&hosting));
        assert!(value(&counts(&hosting), "termtrace_pictures_total{from=\"memory\"}") > Some(0.0));
        // Another view is traced.
        second.send(b"w").await;
        until("another view is traced", || traced() > before).await;
    });
}

#[test]
fn row_18_a_signal_drains_and_a_second_one_ends_at_once() {
    let mut program = Program::start(&["three_spheres"]);
    run(async {
        let mut guest = Guest::enter(&program).await;
        guest.see_picture().await;
        program.terminate();
        let is_told = |guest: &Guest| {
            let told = |left: u32| guest.text().iter().any(|row| row.contains(&format!("you leave in {left} s")));
            guest.text().iter().any(|row| row.contains("the server restarts")) && (20..=30).any(told)
        };
        guest.see("the notice of the restart", is_told).await;
        assert!(tokio::net::TcpStream::connect(program.address()).await.is_err(), "new connections are refused");
        // A user who leaves before the time is over is not waited for.
        guest.send(b"q").await;
        assert_eq!(guest.leave().await, Some(0));
        guest.assert_clean();
    });
    assert!(program.process.child.wait().expect("it ends").success());

    let mut program = Program::start(&["three_spheres"]);
    run(async {
        let mut guest = Guest::enter(&program).await;
        guest.see_picture().await;
        program.terminate();
        guest.see_text("the server restarts: you leave in").await;
        program.terminate();
        guest.leave().await;
    });
    let status = program.process.child.wait().expect("it ends");
    assert_eq!(std::os::unix::process::ExitStatusExt::signal(&status), Some(15), "{status}");
}

#[test]
fn row_17_the_unit_gives_the_server_no_rights() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/termtrace.service");
    let unit = fs::read_to_string(path).expect("the unit is there");
    for line in [
        "DynamicUser=yes",
        "StateDirectory=termtrace",
        "NoNewPrivileges=yes",
        "ProtectSystem=strict",
        "ProtectHome=yes",
        "PrivateDevices=yes",
        "NoExecPaths=/",
        "CapabilityBoundingSet=CAP_NET_BIND_SERVICE",
        "MemoryDenyWriteExecute=yes",
        "SystemCallFilter=@system-service",
        "RestrictAddressFamilies=AF_INET AF_INET6",
    ] {
        assert!(unit.lines().any(|given| given == line), "{line} is not in the unit");
    }
    assert!(unit.contains("\nMemoryMax=") && unit.contains("\nTasksMax="), "{unit}");
    let Ok(output) =
        Command::new("systemd-analyze").args(["security", "--offline=true", "--threshold=20", path]).output()
    else {
        return eprintln!("skipped: there is no systemd-analyze");
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    // With this program in the place of an installed one.
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    write("termtrace.service", &unit.replace("/usr/local/bin/termtrace", env!("CARGO_BIN_EXE_termtrace")));
    write("termtrace.socket", include_str!("../../docs/termtrace.socket"));
    let units = ["termtrace.socket", "termtrace.service"].map(|name| folder.path().join(name));
    let output = Command::new("systemd-analyze").args(["verify", "--man=no"]).args(units).output().expect("it runs");
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}

#[test]
fn a_hang_up_reloads_scenes_and_settings() {
    let scene = |title: &str| {
        let sphere = "objects: [Sphere(center: (0, 0, 0), radius: 1)], ambient: 1";
        format!("(caption: \"{title}\", camera: (eye: (0, 0, 5), target: (0, 0, 0)), {sphere})")
    };
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    fs::create_dir(folder.path().join("scenes")).expect("a folder");
    write("scenes/one.ron", &scene("before"));
    write("scenes/two.ron", &scene("before"));
    write("serve.ron", r#"(listen: "127.0.0.1:0", link: "https://example.org/before", max_viewers: 1)"#);
    let program = Program::start_in("exec", &[&path("scenes"), "--config", &path("serve.ron")]);
    let has_logged = |event: &str| program.errors().lines().any(|line| line == event);
    run(async {
        let mut first = Guest::enter_with(&program, (80, 24), Some("two")).await;
        first.see_text("https://example.org/before").await;
        let mut waiting = Guest::enter(&program).await;
        waiting.see_text("full, 0 ahead of you").await;

        // A file with an error changes nothing.
        write("serve.ron", "(max_viewers: 0)");
        program.hang_up();
        let failed = |line: &str| line.starts_with("event=reload_failed error=") && line.contains("max_viewers");
        until("the error is in the log", || program.errors().lines().any(failed)).await;

        fs::remove_file(folder.path().join("scenes/two.ron")).expect("it is there");
        write("scenes/one.ron", &scene("after"));
        write("scenes/three.ron", &scene("after"));
        write("serve.ron", r#"(listen: "127.0.0.1:1", link: "https://example.org/after", max_viewers: 2)"#);
        program.hang_up();
        until("it is in the log", || has_logged("event=reload scenes=2 needs_restart=listen")).await;
        // The new number of places counts at once, and who shows a scene that is gone is told so.
        waiting.see_picture().await;
        first.see_text("the scene two is no longer shown").await;
        first.send(b"n").await;
        first.see_text("three (2 of 2)").await;
        let mut list = Guest::without_terminal(&program, (80, 24)).await;
        list.ask(Some("--list")).await;
        list.see("the new list", |guest| guest.has("one    after\r\nthree  after\r\n")).await;

        // A server that drains goes on draining.
        program.terminate();
        first.see_text("the server restarts: you leave in").await;
        program.hang_up();
        first.send(b"q").await;
        assert_eq!(first.leave().await, Some(0));
    });
}

#[test]
fn a_server_drains_when_its_terminal_is_closed() {
    let folder = tempfile::tempdir().expect("a folder");
    let server = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg("serve").arg("three_spheres");
    let server = server.arg("--listen").arg("127.0.0.1:0").arg("--host-key").arg(folder.path().join("key"));
    let mut session = server.spawn();
    session.wait_for_text("host key SHA256:");
    // On a terminal that is there, the signal asks to read the files again.
    session.signal(Signal::HUP);
    session.wait_for_text("event=reload ");
    session.vanish();
    let status = session.wait_exit(SOON);
    assert!(status.success(), "{status}");
}

/// The unit's limits, as far as a shell can set them: few files, little memory, no new file.
#[test]
fn row_17_the_server_runs_with_few_rights() {
    let program = Program::start_in(
        "ulimit -f 16; ulimit -n 256; ulimit -c 0; umask 077; exec",
        &["three_spheres", "--listen", "127.0.0.1:0"],
    );
    run(async {
        let mut guest = Guest::enter(&program).await;
        guest.see_picture().await;
        guest.send(b"q").await;
        assert_eq!(guest.leave().await, Some(0));
    });
    let children =
        fs::read_to_string(format!("/proc/{0}/task/{0}/children", program.process.child.id())).unwrap_or_default();
    assert!(children.is_empty(), "it has started {children}");
}

/// Starts the server as systemd does with a socket unit.
#[test]
fn systemd_passes_a_socket() {
    if Command::new("systemd-socket-activate").arg("--version").output().is_err() {
        eprintln!("skipped: there is no systemd-socket-activate");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    // Another program may take the port first.
    let started = (0..10).find_map(|_| activated(&folder.path().join("key")));
    let mut activated = started.expect("it has a port");
    let address = activated.address;
    run(async { Guest::enter(&activated).await.see_picture().await });
    let mut first = String::new();
    let mut output = std::io::BufReader::new(activated.child.stdout.take().expect("a pipe"));
    std::io::BufRead::read_line(&mut output, &mut first).expect("a line");
    assert_eq!(first, format!("listening on {address}: ssh -p {} 127.0.0.1\n", address.port()));
    let pid = rustix::process::Pid::from_child(&activated.child);
    rustix::process::kill_process(pid, Signal::TERM).expect("it runs");
    assert!(activated.child.wait().expect("it ends").success());
}

/// Starts a server by `systemd-socket-activate`; `None` if its port is not free any more.
///
/// The first connection starts the server, which then says where it listens: at the socket that it was given.
fn activated(key: &Path) -> Option<ListeningProcess> {
    let address = std::net::SocketAddr::from(([127, 0, 0, 1], free_port()));
    let mut command = Command::new("systemd-socket-activate");
    command.args(["-l", &address.to_string(), env!("CARGO_BIN_EXE_termtrace"), "serve", "three_spheres"]);
    command.arg("--host-key").arg(key).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut activated = ListeningProcess { child: command.spawn().expect("it starts"), address };
    for _ in 0..2000 {
        if activated.child.try_wait().expect("it is a child").is_some() {
            return None;
        }
        if TcpStream::connect(address).is_ok() {
            return Some(activated);
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("the socket is not there");
}
