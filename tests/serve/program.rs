//! The program `termtrace serve` as a process of its own, whose memory is not that of the clients.

use crate::Place;
use rustix::process::Signal;
use std::io::{BufRead, BufReader};
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, Output, Stdio};
use tempfile::TempDir;

/// Runs `termtrace serve` with arguments by which it ends at once.
pub(crate) fn termtrace(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_termtrace")).arg("serve").args(arguments).output().expect("it runs")
}

/// A running process that listens; it is ended when it is dropped.
pub(crate) struct ListeningProcess {
    pub(crate) child: Child,
    pub(crate) address: SocketAddr,
}

impl Drop for ListeningProcess {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Place for ListeningProcess {
    fn address(&self) -> SocketAddr {
        self.address
    }
}

/// A running `termtrace serve`; it is ended when it is dropped.
pub(crate) struct Program {
    pub(crate) process: ListeningProcess,
    /// Its standard output, which is open for as long as it runs.
    _output: std::io::Lines<BufReader<ChildStdout>>,
    folder: TempDir,
}

impl Program {
    /// Starts the program on a free port with these arguments, and waits until it listens.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        Self::start_in("exec", &[&["--listen", "127.0.0.1:0"], arguments].concat())
    }

    /// Starts the program by a shell, with `prefix` before its name.
    pub(crate) fn start_in(prefix: &str, arguments: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let script = format!("{prefix} \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &script, "sh", env!("CARGO_BIN_EXE_termtrace"), "serve"]);
        command.arg("--host-key").arg(folder.path().join("key")).args(arguments);
        let errors = std::fs::File::create(folder.path().join("errors")).expect("a file");
        let mut child = command.stdout(Stdio::piped()).stderr(errors).spawn().expect("it starts");
        let mut lines = BufReader::new(child.stdout.take().expect("a pipe")).lines();
        let first = lines.next().expect("a line").expect("text");
        let address = first.strip_prefix("listening on ").and_then(|rest| rest.split(": ").next());
        let mut address: SocketAddr = address.expect("an address").parse().expect("an address");
        if address.ip().is_unspecified() {
            address.set_ip([127, 0, 0, 1].into());
        }
        Self { process: ListeningProcess { child, address }, _output: lines, folder }
    }

    /// Returns the memory of the process in kilobytes; `None` on systems without `/proc`.
    pub(crate) fn memory(&self) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.process.child.id())).ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
        line.split_whitespace().next()?.parse().ok()
    }

    /// Returns the file of the host key.
    pub(crate) fn key(&self) -> PathBuf {
        self.folder.path().join("key")
    }

    /// Returns the lines of standard error.
    pub(crate) fn errors(&self) -> String {
        std::fs::read_to_string(self.folder.path().join("errors")).expect("text")
    }

    /// Asks the process to end.
    pub(crate) fn terminate(&self) {
        self.signal(Signal::TERM);
    }

    /// Asks the process to read its files again.
    pub(crate) fn hang_up(&self) {
        self.signal(Signal::HUP);
    }

    fn signal(&self, signal: Signal) {
        let pid = rustix::process::Pid::from_child(&self.process.child);
        rustix::process::kill_process(pid, signal).expect("it runs");
    }
}

impl Place for Program {
    fn address(&self) -> SocketAddr {
        self.process.address
    }
}
