//! Scenes built in code: invalid values are errors in the words of scene files.

use glam::{Vec2, Vec3};
use std::error::Error;
use termtrace::internals::light::{SpotLight, Sun};
use termtrace::internals::material::{Checker, Gradient, Noise, Stripes};
use termtrace::{
    Background, Camera, Falloff, LinearRgb, Material, Mesh, Plane, PointLight, Pose, Scene, Sphere, ToneCurve,
    Triangle, ViewRectangle,
};

fn camera() -> Camera {
    Camera::look_at(Vec3::Z * 5.0, Vec3::ZERO).expect("a view")
}

/// Returns the message of an error, without the name and value at its start, if any.
fn message<T>(made: Result<T, impl Error>) -> String {
    let error = made.map(drop).expect_err("a fault").to_string();
    error.rsplit(": ").next().unwrap_or_default().to_owned()
}

/// Returns the message of a scene file's first fault, without its position.
fn in_file(fields: &str) -> String {
    let has_camera = fields.contains("camera:");
    let camera = if has_camera { "" } else { "camera: (eye: (0, 0, 5), target: (0, 0, 0)), " };
    let error = Scene::from_ron("x.ron", &format!("({camera}{fields})")).expect_err(fields);
    error.reports()[0].message.clone()
}

fn shape(shape: &str) -> String {
    in_file(&format!("objects: [{shape}]"))
}

fn material(material: &str) -> String {
    shape(&format!("Plane(point: (0, 0, 0), normal: (0, 1, 0), material: {material})"))
}

fn pose(eye: Vec3, target: Vec3, up: Vec3) -> Result<Camera, impl Error> {
    Camera::new(Pose { eye, target, up }, camera().rectangle())
}

#[test]
fn shapes_are_refused_in_the_words_of_scene_files() {
    let (o, x) = (Vec3::ZERO, Vec3::X);
    for (code, file) in [
        (message(Sphere::new(o, 0.0)), shape("Sphere(center: (0, 0, 0), radius: 0)")),
        (message(Sphere::new(o, -1.0)), shape("Sphere(center: (0, 0, 0), radius: -1)")),
        (message(Sphere::new(o, 1e-10)), shape("Sphere(center: (0, 0, 0), radius: 1e-10)")),
        (message(Sphere::new(o, 1e10)), shape("Sphere(center: (0, 0, 0), radius: 1e10)")),
        (message(Sphere::new(o, f32::NAN)), shape("Sphere(center: (0, 0, 0), radius: NaN)")),
        (message(Sphere::new(o, f32::INFINITY)), shape("Sphere(center: (0, 0, 0), radius: inf)")),
        (message(Sphere::new(Vec3::NAN, 1.0)), shape("Sphere(center: (0, NaN, 0), radius: 1)")),
        (message(Sphere::new(x * 2e9, 1.0)), shape("Sphere(center: (2e9, 0, 0), radius: 1)")),
        (message(Plane::new(o, o)), shape("Plane(point: (0, 0, 0), normal: (0, 0, 0))")),
        (message(Plane::new(o, x * -1e10)), shape("Plane(point: (0, 0, 0), normal: (-1e10, 0, 0))")),
        (message(Plane::new(Vec3::NEG_INFINITY, x)), shape("Plane(point: (0, -inf, 0), normal: (1, 0, 0))")),
        (message(Triangle::new([o, o, x])), shape("Triangle(corners: [(0, 0, 0), (0, 0, 0), (1, 0, 0)])")),
        (message(Triangle::new([o, x, x * 3.0])), shape("Triangle(corners: [(0, 0, 0), (1, 0, 0), (3, 0, 0)])")),
        (message(Triangle::new([o, x, Vec3::NAN])), shape("Triangle(corners: [(0, 0, 0), (1, 0, 0), (0, 0, NaN)])")),
        (message(Triangle::new([o, x, x * 1e10])), shape("Triangle(corners: [(0, 0, 0), (1, 0, 0), (1e10, 0, 0)])")),
    ] {
        assert_eq!(code, file);
    }
}

