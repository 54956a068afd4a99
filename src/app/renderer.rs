//! The thread that traces, so that the loop never waits for a frame. One that takes less time than to wake the thread
//! and to be woken by it is no wait: the loop traces it by itself.

use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::maps::{self, Map, Seen};
use crate::progress::{Cancellation, Cancelled};
use crate::render::{Cost, Crew, Refining, Sampling};
use crate::scene::Scene;
use crate::terminal::{self, Waker};
use crate::tone::tone;
use crate::viewer::{Frame, Job, MIDDLE, Shot, Tracing};
use rayon::ThreadPoolBuilder;
use std::any::Any;
use std::collections::VecDeque;
use std::io;
use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The thread's result: a frame unless it was cancelled, or what it panicked with.
type Traced = Result<Result<Frame, Cancelled>, Box<dyn Any + Send>>;

/// Frames that take no longer are traced by the loop.
const SMALL: Duration = Duration::from_micros(1500);

/// Our side of the thread.
pub(super) struct Renderer {
    jobs: Option<Sender<Order>>,
    frames: Receiver<Traced>,
    thread: Option<JoinHandle<()>>,
    /// In the order in which they will be done.
    in_work: VecDeque<InWork>,
    /// How many seconds a pixel of the last frame of one sample took, all threads together, and what it showed.
    seconds_per_pixel: Option<(Shot, f64)>,
}

/// What is known here of a job.
struct InWork {
    refines: bool,
    token: Cancellation,
}

impl InWork {
    fn is_wanted(&self) -> bool {
        !self.token.is_cancelled()
    }
}

impl Renderer {
    /// Starts the thread, and the pool of those that it shares the tiles with. It is one of them itself: to wake another
    /// and to be woken again takes as long as a small frame.
    pub(super) fn start(threads: Option<usize>, mut waker: Waker) -> io::Result<Self> {
        let (jobs, wanted) = channel::<Order>();
        let (begun, started) = channel();
        let (done, frames) = channel();
        let mut tracer = Tracer::default();
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
            for order in wanted {
                let traced = catch_unwind(AssertUnwindSafe(|| pool.install(|| order(&mut tracer))));
                // The loop may have ended.
                let heard = done.send(traced).is_ok();
                waker.wake();
                if !heard {
                    break;
                }
            }
        })?;
        started.recv().map_err(io::Error::other)??;
        let in_work = VecDeque::new();
        Ok(Self { jobs: Some(jobs), frames, thread: Some(thread), in_work, seconds_per_pixel: None })
    }

    /// What is being traced and still wanted.
    pub(super) fn tracing(&self) -> Option<Tracing> {
        let wanted = self.in_work.iter().filter(|work| work.is_wanted());
        let tracing = wanted.map(|work| if work.refines { Tracing::Refinement } else { Tracing::NewView });
        tracing.min_by_key(|&tracing| tracing == Tracing::Refinement)
    }

    /// Begins a frame, or traces it at once where that takes next to no time.
    pub(super) fn begin(&mut self, job: Job) -> Option<Frame> {
        if self.is_small(&job) {
            // The same light as of one sample at most, without what is kept to go on: that is little to trace again.
            let one = Sampling::Each(NonZeroU32::MIN);
            let see = |map, part| maps::seen(map, Crew::Alone, &job.scene, &job.shot.camera, part, one);
            return frame_of(&job, see).ok().map(|frame| self.noted(frame));
        }
        let work = InWork { refines: job.refines, token: Cancellation::default() };
        let token = work.token.clone();
        self.order(work, move |tracer| tracer.trace(&job, &token));
        None
    }

    fn order(&mut self, work: InWork, order: impl FnOnce(&mut Tracer) -> Result<Frame, Cancelled> + Send + 'static) {
        if let Some(jobs) = &self.jobs
            && jobs.send(Box::new(order)).is_ok()
        {
            self.in_work.push_back(work);
        }
    }

    /// Panics in one of the threads that trace, if a test asks for it.
    pub(super) fn panic_if_asked(&mut self) {
        if terminal::take_worker_panic() {
            let work = InWork { refines: false, token: Cancellation::default() };
            self.order(work, |_| {
                rayon::join(|| {}, || panic!("a test asked for a panic in a worker"));
                Err(Cancelled)
            });
        }
    }

    /// The view has changed: what refines the last one is given up at once.
    pub(super) fn give_up_refining(&self) {
        for work in self.in_work.iter().filter(|work| work.refines) {
            work.token.cancel();
        }
    }

    /// A frame that has been finished since the last call, if one has.
    ///
    /// # Panics
    /// With what the thread panicked with.
    pub(super) fn finished(&mut self) -> Option<Frame> {
        loop {
            let traced = self.frames.try_recv().ok()?;
            let is_wanted = self.in_work.pop_front().is_some_and(|work| work.is_wanted());
            // The message is out already, or kept; the panic goes on here, where the terminal is given back.
            let frame = traced.unwrap_or_else(|panic| resume_unwind(panic));
            // One may have been given up too late to be stopped.
            if let (Ok(frame), true) = (frame, is_wanted) {
                return Some(self.noted(frame));
            }
        }
    }

    /// Whether a frame will take next to no time, going by the last of one sample.
    fn is_small(&self, job: &Job) -> bool {
        let pixels = job.shot.resolution.pixel_count() as f64;
        let is_short = |(shot, seconds): (Shot, f64)| {
            let is_alike = (shot.scene, shot.shown) == (job.shot.scene, job.shot.shown);
            is_alike && seconds * pixels < SMALL.as_secs_f64()
        };
        has_one_sample(job.sampling) && !job.refines && self.seconds_per_pixel.is_some_and(is_short)
    }

    fn noted(&mut self, frame: Frame) -> Frame {
        if has_one_sample(frame.sampling) && !frame.refines {
            let seconds = frame.cost.work.as_secs_f64() / frame.picture.pixels.len() as f64;
            self.seconds_per_pixel = Some((frame.shot, seconds));
        }
        frame
    }
}

