//! Loading of scenes on a thread of its own, so that keys and signals are handled meanwhile.
//!
//! One thread reads one scene at a time. Saving a scene's file cancels its load in progress and requests another one,
//! so that at most one load takes memory, however often a large scene is saved. (With a thread for each load, 30 saves
//! of a scene of 12 MB took 5.9 GB; now they peak at 409 MB, where one load takes 394.) A load that waits on a pipe may
//! never end, so another thread takes over the queue of requests.

use super::source::Source;
use super::watching::Dependency;
use crate::progress::{Cancellation, Progress, Reporter};
use crate::scene::{Draft, Scene};
use crate::terminal::{self, Waker};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::any::Any;
use std::cell::OnceCell;
use std::collections::VecDeque;
use std::io;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// An event of loading a scene. Events arrive in this order; exactly one of the last three ends a
/// load that is not cancelled.
pub(super) enum LoadEvent<E> {
    /// Progress of reading or building.
    Progress(Progress),
    /// The files that the scene was read from, and those that were missing.
    Dependencies(Vec<Dependency>),
    /// Warnings about the scene's files; empty if there are none.
    Warnings(Vec<String>),
    /// A scene with coarse meshes, to show while the trees of the complete scene are built.
    Sketch(Scene),
    /// The complete scene.
    Scene(Scene),
    /// The error that ended the load.
    Error(E),
    /// The payload of a panic that ended the load.
    Panic(Box<dyn Any + Send>),
}

/// Time after which a load shows a progress panel. In a faster load the panel would only flash up.
// 100 ms is the usual limit of what users feel as immediate (Miller 1968).
pub(super) const PROGRESS_DELAY: Duration = Duration::from_millis(100);

/// Least time between two progress reports of a load.
// 20 reports a second look continuous, and each one costs a frame.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(50);

/// The receiving side of a load. Dropping it cancels the load without waiting for its end.
pub(super) struct Loading<E> {
    events: Receiver<LoadEvent<E>>,
    /// Events that arrived during [`wait`](Self::wait).
    received: VecDeque<LoadEvent<E>>,
    begun: Instant,
    cancellation: Cancellation,
}

impl<E> Drop for Loading<E> {
    fn drop(&mut self) {
        self.cancellation.cancel();
    }
}

impl<E> Loading<E> {
    /// Returns a finished load of `scene`.
    pub(super) fn finished(scene: Scene) -> Self {
        let (_, events) = channel();
        let received = VecDeque::from([LoadEvent::Scene(scene)]);
        Self { events, received, begun: Instant::now(), cancellation: Cancellation::default() }
    }

    /// Waits until the load has ended, for at most `patience`, and keeps its events for
    /// [`next`](Self::next).
    ///
    /// # Errors
    /// The error that ended the load.
    pub(super) fn wait(&mut self, patience: Duration) -> Result<(), E> {
        let deadline = Instant::now() + patience;
        while let Ok(event) = self.events.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
            match event {
                LoadEvent::Error(fault) => return Err(fault),
                // Once the complete scene has arrived, its progress and its sketch need not be shown.
                LoadEvent::Scene(_) => {
                    self.received.retain(|event| matches!(event, LoadEvent::Dependencies(_) | LoadEvent::Warnings(_)));
                    self.received.push_back(event);
                    return Ok(());
                }
                _ => self.received.push_back(event),
            }
        }
        Ok(())
    }

    /// Returns whether the load has taken longer than [`PROGRESS_DELAY`].
    pub(super) fn is_slow(&self) -> bool {
        self.begun.elapsed() >= PROGRESS_DELAY
    }

    /// Returns the next event, if one has arrived.
    pub(super) fn next(&mut self) -> Option<LoadEvent<E>> {
        self.received.pop_front().or_else(|| self.events.try_recv().ok())
    }
}

/// The thread that loads scenes, in the order of the requests.
pub(super) struct Loader<E> {
    requests: Sender<LoadRequest<E>>,
}