#[test]
fn lights_and_materials_are_refused_in_the_words_of_scene_files() {
    let (grey, o) = (LinearRgb::grey, Vec3::ZERO);
    let light = |light: &str| in_file(&format!("lights: [Point(position: (0, 0, 0), {light})]"));
    for (code, file) in [
        (message(PointLight::new(o, grey(-1.0))), light("color: -1")),
        (message(PointLight::new(o, grey(2e12))), light("color: 2e12")),
        (message(PointLight::new(o, grey(f32::NAN))), light("color: NaN")),
        (message(PointLight::new(Vec3::NAN, grey(1.0))), in_file("lights: [Point(position: (NaN, 0, 0))]")),
        (message(PointLight::new(o - Vec3::X * 1e20, grey(1.0))), in_file("lights: [Point(position: (-1e20, 0, 0))]")),
        (message(Material::diffuse(grey(1.5))), material("Diffuse(1.5)")),
        (message(Material::diffuse(LinearRgb::new(0.0, 0.0, -0.1))), material("Diffuse((0, 0, -0.1))")),
        (message(Material::diffuse(grey(f32::NAN))), material("Diffuse(NaN)")),
        (message(Checker::new(grey(2.0), grey(0.5), 1.0)), material("Checker(a: 2)")),
        (message(Checker::new(grey(0.5), grey(-2.0), 1.0)), material("Checker(b: -2)")),
        (message(Checker::new(grey(0.5), grey(0.5), 0.0)), material("Checker(size: 0)")),
        (message(Material::checker(grey(0.5), grey(0.5), 1e-12)), material("Checker(size: 1e-12)")),
        (message(Stripes::new(grey(2.0), grey(0.5), 1.0)), material("Stripes(a: 2)")),
        (message(Stripes::new(grey(0.5), grey(0.5), 0.0)), material("Stripes(width: 0)")),
        (message(Gradient::new(grey(0.5), grey(-1.0), 1.0)), material("Gradient(from: 0.5, to: -1)")),
        (message(Gradient::new(grey(0.5), grey(0.5), 1e10)), material("Gradient(from: 0.5, to: 0.5, length: 1e10)")),
        (message(Noise::new(grey(0.5), grey(f32::NAN), 1.0)), material("Noise(b: NaN)")),
        (message(Noise::new(grey(0.5), grey(0.5), -1.0)), material("Noise(size: -1)")),
    ] {
        assert_eq!(code, file);
    }
}

#[test]
fn spots_and_suns_are_refused_in_the_words_of_scene_files() {
    let (grey, o, y) = (LinearRgb::grey, Vec3::ZERO, Vec3::Y);
    let sun = |sun: &str| in_file(&format!("lights: [Sun({sun})]"));
    let sized = |degrees| Sun::new(y, grey(1.0)).expect("a light").with_size(degrees);
    let spot = |rest: &str| in_file(&format!("lights: [Spot(position: (0, 1, 0), {rest})]"));
    let cone = |degrees, softness| SpotLight::new(y, o, grey(1.0)).expect("a light").with_cone(degrees, softness);
    for (code, file) in [
        (message(Sun::new(o, grey(1.0))), sun("direction: (0, 0, 0)")),
        (message(Sun::new(y * 2e9, grey(1.0))), sun("direction: (0, 2e9, 0)")),
        (message(Sun::new(y, grey(-1.0))), sun("direction: (0, 1, 0), color: -1")),
        (message(sized(-0.5)), sun("direction: (0, 1, 0), size: -0.5")),
        (message(sized(90.5)), sun("direction: (0, 1, 0), size: 90.5")),
        (message(sized(f32::NAN)), sun("direction: (0, 1, 0), size: NaN")),
        (message(SpotLight::new(y, y, grey(1.0))), spot("target: (0, 1, 0)")),
        (message(SpotLight::new(y, Vec3::NAN, grey(1.0))), spot("target: (NaN, 0, 0)")),
        (message(SpotLight::new(y, o, grey(2e12))), spot("target: (0, 0, 0), color: 2e12")),
        (message(cone(0.0, 0.5)), spot("target: (0, 0, 0), angle: 0")),
        (message(cone(180.5, 0.5)), spot("target: (0, 0, 0), angle: 180.5")),
        (message(cone(40.0, -0.5)), spot("target: (0, 0, 0), softness: -0.5")),
        (message(cone(40.0, f32::INFINITY)), spot("target: (0, 0, 0), softness: inf")),
    ] {
        assert_eq!(code, file);
    }
}

