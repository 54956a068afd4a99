//! Progress reports of a parser.

use super::{Cancelled, Progress, Reporter, Work};

/// A parser's position in its file, reported to a [`Reporter`] every [`REPORT_STRIDE`] bytes.
pub(crate) struct Meter<'a> {
    reporter: &'a Reporter<'a>,
    name: &'a str,
    /// The size of the file in bytes.
    total: usize,
    /// The position in bytes at which the next report is due.
    next: usize,
}

/// The number of bytes that a parser reads between two progress reports.
// 256 KiB take one or two milliseconds to parse: a cancel takes effect within a frame, and reports cost hardly any
// time.
const REPORT_STRIDE: usize = 256 << 10;

impl<'a> Meter<'a> {
    /// Returns a meter at the start of the file `name` of `total` bytes.
    pub(crate) fn new(reporter: &'a Reporter<'a>, name: &'a str, total: usize) -> Self {
        Self { reporter, name, total, next: 0 }
    }

    /// Moves the parser's position to byte `position`, and reports it if a report is due.
    ///
    /// # Errors
    /// [`Cancelled`], if the work is cancelled.
    #[inline]
    pub(crate) fn advance_to(&mut self, position: usize) -> Result<(), Cancelled> {
        if position < self.next { Ok(()) } else { self.report(position, self.total) }
    }

    /// Returns the size in bytes of the pieces in which the file is parsed.
    #[cfg(feature = "mesh")]
    pub(crate) fn piece_bytes(&self) -> usize {
        self.reporter.piece_bytes()
    }

    /// Returns whether the file may be parsed on all threads of the current rayon pool.
    #[cfg(feature = "mesh")]
    pub(crate) fn is_parallel(&self) -> bool {
        self.reporter.is_parallel()
    }

    /// Moves the parser's position to byte `position`, and reports it.
    ///
    /// # Errors
    /// [`Cancelled`], if the work is cancelled.
    #[cfg(feature = "mesh")]
    pub(crate) fn report_at(&mut self, position: usize) -> Result<(), Cancelled> {
        self.report(position, self.total)
    }

    /// Reports progress without a position, for a parser that reads its file in any order.
    ///
    /// # Errors
    /// [`Cancelled`], if the work is cancelled.
    #[cfg(feature = "mesh")]
    pub(crate) fn report_indeterminate(&mut self) -> Result<(), Cancelled> {
        self.report(0, 0)
    }

    // Cold, so that only the comparison in `advance_to` is inlined into the parser's loop.
    #[cold]
    fn report(&mut self, done: usize, total: usize) -> Result<(), Cancelled> {
        self.next = done + REPORT_STRIDE;
        let work = Work::Parsing(self.name.to_owned());
        self.reporter.report(Progress { work, done, total })
    }
}
