//! Meshes that the animation of their file moves.
//!
//! `s4_parts.gltf` has three unit squares. One stands still at x from -3 to -2. One makes a quarter turn about its corner
//! at the origin within two seconds, and carries the third, which rises from y = 0 to 2 in its coordinates.

use super::goldens::folder;
use std::fs;
use termtrace::glam::{BVec3, Vec3};
use termtrace::internals::hit::closest_hit;
use termtrace::internals::mesh_file::MeshFile;
use termtrace::internals::ray::Ray;
use termtrace::{Scene, Size, text_frame};

fn load(name: &str) -> Scene {
    Scene::load(&folder("tests/odd_meshes").join(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the t at which a ray from (0, 1, 9) to a point hits a mesh, which is before the floor.
fn hit(scene: &Scene, target: Vec3) -> Option<f32> {
    let origin = Vec3::new(0.0, 1.0, 9.0);
    let hit = closest_hit(scene, &Ray { origin, direction: target - origin })?;
    ((hit.object as usize) + 1 < scene.objects().len()).then_some(hit.t)
}

/// Returns the points of a grid around the squares, none of them on an edge of a square at rest.
fn grid() -> impl Iterator<Item = Vec3> {
    (0..60).flat_map(|x| (0..50).map(move |y| Vec3::new(-3.97 + 0.13 * x as f32, 0.013 + 0.07 * y as f32, 0.0)))
}

#[test]
fn an_animation_has_a_frame_for_each_time() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots/motion");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let scene = load("s4_parts.gltf");
    assert!(scene.depends_on_time());
    for (name, seconds) in [("parts_at_0_s", 0.0), ("parts_at_1_s", 1.0)] {
        let frame = text_frame(&scene.clone().at_time(seconds), Size::new(60, 20));
        // Readers of goldens may drop blanks at the end of a line, which count here.
        let framed: Vec<_> = frame.lines().map(|row| format!("|{row}|")).collect();
        settings.bind(|| insta::assert_snapshot!(name, framed.join("\n")));
        // It starts again after two seconds.
        assert_eq!(text_frame(&scene.clone().at_time(seconds + 4.0), Size::new(60, 20)), frame);
    }
}

#[test]
fn moved_parts_are_hit_where_nodes_in_their_place_are() {
    let scene = load("s4_parts.gltf");
    let text = fs::read_to_string(folder("tests/odd_meshes/s4_parts.gltf")).expect("a file");
    // The sine and cosine of half the angle of an eighth of a turn.
    let [sine, cosine] = [0.5 - 0.125_f64.sqrt(), 0.5 + 0.125_f64.sqrt()].map(f64::sqrt);
    let nodes = |turn: &str, height: u32| {
        format!("{{\"mesh\": 0, \"children\": [1]{turn}}}, {{\"mesh\": 0, \"translation\": [1, {height}, 0]}}")
    };
    let at_rest = nodes("", 0);
    assert!(text.contains(&at_rest));
    let turned = nodes(&format!(", \"rotation\": [0, 0, {sine}, {cosine}]"), 1);
    for (seconds, nodes) in [(0.0, &at_rest), (1.0, &turned)] {
        let posed = text.replace(&at_rest, nodes).replace("\"animations\"", "\"extras\"");
        let posed = MeshFile::from_bytes("x.gltf", posed.as_bytes(), &mut |_| unreachable!()).expect("a mesh");
        assert!(!posed.moves());
        let posed = Scene::of_mesh(posed).expect("a scene");
        let moved = scene.clone().at_time(seconds);
        let (mut hits, mut differing) = (0, 0);
        for target in grid() {
            let [one, other] = [&posed, &moved].map(|scene| hit(scene, target));
            hits += u32::from(one.is_some());
            match (one, other) {
                (Some(one), Some(other)) => assert!((one - other).abs() < 1e-5, "{one} {other}"),
                (one, other) => differing += u32::from(one != other),
            }
        }
        assert!(hits > 250, "{hits}");
        // Rays to an edge may pass on either side.
        assert!(differing <= 2, "{differing} of {hits} at {seconds}");
    }
}

#[test]
fn a_part_of_scale_zero_is_nowhere() {
    for (name, seen) in [("s4_vanish.gltf", [true, false]), ("s4_appear.gltf", [false, true])] {
        for (seconds, is_seen) in [(0.5, seen[0]), (1.5, seen[1])] {
            let scene = load(name).at_time(seconds);
            assert_eq!(hit(&scene, Vec3::new(0.4, 0.3, 0.0)).is_some(), is_seen, "{name} at {seconds}");
            assert_eq!(scene.bounds().is_some(), is_seen, "{name} at {seconds}");
        }
    }
}

/// Of a mesh that moves far away, the first view frames the start.
#[test]
fn the_first_view_frames_the_whole_animation() {
    let tangent = 0.364; // of half the field of view
    for name in ["s4_rise.gltf", "s4_parts.gltf", "s4_step.gltf"] {
        let scene = load(name);
        let (pose, basis) = (scene.camera().pose(), scene.camera().basis());
        let is_inside = |corner: Vec3| {
            let from_eye = corner - pose.eye;
            let at = |axis: Vec3| from_eye.dot(axis) / -from_eye.dot(basis.w);
            at(basis.u).abs() < tangent * 4.0 / 3.0 && at(basis.v).abs() < tangent
        };
        let corners = |seconds: f64| {
            let bounds = scene.clone().at_time(seconds).bounds().expect("a mesh");
            (0..8).map(move |i| Vec3::select(BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), bounds.min, bounds.max))
        };
        assert!((0..16).flat_map(|step| corners(f64::from(step) / 8.0)).all(is_inside), "{name}");
    }
    // Of a mesh that leaves for a place a thousand times its size away, it is the start.
    let text = fs::read_to_string(folder("tests/odd_meshes/s4_rise.gltf")).expect("a file");
    let far =
        text.replacen("\"nodes\": [{\"mesh\": 0}]", "\"nodes\": [{\"mesh\": 0, \"scale\": [0.001, 0.001, 0.001]}]", 1);
    assert_ne!(far, text);
    let far = MeshFile::from_bytes("x.gltf", far.as_bytes(), &mut |_| unreachable!()).expect("a mesh");
    let eye = Scene::of_mesh(far).expect("a scene").camera().pose().eye;
    assert!(eye.length() < 0.01, "{eye}");
}

#[test]
fn a_moving_mesh_is_placed_in_a_scene() {
    let path = folder("tests/odd_meshes/x.ron");
    let scene = |objects: &str| {
        let text = format!("(camera: (eye: (0, 1, 9), target: (0, 1, 0)), objects: [{objects}])");
        Scene::from_ron(&path.to_string_lossy(), &text).unwrap_or_else(|error| panic!("{error}"))
    };
    // Twice as large, upside down, to the right of where it was, and a copy 10 further.
    let moving = scene(
        "Mesh(path: \"s4_rise.gltf\", scale: 2, rotate: (0, 0, 180), translate: (1, 0, 0), \
         copies: (count: (2, 1, 1), step: (10, 0, 0)))",
    );
    assert_eq!(moving.objects().len(), 2);
    let bounds = |seconds| moving.clone().at_time(seconds).bounds().expect("two squares");
    let near = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-5, "{a} {b}");
    near(bounds(0.0).min, Vec3::new(-1.0, -2.0, 0.0));
    near(bounds(0.0).max, Vec3::new(11.0, 0.0, 0.0));
    // It rises by 2 within a second, and so sinks by 4.
    near(bounds(1.0).min, Vec3::new(-1.0, -6.0, 0.0));
    near(bounds(1.0).max, Vec3::new(11.0, -4.0, 0.0));
    let parts = scene("Mesh(path: \"s4_parts.gltf\", material: Diffuse(\"red\"))");
    assert_eq!(parts.objects().len(), 3);
    near(parts.at_time(1.0).bounds().expect("squares").min, Vec3::new(-3.0, 0.0, 0.0));
}