impl Drop for Renderer {
    /// The frame in work is given up at its next tile, so that leaving is quick.
    fn drop(&mut self) {
        for work in &self.in_work {
            work.token.cancel();
        }
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// What the thread is sent.
type Order = Box<dyn FnOnce(&mut Tracer) -> Result<Frame, Cancelled> + Send>;

/// Returns what `see` sees of each part of a frame.
fn frame_of(job: &Job, mut see: impl FnMut(Map, Resolution) -> Result<Seen, Cancelled>) -> Result<Frame, Cancelled> {
    let start = Instant::now();
    let Job { scene, shot, sampling, refines } = job.clone();
    let mut cost = Cost::default();
    let mut parts = Vec::new();
    for (map, resolution) in shot.shown.parts(shot.resolution) {
        let seen = see(map, resolution)?;
        cost += seen.cost;
        parts.push(seen.picture);
    }
    let joined = shot.shown.joined(&parts, MIDDLE).or_else(|| parts.pop());
    let picture = joined.expect("at least one picture is shown");
    if !shot.shown.is_wipe() {
        parts.clear();
    }
    let legends = shot.shown.legends(&scene, &shot.camera);
    Ok(Frame { scene, shot, picture, parts, sampling, legends, refines, cost, trace: start.elapsed() })
}

/// The thread's side.
#[derive(Default)]
struct Tracer {
    /// The last picture, if it can be refined.
    kept: Option<Kept>,
}

/// A picture that is gone on with where it is of the wanted scene and view.
struct Kept {
    scene: Scene,
    view: (Camera, Resolution),
    picture: Refining,
}

impl Kept {
    fn new(Job { scene, shot, .. }: &Job, resolution: Resolution) -> Self {
        let picture = Refining::new(&shot.camera, resolution);
        Self { scene: scene.clone(), view: (shot.camera, resolution), picture }
    }

    fn is_of(&self, Job { scene, shot, .. }: &Job, resolution: Resolution) -> bool {
        self.scene.is_copy_of(scene) && self.view == (shot.camera, resolution)
    }
}

impl Tracer {
    fn trace(&mut self, job: &Job, token: &Cancellation) -> Result<Frame, Cancelled> {
        // The last frame may have been traced by the loop, or be of other pictures.
        let mut kept = self.kept.take();
        frame_of(job, |map, resolution| {
            let last = if map.refines() { kept.take() } else { None };
            let last = last.filter(|kept| job.refines && kept.is_of(job, resolution));
            self.seen(job, token, map, resolution, last)
        })
    }

    /// One of a frame's pictures; the light of the scene is gone on with where that can be.
    fn seen(
        &mut self,
        job: &Job,
        token: &Cancellation,
        map: Map,
        resolution: Resolution,
        kept: Option<Kept>,
    ) -> Result<Seen, Cancelled> {
        let Job { scene, shot, .. } = job;
        let samples = match job.sampling {
            Sampling::UpTo(samples) if map.refines() => samples,
            sampling => {
                return maps::seen(map, Crew::Cancellable(token), scene, &shot.camera, resolution, sampling);
            }
        };
        let mut kept = kept.unwrap_or_else(|| Kept::new(job, resolution));
        let cost = kept.picture.refine_or_cancel(token, scene, samples)?;
        let light = self.kept.insert(kept).picture.framebuffer();
        Ok(Seen { picture: tone(&light, scene), cost })
    }
}

/// Whether each pixel has just one.
fn has_one_sample(sampling: Sampling) -> bool {
    matches!(sampling, Sampling::Each(NonZeroU32::MIN) | Sampling::UpTo(NonZeroU32::MIN))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Pose, ViewRectangle};
    use crate::render::{Crew, render_by};
    use crate::terminal::Signals;
    use crate::tone::Picture;
    use crate::viewer::Shown;
    use glam::Vec3;

    fn three_spheres() -> Scene {
        let text = include_str!("../../scenes/three_spheres.ron");
        Scene::from_ron("three_spheres.ron", text).expect("the scene is fine")
    }

    fn shot(camera: Camera, resolution: Resolution) -> Shot {
        Shot { scene: 1, lights: 0, camera, resolution, shown: Shown::default() }
    }

    fn frame(refines: bool) -> Frame {
        let pose = Pose { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y };
        let rectangle = ViewRectangle::from_vertical_fov(1.0).expect("an angle");
        Frame {
            scene: three_spheres(),
            shot: shot(Camera::new(pose, rectangle).expect("a pose"), Resolution::square(0, 0)),
            picture: Picture { width: 0, height: 0, pixels: Vec::new() },
            parts: Vec::new(),
            sampling: Sampling::BEST,
            legends: Vec::new(),
            refines,
            cost: Cost::default(),
            trace: Duration::ZERO,
        }
    }

    /// What refines a view that has changed since is not shown, even if it was finished before it heard of it.
    #[test]
    fn a_refinement_given_up_too_late_is_thrown_away() {
        let (done, frames) = channel();
        let work = |refines| InWork { refines, token: Cancellation::default() };
        let mut renderer = Renderer {
            jobs: None,
            frames,
            thread: None,
            in_work: [work(true), work(false)].into(),
            seconds_per_pixel: None,
        };
        assert_eq!(renderer.tracing(), Some(Tracing::NewView));
        let _ = done.send(Ok(Ok(frame(true))));
        renderer.give_up_refining();
        assert!(renderer.finished().is_none());
        assert!(renderer.tracing().is_some());
        let _ = done.send(Ok(Ok(frame(false))));
        assert!(renderer.finished().is_some_and(|frame| !frame.refines));
        assert_eq!(renderer.tracing(), None);
    }

    /// The loop traces what its last frames were small for, and the same picture as the thread does.
    #[test]
    fn small_frames_are_done_at_once() {
        let scene = three_spheres();
        let camera = *scene.camera();
        let waker = Signals::catch().and_then(|signals| signals.waker()).expect("pipes can be made");
        let mut renderer = Renderer::start(Some(2), waker).expect("threads can be started");
        let job = |side| Job {
            scene: scene.clone(),
            shot: shot(camera, Resolution::square(side, side)),
            sampling: Sampling::UpTo(NonZeroU32::MIN),
            refines: false,
        };
        assert!(renderer.begin(job(8)).is_none(), "nothing is known of the first");
        let by_the_thread = wait_for(&mut renderer);
        let by_the_loop = renderer.begin(job(8)).expect("64 pixels are a small frame");
        assert!(by_the_loop.picture == by_the_thread.picture);
        assert!(renderer.begin(job(1000)).is_none(), "a million pixels are not");
        wait_for(&mut renderer);
    }

    /// What was traced already is not traced again; what is of another view is.
    #[test]
    fn a_picture_is_gone_on_with_where_it_was_left() {
        let scene = three_spheres();
        let (camera, resolution) = (*scene.camera(), Resolution::square(40, 24));
        let best = render_by(Crew::Pool, &scene, &camera, resolution, Sampling::BEST).expect("it has no token");
        let shown = tone(&best.framebuffer, &scene);
        let mut tracer = Tracer::default();
        let mut trace_of = |scene: &Scene, camera, sampling, refines| {
            let job = Job { scene: scene.clone(), shot: shot(camera, resolution), sampling, refines };
            tracer.trace(&job, &Cancellation::default()).expect("a frame")
        };
        let mut trace = |camera, sampling, refines| trace_of(&scene, camera, sampling, refines);
        let one = Sampling::UpTo(NonZeroU32::MIN);
        let first = trace(camera, one, false);
        let rest = trace(camera, Sampling::BEST, true);
        assert_eq!(first.cost.rays + rest.cost.rays, best.cost.rays);
        assert!(first.picture != shown && rest.picture == shown);
        // A new view begins anew, even one as before; so does one whose first frame another has traced.
        assert!(trace(camera, one, false).picture == first.picture);
        let other = camera.with_pose(Pose { eye: camera.pose().eye + Vec3::X, ..camera.pose() }).expect("a pose");
        trace(other, one, false);
        let anew = trace(camera, Sampling::BEST, true);
        assert!(anew.picture == shown && anew.cost.rays == best.cost.rays);
        // And of another scene: that of a sketch is not gone on with.
        trace(camera, one, false);
        let anew = trace_of(&three_spheres(), camera, Sampling::BEST, true);
        assert!(anew.picture == shown && anew.cost.rays == best.cost.rays);
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
