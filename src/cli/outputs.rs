//! The files that a command writes. A signal that ends the program removes the unfinished one
//! first.

use super::outcome::{CommandResult, Failure, reason};
use std::fs::File;
use std::io::{self, Stdout, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use termtrace::internals::output_file::{OutputFile, open_stream};
use termtrace::internals::terminal::before_death;

/// The file being written, shared with the signal thread. The lock covers every begin, write,
/// finish and removal, so that a signal meets a consistent state. Streams are not in it: a write to a full pipe blocks,
/// and with the lock held the signal thread would wait for it.
type PartialFile = Mutex<Option<OutputFile>>;

/// Writes a file as a whole or not at all.
pub(super) fn write(path: &Path, bytes: &[u8]) -> CommandResult {
    let mut outputs = Outputs::default();
    outputs.remove_on_signals(|| ());
    outputs.write(path, bytes).map_err(|error| Failure::runtime(path.display(), reason(&error)))
}

/// The files of a command, written one after the other.
#[derive(Default)]
pub(super) struct Outputs {
    unfinished: Arc<PartialFile>,
    /// Whether leftovers of killed runs were removed: once is enough for the thousands of files of
    /// a film.
    has_cleaned: bool,
}

impl Outputs {
    /// Has a deadly signal remove the unfinished file and call `last_act` before the program dies.
    pub(super) fn remove_on_signals(&self, last_act: impl FnOnce() + Send + 'static) {
        let unfinished = Arc::downgrade(&self.unfinished);
        // If signals cannot be caught, the next run removes the file: not a reason to fail.
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
    /// Finishes the output; only now a file gets its name.
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
            // Without a file a signal has removed it: the bytes are dropped until the program dies.
            Self::File(unfinished) => locked(unfinished).as_mut().map_or(Ok(bytes.len()), |file| file.write(bytes)),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout(stdout) => stdout.flush(),
            // Neither has a buffer of its own.
            Self::Stream(_) | Self::File(_) => Ok(()),
        }
    }
}

fn locked(unfinished: &PartialFile) -> MutexGuard<'_, Option<OutputFile>> {
    // A panic in another thread must not keep the file from being removed.
    unfinished.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the unfinished file and keeps the lock for ever, so that no other file is created before
/// the program dies.
fn abandon(unfinished: &Weak<PartialFile>) {
    // A weak reference: outputs that are dropped have no file to remove.
    if let Some(unfinished) = unfinished.upgrade() {
        let mut file = locked(&unfinished);
        file.take();
        std::mem::forget(file);
    }
}
