//! A program on a pseudo-terminal of its own: what it shows, what it leaves behind, how it exits.
//!
//! ```ignore
//! let mut session = Start::new("termtrace").arg("scene.ron").size(Size::cells(80, 24)).spawn();
//! session.wait_for("a picture", SOON, |seen| seen.screen().text()[0].contains('▄'));
//! session.send(b"q");
//! let status = session.wait_exit(SOON);
//! session.assert_clean();
//! ```
//!
//! Nothing here sleeps in the place of knowing: every wait is for a condition, with a deadline.

// Each test target that says `mod pty;` uses a part of it.
#![allow(dead_code, unused_imports)]

mod deadline;
mod modes;
mod output;
mod phases;
mod picture;
mod replies;
mod rest;
mod retries;
mod screen;
mod signals;
mod storm;
mod termios;

use std::{
    cell::Cell,
    ffi::{OsStr, OsString},
    io::{self, Read, Write},
    os::{
        fd::AsFd,
        unix::{ffi::OsStrExt, fs::OpenOptionsExt, process::ExitStatusExt},
    },
    process::{Child, ExitStatus, Stdio},
    sync::Arc,
    time::{Duration, Instant},
};

use pty_process::blocking::{Command, Pty, open};
use rustix::{
    event::{PollFd, PollFlags},
    fs::OFlags,
    process::{Pid, Signal, WaitId, WaitIdOptions},
    termios::{Termios, Winsize},
};

pub(crate) use deadline::Deadline;
pub(crate) use modes::Modes;
use output::Output;
pub(crate) use phases::{Answer, Phases};
pub(crate) use picture::{halves_of, picture, picture_with, shows};
use replies::Replies;
pub(crate) use replies::{Fault, Which};
use rest::Rest;
pub(crate) use retries::{best_of_three, until_in_time, within_limit};
pub(crate) use screen::{Colour, Screen, without_colors};
pub(crate) use signals::reset_for_children;
pub(crate) use storm::Storm;

/// The longest wait for an event that must come. It tells a hang from a busy machine, and measures
/// nothing: with 10 s, a picture that is refined in .3 s was given up beside builds that ran 24 threads on 2 cores.
/// Limits in time are in `tests/slow.rs`.
pub(crate) const SOON: Duration = Duration::from_secs(60);

/// The time between two looks at whether the child has exited, which only its parent is told.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// The longest wait for the last output of a dead child, which an idle machine delivers at once.
const LAST_OUTPUT_TIMEOUT: Duration = Duration::from_secs(10);

/// The wait for the last output on a terminal that was stopped or is not read: it does not come.
const HELD_OUTPUT_TIMEOUT: Duration = Duration::from_secs(1);

/// The marker that the harness writes after the child's last byte: all output before it has come.
const END_MARKER: &[u8] = b"\x1b_the end of the output\x1b\\";

/// The size of a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    /// Cells from left to right.
    pub(crate) columns: u16,
    /// Cells from top to bottom.
    pub(crate) rows: u16,
    /// The width and height of a cell in pixels; zero where the terminal does not say.
    pub(crate) cell: (u16, u16),
}

impl Size {
    /// Returns a size of `columns` by `rows` cells of 10x20 pixels.
    pub(crate) fn cells(columns: u16, rows: u16) -> Self {
        Self { columns, rows, cell: (10, 20) }
    }

    /// Returns the same number of cells with `width` by `height` pixels in all.
    pub(crate) fn of_pixels(self, width: u16, height: u16) -> Self {
        Self { cell: (width, height), ..self }
    }

    fn winsize(self) -> Winsize {
        Winsize {
            ws_row: self.rows,
            ws_col: self.columns,
            ws_xpixel: self.columns * self.cell.0,
            ws_ypixel: self.rows * self.cell.1,
        }
    }
}

