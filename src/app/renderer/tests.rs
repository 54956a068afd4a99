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

fn wait_for(renderer: &mut Renderer) -> Frame {
    loop {
        if let Some(frame) = renderer.take_finished() {
            return frame;
        }
        thread::yield_now();
    }
}
