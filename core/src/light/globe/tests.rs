use super::*;
use crate::light::Light;
use crate::scene::Scene;
use crate::shade::tests::light_on_floor;

/// A ball above the horizon gives what a point source in its middle gives: I cos / D^2.
#[test]
fn above_the_horizon_it_is_as_bright_as_a_point_source() {
    for (globe, x) in [("position: (0, 2, 0), radius: 0.5", 0.0), ("position: (0, 3, 0), radius: 2", 1.0)] {
        let height: f64 = if x == 0.0 { 2.0 } else { 3.0 };
        let squared = height * height + x * x;
        let expected = 7.0 * height / squared / squared.sqrt();
        for samples in [1, 64] {
            let found = f64::from(light_on_floor(&format!("Globe({globe}, intensity: 7)"), "", x as f32, samples));
            assert!((found / expected - 1.0).abs() < 4e-3, "{globe}, {samples} samples: {found}, not {expected}");
        }
    }
}

/// A ball whose middle is on the horizon lights a surface with its upper half.
#[test]
fn a_ball_on_the_horizon_lights_a_surface_with_its_upper_half() {
    // At the angle p from the middle, the mean of cos over the upper half circle is sin p / pi. With the radiance
    // I pi / (pi r^2), E / pi = I / (pi r^2) times the integral of sin p / pi over 2 pi sin p dp, up to sin a = r / D.
    let (distance, radius): (f64, f64) = (2.0, 1.0);
    let angle = libm::asin(radius / distance);
    let integral = 0.5 * (angle - libm::sin(angle) * libm::cos(angle));
    let expected = 5.0 * 2.0 * integral / (radius * radius) / std::f64::consts::PI;
    let found = f64::from(light_on_floor("Globe(position: (2, 0, 0), radius: 1, intensity: 5)", "", 0.0, 1024));
    assert!((found / expected - 1.0).abs() < 0.02, "{found}, not {expected}");
}

/// The shadow of a straight edge grows from full light to darkness over the width that the rays
/// through the edge and both sides of the ball have on the floor.
#[test]
fn a_straight_edge_has_a_penumbra() {
    let lamp = "Globe(position: (0, 2, 0), radius: 0.2, intensity: 4)";
    let edge = "Quad(corner: (-50, 1, -50), edges: [(50, 0, 0), (0, 0, 100)])";
    let share = |x: f32, samples| light_on_floor(lamp, edge, x, samples) / light_on_floor(lamp, "", x, samples);
    assert_eq!(share(-0.21, 64), 0.0);
    assert!((share(0.21, 64) - 1.0).abs() < 1e-6);
    for samples in [1, 64] {
        let middle = share(0.0, samples);
        assert!((middle - 0.5).abs() < if samples == 1 { 0.13 } else { 0.01 }, "{middle} with {samples} samples");
    }
    let steps: Vec<f32> = (-20..=20).map(|step| share(0.01 * step as f32, 64)).collect();
    assert!(steps.windows(2).all(|pair| pair[0] <= pair[1] + 0.01), "{steps:?}");
    // The part of a disk on one side of a line at the distance h from its middle, in radii.
    for (at, &found) in steps.iter().enumerate() {
        let h = -(at as f64 * 0.01 - 0.2) / 0.2;
        let expected = (libm::acos(h.clamp(-1.0, 1.0)) - h * (1.0 - h * h).max(0.0).sqrt()) / std::f64::consts::PI;
        assert!((f64::from(found) - expected).abs() < 0.03, "{found} at {h}, not {expected}");
    }
}

#[test]
fn an_object_of_its_size_does_not_block_its_light() {
    let lamp = "Globe(position: (0, 2, 0), radius: 0.5, intensity: 4)";
    let ball = "Sphere(center: (0, 2, 0), radius: 0.5, finish: Glowing)";
    assert_eq!(light_on_floor(lamp, ball, 1.0, 16), light_on_floor(lamp, "", 1.0, 16));
}

#[test]
fn a_surface_inside_the_ball_has_finite_light() {
    let found = light_on_floor("Globe(position: (0, 0, 0), radius: 3, intensity: 4)", "", 1.0, 16);
    assert!(found.is_finite() && found > 0.0, "{found}");
}

#[test]
fn written_values_are_those_of_the_constructor() {
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)),
        lights: [Globe(position: (1, 2, 3), radius: 0.25, color: (1, 0.5, 0), intensity: 8)])";
    let scene = Scene::from_ron("globe.ron", text).expect("a scene");
    let globe = Globe::new(Vec3::new(1.0, 2.0, 3.0), 0.25, LinearRgb::new(8.0, 4.0, 0.0)).expect("a light");
    assert_eq!(scene.lights(), [Light::from(globe)]);
}