/// The command, terminal and environment of a program to start.
pub(crate) struct Start {
    program: OsString,
    arguments: Vec<OsString>,
    environment: Vec<(OsString, OsString)>,
    size: Size,
    stdin: Option<Stdio>,
    stdout: Option<Stdio>,
    stderr: Option<Stdio>,
    replies: Replies,
    rest: Option<Rest>,
}

impl Start {
    /// Prepares a program, found by its path or in this process's PATH.
    ///
    /// The terminal has 80x24 cells of 10x20 pixels. The environment has PATH, a TERM with truecolor and a locale of
    /// UTF-8, and what is added.
    pub(crate) fn new(program: impl AsRef<OsStr>) -> Self {
        let start = Self {
            program: program.as_ref().to_owned(),
            arguments: Vec::new(),
            environment: Vec::new(),
            size: Size::cells(80, 24),
            stdin: None,
            stdout: None,
            stderr: None,
            replies: Replies::default(),
            rest: None,
        };
        start
            .env("PATH", std::env::var_os("PATH").unwrap_or_default())
            .env("TERM", "xterm-256color")
            .env("COLORTERM", "truecolor")
            .env("LC_ALL", "C.UTF-8")
            // The lowest row shows the picture from the first frame on; `live/hint.rs` turns the hint on.
            .env("TERMTRACE_HINT", "false")
    }

    /// Prepares `sh` with a script.
    pub(crate) fn shell(script: &str) -> Self {
        Self::new("sh").arg("-c").arg(script)
    }

    /// Adds an argument.
    pub(crate) fn arg(mut self, argument: impl AsRef<OsStr>) -> Self {
        self.arguments.push(argument.as_ref().to_owned());
        self
    }

    /// Sets a variable of the environment.
    pub(crate) fn env(mut self, name: &str, value: impl AsRef<OsStr>) -> Self {
        self.environment.retain(|(known, _)| known != name);
        self.environment.push((name.into(), value.as_ref().to_owned()));
        self
    }

    /// Sets the size of the terminal.
    pub(crate) fn size(self, size: Size) -> Self {
        Self { size, ..self }
    }

    /// Uses `stdin` instead of the terminal for standard input.
    pub(crate) fn stdin(self, stdin: impl Into<Stdio>) -> Self {
        Self { stdin: Some(stdin.into()), ..self }
    }

    /// Uses `stdout` instead of the terminal for standard output.
    pub(crate) fn stdout(self, stdout: impl Into<Stdio>) -> Self {
        Self { stdout: Some(stdout.into()), ..self }
    }

    /// Uses `stderr` instead of the terminal for standard error.
    pub(crate) fn stderr(self, stderr: impl Into<Stdio>) -> Self {
        Self { stderr: Some(stderr.into()), ..self }
    }

    /// Makes the terminal answer no query. Otherwise it answers DA1, as every terminal does, and
    /// nothing else.
    pub(crate) fn mute(mut self) -> Self {
        self.replies.unanswered = None;
        self
    }

    /// Makes the terminal report the flags of the kitty keyboard protocol that are on. The test
    /// sends the keys itself.
    pub(crate) fn kitty(mut self) -> Self {
        self.replies.kitty = true;
        self
    }

    /// Makes the terminal report modes (DECRQM), none of which it knows.
    pub(crate) fn reports_modes(mut self) -> Self {
        self.replies.modes = true;
        self
    }

    /// Makes some of the replies to DA1 and about modes faulty.
    pub(crate) fn with_fault(mut self, fault: Fault, which: Which) -> Self {
        self.replies.fault = Some((fault, which));
        self
    }

    /// Makes the program's test-only hooks report each rest, for [`Session::wait_for_rest`].
    pub(crate) fn says_when_it_rests(self) -> Self {
        let rest = Rest::listen();
        Self { rest: Some(rest), ..self }
    }

