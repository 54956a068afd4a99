//! Light on a floor, for the tests of lights, highlights and fog.

use crate::color::LinearRgb;
use crate::framebuffer::Resolution;
use crate::render::render;
use crate::scene::Scene;
use std::num::NonZeroU32;

/// Returns the light along an eye ray straight down to a point of a floor of reflectance 1.
fn seen_on_floor(fields: &str, lights: &str, objects: &str, x: f32, samples: u32) -> LinearRgb {
    let text = format!(
        "(camera: (eye: ({x}, 0.3, 0), target: ({x}, 0, 0), up: (0, 0, 1), vertical_fov: 0.001), {fields}
            lights: [{lights}], objects: [Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Diffuse(1)), \
                {objects}])"
    );
    let scene = Scene::from_ron("floor.ron", &text).unwrap_or_else(|error| panic!("{error}"));
    render(&scene, scene.camera(), Resolution::square(1, 1), NonZeroU32::new(samples).expect("samples")).pixels()[0]
}

/// Returns the light that a point (x, 0, 0) of a white floor reflects upwards.
pub fn light_on_floor(lights: &str, objects: &str, x: f32, samples: u32) -> f32 {
    seen_on_floor("", lights, objects, x, samples).g
}

/// T L + (1 - T) C, with T = exp(-d / distance).
#[test]
fn fog_dims_light_over_the_way_to_the_eye() {
    let lamp = "Point(position: (0, 2, 0), intensity: 8)";
    let fog = "fog: (color: (0.1, 0.5, 0.2), distance: 0.6),";
    let (clear, fogged) = (seen_on_floor("", lamp, "", 0.0, 1), seen_on_floor(fog, lamp, "", 0.0, 1));
    let left = libm::exp(-0.5) as f32;
    for (clear, fogged, color) in [(clear.r, fogged.r, 0.1), (clear.g, fogged.g, 0.5), (clear.b, fogged.b, 0.2)] {
        let expected = clear * left + color * (1.0 - left);
        assert!((fogged - expected).abs() < 1e-5, "{fogged}, not {expected}");
    }
}

/// With l and the view both along n, n.h = 1, and the highlight is s I / d^2.
#[test]
fn a_highlight_in_the_mirror_direction_has_the_intensity_of_the_light() {
    let lamp = "Point(position: (0, 2, 0), intensity: 8)";
    let shiny = |x| {
        let disk = format!(
            "Disk(center: ({x}, 0.01, 0), normal: (0, 1, 0), radius: 0.1, material: Diffuse(0), \
                finish: Shiny(exponent: 200, strength: 0.25))"
        );
        f64::from(seen_on_floor("", lamp, &disk, x, 1).g)
    };
    let found = shiny(0.0);
    assert!((found - 0.25 * 8.0 / (1.99 * 1.99)).abs() < 1e-4, "{found}");
    // h is halfway between l, at the angle a from n, and the view along n: (n.h)^p = cos(a / 2)^p.
    let (height, x) = (1.99_f64, 0.3_f64);
    let squared = height * height + x * x;
    let cosine = libm::cos(0.5 * libm::atan(x / height));
    let expected = 0.25 * 8.0 / squared * libm::pow(cosine, 200.0);
    let found = shiny(0.3);
    assert!((found / expected - 1.0).abs() < 1e-3, "{found}, not {expected}");
}

/// A highlight vanishes in the shadow, and one of a light with a size fades in the penumbra.
#[test]
fn highlights_are_in_the_light_only() {
    let disk = "Disk(center: (0, 0.01, 0), normal: (0, 1, 0), radius: 0.1, material: Diffuse(0), finish: Shiny)";
    let roof = "Quad(corner: (-50, 1, -50), edges: [(50, 0, 0), (0, 0, 100)])";
    let cover = "Disk(center: (0, 1, 0), normal: (0, 1, 0), radius: 0.5)";
    let seen = |lamp: &str, more: &str| seen_on_floor("", lamp, &format!("{disk}, {more}"), 0.0, 64).g;
    let (point, globe) = ("Point(position: (0, 2, 0))", "Globe(position: (0, 2, 0), radius: 0.1)");
    assert!(seen(point, "") > 0.1);
    assert_eq!(seen(point, cover), 0.0);
    let half = seen(globe, roof) / seen(globe, "");
    assert!((half - 0.5).abs() < 0.03, "{half}");
}

