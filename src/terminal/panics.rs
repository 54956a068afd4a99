//! Panic messages, kept back while the alternate screen would swallow them.

use std::panic::PanicHookInfo;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the terminal is taken.
static HELD: AtomicBool = AtomicBool::new(false);
static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// From now on the message of a panic, in any thread, is kept while a [`Terminal`](super::Terminal) lives, for
/// [`take_panic_messages`]; at other times it goes where it went before. To be called once, by `main`.
pub fn hold_panic_messages() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if HELD.load(Ordering::SeqCst) {
            keep(panic);
        } else {
            before(panic);
        }
    }));
}

/// The messages kept so far, oldest first.
pub fn take_panic_messages() -> Vec<String> {
    MESSAGES.lock().map(|mut messages| std::mem::take(&mut *messages)).unwrap_or_default()
}

/// Said by whoever takes the terminal and gives it back.
pub(super) fn hold(taken: bool) {
    HELD.store(taken, Ordering::SeqCst);
}

fn keep(panic: &PanicHookInfo<'_>) {
    let thread = std::thread::current();
    let message = format!("thread '{}' {panic}", thread.name().unwrap_or("without a name"));
    if let Ok(mut messages) = MESSAGES.lock() {
        messages.push(message);
    }
}