    fn command(self) -> Command {
        let mut command = Command::new(self.program).args(self.arguments).env_clear().envs(self.environment);
        if let Some(stdin) = self.stdin {
            command = command.stdin(stdin);
        }
        if let Some(stdout) = self.stdout {
            command = command.stdout(stdout);
        }
        if let Some(stderr) = self.stderr {
            command = command.stderr(stderr);
        }
        command
    }

    /// Starts it, as the leader of a session whose controlling terminal is a fresh pseudo-terminal.
    #[track_caller]
    pub(crate) fn spawn(mut self) -> Session {
        let (master, slave) = open().expect("a pseudo-terminal can be had");
        let size = self.size;
        rustix::termios::tcsetwinsize(&master, size.winsize()).expect("a terminal has a size");
        let slave_side = open_slave_again(&slave).expect("the slave side can be opened twice");
        set_nonblocking(&master).expect("a file descriptor has flags");
        let master = Arc::new(master);
        let before = rustix::termios::tcgetattr(&*master).expect("a terminal has settings");
        let output = Output::read_from(Arc::clone(&master)).expect("a pipe and a thread can be had");
        let name = self.program.display().to_string();
        reset_for_children();
        let (rest, replies) = (self.rest.take(), std::mem::take(&mut self.replies));
        let start = rest.iter().fold(self, |start, rest| start.env("TERMTRACE_TEST_SOCKET", rest.path()));
        let child = start.command().spawn(slave);
        let child = child.unwrap_or_else(|error| panic!("{name} does not start: {error}"));
        Session {
            child,
            status: None,
            master,
            slave_side,
            before,
            output,
            last_output_timeout: LAST_OUTPUT_TIMEOUT,
            replies,
            rest,
            typed: Cell::new(0),
            seen: Seen { bytes: Vec::new(), screen: Screen::new(size.columns, size.rows) },
        }
    }
}

/// Opens the slave side by its name, which makes an open file description of its own.
///
/// A stopped terminal never blocks it, and the child does not see its flags. While it is open the output of a dead
/// child is not lost, and reading the master gives no EIO.
fn open_slave_again(slave: &impl AsFd) -> io::Result<std::fs::File> {
    let name = rustix::termios::ttyname(slave, Vec::new())?;
    let flags = OFlags::NOCTTY | OFlags::NONBLOCK;
    let flags = flags.bits().try_into().expect("these flags are small");
    let mut options = std::fs::OpenOptions::new();
    options.read(true).write(true).custom_flags(flags);
    options.open(OsStr::from_bytes(name.as_bytes()))
}

fn set_nonblocking(file: &impl AsFd) -> rustix::io::Result<()> {
    let flags = rustix::fs::fcntl_getfl(file)?;
    rustix::fs::fcntl_setfl(file, flags | OFlags::NONBLOCK)
}

/// Writes all to a file that does not block; false if there was no room for it before the deadline.
fn write_before(file: &mut (impl Write + AsFd), mut bytes: &[u8], deadline: Instant) -> io::Result<bool> {
    while !bytes.is_empty() {
        match file.write(bytes) {
            Ok(count) => bytes = &bytes[count..],
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                let left = deadline.saturating_duration_since(Instant::now());
                if left.is_zero() {
                    return Ok(false);
                }
                let timeout = left.try_into().expect("a deadline is near");
                let mut polled = [PollFd::new(file, PollFlags::OUT)];
                // An interrupted or timed-out wait only means another look.
                let _ = rustix::event::poll(&mut polled, Some(&timeout));
            }
            Err(error) => return Err(error),
        }
    }
    Ok(true)
}

/// The output of the terminal up to now.
pub(crate) struct Seen {
    bytes: Vec<u8>,
    screen: Screen,
}

impl Seen {
    /// Returns the bytes.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns whether `wanted` came in one piece.
    pub(crate) fn has(&self, wanted: &[u8]) -> bool {
        self.has_after(0, wanted)
    }

