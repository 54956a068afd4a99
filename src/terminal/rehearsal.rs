//! For this crate's own tests: what they are told, and what they have go wrong. Without the feature `test-hooks`, which
//! only tests turn on, nothing of it is left.

use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock};
use std::time::Duration;

/// The test, if one listens.
static TEST: OnceLock<Mutex<UnixStream>> = OnceLock::new();
/// Whether a worker is to panic.
static WORKER: AtomicBool = AtomicBool::new(false);
/// How long another thread may take to tell the test of its phase.
const BESIDE: Duration = Duration::from_millis(2);
/// How many bytes the loop has read from the terminal.
static READ: AtomicU64 = AtomicU64::new(0);

/// From now on this test is told of every phase that is reached, and says what is to happen there.
#[cfg(feature = "test-hooks")]
pub fn rehearse(test: UnixStream) {
    // A second test would have nobody to talk to.
    let _ = TEST.set(Mutex::new(test));
}

/// Tells the test of the phase and does what it answers: an error or a panic here or in a worker. Any other answer, or
/// none, and it goes on. So it does while another thread is held at its own phase.
pub(crate) fn reach(phase: &str) -> io::Result<()> {
    go_by(test().and_then(|test| test.try_lock().ok()), phase)
}

/// The same for a thread beside the loop's, which waits its turn.
pub(crate) fn reach_beside(phase: &str) -> io::Result<()> {
    go_by(test().and_then(|test| test.lock().ok()), phase)
}

fn go_by(test: Option<MutexGuard<'_, UnixStream>>, phase: &str) -> io::Result<()> {
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

/// Tells the test that the loop is about to sleep with no work under way and no timer, and how many bytes of the terminal
/// it has read until then. So a test knows that nothing happens any more, without waiting for that. Returns after which
/// time it has to be told again, if another thread is telling it something now.
pub(crate) fn rest() -> io::Result<Option<Duration>> {
    let Some(test) = test() else { return Ok(None) };
    let Ok(test) = test.try_lock() else { return Ok(Some(BESIDE)) };
    go_by(Some(test), &format!("rest {}", READ.load(Ordering::SeqCst)))?;
    Ok(None)
}

/// Counts bytes that the loop has read from the terminal.
pub(super) fn count_read(bytes: usize) {
    if cfg!(feature = "test-hooks") {
        READ.fetch_add(bytes as u64, Ordering::SeqCst);
    }
}

/// Whether the test wants a panic in a worker: said once.
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
