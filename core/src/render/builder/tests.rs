use super::*;
use crate::render::render;
use std::num::NonZeroU32;
use std::sync::Mutex;

fn scene() -> Scene {
    let sphere = |x: i32| format!("Sphere(center: ({x}, 0, 0), radius: 0.7)");
    let objects: Vec<_> = (-2..=2).map(sphere).collect();
    let light = "lights: [Point(position: (3, 5, 4), intensity: 20)]";
    let text = format!("(camera: (eye: (0, 1, 6), target: (0, 0, 0)), {light}, objects: [{}])", objects.join(", "));
    Scene::from_ron("row.ron", &text).expect("a scene")
}

fn samplings() -> [Sampling; 5] {
    let samples = |samples| NonZeroU32::new(samples).expect("more than none");
    [Sampling::Coarse, Sampling::Split, Sampling::Each(samples(5)), Sampling::UpTo(samples(1)), Sampling::BEST]
}

#[test]
fn its_light_is_that_of_render_and_its_reports_increase_to_one() {
    let (scene, resolution) = (scene(), Resolution::square(601, 401));
    for sampling in samplings() {
        let reports = Mutex::new(Vec::new());
        let callback = |part| {
            reports.lock().expect("no report panics").push(part);
            ControlFlow::Continue(())
        };
        let picture = Render::new(&scene).resolution(resolution).sampling(sampling).on_progress(callback).run();
        let wanted = render(&scene, scene.camera(), resolution, sampling);
        assert_eq!(picture.expect("nothing cancels it").hash(), wanted.hash(), "{sampling:?}");
        let reports = reports.into_inner().expect("no report panics");
        assert!(reports.len() > 50, "{} reports with {sampling:?}", reports.len());
        assert!(reports.is_sorted_by(|a, b| a < b) && reports[0] > 0.0, "{sampling:?}: {reports:?}");
        assert!(reports.ends_with(&[1.0]) && reports[reports.len() - 2] > 0.9, "{sampling:?}: {reports:?}");
    }
}

#[test]
fn a_break_cancels_the_render_and_ends_the_reports() {
    let (scene, resolution) = (scene(), Resolution::square(400, 300));
    for sampling in samplings() {
        let reports = Mutex::new(0);
        let callback = |_| {
            let mut reports = reports.lock().expect("no report panics");
            *reports += 1;
            if *reports == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let render = Render::new(&scene).resolution(resolution).sampling(sampling).on_progress(callback);
        assert_eq!(render.run(), Err(Cancelled), "{sampling:?}");
        assert_eq!(reports.into_inner().expect("no report panics"), 3, "{sampling:?}");
    }
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_light() {
    let (scene, resolution) = (scene(), Resolution::square(61, 41));
    let wanted = render(&scene, scene.camera(), resolution, Sampling::BEST).hash();
    for threads in [0, 1, 2, 7] {
        let used = Mutex::new(0);
        let callback = |_| {
            *used.lock().expect("no report panics") = rayon::current_num_threads();
            ControlFlow::Continue(())
        };
        let picture = Render::new(&scene).resolution(resolution).threads(threads).on_progress(callback).run();
        assert_eq!(picture.expect("nothing cancels it").hash(), wanted, "{threads}");
        assert_eq!(used.into_inner().expect("no report panics"), threads.max(1));
    }
}

#[test]
fn a_token_cancels_the_render() {
    let (scene, token) = (scene(), Cancellation::default());
    token.cancel();
    assert_eq!(Render::new(&scene).cancelled_by(&token).run(), Err(Cancelled));
    let never = Render::new(&scene).cancelled_by(&token).on_progress(|_| unreachable!("it is cancelled before"));
    assert_eq!(never.run(), Err(Cancelled));
}