    /// Returns whether `wanted` came in one piece after the first `before` bytes.
    pub(crate) fn has_after(&self, before: usize, wanted: &[u8]) -> bool {
        // A wait searches all bytes again whenever some arrive: with `windows` and `any`, those of a large window took
        // more than a minute beside other tests.
        memchr::memmem::find(&self.bytes[before..], wanted).is_some()
    }

    /// Returns the screen of a terminal that has received the bytes.
    pub(crate) fn screen(&self) -> &Screen {
        &self.screen
    }

    /// Returns the modes that the bytes left on, and whether they end inside an escape sequence.
    pub(crate) fn modes(&self) -> Modes {
        Modes::after(&self.bytes)
    }

    fn take(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
        self.screen.feed(bytes);
    }

    /// Returns the screen and the end of the bytes, for the message of a failed wait.
    fn describe(&self) -> String {
        let tail = &self.bytes[self.bytes.len().saturating_sub(300)..];
        let screen = self.screen.text().join("\n");
        format!(
            "the screen shows\n{}\nafter {} bytes that end in {}",
            screen.trim_end(),
            self.bytes.len(),
            tail.escape_ascii()
        )
    }
}

/// A program on its pseudo-terminal. The drop kills it, with the processes that it started.
pub(crate) struct Session {
    child: Child,
    status: Option<ExitStatus>,
    master: Arc<Pty>,
    slave_side: std::fs::File,
    before: Termios,
    output: Output,
    last_output_timeout: Duration,
    replies: Replies,
    rest: Option<Rest>,
    /// The number of bytes that were typed or sent as replies.
    typed: Cell<u64>,
    seen: Seen,
}

impl Session {
    /// Returns the process that was started.
    pub(crate) fn pid(&self) -> Pid {
        Pid::from_child(&self.child)
    }

    /// Returns the process group in the foreground of the terminal.
    ///
    /// It is not the child's own if the child is a shell with job control.
    pub(crate) fn foreground_group(&self) -> Pid {
        rustix::termios::tcgetpgrp(&*self.master).expect("the terminal has a foreground")
    }

    /// Types these bytes.
    #[track_caller]
    pub(crate) fn send(&self, bytes: &[u8]) {
        let written = write_before(&mut &*self.master, bytes, Instant::now() + SOON);
        assert!(matches!(written, Ok(true)), "not all of {} bytes typed: {written:?}", bytes.len());
        self.typed.update(|typed| typed + bytes.len() as u64);
    }

    /// Sends a signal to the child; to one that has exited nothing happens.
    #[track_caller]
    pub(crate) fn signal(&self, signal: Signal) {
        rustix::process::kill_process(self.pid(), signal).expect("one's own child takes signals");
    }

    /// Resizes the terminal. The kernel sends SIGWINCH to the foreground.
    pub(crate) fn resize(&mut self, size: Size) {
        self.pump();
        self.seen.screen.resize(size.columns, size.rows);
        rustix::termios::tcsetwinsize(&*self.master, size.winsize()).expect("a terminal can be resized");
    }

    /// Stops reading the child's output, as when a terminal was stopped or a link is dead.
    pub(crate) fn stop_reading(&mut self) {
        self.output.stop();
        self.pump();
        self.last_output_timeout = HELD_OUTPUT_TIMEOUT;
    }

    /// Stops reading, and types `keys` until the output that they cause fills the terminal.
    #[track_caller]
    pub(crate) fn fill(&mut self, keys: &[u8]) {
        self.stop_reading();
        let moment = POLL_INTERVAL.try_into().expect("it is short");
        let mut deadline = Deadline::after(SOON);
        let mut full_looks = 0;
        // One look is not enough: the kernel passes bytes on to the reader's side some time after they were written,
        // which makes room again.
        while full_looks < 25 {
            assert!(!deadline.has_passed(), "the terminal takes all output");
            let mut polled = [PollFd::new(&self.slave_side, PollFlags::OUT)];
            if rustix::event::poll(&mut polled, Some(&moment)) == Ok(0) {
                full_looks += 1;
                continue;
            }
            full_looks = 0;
            if self.unread() == 0 {
                self.send(keys);
            }
            self.output.wait_for_more(Instant::now() + POLL_INTERVAL);
        }
    }

