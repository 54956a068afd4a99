//! Light and hits that follow from pen and paper.
//!
//! Each expectation is worked out here in f64 from the geometry of its scene, not from the crate's own functions.

use glam::{Vec2, Vec3};
use std::f32::consts::PI;
use std::num::NonZeroU32;
use termtrace::internals::hit::any_hit;
use termtrace::internals::light::{LightSource, SpotLight, Sun};
use termtrace::internals::material::{Checker, Gradient, Noise, Stripes};
use termtrace::internals::ray::{Interval, Probe, Ray};
use termtrace::internals::shade::{incidence, shadow_ray};
use termtrace::internals::shape::{Side, Surface};
use termtrace::{
    Background, Camera, Falloff, Framebuffer, Light, LinearRgb, Material, Object, Plane, PointLight, Pose, Resolution,
    Scene, Sphere, ToneCurve, ViewRectangle, render, tone,
};

/// Returns a camera that sees `fov` degrees vertically.
fn camera(eye: [f32; 3], target: [f32; 3], fov: f32) -> Camera {
    let pose = Pose { eye: Vec3::from(eye), target: Vec3::from(target), up: Vec3::Y };
    Camera::new(pose, ViewRectangle::from_vertical_fov(fov.to_radians()).unwrap()).unwrap()
}

fn light(position: [f32; 3], intensity: f32) -> PointLight {
    PointLight::new(Vec3::from(position), LinearRgb::grey(intensity)).expect("a light")
}

fn grey() -> Material {
    Material::diffuse(LinearRgb::grey(0.5)).expect("a reflectance")
}

fn unit_sphere() -> Object {
    Object::new(Sphere::new(Vec3::ZERO, 1.0).expect("a sphere"), grey())
}

fn floor() -> Object {
    Object::new(Plane::new(Vec3::ZERO, Vec3::Y).expect("a plane"), grey())
}

fn lit(camera: Camera, objects: Vec<Object>, lights: impl IntoIterator<Item: Into<Light>>) -> Scene {
    let mut scene = Scene::new(camera, objects);
    scene = scene.with_lights(lights);
    scene
}

fn picture(scene: &Scene, width: u32, height: u32) -> Framebuffer {
    render(scene, scene.camera(), Resolution::square(width, height), NonZeroU32::MIN)
}

/// Returns the light that arrives along the middle of the view.
fn seen(scene: &Scene) -> f64 {
    f64::from(picture(scene, 1, 1).pixel(0, 0).g)
}

#[track_caller]
fn assert_close(found: f64, expected: f64) {
    let error = (found - expected).abs() / expected.abs().max(1e-30);
    assert!(error < 1e-4, "found {found}, pen and paper say {expected} ({error:e} off)");
}

fn tan_of_degrees(degrees: f64) -> f64 {
    libm::tan(degrees.to_radians())
}

#[test]
fn unit_sphere_lit_from_the_eye() {
    // n.l = 1 at the nearest point, which is 4 - 1 from the light: L = 0.5 * 18 / 9.
    let scene =
        lit(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0), vec![unit_sphere()], vec![light([0.0, 0.0, 4.0], 18.0)]);
    assert_close(seen(&scene), 1.0);
}

#[test]
fn unit_sphere_lit_from_the_eye_off_its_middle() {
    // A ray at angle a to the axis meets the sphere at t = D cos a - sqrt(1 - D^2 sin^2 a); there, with the light at
    // the eye, cos(n, l) = sqrt(1 - D^2 sin^2 a) (the sine rule), and the distance is t.
    let distance = 4.0_f64;
    let scene =
        lit(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0), vec![unit_sphere()], vec![light([0.0, 0.0, 4.0], 18.0)]);
    let frame = picture(&scene, 101, 101);
    for x in [30, 40, 50, 60, 75] {
        let tan = (f64::from(x) + 0.5 - 50.5) / 50.5 * tan_of_degrees(20.0);
        let sin_squared = tan * tan / (1.0 + tan * tan);
        let cosine = (1.0 - distance * distance * sin_squared).sqrt();
        let t = distance * (1.0 - sin_squared).sqrt() - cosine;
        assert_close(f64::from(frame.pixel(x, 50).g), 0.5 * 18.0 * cosine / (t * t));
    }
}

