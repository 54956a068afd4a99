//! The export of a large picture, on a thread of its own while the live view goes on.

use super::picture_export;
use super::renderer::frame_of;
use crate::export::{Format, png};
use crate::maps::{self, Map, TracedMap};
use crate::memory;
use crate::progress::{Cancellation, Cancelled};
use crate::render::{Cost, Executor, Render};
use crate::terminal::{self, Waker};
use crate::tone::tone;
use crate::viewer::Job;
use std::any::Any;
use std::io;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Estimated bytes of memory per pixel for a large picture: samples, light, colours and the file.
const BYTES_PER_PIXEL: usize = 160;

/// The name of the written file; `None` if the picture was cancelled.
type Written = io::Result<Option<String>>;

/// A large picture in progress. Dropping it cancels it, and leaves no file.
pub(super) struct LargePicture {
    shared: Arc<SharedPicture>,
    ended: Receiver<Result<Written, Box<dyn Any + Send>>>,
    thread: Option<JoinHandle<()>>,
}

/// The state that the live view's loop shares with the thread that traces the picture.
#[derive(Default)]
struct SharedPicture {
    token: Cancellation,
    /// The percentage of the picture that is done.
    percent: AtomicU32,
    pause: Mutex<Pause>,
    resumed: Condvar,
}

/// A request to the tracing thread to pause while the live view traces a frame of a new view.
#[derive(Default)]
struct Pause {
    is_on: bool,
    /// Time at which [`Shared::throttle_while_paused`] last returned; `None` before the first call.
    ended: Option<Instant>,
}

/// The contents of a large picture, and the place to write it.
pub(super) struct LargePictureJob {
    pub(super) job: Job,
    /// The position of the line between the two maps of a wipe, as a share of the width.
    pub(super) wipe: f32,
    pub(super) folder: PathBuf,
    /// The stem of the picture file's name.
    pub(super) stem: String,
    /// The number of tracing threads of the live view; `None` for one per core.
    pub(super) threads: Option<usize>,
}

impl LargePicture {
    /// Starts to trace a picture.
    ///
    /// `waker` wakes the loop whenever the percentage changes, and at the end.
    ///
    /// # Errors
    /// If there is not enough memory, or no thread can be started.
    pub(super) fn start(picture_job: LargePictureJob, mut waker: Waker) -> io::Result<Self> {
        memory::check(BYTES_PER_PIXEL * picture_job.job.shot.resolution.pixel_count())?;
        let shared = Arc::new(SharedPicture::default());
        let (done, ended) = channel();
        let of_thread = Arc::clone(&shared);
        let for_progress = Mutex::new(waker.try_clone()?);
        let thread = thread::Builder::new().name("large picture".to_owned()).spawn(move || {
            terminal::lower_thread_priority();
            // `ended` resumes a panic of this thread in the event loop, so that the terminal is restored before the
            // message is printed.
            let work = AssertUnwindSafe(|| of_thread.write(&picture_job, &for_progress));
            let _ = done.send(catch_unwind(work));
            waker.wake();
        })?;
        Ok(Self { shared, ended, thread: Some(thread) })
    }

    /// Returns the percentage of the picture that is done.
    pub(super) fn percent(&self) -> u32 {
        self.shared.percent.load(Ordering::Relaxed)
    }

    /// Throttles the tracing thread, or lets it run at full speed.
    ///
    /// While it is throttled, the thread waits up to half of the time, so that the picture is finished even during an
    /// endless motion.
    pub(super) fn set_paused(&self, is_paused: bool) {
        self.shared.pause.lock().unwrap_or_else(PoisonError::into_inner).is_on = is_paused;
        if !is_paused {
            self.shared.resumed.notify_all();
        }
    }

    /// Cancels the picture, which ends within milliseconds.
    pub(super) fn cancel(&self) {
        self.shared.token.cancel();
        // Ends a pause, because a thread that waits in one would notice the cancellation only after it.
        self.set_paused(false);
    }

