//! The thread that reads the master side.

use std::{
    io::{self, PipeWriter, Read},
    sync::{Arc, Condvar, Mutex, MutexGuard},
    thread::JoinHandle,
    time::Instant,
};

use pty_process::blocking::Pty;
use rustix::event::{PollFd, PollFlags};

/// Output that has been read and not yet taken.
#[derive(Default)]
struct Unread {
    bytes: Vec<u8>,
    ended: bool,
}

/// Output that was read, and the condition variable that reports more.
#[derive(Default)]
struct Shared {
    read: Mutex<Unread>,
    more: Condvar,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Unread> {
        self.read.lock().expect("no holder of this lock panics")
    }
}

/// The output of a terminal, read as it comes.
pub(super) struct Output {
    shared: Arc<Shared>,
    /// Closed to make the thread end.
    stop: Option<PipeWriter>,
    thread: Option<JoinHandle<()>>,
}

impl Output {
    /// Begins to read.
    pub(super) fn read_from(master: Arc<Pty>) -> io::Result<Self> {
        let mut output = Self { shared: Arc::default(), stop: None, thread: None };
        output.start(master)?;
        Ok(output)
    }

    /// Begins again after [`stop`](Self::stop).
    pub(super) fn start(&mut self, master: Arc<Pty>) -> io::Result<()> {
        let (stopped, stop) = io::pipe()?;
        let into = Arc::clone(&self.shared);
        into.lock().ended = false;
        self.thread = Some(std::thread::spawn(move || read_all(&master, &stopped, &into)));
        self.stop = Some(stop);
        Ok(())
    }

    /// Returns the output since the last call.
    pub(super) fn take(&self) -> Vec<u8> {
        std::mem::take(&mut self.shared.lock().bytes)
    }

    /// Waits until there is something to take; false if the deadline passed.
    pub(super) fn wait_for_more(&self, deadline: Instant) -> bool {
        let left = deadline.saturating_duration_since(Instant::now());
        let wait = self.shared.more.wait_timeout_while(self.shared.lock(), left, |unread| unread.bytes.is_empty());
        !wait.expect("no holder of this lock panics").0.bytes.is_empty()
    }

    /// Returns the output before `marker`, once that has come or the output has ended.
    #[track_caller]
    pub(super) fn take_up_to(&self, marker: Option<&[u8]>) -> Vec<u8> {
        let find = |bytes: &[u8]| {
            let marker = marker?;
            let at = bytes.windows(marker.len()).rposition(|window| window == marker)?;
            Some(at..at + marker.len())
        };
        let goes_on = |unread: &mut Unread| !unread.ended && find(&unread.bytes).is_none();
        let wait = self.shared.more.wait_timeout_while(self.shared.lock(), super::SOON, goes_on);
        let (mut unread, timeout) = wait.expect("no holder of this lock panics");
        assert!(!timeout.timed_out(), "the output of a child that exited does not end");
        let mut bytes = std::mem::take(&mut unread.bytes);
        // A process that the child left behind may have written after the marker.
        if let Some(place) = find(&bytes) {
            bytes.drain(place);
        }
        bytes
    }
}

impl Output {
    /// Reads no more, as a terminal that was stopped, or whose link is dead.
    pub(super) fn stop(&mut self) {
        self.stop = None;
        if let Some(thread) = self.thread.take() {
            // A panic of the thread has shown itself already.
            let _ = thread.join();
        }
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        self.stop();
    }
}

fn read_all(master: &Pty, stopped: &io::PipeReader, shared: &Shared) {
    let mut buffer = vec![0; 1 << 16];
    loop {
        let mut polled = [PollFd::new(master, PollFlags::IN), PollFd::new(stopped, PollFlags::IN)];
        // An interrupted wait only means another look.
        let _ = rustix::event::poll(&mut polled, None);
        if !polled[1].revents().is_empty() {
            break;
        }
        let mut source = master;
        match source.read(&mut buffer) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => continue,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            // EIO on Linux, end of file elsewhere: no slave side is open.
            Ok(0) | Err(_) => break,
            Ok(count) => shared.lock().bytes.extend_from_slice(&buffer[..count]),
        }
        shared.more.notify_all();
    }
    shared.lock().ended = true;
    shared.more.notify_all();
}