#[test]
fn plane_under_a_light() {
    // L = rho I cos / d^2 = rho I h / (h^2 + r^2)^(3/2) at the distance r from the foot of a light at height h.
    let h = 3.0_f64;
    for r in [0.0_f64, 0.5, 1.0, 2.0, 5.0, 20.0] {
        let camera = camera([r as f32, 2.0, 1.5], [r as f32, 0.0, 0.0], 40.0);
        let scene = lit(camera, vec![floor()], vec![light([0.0, 3.0, 0.0], 10.0)]);
        assert_close(seen(&scene), 0.5 * 10.0 * h / libm::pow(h * h + r * r, 1.5));
    }
}

#[test]
fn a_light_without_falloff_is_as_strong_anywhere() {
    // n.l = 3/5 in a 3-4-5 triangle, at any size of it.
    for scale in [1.0, 10.0, 1000.0] {
        let lamp = light([4.0 * scale, 3.0 * scale, 0.0], 1.5).with_falloff(Falloff::None);
        let scene = lit(camera([0.0, 2.0, 2.0], [0.0, 0.0, 0.0], 40.0), vec![floor()], vec![lamp]);
        assert_close(seen(&scene), 0.5 * 1.5 * 0.6);
    }
}

/// The light of a sun is rho I n.l on every surface that faces it.
///
/// An object blocks it at any distance.
#[test]
fn a_sun_shines_everywhere_alike() {
    let sun = |direction: [f32; 3]| Sun::new(Vec3::from(direction), LinearRgb::grey(1.5)).expect("a light");
    for (direction, cosine) in
        [([0.0, 7.0, 0.0], 1.0), ([3.0, 4.0, 0.0], 0.8), ([-4.0, 3.0, 0.0], 0.6), ([1.0, -1.0, 0.0], 0.0)]
    {
        for x in [0.0, 100.0, -30.0] {
            let view = camera([x, 2.0, 2.0], [x, 0.0, 0.0], 40.0);
            let expected = 0.5 * 1.5 * cosine;
            assert_close(seen(&lit(view, vec![floor()], [sun(direction)])), expected);
        }
    }
    let far = |distance: f32| {
        let ball = Sphere::new(Vec3::new(0.6, 0.8, 0.0) * distance, 0.1 * distance).expect("a sphere");
        let view = camera([0.0, 0.1, 0.2], [0.0, 0.0, 0.0], 40.0);
        seen(&lit(view, vec![floor(), Object::new(ball, grey())], [sun([3.0, 4.0, 0.0])]))
    };
    assert_eq!([2.0, 1e4, 1e8].map(far), [0.0; 3]);
}

/// On a floor below a spot the cosine of the angle to the axis is that of n.l.
///
/// Inside the cone the light is rho I h / (h^2 + r^2)^(3/2), as of a point; between the two angles it is multiplied by a
/// smooth step, which is 1/2 where the cosine is in the middle; outside it is dark.
#[test]
fn a_spot_lights_a_cone() {
    let (h, degrees, softness) = (3.0_f64, 50.0_f32, 0.4_f32);
    let spot = SpotLight::new(Vec3::Y * 3.0, Vec3::ZERO, LinearRgb::grey(10.0)).expect("a light");
    let spot = spot.with_cone(degrees, softness).expect("a cone");
    let cosine_at = |half_angle: f64| libm::cos(half_angle.to_radians());
    let (outer, inner) = (cosine_at(25.0), cosine_at(15.0));
    // The distance from the foot of the light at which the angle has a cosine.
    let r_of = |cosine: f64| h * (1.0 / (cosine * cosine) - 1.0).sqrt();
    for (cosine, share) in [
        (1.0, 1.0),
        (cosine_at(8.0), 1.0),
        (cosine_at(14.9), 1.0),
        (inner - 0.25 * (inner - outer), 27.0 / 32.0),
        (0.5 * (inner + outer), 0.5),
        (outer + 0.25 * (inner - outer), 5.0 / 32.0),
        (cosine_at(25.1), 0.0),
        (cosine_at(60.0), 0.0),
    ] {
        let r = r_of(cosine);
        let view = camera([r as f32, 1.0, 1.5], [r as f32, 0.0, 0.0], 40.0);
        let found = seen(&lit(view, vec![floor()], [spot]));
        let expected = share * 0.5 * 10.0 * h / libm::pow(h * h + r * r, 1.5);
        assert!((found - expected).abs() < 2e-4 * expected.max(1e-3), "at {r}: {found}, not {expected}");
    }
}

