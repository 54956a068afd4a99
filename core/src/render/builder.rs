//! The builder of a render.

use super::report::TileReport;
use super::{Executor, Sampling, progress_units, render_partial};
use crate::camera::Camera;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::progress::{Cancellation, Cancelled};
use crate::scene::Scene;
use crate::threads;
use std::fmt;
use std::ops::ControlFlow;

/// A callback for progress reports, which gets the fraction of the work that is done, from 0 to 1.
type ProgressCallback<'a> = Box<dyn Fn(f32) -> ControlFlow<()> + Send + Sync + 'a>;

/// A builder of a picture of a scene.
///
/// The defaults are the scene's own camera, 1280x720 pixels, [`Sampling::BEST`], and the threads of the current rayon
/// pool.
///
/// ```
/// use std::ops::ControlFlow;
/// use termtrace::{Render, Resolution, Sampling, Scene};
///
/// let scene = Scene::from_ron("ball.ron", "(
///     camera: (eye: (0, 0, 5), target: (0, 0, 0)),
///     ambient: 1,
///     objects: [Sphere(center: (0, 0, 0), radius: 1)],
/// )")?;
/// let picture = Render::new(&scene)
///     .resolution(Resolution::new(40, 30)?)
///     .sampling(Sampling::BEST)
///     .on_progress(|share| {
///         eprint!("\r{:3.0} %", 100.0 * share);
///         ControlFlow::Continue(())
///     })
///     .run()?;
/// assert_eq!(picture.pixels().len(), 1200);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use = "nothing is rendered before `run`"]
pub struct Render<'a> {
    scene: &'a Scene,
    camera: Camera,
    resolution: Resolution,
    sampling: Sampling,
    threads: Option<usize>,
    token: Cancellation,
    callback: Option<ProgressCallback<'a>>,
}

impl fmt::Debug for Render<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { camera, resolution, sampling, .. } = self;
        let mut render = f.debug_struct("Render");
        render
            .field("camera", camera)
            .field("resolution", resolution)
            .field("sampling", sampling)
            .finish_non_exhaustive()
    }
}

impl<'a> Render<'a> {
    /// The largest number of [threads](Self::threads).
    #[doc(hidden)]
    pub const MAX_THREADS: usize = 1024;

    /// Returns a builder of a picture of `scene`, with the default camera, size and sampling.
    pub fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            camera: *scene.camera(),
            resolution: Resolution::square(1280, 720),
            sampling: Sampling::BEST,
            threads: None,
            token: Cancellation::default(),
            callback: None,
        }
    }

    /// Sets the camera.
    pub fn camera(self, camera: &Camera) -> Self {
        Self { camera: *camera, ..self }
    }

    /// Sets the size of the picture.
    pub fn resolution(self, resolution: Resolution) -> Self {
        Self { resolution, ..self }
    }

    /// Sets the sampling.
    pub fn sampling(self, sampling: impl Into<Sampling>) -> Self {
        Self { sampling: sampling.into(), ..self }
    }

    /// Sets the number of threads, clamped to between 1 and 1,024.
    ///
    /// The picture is the same for any number. Without the feature `parallel` only the calling thread traces.
    pub fn threads(self, count: usize) -> Self {
        Self { threads: Some(count.clamp(1, Self::MAX_THREADS)), ..self }
    }

    /// Sets a token that cancels the render, which then ends after at most 256 eye rays.
    ///
    /// Each thread finishes the rays of its batch, with those that mirrors and glass make of them.
    #[doc(hidden)]
    pub fn cancelled_by(self, token: &Cancellation) -> Self {
        Self { token: token.clone(), ..self }
    }

    /// Sets a callback for progress reports, which cancels the render by returning `Break`.
    ///
    /// The callback gets the share of the work done: positive, increasing, and 1 at the end. Calls come one at a time,
    /// from any of the threads, about every 10 ms. A thread that has progress to report meanwhile waits for the call to
    /// return.
    pub fn on_progress(self, callback: impl Fn(f32) -> ControlFlow<()> + Send + Sync + 'a) -> Self {
        Self { callback: Some(Box::new(callback)), ..self }
    }

    /// Renders the picture, with the same bits for any number of threads.
    ///
    /// # Errors
    /// [`Cancelled`], if the token is cancelled or the callback returns `Break` before the last report.
    pub fn run(self) -> Result<Framebuffer, Cancelled> {
        match self.threads {
            Some(count) => threads::in_pool_of(count, || self.run_in_current_pool()),
            None => self.run_in_current_pool(),
        }
    }

    /// Renders on the threads of the current rayon pool.
    fn run_in_current_pool(self) -> Result<Framebuffer, Cancelled> {
        let Self { scene, camera, resolution, sampling, threads: _, token, callback } = self;
        let render = |executor: Executor<'_>| {
            executor.unless_cancelled(render_partial(executor, scene, &camera, resolution, sampling).framebuffer)
        };
        let Some(callback) = callback else {
            return render(Executor::Cancellable(&token));
        };
        let report = TileReport::new(&callback, token, progress_units(resolution, sampling));
        let framebuffer = render(Executor::Reporting(&report))?;
        // The picture is complete, so a `Break` is ignored here.
        let _ = callback(1.0);
        Ok(framebuffer)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