    /// Reads the child's output again.
    pub(crate) fn start_reading(&mut self) {
        self.output.start(Arc::clone(&self.master)).expect("a pipe and a thread can be had");
        self.last_output_timeout = LAST_OUTPUT_TIMEOUT;
    }

    /// Types Ctrl-S, which stops the output, the echo of what is typed included, but not the
    /// reading.
    #[track_caller]
    pub(crate) fn stop_output(&mut self) {
        self.send(b"\x13");
        self.last_output_timeout = HELD_OUTPUT_TIMEOUT;
    }

    /// Resizes the terminal again and again until the returned storm is dropped.
    pub(crate) fn storm(&self) -> Storm {
        Storm::over(Arc::clone(&self.master))
    }

    /// Removes the terminal, as when its window is closed or the link is cut.
    pub(crate) fn vanish(&mut self) {
        self.output.stop();
        self.pump();
        let (other, _) = open().expect("a pseudo-terminal can be had");
        self.master = Arc::new(other);
        let null = std::fs::OpenOptions::new().read(true).write(true).open("/dev/null");
        self.slave_side = null.expect("there is always /dev/null");
    }

    /// Returns the terminal's own side, for another process to use.
    pub(crate) fn terminal(&self) -> std::fs::File {
        let name = rustix::termios::ttyname(&self.slave_side, Vec::new()).expect("a terminal has a name");
        let mut options = std::fs::OpenOptions::new();
        options.read(true).write(true).custom_flags(OFlags::NOCTTY.bits().try_into().expect("this flag is small"));
        options.open(OsStr::from_bytes(name.as_bytes())).expect("the slave side can be opened again")
    }

    /// Waits until the child has read all input and will read no more: what is typed next stays
    /// unread.
    #[track_caller]
    pub(crate) fn wait_for_no_reader(&mut self) {
        self.wait_until_read();
        self.sees(Duration::from_millis(200), |_| false);
    }

    /// Waits until the child has read all that was typed.
    #[track_caller]
    pub(crate) fn wait_until_read(&mut self) {
        let mut deadline = Deadline::after(SOON);
        while self.unread() > 0 {
            assert!(!deadline.has_passed(), "what was typed is not read");
            self.output.wait_for_more(Instant::now() + POLL_INTERVAL);
        }
    }

    /// Returns the number of typed bytes that the child has not read.
    fn unread(&self) -> u64 {
        rustix::io::ioctl_fionread(&self.slave_side).expect("a terminal counts what was typed")
    }

    /// Returns the typed bytes that are unread, which the next reader, such as a shell, would get.
    pub(crate) fn typed_ahead(&mut self) -> Vec<u8> {
        let mut bytes = vec![0; 4096];
        // WouldBlock: there is no input.
        let count = self.slave_side.read(&mut bytes).unwrap_or(0);
        bytes.truncate(count);
        bytes
    }

    /// Returns the terminal's size as the child sees it.
    pub(crate) fn window_size(&self) -> Winsize {
        rustix::termios::tcgetwinsize(&*self.master).expect("a terminal has a size")
    }

    /// Returns the output up to now.
    pub(crate) fn seen(&mut self) -> &Seen {
        self.pump();
        &self.seen
    }

    fn pump(&mut self) {
        self.seen.take(&self.output.take());
        self.answer();
    }

    /// Answers DA1 on a mute terminal from now on, for all queries at or behind byte `from` of the
    /// output.
    pub(crate) fn answer_from(&mut self, from: usize) {
        self.replies.unanswered = Some(from);
        self.pump();
    }

