//! With OpenSSH's client, if it is installed.

use crate::Hosting;
use crate::pty::{SOON, Size, Start};
use std::process::{Command, Output};

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
    let folder = tempfile::tempdir().expect("a folder");
    let key = folder.path().join("key");
    let script = format!(
        "ulimit -n 64; exec {} serve three_spheres --listen 127.0.0.1:0 --max-per-address 1000 --host-key {}",
        env!("CARGO_BIN_EXE_termtrace"),
        key.display()
    );
    let mut server = Command::new("sh");
    let server = server.args(["-c", &script]).stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::null());
    let mut server = server.spawn().expect("it starts");
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(server.stdout.take().expect("a pipe")));
    let first = lines.next().expect("a line").expect("text");
    let address = first.trim_start_matches("listening on ").split(": ").next().expect("an address").to_owned();
    let dial = || std::net::TcpStream::connect(&address);
    let streams: Vec<_> = (0..200).filter_map(|_| dial().ok()).collect();
    assert!(streams.len() > 60, "{}", streams.len());
    drop(streams);
    // The next one is served: the server says its name.
    let mut name = [0; 7];
    let mut stream = dial().expect("it still listens");
    std::io::Read::read_exact(&mut stream, &mut name).expect("it greets");
    assert_eq!(&name, b"SSH-2.0");
    rustix::process::kill_process(rustix::process::Pid::from_child(&server), rustix::process::Signal::TERM)
        .expect("it runs");
    assert!(server.wait().expect("it ends").success(), "without viewers it ends at once");
}
