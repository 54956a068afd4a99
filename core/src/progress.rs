//! Progress reports of long operations, and the token that cancels them.

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

/// A progress report from loading a scene.
///
/// ```
/// use std::ops::ControlFlow;
/// use termtrace::{Scene, Work};
///
/// let path = std::env::temp_dir().join("termtrace-progress.ron");
/// std::fs::write(&path, "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))")?;
/// let scene = Scene::load_watched(&path, |progress| {
///     if let Work::Reading(name) = progress.work {
///         eprintln!("{name}: {} of {} bytes", progress.done, progress.total);
///     }
///     ControlFlow::Continue(())
/// })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Progress {
    /// The operation in progress.
    pub work: Work,
    /// The amount done: bytes of a file, or primitives sorted into the trees of the scene.
    pub done: usize,
    /// The amount to be done in total, in the same unit; 0 if unknown.
    pub total: usize,
}

/// A stage of loading a scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Work {
    /// Reading the file with this name from disk.
    Reading(String),
    /// Parsing the bytes of the file with this name.
    Parsing(String),
    /// Building the bounding volume hierarchies of the scene.
    Building,
}

impl Progress {
    /// Returns the progress of a stage.
    #[doc(hidden)]
    pub fn new(work: Work, done: usize, total: usize) -> Self {
        Self { work, done, total }
    }
}

impl Work {
    /// Returns the verb of the stage, and the name of its file, if it is about a file.
    #[doc(hidden)]
    pub fn verb_and_file(&self) -> (&'static str, Option<&str>) {
        match self {
            Self::Reading(name) => ("reading", Some(name)),
            Self::Parsing(name) => ("parsing", Some(name)),
            Self::Building => ("building", None),
        }
    }
}

/// A reporter of progress to a callback, which can cancel the work.
///
/// Reports may come from any thread.
pub struct Reporter<'w> {
    on_progress: &'w (dyn Fn(Progress) -> ControlFlow<()> + Sync),
    on_dependency: Option<&'w (dyn Fn(&Path) + Sync)>,
    on_warning: Option<&'w (dyn Fn(String) + Sync)>,
    is_strict: bool,
    is_parallel: bool,
    piece_bytes: usize,
    cancellation: Cancellation,
}

/// The size of the pieces in which large files are parsed, in bytes.
// A little less than 256 KiB, which take one or two milliseconds: a cancel takes effect within a frame, and a piece
// costs little besides.
const PIECE_BYTES: usize = 252 << 10;

impl<'w> Reporter<'w> {
    /// Returns a reporter that calls `on_progress`, which cancels the work by returning `Break`.
    pub fn new(on_progress: &'w (dyn Fn(Progress) -> ControlFlow<()> + Sync)) -> Self {
        Self {
            on_progress,
            on_dependency: None,
            on_warning: None,
            is_strict: false,
            is_parallel: true,
            piece_bytes: PIECE_BYTES,
            cancellation: Cancellation::default(),
        }
    }

    /// Returns the reporter with a callback that gets the path of each file before the file is
    /// opened.
    // The callback also gets files that turn out to be missing, so that a live view notices when they are created.
    pub fn with_dependencies(self, on_dependency: &'w (dyn Fn(&Path) + Sync)) -> Self {
        Self { on_dependency: Some(on_dependency), ..self }
    }

    /// Returns the reporter with a callback for warnings: faults of files despite which the scene
    /// can be shown, each as one line.
    ///
    /// Without a callback these faults are errors.
    pub fn with_warnings(self, on_warning: &'w (dyn Fn(String) + Sync)) -> Self {
        Self { on_warning: Some(on_warning), ..self }
    }

    /// Returns the reporter with warnings turned into errors. Notices stay notices.
    pub fn strict(&self) -> Self {
        Self { is_strict: true, cancellation: self.cancellation.clone(), ..*self }
    }

    /// Returns the reporter for reading on the calling thread only, and not on the threads of the
    /// current rayon pool.
    ///
    /// Trees are built in the pool nevertheless.
    pub fn on_this_thread(&self) -> Self {
        Self { is_parallel: false, cancellation: self.cancellation.clone(), ..*self }
    }

    /// Returns whether files may be parsed on all threads of the current rayon pool.
    pub fn is_parallel(&self) -> bool {
        self.is_parallel
    }

    /// Returns the reporter for parsing files in pieces of about this size, for tests.
    pub fn in_pieces_of(self, bytes: usize) -> Self {
        Self { piece_bytes: bytes, ..self }
    }

    /// Returns the size in bytes of the pieces in which files are parsed.
    pub fn piece_bytes(&self) -> usize {
        self.piece_bytes
    }

    /// Returns the reporter with a token that cancels the work.
    pub fn cancelled_by(self, cancellation: &Cancellation) -> Self {
        Self { cancellation: cancellation.clone(), ..self }
    }

    /// Returns a reporter that drops all reports and never cancels.
    pub fn silent() -> Reporter<'static> {
        Reporter::new(&|_| ControlFlow::Continue(()))
    }

    /// Reports progress.
    ///
    /// # Errors
    /// [`Cancelled`], if the work is cancelled.
    pub fn report(&self, progress: Progress) -> Result<(), Cancelled> {
        if (self.on_progress)(progress).is_break() {
            // The token also ends the work of threads that do not report.
            self.cancellation.cancel();
        }
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Reports a file on which the result depends, and which may be missing.
    pub fn report_dependency(&self, file: &Path) {
        if let Some(on_dependency) = self.on_dependency {
            on_dependency(file);
        }
    }

    /// Reports a warning. Returns false if there is no callback or warnings are errors, so that the
    /// caller returns an error.
    pub fn warn_instead_of_error(&self, warning: impl FnOnce() -> String) -> bool {
        !self.is_strict && self.notify_if_possible(warning)
    }

    /// Reports a notice to the callback for warnings, and returns false if there is no callback.
    ///
    /// A notice is one line about contents of a file that are not shown.
    pub fn notify_if_possible(&self, notice: impl FnOnce() -> String) -> bool {
        if let Some(on_warning) = self.on_warning {
            on_warning(notice());
        }
        self.takes_notices()
    }

    /// Returns whether there is a callback for warnings and notices.
    pub fn takes_notices(&self) -> bool {
        self.on_warning.is_some()
    }

    /// Returns whether the work has been cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancellation.is_cancelled()
    }
}

/// A cancellation token, shared by all its clones. Once cancelled, it stays cancelled.
// Relaxed ordering is enough, as the flag guards no other data, and a thread that sees it late only does more work.
#[derive(Clone, Debug, Default)]
pub struct Cancellation(Arc<AtomicBool>);

impl Cancellation {
    /// Cancels the work, which ends at its next check.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether the work is cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The error of a cancelled operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the work was cancelled")
    }
}

impl std::error::Error for Cancelled {}

/// The error of an operation that can fail or be cancelled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unfinished<E> {
    /// The work was cancelled.
    Cancelled,
    /// The work failed.
    Failed(E),
}

impl<E> Unfinished<E> {
    /// Converts the error in [`Failed`](Self::Failed), and keeps [`Cancelled`](Self::Cancelled).
    #[doc(hidden)]
    pub fn map<F>(self, convert: impl FnOnce(E) -> F) -> Unfinished<F> {
        match self {
            Self::Cancelled => Unfinished::Cancelled,
            Self::Failed(error) => Unfinished::Failed(convert(error)),
        }
    }

    /// Returns the error of an operation that could not be cancelled.
    ///
    /// # Panics
    /// If the operation was cancelled.
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
