//! Frames in a real tmux, in whole windows and split ones.
//!
//! Its panes and the terminal around it have to show the same cells. Without tmux 3.2 or newer the tests are skipped.

use super::pictures::noise;
use super::screens::assert_avt_shows;
use super::shifted::{Event, Story, View};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;
use termtrace::internals::capabilities::Shifts;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{Cell, Quality, Size};

/// The longest wait for what tmux shows.
const SOON: Duration = Duration::from_secs(60);

/// A server of tmux with one window, and a terminal that is attached to it.
struct Tmux {
    folder: TempDir,
    /// The terminal side of the first pane.
    pane: File,
    size: Size,
    frames: u32,
    outer: avt::Terminal,
    outer_bytes: Receiver<Vec<u8>>,
    /// The end of a character that has not come yet.
    partial: Vec<u8>,
    client: std::process::Child,
}

/// Returns whether there is a tmux to test with: 3.2 or newer, which has `terminal-features`.
fn has_tmux() -> bool {
    let version = Command::new("tmux").arg("-V").output();
    let version = version.map(|version| String::from_utf8_lossy(&version.stdout).into_owned()).unwrap_or_default();
    let numbers = version.trim().trim_start_matches("tmux ").split('.');
    let mut numbers = numbers.map(|number| number.trim_end_matches(char::is_alphabetic).parse::<u32>());
    let has =
        matches!((numbers.next(), numbers.next()), (Some(Ok(major)), Some(Ok(minor))) if (major, minor) >= (3, 2));
    if !has {
        eprintln!("skipped: there is no tmux 3.2 or newer");
    }
    has
}

impl Tmux {
    /// Starts a server whose window has this size.
    ///
    /// If `split`, the first pane is on the left, with as many columns as `split`.
    fn start(window: Size, split: Option<u16>) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let config = "set -g status off\nset -g default-terminal tmux-256color\n\
                      set -as terminal-features ',xterm-256color:RGB'\n";
        std::fs::write(folder.path().join("conf"), config).expect("a file can be written");
        let (columns, rows) = (window.columns.to_string(), window.rows.to_string());
        let quiet = "stty raw -echo; printf '\\033]2;frame 0\\033\\\\'; exec sleep 10000";
        run_in(&folder, &["new-session", "-d", "-x", &columns, "-y", &rows, "sh", "-c", quiet]);
        // With this in the configuration, tmux 3.3a exits at its start.
        run_in(&folder, &["set-option", "-g", "window-size", "manual"]);
        if let Some(left) = split {
            let others = (window.columns - left - 1).to_string();
            run_in(&folder, &["split-window", "-h", "-d", "-l", &others, "sh", "-c", "echo other; exec sleep 10000"]);
        }
        let size = Size::new(split.unwrap_or(window.columns), window.rows);
        let path = run_in(&folder, &["display-message", "-p", "-t", ":0.0", "#{pane_tty}"]);
        let pane = OpenOptions::new().write(true).open(path.trim()).expect("a pane has a terminal");
        let (client, outer_bytes) = attach(&folder, window);
        let outer = avt::Terminal::new(window.columns.into(), window.rows.into()).expect("a screen has cells");
        let tmux = Self { folder, pane, size, frames: 0, outer, outer_bytes, partial: Vec::new(), client };
        tmux.wait_for("the raw terminal", |tmux| tmux.title() == "frame 0");
        tmux
    }

    fn run(&self, arguments: &[&str]) -> String {
        run_in(&self.folder, arguments)
    }

    fn title(&self) -> String {
        self.run(&["display-message", "-p", "-t", ":0.0", "#{pane_title}"]).trim_end().to_owned()
    }

    fn wait_for(&self, what: &str, holds: impl Fn(&Self) -> bool) {
        let deadline = Instant::now() + SOON;
        while !holds(self) {
            assert!(Instant::now() < deadline, "tmux does not show {what}");
            thread::sleep(Duration::from_millis(1));
        }
    }

    fn resize(&mut self, size: Size) {
        let (columns, rows) = (size.columns.to_string(), size.rows.to_string());
        self.run(&["resize-window", "-x", &columns, "-y", &rows]);
        self.size = size;
    }

    /// Shows a frame, and asserts that the pane shows these cells then.
    #[track_caller]
    fn show(&mut self, bytes: &[u8], shown: &[Cell]) {
        self.frames += 1;
        let title = format!("frame {}", self.frames);
        let mark = format!("\x1b]2;{title}\x1b\\");
        self.pane.write_all(&[bytes, mark.as_bytes()].concat()).expect("the pane takes bytes");
        self.wait_for(&title, |tmux| tmux.title() == title);
        let captured = self.run(&["capture-pane", "-p", "-e", "-N", "-t", ":0.0"]);
        let Size { columns, rows } = self.size;
        let mut pane = avt::Terminal::new(columns.into(), rows.into()).expect("a screen has cells");
        for (row, line) in captured.lines().enumerate() {
            pane.feed(format!("\x1b[{};1H{line}", row + 1));
        }
        assert_avt_shows(&pane, shown, self.size);
    }

    /// Waits until the terminal around tmux shows these cells in the first pane.
    #[track_caller]
    fn see_outside(&mut self, shown: &[Cell]) {
        let deadline = Instant::now() + SOON;
        while !super::screens::avt_shows(&self.outer, shown, self.size) {
            match self.outer_bytes.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok(bytes) => self.feed_outer(&bytes),
                Err(_) => assert_avt_shows(&self.outer, shown, self.size),
            }
        }
    }

    fn feed_outer(&mut self, bytes: &[u8]) {
        self.partial.extend_from_slice(bytes);
        let whole = match std::str::from_utf8(&self.partial) {
            Err(error) if error.error_len().is_none() => error.valid_up_to(),
            _ => self.partial.len(),
        };
        self.outer.feed(String::from_utf8_lossy(&self.partial[..whole]).as_ref());
        self.partial.drain(..whole);
    }
}

