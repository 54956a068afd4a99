//! The thread that traces, so that the loop never waits for a frame.

use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::render_unless;
use crate::scene::Scene;
use crate::terminal::Waker;
use crate::tone::{Picture, tone};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::any::Any;
use std::io;
use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// A frame that is wanted.
pub(super) struct Job {
    pub(super) camera: Camera,
    pub(super) resolution: Resolution,
    /// Panic instead of tracing, because a test asks for it.
    pub(super) test_panic: bool,
}

/// A frame that is done.
pub(super) struct Frame {
    /// From where it is seen.
    pub(super) camera: Camera,
    pub(super) picture: Picture,
    /// How many rays it took.
    pub(super) rays: u64,
    /// How long tracing took.
    pub(super) trace: Duration,
}

/// The thread's result: a frame, none if it was cancelled, or what it panicked with.
type Traced = Result<Option<Frame>, Box<dyn Any + Send>>;

/// Our side of the thread.
pub(super) struct Renderer {
    jobs: Option<Sender<Job>>,
    frames: Receiver<Traced>,
    cancelled: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    in_work: usize,
}

impl Renderer {
    /// Starts the thread, and the pool of those that it shares the tiles with. It is one of them itself: to wake another
    /// and to be woken again takes as long as a small frame.
    pub(super) fn start(scene: Scene, threads: Option<usize>, mut waker: Waker) -> io::Result<Self> {
        let (jobs, wanted) = channel::<Job>();
        let (begun, started) = channel();
        let (done, frames) = channel();
        let cancelled = Arc::new(AtomicBool::new(false));
        let stop = Arc::clone(&cancelled);
        let thread = thread::Builder::new().name("render".to_owned()).spawn(move || {
            let pool = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).use_current_thread().build();
            let pool = match pool {
                Ok(pool) => pool,
                Err(error) => {
                    let _ = begun.send(Err(io::Error::other(error)));
                    return;
                }
            };
            let _ = begun.send(Ok(()));
            for job in wanted {
                let traced = catch_unwind(AssertUnwindSafe(|| trace(&pool, &stop, &scene, &job)));
                // Nobody listens any more: the loop has ended.
                let heard = done.send(traced).is_ok();
                waker.wake();
                if !heard {
                    break;
                }
            }
        })?;
        started.recv().map_err(io::Error::other)??;
        Ok(Self { jobs: Some(jobs), frames, cancelled, thread: Some(thread), in_work: 0 })
    }

    /// Whether a frame is on its way.
    pub(super) fn is_busy(&self) -> bool {
        self.in_work > 0
    }

    /// Begins a frame.
    pub(super) fn begin(&mut self, job: Job) {
        if let Some(jobs) = &self.jobs
            && jobs.send(job).is_ok()
        {
            self.in_work += 1;
        }
    }

    /// The frame that has been finished since the last call, if one has.
    ///
    /// # Panics
    /// With what the thread panicked with.
    pub(super) fn finished(&mut self) -> Option<Frame> {
        let traced = self.frames.try_recv().ok()?;
        self.in_work -= 1;
        // The message is out already, or kept; the panic goes on here, where the terminal is given back.
        traced.unwrap_or_else(|panic| resume_unwind(panic))
    }
}

impl Drop for Renderer {
    /// The frame in work is given up at its next tile, so that leaving is quick.
    fn drop(&mut self) {
        self.cancelled.store(true, Ordering::Relaxed);
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn trace(pool: &ThreadPool, cancelled: &AtomicBool, scene: &Scene, job: &Job) -> Option<Frame> {
    pool.install(|| {
        if cfg!(feature = "test-hooks") && job.test_panic {
            panic_in_a_worker();
        }
        let start = Instant::now();
        let rendered = render_unless(cancelled, scene, &job.camera, job.resolution, NonZeroU32::MIN)?;
        let trace = start.elapsed();
        let picture = tone(&rendered.framebuffer, scene);
        Some(Frame { camera: job.camera, picture, rays: rendered.rays, trace })
    })
}

fn panic_in_a_worker() {
    rayon::join(|| {}, || panic!("a test asked for a panic in a worker"));
}