#[test]
fn inside_of_a_sphere_with_the_light_in_its_middle() {
    // Every point is at distance r, and faces the light: the same light everywhere, rho I / r^2.
    let room = Object::new(Sphere::new(Vec3::new(1.0, 2.0, 3.0), 2.5).expect("a sphere"), grey());
    let scene = lit(camera([1.5, 2.5, 3.5], [5.0, 2.0, 0.0], 90.0), vec![room], vec![light([1.0, 2.0, 3.0], 5.0)]);
    for pixel in picture(&scene, 31, 23).pixels() {
        assert_close(f64::from(pixel.g), 0.5 * 5.0 / 6.25);
    }
}

#[test]
fn ambient_light_is_reflected_by_its_share() {
    let mut scene = Scene::new(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0), vec![unit_sphere()]);
    scene = scene.with_ambient(LinearRgb::grey(0.3)).expect("light");
    assert_close(seen(&scene), 0.15);
}

#[test]
fn colours_of_lights_and_surfaces_multiply_and_lights_add() {
    let surface = Material::diffuse(LinearRgb::new(0.2, 0.4, 0.8)).expect("a reflectance");
    let object = Object::new(Plane::new(Vec3::ZERO, Vec3::Y).expect("a plane"), surface);
    let lamps =
        [([3.0, 4.0, 0.0], LinearRgb::new(25.0, 0.0, 50.0)), ([0.0, 12.0, 5.0], LinearRgb::new(0.0, 169.0, 169.0))];
    let lights = lamps.map(|(position, intensity)| PointLight::new(Vec3::from(position), intensity).expect("a light"));
    let scene = lit(camera([0.0, 2.0, 2.0], [0.0, 0.0, 0.0], 40.0), vec![object], lights.to_vec());
    let found = picture(&scene, 1, 1).pixel(0, 0);
    // n.l / d^2 is 0.8 / 25 and (12/13) / 169.
    assert_close(found.r.into(), 0.2 * 0.8);
    assert_close(found.g.into(), 0.4 * 12.0 / 13.0);
    assert_close(found.b.into(), 0.8 * (2.0 * 0.8 + 12.0 / 13.0));
}