impl Drop for Tmux {
    fn drop(&mut self) {
        let _ = tmux_in(&self.folder).arg("kill-server").output();
        let _ = self.client.wait();
    }
}

fn tmux_in(folder: &TempDir) -> Command {
    let mut command = Command::new("tmux");
    command.arg("-S").arg(folder.path().join("socket")).arg("-f").arg(folder.path().join("conf"));
    command.env_remove("TMUX").env("LC_ALL", "C.UTF-8").env("TERM", "xterm-256color").stdin(Stdio::null());
    command
}

fn run_in(folder: &TempDir, arguments: &[&str]) -> String {
    let output = tmux_in(folder).args(arguments).output().expect("tmux runs");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Attaches a terminal, whose bytes are sent to the receiver.
fn attach(folder: &TempDir, size: Size) -> (std::process::Child, Receiver<Vec<u8>>) {
    let (mut terminal, other) = pty_process::blocking::open().expect("a pseudo-terminal can be had");
    terminal.resize(pty_process::Size::new(size.rows, size.columns)).expect("a terminal has a size");
    let command = pty_process::blocking::Command::new("tmux")
        .arg("-S")
        .arg(folder.path().join("socket"))
        .arg("attach-session")
        .env_remove("TMUX")
        .env("LC_ALL", "C.UTF-8")
        .env("TERM", "xterm-256color");
    let client = command.spawn(other).expect("tmux runs");
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let mut bytes = [0; 4096];
        // At the end the terminal is gone, which is an error.
        while let Ok(count @ 1..) = terminal.read(&mut bytes) {
            if sender.send(bytes[..count].to_vec()).is_err() {
                break;
            }
        }
    });
    (client, receiver)
}

/// Returns the change before a frame: the view moves, and panels come and go.
fn event(number: u32) -> Event {
    let [a, b, c, kind] = number.to_le_bytes();
    let signed = |byte: u8, most: i32| i32::from(byte) % (2 * most + 1) - most;
    match kind % 8 {
        0..3 => Event::Pan(signed(a, 9), signed(b, 1)),
        3..5 => Event::Pan(signed(a, 1), signed(b, 4)),
        5 => Event::Close,
        _ => Event::Panel {
            column: u16::from(a) % 60,
            row: u16::from(b) % 10,
            columns: 1 + u16::from(c) % 20,
            rows: 1 + u16::from(c) % 4,
            text: ["plain text ", "世界", "🙂 ok ", "│ ─ é "][usize::from(a % 4)],
        },
    }
}

/// Sends frames of a story to tmux, each of which must be shown as the encoder believes.
fn tell(tmux: &mut Tmux, shifts: Shifts, seed: u32, sizes: &[Size]) {
    let mut number = noise(seed);
    let view = View { seed, at: [0; 2], grain: 2, shade: 0 };
    let mut story = Story::new(view, tmux.size, HalfBlocks::Either, shifts);
    for frame in 0..12_usize {
        story.take(&event(number()));
        if let Some(&size) = sizes.get(frame / 4).filter(|_| frame % 4 == 3) {
            story.take(&Event::Resize(size));
            tmux.resize(size);
        }
        let max_bytes = (!number().is_multiple_of(3)).then(|| 300 + number() as usize % 2_000);
        let quality = if number().is_multiple_of(4) { Quality::Exact } else { Quality::Equal };
        story.send(quality, max_bytes, 33);
        tmux.show(story.watched.sent(), story.watched.shown());
        if sizes.is_empty() {
            tmux.see_outside(story.watched.shown());
        }
    }
}

#[test]
fn tmux_shows_what_the_encoder_believes() {
    if !has_tmux() {
        return;
    }
    let size = Size::new(72, 14);
    for (seed, shifts) in [(1, Shifts::ThroughTmux), (2, Shifts::Direct), (3, Shifts::ThroughTmux)] {
        tell(&mut Tmux::start(size, None), shifts, seed, &[]);
        let sizes = [Size::new(40, 9), Size::new(90, 12), Size::new(72, 14)];
        tell(&mut Tmux::start(size, None), shifts, seed + 10, &sizes);
    }
}

/// In a pane that is not as wide as the window, tmux draws moved lines again, and they are right.
#[test]
fn a_split_window_of_tmux_shows_what_the_encoder_believes() {
    if !has_tmux() {
        return;
    }
    for (seed, shifts) in [(5, Shifts::ThroughTmux), (6, Shifts::Direct)] {
        let mut tmux = Tmux::start(Size::new(90, 14), Some(60));
        tell(&mut tmux, shifts, seed, &[]);
        assert_eq!(tmux.run(&["capture-pane", "-p", "-t", ":0.1"]).lines().next(), Some("other"));
    }
}
