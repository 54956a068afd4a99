//! Signals as events of the live view's loop, and job control.
//!
//! Signals that were ignored when the program was started, as after a shell's `trap '' HUP` or in a background job of a
//! shell without job control, stay ignored.
//!
//! Every other signal whose default action ends the process ends the loop instead. Exceptions are SIGKILL, and SIGSEGV
//! and SIGBUS, whose handlers report a stack overflow. SIGTERM, SIGHUP, SIGINT and SIGQUIT are caught. All others, and
//! SIGTSTP, are blocked and accepted by one thread: their disposition stays the default, so that [`die_of`] only has to
//! unblock the signal. (Resetting a disposition takes unsafe code, and signal-hook does it for no real-time signals.)

use nix::sys::signal::{SigSet, SigmaskHow, Signal, raise};
use rustix::fd::{AsFd, BorrowedFd};
use signal_hook::consts::{
    SIGALRM, SIGCONT, SIGHUP, SIGINT, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGTRAP, SIGTSTP, SIGTTOU, SIGUSR1, SIGUSR2,
    SIGVTALRM, SIGWINCH, SIGXCPU, SIGXFSZ,
};
use std::fmt;
use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

/// The flags that signal handlers set, and the wake pipe, which wakes the loop for all events but
/// keys.
pub struct Signals {
    read: UnixStream,
    write: UnixStream,
    /// The number of the last signal that asked the program to end, or 0.
    deadly: Arc<AtomicUsize>,
    resized: Arc<AtomicBool>,
    continued: Arc<AtomicBool>,
    /// Whether SIGHUP has asked to read files again.
    reload: Arc<AtomicBool>,
    /// Whether the process had a controlling terminal at the start.
    had_terminal: bool,
    /// The receiver of stop requests (SIGTSTP); `None` if SIGTSTP is ignored.
    stops: Option<Receiver<StopRequest>>,
}

/// Signals that conventionally ask a program to end, for which handlers are installed.
const CAUGHT: [i32; 4] = [SIGTERM, SIGHUP, SIGINT, SIGQUIT];

/// Signals that ask a server to end: those of [`CAUGHT`] but SIGHUP.
const CAUGHT_BY_SERVER: [i32; 3] = [SIGTERM, SIGINT, SIGQUIT];

/// Signals that [`before_death`] catches besides [`CAUGHT`].
///
/// They end a program by default, and signal-hook can reset their disposition. Blocking them, as the live view does, is
/// impossible when threads are running already. Real-time signals, SIGIO, SIGPWR and SIGSTKFLT are missing: if one of
/// them ends the program, its next run removes the temporary files.
const CAUGHT_BEFORE_DEATH: [i32; 8] = [SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGSYS, SIGTRAP];

/// Signals that are never blocked.
const UNBLOCKED: &[Signal] = &[
    // The system does not allow blocking these signals.
    Signal::SIGKILL,
    Signal::SIGSTOP,
    // These signals report faults of the program itself; the standard library reports a stack overflow from their
    // handlers.
    Signal::SIGSEGV,
    Signal::SIGBUS,
    // The default action of these signals does not end the process.
    Signal::SIGCHLD,
    Signal::SIGURG,
    Signal::SIGTTIN,
    Signal::SIGTTOU,
    #[cfg(target_os = "macos")]
    Signal::SIGINFO,
    // A write that would cause these signals fails with an error instead, by `fail_large_writes` and by the standard
    // library.
    Signal::SIGXFSZ,
    Signal::SIGPIPE,
    // Handlers are installed for the following signals.
    Signal::SIGTERM,
    Signal::SIGHUP,
    Signal::SIGINT,
    Signal::SIGQUIT,
    Signal::SIGWINCH,
    Signal::SIGCONT,
];

/// Time to wait for a signal that this process has sent to its group, itself included.
// Delivery takes well under a millisecond on an idle machine; the limit only keeps a lost signal from hanging the
// program.
const GROUP_SIGNAL_TIMEOUT: Duration = Duration::from_millis(100);

/// A SIGTSTP that the process received.
struct StopRequest;

