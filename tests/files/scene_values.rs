//! The values of scene files: units, colour spaces, defaults and the two forms of each item.

use glam::{Vec2, Vec3};
use std::path::Path;
use termtrace::internals::light::{SpotLight, Sun};
use termtrace::internals::material::{Checker, Noise, Stripes};
use termtrace::internals::shape::Primitive;
use termtrace::{
    Background, Camera, Falloff, Light, LinearRgb, Material, Object, Plane, PointLight, Pose, Scene, Sphere, Srgb8,
    ToneCurve, ViewRectangle,
};

const CAMERA: &str = "camera: (eye: (0, 1, 5), target: (0, 1, 0))";

fn scene(fields: &str) -> Scene {
    Scene::from_ron("x.ron", &format!("({CAMERA}, {fields})")).unwrap_or_else(|error| panic!("{error}"))
}

fn camera(fields: &str) -> Scene {
    let text = format!("(camera: (eye: (0, 1, 5), target: (0, 1, 0), {fields}))");
    Scene::from_ron("x.ron", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn srgb(r: u8, g: u8, b: u8) -> LinearRgb {
    LinearRgb::from_srgb8(Srgb8::new(r, g, b))
}

#[test]
fn only_the_camera_must_be_given() {
    let scene = scene("");
    let pose = Pose { eye: Vec3::new(0.0, 1.0, 5.0), target: Vec3::new(0.0, 1.0, 0.0), up: Vec3::Y };
    assert_eq!(scene.camera().pose(), pose);
    let quarter = ViewRectangle::from_vertical_fov(std::f32::consts::FRAC_PI_4).unwrap();
    assert_eq!(scene.camera().rectangle(), quarter);
    assert_eq!(scene, Scene::new(*scene.camera(), Vec::new()));
}

#[test]
fn the_view_rectangle_has_two_forms() {
    let by_angle = camera("vertical_fov: 90, aspect_ratio: 1.5, shift: (0.25, -1)").camera().rectangle();
    assert!((by_angle.height() - 2.0).abs() < 1e-6 && (by_angle.width().unwrap() - 3.0).abs() < 1e-6);
    assert_eq!(by_angle.shift(), Vec2::new(0.25, -1.0));
    let by_length = camera("focal_length: 24, width: 36, height: 24").camera().rectangle();
    assert_eq!((by_length.width(), by_length.height()), (Some(1.5), 1.0));
}

#[test]
fn a_color_has_many_forms() {
    for (written, light) in [
        ("\"#f80\"", srgb(0xff, 0x88, 0x00)),
        ("\"#Ff8800\"", srgb(0xff, 0x88, 0x00)),
        ("\"SteelBlue\"", srgb(70, 130, 180)),
        ("(0.5, 2, 0)", LinearRgb::new(0.5, 2.0, 0.0)),
        ("[0.5, 2, 0]", LinearRgb::new(0.5, 2.0, 0.0)),
        ("0.25", LinearRgb::grey(0.25)),
        ("Some(0x2)", LinearRgb::grey(2.0)),
    ] {
        let scene = scene(&format!("background: {written}, ambient: {written}"));
        assert_eq!((scene.background(), scene.ambient()), (Background::Color(light), light), "{written}");
    }
    let gradient = scene("background: Gradient(bottom: 0, top: \"white\")").background();
    let (bottom, top) = (LinearRgb::BLACK, LinearRgb::grey(1.0));
    assert_eq!(gradient, Background::Gradient { bottom, top });
}

/// A view takes missing fields from the camera; of the lens, all or none.
#[test]
fn views_default_to_the_camera() {
    let text = "(
        camera: (eye: (0, 0, 5), target: (0, 0, 0), up: (1, 2, 0), vertical_fov: 30, shift: (0, 1)),
        views: [
            (eye: (1, 0, 5), target: (0, 1, 0)),
            (eye: (1, 0, 5), target: (0, 1, 0), up: (0, 0, 1), vertical_fov: 90),
        ],
    )";
    let scene = Scene::from_ron("views.ron", text).unwrap();
    let [eye, target] = [Vec3::new(1.0, 0.0, 5.0), Vec3::Y];
    let up = Vec3::new(1.0, 2.0, 0.0);
    let like_it = scene.camera().with_pose(Pose { eye, target, up }).unwrap();
    let quarter = ViewRectangle::from_vertical_fov(std::f32::consts::FRAC_PI_2).unwrap();
    let other = Camera::new(Pose { eye, target, up: Vec3::Z }, quarter).unwrap();
    assert_eq!(scene.views(), [like_it, other]);
}

/// A view in the form that the live view writes is the camera.
#[test]
fn a_camera_can_be_written_as_a_view() {
    let line = "camera: (eye: (0, 1.5, 6), target: (0, 0.7, 0), vertical_fov: 40)";
    let view = "(eye: (1, 0, 5), target: (0, 1, 0), focal_length: 1, width: 1.5, height: 1, shift: (0, 0.5))";
    let scene = Scene::from_ron("views.ron", &format!("({line}, views: [{view}])")).unwrap();
    assert_eq!(scene.views()[0].to_ron(), format!("camera: {view}"));
}

#[test]
fn lights_multiply_color_by_intensity() {
    let lights = scene(
        "lights: (Point(position: (1, 2, 3)), Point(position: [1, 2, 3], color: (1, 0.5, 0), intensity: 4, falloff: None))",
    )
    .lights()
    .to_vec();
    let position = Vec3::new(1.0, 2.0, 3.0);
    let light =
        |intensity, falloff| Light::from(PointLight::new(position, intensity).expect("a light").with_falloff(falloff));
    let expected =
        [light(LinearRgb::grey(1.0), Falloff::InverseSquare), light(LinearRgb::new(4.0, 2.0, 0.0), Falloff::None)];
    assert_eq!(lights, expected);
}

#[test]
fn spots_and_suns_are_white_by_default() {
    let lights = scene(
        "lights: [
            Spot(position: (1, 2, 3), target: (1, 0, 3)),
            Spot(position: (1, 2, 3), target: (1, 0, 3), angle: 40, softness: 0.2, color: 1, intensity: 1, falloff: InverseSquare),
            Sun(direction: (0, 4, 3)), Sun(direction: (0, 40, 30), color: \"white\", intensity: 1),
        ]",
    )
    .lights()
    .to_vec();
    let [position, target] = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 0.0, 3.0)];
    let spot = Light::from(SpotLight::new(position, target, LinearRgb::grey(1.0)).expect("a light"));
    let sun = Light::from(Sun::new(Vec3::new(0.0, 0.8, 0.6), LinearRgb::grey(1.0)).expect("a light"));
    assert_eq!(lights[..2], [spot, spot]);
    assert_eq!(lights[2], lights[3]);
    assert_eq!(lights[2], sun);
}