impl<E: Send + 'static> Loader<E> {
    /// Starts the thread, which ends when the returned value is dropped and the last load has
    /// ended.
    pub(super) fn start(threads: Option<usize>, waker: Waker) -> io::Result<Self> {
        let (requests, queue) = channel();
        LoadWorker { queue: Arc::new(Mutex::new(queue)), threads, waker: Arc::new(Mutex::new(waker)) }.start()?;
        Ok(Self { requests })
    }

    /// Requests a load, which starts when the one before it has ended.
    pub(super) fn load(&self, source: Source<E>) -> io::Result<Loading<E>> {
        let (sender, events) = channel();
        let cancellation = Cancellation::default();
        let request = LoadRequest { source, events: sender, cancellation: cancellation.clone() };
        self.requests.send(request).map_err(|_| io::Error::other("the thread that reads scenes has ended"))?;
        Ok(Loading { events, received: VecDeque::new(), begun: Instant::now(), cancellation })
    }
}

/// A requested load.
struct LoadRequest<E> {
    source: Source<E>,
    events: Sender<LoadEvent<E>>,
    cancellation: Cancellation,
}

/// The state of the loading thread.
struct LoadWorker<E> {
    /// The requests, shared with earlier loading threads, which wait on pipes and take no more.
    queue: Arc<Mutex<Receiver<LoadRequest<E>>>>,
    threads: Option<usize>,
    // Locked, because any thread that builds trees may report progress.
    waker: Arc<Mutex<Waker>>,
}

impl<E: Send + 'static> LoadWorker<E> {
    fn start(self) -> io::Result<()> {
        let thread = thread::Builder::new().name("load".to_owned());
        terminal::without_signals(|| thread.spawn(|| self.load_all())).map(drop)
    }

    /// Loads scenes until the queue is closed or another thread has taken over.
    fn load_all(self) {
        let pool = OnceCell::new();
        loop {
            let request = self.queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
            let Ok(request) = request else { return };
            // Requests that were cancelled while they waited are skipped, so that after many saves in a row only the
            // last version is read.
            if request.cancellation.is_cancelled() {
                continue;
            }
            // The queue is handed over to another thread at most once per load, however many pipes the scene has.
            let is_handed_over = AtomicBool::new(false);
            let hand_over_queue = || {
                if !is_handed_over.load(Ordering::Relaxed) {
                    is_handed_over.store(self.start_another().is_ok(), Ordering::Relaxed);
                }
            };
            let pool = || pool.get_or_init(|| self.build_pool()).as_ref();
            request.process(&self.waker, &hand_over_queue, &pool);
            if is_handed_over.into_inner() {
                return;
            }
        }
    }

    /// Starts another thread that loads the scenes of the same queue.
    fn start_another(&self) -> io::Result<()> {
        Self { queue: Arc::clone(&self.queue), threads: self.threads, waker: Arc::clone(&self.waker) }.start()
    }

    /// Returns a pool with the requested number of threads, or of this thread alone if they cannot
    /// be started.
    ///
    /// (`None` would mean rayon's global pool, which panics if its threads cannot be started.)
    fn build_pool(&self) -> Option<ThreadPool> {
        let pool = ThreadPoolBuilder::new().num_threads(self.threads.unwrap_or(0)).build();
        pool.or_else(|_| ThreadPoolBuilder::new().num_threads(1).use_current_thread().build()).ok()
    }
}

impl<E: Send> LoadRequest<E> {
    /// Loads the scene and sends the events of the load.
    ///
    /// Calls `hand_over_queue` before opening a file that may block, and builds large trees on the threads of `pool`.
    fn process<'p>(
        self,
        waker: &Mutex<Waker>,
        hand_over_queue: &(dyn Fn() + Sync),
        pool: &dyn Fn() -> Option<&'p ThreadPool>,
    ) {
        let Self { source, events: sender, cancellation } = self;
        let events = EventSender { events: sender, waker, last_progress: Mutex::new(None) };
        let work = || load(&source, &cancellation, &events, hand_over_queue, pool);
        // The event loop resumes the panic and restores the terminal.
        if let Err(panic) = catch_unwind(AssertUnwindSafe(work)) {
            events.send(LoadEvent::Panic(panic));
        }
    }
}