    /// Returns the outcome if the picture is finished, cancelled or has failed; `None` before.
    ///
    /// # Panics
    /// With the payload of a panic in the thread.
    pub(super) fn ended(&self) -> Option<Written> {
        let ended = self.ended.try_recv().ok()?;
        Some(ended.unwrap_or_else(|panic| resume_unwind(panic)))
    }
}

impl Drop for LargePicture {
    fn drop(&mut self) {
        self.cancel();
        // Waits for the thread, so that no file is written after the live view has ended.
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl SharedPicture {
    fn write(&self, picture_job: &LargePictureJob, waker: &Mutex<Waker>) -> Written {
        let Some(picture) = self.traced(picture_job, waker) else { return Ok(None) };
        let file = png(&picture, 1.0, 1).map_err(io::Error::other)?;
        // Checked before the file is written, but not during the write, which takes only a few milliseconds.
        if self.token.is_cancelled() {
            return Ok(None);
        }
        picture_export::write_new(&picture_job.folder, &picture_job.stem, Format::Png, &file).map(Some)
    }

    /// Traces the picture. Returns `None` if it was cancelled.
    fn traced(&self, picture_job: &LargePictureJob, waker: &Mutex<Waker>) -> Option<crate::tone::Picture> {
        let shot = &picture_job.job.shot;
        let (mut part, parts) = (0, shot.layout.map_sizes(shot.resolution).len());
        let mut frame = frame_of(&picture_job.job, |map, resolution, camera| {
            let report = |share: f32| {
                self.throttle_while_paused();
                self.set_progress((part as f32 + share) / parts as f32, waker);
                ControlFlow::Continue(())
            };
            let scene = &picture_job.job.scene;
            let picture = if map == Map::Shaded {
                let render = Render::new(scene).camera(camera).resolution(resolution);
                let render = render.threads(picture_job.thread_count()).cancelled_by(&self.token).on_progress(report);
                TracedMap::new(tone(&render.run()?, scene), Cost::default())
            } else {
                self.throttle_while_paused();
                // `maps::trace` reports no progress, so the thread can pause only before this call.
                let executor = Executor::Cancellable(&self.token);
                maps::trace(map, executor, scene, camera, resolution, picture_job.job.sampling)?
            };
            part += 1;
            Ok::<_, Cancelled>(picture)
        });
        if let Ok(frame) = &mut frame {
            frame.wipe_to(picture_job.wipe);
        }
        frame.ok().map(|frame| frame.picture)
    }

    /// Waits while the live view traces a frame, at most as long as the thread has worked since its
    /// last pause.
    // During an endless motion the live view traces without a break, and a picture that waited for it to stop would
    // never be finished.
    fn throttle_while_paused(&self) {
        let pause = self.pause.lock().unwrap_or_else(PoisonError::into_inner);
        let worked = pause.ended.map_or(Duration::ZERO, |ended| ended.elapsed());
        let waited = self.resumed.wait_timeout_while(pause, worked, |pause| pause.is_on);
        waited.unwrap_or_else(PoisonError::into_inner).0.ended = Some(Instant::now());
    }

    /// Records the share of the picture that is done, and wakes the loop if the percentage changes.
    fn set_progress(&self, share: f32, waker: &Mutex<Waker>) {
        let percent = (100.0 * share) as u32;
        if self.percent.swap(percent, Ordering::Relaxed) != percent {
            waker.lock().unwrap_or_else(PoisonError::into_inner).wake();
        }
    }
}

impl LargePictureJob {
    /// Returns the number of threads that trace the picture: all but one, left to the live view.
    fn thread_count(&self) -> usize {
        let cores = || thread::available_parallelism().map_or(1, NonZeroUsize::get);
        self.threads.unwrap_or_else(cores).saturating_sub(1).max(1)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