/// Each sheet of opacity a lets 1 - a of the light through, once for the light and once for the
/// eye.
#[test]
fn transparent_sheets_weaken_the_light_that_passes_them() {
    let sheet = |height: f32, opacity: f32| {
        format!(
            "Disk(center: (0, {height}, 0), normal: (0, 1, 0), radius: 9, material: Diffuse(0), opacity: {opacity})"
        )
    };
    for lamp in [
        "Point(position: (0, 2, 0))",
        "Sun(direction: (1, 4, 0))",
        "Globe(position: (0, 2, 0), \
        radius: 0.1)",
    ] {
        let seen = |objects: &str| light_on_floor(lamp, objects, 0.0, 1);
        let clear = seen("");
        let one = seen(&sheet(1.0, 0.25)) / clear;
        assert!((one - 0.75).abs() < 1e-6, "{lamp}: {one}");
        let two = seen(&format!("{}, {}", sheet(1.0, 0.25), sheet(1.5, 0.5))) / clear;
        assert!((two - 0.375).abs() < 1e-6, "{lamp}: {two}");
        let opaque = seen(&format!("{}, {}", sheet(1.0, 0.25), sheet(1.5, 1.0)));
        assert_eq!(opaque, 0.0, "{lamp}");
        // The eye is above this one.
        let through = seen(&sheet(0.1, 0.25)) / clear;
        assert!((through - 0.75 * 0.75).abs() < 1e-6, "{lamp}: {through}");
    }
}

#[test]
fn a_transparent_surface_adds_its_own_light() {
    let sheet = |opacity: f32| {
        format!("Disk(center: (0, 0.1, 0), normal: (0, 1, 0), radius: 9, finish: Glowing, opacity: {opacity})")
    };
    let seen = |opacity| light_on_floor("", &sheet(opacity), 0.0, 1);
    assert!((seen(0.25) - 0.25 * seen(1.0)).abs() < 1e-6);
}

#[test]
fn a_highlight_behind_a_transparent_sheet_is_weaker() {
    let disk = "Disk(center: (0, 0.01, 0), normal: (0, 1, 0), radius: 0.1, material: Diffuse(0), finish: Shiny)";
    let sheet = "Disk(center: (0, 1, 0), normal: (0, 1, 0), radius: 9, opacity: 0.25)";
    let seen = |objects: &str| light_on_floor("Point(position: (0, 2, 0))", objects, 0.0, 1);
    let share = seen(&format!("{disk}, {sheet}")) / seen(disk);
    assert!((share - 0.75).abs() < 1e-6, "{share}");
}

/// Glass of index 1 neither mirrors nor refracts, so that its opacity changes nothing, and fog
/// begins again behind it.
#[test]
fn rays_that_pass_transparent_glass_are_inside_it_and_outside_again() {
    let ball = |opacity: f32| {
        format!(
            "Sphere(center: (0, 0.15, 0), radius: 0.05, material: Diffuse(1), finish: Glass(index: 1), \
                opacity: {opacity})"
        )
    };
    let seen = |opacity| {
        let fields = "shadows: false, fog: (color: 0.5, distance: 0.2),";
        seen_on_floor(fields, "Point(position: (0, 2, 0), intensity: 8)", &ball(opacity), 0.0, 1).g
    };
    assert!((seen(0.5) - seen(1.0)).abs() < 1e-5, "{} {}", seen(0.5), seen(1.0));
}
