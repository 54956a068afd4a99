use super::*;
use crate::describe::describe;
use crate::explain::explain;
use crate::framebuffer::Resolution;
use crate::light::Light;
use crate::render::{Sampling, render};
use crate::scene::Scene;

/// Returns the text of a scene: a floor seen from above, a sun, and other objects.
fn scene(sun: &str, objects: &str) -> String {
    let camera = "camera: (eye: (0, 5, 0.01), target: (0, 0, 0))";
    let floor = "Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Diffuse(0.5))";
    format!("({camera}, lights: [{sun}], objects: [{floor}, {objects}])")
}

fn read(sun: &str, objects: &str) -> Scene {
    Scene::from_ron("sun.ron", &scene(sun, objects)).expect("a scene")
}

/// Checks that a sun lights the floor by 0.5 (reflectance) times 0.8 (cosine), or 0 in the shadow.
#[test]
fn its_light_is_that_of_the_closed_form() {
    let resolution = Resolution::square(9, 9);
    for (objects, wanted) in [("", 0.4), ("Sphere(center: (3000, 4000, 0), radius: 100)", 0.0)] {
        let scene = read("Sun(direction: (3, 4, 0))", objects);
        let picture = render(&scene, scene.camera(), resolution, Sampling::BEST);
        assert!(picture.pixels().iter().all(|light| (light.r - wanted).abs() < 1e-6), "{objects}: {picture:?}");
    }
}

#[test]
fn its_colour_is_multiplied_by_its_intensity() {
    let scene = read("Sun(direction: (0, 2, 0), color: (1, 0.5, 0), intensity: 4)", "");
    let sun = Sun::new(Vec3::Y, LinearRgb::new(4.0, 2.0, 0.0)).expect("a light");
    assert_eq!(scene.lights(), [Light::from(sun)]);
    assert_eq!(sun.irradiance_over_pi(Vector::<f32>::splat(Vec3::Y), 1.0, 0.5), [2.0, 1.0, 0.0]);
}

#[test]
fn it_cannot_be_moved() {
    let sun = Light::from(Sun::new(Vec3::Y, LinearRgb::grey(1.0)).expect("a light"));
    assert_eq!((sun.position(), sun.moved_to(Vec3::ONE)), (None, sun));
}

#[test]
fn it_is_described_and_explained() {
    let scene = read("Sun(direction: (0, 0, 1))", "");
    let text = describe("sun.ron", &scene, scene.camera(), Resolution::square(40, 40));
    assert!(text.contains("- white, from below\n"), "{text}");
    let explained = explain(&scene, scene.camera(), Resolution::square(9, 9), [4, 4]).lines().join("\n");
    assert!(explained.contains("\nD         infinite\n"), "{explained}");
}

#[test]
fn its_faults_have_the_messages_of_other_lights() {
    let message = |sun: &str| Scene::from_ron("x.ron", &scene(sun, "")).expect_err("a fault").to_string();
    assert!(message("Sun()").contains("missing field \"direction\"; a Sun needs one"));
    assert!(message("Sun(direction: (0, 1, 0), power: 2)").contains("did you mean \"intensity\"?"));
    assert!(message("Sun(direction: (0, 0, 0))").contains("the direction must have a length"));
    assert!(message("Sum(direction: (0, 0, 1))").contains("did you mean Sun?"));
}
