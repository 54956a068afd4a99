//! A recording of the live session: the bytes of its frames with their times, as an asciicast.
//!
//! Queries and modes are not recorded: the terminal of a player would reply to the queries, and stay in the modes.

use super::picture_export;
use crate::grid::Size;
use crate::output_file::OutputFile;
use crate::record::{write_event, write_header};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Hides the cursor and clears the screen at the start of a recording.
const BEGIN: &str = "\x1b[?25l\x1b[m\x1b[2J";
/// Resets the colours and shows the cursor at the end of a recording.
const END: &str = "\x1b[m\x1b[?25h";

/// A recording in progress. Dropping it finishes the file, so that it is valid after a signal too.
pub(super) struct SessionRecording {
    /// The temporary file; `None` once the recording has ended or an error has occurred.
    file: Option<BufWriter<OutputFile>>,
    folder: PathBuf,
    /// The stem of the finished file's name.
    stem: String,
    start: Duration,
    /// The time of the last event, on the loop's clock.
    now: Duration,
    size: Size,
}

impl SessionRecording {
    /// Starts a recording of a terminal of this size, under a temporary name in the folder.
    pub(super) fn start(folder: &Path, stem: &str, size: Size, now: Duration) -> io::Result<Self> {
        let file = OutputFile::create_in(folder)?;
        file.remove_stale();
        // Events are written as they occur, through a small buffer, so that memory does not grow with the length of the
        // session.
        let mut file = BufWriter::new(file);
        write_header(&mut file, size)?;
        write_event(&mut file, 0.0, "o", BEGIN)?;
        let (folder, stem) = (folder.to_owned(), stem.to_owned());
        Ok(Self { file: Some(file), folder, stem, start: now, now, size })
    }

    /// Adds the bytes of a frame on a screen of this size.
    ///
    /// # Errors
    /// If writing fails; the recording then ends and leaves no file.
    pub(super) fn add(&mut self, bytes: &[u8], size: Size, now: Duration) -> io::Result<()> {
        self.now = now;
        if size != self.size {
            self.size = size;
            self.write("r", &format!("{}x{}", size.columns, size.rows))?;
        }
        if bytes.is_empty() { Ok(()) } else { self.write("o", &String::from_utf8_lossy(bytes)) }
    }

    /// Leaves out the time from `from` to `to`, in which another program had the terminal.
    pub(super) fn skip(&mut self, from: Duration, to: Duration) {
        self.start += to.saturating_sub(from);
    }

    /// Finishes the file, and returns its name.
    ///
    /// # Errors
    /// If writing fails; no file is left then.
    pub(super) fn finish(&mut self, now: Duration) -> io::Result<String> {
        self.now = now;
        self.write("o", END)?;
        let Some(file) = self.file.take() else { return Err(io::Error::other("the recording has ended")) };
        picture_export::finish_new(file.into_inner()?, &self.folder, &self.stem, "cast")
    }

    fn write(&mut self, kind: &str, text: &str) -> io::Result<()> {
        let seconds = self.now.saturating_sub(self.start).as_secs_f64();
        let Some(file) = &mut self.file else { return Ok(()) };
        let written = write_event(file, seconds, kind, text);
        if written.is_err() {
            // `into_parts`, because a dropped `BufWriter` would try again to write its contents.
            self.file.take().map(BufWriter::into_parts);
        }
        written
    }
}

impl Drop for SessionRecording {
    fn drop(&mut self) {
        if self.file.is_some() {
            // An error is ignored: the live view is ending and can no longer show a message.
            let _ = self.finish(self.now);
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