/// The processes that [`Signals::stop`] stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopTarget {
    /// Only this process.
    Process,
    /// The whole process group, as a terminal does for Ctrl-Z.
    Group,
}

impl fmt::Debug for Signals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Signals").field("deadly", &self.deadly()).finish_non_exhaustive()
    }
}

impl Signals {
    /// Installs the handlers.
    ///
    /// Signals arrive at the calling thread if all other threads are started within [`without_signals`].
    ///
    /// # Errors
    /// If the operating system refuses.
    pub fn catch() -> io::Result<Self> {
        Self::install(&CAUGHT)
    }

    /// Installs the handlers of a server, for which SIGHUP is a request to read its files again.
    ///
    /// # Errors
    /// If the operating system refuses.
    #[doc(hidden)]
    pub fn catch_for_server() -> io::Result<Self> {
        let signals = Self::install(&CAUGHT_BY_SERVER)?;
        if !contains_signal(ignored_signals(), SIGHUP) {
            signal_hook::flag::register(SIGHUP, Arc::clone(&signals.reload))?;
            signal_hook::low_level::pipe::register(SIGHUP, signals.write.try_clone()?)?;
        }
        Ok(signals)
    }

    /// Installs the handlers, by which these signals ask the program to end.
    fn install(deadly_signals: &[i32]) -> io::Result<Self> {
        let (read, write) = UnixStream::pair()?;
        // Non-blocking, because `drain` reads until the pipe is empty.
        read.set_nonblocking(true)?;
        let ignored = ignored_signals();
        let deadly = Arc::new(AtomicUsize::new(0));
        catch_deadly(deadly_signals, ignored, &deadly, &write)?;
        let flag = |signal| -> io::Result<Arc<AtomicBool>> {
            let flag = Arc::new(AtomicBool::new(false));
            signal_hook::flag::register(signal, Arc::clone(&flag))?;
            signal_hook::low_level::pipe::register(signal, write.try_clone()?)?;
            Ok(flag)
        };
        let (resized, continued) = (flag(SIGWINCH)?, flag(SIGCONT)?);
        let stops = spawn_signal_acceptor(ignored, Arc::clone(&deadly), Waker(write.try_clone()?))?;
        let stops = (!contains_signal(ignored, SIGTSTP)).then_some(stops);
        Ok(Self {
            read,
            write,
            deadly,
            resized,
            continued,
            reload: Arc::default(),
            had_terminal: has_controlling_terminal(),
            stops,
        })
    }