/// The sending side of a load's events.
struct EventSender<'w, E> {
    events: Sender<LoadEvent<E>>,
    waker: &'w Mutex<Waker>,
    /// Time of the last progress report.
    last_progress: Mutex<Option<Instant>>,
}

impl<E> EventSender<'_, E> {
    fn send(&self, event: LoadEvent<E>) {
        // If the channel is closed, the load has been cancelled and the event loop needs no wake-up.
        if self.events.send(event).is_ok()
            && let Ok(mut waker) = self.waker.lock()
        {
            waker.wake();
        }
    }

    /// Sends a progress report, unless the last one is less than [`PROGRESS_INTERVAL`] ago.
    fn send_progress(&self, progress: Progress) {
        let now = Instant::now();
        if let Ok(mut last_progress) = self.last_progress.lock() {
            if last_progress.is_some_and(|last| now < last + PROGRESS_INTERVAL) {
                return;
            }
            *last_progress = Some(now);
        }
        self.send(LoadEvent::Progress(progress));
    }
}

fn load<'p, E: Send>(
    source: &Source<E>,
    cancellation: &Cancellation,
    events: &EventSender<'_, E>,
    hand_over_queue: &(dyn Fn() + Sync),
    pool: &dyn Fn() -> Option<&'p ThreadPool>,
) {
    let on_progress = |progress| {
        events.send_progress(progress);
        ControlFlow::Continue(())
    };
    let needed = Mutex::new(Vec::new());
    let on_dependency = |file: &Path| {
        let file = Dependency::in_current_state(file);
        if file.is_special_file() {
            hand_over_queue();
        }
        if let Ok(mut needed) = needed.lock() {
            needed.push(file);
        }
    };
    let warnings = Mutex::new(Vec::new());
    let on_warning = |warning: String| {
        if let Ok(mut warnings) = warnings.lock() {
            warnings.push(warning);
        }
    };
    let reporter = Reporter::new(&on_progress).with_dependencies(&on_dependency).cancelled_by(cancellation);
    let reporter = reporter.with_warnings(&on_warning);
    // In a pool, a reader takes all of its threads.
    let read = match source.is_large().then(pool).flatten() {
        Some(pool) => pool.install(|| source.read(&reporter)),
        None => source.read(&reporter.on_this_thread()),
    };
    let needed = needed.lock().map(|mut needed| std::mem::take(&mut *needed)).unwrap_or_default();
    // Sent after an error too, so that the files are watched and a correction is noticed.
    events.send(LoadEvent::Dependencies(needed));
    events.send(LoadEvent::Warnings(warnings.lock().map(|mut all| std::mem::take(&mut *all)).unwrap_or_default()));
    match read {
        // The result of a cancelled load is dropped, whether it is a scene or an error.
        _ if cancellation.is_cancelled() => {}
        // Small scenes are built in microseconds on this thread; two threads of a pool would take 130 MB of address
        // space.
        Ok(draft) => match draft.builds_in_parallel().then(pool).flatten() {
            Some(pool) => pool.install(|| build(draft, &reporter, events)),
            None => build(draft, &reporter, events),
        },
        Err(fault) => events.send(LoadEvent::Error(fault)),
    }
}

fn build<E>(draft: Draft, reporter: &Reporter<'_>, events: &EventSender<'_, E>) {
    // The sketch comes before the trees are built, which takes most of the time of loading a large mesh.
    if let Some(sketch) = draft.sketch() {
        events.send(LoadEvent::Sketch(sketch));
    }
    let _ = terminal::report_phase_in_thread("build");
    if let Ok(scene) = draft.build_or_cancel(reporter) {
        events.send(LoadEvent::Scene(scene));
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
