//! Signals as something to wait for, and job control.
//!
//! A signal that whoever started the program ignores stays ignored: a shell's `trap '' HUP`, or a job in the background
//! of a shell without job control.
//!
//! Every other signal whose default action is to end the process ends the loop instead, except SIGKILL, and SIGSEGV and
//! SIGBUS, whose handlers report a stack overflow. The usual four are caught. All others are held off like SIGTSTP and
//! taken by one thread: their disposition stays the default, so that [`die_of`] only has to let one through. (To set a
//! disposition back takes unsafe code, and signal-hook, which has it, does so for a list without real-time signals.)

use nix::sys::signal::{SigSet, SigmaskHow, Signal, raise};
use rustix::fd::{AsFd, BorrowedFd};
use signal_hook::consts::{
    SIGALRM, SIGCONT, SIGHUP, SIGINT, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGTRAP, SIGTSTP, SIGTTOU, SIGUSR1, SIGUSR2,
    SIGVTALRM, SIGWINCH, SIGXCPU, SIGXFSZ,
};
use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

/// Catches signals, and carries all that wakes the loop besides keys: the wake pipe.
pub struct Signals {
    read: UnixStream,
    write: UnixStream,
    /// The last signal that asked the program to end; 0: none.
    deadly: Arc<AtomicUsize>,
    resized: Arc<AtomicBool>,
    continued: Arc<AtomicBool>,
    /// Something for each SIGTSTP; nobody to ask if it is ignored.
    stops: Option<Receiver<()>>,
}

/// The signals by which a program is usually asked to end: they are caught.
const CAUGHT: [i32; 4] = [SIGTERM, SIGHUP, SIGINT, SIGQUIT];

/// The other signals that end a program by default and that signal-hook can set back. [`before_death`] catches them too:
/// it is called when threads run already, which would not hold them off. Real-time signals, SIGIO, SIGPWR and SIGSTKFLT
/// are missing; the next run removes what they leave.
const CAUGHT_BEFORE_DEATH: [i32; 8] = [SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGSYS, SIGTRAP];

/// The signals that are not held off, besides those that are caught.
const LET_THROUGH: &[Signal] = &[
    // No program can hold them off.
    Signal::SIGKILL,
    Signal::SIGSTOP,
    // Faults of the program itself; the standard library reports a stack overflow from their handlers.
    Signal::SIGSEGV,
    Signal::SIGBUS,
    // Their default is not to end the process.
    Signal::SIGCHLD,
    Signal::SIGURG,
    Signal::SIGTTIN,
    Signal::SIGTTOU,
    #[cfg(target_os = "macos")]
    Signal::SIGINFO,
    // The failed write is the error: see `fail_large_writes`, and what the standard library does.
    Signal::SIGXFSZ,
    Signal::SIGPIPE,
    // Caught.
    Signal::SIGTERM,
    Signal::SIGHUP,
    Signal::SIGINT,
    Signal::SIGQUIT,
    Signal::SIGWINCH,
    Signal::SIGCONT,
];

/// How long our own copy of a signal to the whole group may take.
const DELIVERY: Duration = Duration::from_millis(100);

/// Who is to be stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// This process.
    Process,
    /// All of its process group, as when the terminal itself understands Ctrl-Z.
    Group,
}

impl Signals {
    /// From now on signals are caught, by the calling thread alone if the others are begun by [`without_signals`].
    ///
    /// # Errors
    /// If the operating system refuses.
    pub fn catch() -> io::Result<Self> {
        let (read, write) = UnixStream::pair()?;
        read.set_nonblocking(true)?;
        let ignored = ignored();
        let deadly = Arc::new(AtomicUsize::new(0));
        catch_deadly(&CAUGHT, ignored, &deadly, &write)?;
        let flag = |signal| -> io::Result<Arc<AtomicBool>> {
            let flag = Arc::new(AtomicBool::new(false));
            signal_hook::flag::register(signal, Arc::clone(&flag))?;
            signal_hook::low_level::pipe::register(signal, write.try_clone()?)?;
            Ok(flag)
        };
        let (resized, continued) = (flag(SIGWINCH)?, flag(SIGCONT)?);
        let stops = take_held_off(ignored, Arc::clone(&deadly), Waker(write.try_clone()?))?;
        let stops = (!contains(ignored, SIGTSTP)).then_some(stops);
        Ok(Self { read, write, deadly, resized, continued, stops })
    }