#[test]
fn patterns_are_grey_by_default() {
    let plane = |material: &str| format!("Plane(point: (0, 0, 0), normal: (0, 1, 0), material: {material})");
    let scene = scene(&format!("objects: [{}, {}]", plane("Stripes()"), plane("Noise()")));
    let (light, dark) = (srgb(0xdd, 0xdd, 0xdd), srgb(0x33, 0x33, 0x33));
    let stripes = Stripes::new(light, dark, 1.0).expect("a pattern");
    let noise = Noise::new(light, dark, 1.0).expect("a pattern");
    let expected = [Material::from(stripes), Material::from(noise)];
    assert_eq!(scene.objects().iter().map(|object| object.material).collect::<Vec<_>>(), expected);
}

#[test]
fn objects_and_their_materials() {
    let scene = scene(
        "materials: {\"floor\": Checker(size: 2), \"red\": Diffuse(reflectance: \"red\")},
        objects: [
            Sphere(center: (1, 2, 3), radius: 4),
            Sphere(center: (1, 2, 3), radius: 4, material: \"red\"),
            Sphere(center: (1, 2, 3), radius: 4, material: Diffuse(0.5)),
            Plane(point: (0, 1, 0), normal: (0, 1e-30, 0), material: \"floor\"),
        ]",
    );
    let sphere = Sphere::new(Vec3::new(1.0, 2.0, 3.0), 4.0).expect("a sphere");
    let checker = Material::from(Checker::new(srgb(0xdd, 0xdd, 0xdd), srgb(0x33, 0x33, 0x33), 2.0).expect("a pattern"));
    let expected = [
        Object::new(sphere, Material::DEFAULT),
        Object::new(sphere, Material::diffuse(srgb(255, 0, 0)).expect("a reflectance")),
        Object::new(sphere, Material::diffuse(LinearRgb::grey(0.5)).expect("a reflectance")),
        Object::new(Plane::new(Vec3::Y, Vec3::Y).expect("a plane"), checker),
    ];
    assert_eq!(scene.objects(), expected);
}

#[test]
fn how_the_light_is_shown() {
    let scene = scene("shadows: false, exposure: 2, tone_curve: Reinhard");
    assert_eq!((scene.shadows(), scene.exposure(), scene.tone_curve()), (false, 2.0, ToneCurve::Reinhard));
}

fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    let shape = &scene.objects()[0].shape;
    let corners = (0..shape.primitive_count()).map(|primitive| match shape.primitive(primitive) {
        Primitive::Triangle(triangle) => triangle.corners(),
        Primitive::Facet(facet) => facet.triangle().corners(),
        other => panic!("{other:?}"),
    });
    corners.collect()
}

#[test]
fn triangles_have_three_corners() {
    let scene = scene("objects: [Triangle(corners: [(0, 0, 0), (1, 2, 3), (-1, 1e9, 0)])]");
    assert_eq!(corners(&scene), [[Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0), Vec3::new(-1.0, 1e9, 0.0)]]);
    assert_eq!(scene.objects()[0].material, Material::DEFAULT);
}

