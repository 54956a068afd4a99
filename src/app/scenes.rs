//! The list of scenes: the current one, its load, and when it is read again.

use super::loading::{LoadEvent, Loader, Loading, PROGRESS_DELAY};
use super::source::{SceneName, Source};
use super::watching::{Dependency, Watching};
use crate::scene::Scene;
use crate::terminal::{Signals, Waker};
use std::io;

/// The scenes that the user can switch between.
pub(super) struct Scenes<E> {
    /// Empty for a scene that was passed as a value.
    sources: Vec<Source<E>>,
    /// Index of the current scene.
    wanted: usize,
    /// `None` for a scene that was passed as a value.
    loader: Option<Loader<E>>,
    loading: Loading<E>,
    waker: Waker,
    /// `None` before the first watch, and if the system does not support it.
    watching: Option<Watching>,
    /// The files of the current scene that are not watched yet.
    unwatched: Option<Vec<Dependency>>,
    /// The reason why changes are not noticed, as last reported to the user.
    reported_problem: Option<String>,
}

/// An event of the current scene's load.
pub(super) struct SceneEvent<E> {
    /// Index of the scene.
    pub(super) of: usize,
    pub(super) event: LoadEvent<E>,
    /// Whether the load has taken longer than [`PROGRESS_DELAY`].
    pub(super) is_slow: bool,
}

impl<E: Send + 'static> Scenes<E> {
    /// Returns a list of one loaded scene.
    pub(super) fn of_scene(scene: Scene, signals: &Signals) -> io::Result<Self> {
        Self::new(Vec::new(), None, Loading::finished(scene), signals)
    }

    /// Starts to load the first scene.
    pub(super) fn start(sources: Vec<Source<E>>, threads: Option<usize>, signals: &Signals) -> io::Result<Self> {
        let first = sources.first().cloned().ok_or_else(|| io::Error::other("there is no scene to look at"))?;
        let loader = Loader::start(threads, signals.waker()?)?;
        let loading = loader.load(first)?;
        Self::new(sources, Some(loader), loading, signals)
    }

    fn new(
        sources: Vec<Source<E>>,
        loader: Option<Loader<E>>,
        loading: Loading<E>,
        signals: &Signals,
    ) -> io::Result<Self> {
        let waker = signals.waker()?;
        Ok(Self { sources, wanted: 0, loader, loading, waker, watching: None, unwatched: None, reported_problem: None })
    }

    /// Waits for the first scene, for at most [`PROGRESS_DELAY`].
    ///
    /// # Errors
    /// The error of loading it.
    pub(super) fn wait(&mut self) -> Result<(), E> {
        self.loading.wait(PROGRESS_DELAY)
    }

    /// Returns the next event of the load, if one has arrived.
    ///
    /// Starts to read the scene again if a file has changed.
    pub(super) fn next(&mut self) -> io::Result<Option<SceneEvent<E>>> {
        if self.watching.as_mut().is_some_and(Watching::take_changed) {
            self.read_again()?;
        }
        while let Some(event) = self.loading.next() {
            match event {
                LoadEvent::Dependencies(files) => self.unwatched = Some(files),
                event => return Ok(Some(SceneEvent { of: self.wanted, event, is_slow: self.loading.is_slow() })),
            }
        }
        Ok(None)
    }

    /// Returns the names of the scenes.
    pub(super) fn names(&self) -> Vec<SceneName> {
        self.sources.iter().map(|source| source.named().clone()).collect()
    }

    /// Switches to the scene `steps` further on, in a cycle. Does nothing if there is only one.
    pub(super) fn switch(&mut self, steps: isize) -> io::Result<()> {
        // The only scene would merely be loaded again.
        if self.sources.len() < 2 {
            return Ok(());
        }
        let count = self.sources.len();
        self.wanted = (self.wanted + steps.rem_euclid(count.cast_signed()).cast_unsigned()) % count;
        self.read_again()
    }

    /// Cancels the load in progress and starts one of the current scene.
    fn read_again(&mut self) -> io::Result<()> {
        if let (Some(source), Some(loader)) = (self.sources.get(self.wanted), &self.loader) {
            // The new load reports its files itself.
            self.unwatched = None;
            self.loading = loader.load(source.clone())?;
        }
        Ok(())
    }

    /// Starts to watch the current scene's files, and reads the scene again if one has changed
    /// since it was read.
    ///
    /// Returns the reason why changes will not be noticed, unless it was returned before.
    pub(super) fn watch(&mut self) -> io::Result<Option<String>> {
        let Some(files) = self.unwatched.take().filter(|files| !files.is_empty()) else { return Ok(None) };
        let problem = match self.started() {
            Ok(watching) => {
                // A file may have changed between reading and watching.
                if watching.watch(files) {
                    self.read_again()?;
                }
                self.watching.as_ref().and_then(Watching::problem).map(str::to_owned)
            }
            Err(problem) => Some(problem),
        };
        // Reported once: the reason stays the same at each reload, and a note hides the lowest row.
        let is_new = problem != self.reported_problem;
        self.reported_problem.clone_from(&problem);
        Ok(problem.filter(|_| is_new))
    }

    fn started(&mut self) -> Result<&mut Watching, String> {
        Ok(match &mut self.watching {
            Some(watching) => watching,
            none => none.insert(Watching::start(self.waker.try_clone().map_err(|error| error.to_string())?)?),
        })
    }
}
