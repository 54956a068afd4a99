use super::*;
use crate::color::LinearRgb;
use crate::lanes::{F32x8, LANES, Lanes};
use crate::light::PointLight;
use crate::simd::{self, SimdKernel};

fn degrees(angle: f64) -> Vec3 {
    let (sine, cosine) = libm::sincos(angle.to_radians());
    Vec3::new(sine as f32, -cosine as f32, 0.0)
}

/// At normal incidence ((n - 1) / (n + 1))^2 is mirrored, from either side.
#[test]
fn fresnel_at_normal_incidence() {
    for index in [1.0_f32, 1.33, 1.5, 2.42, 4.0] {
        let part = f64::from((index - 1.0) / (index + 1.0));
        let expected = part * part;
        for ratio in [index, 1.0 / index] {
            let found = f64::from(fresnel(1.0, ratio));
            assert!((found - expected).abs() < 1e-6, "index {index}: {found}, not {expected}");
        }
    }
}

/// At Brewster's angle, tan a = n, only one polarization is mirrored; at 90 degrees all light is.
#[test]
fn fresnel_at_brewsters_angle_and_at_grazing_incidence() {
    let index = 1.5_f64;
    let cosine = 1.0 / (1.0 + index * index).sqrt();
    let perpendicular = (1.0 - index * index) / (1.0 + index * index);
    let found = f64::from(fresnel(cosine as f32, (1.0 / index) as f32));
    assert!((found - 0.5 * perpendicular * perpendicular).abs() < 1e-6, "{found}");
    assert_eq!(fresnel(0.0_f32, 1.0 / 1.5), 1.0);
    assert_eq!(fresnel(0.0_f32, 1.0), 0.0);
}

/// sin a = n sin b (Snell), for rays into and out of glass.
#[test]
fn refraction_follows_snells_law() {
    for index in [1.33_f64, 1.5, 2.42] {
        for angle in [0.0_f64, 10.0, 30.0, 45.0, 60.0, 89.0] {
            let inside = refract(degrees(angle), Vec3::Y, (1.0 / index) as f32).expect("it enters");
            let expected = libm::asin(libm::sin(angle.to_radians()) / index).to_degrees();
            let found = libm::atan2(inside.x.into(), (-inside.y).into()).to_degrees();
            assert!((found - expected).abs() < 1e-3, "{angle} degrees: {found}, not {expected}");
            assert!((inside.length() - 1.0).abs() < 1e-6);
            let outside = refract(inside, Vec3::Y, index as f32).expect("it leaves");
            assert!(outside.distance(degrees(angle)) < 1e-4, "{angle} degrees: {outside}");
        }
    }
}

/// From the critical angle asin(1 / n) on, all light is mirrored.
#[test]
fn total_internal_reflection_starts_at_the_critical_angle() {
    let critical = libm::asin(1.0 / 1.5).to_degrees();
    assert!(refract(degrees(critical - 0.01), Vec3::Y, 1.5).is_some());
    assert_eq!(refract(degrees(critical + 0.01), Vec3::Y, 1.5), None);
    assert_eq!(fresnel(-degrees(critical + 0.01).y, 1.5), 1.0);
}

#[test]
fn a_mirror_image_has_the_same_angle_on_the_other_side() {
    let mirrored = reflect(Vector::<f32>::splat(Vec3::new(3.0, -4.0, 1.0)), Vector::splat(Vec3::Y));
    assert_eq!(Vec3::from(mirrored), Vec3::new(3.0, 4.0, 1.0));
}

#[test]
fn whole_powers_are_those_of_pow() {
    for exponent in [1, 2, 3, 50, 255, 10_000] {
        let (found, expected) = (whole_power(0.999, exponent), libm::pow(f64::from(0.999_f32), exponent.into()));
        assert!((f64::from(found) / expected - 1.0).abs() < 1e-3, "{exponent}: {found}, not {expected}");
    }
}

/// A facet's tangent squared is alpha^2 h / (1 - h): half of the facets are within the angle of
/// tangent alpha = roughness^2.
#[test]
fn half_of_the_facets_are_within_alpha() {
    for normal in [Vec3::Y, Vec3::Z, Vec3::NEG_Y, Vec3::new(0.6, -0.48, 0.64)] {
        let part = PartPosition { square: [0.0; 2], direction: [0.8, -0.6], height: 0.5 };
        let facet = facet_normal(normal, 0.5, &part);
        assert!((facet.length() - 1.0).abs() < 1e-5, "{normal}: {facet}");
        let tangent = (1.0 / (facet.dot(normal) * facet.dot(normal)) - 1.0).sqrt();
        assert!((tangent - 0.25).abs() < 1e-3, "{normal}: {tangent}");
        assert!((facet_normal(normal, 0.0, &part) - normal).length() < 1e-6);
    }
}

/// The mirrored part, the mirrored direction and a highlight of eight rays.
struct OfEightRays<'w> {
    directions: &'w Vector<F32x8>,
    normals: &'w Vector<F32x8>,
    ratio: f32,
}

impl SimdKernel for OfEightRays<'_> {
    type Output = [F32x8; 7];

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let (direction, normal) = (self.directions.load::<N>(), self.normals.load());
        let part = mirrored_part(direction, normal, N::splat(self.ratio));
        let Vector { x, y, z } = reflect(direction, normal);
        let light = PointLight::new(Vec3::new(1.0, 4.0, -2.0), LinearRgb::new(1.0, 2.0, 3.0)).expect("a light");
        let light = Light::from(light);
        let [r, g, b] = highlight(&light, light.to_light(normal), direction, normal, 37);
        [part, x, y, z, r, g, b].map(N::store)
    }
}

/// Eight rays have the bits of single ones, also without a direction and at total reflection.
#[test]
fn finishes_of_all_lanes_have_the_bits_of_single_rays() {
    let mut directions = [Vec3::ZERO; LANES];
    for (lane, direction) in directions.iter_mut().enumerate().skip(1) {
        *direction = degrees(15.0 * lane as f64 - 15.0) * lane as f32;
    }
    let normals = [Vec3::Y, Vec3::Y, Vec3::Y, Vec3::new(0.6, 0.8, 0.0), Vec3::Y, Vec3::Z, Vec3::Y, Vec3::NEG_Y];
    let [of_all, normal_of_all] = [directions, normals].map(Vector::of);
    for ratio in [1.0 / 1.5, 1.0, 1.5] {
        let eight = || OfEightRays { directions: &of_all, normals: &normal_of_all, ratio };
        let (array, registers) = (simd::run_scalar(eight()), simd::dispatch(eight()));
        for lane in 0..LANES {
            let [directions, normals] = [directions[lane], normals[lane]].map(|v| Vector::of([v; LANES]));
            let alone = simd::run_scalar(OfEightRays { directions: &directions, normals: &normals, ratio });
            for (at, alone) in alone.iter().enumerate() {
                let alone = alone.0[0].to_bits();
                assert_eq!(array[at].0[lane].to_bits(), alone, "value {at} of lane {lane} in an array, ratio {ratio}");
                assert_eq!(registers[at].0[lane].to_bits(), alone, "value {at} of lane {lane}, ratio {ratio}");
            }
        }
    }
}
