//! The thread that traces frames, so that the event loop need not wait for them.
//!
//! The loop itself traces frames that take less time than waking the thread and being woken by it.

use super::refinements::{RefinablePicture, Refinements, ViewerId};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::maps::{self, Map, TracedMap};
use crate::progress::{Cancellation, Cancelled};
use crate::rasterize::Comparison;
use crate::render::{Cost, Executor, Sampling, trace_geometry};
use crate::scene::Scene;
use crate::terminal::{self, Waker};
use crate::tone::tone;
use crate::viewer::{Frame, INITIAL_WIPE, Job, Shot, Tracing};
use rayon::ThreadPoolBuilder;
use std::any::Any;
use std::collections::VecDeque;
use std::io;
use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The result of a job: a frame, [`Cancelled`], or the payload of a panic.
type Traced = Result<Result<Frame, Cancelled>, Box<dyn Any + Send>>;

/// Greatest predicted time of frames that the event loop traces itself.
// Waking the render thread and its pool and being woken takes 0.15 to 0.3 ms, and 1 to 4 ms in one of twenty cases.
// Three spheres at 80x24 take one thread 0.59 ms, and two threads with waking 0.62 to 0.64 ms; traced by the loop, the
// median time from a key to its first byte fell from 0.87 to 0.65 ms. Keys wait for such a frame, so the limit stays
// well below a frame time.
const MAX_INLINE_TRACE_TIME: Duration = Duration::from_micros(1500);

/// The number of the viewer in the pool of refinements, which has no other.
const ONLY_VIEWER: ViewerId = 0;

/// The event loop's handle of the tracing thread.
pub(super) struct Renderer {
    jobs: Option<Sender<TraceTask>>,
    frames: Receiver<Traced>,
    thread: Option<JoinHandle<()>>,
    /// Jobs that were sent and are not finished, in the order in which they will finish.
    pending: VecDeque<PendingJob>,
    /// The shot of the last frame with one sample per pixel, and the seconds per pixel, summed over
    /// all threads.
    seconds_per_pixel: Option<(Shot, f64)>,
}

/// A job that was sent to the tracing thread and is not finished.
struct PendingJob {
    refines: bool,
    token: Cancellation,
}

impl PendingJob {
    fn is_wanted(&self) -> bool {
        !self.token.is_cancelled()
    }
}

impl Renderer {
    /// Starts the tracing thread and its pool.
    ///
    /// The thread is a member of the pool, because passing a frame to another thread and waiting takes as long as a
    /// small frame.
    pub(super) fn start(threads: Option<usize>, mut waker: Waker) -> io::Result<Self> {
        let (jobs, wanted) = channel::<TraceTask>();
        let (begun, started) = channel();
        let (done, frames) = channel();
        let tracer = Tracer::new(1);
        let thread = thread::Builder::new().name("render".to_owned()).spawn(move || {
            // The pool is not rayon's global one, which other work of the process may occupy for seconds.
            let pool = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).use_current_thread().build();
            let pool = match pool {
                Ok(pool) => pool,
                Err(error) => {
                    let _ = begun.send(Err(io::Error::other(error)));
                    return;
                }
            };
            let _ = begun.send(Ok(()));
            for task in wanted {
                // A panic is passed to the loop, which restores the terminal before it continues the panic.
                let traced = catch_unwind(AssertUnwindSafe(|| pool.install(|| task(&tracer))));
                // If the receiver is gone, the loop has ended.
                let heard = done.send(traced).is_ok();
                waker.wake();
                if !heard {
                    break;
                }
            }
        })?;
        started.recv().map_err(io::Error::other)??;
        let pending = VecDeque::new();
        Ok(Self { jobs: Some(jobs), frames, thread: Some(thread), pending, seconds_per_pixel: None })
    }

    /// Returns the kind of the frame that is being traced, if any; cancelled ones do not count.
    pub(super) fn tracing(&self) -> Option<Tracing> {
        let wanted = self.pending.iter().filter(|work| work.is_wanted());
        let tracing = wanted.map(|work| if work.refines { Tracing::Refinement } else { Tracing::NewView });
        // If there are both kinds, the frame of a new view counts, because only a refinement may be cancelled.
        tracing.min_by_key(|&tracing| tracing == Tracing::Refinement)
    }

    /// Starts tracing a frame on the tracing thread.
    ///
    /// A frame that is predicted to take little time is traced on the caller's thread instead, and returned.
    pub(super) fn start_frame(&mut self, job: Job) -> Option<Frame> {
        if self.is_small(&job) {
            return trace_once(&job).ok().map(|frame| self.record_time(frame));
        }
        let work = PendingJob { refines: job.refines, token: Cancellation::default() };
        let token = work.token.clone();
        self.submit(work, move |tracer| tracer.trace(ONLY_VIEWER, &job, &token));
        None
    }

    fn submit(&mut self, work: PendingJob, task: impl FnOnce(&Tracer) -> Result<Frame, Cancelled> + Send + 'static) {
        if let Some(jobs) = &self.jobs
            && jobs.send(Box::new(task)).is_ok()
        {
            self.pending.push_back(work);
        }
    }

    /// Makes a tracing thread panic, if a test has asked for it.
    pub(super) fn inject_worker_panic(&mut self) {
        if terminal::take_worker_panic() {
            let work = PendingJob { refines: false, token: Cancellation::default() };
            self.submit(work, |_| {
                rayon::join(|| {}, || panic!("a test asked for a panic in a worker"));
                Err(Cancelled)
            });
        }
    }

    /// Cancels refinements, because the view has changed.
    pub(super) fn cancel_refinements(&self) {
        for work in self.pending.iter().filter(|work| work.refines) {
            work.token.cancel();
        }
    }

    /// Returns a frame that has been finished since the last call, if any.
    ///
    /// # Panics
    /// With the payload of a panic in the thread.
    pub(super) fn take_finished(&mut self) -> Option<Frame> {
        loop {
            let traced = self.frames.try_recv().ok()?;
            let is_wanted = self.pending.pop_front().is_some_and(|work| work.is_wanted());
            // The panic hook has printed or kept the message. The panic continues on this thread, which restores the
            // terminal.
            let frame = traced.unwrap_or_else(|panic| resume_unwind(panic));
            // A cancelled job may have finished before it noticed, and its frame is dropped.
            if let (Ok(frame), true) = (frame, is_wanted) {
                return Some(self.record_time(frame));
            }
        }
    }

    /// Returns whether a frame is predicted to take less than [`MAX_INLINE_TRACE_TIME`].
    ///
    /// The prediction is the time per pixel of the last timed frame, times the number of pixels. Returns `false`
    /// without such a frame, or if it had another scene or other maps.
    fn is_small(&self, job: &Job) -> bool {
        // A comparison of image order and object order takes longer than the prediction.
        if job.shot.orders {
            return false;
        }
        let pixels = job.shot.resolution.pixel_count() as f64;
        let is_short = |(shot, seconds): (Shot, f64)| {
            // The camera may differ, because its effect on the time is small from frame to frame.
            let is_alike = (shot.scene, shot.layout) == (job.shot.scene, job.shot.layout);
            is_alike && seconds * pixels < MAX_INLINE_TRACE_TIME.as_secs_f64()
        };
        has_one_sample(job.sampling) && !job.refines && self.seconds_per_pixel.is_some_and(is_short)
    }

    fn record_time(&mut self, frame: Frame) -> Frame {
        // Only frames with one sample per pixel that refine nothing are timed, because `is_small` predicts only those.
        if has_one_sample(frame.sampling) && !frame.refines {
            let seconds = frame.cost.work.as_secs_f64() / frame.picture.pixels().len() as f64;
            self.seconds_per_pixel = Some((frame.shot, seconds));
        }
        frame
    }
}

