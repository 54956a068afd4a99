//! The list of scenes: the current one, its load in progress, and reading it again when its files
//! change.

use super::loading::{LoadEvent, Loader, Loading, PROGRESS_DELAY};
use super::source::{SceneName, Source};
use super::watching::{Dependency, Watching};
use crate::mesh_file::UpAxis;
use crate::scene::Scene;
use crate::terminal::{Signals, Waker};
use std::io;

/// The scenes that the user can switch between.
pub(super) struct Scenes<E> {
    /// The sources of the scenes; empty for a scene that was passed as a value.
    sources: Vec<Source<E>>,
    /// Index of the current scene.
    wanted: usize,
    /// The loading thread; `None` for a scene that was passed as a value.
    loader: Option<Loader<E>>,
    /// The last load of the current scene.
    loading: Loading<E>,
    waker: Waker,
    /// The watching thread; `None` before it is started, and if that fails.
    watching: Option<Watching>,
    /// The files of the current scene that are not watched yet.
    unwatched: Option<Vec<Dependency>>,
    /// The reason why file changes are not noticed, as the user was last told.
    reported_problem: Option<String>,
}

/// An event of loading the current scene.
pub(super) struct SceneEvent<E> {
    /// Index of the scene in the list.
    pub(super) index: usize,
    pub(super) event: LoadEvent<E>,
    /// Whether the load has taken longer than [`PROGRESS_DELAY`].
    pub(super) is_slow: bool,
}

impl<E: Send + 'static> Scenes<E> {
    /// Returns a list of one scene, which is loaded already.
    pub(super) fn of_scene(scene: Scene, signals: &Signals) -> io::Result<Self> {
        Self::new(Vec::new(), None, Loading::finished(scene), signals)
    }

    /// Returns a list of these scenes and starts to load the first one.
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

    /// Waits until the first scene is loaded, for at most [`PROGRESS_DELAY`].
    ///
    /// # Errors
    /// The error of loading it.
    pub(super) fn wait(&mut self) -> Result<(), E> {
        self.loading.wait(PROGRESS_DELAY)
    }

    /// Returns the next event of loading the current scene, if one has arrived.
    ///
    /// Before that, starts to load the scene again if one of its files has changed.
    pub(super) fn next_event(&mut self) -> io::Result<Option<SceneEvent<E>>> {
        if self.watching.as_mut().is_some_and(Watching::take_changed) {
            self.read_again()?;
        }
        while let Some(event) = self.loading.next() {
            match event {
                LoadEvent::Dependencies(files) => self.unwatched = Some(files),
                event => return Ok(Some(SceneEvent { index: self.wanted, event, is_slow: self.loading.is_slow() })),
            }
        }
        Ok(None)
    }

    /// Returns the names of the scenes.
    pub(super) fn names(&self) -> Vec<SceneName> {
        self.sources.iter().map(|source| source.scene_name().clone()).collect()
    }

    /// Switches to the scene `steps` places further on in the cyclic list, starts to load it, and
    /// returns its index.
    pub(super) fn switch(&mut self, steps: isize) -> io::Result<usize> {
        // Switching from a single scene to itself would only load it again.
        if self.sources.len() < 2 {
            return Ok(self.wanted);
        }
        let count = self.sources.len();
        self.wanted = (self.wanted + steps.rem_euclid(count.cast_signed()).cast_unsigned()) % count;
        self.read_again()?;
        Ok(self.wanted)
    }

    /// Reads the current scene again; a mesh is turned so that the next axis of its file points up.
    ///
    /// This is the axis after the one that the user chose last, or after `shown` if the user has chosen none.
    pub(super) fn turn_next_axis_up(&mut self, shown: UpAxis) -> io::Result<()> {
        if let Some(source) = self.sources.get_mut(self.wanted) {
            source.turn_next_axis_up(shown);
        }
        self.read_again()
    }

    /// Cancels the load in progress and starts one of the current scene.
    fn read_again(&mut self) -> io::Result<()> {
        if let (Some(source), Some(loader)) = (self.sources.get(self.wanted), &self.loader) {
            // Forgets the files that are not watched yet, because the new load reports the scene's files again.
            self.unwatched = None;
            self.loading = loader.load(source.clone())?;
        }
        Ok(())
    }

    /// Starts to watch the current scene's files; if one has changed since it was read, loads the
    /// scene again.
    ///
    /// Returns the reason why changes will not be noticed, unless it was returned before.
    pub(super) fn watch_current_scene(&mut self) -> io::Result<Option<String>> {
        let Some(files) = self.unwatched.take().filter(|files| !files.is_empty()) else { return Ok(None) };
        let problem = match self.started_watching() {
            Ok(watching) => {
                // A file may have changed between reading and watching.
                if watching.watch(files) {
                    self.read_again()?;
                }
                self.watching.as_ref().and_then(Watching::problem).map(str::to_owned)
            }
            Err(problem) => Some(problem),
        };
        // A reason is reported only once, because it is the same at each reload and a note hides the lowest row.
        let is_new = problem != self.reported_problem;
        self.reported_problem.clone_from(&problem);
        Ok(problem.filter(|_| is_new))
    }

    fn started_watching(&mut self) -> Result<&mut Watching, String> {
        Ok(match &mut self.watching {
            Some(watching) => watching,
            none => none.insert(Watching::start(self.waker.try_clone().map_err(|error| error.to_string())?)?),
        })
    }
}
