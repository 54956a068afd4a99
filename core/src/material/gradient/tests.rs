use super::*;
use crate::describe::describe;
use crate::framebuffer::Resolution;
use crate::scene::Scene;

/// Returns the text of a scene with a floor of this material.
fn scene(material: &str) -> String {
    let plane = format!("Plane(point: (0, 0, 0), normal: (0, 1, 0), material: {material})");
    format!("(camera: (eye: (0, 5, 0.01), target: (0, 0, 0)), ambient: 1.0, objects: [{plane}])")
}

#[test]
fn it_is_linear_and_repeats_mirrored() {
    let material = Gradient::new(LinearRgb::new(0.0, 0.5, 1.0), LinearRgb::new(1.0, 0.5, 0.0), 2.0).expect("a pattern");
    for (v, share) in [(0.0, 0.0), (0.5, 0.25), (2.0, 1.0), (3.0, 0.5), (4.0, 0.0), (-0.5, 0.25), (-2.0, 1.0)] {
        assert_eq!(material.reflectance([9.0, v], [7.0, 0.0]), [share, 0.5, 1.0 - share], "{v}");
    }
    assert_eq!(material.reflectance([0.0, 0.7], [0.0, 1e9]), [0.5; 3], "the mean of a wide footprint");
}

#[test]
fn it_is_read_and_described() {
    let scene = Scene::from_ron("x.ron", &scene("Gradient(from: \"red\", to: \"blue\")")).expect("a scene");
    let gradient = Gradient::new(LinearRgb::new(1.0, 0.0, 0.0), LinearRgb::new(0.0, 0.0, 1.0), 1.0);
    assert_eq!(scene.objects()[0].material, gradient.expect("a pattern").into());
    let text = describe("x.ron", &scene, scene.camera(), Resolution::square(40, 40));
    assert!(text.contains("an endless red to blue plane"), "{text}");
}

#[test]
fn faults_are_reported_like_those_of_other_materials() {
    let message = |material: &str| Scene::from_ron("x.ron", &scene(material)).expect_err("a fault").to_string();
    assert!(message("Gradient(from: 0.5)").contains("missing field \"to\"; a Gradient needs one"));
    assert!(message("Gradient(from: 0.5, to: 0, length: 0)").contains("length of a gradient must be greater than 0"));
    assert!(message("Gradiant(from: 0.5, to: 0)").contains("did you mean Gradient?"));
}
