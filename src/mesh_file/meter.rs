//! How far a reader has come in its file.

use super::error::Fault;
use crate::progress::{Progress, Watcher, Work};

/// Tells who waits for the mesh how many of its file's bytes are read, every now and then.
pub(super) struct Meter<'a> {
    watcher: &'a Watcher<'a>,
    name: &'a str,
    total: usize,
    /// From this place on he is to be told.
    next: usize,
}

/// How many bytes are read from one report to the next: a millisecond's or two.
const STRIDE: usize = 256 << 10;

impl<'a> Meter<'a> {
    /// Of the file of that name, with so many bytes.
    pub(super) fn new(watcher: &'a Watcher<'a>, name: &'a str, total: usize) -> Self {
        Self { watcher, name, total, next: 0 }
    }

    /// The reader is at this byte. A fault if nobody waits any more: no matter which, as nobody will hear of it.
    #[inline]
    pub(super) fn reach(&mut self, at: usize) -> Result<(), Fault> {
        if at < self.next { Ok(()) } else { self.tell(at, self.total) }
    }

    /// The same of a reader that does not go from the beginning of its file to the end: it has come farther, and nobody
    /// knows how far.
    pub(super) fn step(&mut self) -> Result<(), Fault> {
        self.tell(0, 0)
    }

    #[cold]
    fn tell(&mut self, done: usize, total: usize) -> Result<(), Fault> {
        self.next = done + STRIDE;
        let work = Work::Parsing(self.name.to_owned());
        let told = self.watcher.tell(Progress { work, done, total });
        if told.is_break() { Err(Fault::of_file("nobody waits for this mesh any more")) } else { Ok(()) }
    }
}
