//! Panic messages, kept while the alternate screen is on, because they would vanish with it.

use std::panic::PanicHookInfo;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether panic messages are kept instead of printed, because a [`Terminal`](super::Terminal) is
/// in use.
static HELD: AtomicBool = AtomicBool::new(false);
static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Installs a panic hook that keeps the messages of all threads for [`take_panic_messages`] while a
/// [`Terminal`](super::Terminal) is in use, and otherwise calls the previous hook.
///
/// Call this once, in `main`.
pub fn hold_panic_messages() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if HELD.load(Ordering::SeqCst) {
            keep_message(panic);
        } else {
            before(panic);
        }
    }));
}

/// Removes and returns the messages kept so far, oldest first.
pub fn take_panic_messages() -> Vec<String> {
    MESSAGES.lock().map(|mut messages| std::mem::take(&mut *messages)).unwrap_or_default()
}

/// Starts or ends keeping panic messages.
pub(super) fn set_held(is_held: bool) {
    HELD.store(is_held, Ordering::SeqCst);
}

fn keep_message(panic: &PanicHookInfo<'_>) {
    let thread = std::thread::current();
    let message = format!("thread '{}' {panic}", thread.name().unwrap_or("without a name"));
    if let Ok(mut messages) = MESSAGES.lock() {
        messages.push(message);
    }
}