impl Drop for Renderer {
    /// Cancels all jobs, which end at their next tile, and joins the thread.
    fn drop(&mut self) {
        for work in &self.pending {
            work.token.cancel();
        }
        // Closing the channel ends the thread's loop.
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// A job in the form in which it is sent to the tracing thread.
type TraceTask = Box<dyn FnOnce(&Tracer) -> Result<Frame, Cancelled> + Send>;

/// Returns the frame of a job: `trace_map` traces each of its maps, which are then combined.
pub(super) fn frame_of(
    job: &Job,
    mut trace_map: impl FnMut(Map, Resolution, &Camera) -> Result<TracedMap, Cancelled>,
) -> Result<Frame, Cancelled> {
    let start = Instant::now();
    let Job { scene, shot, sampling, refines } = job.clone();
    let mut cost = Cost::default();
    let (mut parts, mut geometry) = (Vec::new(), None);
    for (map, resolution, camera) in shot.parts() {
        let seen = trace_map(map, resolution, &camera)?;
        cost += seen.cost;
        parts.push(seen.picture);
        // Geometry is kept only if one view fills the picture: two views side by side may meet within a cell, which has
        // only one geometry.
        geometry = seen.geometry.filter(|_| resolution == shot.resolution);
    }
    let trace = start.elapsed();
    let combined = shot.layout.combined(&parts, INITIAL_WIPE).or_else(|| parts.pop());
    let picture = combined.expect("at least one picture is shown");
    if !shot.layout.is_wipe() {
        parts.clear();
    }
    let orders = match *shot.layout.map_sizes(shot.resolution) {
        [(_, left), (_, right)] if shot.orders && !refines => {
            Some(Arc::new(Comparison::new(&scene, &shot.camera, [left, right])))
        }
        _ => None,
    };
    let legends = match shot.outside {
        // If two orders are compared, their panel already names the two pictures.
        None if shot.orders => Vec::new(),
        Some(_) => ["first camera", "from outside: o eye, q on rectangle, p hit, n normal, * light"]
            .map(str::to_owned)
            .to_vec(),
        None => shot.layout.legends(&scene, &shot.camera),
    };
    Ok(Frame {
        scene,
        shot,
        picture,
        geometry,
        parts,
        sampling,
        legends,
        orders,
        refines,
        cost,
        trace,
        interval: trace,
    })
}

/// Traces a frame with one sample per pixel on the calling thread.
///
/// Gives the same light as `UpTo(1)`, but keeps no accumulators. A later refinement traces this sample again, which
/// takes little time.
fn trace_once(job: &Job) -> Result<Frame, Cancelled> {
    let one = Sampling::Each(NonZeroU32::MIN);
    let trace_map = |map, part, camera: &Camera| {
        trace_function(&job.shot)(map, Executor::CurrentThread, &job.scene, camera, part, one)
    };
    frame_of(job, trace_map)
}

/// Tracing of frames, with the pictures that are kept between two refinements.
///
/// Shared by all threads that trace for the viewers of a process.
pub(crate) struct Tracer {
    refinements: Refinements,
}

impl Tracer {
    /// Returns a tracer for this number of threads, which keeps as many pictures at most.
    pub(crate) fn new(threads: usize) -> Self {
        Self { refinements: Refinements::new(threads) }
    }

    /// Drops the picture that is kept for a viewer's next refinement, if there is one.
    #[cfg(feature = "serve")]
    pub(crate) fn release(&self, viewer: ViewerId) {
        self.refinements.release(viewer);
    }

    /// Traces or refines a frame of any viewer, on the calling thread or on the current rayon pool.
    ///
    /// A new frame with one sample per pixel is traced on the calling thread and ignores `token`. All others are traced
    /// on the pool, and `token` may cancel them.
    #[cfg(feature = "serve")]
    pub(crate) fn trace_for(&self, viewer: ViewerId, job: &Job, token: &Cancellation) -> Result<Frame, Cancelled> {
        if job.refines || !has_one_sample(job.sampling) {
            return self.trace(viewer, job, token);
        }
        self.refinements.release(viewer);
        trace_once(job)
    }

    /// Traces or refines a frame of a viewer.
    ///
    /// A refinement starts anew if no picture of its view is kept.
    fn trace(&self, viewer: ViewerId, job: &Job, token: &Cancellation) -> Result<Frame, Cancelled> {
        let Sampling::UpTo(samples) = job.sampling else {
            self.refinements.release(viewer);
            return frame_of(job, |map, resolution, camera| trace_all(job, token, (map, resolution, camera)));
        };
        // The kept picture may be older than the last frame, because the loop traces small frames itself.
        let (place, mut kept) = self.refinements.take_place(viewer);
        let mut next = None;
        let frame = frame_of(job, |map, resolution, camera| {
            if !map.refines() {
                return trace_all(job, token, (map, resolution, camera));
            }
            let last = kept.take().filter(|kept| job.refines && kept.has_view_of(&job.scene, *camera, resolution));
            next = None;
            let mut picture = last.unwrap_or_else(|| RefinablePicture::new(&job.scene, *camera, resolution));
            let traced = refine(&mut picture, job, samples, token)?;
            next = Some(picture);
            Ok(traced)
        })?;
        // A final picture rests, and is not kept.
        if let Some(picture) = next.filter(|picture| !picture.picture.is_final()) {
            place.keep(picture);
        }
        Ok(frame)
    }
}

/// Traces one map of a frame that has all its samples at once.
fn trace_all(
    Job { scene, shot, sampling, .. }: &Job,
    token: &Cancellation,
    (map, resolution, camera): (Map, Resolution, &Camera),
) -> Result<TracedMap, Cancelled> {
    trace_function(shot)(map, Executor::Cancellable(token), scene, camera, resolution, *sampling)
}

/// Refines a picture up to this number of samples per pixel.
fn refine(
    kept: &mut RefinablePicture,
    Job { scene, shot, sampling, .. }: &Job,
    samples: NonZeroU32,
    token: &Cancellation,
) -> Result<TracedMap, Cancelled> {
    let cost = kept.picture.refine_or_cancel(token, scene, samples)?;
    let mut traced = TracedMap::new(tone(&kept.picture.framebuffer(), scene), cost);
    if shot.geometry {
        let (camera, resolution) = kept.view();
        let geometry = kept.geometry.get_or_insert_with(|| {
            let executor = Executor::Cancellable(token);
            let (geometry, cost) = trace_geometry(executor, scene, &camera, resolution, *sampling);
            traced.cost += cost;
            geometry.into()
        });
        traced = traced.with_geometry(geometry.clone());
    }
    // The geometry of a cancelled job is incomplete and must not be kept.
    if token.is_cancelled() { Err(Cancelled) } else { Ok(traced) }
}

/// Returns the function that traces a shot's maps, with their geometry if the shot needs it.
fn trace_function(shot: &Shot) -> TraceMap {
    if shot.geometry { maps::trace_with_geometry } else { maps::trace }
}

/// A function that traces a map.
type TraceMap = fn(Map, Executor<'_>, &Scene, &Camera, Resolution, Sampling) -> Result<TracedMap, Cancelled>;

/// Returns whether each pixel gets exactly one sample.
fn has_one_sample(sampling: Sampling) -> bool {
    matches!(sampling, Sampling::Each(NonZeroU32::MIN) | Sampling::UpTo(NonZeroU32::MIN))
}

#[cfg(all(test, unit_tests))]
mod tests;
