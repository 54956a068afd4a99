//! With OpenSSH's client, if it is installed.

use crate::operator::key;
use crate::program::Program;
use crate::pty::{SOON, Size, Start};
use crate::{Hosting, Place};
use russh::keys::ssh_key::LineEnding;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// Returns the options that every call needs, or `None` if there is no `ssh`.
fn options(hosting: &Hosting) -> Option<Vec<String>> {
    if Command::new("ssh").arg("-V").output().is_err() {
        eprintln!("skipped: there is no ssh");
        return None;
    }
    let port = hosting.address().port().to_string();
    let fixed = ["-F", "none", "-o", "StrictHostKeyChecking=no", "-o", "UserKnownHostsFile=/dev/null"];
    let more = ["-o", "BatchMode=yes", "-o", "IdentityAgent=none", "-l", "anybody", "-p", &port];
    Some(fixed.iter().chain(&more).map(|&option| option.to_owned()).collect())
}

fn ssh(hosting: &Hosting, arguments: &[&str]) -> Option<Output> {
    let options = options(hosting)?;
    Some(Command::new("ssh").args(options).args(arguments).output().expect("ssh runs"))
}

#[test]
fn a_terminal_shows_the_view_and_is_left_clean() {
    let hosting = Hosting::usual();
    let Some(options) = options(&hosting) else { return };
    let start = options.iter().fold(Start::new("ssh"), Start::arg);
    let mut session = start.arg("-tt").arg("127.0.0.1").size(Size::cells(80, 24)).spawn();
    session.wait_for_text("? all keys, q quits");
    session.wait_for("a picture", SOON, |seen| seen.screen().text()[..20].iter().any(|row| row.contains(['▀', '▄'])));
    session.send(b"q");
    let status = session.wait_exit(SOON);
    assert!(status.success(), "{status:?}");
    session.assert_clean();
    assert!(session.seen().has(b"this view at home: termtrace three_spheres"));
}

#[test]
fn without_a_terminal_there_is_text() {
    let hosting = Hosting::usual();
    let Some(output) = ssh(&hosting, &["127.0.0.1", "corridor"]) else { return };
    assert!(output.status.success(), "{output:?}");
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 24);
    let list = ssh(&hosting, &["127.0.0.1", "--", "--list"]).expect("ssh is there");
    assert!(String::from_utf8_lossy(&list.stdout).contains("corridor"), "{list:?}");
}

#[test]
fn row_01_02_03_all_else_is_refused() {
    let hosting = Hosting::usual();
    let password = ["-v", "-o", "PreferredAuthentications=password", "127.0.0.1", "x;id"];
    let Some(output) = ssh(&hosting, &password) else { return };
    let log = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!log.contains("password:") && !log.contains("keyboard-interactive)"), "{log}");
    assert_eq!(output.status.code(), Some(2), "{log}");
    let port = hosting.address().port();
    let refused = [
        vec!["-W".to_owned(), format!("127.0.0.1:{port}"), "127.0.0.1".to_owned()],
        ["-o", "ExitOnForwardFailure=yes", "-N", "-R", "0:127.0.0.1:1", "127.0.0.1"].map(str::to_owned).to_vec(),
        ["-s", "127.0.0.1", "sftp"].map(str::to_owned).to_vec(),
    ];
    for arguments in refused {
        let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
        let output = ssh(&hosting, &arguments).expect("ssh is there");
        assert!(!output.status.success() && output.stdout.is_empty(), "{arguments:?}: {output:?}");
    }
}

/// Returns a port of this machine that nothing listens at.
pub(crate) fn free_port() -> u16 {
    std::net::TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a port").port()
}