#[test]
fn scenes_are_refused_in_the_words_of_scene_files() {
    let scene = || Scene::builder(camera());
    let grey = LinearRgb::grey;
    let gradient = |bottom, top| Background::Gradient { bottom: grey(bottom), top: grey(top) };
    let checker = || Checker::new(grey(0.5), grey(0.2), 1.0).expect("a pattern");
    let ball = Sphere::new(Vec3::ZERO, 1.0).expect("a sphere");
    let built = scene().build().expect("a scene");
    for (code, file) in [
        (message(scene().exposure(0.0).build()), in_file("exposure: 0")),
        (message(scene().exposure(2e6).build()), in_file("exposure: 2e6")),
        (message(scene().exposure(f32::NAN).build()), in_file("exposure: NaN")),
        (message(built.clone().with_exposure(-1.0)), in_file("exposure: -1")),
        (message(scene().ambient(grey(-1.0)).build()), in_file("ambient: -1")),
        (message(scene().ambient(grey(f32::NAN)).build()), in_file("ambient: NaN")),
        (message(built.clone().with_ambient(grey(1e13))), in_file("ambient: 1e13")),
        (message(scene().background(grey(-1.0)).build()), in_file("background: -1")),
        (
            message(scene().background(gradient(1.0, 1e13)).build()),
            in_file("background: Gradient(bottom: 1, top: 1e13)"),
        ),
        (message(built.with_background(gradient(-1.0, 1.0))), in_file("background: Gradient(bottom: -1, top: 1)")),
        (
            message(scene().object(ball, checker()).build()),
            shape("Sphere(center: (0, 0, 0), radius: 1, material: Checker(size: 1))"),
        ),
    ] {
        assert_eq!(code, file);
    }
    let second = scene().object(ball, Material::DEFAULT).object(ball, checker()).build().expect_err("a fault");
    assert!(second.to_string().starts_with("object 2: a Checker needs a Plane"), "{second}");
}

#[test]
fn cameras_are_refused_in_the_words_of_scene_files() {
    let (o, y, z) = (Vec3::ZERO, Vec3::Y, Vec3::Z);
    let view = |rest: &str| in_file(&format!("camera: (eye: (0, 0, 1), target: (0, 0, 0), {rest})"));
    let rectangle = camera().rectangle();
    for (code, file) in [
        (message(Camera::look_at(z, z)), in_file("camera: (eye: (0, 0, 1), target: (0, 0, 1))")),
        (message(Camera::look_at(z * 1e10, o)), in_file("camera: (eye: (0, 0, 1e10), target: (0, 0, 0))")),
        (message(pose(z, o, o)), view("up: (0, 0, 0)")),
        (message(pose(z, o, y * 1e-10)), view("up: (0, 1e-10, 0)")),
        (message(pose(z, o, y * -1e10)), view("up: (0, -1e10, 0)")),
        (message(camera().with_up(z)), view("up: (0, 0, 1)")),
        (message(camera().with_fov_degrees(0.0)), view("vertical_fov: 0")),
        (message(camera().with_fov_degrees(180.0)), view("vertical_fov: 180")),
        (message(rectangle.with_aspect_ratio(1e-7)), view("aspect_ratio: 1e-7")),
        (message(rectangle.with_shift(Vec2::X * 1001.0)), view("shift: (1001, 0)")),
        (message(rectangle.with_tilt(Vec2::Y * 1.56)), view("tilt: (0, 89.4)")),
        (
            message(rectangle.with_shift(Vec2::Y * 2.0).and_then(|shifted| shifted.with_tilt(Vec2::Y))),
            view("shift: (0, 2), tilt: (0, 57.3)"),
        ),
        (message(ViewRectangle::from_focal_length(1.0, 1.0, 2e6)), view("focal_length: 1, width: 1, height: 2e6")),
    ] {
        assert_eq!(code, file);
    }
}

#[test]
fn meshes_with_faults_are_errors() {
    let corners = || vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let error = |positions, indices| Mesh::from_triangles(positions, indices).expect_err("a fault").to_string();
    assert_eq!(error(corners(), vec![]), "indices: a mesh has 1 to 67108864 triangles; there are 0");
    assert_eq!(
        error(corners(), vec![[0, 1, 2], [0, 1, 3]]),
        "indices[1] is [0, 1, 3]: position 3 does not exist: there are 3"
    );
    let far = vec![Vec3::ZERO, Vec3::X * 2e9, Vec3::Y];
    assert!(
        error(far, vec![[0, 1, 2]]).starts_with("positions[1] is (2000000000, 0, 0): coordinates must lie within ±1e9")
    );
    assert!(error(vec![Vec3::NAN; 3], vec![[0, 1, 2]]).ends_with("the number must be finite"));
    assert!(Mesh::from_triangles(corners(), vec![[0, 1, 1]]).is_ok(), "without an area, as in a mesh file");
}

