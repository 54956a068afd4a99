use super::*;
use crate::light::Light;
use crate::scene::Scene;
use crate::shade::tests::light_on_floor;

/// The irradiance below a corner of a parallel rectangle has a closed form (Howell, A Catalog of
/// Radiation Heat Transfer Configuration Factors, B-3).
#[test]
fn below_a_corner_it_has_the_irradiance_of_the_closed_form() {
    for (width, length, height) in [(1.0_f64, 1.0, 2.0), (3.0, 1.0, 1.5), (0.1, 0.2, 5.0)] {
        let (a, b) = (width / height, length / height);
        let (sa, sb) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        let factor = (a / sa * libm::atan(b / sa) + b / sb * libm::atan(a / sb)) / (2.0 * std::f64::consts::PI);
        // E / pi = L F, with the radiance L = pi I / A.
        let expected = 6.0 * std::f64::consts::PI * factor / (width * length);
        let lamp = format!("Panel(corner: (0, {height}, 0), edges: [({width}, 0, 0), (0, 0, {length})], intensity: 6)");
        for (samples, tolerance) in [(1, 0.02), (256, 0.002)] {
            let found = f64::from(light_on_floor(&lamp, "", 0.0, samples));
            assert!((found / expected - 1.0).abs() < tolerance, "{lamp}, {samples}: {found}, not {expected}");
        }
    }
}

#[test]
fn a_straight_edge_has_a_penumbra_without_jumps() {
    let lamp = "Panel(corner: (-0.2, 2, -0.2), edges: [(0.4, 0, 0), (0, 0, 0.4)], intensity: 4)";
    let edge = "Quad(corner: (-50, 1, -50), edges: [(50, 0, 0), (0, 0, 100)])";
    let share = |x: f32, samples| light_on_floor(lamp, edge, x, samples) / light_on_floor(lamp, "", x, samples);
    assert_eq!(share(-0.21, 16), 0.0);
    assert!((share(0.21, 16) - 1.0).abs() < 1e-6);
    for at in -9..=9 {
        let x = 0.02 * at as f32;
        let (found, expected) = (share(x, 64), 0.5 + x / 0.4);
        assert!((found - expected).abs() < 0.02, "{found} at {x}, not {expected}");
        // Each row and each column of the parts has one part: one sample has steps of a sixteenth.
        let found = share(x, 1);
        assert!((found - expected).abs() < 0.07, "{found} at {x}, not {expected}, with one sample");
    }
}

#[test]
fn an_object_in_its_place_does_not_block_its_light() {
    let lamp = "Panel(corner: (-1, 2, -1), edges: [(2, 0, 0), (0, 0, 2)], intensity: 4)";
    let quad = "Quad(corner: (-1, 2, -1), edges: [(2, 0, 0), (0, 0, 2)], finish: Glowing)";
    assert_eq!(light_on_floor(lamp, quad, 0.5, 16), light_on_floor(lamp, "", 0.5, 16));
}

#[test]
fn written_values_are_those_of_the_constructor() {
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)),
        lights: [Panel(corner: (1, 2, 3), edges: [(1, 0, 0), (0, 0, 2)], color: (1, 0.5, 0), intensity: 8)])";
    let scene = Scene::from_ron("panel.ron", text).expect("a scene");
    let panel = Panel::new(Vec3::new(1.0, 2.0, 3.0), [Vec3::X, Vec3::Z * 2.0], LinearRgb::new(8.0, 4.0, 0.0));
    assert_eq!(scene.lights(), [Light::from(panel.expect("a light"))]);
}

#[test]
fn edges_of_one_direction_are_refused() {
    let error = Panel::new(Vec3::ZERO, [Vec3::X, Vec3::X * 2.0], LinearRgb::grey(1.0)).expect_err("no area");
    assert!(error.to_string().ends_with("the edges of a panel must have lengths and different directions"), "{error}");
}
