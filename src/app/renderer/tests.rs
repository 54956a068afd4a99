use super::*;
use crate::camera::{Pose, ViewRectangle};
use crate::render::{Executor, render_by};
use crate::terminal::Signals;
use crate::tone::Picture;
use crate::viewer::ViewLayout;
use glam::Vec3;
use std::time::Duration;

fn three_spheres() -> Scene {
    let text = include_str!("../../../scenes/three_spheres.ron");
    Scene::from_ron("three_spheres.ron", text).expect("the scene is fine")
}

fn shot(camera: Camera, resolution: Resolution) -> Shot {
    Shot {
        scene: 1,
        lights: 0,
        time: Duration::ZERO,
        camera,
        outside: None,
        orders: false,
        resolution,
        layout: ViewLayout::default(),
        geometry: false,
    }
}

fn frame(refines: bool) -> Frame {
    let pose = Pose { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y };
    let rectangle = ViewRectangle::from_vertical_fov(1.0).expect("an angle");
    Frame {
        scene: three_spheres(),
        shot: shot(Camera::new(pose, rectangle).expect("a pose"), Resolution::square(0, 0)),
        picture: Picture::from_pixels(0, 0, Vec::new()).expect("all pixels are there"),
        geometry: None,
        parts: Vec::new(),
        sampling: Sampling::BEST,
        legends: Vec::new(),
        orders: None,
        refines,
        cost: Cost::default(),
        trace: Duration::ZERO,
        interval: Duration::ZERO,
    }
}

/// A cancelled refinement is not shown, even if it finished before it noticed the cancellation.
#[test]
fn a_refinement_given_up_too_late_is_thrown_away() {
    let (done, frames) = channel();
    let work = |refines| PendingJob { refines, token: Cancellation::default() };
    let mut renderer = Renderer {
        jobs: None,
        frames,
        thread: None,
        pending: [work(true), work(false)].into(),
        seconds_per_pixel: None,
    };
    assert_eq!(renderer.tracing(), Some(Tracing::NewView));
    let _ = done.send(Ok(Ok(frame(true))));
    renderer.cancel_refinements();
    assert!(renderer.take_finished().is_none());
    assert!(renderer.tracing().is_some());
    let _ = done.send(Ok(Ok(frame(false))));
    assert!(renderer.take_finished().is_some_and(|frame| !frame.refines));
    assert_eq!(renderer.tracing(), None);
}

/// After a fast frame the loop traces small frames itself, with the same picture as the thread's.
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
    assert!(renderer.start_frame(job(8)).is_none(), "nothing is known of the first");
    let by_the_thread = wait_for(&mut renderer);
    let by_the_loop = renderer.start_frame(job(8)).expect("64 pixels are a small frame");
    assert!(by_the_loop.picture == by_the_thread.picture);
    assert!(renderer.start_frame(job(1000)).is_none(), "a million pixels are not");
    wait_for(&mut renderer);
}

/// A picture of the same scene and view is refined; any other starts with its first sample.
#[test]
fn a_picture_is_gone_on_with_where_it_was_left() {
    let scene = three_spheres();
    let (camera, resolution) = (*scene.camera(), Resolution::square(40, 24));
    let best = render_by(Executor::Pool, &scene, &camera, resolution, Sampling::BEST).expect("it has no token");
    let shown = tone(&best.framebuffer, &scene);
    let tracer = Tracer::new(1);
    let trace_of = |scene: &Scene, camera, sampling, refines| {
        let job = Job { scene: scene.clone(), shot: shot(camera, resolution), sampling, refines };
        tracer.trace(ONLY_VIEWER, &job, &Cancellation::default()).expect("a frame")
    };
    let trace = |camera, sampling, refines| trace_of(&scene, camera, sampling, refines);
    let one = Sampling::UpTo(NonZeroU32::MIN);
    let first = trace(camera, one, false);
    let rest = trace(camera, Sampling::BEST, true);
    assert_eq!(first.cost.rays + rest.cost.rays, best.cost.rays);
    assert!(first.picture != shown && rest.picture == shown);
    // A frame that does not refine starts anew, and so does a refinement of a view whose first frame was not kept.
    assert!(trace(camera, one, false).picture == first.picture);
    let other = camera.with_pose(Pose { eye: camera.pose().eye + Vec3::X, ..camera.pose() }).expect("a pose");
    trace(other, one, false);
    let anew = trace(camera, Sampling::BEST, true);
    assert!(anew.picture == shown && anew.cost.rays == best.cost.rays);
    // The picture of another scene, such as a sketch, is not refined either.
    trace(camera, one, false);
    let anew = trace_of(&three_spheres(), camera, Sampling::BEST, true);
    assert!(anew.picture == shown && anew.cost.rays == best.cost.rays);
}

/// Sampling of the pictures between the first one and the final one.
const BETWEEN: Sampling = Sampling::UpTo(NonZeroU32::new(4).expect("it is not 0"));

/// The bytes that a picture with its samples takes at least, at the size of these tests.
const PICTURE_BYTES: i64 = 60_000;

/// Viewers who look at the spheres from places of their own, and share a tracer.
struct Viewers {
    scene: Scene,
    tracer: Tracer,
}

impl Viewers {
    fn sharing(places: usize) -> Self {
        Self { scene: three_spheres(), tracer: Tracer::new(places) }
    }

