//! The scenes that there are to look at: which one is wanted, what is on its way, and when it is read again.

use super::loading::{Loader, Loading, MOMENT, News};
use super::source::{Named, Source};
use super::watching::{Needed, Watching};
use crate::scene::Scene;
use crate::terminal::{Signals, Waker};
use std::io;

/// One of them is wanted at a time.
pub(super) struct Scenes<E> {
    /// None for a scene that was there from the start.
    sources: Vec<Source<E>>,
    wanted: usize,
    /// None for a scene that was there from the start.
    loader: Option<Loader<E>>,
    loading: Loading<E>,
    waker: Waker,
    /// `None`: nothing is watched yet, or the system does not tell of changes.
    watching: Option<Watching>,
    /// What the wanted scene needs, if that is not watched yet.
    unwatched: Option<Vec<Needed>>,
    /// Why changes are not heard of, as the user was last told.
    told: Option<String>,
}

/// What is new of the wanted scene.
pub(super) struct Heard<E> {
    /// Which one it is.
    pub(super) of: usize,
    pub(super) news: News<E>,
    /// Whether it has been on its way for longer than a moment.
    pub(super) is_slow: bool,
}

impl<E: Send + 'static> Scenes<E> {
    /// A scene that is there.
    pub(super) fn done(scene: Scene, signals: &Signals) -> io::Result<Self> {
        Self::new(Vec::new(), None, Loading::done(scene), signals)
    }

    /// Begins with the first.
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
        Ok(Self { sources, wanted: 0, loader, loading, waker, watching: None, unwatched: None, told: None })
    }

    /// Waits a moment for the first, or for what is wrong with it, which is then the error.
    pub(super) fn wait(&mut self) -> Result<(), E> {
        self.loading.wait(MOMENT)
    }

    /// What is new since the last call, one by one. A scene whose files have changed is read again.
    pub(super) fn next(&mut self) -> io::Result<Option<Heard<E>>> {
        if self.watching.as_mut().is_some_and(Watching::take_changed) {
            self.read_again()?;
        }
        while let Some(news) = self.loading.next() {
            match news {
                News::Needs(files) => self.unwatched = Some(files),
                news => return Ok(Some(Heard { of: self.wanted, news, is_slow: self.loading.is_slow() })),
            }
        }
        Ok(None)
    }

    /// What they are called.
    pub(super) fn named(&self) -> Vec<Named> {
        self.sources.iter().map(|source| source.named().clone()).collect()
    }

    /// Another one is wanted, so many further on, if there are several; after the last comes the first.
    pub(super) fn go(&mut self, steps: isize) -> io::Result<()> {
        if self.sources.len() < 2 {
            return Ok(());
        }
        let count = self.sources.len();
        self.wanted = (self.wanted + steps.rem_euclid(count.cast_signed()).cast_unsigned()) % count;
        self.read_again()
    }

    /// Whatever was on its way is given up.
    fn read_again(&mut self) -> io::Result<()> {
        if let (Some(source), Some(loader)) = (self.sources.get(self.wanted), &self.loader) {
            self.unwatched = None;
            self.loading = loader.load(source.clone())?;
        }
        Ok(())
    }

    /// Sees to it that changes of the files are heard of from now on, and reads them again if one has changed since.
    /// Returns why changes will not be heard of, where that is so and has not been told yet.
    pub(super) fn watch(&mut self) -> io::Result<Option<String>> {
        let Some(files) = self.unwatched.take().filter(|files| !files.is_empty()) else { return Ok(None) };
        let problem = match self.started() {
            Ok(watching) => {
                // What was read is out of date already.
                if watching.watch(files) {
                    self.read_again()?;
                }
                self.watching.as_ref().and_then(Watching::problem).map(str::to_owned)
            }
            Err(problem) => Some(problem),
        };
        let is_new = problem != self.told;
        self.told.clone_from(&problem);
        Ok(problem.filter(|_| is_new))
    }

    fn started(&mut self) -> Result<&mut Watching, String> {
        Ok(match &mut self.watching {
            Some(watching) => watching,
            none => none.insert(Watching::start(self.waker.try_clone().map_err(|error| error.to_string())?)?),
        })
    }
}
