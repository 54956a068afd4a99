//! Progress of a parser.

use super::{Cancelled, Progress, Watcher, Work};

/// A parser's position in its file, reported to a [`Watcher`] every [`STRIDE`] bytes.
pub(crate) struct Meter<'a> {
    watcher: &'a Watcher<'a>,
    name: &'a str,
    /// The file's length in bytes.
    total: usize,
    /// The first position that is to be reported.
    next: usize,
}

/// How many bytes lie between two reports: one or two milliseconds of parsing.
const STRIDE: usize = 256 << 10;

impl<'a> Meter<'a> {
    /// A meter at the start of the file `name`, which has `total` bytes.
    pub(crate) fn new(watcher: &'a Watcher<'a>, name: &'a str, total: usize) -> Self {
        Self { watcher, name, total, next: 0 }
    }

    /// Notes that the parser is at byte `at`.
    ///
    /// # Errors
    /// If the file is no longer wanted.
    #[inline]
    pub(crate) fn reach(&mut self, at: usize) -> Result<(), Cancelled> {
        if at < self.next { Ok(()) } else { self.tell(at, self.total) }
    }

    /// Notes progress of a parser that does not read its file from front to back: the report has no position.
    ///
    /// # Errors
    /// If the file is no longer wanted.
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
