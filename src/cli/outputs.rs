//! The output files of a command. If a signal ends the program, the unfinished file is removed
//! first.

use super::outcome::{CommandResult, Failure, reason};
use std::fs::File;
use std::io::{self, Stdout, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use termtrace::internals::output_file::{OutputFile, open_stream};
use termtrace::internals::terminal::before_death;

/// The file being written, shared with the signal thread, which removes it. The lock is held during
/// each creation, write, finish and removal, so that the signal thread finds a consistent state. It does not cover
/// streams: a write to a full pipe blocks, and the signal thread would wait for the lock.
type PartialFile = Mutex<Option<OutputFile>>;

/// Writes a whole file; if that fails or a signal interrupts it, no file is left.
pub(super) fn write(path: &Path, bytes: &[u8]) -> CommandResult {
    let mut outputs = Outputs::default();
    outputs.remove_on_signals(|| ());
    outputs.write(path, bytes).map_err(|error| Failure::runtime(path.display(), reason(&error)))
}

/// The output files of a command, which are written one after the other.
#[derive(Default)]
pub(super) struct Outputs {
    unfinished: Arc<PartialFile>,
    /// Whether temporary files that killed runs left behind were removed. Once per command
    /// suffices: a film may have thousands of files.
    has_cleaned: bool,
}

impl Outputs {
    /// Installs a handler for deadly signals that removes the unfinished file and calls `last_act`.
    pub(super) fn remove_on_signals(&self, last_act: impl FnOnce() + Send + 'static) {
        let unfinished = Arc::downgrade(&self.unfinished);
        // An error is ignored: if signals cannot be caught, the next run removes the unfinished file.
        let _ = before_death(move || {
            abandon(&unfinished);
            last_act();
        });
    }

    /// Creates a file, or opens a device or pipe.
    pub(super) fn begin(&mut self, path: &Path) -> io::Result<Output> {
        if let Some(stream) = open_stream(path)? {
            return Ok(Output::Stream(stream));
        }
        let mut unfinished = locked(&self.unfinished);
        let file = unfinished.insert(OutputFile::create(path)?);
        if !std::mem::replace(&mut self.has_cleaned, true) {
            file.remove_stale();
        }
        Ok(Output::File(Arc::clone(&self.unfinished)))
    }

    pub(super) fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut output = self.begin(path)?;
        output.write_all(bytes)?;
        output.finish()
    }
}

/// The destination of a command's bytes.
pub(super) enum Output {
    Stdout(Stdout),
    /// A device or a pipe, whose bytes cannot be taken back.
    Stream(File),
    File(Arc<PartialFile>),
}

impl Output {
    /// Flushes the output. A file has a temporary name until then, and is now renamed.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        match self {
            Self::Stdout(_) | Self::Stream(_) => Ok(()),
            Self::File(unfinished) => {
                let mut unfinished = locked(&unfinished);
                unfinished.take().map_or(Ok(()), OutputFile::finish)
            }
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Stdout(stdout) => stdout.write(bytes),
            Self::Stream(file) => file.write(bytes),
            // `None` means that the signal thread has removed the file: bytes are dropped until the program dies.
            Self::File(unfinished) => locked(unfinished).as_mut().map_or(Ok(bytes.len()), |file| file.write(bytes)),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout(stdout) => stdout.flush(),
            // Streams and files are written without a buffer, so there is nothing to flush.
            Self::Stream(_) | Self::File(_) => Ok(()),
        }
    }
}

fn locked(unfinished: &PartialFile) -> MutexGuard<'_, Option<OutputFile>> {
    // The lock's poisoning is ignored: the file must be removable even after a panic in another thread.
    unfinished.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the unfinished file, and never releases the lock, so that no other file is created
/// before the program dies.
fn abandon(unfinished: &Weak<PartialFile>) {
    // If the reference is dead, the outputs were dropped and there is no unfinished file.
    if let Some(unfinished) = unfinished.upgrade() {
        let mut file = locked(&unfinished);
        file.take();
        std::mem::forget(file);
    }
}
