//! The descriptions of scenes: goldens, and the words that must change with a scene.

use std::path::Path;
use termtrace::{Resolution, Scene, describe};

const PICTURE: Resolution = Resolution::square(160, 96);

fn told(scene: &Scene) -> String {
    describe("scene", scene, scene.camera(), PICTURE)
}

fn told_of(text: &str) -> String {
    told(&Scene::from_ron("scene.ron", text).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn shipped_scenes_are_described_as_in_their_goldens() {
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_snapshot_path("../snapshots/described");
    for name in ["three_spheres", "many_spheres", "inside_sphere", "teapots", "three_lights"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.ron"));
        let scene = Scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let text = told(&scene);
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
        assert_eq!(one.install(|| told(&scene)), text, "{name}: on one thread");
        settings.bind(|| insta::assert_snapshot!(name, text));
    }
}

/// Returns a scene with a ball at that position, before an eye on the z axis.
fn ball_at(place: &str) -> String {
    told_of(&format!(
        "(camera: (eye: (0, 0, 10), target: (0, 0, 0)),
          objects: [Sphere(center: {place}, radius: 0.5, material: Diffuse(\"red\"))])"
    ))
}

#[test]
fn positions_are_described_as_seen_in_the_picture() {
    for (place, words) in [
        ("(0, 0, 0)", "in the middle"),
        ("(-4, 0, 0)", "on the left"),
        ("(4, 3, 0)", "upper right"),
        ("(-4, -3, 0)", "lower left"),
        ("(0, -3, 0)", "at the bottom"),
        ("(0, 0, 9.9)", "all over the picture"),
        ("(0, 0, 20)", "behind the eye"),
        ("(30, 0, 0)", "to the right of the picture"),
        ("(0, -30, 0)", "below the picture"),
    ] {
        let text = ball_at(place);
        assert!(text.contains(words) && text.contains("a red sphere of radius 0.5"), "{place}: {text}");
    }
}

#[test]
fn a_finish_follows_the_colour_and_its_article() {
    for (look, words) in [
        ("material: Diffuse(\"#fa8c1e\")", "object 1, an orange sphere of radius 1"),
        ("material: Diffuse(\"red\"), finish: Polished", "object 1, a red polished sphere of radius 1"),
        ("material: Diffuse(\"#fa8c1e\"), finish: Glowing", "object 1, an orange glowing sphere of radius 1"),
    ] {
        let text = told_of(&format!(
            "(camera: (eye: (0, 0, 10), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1, {look})])"
        ));
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn an_occlusion_is_described_for_both_objects() {
    let text = told_of(
        "(camera: (eye: (0, 0, 10), target: (0, 0, 0)), objects: [
            Sphere(center: (0.7, 0, 0), radius: 1, material: Diffuse(\"blue\")),
            Sphere(center: (0, 0, 3), radius: 0.6, material: Diffuse(\"yellow\")),
            Sphere(center: (0, 0, -3), radius: 0.1),
            Plane(point: (0, -1, 0), normal: (0, 1, 0)),
        ])",
    );
    let line = |start: &str| text.lines().find(|line| line.contains(start)).unwrap_or_else(|| panic!("{text}"));
    assert!(line("object 2, a yellow").contains("in front of object 1"), "{text}");
    assert!(line("object 1, a blue").contains("partly behind object 2"), "{text}");
    assert!(line("object 3, ").contains("hidden behind object 2"), "{text}");
    assert!(!line("object 4, ").contains("behind"), "all stand before the floor: {text}");
    let text =
        told_of("(camera: (eye: (0, 0, 1), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 3)])");
    assert!(text.contains("all over the picture") && text.contains("the eye is inside it"), "{text}");
}

#[test]
fn lights_come_from_where_the_viewer_sees_them() {
    let text = told_of(
        "(camera: (eye: (0, 0, 10), target: (0, 0, 0)), shadows: false, lights: [
            Point(position: (-10, 10, 0), color: \"#ff2010\", intensity: 10),
            Point(position: (0, 0, -5), intensity: 100),
        ])",
    );
    let lines: Vec<_> = text.lines().skip_while(|line| !line.starts_with("Lights")).collect();
    assert_eq!(lines[1], "- white, from the far side, 5 from the target", "{text}");
    assert!(lines[2].starts_with("- red, from above and the left, 14.1"), "{text}");
    assert_eq!(lines[3], "Nothing casts a shadow.");
}

/// The text of any scene is short enough to be read aloud.
#[test]
fn large_scenes_are_summarised() {
    let ball = |at: usize| {
        let (x, y) = (at % 20, at / 20);
        format!("Sphere(center: ({}, {}, 0), radius: 0.2),", x as f32 * 0.5 - 5.0, y as f32 * 0.5 - 2.5)
    };
    let balls: String = (0..200).map(ball).collect();
    let text = told_of(&format!("(camera: (eye: (0, 0, 16), target: (0, 0, 0)), objects: [{balls}])"));
    assert!(text.lines().count() < 20, "{text}");
    assert!(text.contains("200 objects") && text.contains("- and 190 spheres more"), "{text}");
}