    /// Answers each query, whole or in pieces in the output, once.
    fn answer(&mut self) {
        let replies = self.replies.to(&self.seen.bytes);
        // The child may have exited, and then reads no reply.
        if let Ok(true) = write_before(&mut &*self.master, &replies, Instant::now() + POLL_INTERVAL) {
            self.typed.update(|typed| typed + replies.len() as u64);
        }
    }

    /// Returns the number of replies to DA1 and about modes that were due up to now.
    pub(crate) fn replies(&mut self) -> usize {
        self.pump();
        self.replies.count
    }

    /// Returns whether a child that rests after reading `read` bytes has no more input and no
    /// unread output.
    fn has_nothing_under_way(&mut self, read: u64) -> bool {
        self.take_last_output();
        self.answer();
        self.typed.get() == read
    }

    /// Waits until the child has read all input and sleeps, with all its output taken in.
    ///
    /// Nothing is sent or computed from then on unless the test does something. After a signal, a resize or a change of
    /// a file, wait for its effect first. Stops other than SIGSTOP throw input away, so this wait would not end.
    #[track_caller]
    pub(crate) fn wait_for_rest(&mut self) {
        let mut deadline = Deadline::after(SOON);
        loop {
            self.pump();
            let typed = self.typed.get();
            let rest = self.rest.as_ref().expect("the child says when it rests");
            if rest.is_after(typed) && self.has_nothing_under_way(typed) {
                return;
            }
            assert!(!deadline.has_passed(), "it does not come to rest: {}", self.seen.describe());
            self.output.wait_for_more(Instant::now() + POLL_INTERVAL);
        }
    }

    /// Returns how many loads of a scene have reached the building of its trees.
    pub(crate) fn loads(&self) -> u64 {
        self.rest.as_ref().expect("the child reports its phases").loads()
    }

    /// Waits until what came out fulfils a condition; whether it did so in time.
    pub(crate) fn sees(&mut self, limit: Duration, mut wanted: impl FnMut(&Seen) -> bool) -> bool {
        let mut deadline = Deadline::after(limit);
        loop {
            self.pump();
            if wanted(&self.seen) {
                return true;
            }
            // A child that never stops writing must not keep us beyond the deadline.
            if deadline.has_passed() {
                // Output between the last look and the deadline counts.
                self.pump();
                return wanted(&self.seen);
            }
            let next = deadline.next_look();
            self.output.wait_for_more(self.replies.next_due().map_or(next, |due| due.min(next)));
        }
    }

    /// Waits until the output fulfils a condition, and panics with the screen if it does not in
    /// time.
    #[track_caller]
    pub(crate) fn wait_for(&mut self, what: &str, limit: Duration, wanted: impl FnMut(&Seen) -> bool) {
        let seen = self.sees(limit, wanted);
        assert!(seen, "no {what} within {limit:?}: {}", self.seen.describe());
    }

    /// Waits until the screen shows this text, in one line.
    #[track_caller]
    pub(crate) fn wait_for_text(&mut self, text: &str) {
        self.wait_for(&format!("{text:?}"), SOON, |seen| seen.screen.text().iter().any(|line| line.contains(text)));
    }

    /// Waits until the child is stopped, and returns the number of the signal. A stop is reported
    /// once.
    ///
    /// A session leader whose parent is elsewhere ignores SIGTSTP, SIGTTIN and SIGTTOU, as POSIX requires of an
    /// orphaned process group. To see a program stopped by these, start it from a shell with job control (`sh -m`) and
    /// wait for the shell's message.
    #[track_caller]
    pub(crate) fn wait_stopped(&mut self, limit: Duration) -> i32 {
        let mut deadline = Deadline::after(limit);
        loop {
            let options = WaitIdOptions::STOPPED | WaitIdOptions::NOHANG;
            let stopped =
                rustix::process::waitid(WaitId::Pid(self.pid()), options).expect("one's own child can be waited for");
            if let Some(signal) = stopped.and_then(|status| status.stopping_signal()) {
                return signal;
            }
            assert!(!deadline.has_passed(), "not stopped within {limit:?}");
            self.output.wait_for_more(Instant::now() + POLL_INTERVAL);
            self.pump();
        }
    }

