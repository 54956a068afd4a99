//! Signals as something to wait for.

use rustix::event::{PollFd, PollFlags};
use rustix::fd::{AsFd, BorrowedFd};
use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGWINCH};
use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Catches signals, and carries all that wakes the loop besides keys: the wake pipe.
pub struct Signals {
    read: UnixStream,
    write: UnixStream,
    /// The last signal that asked the program to end; 0: none.
    deadly: Arc<AtomicUsize>,
    resized: Arc<AtomicBool>,
}

/// The signals by which a program is asked to end.
const DEADLY: [i32; 4] = [SIGTERM, SIGHUP, SIGINT, SIGQUIT];

impl Signals {
    /// From now on signals are caught.
    ///
    /// # Errors
    /// If the operating system refuses.
    pub fn catch() -> io::Result<Self> {
        let (read, write) = UnixStream::pair()?;
        read.set_nonblocking(true)?;
        let deadly = Arc::new(AtomicUsize::new(0));
        let resized = Arc::new(AtomicBool::new(false));
        // The flag before the pipe: who is woken must find it set.
        for signal in DEADLY {
            signal_hook::flag::register_usize(signal, Arc::clone(&deadly), signal as usize)?;
            signal_hook::low_level::pipe::register(signal, write.try_clone()?)?;
        }
        signal_hook::flag::register(SIGWINCH, Arc::clone(&resized))?;
        signal_hook::low_level::pipe::register(SIGWINCH, write.try_clone()?)?;
        Ok(Self { read, write, deadly, resized })
    }

    /// What becomes readable when there is something to do.
    pub fn wake_pipe(&self) -> BorrowedFd<'_> {
        self.read.as_fd()
    }

    /// Another thread's end of the wake pipe.
    ///
    /// # Errors
    /// If the operating system refuses.
    pub fn waker(&self) -> io::Result<Waker> {
        self.write.try_clone().map(Waker)
    }

    /// Empties the wake pipe; to be done before looking at what happened.
    pub fn drain(&mut self) {
        let mut buffer = [0; 256];
        while matches!(self.read.read(&mut buffer), Ok(count) if count > 0) {}
    }

    /// The signal that asked the program to end, if one has.
    pub fn deadly(&self) -> Option<i32> {
        match self.deadly.load(Ordering::SeqCst) {
            0 => None,
            signal => i32::try_from(signal).ok(),
        }
    }

    /// Waits until a signal asks the program to end.
    pub fn wait_for_deadly(&mut self) -> i32 {
        loop {
            if let Some(signal) = self.deadly() {
                return signal;
            }
            // Whatever interrupts it, the next look finds out why.
            let _ = rustix::event::poll(&mut [PollFd::new(&self.read, PollFlags::IN)], None);
            self.drain();
        }
    }

    /// Whether the window may have changed its size since the last call.
    pub fn take_resized(&self) -> bool {
        self.resized.swap(false, Ordering::SeqCst)
    }
}

/// Wakes the loop from another thread.
pub struct Waker(UnixStream);

impl Waker {
    /// Does so.
    pub fn wake(&mut self) {
        // A full pipe wakes as well; a closed one has nobody to wake.
        let _ = self.0.write(&[1]);
    }
}

/// Dies as if the signal had not been caught, so that the parent process sees it.
pub fn die_of(signal: i32) {
    // If even that fails, the caller goes on to exit.
    let _ = signal_hook::low_level::emulate_default_handler(signal);
}
