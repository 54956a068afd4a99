//! Fault injection for this crate's own tests: the program reports its phases to a test, which may
//! let them fail.
//!
//! Without the feature `test-hooks`, which only the tests switch on, the functions here do nothing.

use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock};
use std::time::Duration;

/// The connection to the test, if there is one.
static TEST: OnceLock<Mutex<UnixStream>> = OnceLock::new();
/// Whether the next job of a worker thread must panic, because the test has asked for it.
static WORKER: AtomicBool = AtomicBool::new(false);
/// Delay before [`try_report_idle`] is retried while another thread is reporting its phase.
const IDLE_RETRY: Duration = Duration::from_millis(2);
/// Number of bytes that the event loop has read from the terminal.
static READ: AtomicU64 = AtomicU64::new(0);

/// Connects to a test, to which `report_phase` reports each phase and whose answers it obeys.
///
/// Only the first call has an effect.
#[cfg(feature = "test-hooks")]
pub fn inject_faults(test: UnixStream) {
    let _ = TEST.set(Mutex::new(test));
}

/// Reports a phase of the event loop to the test and obeys the answer.
///
/// The answer `e` asks for an error, `p` for a panic, `w` for a panic in a worker thread; anything else continues. Also
/// continues, without a report, while another thread waits for its answer.
///
/// # Errors
/// If the test asks for one.
///
/// # Panics
/// If the test asks for one.
pub(crate) fn report_phase(phase: &str) -> io::Result<()> {
    report(connection().and_then(|test| test.try_lock().ok()), phase)
}

/// Reports a phase of another thread as [`report_phase`] does, but waits until no other thread is
/// reporting.
pub(crate) fn report_phase_in_thread(phase: &str) -> io::Result<()> {
    report(connection().and_then(|test| test.lock().ok()), phase)
}

fn report(test: Option<MutexGuard<'_, UnixStream>>, phase: &str) -> io::Result<()> {
    match test.and_then(|test| ask_test(test, phase)) {
        Some(b'e') => Err(io::Error::other("a test asked for an error")),
        Some(b'p') => panic!("a test asked for a panic in the loop"),
        Some(b'w') => {
            WORKER.store(true, Ordering::SeqCst);
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Reports that the event loop is about to sleep without work or timer, and how many bytes it has
/// read.
///
/// A test then knows without waiting that nothing more will happen. Returns the delay after which to call again if
/// another thread is reporting.
pub(crate) fn try_report_idle() -> io::Result<Option<Duration>> {
    let Some(test) = connection() else { return Ok(None) };
    let Ok(test) = test.try_lock() else { return Ok(Some(IDLE_RETRY)) };
    report(Some(test), &format!("rest {}", READ.load(Ordering::SeqCst)))?;
    Ok(None)
}

/// Adds to the number of bytes that the event loop has read from the terminal.
pub(super) fn count_read(bytes: usize) {
    if cfg!(feature = "test-hooks") {
        READ.fetch_add(bytes as u64, Ordering::SeqCst);
    }
}

/// Returns whether the test has asked for a panic in a worker thread, and clears the request.
pub(crate) fn take_worker_panic() -> bool {
    cfg!(feature = "test-hooks") && WORKER.swap(false, Ordering::SeqCst)
}

fn connection() -> Option<&'static Mutex<UnixStream>> {
    if cfg!(feature = "test-hooks") { TEST.get() } else { None }
}

fn ask_test(mut test: MutexGuard<'_, UnixStream>, phase: &str) -> Option<u8> {
    writeln!(test, "{phase}").ok()?;
    let mut answer = [0];
    test.read_exact(&mut answer).ok()?;
    Some(answer[0])
}