/// Every scene that a file accepts can be built in code, and is the same scene.
#[test]
fn a_scene_in_code_is_the_scene_of_a_file() {
    let text = "(
        camera: (eye: (0, 1.5, 6), target: (0, 0.7, 0), vertical_fov: 40),
        views: [(eye: (6, 1.5, 0), target: (0, 0.7, 0), up: (0, 1, 1))],
        background: Gradient(bottom: 0.5, top: (0, 0.25, 1)),
        ambient: 0.125,
        exposure: 2,
        tone_curve: Filmic,
        shadows: false,
        lights: [
            Point(position: (3, 5, 4), intensity: 45), Point(position: (0, 9, 0), color: (1, 0.5, 0), falloff: None),
            Spot(position: (3, 5, 4), target: (0, 1, 0), angle: 30, softness: 1, intensity: 2, falloff: None),
            Sun(direction: (1, 2, -3), size: 0.5, color: (1, 0.5, 0)),
        ],
        objects: [
            Sphere(center: (0, 1, 0), radius: 1, material: Diffuse((0.8, 0.1, 0.1))),
            Sphere(center: (1, 1, 0), radius: 1e-9),
            Plane(point: (0, 0, 0), normal: (1, 2, -3), material: Checker(a: 0.25, b: 1, size: 1e-9)),
            Triangle(corners: [(0, 0, 0), (1, 0, 0), (0, 1e9, 0)]),
            Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Stripes(a: 0.25, b: 1, width: 2)),
            Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Gradient(from: 0.25, to: 1, length: 2)),
            Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Noise(a: 0.25, b: 1, size: 2)),
        ],
    )";
    let built = || -> Result<Scene, Box<dyn Error>> {
        let camera = Camera::look_at(Vec3::new(0.0, 1.5, 6.0), Vec3::new(0.0, 0.7, 0.0))?.with_fov_degrees(40.0)?;
        let side = Pose { eye: Vec3::new(6.0, 1.5, 0.0), up: Vec3::new(0.0, 1.0, 1.0), ..camera.pose() };
        let above = PointLight::new(Vec3::Y * 9.0, LinearRgb::new(1.0, 0.5, 0.0))?;
        let pattern = Material::checker(LinearRgb::grey(0.25), LinearRgb::grey(1.0), 1e-9)?;
        let (dark, white, floor) = (LinearRgb::grey(0.25), LinearRgb::grey(1.0), Plane::new(Vec3::ZERO, Vec3::Y)?);
        let spot = SpotLight::new(Vec3::new(3.0, 5.0, 4.0), Vec3::Y, LinearRgb::grey(2.0))?.with_cone(30.0, 1.0)?;
        let red = Material::diffuse(LinearRgb::new(0.8, 0.1, 0.1))?;
        Ok(Scene::builder(camera)
            .view(camera.with_pose(side)?)
            .background(Background::Gradient { bottom: LinearRgb::grey(0.5), top: LinearRgb::new(0.0, 0.25, 1.0) })
            .ambient(LinearRgb::grey(0.125))
            .exposure(2.0)
            .tone_curve(ToneCurve::Filmic)
            .shadows(false)
            .light(PointLight::new(Vec3::new(3.0, 5.0, 4.0), LinearRgb::grey(45.0))?)
            .light(above.with_falloff(Falloff::None))
            .light(spot.with_falloff(Falloff::None))
            .light(Sun::new(Vec3::new(1.0, 2.0, -3.0), LinearRgb::new(1.0, 0.5, 0.0))?.with_size(0.5)?)
            .object(Sphere::new(Vec3::Y, 1.0)?, red)
            .object(Sphere::new(Vec3::new(1.0, 1.0, 0.0), 1e-9)?, Material::DEFAULT)
            .object(Plane::new(Vec3::ZERO, Vec3::new(1.0, 2.0, -3.0))?, pattern)
            .object(Triangle::new([Vec3::ZERO, Vec3::X, Vec3::Y * 1e9])?, Material::DEFAULT)
            .object(floor, Stripes::new(dark, white, 2.0)?)
            .object(floor, Gradient::new(dark, white, 2.0)?)
            .object(floor, Noise::new(dark, white, 2.0)?)
            .build()?)
    };
    let built = built().unwrap_or_else(|error| panic!("{error}"));
    let read = Scene::from_ron("x.ron", text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(built, read);
}

#[test]
fn a_scene_is_shown_without_its_trees() {
    let ball = Sphere::new(Vec3::ZERO, 1.0).expect("a sphere");
    let light = PointLight::new(Vec3::ONE, LinearRgb::grey(9.0)).expect("a light");
    let scene = Scene::builder(camera()).object(ball, Material::DEFAULT).light(light).build().expect("a scene");
    let (long, short) = (format!("{scene:#?}"), format!("{scene:?}"));
    assert!(long.contains("Sphere") && short.contains("radius: 1.0"), "{long}");
    assert!(long.lines().count() <= 60, "{long}");
    assert!(short.len() < 700, "{short}");
    let many = Mesh::from_triangles(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]; 1000]).expect("a mesh");
    assert_eq!(format!("{many:?}"), "Mesh { triangles: 1000, .. }");
}
