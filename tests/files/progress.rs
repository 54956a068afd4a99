//! Progress of loading a mesh into a scene: reports, and a cancel after any of them.

use crate::mesh_writers::{WRITERS, ball, written};
use std::fs;
use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use termtrace::internals::mesh_file::MeshFile;
use termtrace::internals::progress::{Cancellation, Reporter, Unfinished};
use termtrace::internals::scene::Draft;
use termtrace::internals::scene_file::SceneFile;
use termtrace::internals::scene_text::{Faults, parse};
use termtrace::{Progress, Resolution, Scene, Srgb8, Work, render, tone};

/// Returns a ball of `triangles` triangles that was read from a file.
fn read(triangles: u32) -> MeshFile {
    let bytes = written(&ball(triangles), "binary.stl");
    MeshFile::from_bytes("ball.stl", &bytes, &mut |_| unreachable!("it names no file")).expect("it is a mesh")
}

/// Returns the reports of a reader that cancels after `most` of them, and the result of the work.
fn heard<T>(most: usize, work: impl FnOnce(&Reporter<'_>) -> T) -> (Vec<Progress>, T) {
    let heard = Mutex::new(Vec::new());
    let on_progress = |progress| {
        let mut heard = heard.lock().expect("no holder of this lock panics");
        heard.push(progress);
        if heard.len() < most { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let done = work(&Reporter::new(&on_progress));
    (heard.into_inner().expect("no holder of this lock panics"), done)
}

/// Returns the result, or `None` if the work was cancelled.
#[track_caller]
fn unless_cancelled<T, E: std::fmt::Debug>(done: Result<T, Unfinished<E>>) -> Option<T> {
    match done {
        Ok(done) => Some(done),
        Err(Unfinished::Cancelled) => None,
        Err(Unfinished::Failed(error)) => panic!("{error:?}"),
    }
}

/// Each format reports its progress from start to end, and can be cancelled after any report.
#[test]
fn reading_reports_progress_and_can_be_cancelled() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let mesh = ball(30_000);
    for writer in WRITERS {
        let path = folder.path().join(writer.name);
        let size = written(&mesh, writer.name).len();
        fs::write(&path, written(&mesh, writer.name)).expect("a file can be written");
        let load = |reporter: &Reporter<'_>| unless_cancelled(MeshFile::load_or_cancel(&path, reporter));
        let (reports, read) = heard(usize::MAX, load);
        assert_eq!(read, Some(MeshFile::load(&path).expect("it is a mesh")), "{}", writer.name);
        assert_steps(&reports, &Work::Reading(path.to_string_lossy().into()), 1 << 20, size);
        let parsing = Work::Parsing(path.to_string_lossy().into());
        // The parts of the file are read in any order.
        if writer.name == "x.glb" {
            assert!(reports.iter().any(|report| report.work == parsing && report.total == 0));
        } else {
            assert_steps(&reports, &parsing, 256 << 10, size);
        }
        for most in 1..=reports.len() {
            let (reports, read) = heard(most, load);
            assert_eq!((reports.len(), read), (most, None), "{}", writer.name);
        }
    }
}

/// Asserts that the reports of this work go up to its end in steps of about that size.
#[track_caller]
fn assert_steps(reports: &[Progress], work: &Work, step: usize, total: usize) {
    let steps: Vec<usize> = reports.iter().filter(|report| report.work == *work).map(|report| report.done).collect();
    assert!(reports.iter().all(|report| report.work != *work || report.total == total), "{work:?}");
    assert!(steps.is_sorted() && steps.first().is_some_and(|&first| first < step), "{work:?} {steps:?}");
    assert!(steps.last().is_some_and(|&last| last + step + 100 >= total && last <= total), "{work:?} {steps:?}");
    assert!(steps.windows(2).all(|pair| pair[1] - pair[0] <= step + 100), "{work:?} {steps:?}");
}

/// Meshes that a scene names report progress as one alone does.
#[test]
fn reading_the_meshes_of_a_scene_reports_progress() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fs::write(folder.path().join("ball.stl"), written(&ball(20_000), "binary.stl")).expect("a file can be written");
    let scene = folder.path().join("scene.ron");
    let text = r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Mesh(path: "ball.stl")])"#;
    fs::write(&scene, text).expect("a file can be written");
    let load = |reporter: &Reporter<'_>| unless_cancelled(Draft::load(&scene, reporter));
    let (reports, draft) = heard(usize::MAX, load);
    assert!(draft.map(Draft::finish) == Some(Scene::load(&scene).expect("it is a scene")), "the same scene");
    assert!(reports.iter().any(|report| matches!(&report.work, Work::Parsing(name) if name.ends_with("ball.stl"))));
    for most in 1..=reports.len() {
        assert!(heard(most, load).1.is_none(), "given up after {most}");
    }
}

