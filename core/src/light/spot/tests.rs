use super::*;
use crate::describe::describe;
use crate::explain::explain;
use crate::framebuffer::Resolution;
use crate::lanes::{F32x8, LANES, Lanes};
use crate::light::Light;
use crate::scene::Scene;
use crate::simd::{self, SimdKernel};

/// Returns a spot 2 above the origin, which shines down.
fn spot(degrees: f32, softness: f32) -> SpotLight {
    let spot = SpotLight::new(Vec3::Y * 2.0, Vec3::ZERO, LinearRgb::grey(3.0)).expect("a light");
    spot.with_cone(degrees, softness).expect("a cone")
}

/// Returns the unit vector to the spot from below it, at an angle to its axis.
fn at_angle(degrees: f64) -> Vec3 {
    let angle = degrees.to_radians();
    DVec3::new(libm::sin(angle), libm::cos(angle), 0.0).as_vec3()
}

fn share(spot: &SpotLight, degrees: f64) -> f32 {
    spot.cone_share(at_angle(degrees)).expect("a spot has a cone")
}

#[test]
fn light_fades_between_the_two_angles() {
    for (degrees, softness) in [(60.0, 0.5), (40.0, 0.2), (170.0, 0.1), (180.0, 1.0), (2.0, 0.3), (0.1, 0.5)] {
        let spot = spot(degrees, softness);
        let outer = f64::from(degrees) / 2.0;
        let inner = outer * (1.0 - f64::from(softness));
        let cosine = |degrees: f64| libm::cos(degrees.to_radians());
        let in_cosine = |share: f64| libm::acos(cosine(outer) + share * (cosine(inner) - cosine(outer))).to_degrees();
        for (angle, expected) in [
            (0.0, 1.0),
            (inner * 0.99, 1.0),
            (in_cosine(0.75), 0.84375),
            (in_cosine(0.5), 0.5),
            (in_cosine(0.25), 0.15625),
            (outer * 1.01, 0.0),
            (180.0, 0.0),
        ] {
            let found = share(&spot, angle);
            assert!((found - expected).abs() < 2e-3, "{degrees} {softness} at {angle}: {found}, not {expected}");
        }
    }
}

#[test]
fn without_softness_the_edge_is_hard() {
    let spot = spot(60.0, 0.0);
    assert_eq!([0.0, 29.99, 30.01, 90.0, 180.0].map(|degrees| share(&spot, degrees)), [1.0, 1.0, 0.0, 0.0, 0.0]);
    assert!([0.0, 1.0].contains(&share(&spot, 30.0)));
}

#[test]
fn inside_the_cone_it_is_a_point_source() {
    let (spot, l) = (spot(60.0, 0.5), Vector::<f32>::splat(at_angle(10.0)));
    assert_eq!(spot.irradiance_over_pi(l, 4.0, 0.5), [3.0 * 0.5 / 4.0; 3]);
    assert_eq!(spot.with_falloff(Falloff::None).irradiance_over_pi(l, 4.0, 0.5), [1.5; 3]);
    let outside = Vector::<f32>::splat(at_angle(31.0));
    assert_eq!(spot.irradiance_over_pi(outside, 1e-40, 0.5), [0.0; 3], "even very near the light");
}

#[test]
fn moved_it_shines_in_the_same_direction() {
    let spot = spot(60.0, 0.5);
    let moved = spot.moved_to(Vec3::new(7.0, 1.0, -3.0));
    assert_eq!(LightSource::position(&moved), Some(Vec3::new(7.0, 1.0, -3.0)));
    assert_eq!(share(&moved, 17.0), share(&spot, 17.0));
    assert_eq!(spot.moved_to(Vec3::NAN), spot);
}

/// A kernel that returns the shares of unit vectors.
struct Shares<'w>(&'w SpotLight, &'w [Vector<F32x8>]);

