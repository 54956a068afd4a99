//! Fault injection for this crate's own tests.
//!
//! A test learns which phase the program has reached, and may have it fail.
//!
//! Compiled to nothing without the feature `test-hooks`, which only the tests switch on.

use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock};
use std::time::Duration;

/// The connection to the test, if there is one.
static TEST: OnceLock<Mutex<UnixStream>> = OnceLock::new();
/// Whether the next job of a worker thread is to panic.
static WORKER: AtomicBool = AtomicBool::new(false);
/// Delay before [`rest`] is retried while another thread is reporting its phase.
const REST_RETRY: Duration = Duration::from_millis(2);
/// Number of bytes that the loop has read from the terminal.
static READ: AtomicU64 = AtomicU64::new(0);

/// Reports every phase reached from now on to `test`, which answers what is to happen there.
///
/// Only the first call has an effect.
#[cfg(feature = "test-hooks")]
pub fn inject_faults(test: UnixStream) {
    let _ = TEST.set(Mutex::new(test));
}

/// Reports a phase of the loop to the test and obeys the answer.
///
/// `e` for an error, `p` for a panic, `w` for a panic in a worker; anything else continues. Continues as well while
/// another thread is held at its own phase.
///
/// # Errors
/// If the test asks for one.
///
/// # Panics
/// If the test asks for one.
pub(crate) fn reach(phase: &str) -> io::Result<()> {
    report(test().and_then(|test| test.try_lock().ok()), phase)
}

/// Reports a phase of another thread than the loop's, as [`reach`] does, after waiting for its
/// turn.
pub(crate) fn reach_in_thread(phase: &str) -> io::Result<()> {
    report(test().and_then(|test| test.lock().ok()), phase)
}

fn report(test: Option<MutexGuard<'_, UnixStream>>, phase: &str) -> io::Result<()> {
    match test.and_then(|test| answer(test, phase)) {
        Some(b'e') => Err(io::Error::other("a test asked for an error")),
        Some(b'p') => panic!("a test asked for a panic in the loop"),
        Some(b'w') => {
            WORKER.store(true, Ordering::SeqCst);
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Reports that the loop is about to sleep without work or timer, and how many bytes it has read,
/// so that a test need not wait to know that nothing more happens.
///
/// Returns the delay after which to call again, if another thread is reporting at the moment.
pub(crate) fn rest() -> io::Result<Option<Duration>> {
    let Some(test) = test() else { return Ok(None) };
    let Ok(test) = test.try_lock() else { return Ok(Some(REST_RETRY)) };
    report(Some(test), &format!("rest {}", READ.load(Ordering::SeqCst)))?;
    Ok(None)
}

/// Adds to the number of bytes that the loop has read from the terminal.
pub(super) fn count_read(bytes: usize) {
    if cfg!(feature = "test-hooks") {
        READ.fetch_add(bytes as u64, Ordering::SeqCst);
    }
}

/// Returns whether the test has asked for a panic in a worker, and clears the request.
pub(crate) fn take_worker_panic() -> bool {
    cfg!(feature = "test-hooks") && WORKER.swap(false, Ordering::SeqCst)
}

fn test() -> Option<&'static Mutex<UnixStream>> {
    if cfg!(feature = "test-hooks") { TEST.get() } else { None }
}

fn answer(mut test: MutexGuard<'_, UnixStream>, phase: &str) -> Option<u8> {
    writeln!(test, "{phase}").ok()?;
    let mut answer = [0];
    test.read_exact(&mut answer).ok()?;
    Some(answer[0])
}