    /// Returns the reading end of the wake pipe, to be polled.
    #[doc(hidden)]
    pub fn wake_pipe(&self) -> BorrowedFd<'_> {
        self.read.as_fd()
    }

    /// Returns a writing end of the wake pipe for another thread.
    ///
    /// # Errors
    /// If the operating system refuses.
    #[doc(hidden)]
    pub fn waker(&self) -> io::Result<Waker> {
        self.write.try_clone().map(Waker)
    }

    /// Empties the wake pipe.
    ///
    /// Call this before looking at the flags, so that a later event wakes the loop again.
    #[doc(hidden)]
    pub fn drain(&mut self) {
        let mut buffer = [0; 256];
        while matches!(self.read.read(&mut buffer), Ok(count) if count > 0) {}
    }

    /// Returns the signal that asked the program to end, if any.
    #[doc(hidden)]
    pub fn deadly(&self) -> Option<i32> {
        signal_of(self.deadly.load(Ordering::SeqCst))
    }

    /// Returns the signal that has asked the program to end since the last call, if any.
    #[cfg(feature = "serve")]
    pub(crate) fn take_deadly(&self) -> Option<i32> {
        signal_of(self.deadly.swap(0, Ordering::SeqCst))
    }

    /// Returns whether SIGHUP has asked since the last call to read files again.
    ///
    /// That is only so after [`catch_for_server`](Self::catch_for_server). If the terminal of the process has been
    /// closed, which sends SIGHUP too, the signal asks the program to end.
    #[doc(hidden)]
    pub fn take_reload(&mut self) -> bool {
        let reloads = self.reload.swap(false, Ordering::SeqCst);
        if reloads && self.had_terminal && !has_controlling_terminal() {
            // A closed terminal asks once, although it may send the signal again.
            self.had_terminal = false;
            self.deadly.store(SIGHUP as usize, Ordering::SeqCst);
            return false;
        }
        reloads
    }

    /// Returns whether the window may have changed its size since the last call.
    #[doc(hidden)]
    pub fn take_resized(&self) -> bool {
        self.resized.swap(false, Ordering::SeqCst)
    }

    /// Returns whether a SIGTSTP (stop request) has arrived that no call has returned yet.
    #[doc(hidden)]
    pub fn take_stop(&self) -> bool {
        self.stops.as_ref().is_some_and(|stops| stops.try_recv().is_ok())
    }

    /// Returns whether the program was continued since the last call, after a stop that cannot be
    /// caught (SIGSTOP).
    #[doc(hidden)]
    pub fn take_continued(&self) -> bool {
        self.continued.swap(false, Ordering::SeqCst)
    }

    /// Stops the process until it is continued.
    ///
    /// Must be called by the thread that called [`catch`](Self::catch), after the terminal has been restored. Returns
    /// at once if SIGTSTP is ignored or the process group is orphaned, so that nothing could continue it.
    #[doc(hidden)]
    pub fn stop(&mut self, target: StopTarget) {
        let Some(stops) = &self.stops else { return };
        let stop_group = || rustix::process::kill_current_process_group(rustix::process::Signal::TSTP);
        if target == StopTarget::Group && stop_group().is_ok() {
            // The group's SIGTSTP comes to this process too. It is received here, or it would stop the process a second
            // time.
            let _ = stops.recv_timeout(GROUP_SIGNAL_TIMEOUT);
        }
        // `raise` makes the signal pending for this thread, where it is blocked, and not for the process, so that the
        // accepting thread does not get it. A SIGCONT from here on removes the pending signal.
        let stop = stop_signal();
        let _ = raise(Signal::SIGTSTP);
        if self.take_continued() {
            // The shell has seen the rest of the group stop and has already continued it; it would not continue this
            // process if it stopped now. So SIGTSTP is taken from the pending signals instead, raised again in case
            // SIGCONT has removed it.
            let _ = raise(Signal::SIGTSTP);
            let _ = stop.wait();
        } else {
            // Unblocking delivers the signal: the process stops here.
            let _ = stop.thread_unblock();
            let _ = stop.thread_block();
        }
        while stops.try_recv().is_ok() {}
        self.take_continued();
    }
}

/// Installs handlers, which set `deadly` and wake the loop, for those of `signals` that are not
/// ignored.
fn catch_deadly(signals: &[i32], ignored: u64, deadly: &Arc<AtomicUsize>, wake: &UnixStream) -> io::Result<()> {
    for &signal in signals.iter().filter(|&&signal| !contains_signal(ignored, signal)) {
        // The flag is registered before the pipe, because a thread that the pipe wakes must find the flag set.
        signal_hook::flag::register_usize(signal, Arc::clone(deadly), signal as usize)?;
        signal_hook::low_level::pipe::register(signal, wake.try_clone()?)?;
    }
    Ok(())
}

/// Returns the signal of a number, of which 0 means none.
fn signal_of(number: usize) -> Option<i32> {
    i32::try_from(number).ok().filter(|&signal| signal != 0)
}

/// Installs handlers that run `last_act` before a signal ends the process, for commands without a
/// loop.
///
/// `last_act` runs on a thread of its own, which then raises the signal with its default action. Stop signals are not
/// caught.
///
/// # Errors
/// If the operating system refuses.
pub fn before_death(last_act: impl FnOnce() + Send + 'static) -> io::Result<()> {
    let (mut read, write) = UnixStream::pair()?;
    let deadly = Arc::new(AtomicUsize::new(0));
    let caught = Arc::clone(&deadly);
    let wait = move || {
        // A read error means that no handler could be installed.
        if let (Ok(()), Some(signal)) = (read.read_exact(&mut [0]), signal_of(caught.load(Ordering::SeqCst))) {
            last_act();
            die_of(signal);
        }
    };
    // The thread starts before the handlers are installed, so that no signal is caught without a receiver.
    thread::Builder::new().name("signals".to_owned()).spawn(wait)?;
    let ignored = ignored_signals();
    catch_deadly(&CAUGHT, ignored, &deadly, &write)?;
    catch_deadly(&CAUGHT_BEFORE_DEATH, ignored, &deadly, &write)
}