    /// What becomes readable when there is something to do.
    #[doc(hidden)]
    pub fn wake_pipe(&self) -> BorrowedFd<'_> {
        self.read.as_fd()
    }

    /// Another thread's end of the wake pipe.
    ///
    /// # Errors
    /// If the operating system refuses.
    #[doc(hidden)]
    pub fn waker(&self) -> io::Result<Waker> {
        self.write.try_clone().map(Waker)
    }

    /// Empties the wake pipe; to be done before looking at what happened.
    #[doc(hidden)]
    pub fn drain(&mut self) {
        let mut buffer = [0; 256];
        while matches!(self.read.read(&mut buffer), Ok(count) if count > 0) {}
    }

    /// The signal that asked the program to end, if one has.
    pub fn deadly(&self) -> Option<i32> {
        signal_in(&self.deadly)
    }

    /// Whether the window may have changed its size since the last call.
    #[doc(hidden)]
    pub fn take_resized(&self) -> bool {
        self.resized.swap(false, Ordering::SeqCst)
    }

    /// Whether a signal asked the program to stop since the last call.
    #[doc(hidden)]
    pub fn take_stop(&self) -> bool {
        self.stops.as_ref().is_some_and(|stops| stops.try_recv().is_ok())
    }

    /// Whether the program was stopped by something that it cannot hear of (SIGSTOP), and continued, since the last
    /// call.
    #[doc(hidden)]
    pub fn take_continued(&self) -> bool {
        self.continued.swap(false, Ordering::SeqCst)
    }

    /// Stops until a shell says to go on: to be called by the thread that called [`catch`](Self::catch), with the
    /// terminal given back. It returns at once where stops are ignored, or where nobody is there to say it.
    #[doc(hidden)]
    pub fn stop(&mut self, who: Stopped) {
        let Some(stops) = &self.stops else { return };
        if who == Stopped::Group && rustix::process::kill_current_process_group(rustix::process::Signal::TSTP).is_ok() {
            // We are in the group too, and would be stopped a second time.
            let _ = stops.recv_timeout(DELIVERY);
        }
        // To this thread alone, where it is held off: the one that hears of stops does not get it. A SIGCONT from now on
        // takes it away again.
        let stop = stop_signal();
        let _ = raise(Signal::SIGTSTP);
        if self.take_continued() {
            // The shell saw the rest of the group stop, and was quick: who stops now is never continued.
            let _ = raise(Signal::SIGTSTP);
            let _ = stop.wait();
        } else {
            // Here it stops.
            let _ = stop.thread_unblock();
            let _ = stop.thread_block();
        }
        while stops.try_recv().is_ok() {}
        self.take_continued();
    }
}

/// Catches signals that ask the program to end, but for the ignored ones.
fn catch_deadly(signals: &[i32], ignored: u64, deadly: &Arc<AtomicUsize>, wake: &UnixStream) -> io::Result<()> {
    for &signal in signals.iter().filter(|&&signal| !contains(ignored, signal)) {
        // The flag before the pipe: who is woken must find it set.
        signal_hook::flag::register_usize(signal, Arc::clone(deadly), signal as usize)?;
        signal_hook::low_level::pipe::register(signal, wake.try_clone()?)?;
    }
    Ok(())
}

fn signal_in(deadly: &AtomicUsize) -> Option<i32> {
    match deadly.load(Ordering::SeqCst) {
        0 => None,
        signal => i32::try_from(signal).ok(),
    }
}

/// For a command without a loop: from now on a signal that asks the program to end does this first, on a thread of its
/// own, and then kills the program as if it had not been caught. Stops are not caught.
///
/// # Errors
/// If the operating system refuses.
pub fn before_death(last_act: impl FnOnce() + Send + 'static) -> io::Result<()> {
    let (mut read, write) = UnixStream::pair()?;
    let deadly = Arc::new(AtomicUsize::new(0));
    let caught = Arc::clone(&deadly);
    let wait = move || {
        // An error: no signal could be caught.
        if let (Ok(()), Some(signal)) = (read.read_exact(&mut [0]), signal_in(&caught)) {
            last_act();
            die_of(signal);
        }
    };
    // Before the signals are caught: nobody else would hear of them.
    thread::Builder::new().name("signals".to_owned()).spawn(wait)?;
    let ignored = ignored();
    catch_deadly(&CAUGHT, ignored, &deadly, &write)?;
    catch_deadly(&CAUGHT_BEFORE_DEATH, ignored, &deadly, &write)
}

/// Holds off from all threads what is not caught, and has one thread take it: SIGTSTP goes into the channel, any other
/// signal asks the program to end.
///
/// SIGTSTP is not caught, so that its action stays the system's: that alone stops a process as its shell expects, and does
/// not where nobody could continue it (started by a terminal without a shell, it is of an orphaned process group, and would
/// hang for ever after SIGSTOP).
fn take_held_off(ignored: u64, deadly: Arc<AtomicUsize>, mut waker: Waker) -> io::Result<Receiver<()>> {
    let signals = held_off();
    signals.thread_block()?;
    let mut taken = Taken::of(&signals)?;
    let (heard, stops) = channel();
    let listen = move || {
        while let Ok(signal) = taken.next() {
            // A signal that is held off stays pending even if it is ignored, so it arrives here all the same.
            if contains(ignored, signal) {
                continue;
            }
            if signal == SIGTSTP {
                if heard.send(()).is_err() {
                    break;
                }
            } else {
                deadly.store(signal as usize, Ordering::SeqCst);
            }
            waker.wake();
        }
    };
    without_signals(|| thread::Builder::new().name("signals".to_owned()).spawn(listen))?;
    Ok(stops)
}

