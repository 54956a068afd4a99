use super::*;
use crate::describe::describe;
use crate::framebuffer::Resolution;
use crate::render::{Sampling, render};
use crate::scene::Scene;
use std::num::NonZeroU32;

/// Returns a scene seen from above, with one pixel per unit and an ambient light of 1.
fn scene(objects: &str) -> String {
    let camera = "camera: (eye: (0, 1, 0), target: (0, 0, 0), up: (0, 0, -1), vertical_fov: 126.86989764584402)";
    format!("({camera}, ambient: 1.0, objects: [{objects}])")
}

#[test]
fn they_are_read_drawn_and_described() {
    let plane = "Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Stripes(a: 0.25, b: \"red\"))";
    let scene = Scene::from_ron("stripes.ron", &scene(plane)).expect("a scene");
    let picture = render(&scene, scene.camera(), Resolution::square(4, 4), Sampling::Each(NonZeroU32::MIN));
    let is_a = |light: &LinearRgb| light.g > 0.2;
    let columns: Vec<_> = picture.pixels()[..4].iter().map(is_a).collect();
    let rows: Vec<_> = picture.pixels().iter().step_by(4).map(is_a).collect();
    let in_turn = |seen: &[bool]| seen.windows(2).all(|pair| pair[0] != pair[1]);
    let alike = |seen: &[bool]| seen.windows(2).all(|pair| pair[0] == pair[1]);
    assert!(in_turn(&columns) && alike(&rows) || in_turn(&rows) && alike(&columns), "{columns:?} {rows:?}");
    let text = describe("stripes.ron", &scene, scene.camera(), Resolution::square(40, 40));
    assert!(text.contains("grey and red striped plane"), "{text}");
}

#[test]
fn their_mean_is_that_of_the_footprint() {
    let stripes = Stripes::new(LinearRgb::grey(1.0), LinearRgb::grey(0.0), 2.0).expect("a pattern");
    for (u, footprint, expected) in
        [(1.0, 0.0, 1.0), (3.0, 0.0, 0.0), (-1.0, 1.0, 0.0), (2.0, 1.0, 0.5), (2.5, 2.0, 0.25), (2.0, 1e9, 0.5)]
    {
        assert_eq!(stripes.reflectance([u, 7.0], [footprint, 3.0]), [expected; 3], "{u} {footprint}");
    }
}

#[test]
fn faults_are_reported_like_those_of_other_materials() {
    let message = |objects: &str| Scene::from_ron("x.ron", &scene(objects)).expect_err("a fault").to_string();
    let on = |shape: &str, stripes: &str| message(&format!("{shape}, material: {stripes})"));
    let plane = "Plane(point: (0, 0, 0), normal: (0, 1, 0)";
    assert!(on(plane, "Stripes(width: 0)").contains("the width of a stripe must be greater than 0"));
    assert!(on(plane, "Stripes(size: 2)").contains("unknown field \"size\"; Stripes has a, b and width"));
    assert!(on(plane, "Stripes(a: 0.5, b: 2)").contains("a reflectance must lie within 0 and 1"));
    assert!(
        on(plane, "Strpes(a: 0.5, b: 1)").contains("did you mean Stripes?"),
        "{}",
        on(plane, "Strpes(a: 0.5, b: 1)")
    );
    let ball = on("Sphere(center: (0, 0, 0), radius: 1", "Stripes(a: 0.5, b: 1)");
    assert!(
        ball.contains(
            "Stripes needs a Plane, a Box, a Disk or a Quad, on which its stripes are laid out; this is a Sphere"
        ),
        "{ball}"
    );
}