/// Blocks the uncaught signals in all threads and starts a thread that accepts them.
///
/// Each SIGTSTP is sent to the returned channel; any other signal asks the program to end.
///
/// SIGTSTP is blocked rather than caught, because only its default action stops a process as its shell expects. In an
/// orphaned process group (a terminal that runs the program without a shell), which cannot be continued, that action
/// does nothing, whereas SIGSTOP would hang the process for ever.
fn spawn_signal_acceptor(
    ignored: u64,
    deadly: Arc<AtomicUsize>,
    mut waker: Waker,
) -> io::Result<Receiver<StopRequest>> {
    let signals = signals_to_block();
    signals.thread_block()?;
    let mut pending = PendingSignals::for_signals(&signals)?;
    let (stopped, stops) = channel();
    let accept = move || {
        while let Ok(signal) = pending.next() {
            // A signal that is both blocked and ignored becomes pending too, and is skipped here.
            if contains_signal(ignored, signal) {
                continue;
            }
            if signal == SIGTSTP {
                if stopped.send(StopRequest).is_err() {
                    break;
                }
            } else {
                deadly.store(signal as usize, Ordering::SeqCst);
            }
            waker.wake();
        }
    };
    without_signals(|| thread::Builder::new().name("signals".to_owned()).spawn(accept))?;
    Ok(stops)
}

/// Returns the signals to block; they include the real-time signals, for which nix has no names.
fn signals_to_block() -> SigSet {
    let mut signals = SigSet::all();
    for &signal in UNBLOCKED {
        signals.remove(signal);
    }
    signals
}

/// An iterator over the signals pending for the process.
///
/// Reads a signalfd instead of calling `sigwait`, because nix's `sigwait` returns an enum without the real-time
/// signals.
#[cfg(target_os = "linux")]
struct PendingSignals(nix::sys::signalfd::SignalFd);

#[cfg(target_os = "linux")]
impl PendingSignals {
    fn for_signals(signals: &SigSet) -> io::Result<Self> {
        use nix::sys::signalfd::{SfdFlags, SignalFd};
        Ok(Self(SignalFd::with_flags(signals, SfdFlags::SFD_CLOEXEC)?))
    }

    /// Waits for the next signal and removes it from the pending ones.
    fn next(&mut self) -> io::Result<i32> {
        let signal = self.0.read_signal()?.ok_or(io::ErrorKind::WouldBlock)?;
        i32::try_from(signal.ssi_signo).map_err(io::Error::other)
    }
}

/// An iterator over the signals pending for the process.
#[cfg(not(target_os = "linux"))]
struct PendingSignals(SigSet);

#[cfg(not(target_os = "linux"))]
impl PendingSignals {
    #[expect(clippy::unnecessary_wraps, reason = "it can fail on Linux")]
    fn for_signals(signals: &SigSet) -> io::Result<Self> {
        Ok(Self(*signals))
    }

    /// Waits for the next signal and removes it from the pending ones.
    fn next(&mut self) -> io::Result<i32> {
        Ok(self.0.wait()? as i32)
    }
}

fn stop_signal() -> SigSet {
    SigSet::from_iter([Signal::SIGTSTP])
}

/// Runs `work` with all signals blocked in this thread and in the threads that `work` starts.
///
/// So signals are delivered to the thread that installed the handlers, and after a stop the SIGCONT handler has run
/// before that thread goes on.
pub fn without_signals<T>(work: impl FnOnce() -> T) -> T {
    with_blocked(&SigSet::all(), work)
}

