//! Rest: the child reports through its test-only hooks that it sleeps until an event.

use std::{
    io::{BufRead, BufReader, Write},
    os::unix::net::UnixListener,
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

use tempfile::TempDir;

/// The rests that a child has reported.
pub(super) struct Rest {
    folder: TempDir,
    /// The number of bytes that the child had read when it last rested, plus one; 0 before the
    /// first rest.
    said: Arc<AtomicU64>,
    /// Number of loads that have reached the building of trees.
    loads: Arc<AtomicU64>,
}

impl Rest {
    /// Listens to one child, and lets it go on at every phase.
    pub(super) fn listen() -> Self {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let listener = UnixListener::bind(folder.path().join("phases")).expect("a socket can be had");
        let said = Arc::new(AtomicU64::new(0));
        let loads = Arc::new(AtomicU64::new(0));
        let (heard, begun) = (Arc::clone(&said), Arc::clone(&loads));
        // The thread ends with the child, and with the test program if no child connects.
        std::thread::spawn(move || hear(&listener, &heard, &begun));
        Self { folder, said, loads }
    }

    /// Returns the path of the socket that the child connects to.
    pub(super) fn path(&self) -> PathBuf {
        self.folder.path().join("phases")
    }

    /// Returns how many loads have reached the building of trees.
    pub(super) fn loads(&self) -> u64 {
        self.loads.load(Ordering::SeqCst)
    }

    /// Returns whether the child's last rest was after it had read `typed` bytes.
    pub(super) fn is_after(&self, typed: u64) -> bool {
        self.said.load(Ordering::SeqCst) == typed + 1
    }
}

fn hear(listener: &UnixListener, said: &AtomicU64, loads: &AtomicU64) {
    let Ok((child, _)) = listener.accept() else { return };
    let Ok(mut answers) = child.try_clone() else { return };
    for phase in BufReader::new(child).lines().map_while(Result::ok) {
        if let Some(read) = bytes_read(&phase) {
            said.store(read + 1, Ordering::SeqCst);
        }
        if phase == "build" {
            loads.fetch_add(1, Ordering::SeqCst);
        }
        // A dead child needs no answer.
        let _ = answers.write_all(b".");
    }
}

/// Returns the number of bytes that a resting child has read, if the phase is a rest.
pub(super) fn bytes_read(phase: &str) -> Option<u64> {
    phase.strip_prefix("rest ")?.parse().ok()
}
