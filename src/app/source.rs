//! Where a scene comes from.

use crate::mesh_file;
use crate::progress::{Cancelled, Unfinished, Watcher};
use crate::scene::{Draft, LoadError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{fmt, io};

/// A scene that can be read as often as it is wanted: at the start, when it is come back to, and when one of its files
/// has changed. See [`open`](super::open).
pub struct Source<E = LoadError> {
    named: Named,
    read: Arc<Read<E>>,
}

/// What is known of a scene without reading it.
#[derive(Clone, Debug)]
pub(super) struct Named {
    /// A person knows it by that.
    pub(super) name: String,
    /// The scene file that it stands in.
    pub(super) file: Option<PathBuf>,
    /// Whether the eye goes around it at first.
    pub(super) orbited: bool,
}

type Read<E> = dyn Fn(&Watcher<'_>) -> Result<Draft, E> + Send + Sync;

impl Source {
    /// Returns the scene or mesh in that file. The eye goes around a mesh at first.
    pub fn of_file(path: &Path) -> Self {
        let (name, file) = (path.to_string_lossy().into_owned(), path.to_owned());
        let is_mesh = mesh_file::is_mesh(&name, &[]);
        let source = Self::new(name, move |watcher| draft(&file, watcher));
        let source = source.with_file(path.to_owned());
        if is_mesh { source.orbited() } else { source }
    }
}

fn draft(path: &Path, watcher: &Watcher<'_>) -> Result<Draft, LoadError> {
    Draft::load(path, watcher).map_err(|unfinished| match unfinished {
        Unfinished::Failed(error) => error,
        Unfinished::Cancelled => LoadError::CannotRead { path: path.to_owned(), error: io::Error::other(Cancelled) },
    })
}

impl<E> Source<E> {
    /// The scene that `read` gives, under a name that a person knows it by. `read` should return soon after its watcher has
    /// [gone](Watcher::is_gone), with whatever result, because one scene is read at a time, and the next one waits for it;
    /// only a `read` that has told its watcher of a pipe may wait for ever. What it tells its watcher to
    /// [need](Watcher::needs) is watched: as files change, the scene is read again.
    #[doc(hidden)]
    pub fn new(
        name: impl Into<String>,
        read: impl Fn(&Watcher<'_>) -> Result<Draft, E> + Send + Sync + 'static,
    ) -> Self {
        Self { named: Named { name: name.into(), file: None, orbited: false }, read: Arc::new(read) }
    }

    /// It stands in that scene file, into which views may be written.
    #[doc(hidden)]
    pub fn with_file(self, file: PathBuf) -> Self {
        Self { named: Named { file: Some(file), ..self.named }, ..self }
    }

    /// The eye goes around it at first, and does not fly: good for a thing by itself.
    #[doc(hidden)]
    pub fn orbited(self) -> Self {
        Self { named: Named { orbited: true, ..self.named }, ..self }
    }

    pub(super) fn named(&self) -> &Named {
        &self.named
    }

    /// Reads it.
    ///
    /// # Errors
    /// What is wrong with the scene.
    #[doc(hidden)]
    pub fn read(&self, watcher: &Watcher<'_>) -> Result<Draft, E> {
        (self.read)(watcher)
    }
}

impl<E> Clone for Source<E> {
    fn clone(&self) -> Self {
        Self { named: self.named.clone(), read: Arc::clone(&self.read) }
    }
}

impl<E> fmt::Debug for Source<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Source").field("named", &self.named).finish_non_exhaustive()
    }
}