/// A connection to a forwarded port ends without a byte of the server.
#[test]
fn row_03_forwarded_ports_lead_nowhere() {
    let hosting = Hosting::usual();
    let Some(options) = options(&hosting) else { return };
    let target = hosting.address().port();
    for (forward, greeting) in [("-L", &b""[..]), ("-D", b"\x05\x01\x00")] {
        let port = free_port();
        let place = if forward == "-L" { format!("{port}:127.0.0.1:{target}") } else { port.to_string() };
        let mut ssh = Command::new("ssh");
        ssh.args(&options)
            .args(["-o", "ExitOnForwardFailure=yes", "-N", forward, &place, "127.0.0.1"])
            .stderr(Stdio::null());
        let mut ssh = ssh.spawn().expect("ssh runs");
        let mut stream = loop {
            if let Ok(stream) = TcpStream::connect(("127.0.0.1", port)) {
                break stream;
            }
            assert!(ssh.try_wait().expect("it is a child").is_none(), "ssh has ended");
            std::thread::sleep(Duration::from_millis(20));
        };
        stream.write_all(greeting).expect("ssh takes it");
        let mut answer = Vec::new();
        if forward == "-D" {
            let mut method = [0; 2];
            stream.read_exact(&mut method).expect("ssh answers by itself");
            let [high, low] = target.to_be_bytes();
            stream.write_all(&[5, 1, 0, 1, 127, 0, 0, 1, high, low]).expect("ssh takes it");
        }
        let _ = stream.read_to_end(&mut answer);
        assert!(!answer.windows(4).any(|word| word == b"SSH-"), "{forward} led to the server: {answer:?}");
        ssh.kill().expect("it runs");
        let _ = ssh.wait();
    }
}

#[test]
fn row_03_no_agent_no_x11_and_no_second_channel() {
    let hosting = Hosting::usual();
    let Some(options) = options(&hosting) else { return };
    let asked = ssh(&hosting, &["-A", "-X", "-v", "127.0.0.1", "--", "--list"]).expect("ssh is there");
    assert!(asked.status.success(), "{asked:?}");
    assert!(String::from_utf8_lossy(&asked.stdout).contains("corridor"), "{asked:?}");

    let folder = tempfile::tempdir().expect("a folder");
    let control = format!("ControlPath={}", folder.path().join("control").display());
    let start = options.iter().fold(Start::new("ssh"), Start::arg);
    let mut session =
        start.arg("-tt").arg("-M").arg("-o").arg(&control).arg("127.0.0.1").size(Size::cells(80, 24)).spawn();
    session.wait_for_text("? all keys, q quits");
    let second = Command::new("ssh").args(["-F", "none", "-o", &control, "127.0.0.1", "corridor"]).output();
    let second = second.expect("ssh runs");
    assert!(second.stdout.is_empty() && !second.status.success(), "{second:?}");
    // The first one goes on.
    session.send(b"i");
    session.wait_for_text("three_spheres");
    session.send(b"q");
    assert!(session.wait_exit(SOON).success());
}

/// Row 25 with a shell: after `ssh` it reads only typed text.
#[test]
fn row_25_the_shell_after_ssh_reads_nothing() {
    let hosting = Hosting::usual();
    let Some(options) = options(&hosting) else { return };
    let script = format!("ssh {} -tt 127.0.0.1; echo over; read -r line; echo \"read:$line.\"", options.join(" "));
    let mut session = Start::shell(&script).size(Size::cells(80, 24)).spawn();
    session.wait_for_text("? all keys, q quits");
    session.send(b"tq");
    session.wait_for_text("over");
    session.send(b"typed\r");
    session.wait_for_text("read:typed.");
}

#[test]
fn row_14_only_strong_algorithms_are_offered() {
    let hosting = Hosting::usual();
    let Some(output) = ssh(&hosting, &["-vv", "127.0.0.1", "--", "--list"]) else { return };
    let log = String::from_utf8_lossy(&output.stderr).into_owned();
    let of_server = log.split("peer server KEXINIT proposal").nth(1).expect("what the server offers");
    let offers: Vec<_> = of_server.lines().skip(1).take(10).map(|line| line.trim_start_matches("debug2: ")).collect();
    let offer =
        |name: &str| *offers.iter().find(|offer| offer.starts_with(name)).unwrap_or_else(|| panic!("{offers:?}"));
    assert!(offer("KEX algorithms: ").starts_with("KEX algorithms: mlkem768x25519-sha256,curve25519-sha256"));
    assert!(offer("KEX algorithms: ").contains("kex-strict-s-v00@openssh.com"));
    assert_eq!(offer("host key algorithms: "), "host key algorithms: ssh-ed25519");
    assert_eq!(offer("compression ctos: "), "compression ctos: none");
    for offer in offers {
        assert!(!offer.contains("sha1") && !offer.contains("md5") && !offer.contains("rsa"), "{offer}");
    }
    // A client that hears of it sends a packet with each key, and more as a disguise.
    assert!(!log.contains("ping@openssh.com"), "{log}");
}

