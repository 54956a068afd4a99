//! The scenes that there are to look at: which one is wanted, what is on its way, and when it is read again.

use super::loading::{Loading, MOMENT, News};
use super::source::{Named, Source};
use super::watching::{Needed, Watching};
use crate::scene::Scene;
use crate::terminal::{self, Signals, Waker};
use std::io;

/// One of them is wanted at a time.
pub(super) struct Scenes<E> {
    /// None for a scene that was there from the start.
    sources: Vec<Source<E>>,
    wanted: usize,
    loading: Loading<E>,
    threads: Option<usize>,
    waker: Waker,
    /// `None`: nothing is watched yet, or the system does not tell of changes.
    watching: Option<Watching>,
    /// What the wanted scene needs, if that is not watched yet.
    unwatched: Option<Vec<Needed>>,
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
        let waker = signals.waker()?;
        let loading = Loading::done(scene);
        Ok(Self { sources: Vec::new(), wanted: 0, loading, threads: None, waker, watching: None, unwatched: None })
    }

    /// Begins with the first.
    pub(super) fn start(sources: Vec<Source<E>>, threads: Option<usize>, signals: &Signals) -> io::Result<Self> {
        let waker = signals.waker()?;
        let first = sources.first().cloned().ok_or_else(|| io::Error::other("there is no scene to look at"))?;
        let loading = begin(first, threads, &waker)?;
        Ok(Self { sources, wanted: 0, loading, threads, waker, watching: None, unwatched: None })
    }

    /// Waits a moment for the first, or for what is wrong with it, which is then the error.
    pub(super) fn wait(&mut self) -> Result<(), E> {
        self.loading.wait(MOMENT)
    }

    /// What is new since the last call, one by one. A scene whose files have changed is read again.
    pub(super) fn next(&mut self) -> io::Result<Option<Heard<E>>> {
        if self.watching.as_ref().is_some_and(Watching::take_changed) {
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
        if let Some(source) = self.sources.get(self.wanted).cloned() {
            self.unwatched = None;
            self.loading = begin(source, self.threads, &self.waker)?;
        }
        Ok(())
    }

    /// Sees to it that changes of the files are heard of from now on, and reads them again if one has changed since.
    pub(super) fn watch(&mut self) -> io::Result<()> {
        let Some(files) = self.unwatched.take() else { return Ok(()) };
        if self.watching.is_none() && !files.is_empty() {
            self.watching = Watching::start(self.waker.try_clone()?).ok();
        }
        // What was read is out of date already.
        if self.watching.as_mut().is_some_and(|watching| watching.watch(&files)) {
            self.read_again()?;
        }
        Ok(())
    }
}

fn begin<E: Send + 'static>(source: Source<E>, threads: Option<usize>, waker: &Waker) -> io::Result<Loading<E>> {
    let waker = waker.try_clone()?;
    terminal::without_signals(|| Loading::start(source, threads, waker))
}
