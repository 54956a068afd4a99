//! A window that is resized again and again.

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use pty_process::blocking::Pty;

/// Resizes a terminal again and again until it is dropped.
pub(crate) struct Storm {
    over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Storm {
    pub(super) fn over(terminal: Arc<Pty>) -> Self {
        let over = Arc::new(AtomicBool::new(false));
        let is_over = Arc::clone(&over);
        let thread = thread::spawn(move || {
            for step in (0_u16..).map(|step| step % 20) {
                if is_over.load(Ordering::SeqCst) {
                    break;
                }
                let size = super::Size::cells(40 + 7 * step, 50 - 2 * step).winsize();
                rustix::termios::tcsetwinsize(&*terminal, size).expect("a terminal can be resized");
                thread::sleep(Duration::from_millis(1));
            }
        });
        Self { over, thread: Some(thread) }
    }
}

impl Drop for Storm {
    fn drop(&mut self) {
        self.over.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A panic of the thread has shown itself already.
            let _ = thread.join();
        }
    }
}