/// Meshes are scaled, turned about x, y and z, and moved, in this order.
///
/// The file has the tetrahedron between the origin and the points at the distances 1, 2 and 3 on the axes.
#[test]
fn meshes_are_scaled_turned_and_moved() {
    let mesh = |fields: &str| {
        let mesh = scene(&format!("objects: [Mesh(path: \"tests/meshes/tetrahedron.ply\"{fields})]"));
        let mut corners = corners(&mesh);
        let is_outward = |[a, b, c]: &[Vec3; 3], middle: Vec3| (*b - *a).cross(*c - *a).dot(*a - middle) > 0.0;
        let middle = corners.iter().flatten().sum::<Vec3>() / (3 * corners.len()) as f32;
        assert!(corners.iter().all(|corners| is_outward(corners, middle)), "{fields}: its front is outside");
        let mut points: Vec<Vec3> = corners.drain(..).flatten().collect();
        points.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
        points.dedup();
        points
    };
    let sorted = |mut points: Vec<Vec3>| {
        points.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
        points
    };
    let (o, x, y, z) = (Vec3::ZERO, Vec3::X, 2.0 * Vec3::Y, 3.0 * Vec3::Z);
    assert_eq!(mesh(""), sorted(vec![o, x, y, z]));
    assert_eq!(
        mesh(", scale: 2, translate: (1, 2, 3)"),
        sorted([o, x, y, z].map(|p| 2.0 * p + Vec3::new(1.0, 2.0, 3.0)).into())
    );
    assert_eq!(mesh(", scale: (2, 3, 4)"), sorted(vec![o, 2.0 * x, 3.0 * y, 4.0 * z]));
    assert_eq!(mesh(", scale: (-1, 1, 1)"), sorted(vec![o, -x, y, z]), "mirrored");
    assert_eq!(mesh(", rotate: (90, 0, 0)"), sorted(vec![o, x, 2.0 * Vec3::Z, -3.0 * Vec3::Y]));
    assert_eq!(mesh(", rotate: (0, 90, 0)"), sorted(vec![o, -Vec3::Z, y, 3.0 * Vec3::X]));
    assert_eq!(mesh(", rotate: (0, 0, -270)"), sorted(vec![o, Vec3::Y, -2.0 * Vec3::X, z]));
    assert_eq!(
        mesh(", scale: (2, 1, 1), rotate: (90, 90, 0)"),
        sorted(vec![o, -2.0 * Vec3::Z, 2.0 * Vec3::X, -3.0 * Vec3::Y]),
        "x, then y"
    );
}

/// A file's own colours are used, unless the scene has others.
#[test]
fn meshes_keep_their_colours() {
    let light = |fields: &str| {
        let mut scene = Scene::from_ron(
            "x.ron",
            &format!("(camera: (eye: (0.5, 0.5, 3), target: (0.5, 0.5, 0), vertical_fov: 1), ambient: 1, objects: [Mesh({fields})])"),
        )
        .unwrap_or_else(|error| panic!("{error}"));
        scene = scene.with_shadows(false);
        let resolution = termtrace::Resolution::square(1, 1);
        termtrace::render(&scene, scene.camera(), resolution, std::num::NonZeroU32::MIN).pixel(0, 0)
    };
    let coloured = light("path: \"tests/meshes/square.ply\"");
    assert!(coloured != LinearRgb::grey(0.8) && coloured != LinearRgb::BLACK, "{coloured:?}");
    let textured = light("path: \"tests/meshes/square.obj\"");
    assert!(textured != LinearRgb::grey(0.8) && textured != LinearRgb::BLACK, "{textured:?}");
    assert_eq!(
        light("path: \"tests/meshes/square.ply\", material: Diffuse((0.25, 0.5, 1))"),
        LinearRgb::new(0.25, 0.5, 1.0)
    );
    assert_eq!(light("path: \"tests/meshes/square_floats.ply\", material: Diffuse(0.5)"), LinearRgb::grey(0.5));
}