impl SimdKernel for Shares<'_> {
    type Output = Vec<[F32x8; 3]>;

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let mut all = Vec::new();
        for l in self.1 {
            let [r, g, b] = self.0.irradiance_over_pi(l.load::<N>(), N::splat(2.0), N::splat(0.7));
            all.push([r.store(), g.store(), b.store()]);
        }
        all
    }
}

#[test]
fn all_lanes_have_the_bits_of_single_rays() {
    for spot in [spot(40.0, 0.2), spot(40.0, 0.0), spot(0.5, 1.0)] {
        let groups: Vec<_> = (0..200)
            .map(|group| Vector::of(std::array::from_fn(|lane| at_angle(f64::from(8 * group + lane as u32) * 0.02))))
            .collect();
        let (arrays, registers) = (simd::run_scalar(Shares(&spot, &groups)), simd::dispatch(Shares(&spot, &groups)));
        for (at, l) in groups.iter().enumerate() {
            for lane in 0..LANES {
                let alone = spot.irradiance_over_pi(Vector::<f32>::splat(l.of_lane(lane)), 2.0, 0.7).map(f32::to_bits);
                let bits = |all: &[[F32x8; 3]]| all[at].map(|channel| channel.0[lane].to_bits());
                assert_eq!([bits(&arrays), bits(&registers)], [alone, alone]);
            }
        }
    }
}

/// Returns a scene with a floor seen from above.
fn scene(spot: &str) -> String {
    let floor = "Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Diffuse(0.5))";
    format!("(camera: (eye: (0, 5, 0.01), target: (0, 0, 0)), lights: [{spot}], objects: [{floor}])")
}

#[test]
fn it_is_read_described_and_explained() {
    let text = scene("Spot(position: (0, 2, 0), target: (0, 0, 0), angle: 60, softness: 0.5, intensity: 3)");
    let read = Scene::from_ron("spot.ron", &text).expect("a scene");
    assert_eq!(read.lights(), [Light::from(spot(60.0, 0.5))]);
    let defaults = Scene::from_ron("spot.ron", &scene("Spot(position: (0, 2, 0), target: (0, 0, 0))"));
    let expected = SpotLight::new(Vec3::Y * 2.0, Vec3::ZERO, LinearRgb::grey(1.0)).expect("a light");
    assert_eq!(defaults.expect("a scene").lights(), [Light::from(expected)]);
    let text = describe("spot.ron", &read, read.camera(), Resolution::square(40, 40));
    assert!(text.contains(", 2 from the target, in a cone of 60 degrees\n"), "{text}");
    let explained = explain(&read, read.camera(), Resolution::square(9, 9), [4, 4]).lines().join("\n");
    assert!(explained.contains("light 1: V I S max(0, n.l) / D^2\n"), "{explained}");
    assert!(explained.contains("\nS       1.0000\n"), "{explained}");
}

#[test]
fn outside_its_cone_it_is_explained_as_dark() {
    let text = scene("Spot(position: (2, 2, 0), target: (2, 0, 0))");
    let read = Scene::from_ron("spot.ron", &text).expect("a scene");
    let explained = explain(&read, read.camera(), Resolution::square(9, 9), [4, 4]).lines().join("\n");
    assert!(explained.contains("\nV = 1, outside the cone\n"), "{explained}");
    assert!(explained.contains("\nS       0.0000\n"), "{explained}");
}

#[test]
fn its_faults_have_the_messages_of_other_lights() {
    let message = |spot: &str| Scene::from_ron("x.ron", &scene(spot)).expect_err("a fault").to_string();
    assert!(message("Spot(position: (0, 1, 0))").contains("missing field \"target\"; a Spot light needs one"));
    let same = message("Spot(position: (0, 1, 0), target: (0, 1, 0))");
    assert!(same.contains("position and target must be different points"), "{same}");
    assert!(message("Spott(position: (0, 1, 0), target: (0, 0, 0))").contains("did you mean Spot?"));
}
