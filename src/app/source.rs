//! A source of a scene: its name, and the function that reads it.

use crate::mesh_file::{self, UpAxis};
use crate::progress::{Cancelled, Reporter, Unfinished};
use crate::scene::{Draft, LoadError};
use crate::text::visible;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{fmt, io};

/// A scene that can be read repeatedly.
///
/// A scene is read when it is first shown, when the user returns to it, and when one of its files has changed.
pub struct Source<E = LoadError> {
    named: SceneName,
    /// The axis of a mesh that points up, if the user has chosen one.
    up: Option<UpAxis>,
    // In an `Arc`, because the loading thread may use it for longer than `self` lives.
    read: Arc<Read<E>>,
}

/// The facts about a scene that are known without reading it.
#[derive(Clone, Debug)]
pub(super) struct SceneName {
    /// The name shown to the user.
    pub(super) name: String,
    /// The scene file, into which views can be saved.
    pub(super) file: Option<PathBuf>,
    /// Whether the live view starts in orbit mode.
    pub(super) orbited: bool,
}

impl SceneName {
    /// Returns the last component of the name, without control characters.
    pub(super) fn short(&self) -> String {
        let name = self.name.rsplit('/').find(|part| !part.is_empty());
        visible(name.unwrap_or_default())
    }
}

type Read<E> = dyn Fn(&Reporter<'_>, Option<UpAxis>) -> Result<Draft, E> + Send + Sync;

impl Source {
    /// Returns the source of the scene or mesh in the file at `path`. A mesh starts in orbit mode.
    pub fn of_file(path: &Path) -> Self {
        let (name, file) = (path.to_string_lossy().into_owned(), path.to_owned());
        let is_mesh = mesh_file::is_mesh(&name, &[]);
        let source = Self::turnable(name, move |reporter, up| load_draft(&file, up, reporter));
        let source = source.with_file(path.to_owned());
        // A mesh is a single object, which users want to see from all sides.
        if is_mesh { source.orbited() } else { source }
    }
}

fn load_draft(path: &Path, up: Option<UpAxis>, reporter: &Reporter<'_>) -> Result<Draft, LoadError> {
    Draft::load_turned(path, up, reporter).map_err(|unfinished| match unfinished {
        Unfinished::Failed(error) => error,
        // The error of a cancellation is never shown, because the result of a cancelled load is dropped.
        Unfinished::Cancelled => LoadError::CannotRead { path: path.to_owned(), error: io::Error::other(Cancelled) },
    })
}

impl<E> Source<E> {
    /// Returns a source that calls `read`, with the name shown to the user.
    ///
    /// `read` should return soon after its reporter [is cancelled](Reporter::is_cancelled), with any result, because
    /// one scene is read at a time. It may block for ever only after reporting a pipe as a
    /// [dependency](Reporter::report_dependency). The files that it reports are watched, and the scene is read again
    /// when one changes.
    #[doc(hidden)]
    pub fn new(
        name: impl Into<String>,
        read: impl Fn(&Reporter<'_>) -> Result<Draft, E> + Send + Sync + 'static,
    ) -> Self {
        Self::turnable(name, move |reporter, _| read(reporter))
    }

    /// Returns a source whose `read` also gets the axis of a mesh file that is to point up.
    ///
    /// The axis is `None` until the user chooses one. Otherwise the same as [`Source::new`].
    #[doc(hidden)]
    pub fn turnable(
        name: impl Into<String>,
        read: impl Fn(&Reporter<'_>, Option<UpAxis>) -> Result<Draft, E> + Send + Sync + 'static,
    ) -> Self {
        let named = SceneName { name: name.into(), file: None, orbited: false };
        Self { named, up: None, read: Arc::new(read) }
    }

    /// Makes later readings of a mesh file turn it so that the next axis points up.
    ///
    /// This is the axis after the one that the user chose last, or after `shown` if the user has chosen none.
    pub(super) fn turn_next_axis_up(&mut self, shown: UpAxis) {
        // The axis after the shown one would be wrong if the user presses the key again before the turned mesh is
        // shown.
        self.up = Some(self.up.unwrap_or(shown).next());
    }

    /// Sets the scene file, into which views can be saved.
    #[doc(hidden)]
    pub fn with_file(self, file: PathBuf) -> Self {
        Self { named: SceneName { file: Some(file), ..self.named }, ..self }
    }

    /// Starts the live view in orbit mode instead of flight, as suits a single object.
    #[doc(hidden)]
    pub fn orbited(self) -> Self {
        Self { named: SceneName { orbited: true, ..self.named }, ..self }
    }

    pub(super) fn scene_name(&self) -> &SceneName {
        &self.named
    }

    /// Returns whether the scene's file is an STL file that is parsed on several threads.
    // Other files are parsed on one thread wherever they are read. In the pool they would only leave memory to more
    // threads.
    pub(super) fn is_large(&self) -> bool {
        /// The least size of such a file in bytes: 4 MiB, which take about 10 ms on one thread.
        const MIN_SIZE: u64 = 4 << 20;
        let is_stl = |file: &&PathBuf| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("stl"));
        let file = self.named.file.as_ref().filter(is_stl).and_then(|file| file.metadata().ok());
        file.is_some_and(|file| file.len() >= MIN_SIZE)
    }

    /// Reads the scene.
    ///
    /// # Errors
    /// The error of `read`.
    #[doc(hidden)]
    pub fn read(&self, reporter: &Reporter<'_>) -> Result<Draft, E> {
        (self.read)(reporter, self.up)
    }
}

impl<E> Clone for Source<E> {
    fn clone(&self) -> Self {
        Self { named: self.named.clone(), up: self.up, read: Arc::clone(&self.read) }
    }
}

impl<E> fmt::Debug for Source<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Source").field("named", &self.named).finish_non_exhaustive()
    }
}
