//! Progress reports on work that takes a while, and the token by which it is cancelled.

#[cfg(feature = "ron")]
mod meter;

#[cfg(feature = "ron")]
pub(crate) use meter::Meter;

use crate::text::Notice;
use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is being done, and how much of it is done.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Progress {
    /// What is being done.
    pub work: Work,
    /// How much of it is done: bytes of a file, boxes of a tree.
    pub done: usize,
    /// How much there is to do; 0 where that is not known.
    pub total: usize,
}

/// What takes time on the way from a file to a scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Work {
    /// The file of that name comes from the disk.
    Reading(String),
    /// The bytes of the file of that name become triangles.
    Parsing(String),
    /// A tree is built over all that is in the scene.
    Building,
}

/// A receiver of progress reports, which come now and then and from any thread, and by which the work can be cancelled.
pub struct Watcher<'w> {
    hear: &'w (dyn Fn(Progress) -> ControlFlow<()> + Sync),
    hear_need: Option<&'w (dyn Fn(&Path) + Sync)>,
    cancellation: Cancellation,
}

impl<'w> Watcher<'w> {
    /// Reports progress to this function, and cancels the work when it answers `Break`.
    pub fn new(hear: &'w (dyn Fn(Progress) -> ControlFlow<()> + Sync)) -> Self {
        Self { hear, hear_need: None, cancellation: Cancellation::default() }
    }

    /// Reports each file to that function, too, before it is opened.
    pub fn with_needs(self, hear_need: &'w (dyn Fn(&Path) + Sync)) -> Self {
        Self { hear_need: Some(hear_need), ..self }
    }

    /// Cancels the work also when this token is cancelled.
    pub fn cancelled_by(self, cancellation: &Cancellation) -> Self {
        Self { cancellation: cancellation.clone(), ..self }
    }

    /// A watcher that hears nothing and cancels nothing.
    pub fn patient() -> Watcher<'static> {
        Watcher::new(&|_| ControlFlow::Continue(()))
    }

    /// Reports progress.
    ///
    /// # Errors
    /// [`Cancelled`], if the work is to be given up.
    pub fn tell(&self, progress: Progress) -> Result<(), Cancelled> {
        if (self.hear)(progress).is_break() {
            self.cancellation.cancel();
        }
        if self.is_gone() { Err(Cancelled) } else { Ok(()) }
    }

    /// Reports a file that the work needs, which may not be there.
    pub fn needs(&self, file: &Path) {
        if let Some(hear) = self.hear_need {
            hear(file);
        }
    }

    /// Returns whether the work is to be given up.
    pub fn is_gone(&self) -> bool {
        self.cancellation.is_cancelled()
    }
}

/// A token shared by whoever waits for work and whoever does it. All clones are one token; once cancelled, it stays so.
#[derive(Clone, Debug, Default)]
pub struct Cancellation(Arc<AtomicBool>);

impl Cancellation {
    /// Asks for the work to be given up at its next check.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether the work is to be given up.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The error of work that was given up because its token was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the work was cancelled")
    }
}

impl std::error::Error for Cancelled {}

/// Why work that may be cancelled, and may fail, has no result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unfinished<E> {
    /// It was given up because its token was cancelled.
    Cancelled,
    /// It failed.
    Failed(E),
}

impl<E> Unfinished<E> {
    /// Converts the failure, if it is one.
    #[doc(hidden)]
    pub fn map<F>(self, convert: impl FnOnce(E) -> F) -> Unfinished<F> {
        match self {
            Self::Cancelled => Unfinished::Cancelled,
            Self::Failed(error) => Unfinished::Failed(convert(error)),
        }
    }

    /// Returns the failure of work that nothing could cancel.
    ///
    /// # Panics
    /// If it was cancelled.
    #[cfg(feature = "ron")]
    pub(crate) fn failure(self) -> E {
        match self {
            Self::Cancelled => panic!("work was cancelled that has no token"),
            Self::Failed(error) => error,
        }
    }
}

impl<E: Into<Notice>> From<Unfinished<E>> for Notice {
    fn from(unfinished: Unfinished<E>) -> Self {
        match unfinished {
            Unfinished::Cancelled => Cancelled.to_string().into(),
            Unfinished::Failed(error) => error.into(),
        }
    }
}

impl<E> From<Cancelled> for Unfinished<E> {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl<E: fmt::Display> fmt::Display for Unfinished<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cancelled => Cancelled.fmt(f),
            Self::Failed(error) => error.fmt(f),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> std::error::Error for Unfinished<E> {}