    fn job(&self, viewer: ViewerId, sampling: Sampling, refines: bool) -> Job {
        let pose = self.scene.camera().pose();
        let pose = Pose { eye: pose.eye + 0.1 * viewer as f32 * Vec3::X, ..pose };
        let camera = self.scene.camera().with_pose(pose).expect("a pose");
        Job { scene: self.scene.clone(), shot: shot(camera, Resolution::square(40, 24)), sampling, refines }
    }

    fn trace(&self, viewer: ViewerId, sampling: Sampling) -> Frame {
        let job = self.job(viewer, sampling, true);
        self.tracer.trace(viewer, &job, &Cancellation::default()).expect("a frame")
    }

    /// Returns the bytes that the tracer keeps in addition after steps whose frames are dropped.
    fn kept_after(&self, steps: impl FnOnce(&Self)) -> i64 {
        allocation_counter::measure(|| steps(self)).bytes_current
    }
}

/// Calls `test` on a thread that is a rayon pool of its own, so that all memory is counted on it.
fn on_one_thread(test: impl FnOnce() + Send) {
    let pool = ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    pool.install(test);
}

#[test]
fn no_picture_is_kept_at_rest() {
    on_one_thread(|| {
        let viewers = Viewers::sharing(2);
        // The working memory of the thread is not that of a viewer.
        viewers.trace(0, BETWEEN);
        viewers.trace(0, Sampling::BEST);
        let refining = viewers.kept_after(|viewers| drop(viewers.trace(0, BETWEEN)));
        assert!(refining > PICTURE_BYTES, "{refining} bytes between two refinements");
        let final_picture = viewers.kept_after(|viewers| drop(viewers.trace(0, Sampling::BEST)));
        assert_eq!(refining + final_picture, 0, "bytes at rest");
        // Nor is one kept after a refinement that is cancelled.
        let cancelled = Cancellation::default();
        cancelled.cancel();
        let moved = viewers.kept_after(|viewers| {
            viewers.trace(0, BETWEEN);
            let job = viewers.job(0, Sampling::BEST, true);
            assert!(viewers.tracer.trace(0, &job, &cancelled).is_err());
        });
        assert_eq!(moved, 0, "bytes of a cancelled refinement");
    });
}

/// Each of more viewers than places gets its final picture, with the same bits as alone.
#[test]
fn more_viewers_than_places_refine_in_turns() {
    on_one_thread(|| {
        for places in [1, 2, 5] {
            let viewers = Viewers::sharing(places);
            let alone: Vec<_> = (0..5).map(|viewer| viewers.trace(viewer, Sampling::BEST)).collect();
            let mut goes_on = Vec::new();
            let kept = viewers.kept_after(|viewers| {
                let mut kept_by_one = 0;
                for viewer in 0..5 {
                    let more = viewers.kept_after(|viewers| drop(viewers.trace(viewer, BETWEEN)));
                    kept_by_one = kept_by_one.max(more);
                    assert!(more <= if viewer < places as ViewerId { i64::MAX } else { PICTURE_BYTES / 2 });
                }
                assert!(kept_by_one > PICTURE_BYTES, "{kept_by_one} bytes for a picture");
                for (viewer, alone) in (0..).zip(&alone) {
                    let frame = viewers.trace(viewer, Sampling::BEST);
                    assert!(frame.picture == alone.picture, "viewer {viewer} of 5, {places} places");
                    goes_on.push(frame.cost.rays < alone.cost.rays);
                }
            });
            assert!(kept <= 10_000, "{kept} bytes at rest, {places} places");
            // A picture that is traced makes room by the one that waited longest. The first viewers begin anew, so that
            // with two places only the last picture is still there, and with one place none is.
            let expected = match places {
                1 => [false; 5],
                2 => [false, false, false, false, true],
                _ => [true; 5],
            };
            assert_eq!(goes_on, expected, "viewers whose picture was still there, of {places} places");
        }
    });
}

/// A panic while a picture is traced gives its place back.
#[test]
fn a_panic_gives_a_place_back() {
    let refinements = Refinements::new(2);
    let picture = || RefinablePicture::new(&three_spheres(), *three_spheres().camera(), Resolution::square(4, 4));
    let traced = catch_unwind(AssertUnwindSafe(|| {
        let _place = refinements.take_place(0);
        panic!("a test panics");
    }));
    assert!(traced.is_err());
    refinements.take_place(1).0.keep(picture());
    // With a place that was never given back, this one would take that of the kept picture.
    let _place = refinements.take_place(2);
    assert!(refinements.take_place(1).1.is_some(), "it was kept");
}

#[cfg(feature = "serve")]
#[test]
fn a_viewer_who_moves_or_leaves_keeps_no_picture() {
    on_one_thread(|| {
        let viewers = Viewers::sharing(2);
        let (one, never) = (Sampling::UpTo(NonZeroU32::MIN), Cancellation::default());
        let trace_and = |end: &dyn Fn(&Viewers)| {
            viewers.kept_after(|viewers| {
                viewers.tracer.trace_for(3, &viewers.job(3, BETWEEN, true), &never).expect("a frame");
                end(viewers);
            })
        };
        trace_and(&|viewers| viewers.tracer.release(3));
        let moved = trace_and(&|viewers| {
            viewers.tracer.trace_for(3, &viewers.job(4, one, false), &never).expect("a frame");
        });
        assert_eq!(moved, 0);
        assert_eq!(trace_and(&|viewers| viewers.tracer.release(3)), 0);
    });
}

fn wait_for(renderer: &mut Renderer) -> Frame {
    loop {
        if let Some(frame) = renderer.take_finished() {
            return frame;
        }
        thread::yield_now();
    }
}