/// The signals that are held off: also those that nix has no name for, the real-time signals.
fn held_off() -> SigSet {
    let mut signals = SigSet::all();
    for &signal in LET_THROUGH {
        signals.remove(signal);
    }
    signals
}

/// The signals that a process has pending, one by one. (`sigwait` would do, but nix returns its own enumeration, which has
/// no real-time signals.)
#[cfg(target_os = "linux")]
struct Taken(nix::sys::signalfd::SignalFd);

#[cfg(target_os = "linux")]
impl Taken {
    fn of(signals: &SigSet) -> io::Result<Self> {
        use nix::sys::signalfd::{SfdFlags, SignalFd};
        Ok(Self(SignalFd::with_flags(signals, SfdFlags::SFD_CLOEXEC)?))
    }

    /// Waits for the next one.
    fn next(&mut self) -> io::Result<i32> {
        let signal = self.0.read_signal()?.ok_or(io::ErrorKind::WouldBlock)?;
        i32::try_from(signal.ssi_signo).map_err(io::Error::other)
    }
}

/// The signals that a process has pending, one by one.
#[cfg(not(target_os = "linux"))]
struct Taken(SigSet);

#[cfg(not(target_os = "linux"))]
impl Taken {
    #[expect(clippy::unnecessary_wraps, reason = "it can fail on Linux")]
    fn of(signals: &SigSet) -> io::Result<Self> {
        Ok(Self(*signals))
    }

    /// Waits for the next one.
    fn next(&mut self) -> io::Result<i32> {
        Ok(self.0.wait()? as i32)
    }
}

fn stop_signal() -> SigSet {
    SigSet::from_iter([Signal::SIGTSTP])
}

/// Does something without any signal. Threads begun in it never get one, so that all go to the thread that knows what
/// to do: it has then seen the signals that came while it was stopped when it goes on.
pub fn without_signals<T>(work: impl FnOnce() -> T) -> T {
    without(&SigSet::all(), work)
}

/// Stops the whole process group, as the system does for a process in the background that writes; a shell sees no stop of
/// a job in parts. Whether that is not ignored. (The system would begin what it stopped us for anew after each signal that
/// is caught, and so stop us again before we have heard of one.)
pub(super) fn stop_for_output() -> bool {
    let is_heeded = !contains(ignored(), SIGTTOU);
    is_heeded && rustix::process::kill_current_process_group(rustix::process::Signal::TTOU).is_ok()
}

/// Does something for which the system would stop a process in the background.
pub(super) fn in_the_background<T>(work: impl FnOnce() -> T) -> T {
    without(&SigSet::from_iter([Signal::SIGTTOU]), work)
}

fn without<T>(signals: &SigSet, work: impl FnOnce() -> T) -> T {
    let before = signals.thread_swap_mask(SigmaskHow::SIG_BLOCK);
    let done = work();
    if let Ok(before) = before {
        let _ = before.thread_set_mask();
    }
    done
}

/// The signals that are ignored now, a bit for each. Only Linux says so; elsewhere the ignored ones are caught too.
fn ignored() -> u64 {
    ignored_in(&std::fs::read_to_string("/proc/self/status").unwrap_or_default())
}

fn contains(signals: u64, signal: i32) -> bool {
    signals >> (signal - 1) & 1 == 1
}

fn ignored_in(status: &str) -> u64 {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Wakes the loop from another thread.
pub struct Waker(UnixStream);

impl Waker {
    /// One more.
    ///
    /// # Errors
    /// If the operating system refuses.
    pub fn try_clone(&self) -> io::Result<Self> {
        self.0.try_clone().map(Self)
    }

    /// Does so.
    pub fn wake(&mut self) {
        // A full pipe wakes as well; a closed one has nobody to wake.
        let _ = self.0.write(&[1]);
    }
}

/// Dies as if the signal had been neither caught nor held off, so that the parent process sees it.
pub fn die_of(signal: i32) {
    // Does not return if the signal is caught, or one that it knows to be deadly.
    let _ = signal_hook::low_level::emulate_default_handler(signal);
    // Of all that is let through, what is pending for the thread itself comes first. If even that fails, the caller goes
    // on to exit.
    let _ = signal_hook::low_level::raise(signal);
    let _ = held_off().thread_unblock();
}

/// Has writes beyond the limit on the size of files (`ulimit -f`) fail with an error, instead of SIGXFSZ ending the
/// process. To be called once, by `main`, for all threads.
///
/// # Errors
/// If the operating system refuses.
pub fn fail_large_writes() -> io::Result<()> {
    // A handler that does nothing suffices: the write has failed already. Unlike an ignored signal it goes back to the
    // default in programs that are started.
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ignored_signals_are_read_from_the_processs_status() {
        let ignored =
            ignored_in("Name:\tsh\nSigBlk:\t0000000000000002\nSigIgn:\t0000000000000001\nSigCgt:\t0000000000000002\n");
        assert_eq!(ignored, 1 << (SIGHUP - 1));
        assert_eq!(ignored_in("no such line"), 0);
    }
}
