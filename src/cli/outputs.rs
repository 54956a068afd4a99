//! The files that a command writes. A signal that ends the program removes the one that is not finished.

use super::outcome::{CommandResult, Failure, reason};
use std::fs::File;
use std::io::{self, Stdout, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use termtrace::internals::output_file::{OutputFile, open_stream};
use termtrace::internals::terminal::before_death;

/// The file that is being written, shared with the thread that hears of signals. Whoever has locked it keeps the other
/// from beginning, writing, finishing or removing it; streams, which may block, are not in it.
type PartialFile = Mutex<Option<OutputFile>>;

/// Writes a whole file, or nothing.
pub(super) fn write(path: &Path, bytes: &[u8]) -> CommandResult {
    let mut outputs = Outputs::default();
    outputs.remove_on_signals(|| ());
    outputs.write(path, bytes).map_err(|error| Failure::runtime(path.display(), reason(&error)))
}

/// The files of a command, one after the other.
#[derive(Default)]
pub(super) struct Outputs {
    unfinished: Arc<PartialFile>,
    /// Whether leftovers were looked for: once is enough for the thousands of files of a film.
    has_cleaned: bool,
}

impl Outputs {
    /// From now on a signal that ends the program removes the unfinished file, and does something else, first. Where
    /// signals cannot be caught, the next run removes it: no reason to give up.
    pub(super) fn remove_on_signals(&self, last_act: impl FnOnce() + Send + 'static) {
        let unfinished = Arc::downgrade(&self.unfinished);
        let _ = before_death(move || {
            abandon(&unfinished);
            last_act();
        });
    }

    /// Begins a file, or opens a device or pipe.
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

/// What a command writes to.
pub(super) enum Output {
    Stdout(Stdout),
    /// A device or a pipe: what is written is gone.
    Stream(File),
    File(Arc<PartialFile>),
}

impl Output {
    /// All is written: a file gets its name.
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
            Self::File(unfinished) => locked(unfinished).as_mut().map_or(Ok(bytes.len()), |file| file.write(bytes)),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout(stdout) => stdout.flush(),
            Self::Stream(_) | Self::File(_) => Ok(()),
        }
    }
}

fn locked(unfinished: &PartialFile) -> MutexGuard<'_, Option<OutputFile>> {
    unfinished.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the unfinished file. It stays locked: nothing is begun any more.
fn abandon(unfinished: &Weak<PartialFile>) {
    if let Some(unfinished) = unfinished.upgrade() {
        let mut file = locked(&unfinished);
        file.take();
        std::mem::forget(file);
    }
}