#[test]
fn silhouette_of_a_sphere() {
    // Its outline is where rays touch it: sin a = r / D, so that on the screen its radius is tan a / tan(fov / 2)
    // half heights. The area is compared, which is right to a fraction of a pixel.
    let (radius, distance) = (1.0_f64, 5.0_f64);
    let mut scene = Scene::new(camera([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 40.0), vec![unit_sphere()]);
    scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
    let frame = picture(&scene, 800, 600);
    let covered = frame.pixels().iter().filter(|pixel| pixel.g > 0.0).count() as f64;
    let tan = radius / (distance * distance - radius * radius).sqrt();
    let on_screen = 300.0 * tan / tan_of_degrees(20.0);
    let error = (covered / (std::f64::consts::PI * on_screen * on_screen) - 1.0).abs();
    assert!(error < 1e-3, "{covered} pixels, radius {on_screen}: {error}");
    // Its leftmost and rightmost pixels on the middle rows are where that radius ends.
    let row: Vec<_> = (0..800).filter(|&x| frame.pixel(x, 300).g > 0.0).collect();
    let half = (row.len() as f64) / 2.0;
    assert!((half - on_screen).abs() <= 1.0, "half width {half}, expected {on_screen}");
    assert_eq!(row[0] + row[row.len() - 1], 799, "the sphere is in the middle");
}

#[test]
fn a_sphere_is_as_wide_as_high_with_pixels_of_any_shape() {
    let mut scene = Scene::new(camera([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 40.0), vec![unit_sphere()]);
    scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
    for pixel_aspect in [0.5_f32, 0.95, 1.0, 1.1, 2.0] {
        let resolution = Resolution::square(400, 300).with_pixel_aspect(pixel_aspect).expect("a shape of pixels");
        let frame = render(&scene, scene.camera(), resolution, NonZeroU32::MIN);
        let wide = (0..400).filter(|&x| frame.pixel(x, 150).g > 0.0).count() as f32;
        let high = (0..300).filter(|&y| frame.pixel(200, y).g > 0.0).count() as f32 * pixel_aspect;
        assert!((wide - high).abs() <= 2.0 * pixel_aspect.max(1.0), "{wide} by {high} at {pixel_aspect}");
    }
}

#[test]
fn row_of_the_horizon() {
    // Looking down by b, the horizon of a plane is tan b / tan(fov / 2) half heights above the middle.
    for down in [-10.0_f64, -3.0, 0.0, 4.0, 12.0] {
        let target = [0.0, 5.0 - tan_of_degrees(down) as f32, -1.0];
        let mut scene = Scene::new(camera([0.0, 5.0, 0.0], target, 50.0), vec![floor()]);
        scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
        let frame = picture(&scene, 3, 1000);
        let sky_rows = (0..1000).take_while(|&y| frame.pixel(1, y).g == 0.0).count() as f64;
        let expected = 500.0 * (1.0 - tan_of_degrees(down) / tan_of_degrees(25.0));
        assert!((sky_rows - expected).abs() <= 1.0, "{sky_rows} rows of sky, expected {expected}");
        assert!((sky_rows as u32..1000).all(|y| frame.pixel(1, y).g > 0.0), "below the horizon all is plane");
    }
}

#[test]
fn shadow_of_a_sphere_on_a_plane() {
    // A light at height 10 above a sphere of radius 1 at height 6: its rays touch the sphere at sin a = 1/4, and the
    // shadow on the floor has the radius 10 tan a.
    let ball = Object::new(Sphere::new(Vec3::new(0.0, 6.0, 0.0), 1.0).expect("a sphere"), grey());
    let edge = 10.0 * (0.25_f64 / (1.0 - 0.0625_f64).sqrt());
    for (r, dark) in [(0.0, true), (edge - 0.01, true), (edge + 0.01, false), (2.0 * edge, false)] {
        let x = r as f32;
        let mut scene = lit(
            camera([x, 1.0, 9.0], [x, 0.0, 0.0], 40.0),
            vec![floor(), ball.clone()],
            vec![light([0.0, 10.0, 0.0], 100.0)],
        );
        assert_eq!(seen(&scene) == 0.0, dark, "at {r} of {edge}");
        // Without shadows the light goes through.
        scene = scene.with_shadows(false);
        assert!(seen(&scene) > 0.0);
    }
}

#[test]
fn a_surface_is_dark_on_the_side_away_from_the_light() {
    let scene =
        |y: f32| lit(camera([0.0, y, 2.0], [0.0, 0.0, 0.0], 40.0), vec![floor()], vec![light([0.0, 3.0, 0.0], 9.0)]);
    assert_close(seen(&scene(2.0)), 0.5);
    assert_eq!(seen(&scene(-2.0)), 0.0, "the light is behind the surface that is seen");
    let ball = |z: f32| {
        lit(camera([0.0, 0.0, z], [0.0, 0.0, 0.0], 40.0), vec![unit_sphere()], vec![light([0.0, 0.0, 4.0], 9.0)])
    };
    assert_close(seen(&ball(2.0)), 0.5);
    assert_eq!(seen(&ball(-2.0)), 0.0);
}

#[test]
fn light_from_behind_is_zero_even_without_a_shadow() {
    // Without shadows the surface itself is not in the way: max(0, n.l) alone makes it dark.
    for (eye, object) in [([0.0, -2.0, 2.0], floor()), ([0.0, 0.0, -4.0], unit_sphere())] {
        let mut scene = lit(camera(eye, [0.0, 0.0, 0.0], 40.0), vec![object], vec![light([0.0, 3.0, 4.0], 9.0)]);
        scene = scene.with_shadows(false);
        assert_eq!(seen(&scene), 0.0);
    }
}

#[test]
fn ambient_light_arrives_once_however_many_lights_there_are() {
    // One light lights (0.5 * 9 / 9), the other is behind the floor: 0.5 * (0.2 + 1 + 0).
    let lights = vec![light([0.0, 3.0, 0.0], 9.0), light([0.0, -3.0, 0.0], 9.0)];
    let mut scene = lit(camera([0.0, 2.0, 2.0], [0.0, 0.0, 0.0], 40.0), vec![floor()], lights);
    scene = scene.with_ambient(LinearRgb::grey(0.2)).expect("light");
    assert_close(seen(&scene), 0.6);
}

#[test]
fn a_shadow_reaches_the_point_of_contact() {
    // A ball on a floor, the light straight above: the floor is dark from where they touch on. The gap between them at
    // the distance x from there is about x^2 / 2, and a ray's origin must be nearer to the floor than that.
    let ball = Object::new(Sphere::new(Vec3::new(3.0, 1.0, 0.0), 1.0).expect("a sphere"), grey());
    let lamp = light([3.0, 50.0, 0.0], 100.0);
    let scene = lit(camera([0.0, 2.0, 4.0], [0.0; 3], 40.0), vec![floor(), ball], vec![lamp]);
    for x in [0.01, 0.03, 0.1, 0.5] {
        let down = Ray { origin: Vec3::new(3.0 + x, 1.0, 0.0), direction: -Vec3::Y };
        let shadow = shadow_ray(&lamp.into(), &floor().shape.primitive(0).at_crossing(&down, 1.0));
        assert!(any_hit(&scene, &shadow, PointLight::BLOCKING_INTERVAL), "lit at {x} from the contact");
        assert!(shadow.origin.y < x * x / 2.0, "inside the ball at {x}: {}", shadow.origin);
    }
}

#[test]
fn the_first_of_two_coincident_surfaces_is_seen() {
    let ball = |grey| {
        Object::new(
            Sphere::new(Vec3::ZERO, 1.0).expect("a sphere"),
            Material::diffuse(LinearRgb::grey(grey)).expect("a reflectance"),
        )
    };
    for (first, second) in [(0.2, 0.7), (0.7, 0.2)] {
        let mut scene = Scene::new(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0), vec![ball(first), ball(second)]);
        scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
        for pixel in picture(&scene, 21, 21).pixels().iter().filter(|pixel| pixel.g > 0.0) {
            assert_close(pixel.g.into(), f64::from(first));
        }
    }
}

#[test]
fn a_point_has_the_same_colour_from_every_viewpoint() {
    let lights = vec![light([3.0, 4.0, 5.0], 30.0), light([-2.0, 6.0, 1.0], 10.0)];
    // The same point, (0, 1, 0) on the sphere, seen from all around the upper half.
    let from = |eye: [f32; 3]| seen(&lit(camera(eye, [0.0, 1.0, 0.0], 10.0), vec![unit_sphere()], lights.clone()));
    let first = from([0.0, 3.0, 4.0]);
    assert!(first > 0.1);
    for eye in [[0.1, 5.0, 0.0], [4.0, 1.5, 0.0], [-30.0, 20.0, -7.0], [1.0, 1.2, -2.0]] {
        assert_close(from(eye), first);
    }
}

#[test]
fn gradient_of_the_background() {
    let (bottom, top) = (LinearRgb::new(0.1, 0.2, 0.3), LinearRgb::new(0.9, 0.6, 0.4));
    for target in [[0.0, 1.0, 0.1], [1.0, 0.0, 0.0], [3.0, 4.0, 0.0], [0.0, -4.0, 3.0]] {
        let mut scene = Scene::new(camera([0.0, 0.0, 0.0], target, 40.0), vec![]);
        scene = scene.with_background(Background::Gradient { bottom, top }).expect("light");
        let [x, y, z] = target.map(f64::from);
        let part = 0.5 * (y / (x * x + y * y + z * z).sqrt()) + 0.5;
        assert_close(seen(&scene), 0.2 + 0.4 * part);
    }
}

#[test]
fn squares_of_a_checker() {
    let (a, b) = (LinearRgb::grey(0.9), LinearRgb::grey(0.1));
    let board = Object::new(
        Plane::new(Vec3::new(1.0, 0.0, -2.0), Vec3::Y).expect("a plane"),
        Material::from(Checker::new(a, b, 2.0).expect("a pattern")),
    );
    // The square from (1, -2) to (3, 0) has colour a; its neighbours have colour b.
    for (x, z, expected) in
        [(1.5, -1.5, 0.9), (2.9, -0.1, 0.9), (3.1, -0.1, 0.1), (0.9, -1.5, 0.1), (0.9, -2.1, 0.9), (2.0, 0.1, 0.1)]
    {
        let mut scene = Scene::new(camera([x, 1.0, z + 1e-3], [x, 0.0, z], 1.0), vec![board.clone()]);
        scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
        assert_close(seen(&scene), expected);
    }
}

/// A pixel over two squares, or four, has the mean of its parts.
#[test]
fn edges_of_a_checker() {
    let (a, b) = (LinearRgb::grey(0.9), LinearRgb::grey(0.1));
    let board = Object::new(
        Plane::new(Vec3::ZERO, Vec3::Y).expect("a plane"),
        Material::from(Checker::new(a, b, 2.0).expect("a pattern")),
    );
    // The width of a pixel, from height 1 straight down.
    let width = 2.0 * tan_of_degrees(5.0);
    let share = |distance: f64| 0.5 - distance / width;
    let four = share(0.02) * share(-0.03) + share(-0.02) * share(0.03);
    for (x, z, of_a) in [(0.0, 1.0, 0.5), (2.02, 1.0, share(0.02)), (1.98, 1.0, share(-0.02)), (2.02, 1.97, four)] {
        let mut scene = Scene::new(camera([x, 1.0, z + 1e-3], [x, 0.0, z], 10.0), vec![board.clone()]);
        scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
        assert_close(seen(&scene), 0.1 + 0.8 * of_a);
    }
}

/// Returns the reflectance of a floor in one pixel that looks straight down at (x, z), with the
/// pixel's width.
fn straight_down(material: impl Into<Material>, [x, z]: [f32; 2], fov: f32) -> (f64, f64) {
    let floor = Object::new(Plane::new(Vec3::ZERO, Vec3::Y).expect("a plane"), material);
    let mut scene = Scene::new(camera([x, 1.0, z + 1e-3], [x, 0.0, z], fov), vec![floor]);
    scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
    (seen(&scene), 2.0 * tan_of_degrees(f64::from(fov) / 2.0))
}

/// Stripes are across the x axis; a pixel over an edge has the mean of its parts.
#[test]
fn stripes_and_their_edges() {
    let stripes = Stripes::new(LinearRgb::grey(0.9), LinearRgb::grey(0.1), 2.0).expect("a pattern");
    let share = |distance: f64, width: f64| 0.5 - distance / width;
    for z in [0.0, 7.3] {
        for (x, expected) in [(0.5, 0.9), (1.9, 0.9), (2.1, 0.1), (3.9, 0.1), (4.1, 0.9), (-0.1, 0.1), (-2.5, 0.9)] {
            assert_close(straight_down(stripes, [x, z], 1.0).0, expected);
        }
        for (x, distance) in [(2.0, 0.0), (2.02, 0.02), (1.98, -0.02)] {
            let (found, width) = straight_down(stripes, [x, z], 10.0);
            assert_close(found, 0.1 + 0.8 * share(distance, width));
        }
    }
}

/// A gradient is along the z axis; at its ends a pixel has the mean of both sides.
#[test]
fn a_gradient_and_its_ends() {
    let gradient = Gradient::new(LinearRgb::grey(0.1), LinearRgb::grey(0.9), 2.0).expect("a pattern");
    for x in [0.0, -3.7] {
        for (z, share) in [(0.5, 0.25), (1.5, 0.75), (2.5, 0.75), (3.5, 0.25), (-0.5, 0.25), (-1.5, 0.75)] {
            assert_close(straight_down(gradient, [x, z], 1.0).0, 0.1 + 0.8 * share);
        }
        for (z, is_end) in [(0.0, false), (2.0, true)] {
            let (found, width) = straight_down(gradient, [x, z], 10.0);
            // The mean distance from the end of a pixel in whose middle the end is.
            let off = 0.25 * width / 2.0;
            assert_close(found, 0.1 + 0.8 * if is_end { 1.0 - off } else { off });
        }
    }
}

/// Noise that is finer than a pixel is the mean of both colours.
#[test]
fn fine_noise_is_its_mean() {
    let noise = |size: f32| Noise::new(LinearRgb::grey(0.9), LinearRgb::grey(0.1), size).expect("a pattern");
    for place in [[0.0, 0.0], [12.3, -4.5], [-700.1, 33.3]] {
        assert_close(straight_down(noise(0.01), place, 10.0).0, 0.5);
        let coarse = straight_down(noise(1.0), place, 1.0).0;
        assert!((0.1..=0.9).contains(&coarse) && (coarse - 0.5).abs() > 1e-3, "{coarse}");
    }
}

#[test]
fn the_closest_crossing_in_front_of_the_eye_is_the_hit() {
    let sphere = Sphere::new(Vec3::ZERO, 2.0).expect("a sphere");
    let crossing = |z: f32| {
        let ray = Ray { origin: Vec3::new(0.0, 0.0, z), direction: Vec3::new(0.0, 0.0, -0.5) };
        sphere.closest_crossing(&Probe::new(ray), Interval::IN_FRONT).map(|t| (t, sphere.at_crossing(&ray, t).side))
    };
    assert_eq!(crossing(5.0), Some((6.0, Side::Front)), "from outside: the near one");
    assert_eq!(crossing(1.0), Some((6.0, Side::Back)), "from inside: the far one");
    assert_eq!(crossing(-3.0), None, "behind the eye: none");
}

#[test]
fn eye_rays_through_the_corners() {
    // Straight ahead along -z: the corners are at (±a tan(fov/2), ±tan(fov/2), -1).
    let rays = camera([1.0, 2.0, 3.0], [1.0, 2.0, -7.0], 60.0).eye_rays(1.5);
    let tan = libm::tanf(PI / 6.0);
    for (qu, qv, x, y) in [
        (0.0, 0.0, -1.5, -1.0),
        (1.0, 0.0, 1.5, -1.0),
        (0.0, 1.0, -1.5, 1.0),
        (1.0, 1.0, 1.5, 1.0),
        (0.5, 0.5, 0.0, 0.0),
    ] {
        let ray = rays.through(qu, qv);
        assert_eq!(ray.origin, Vec3::new(1.0, 2.0, 3.0));
        assert!(ray.direction.abs_diff_eq(Vec3::new(x * tan, y * tan, -1.0), 1e-6), "({qu}, {qv}): {}", ray.direction);
    }
}

#[test]
fn a_rectangle_of_its_own_shape_is_seen_whole() {
    // f = 2, w = 4, h = 1: half the width is 1 and half the height 0.25 at distance 1, in a picture of that shape (4).
    // In a wider one the height stays and the width follows; in a narrower one it is the other way round.
    let pose = camera([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 40.0).pose();
    let camera = Camera::new(pose, ViewRectangle::from_focal_length(2.0, 4.0, 1.0).unwrap()).unwrap();
    for (aspect, x, y) in [(4.0, 1.0, 0.25), (8.0, 2.0, 0.25), (1.0, 1.0, 1.0), (0.5, 1.0, 2.0)] {
        let corner = camera.eye_rays(aspect).through(1.0, 1.0).direction;
        assert!(corner.abs_diff_eq(Vec3::new(x, y, -1.0), 1e-6), "at {aspect}: {corner}");
    }
    // The same shape by a field of view and an aspect ratio.
    let by_angle = ViewRectangle::from_vertical_fov(2.0 * libm::atanf(0.25)).unwrap().with_aspect_ratio(4.0).unwrap();
    let corner = camera.with_rectangle(by_angle).eye_rays(1.0).through(0.0, 0.0).direction;
    assert!(corner.abs_diff_eq(Vec3::new(-1.0, -1.0, -1.0), 1e-6), "{corner}");
}

#[test]
fn another_field_of_view_keeps_the_rectangles_shape() {
    // 90 degrees: half the height is 1 at distance 1, and the width stays four times the height: in a square picture
    // half the width is 4, and so is half the height.
    let rectangle = ViewRectangle::from_focal_length(2.0, 4.0, 1.0).unwrap();
    let wider = rectangle.with_vertical_fov(PI / 2.0).unwrap();
    let pose = camera([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 40.0).pose();
    let corner = Camera::new(pose, wider).unwrap().eye_rays(1.0).through(1.0, 1.0).direction;
    assert!(corner.abs_diff_eq(Vec3::new(4.0, 4.0, -1.0), 1e-5), "{corner}");
}

#[test]
fn a_shift_goes_right_and_up_in_heights_of_the_rectangle() {
    // 2 wide and 1 high at distance 1, moved by half a height to the right and a quarter up.
    let rectangle = ViewRectangle::from_focal_length(1.0, 2.0, 1.0).unwrap().with_shift(Vec2::new(0.5, 0.25)).unwrap();
    let pose = camera([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 40.0).pose();
    let rays = Camera::new(pose, rectangle).unwrap().eye_rays(2.0);
    for (qu, qv, x, y) in [(0.0, 0.0, -0.5, -0.25), (0.5, 0.5, 0.5, 0.25), (1.0, 1.0, 1.5, 0.75)] {
        let direction = rays.through(qu, qv).direction;
        assert!(direction.abs_diff_eq(Vec3::new(x, y, -1.0), 1e-6), "({qu}, {qv}): {direction}");
    }
}

#[test]
fn patterns_lie_along_x_and_z_on_a_floor() {
    let plane = Plane::new(Vec3::new(1.0, 0.0, 2.0), Vec3::Y).expect("a plane");
    let ray = Ray { origin: Vec3::new(4.0, 5.0, 7.0), direction: -Vec3::Y };
    assert!(plane.at_crossing(&ray, 5.0).uv.abs_diff_eq(Vec2::new(3.0, 5.0), 1e-6));
}

#[test]
fn an_off_centre_rectangle_moves_the_picture_and_nothing_else() {
    // Shifted up by a quarter of its height, the rectangle shows the target a quarter of the height below its middle.
    let straight = camera([0.0, 0.0, 9.0], [0.0, 0.0, 0.0], 40.0);
    let shifted = straight.with_rectangle(straight.rectangle().with_shift(Vec2::new(0.0, 0.25)).unwrap());
    let sphere = |camera| {
        let mut scene = Scene::new(camera, vec![unit_sphere()]);
        scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
        picture(&scene, 200, 200)
    };
    let (straight, shifted) = (sphere(straight), sphere(shifted));
    for y in 0..150 {
        for x in 0..200 {
            assert_eq!(straight.pixel(x, y), shifted.pixel(x, y + 50), "({x}, {y})");
        }
    }
}

#[test]
fn light_becomes_srgb_by_its_own_curve() {
    // 12.92 x below the toe, 1.055 x^(1/2.4) - 0.055 above, rounded: worked out by hand for these.
    let mut scene = Scene::new(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0), vec![]);
    for (linear, code) in [(0.0, 0), (0.002, 7), (0.18, 118), (0.5, 188), (0.9, 243), (1.0, 255), (4.0, 255)] {
        scene = scene.with_background(Background::Color(LinearRgb::grey(linear))).expect("light");
        let shown = tone(&picture(&scene, 1, 1), &scene).pixels()[0];
        assert_eq!(shown.r, code, "{linear}");
    }
    // Exposure multiplies; Reinhard's curve makes 1 a half.
    scene = scene.with_background(Background::Color(LinearRgb::grey(0.25))).expect("light");
    scene = scene.with_exposure(2.0).expect("an exposure");
    assert_eq!(tone(&picture(&scene, 1, 1), &scene).pixels()[0].g, 188);
    scene = scene.with_exposure(4.0).expect("an exposure");
    scene = scene.with_tone_curve(ToneCurve::Reinhard);
    assert_eq!(tone(&picture(&scene, 1, 1), &scene).pixels()[0].g, 188);
    // Of a colour, the luminance is bent, and the hue stays: Y of (1, 0.5, 0) is 0.5702, and 1 / 1.5702 = 0.63686.
    scene = scene.with_background(Background::Color(LinearRgb::new(0.25, 0.125, 0.0))).expect("light");
    let orange = tone(&picture(&scene, 1, 1), &scene).pixels()[0];
    assert_eq!([orange.r, orange.g, orange.b], [209, 153, 0]);
    scene = scene.with_background(Background::Color(LinearRgb::grey(0.25))).expect("light");
    scene = scene.with_tone_curve(ToneCurve::Filmic);
    // (2.51 + 0.03) / (2.43 + 0.59 + 0.14) = 0.80380, which is encoded as 0.90824.
    assert_eq!(tone(&picture(&scene, 1, 1), &scene).pixels()[0].g, 232);
    // No light is too bright to be white.
    scene = scene.with_exposure(1e6).expect("an exposure");
    for curve in [ToneCurve::None, ToneCurve::Reinhard, ToneCurve::Filmic] {
        scene = scene.with_tone_curve(curve).with_background(Background::Color(LinearRgb::grey(1e12))).expect("light");
        assert_eq!(tone(&picture(&scene, 1, 1), &scene).pixels()[0].g, 255, "{curve:?}");
    }
}

#[test]
fn light_that_overflows_is_still_a_number() {
    // A light that nearly lies in the surface: I n.l / d^2 is beyond f32, and 0 times that would be NaN.
    let point = floor().shape.primitive(0).at_crossing(&Ray { origin: Vec3::Y, direction: -Vec3::Y }, 1.0);
    for height in [1e-10, 1e-18, 1e-22] {
        let text = format!(
            "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), lights: [Point(position: (0, {height}, 0), color: (1e12, 0, 1e-12), intensity: 1e12)])"
        );
        let scene = Scene::from_ron("bright.ron", &text).expect("a scene");
        let [lamp] = scene.lights() else { panic!("{scene:?}") };
        let arriving = incidence(lamp, &point).expect("it faces the light").light;
        assert!(arriving.is_finite(), "{arriving:?} at {height}");
    }
}