/// Returns the text of a scene of `count` balls.
fn balls(count: usize) -> String {
    let balls = "Sphere(center: (1, 2, 3), radius: 0.5),\n".repeat(count);
    format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [{balls}])")
}

#[test]
fn reading_scene_text_reports_progress_and_can_be_cancelled() {
    let text = balls(30_000);
    let load = |reporter: &Reporter<'_>| unless_cancelled(Draft::from_bytes("x.ron", text.as_bytes(), reporter));
    let (reports, draft) = heard(usize::MAX, load);
    assert!(draft.is_some_and(|draft| draft.finish().objects().len() == 30_000));
    assert_steps(&reports, &Work::Parsing("x.ron".to_owned()), 256 << 10, text.len());
    for most in 1..=reports.len() {
        let (heard, draft) = heard(most, load);
        assert_eq!((heard.len(), draft.is_none()), (most, true));
    }
}

/// The steps behind the syntax tree can be cancelled, too.
#[test]
fn checking_objects_can_be_cancelled() {
    let cancelled = Cancellation::default();
    let on_progress = |_| ControlFlow::Continue(());
    let reporter = Reporter::new(&on_progress).cancelled_by(&cancelled);
    let (text, mut faults) = (balls(10), Faults::default());
    let root = parse(&text).expect("it is RON");
    assert_eq!(SceneFile::read(&root, &reporter, &mut faults).objects.len(), 10);
    cancelled.cancel();
    assert_eq!(SceneFile::read(&root, &reporter, &mut faults).objects.len(), 0);
    // The cancel comes while the objects are checked, at the first mesh.
    let cancelled = Cancellation::default();
    let needed = Mutex::new(0);
    let on_dependency = |_: &Path| {
        *needed.lock().expect("no holder of this lock panics") += 1;
        cancelled.cancel();
    };
    let reporter = Reporter::new(&on_progress).with_dependencies(&on_dependency).cancelled_by(&cancelled);
    let text = r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Mesh(path: "a.obj"), Mesh(path: "b.obj")])"#;
    assert!(matches!(Draft::from_bytes("x.ron", text.as_bytes(), &reporter), Err(Unfinished::Cancelled)));
    assert_eq!(needed.into_inner().expect("no holder of this lock panics"), 1, "meshes");
}

#[test]
fn building_reports_progress_and_can_be_cancelled() {
    let draft = Draft::of_mesh(read(100_000)).expect("it has a size");
    let build = |reporter: &Reporter<'_>| draft.clone().build_or_cancel(reporter).ok();
    let (reports, scene) = heard(usize::MAX, build);
    let total = scene.as_ref().map_or(0, |scene| scene.objects()[0].shape.primitive_count() as usize);
    assert!(scene == Some(draft.clone().finish()), "the same scene");
    assert!(reports.iter().all(|report| report.work == Work::Building && report.total == total));
    assert!(reports.iter().all(|report| report.done <= total) && reports.iter().any(|report| report.done == total));
    for most in [1, 2, reports.len() / 2] {
        assert!(heard(most, build).1.is_none(), "given up after {most}");
    }
}

/// A scene that is built as fast has no sketch.
#[test]
fn a_sketch_looks_like_the_scene() {
    assert!(Draft::of_mesh(read(50_000)).expect("it has a size").sketch().is_none());
    let draft = Draft::of_mesh(read(150_000)).expect("it has a size");
    let sketch = draft.sketch().expect("it is big");
    let count = sketch.objects()[0].shape.primitive_count();
    assert!((10_000..60_000).contains(&count), "{count} triangles");
    assert_eq!(sketch.camera(), draft.camera());
    let pixels = |scene: &Scene| {
        tone(&render(scene, scene.camera(), Resolution::square(80, 48), NonZeroU32::MIN), scene).pixels().to_vec()
    };
    let (coarse, fine) = (pixels(&sketch), pixels(&draft.finish()));
    let is_near = |(a, b): &(&Srgb8, &Srgb8)| a.g.abs_diff(b.g) < 24;
    let near = coarse.iter().zip(&fine).filter(is_near).count();
    assert!(near * 100 > coarse.len() * 92, "{near} of {} pixels", coarse.len());
}