/// Row 6: with few files for the server, and after other errors of accepting.
#[test]
fn row_06_too_many_open_files_end_nothing() {
    let mut program = Program::start_in(
        "ulimit -n 64; exec",
        &["three_spheres", "--listen", "127.0.0.1:0", "--max-per-address", "1000"],
    );
    let address = program.address();
    let dial = || TcpStream::connect(address);
    let streams: Vec<_> = (0..200).filter_map(|_| dial().ok()).collect();
    assert!(streams.len() > 60, "{}", streams.len());
    drop(streams);
    // The next one is served: the server says its name.
    let mut name = [0; 7];
    let mut stream = dial().expect("it still listens");
    Read::read_exact(&mut stream, &mut name).expect("it greets");
    assert_eq!(&name, b"SSH-2.0");
    program.terminate();
    assert!(program.process.child.wait().expect("it ends").success(), "without viewers it ends at once");
}

/// Writes a private key into a file that only its owner can read.
fn write_key(path: &Path, seed: u8) {
    let text = key(seed).to_openssh(LineEnding::LF).expect("a key");
    let mut file = std::fs::OpenOptions::new().write(true).create_new(true).mode(0o600).open(path).expect("a new file");
    file.write_all(text.as_bytes()).expect("it is written");
}

#[test]
fn row_32_a_leader_logs_in_by_key_and_no_visitor_is_asked_a_question() {
    let hosting = Hosting::start(|settings| settings.leaders = Some(vec![key(1).public_key().clone()]));
    let Some(options) = options(&hosting) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    write_key(&file("leader"), 1);
    write_key(&file("stranger"), 9);
    // The client would ask for the passphrase of this one.
    let mut make = Command::new("ssh-keygen");
    make.args(["-q", "-t", "ed25519", "-N", "secret", "-f"]).arg(file("locked"));
    assert!(make.status().expect("ssh-keygen runs").success());
    let visits = [
        ("anybody", &["stranger", "locked"][..], false),
        ("leader", &[], false),
        ("leader", &["stranger", "locked"], false),
        ("leader", &["locked", "stranger", "leader"], true),
    ];
    for (user, keys, leads) in visits {
        let start = ["-l", user, "-o", "BatchMode=no", "-o", "IdentitiesOnly=yes"];
        let start = start.iter().fold(Start::new("ssh"), Start::arg);
        // Without any, the client has those of its own folder, which is not that of the test.
        let files = if keys.is_empty() { vec![file("none")] } else { keys.iter().map(|name| file(name)).collect() };
        let start = files.iter().fold(start, |start, file| start.arg("-i").arg(file.to_str().expect("UTF-8")));
        let start = options.iter().fold(start, Start::arg);
        let mut session = start.arg("-tt").arg("127.0.0.1").size(Size::cells(80, 24)).spawn();
        session.wait_for_text("? all keys, q quits");
        session.send(b"G");
        if leads {
            session.wait_for_text("you lead the tour; G ends that");
        }
        session.send(b"?");
        session.wait_for_text("list of viewers");
        session.send(b"qq");
        assert!(session.wait_exit(SOON).success(), "{user} {keys:?}");
        let seen = session.seen();
        let asked = ["assword", "assphrase", "nteractive"].into_iter().find(|word| seen.has(word.as_bytes()));
        assert_eq!(asked, None, "{user} {keys:?}");
        assert_eq!(seen.has(b"lead the tour"), leads, "{user} {keys:?}");
    }
    // Nor is anyone turned away who cannot be asked.
    let list = ssh(&hosting, &["127.0.0.1", "--", "--list"]).expect("ssh is there");
    assert!(String::from_utf8_lossy(&list.stdout).contains("corridor"), "{list:?}");
    let log = hosting.log();
    assert!(log.iter().any(|line| line.starts_with("event=leave viewer=3 reason=quit")), "{log:?}");
}
