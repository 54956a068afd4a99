//! The scene on its way: read, sketched and built by a thread of its own, so that keys and signals are heard meanwhile.

use super::source::Source;
use super::watching::Needed;
use crate::progress::{Progress, Watcher};
use crate::scene::{Draft, Scene};
use crate::terminal::{self, Waker};
use rayon::ThreadPoolBuilder;
use std::any::Any;
use std::collections::VecDeque;
use std::io;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

/// What there is to say of the scene, in this order: of the last three only one, once.
pub(super) enum News<E> {
    /// How far it is.
    Progress(Progress),
    /// What it was read from, or should have been.
    Needs(Vec<Needed>),
    /// Something to look at until it is there.
    Sketch(Scene),
    /// It is there.
    Scene(Scene),
    /// It will not come: what is wrong with it.
    Fault(E),
    /// It will not come: with what the thread panicked.
    Panic(Box<dyn Any + Send>),
}

/// What is there so soon is shown without a word about it.
pub(super) const MOMENT: Duration = Duration::from_millis(100);

/// Progress is told so often at most: a person sees it move.
const STEP: Duration = Duration::from_millis(50);

/// Our side of the thread. Nobody waits for its end: once this is gone, it notices at its next report.
pub(super) struct Loading<E> {
    news: Receiver<News<E>>,
    /// What was heard while we waited.
    heard: VecDeque<News<E>>,
    begun: Instant,
}

impl<E: Send + 'static> Loading<E> {
    /// A scene that is there.
    pub(super) fn done(scene: Scene) -> Self {
        let (_, news) = channel();
        Self { news, heard: VecDeque::from([News::Scene(scene)]), begun: Instant::now() }
    }

    /// Starts the thread, which reads a draft, sketches and builds it.
    pub(super) fn start(source: Source<E>, threads: Option<usize>, waker: Waker) -> io::Result<Self> {
        let (sender, news) = channel();
        let teller = Teller { news: sender, told: Mutex::new((waker, None)) };
        let work = move || {
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| load(&source, threads, &teller))) {
                let _ = teller.tell(News::Panic(panic));
            }
        };
        thread::Builder::new().name("load".to_owned()).spawn(work)?;
        Ok(Self { news, heard: VecDeque::new(), begun: Instant::now() })
    }

    /// Waits so long for the scene, or for what is wrong with it, which is then the error.
    pub(super) fn wait(&mut self, patience: Duration) -> Result<(), E> {
        let deadline = Instant::now() + patience;
        while let Ok(news) = self.news.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
            match news {
                News::Fault(fault) => return Err(fault),
                News::Scene(_) => {
                    self.heard.retain(|news| matches!(news, News::Needs(_)));
                    self.heard.push_back(news);
                    return Ok(());
                }
                _ => self.heard.push_back(news),
            }
        }
        Ok(())
    }

    /// Whether it has taken longer than a moment: worth a word.
    pub(super) fn is_slow(&self) -> bool {
        self.begun.elapsed() >= MOMENT
    }

    /// What is new since the last call, one by one.
    pub(super) fn next(&mut self) -> Option<News<E>> {
        self.heard.pop_front().or_else(|| self.news.try_recv().ok())
    }
}

/// The thread's side.
struct Teller<E> {
    news: Sender<News<E>>,
    /// Who is woken, and when progress was last told.
    told: Mutex<(Waker, Option<Instant>)>,
}

impl<E> Teller<E> {
    /// `Break`: nobody listens any more.
    fn tell(&self, news: News<E>) -> ControlFlow<()> {
        if self.news.send(news).is_err() {
            return ControlFlow::Break(());
        }
        if let Ok(mut told) = self.told.lock() {
            told.0.wake();
        }
        ControlFlow::Continue(())
    }

    /// The same of what is soon out of date: most of it is not told.
    fn tell_progress(&self, progress: Progress) -> ControlFlow<()> {
        let now = Instant::now();
        if let Ok(mut told) = self.told.lock() {
            if told.1.is_some_and(|last| now < last + STEP) {
                return ControlFlow::Continue(());
            }
            told.1 = Some(now);
        }
        self.tell(News::Progress(progress))
    }
}

fn load<E: Send>(source: &Source<E>, threads: Option<usize>, teller: &Teller<E>) {
    let hear = |progress| teller.tell_progress(progress);
    let needed = Mutex::new(Vec::new());
    let hear_need = |file: &Path| {
        if let Ok(mut needed) = needed.lock() {
            needed.extend(Needed::now(file));
        }
    };
    let watcher = Watcher::new(&hear).with_needs(&hear_need);
    let read = source.read(&watcher);
    let needed = needed.lock().map(|mut needed| std::mem::take(&mut *needed)).unwrap_or_default();
    let _ = teller.tell(News::Needs(needed));
    let draft = match read {
        Ok(Some(draft)) => draft,
        // Nobody listens any more.
        Ok(None) => return,
        Err(fault) => {
            let _ = teller.tell(News::Fault(fault));
            return;
        }
    };
    let build = || build(draft, &watcher, teller);
    let pool = threads.map(|threads| ThreadPoolBuilder::new().num_threads(threads).build());
    match pool {
        Some(Ok(pool)) => pool.install(build),
        // Rayon's own, with as many threads as there are cores.
        _ => build(),
    }
}

fn build<E>(draft: Draft, watcher: &Watcher<'_>, teller: &Teller<E>) {
    if let Some(sketch) = draft.sketch() {
        let _ = teller.tell(News::Sketch(sketch));
    }
    let _ = terminal::reach_beside("build");
    if let Some(scene) = draft.build(watcher) {
        let _ = teller.tell(News::Scene(scene));
    }
}
