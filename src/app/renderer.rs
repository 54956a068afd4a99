//! The thread that traces, so that the loop never waits for a frame. One that takes less time than to wake the thread
//! and to be woken by it is no wait: the loop traces it by itself.

use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::{Cost, Rendered, render_alone, render_unless};
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
    /// What it took.
    pub(super) cost: Cost,
    /// How long it took on the clock.
    pub(super) trace: Duration,
}

impl Frame {
    fn new(scene: &Scene, job: &Job, rendered: &Rendered, trace: Duration) -> Self {
        let picture = tone(&rendered.framebuffer, scene);
        Self { camera: job.camera, picture, cost: rendered.cost, trace }
    }
}

/// The thread's result: a frame, none if it was cancelled, or what it panicked with.
type Traced = Result<Option<Frame>, Box<dyn Any + Send>>;

/// Frames that take no longer are traced by the loop.
const SMALL: Duration = Duration::from_micros(1500);

/// Our side of the thread.
pub(super) struct Renderer {
    /// What frames are of; `None` as long as there is nothing to see.
    scene: Option<Arc<Scene>>,
    jobs: Option<Sender<(Arc<Scene>, Job)>>,
    frames: Receiver<Traced>,
    cancelled: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    in_work: usize,
    /// How many seconds a pixel of the last frame took, all threads together.
    seconds_per_pixel: Option<f64>,
}

impl Renderer {
    /// Starts the thread, and the pool of those that it shares the tiles with. It is one of them itself: to wake another
    /// and to be woken again takes as long as a small frame.
    pub(super) fn start(threads: Option<usize>, mut waker: Waker) -> io::Result<Self> {
        let (jobs, wanted) = channel::<(Arc<Scene>, Job)>();
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
            for (scene, job) in wanted {
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
        Ok(Self {
            scene: None,
            jobs: Some(jobs),
            frames,
            cancelled,
            thread: Some(thread),
            in_work: 0,
            seconds_per_pixel: None,
        })
    }

    /// From now on frames are of that scene.
    pub(super) fn show(&mut self, scene: Scene) {
        self.scene = Some(Arc::new(scene));
        self.seconds_per_pixel = None;
    }

    /// Whether no frame can be begun: one is on its way, or there is no scene yet.
    pub(super) fn is_busy(&self) -> bool {
        self.in_work > 0 || self.scene.is_none()
    }

    /// Begins a frame, or traces it at once where that takes next to no time.
    pub(super) fn begin(&mut self, job: Job) -> Option<Frame> {
        let scene = Arc::clone(self.scene.as_ref()?);
        if self.is_small(&job) {
            let start = Instant::now();
            let rendered = render_alone(&scene, &job.camera, job.resolution, NonZeroU32::MIN);
            return Some(self.noted(Frame::new(&scene, &job, &rendered, start.elapsed())));
        }
        if let Some(jobs) = &self.jobs
            && jobs.send((scene, job)).is_ok()
        {
            self.in_work += 1;
        }
        None
    }

    /// The frame that has been finished since the last call, if one has.
    ///
    /// # Panics
    /// With what the thread panicked with.
    pub(super) fn finished(&mut self) -> Option<Frame> {
        let traced = self.frames.try_recv().ok()?;
        self.in_work -= 1;
        // The message is out already, or kept; the panic goes on here, where the terminal is given back.
        let frame = traced.unwrap_or_else(|panic| resume_unwind(panic))?;
        Some(self.noted(frame))
    }

    /// Whether a frame will take next to no time, going by the last.
    fn is_small(&self, job: &Job) -> bool {
        let Resolution { width, height, .. } = job.resolution;
        let pixels = f64::from(width) * f64::from(height);
        !job.test_panic && self.seconds_per_pixel.is_some_and(|seconds| seconds * pixels < SMALL.as_secs_f64())
    }

    fn noted(&mut self, frame: Frame) -> Frame {
        self.seconds_per_pixel = Some(frame.cost.work.as_secs_f64() / frame.picture.pixels.len() as f64);
        frame
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
        Some(Frame::new(scene, job, &rendered, start.elapsed()))
    })
}

fn panic_in_a_worker() {
    rayon::join(|| {}, || panic!("a test asked for a panic in a worker"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::Signals;

    /// The loop traces what its last frames were small for, and the same picture as the thread does.
    #[test]
    fn small_frames_are_done_at_once() {
        let text = include_str!("../../scenes/three_spheres.ron");
        let scene = Scene::from_ron("three_spheres.ron", text).expect("the scene is fine");
        let camera = scene.camera;
        let waker = Signals::catch().and_then(|signals| signals.waker()).expect("pipes can be made");
        let mut renderer = Renderer::start(Some(2), waker).expect("threads can be started");
        renderer.show(scene);
        let job = |side| Job { camera, resolution: Resolution::square(side, side), test_panic: false };
        assert!(renderer.begin(job(8)).is_none(), "nothing is known of the first");
        let by_the_thread = wait_for(&mut renderer);
        let by_the_loop = renderer.begin(job(8)).expect("64 pixels are a small frame");
        assert!(by_the_loop.picture == by_the_thread.picture);
        assert!(renderer.begin(job(1000)).is_none(), "a million pixels are not");
        wait_for(&mut renderer);
    }

    fn wait_for(renderer: &mut Renderer) -> Frame {
        loop {
            if let Some(frame) = renderer.finished() {
                return frame;
            }
            thread::yield_now();
        }
    }
}