#[test]
fn a_mesh_alone_is_a_scene() {
    let scene = Scene::load(Path::new("scenes/teapot.obj")).unwrap_or_else(|error| panic!("{error}"));
    let resolution = termtrace::Resolution::square(80, 48);
    let picture = termtrace::render(&scene, scene.camera(), resolution, std::num::NonZeroU32::MIN);
    let rays = scene.camera().eye_rays(resolution.aspect_ratio());
    let object = |x: u32, y: u32| {
        let ray = rays.through((x as f32 + 0.5) / 80.0, 1.0 - (y as f32 + 0.5) / 48.0);
        termtrace::internals::hit::closest_hit(&scene, &ray).map(|hit| hit.object)
    };
    let all = || (0..48).flat_map(|y| (0..80).map(move |x| (x, y)));
    let seen: Vec<_> = all().filter(|&(x, y)| object(x, y) == Some(0)).collect();
    assert!(seen.len() > 400, "it fills the picture: {} pixels", seen.len());
    assert!(seen.iter().all(|&(x, y)| x > 0 && x < 79 && y > 0 && y < 47), "and is seen whole");
    assert!(all().any(|(x, y)| object(x, y) == Some(1)), "on a floor");
    assert!(seen.iter().any(|&(x, y)| picture.pixel(x, y).r > 0.3), "in light");
}

#[test]
fn a_mesh_without_a_visible_size_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("point.obj", "v 1 2 3\nf 1 1 1\n"),
        ("far.obj", "v 1e8 0 0\nv 1e8 1 0\nv 1e8 0 1\nf 1 2 3\n"),
        ("large.obj", "v 1e30 0 0\nv 0 1e30 0\nv 0 0 1e30\nf 1 2 3\n"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let message = Scene::load(&path).unwrap_err().to_string();
        assert!(message.contains("this mesh has no size"), "{name}: {message}");
    }
}

/// The extreme numbers of a scene divide by no zero and overflow no bound of the tracer.
#[test]
fn extreme_values_make_a_picture() {
    let text = "(
        camera: (eye: (1e9, 1e9, 1e9), target: (-1e9, 0, 1e9), up: (0, 1e-8, 0), vertical_fov: 179.9, shift: (1000, -1000)),
        lights: [
            Point(position: (1e9, 1, 1e9), color: 1e12, intensity: 1e12), Point(position: (0, 0, 0)),
            Spot(position: (1e9, 1, 1e9), target: (1e9, 1, 0), angle: 180, softness: 0, color: 1e12, intensity: 1e12),
            Spot(position: (0, 0, 0), target: (0, 0, 1e-9), angle: 0.001, softness: 1),
            Sun(direction: (1e9, 1e-9, -1e9), color: 1e12, intensity: 1e12),
        ],
        objects: [
            Sphere(center: (-1e9, 1e9, 0), radius: 1e9), Sphere(center: (0, 0, 0), radius: 1e-9),
            Plane(point: (0, -1e9, 0), normal: (1e9, 1e-9, -1e9), material: Checker(size: 1e-9)),
            Plane(point: (0, 0, 1e9), normal: (0, 1, 0), material: Stripes(width: 1e-9)),
            Plane(point: (0, 1e9, 0), normal: (0, 1, 1), material: Gradient(from: 0, to: 1, length: 1e-9)),
            Plane(point: (1e9, 0, 0), normal: (1, 1, 0), material: Noise(size: 1e-9)),
        ],
        exposure: 1e6, tone_curve: Filmic,
    )";
    let scene = Scene::from_ron("x.ron", text).unwrap_or_else(|error| panic!("{error}"));
    let resolution = termtrace::Resolution::square(16, 8);
    let one = std::num::NonZeroU32::MIN;
    let frame = termtrace::render(&scene, scene.camera(), resolution, one);
    assert_eq!(termtrace::tone(&frame, &scene).pixels().len(), 128);
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let load = |path: &Path| Scene::load(path).unwrap_err().to_string();
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("no\u{1b}such.ron");
    assert!(load(&missing).ends_with("no\u{fffd}such.ron: there is no such file"));
    assert!(load(folder.path()).ends_with(": this is a directory, not a file"));
    let large = folder.path().join("large.ron");
    std::fs::File::create(&large).unwrap().set_len(1 << 40).unwrap();
    assert!(load(&large).ends_with(": the file is larger than 16 MiB, too large to be read"));
}