/// Lowers the priority of this thread, and of threads that it starts, below that of all others.
// Only Linux has priorities of threads: elsewhere the whole process would be slower. A failure does no harm.
pub fn lower_thread_priority() {
    #[cfg(target_os = "linux")]
    let _ = rustix::process::setpriority_process(None, 10);
}

/// Stops the process group by SIGTTOU, and returns whether it could: `false` if SIGTTOU is ignored.
///
/// The kernel does the same when a background process changes its terminal. But the kernel restarts the interrupted
/// call after each caught signal, and so would stop the process again before the program reacts to the signal. The
/// whole group is stopped, because a shell does not notice a job of which only one process stops.
pub(super) fn stop_for_output() -> bool {
    let is_stopping = !contains_signal(ignored_signals(), SIGTTOU);
    is_stopping && rustix::process::kill_current_process_group(rustix::process::Signal::TTOU).is_ok()
}

/// Runs `work` with SIGTTOU blocked, so that a background process may change its terminal.
pub(super) fn with_sigttou_blocked<T>(work: impl FnOnce() -> T) -> T {
    with_blocked(&SigSet::from_iter([Signal::SIGTTOU]), work)
}

/// Runs `work` with `signals` blocked in this thread.
fn with_blocked<T>(signals: &SigSet, work: impl FnOnce() -> T) -> T {
    let before = signals.thread_swap_mask(SigmaskHow::SIG_BLOCK);
    let done = work();
    if let Ok(before) = before {
        let _ = before.thread_set_mask();
    }
    done
}

/// Returns the set of ignored signals, with signal n in bit n - 1.
///
/// On other systems than Linux the set is empty, so that ignored signals are caught too.
fn ignored_signals() -> u64 {
    ignored_in(&std::fs::read_to_string("/proc/self/status").unwrap_or_default())
}

fn contains_signal(signals: u64, signal: i32) -> bool {
    signals >> (signal - 1) & 1 == 1
}

fn ignored_in(status: &str) -> u64 {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// A writing end of the wake pipe, with which another thread wakes the event loop.
pub struct Waker(UnixStream);

impl Waker {
    /// Returns another writing end of the wake pipe.
    ///
    /// # Errors
    /// If the operating system refuses.
    pub fn try_clone(&self) -> io::Result<Self> {
        self.0.try_clone().map(Self)
    }

    /// Wakes the loop.
    pub fn wake(&mut self) {
        // Errors do not matter: a full pipe wakes the loop anyway, and a closed one means that the loop has ended.
        let _ = self.0.write(&[1]);
    }
}

/// Returns whether the process has a controlling terminal.
///
/// It loses that terminal when it is closed.
fn has_controlling_terminal() -> bool {
    use rustix::fs::{Mode, OFlags};
    rustix::fs::open("/dev/tty", OFlags::RDONLY | OFlags::NOCTTY | OFlags::CLOEXEC, Mode::empty()).is_ok()
}

/// Ends the process by the signal's default action, so that its parent sees the signal as the
/// cause.
///
/// Returns only if that fails.
pub fn die_of(signal: i32) {
    // Ends the process if signal-hook knows the signal as one that ends a process. The lines below are for all others.
    let _ = signal_hook::low_level::emulate_default_handler(signal);
    // These other signals are blocked. `raise` makes the signal pending for this thread, and unblocking delivers
    // signals that are pending for the thread before those that are pending for the process.
    let _ = signal_hook::low_level::raise(signal);
    let _ = signals_to_block().thread_unblock();
}

/// Lets writes beyond the file size limit (`ulimit -f`) fail, instead of ending the process by
/// SIGXFSZ.
///
/// Call this once, in `main`; it applies to all threads.
///
/// # Errors
/// If the operating system refuses.
pub fn fail_large_writes() -> io::Result<()> {
    // An empty handler suffices, because the write has already failed. Unlike SIG_IGN, programs that this one starts do
    // not inherit it.
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map(drop)
}

#[cfg(all(test, unit_tests))]
mod tests;
