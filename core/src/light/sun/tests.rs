use super::*;
use crate::describe::describe;
use crate::explain::explain;
use crate::framebuffer::Resolution;
use crate::light::Light;
use crate::render::{Sampling, render};
use crate::scene::Scene;
use crate::shade::tests::light_on_floor;

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
    let of_size = "the size of a sun must lie between 0 and 90 degrees";
    assert!(message("Sun(direction: (0, 1, 0), size: -1)").contains(of_size));
    assert!(message("Sun(direction: (0, 1, 0), size: 90.5)").contains(of_size));
    assert!(message("Sun(direction: (0, 1, 0), size: NaN)").contains("must be finite"));
    assert!(message("Sum(direction: (0, 0, 1))").contains("did you mean Sun?"));
}

/// A sun with a size lights a surface as one without does: I cos.
#[test]
fn a_size_leaves_the_brightness() {
    for (direction, cosine, size) in
        [("(0, 1, 0)", 1.0_f32, 90.0_f32), ("(3, 4, 0)", 0.8, 60.0), ("(4, 3, 0)", 0.6, 0.53)]
    {
        for samples in [1, 64] {
            let sun = format!("Sun(direction: {direction}, size: {size})");
            let found = light_on_floor(&sun, "", 0.0, samples) / cosine;
            assert!((found - 1.0).abs() < 4e-3, "{sun}, {samples} samples: {found}");
        }
    }
}

/// The shadow of a straight edge grows from darkness to full light over the width that the lines
/// through the edge and both sides of the disc have on the floor: 2 tan(size / 2), for a sun in the
/// zenith and an edge at the height 1.
#[test]
fn a_straight_edge_has_a_penumbra() {
    let sun = "Sun(direction: (0, 1, 0), size: 10)";
    let edge = "Quad(corner: (-50, 1, -50), edges: [(50, 0, 0), (0, 0, 100)])";
    let share = |x: f32, samples| light_on_floor(sun, edge, x, samples) / light_on_floor(sun, "", x, samples);
    let half = libm::tan(5_f64.to_radians());
    assert_eq!(share(-1.02 * half as f32, 64), 0.0);
    assert!((share(1.02 * half as f32, 64) - 1.0).abs() < 1e-6);
    let middle = share(0.0, 1);
    assert!((middle - 0.5).abs() < 0.13, "{middle} with one sample");
    for step in -10..=10 {
        // The part of a disk on one side of a line at the distance h from its middle, in radii.
        let h = -0.1 * f64::from(step);
        let expected = (libm::acos(h) - h * (1.0 - h * h).max(0.0).sqrt()) / std::f64::consts::PI;
        let found = f64::from(share((-h * half) as f32, 64));
        assert!((found - expected).abs() < 0.03, "{found} at {h}, not {expected}");
    }
    assert_eq!(light_on_floor("Sun(direction: (0, 1, 0))", edge, -0.001, 64), 0.0);
}

#[test]
fn a_size_of_0_is_none_and_in_the_lecture_there_is_none() {
    let sun = |fields: &str| read(&format!("Sun(direction: (1, 2, 3){fields})"), "").lights()[0];
    assert_eq!(sun(", size: 0"), sun(""));
    let large = sun(", size: 20");
    assert!(large.has_size() && large != sun(""));
    assert_eq!(large.as_in_lecture(), sun(""));
    let in_code = Sun::new(Vec3::new(1.0, 2.0, 3.0), LinearRgb::grey(1.0)).and_then(|sun| sun.with_size(20.0));
    assert_eq!(in_code.map(Light::from), Ok(large));
}
