//! Progress of a parser.

use super::{Cancelled, Progress, Watcher, Work};

/// A parser's position in its file, reported to a [`Watcher`] every [`STRIDE`] bytes.
pub(crate) struct Meter<'a> {
    watcher: &'a Watcher<'a>,
    name: &'a str,
    /// The size of the file in bytes.
    total: usize,
    /// The next position to report.
    next: usize,
}

/// Bytes between two reports: one or two milliseconds of parsing.
const STRIDE: usize = 256 << 10;

impl<'a> Meter<'a> {
    /// Returns a meter at the start of a file called `name` with `total` bytes.
    pub(crate) fn new(watcher: &'a Watcher<'a>, name: &'a str, total: usize) -> Self {
        Self { watcher, name, total, next: 0 }
    }

    /// Reports that the parser has reached byte `at`, if a report is due.
    ///
    /// # Errors
    /// If the work is cancelled.
    #[inline]
    pub(crate) fn reach(&mut self, at: usize) -> Result<(), Cancelled> {
        if at < self.next { Ok(()) } else { self.tell(at, self.total) }
    }

    /// Reports progress without a position, for a parser that does not read its file from front to back.
    ///
    /// # Errors
    /// If the work is cancelled.
    #[cfg(feature = "mesh")]
    pub(crate) fn step(&mut self) -> Result<(), Cancelled> {
        self.tell(0, 0)
    }

    #[cold]
    fn tell(&mut self, done: usize, total: usize) -> Result<(), Cancelled> {
        self.next = done + STRIDE;
        let work = Work::Parsing(self.name.to_owned());
        self.watcher.tell(Progress { work, done, total })
    }
}