    /// Waits until the child has exited, and no longer.
    #[track_caller]
    pub(crate) fn wait_until_gone(&mut self, limit: Duration) {
        let mut deadline = Deadline::after(limit);
        while self.look_for_exit().is_none() {
            assert!(!deadline.has_passed(), "still running after {limit:?}");
            self.output.wait_for_more(Instant::now() + POLL_INTERVAL);
            self.pump();
        }
    }

    /// Waits until the child has exited, and for the last of its output.
    #[track_caller]
    pub(crate) fn wait_exit(&mut self, limit: Duration) -> ExitStatus {
        let mut deadline = Deadline::after(limit);
        loop {
            if let Some(status) = self.status {
                return status;
            }
            // The status is read before the output, so that no output in between is missed.
            let status = self.look_for_exit();
            if status.is_some() {
                self.take_last_output();
                self.status = status;
                continue;
            }
            if deadline.has_passed() {
                self.pump();
                panic!("still running after {limit:?}: {}", self.seen.describe());
            }
            self.output.wait_for_more(Instant::now() + POLL_INTERVAL);
            self.pump();
        }
    }

    /// Returns the exit status of the child, if it has exited.
    ///
    /// The child stays a zombie until the drop, so that its number, which is its group's too, is not used again:
    /// processes that it left behind can then be killed without hitting others.
    pub(crate) fn look_for_exit(&self) -> Option<ExitStatus> {
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        let exited =
            rustix::process::waitid(WaitId::Pid(self.pid()), options).expect("one's own child can be waited for")?;
        let raw = match exited.terminating_signal() {
            Some(signal) => signal,
            None => exited.exit_status()? << 8,
        };
        Some(ExitStatus::from_raw(raw))
    }

    /// Reads the rest of the output of an exited child.
    ///
    /// The kernel passes a terminal's output on some time after it was written, but in order: a marker that the harness
    /// writes comes after all of it.
    #[track_caller]
    fn take_last_output(&mut self) {
        let deadline = Instant::now() + self.last_output_timeout;
        let bytes = match write_before(&mut self.slave_side, END_MARKER, deadline) {
            Ok(true) => self.output.take_up_to(Some(END_MARKER)),
            // The terminal was stopped (Ctrl-S): what it holds back is never shown.
            Ok(false) => self.output.take(),
            // Some systems revoke the terminal of a dead session leader, which ends its output.
            Err(_) => self.output.take_up_to(None),
        };
        self.seen.take(&bytes);
    }

    /// Returns the settings of the terminal that differ from those before the start.
    pub(crate) fn termios_changes(&self) -> Vec<String> {
        let now = rustix::termios::tcgetattr(&*self.master).expect("a terminal has settings");
        termios::changes(&self.before, &now)
    }

    /// Returns what is not as before the start: modes left on, a torn sequence, the terminal's
    /// settings.
    pub(crate) fn left_behind(&mut self) -> Vec<String> {
        let mut left = self.seen().modes().left_on();
        left.extend(self.termios_changes());
        left
    }

    /// Panics if anything is not as it was before the start.
    #[track_caller]
    pub(crate) fn assert_clean(&mut self) {
        let left = self.left_behind();
        assert!(left.is_empty(), "left behind: {}; {}", left.join(", "), self.seen.describe());
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // Kills the child and the group that it leads. An error means that no process of it is left. Groups made by a
        // shell with job control end by the SIGHUP of the terminal's end, if they do not ignore it.
        let _ = rustix::process::kill_process_group(self.pid(), Signal::KILL);
        let _ = self.child.wait();
    }
}
