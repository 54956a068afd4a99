//! Pictures on shapes: the texel at each point, and holes, by hand.
//!
//! `tests/images/make.py` writes the pictures: the texel of column c and row r is (60 c + 20, 60 r + 20, 100).

use glam::Vec3;
use std::f64::consts::PI;
use std::num::NonZeroU32;
use termtrace::internals::hit::{Kernel, any_hit, any_hits, closest_hit, closest_hit_observed, closest_hits};
use termtrace::internals::hit::{TestCount, any_hit_observed};
use termtrace::internals::ray::{EightRays, Interval, Ray};
use termtrace::{LinearRgb, Resolution, Scene, Srgb8, explain, render};

/// Returns a scene in the folder of the pictures, lit equally from everywhere.
fn scene(fields: &str, objects: &str) -> Scene {
    let text = format!("(camera: (eye: (0, 0, 9), target: (0, 0, 0)), ambient: 1, {fields} objects: [{objects}])");
    Scene::from_ron("tests/images/scene.ron", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the light along a ray that meets `at` from the direction `from`.
fn light_at(scene: &Scene, at: Vec3, from: Vec3) -> LinearRgb {
    let up = if from.y.abs() > 0.9 { Vec3::Z } else { Vec3::Y };
    let pose = termtrace::Pose { eye: at + from, target: at, up };
    let camera = scene.camera().with_pose(pose).expect("a pose");
    let size = Resolution::square(1, 1);
    render(scene, &camera, size, NonZeroU32::MIN).pixels()[0]
}

fn texel([column, row]: [u8; 2]) -> LinearRgb {
    LinearRgb::from_srgb8(Srgb8::new(60 * column + 20, 60 * row + 20, 100))
}

/// Asserts that a shape with the picture shows a texel at a point, seen from a direction.
#[track_caller]
fn assert_texel(shape: &str, at: [f64; 3], from: [f64; 3], expected: [u8; 2]) {
    let scene = scene("", &format!("{shape}, material: Image(path: \"grid.png\", filter: Nearest))"));
    let [at, from] = [at, from].map(|vector| Vec3::from(vector.map(|x| x as f32)));
    let found = light_at(&scene, at, from);
    assert_eq!(found, texel(expected), "{shape} at {at} from {from}: texel {expected:?}");
}

#[test]
fn flat_shapes_show_their_texels_where_they_should() {
    let quad = "Quad(corner: (0, 0, 0), edges: [(4, 0, 0), (0, 4, 0)]";
    for [column, row] in [[0, 0], [2, 0], [1, 3], [3, 2]] {
        let (x, y) = (f64::from(column) + 0.5, 3.5 - f64::from(row));
        assert_texel(quad, [x, y, 0.0], [0.0, 0.0, 2.0], [column, row]);
        assert_texel(quad, [x, y, 0.0], [0.0, 0.0, -2.0], [column, row]);
    }
    let leaning = "Quad(corner: (1, 0, 0), edges: [(0, 0, -2), (1, 4, 0)]";
    assert_texel(leaning, [1.375, 1.5, -1.75], [3.0, 0.0, 0.0], [3, 2]);
    let floor = "Plane(point: (0, 0, 0), normal: (0, 1, 0)";
    assert_texel(floor, [0.375, 0.0, 0.625], [0.0, 1.0, 0.0], [1, 2]);
    assert_texel(floor, [-7.125, 0.0, 5.125], [0.0, 1.0, 0.0], [3, 0]);
    let wall = "Plane(point: (1, 0, -3), normal: (0, 0, 1)";
    assert_texel(wall, [1.375, -0.625, -3.0], [0.0, 0.0, 1.0], [1, 2]);
    assert_texel("Disk(center: (0, 0, 1), normal: (0, 0, 1), radius: 2", [-0.5, 1.5, 1.0], [0.0, 0.0, 2.0], [1, 0]);
}

/// Each face of a box shows the picture upright and not mirrored.
#[test]
fn boxes_show_the_picture_on_each_face() {
    let cube = "Box(min: (0, 0, 0), max: (4, 8, 4)";
    for (at, from, expected) in [
        ([0.5, 7.0, 4.0], [0.0, 0.0, 2.0], [0, 0]),
        ([2.5, 3.0, 4.0], [0.0, 0.0, 2.0], [2, 2]),
        ([2.5, 7.0, 0.0], [0.0, 0.0, -2.0], [1, 0]),
        ([4.0, 1.0, 2.5], [2.0, 0.0, 0.0], [1, 3]),
        ([0.0, 1.0, 2.5], [-2.0, 0.0, 0.0], [2, 3]),
        ([0.5, 8.0, 2.5], [0.0, 2.0, 0.0], [0, 2]),
        ([0.5, 0.0, 2.5], [0.0, -2.0, 0.0], [0, 1]),
        // From the inside, too, each point has its texel.
        ([2.5, 7.0, 0.0], [0.0, 0.0, 2.0], [1, 0]),
    ] {
        assert_texel(cube, at, from, expected);
    }
    // The box turned by a quarter about y: its face towards +z is now towards +x.
    let turned = format!("{cube}, rotate: (0, 90, 0)");
    assert_texel(&turned, [4.0, 7.0, -0.5], [2.0, 0.0, 0.0], [0, 0]);
}

/// Returns the direction to a texel on a ball: its middle is at +z, its upper edge at +y.
fn on_ball([column, row]: [u8; 2]) -> [f64; 3] {
    let around = ((f64::from(column) + 0.5) / 4.0 - 0.5) * 2.0 * PI;
    let down = (f64::from(row) + 0.5) / 4.0 * PI;
    [libm::sin(down) * libm::sin(around), libm::cos(down), libm::sin(down) * libm::cos(around)]
}

#[test]
fn balls_show_the_picture_as_a_map_of_the_world() {
    for texel in [[0, 0], [1, 1], [2, 2], [3, 3], [3, 0], [0, 2]] {
        let [x, y, z] = on_ball(texel);
        let scaled = |factors: [f64; 3]| [x * factors[0], y * factors[1], z * factors[2]];
        let ball = "Sphere(center: (0, 0, 0), radius: 1";
        assert_texel(ball, [x, y, z], [x, y, z], texel);
        // Turned by a quarter about y, +z comes to +x, and +x to -z.
        assert_texel(&format!("{ball}, rotate: (0, 90, 0)"), [z, y, -x], [z, y, -x], texel);
        assert_texel(&format!("{ball}, scale: (-1, 1, 1)"), [-x, y, z], [-x, y, z], texel);
        let at = scaled([2.0, 1.0, 0.5]);
        assert_texel(&format!("{ball}, scale: (2, 1, 0.5)"), at, at, texel);
        assert_texel("Ellipsoid(center: (0, 0, 0), radii: (2, 1, 0.5)", at, at, texel);
    }
}

#[test]
fn cylinders_show_the_picture_around_them_and_on_their_caps() {
    let tin = "Cylinder(from: (0, 0, 0), to: (0, 4, 0), radius: 1";
    for [column, row] in [[0, 0], [1, 3], [2, 1], [3, 2]] {
        let around = ((f64::from(column) + 0.5) / 4.0 - 0.5) * 2.0 * PI;
        let [x, y, z] = [libm::sin(around), 3.5 - f64::from(row), libm::cos(around)];
        assert_texel(tin, [x, y, z], [2.0 * x, 0.0, 2.0 * z], [column, row]);
    }
    assert_texel(tin, [-0.3, 4.0, 0.6], [0.0, 2.0, 0.0], [1, 3]);
    assert_texel(tin, [-0.3, 0.0, 0.6], [0.0, -2.0, 0.0], [1, 0]);
}

/// Light is interpolated, not the codes of sRGB: at an edge between texels it is their mean.
#[test]
fn neighbouring_texels_are_blended_in_linear_light() {
    let scene = scene("", "Quad(corner: (0, 0, 0), edges: [(4, 0, 0), (0, 4, 0)], material: Image(\"grid.png\"))");
    let found = light_at(&scene, Vec3::new(2.0, 3.5, 0.0), Vec3::Z);
    let mean = (texel([1, 0]) + texel([2, 0])) * 0.5;
    assert!((found.r - mean.r).abs() < 1e-6 && (found.g - mean.g).abs() < 1e-6, "{found:?}, not {mean:?}");
}

#[test]
fn pictures_are_repeated_mirrored_and_clamped() {
    let shown = |fields: &str, x: f32| {
        let material = format!("Image(path: \"grid.png\", filter: Nearest, {fields})");
        let floor = format!("Plane(point: (0, 0, 0), normal: (0, 1, 0), material: {material})");
        light_at(&scene("", &floor), Vec3::new(x, 0.0, 0.1), Vec3::Y)
    };
    for (fields, x, column) in [
        ("repeat: 2", 0.2, 1),
        ("repeat: (0.5, 1)", 1.3, 2),
        ("repeat: (-1, 1)", 0.1, 3),
        ("wrap: Repeat", 1.1, 0),
        ("wrap: Mirror", 1.1, 3),
        ("wrap: Clamp", 5.1, 3),
        ("wrap: Clamp", -5.1, 0),
    ] {
        assert_eq!(shown(fields, x), texel([column, 0]), "{fields} at {x}");
    }
}

/// A mesh shows the picture by the texture coordinates of its file.
#[test]
fn meshes_show_the_picture_by_their_own_coordinates() {
    let square = "Mesh(path: \"../meshes/square.obj\"";
    assert_texel(square, [0.1, 0.9, 0.0], [0.0, 0.0, 2.0], [0, 0]);
    assert_texel(square, [0.9, 0.4, 0.0], [0.0, 0.0, 2.0], [3, 2]);
}

const SCREEN: &str = "Quad(corner: (0, 0, 0), edges: [(4, 0, 0), (0, 4, 0)], \
    material: Image(path: \"holes.png\", filter: Nearest, cutoff: 0.5))";

#[test]
fn rays_pass_holes_and_meet_what_is_behind_them() {
    let scene = scene("", &format!("{SCREEN}, Plane(point: (0, 0, -1), normal: (0, 0, 1), material: Diffuse(0.25))"));
    let (whole, hole) = (Vec3::new(0.5, 3.5, 0.0), Vec3::new(1.5, 3.5, 0.0));
    assert_eq!(light_at(&scene, whole, Vec3::Z), texel([0, 0]));
    assert_eq!(light_at(&scene, hole, Vec3::Z), LinearRgb::grey(0.25));
    let ray = |at: Vec3| Ray { origin: at + Vec3::Z, direction: -Vec3::Z };
    let hit = |at| closest_hit(&scene, &ray(at)).map(|hit| (hit.object, hit.t));
    assert_eq!((hit(whole), hit(hole)), (Some((0, 1.0)), Some((1, 2.0))));
    let near = Interval { min: 0.0, max: 1.5 };
    assert!(any_hit(&scene, &ray(whole), near) && !any_hit(&scene, &ray(hole), near));
}

/// The 257th surface counts as whole, for eye rays and shadow rays of all kernels.
#[test]
fn rays_pass_at_most_256_holes() {
    let hole = Ray { origin: Vec3::new(1.5, 3.5, 1.0), direction: -Vec3::Z };
    let in_front_of_plane = Interval { min: 0.0, max: 6.0 };
    let screen = SCREEN.strip_suffix(')').expect("an object");
    for screens in [255, 256, 257, 300] {
        let objects = format!(
            "Plane(point: (0, 0, -6), normal: (0, 0, 1), material: Diffuse(0.25)),
            {screen}, copies: (count: (1, 1, {screens}), step: (0, 0, -0.015625)))"
        );
        let scene = scene("", &objects);
        let passes = screens <= 256;
        // The plane is object 0, and the 257th screen object 257.
        let expected = if passes { (0, 7.0) } else { (257, 5.0) };
        assert_eq!(closest_hit(&scene, &hole).map(|hit| (hit.object, hit.t)), Some(expected), "{screens} screens");
        let groups = [EightRays::of(&[hole; 8])];
        for kernel in [Kernel::Auto, Kernel::Single, Kernel::Packet, Kernel::Scalar] {
            let (mut hits, mut masks) = (Vec::new(), Vec::new());
            closest_hits(kernel, &scene, &groups, &mut hits);
            any_hits(kernel, &scene, &groups, in_front_of_plane, &mut masks);
            for lane in 0..8 {
                let found = hits[0].hit(&scene, lane).map(|hit| (hit.object, hit.t));
                assert_eq!(found, Some(expected), "{kernel:?}, {screens} screens");
            }
            assert_eq!(masks, [if passes { 0 } else { 255 }], "{kernel:?}, {screens} screens");
        }
        let nearest = light_at(&scene, Vec3::new(1.5, 3.5, 0.0), Vec3::Z);
        assert_eq!(nearest == LinearRgb::grey(0.25), passes, "{screens} screens: {nearest:?}");
    }
}

#[test]
fn light_falls_through_holes() {
    let lit = |x: f32| {
        let text = format!(
            "(camera: (eye: (0, 0, 9), target: (0, 0, 0)), lights: [Point(position: (2, 2, 9))], objects: [{SCREEN}, \
                Plane(point: (0, 0, -0.001), normal: (0, 0, 1), material: Diffuse(1))])"
        );
        let scene = Scene::from_ron("tests/images/scene.ron", &text).expect("a scene");
        // The eye is between the screen and the wall.
        light_at(&scene, Vec3::new(x, 3.5, -0.001), Vec3::new(0.0, 0.0, 0.0005)).g
    };
    assert_eq!(lit(0.5), 0.0);
    assert!(lit(1.5) > 0.01, "{}", lit(1.5));
}

/// Through a hole in its front one sees the inside of a ball, and through two what is behind it.
#[test]
fn the_far_side_of_a_ball_is_seen_through_its_holes() {
    let ball = "Sphere(center: (0, 0, 0), radius: 1, material: Image(path: \"holes.png\", filter: Nearest, cutoff: 1))";
    let scene = scene("", ball);
    let t = |texel, shift: f32| {
        let [x, y, z] = on_ball(texel).map(|x| x as f32);
        let outward = Vec3::new(x, y, z);
        let side = outward.cross(Vec3::Y).normalize() * shift;
        closest_hit(&scene, &Ray { origin: outward * 3.0 + side, direction: -outward - side }).map(|hit| hit.t)
    };
    let near = |t: Option<f32>, expected: f32| t.is_some_and(|t| (t - expected).abs() < 1e-3);
    assert!(near(t([2, 2], 0.0), 2.0), "whole: {:?}", t([2, 2], 0.0));
    // Opposite to texel (c, r) is texel (c + 2, 3 - r): a hole's is whole.
    assert!(near(t([2, 1], 0.0), 4.0), "a hole: {:?}", t([2, 1], 0.0));
}

/// The opacities of an MTL file's `map_d` make holes, unless the mesh has another material.
#[test]
fn meshes_have_the_holes_of_their_files() {
    let wall = "Plane(point: (0, 0, -1), normal: (0, 0, 1), material: Diffuse(0.25))";
    let [own, red] = ["", ", material: Diffuse((1, 0, 0))"]
        .map(|material| scene("", &format!("Mesh(path: \"leaf.obj\"{material}), {wall}")));
    let (whole, hole) = (Vec3::new(0.5, 3.5, 0.0), Vec3::new(1.5, 3.5, 0.0));
    let found = light_at(&own, whole, Vec3::Z);
    assert!((found.r - texel([0, 0]).r).abs() < 1e-6, "{found:?}");
    assert_eq!(light_at(&own, hole, Vec3::Z), LinearRgb::grey(0.25));
    assert_eq!(light_at(&red, hole, Vec3::Z), LinearRgb::new(1.0, 0.0, 0.0));
    let down = |x: f32| Ray { origin: Vec3::new(x, 3.5, 1.0), direction: -Vec3::Z };
    let near = Interval { min: 0.0, max: 1.5 };
    assert!(any_hit(&own, &down(0.5), near) && !any_hit(&own, &down(1.5), near) && any_hit(&red, &down(1.5), near));
}

/// Of the light from behind, 1 - d passes: to the eye, and to a floor.
#[test]
fn meshes_are_as_transparent_as_their_files_say() {
    let seen = |fields: &str, objects: &str| light_at(&scene(fields, objects), Vec3::new(1.0, 1.0, 0.0), Vec3::Z).r;
    let (veil, wall) =
        ("Mesh(path: \"veil.obj\")", "Plane(point: (0, 0, -1), normal: (0, 0, 1), material: Diffuse(1))");
    let through = seen("", &format!("{veil}, {wall}"));
    assert!((through - (0.25 * 0.5 + 0.75)).abs() < 1e-6, "{through}");
    assert_eq!(seen("lecture: true,", &format!("{veil}, {wall}")), 0.5);
    // The eye is between the veil and the wall, which the light reaches through the veil.
    let lit = |objects: &str| {
        let text = format!(
            "(camera: (eye: (0, 0, 9), target: (0, 0, 0)), lights: [Sun(direction: (0, 0, 1))], objects: [{objects}])"
        );
        let scene = Scene::from_ron("tests/images/scene.ron", &text).expect("a scene");
        light_at(&scene, Vec3::new(1.0, 1.0, -1.0), Vec3::Z * 0.5).r
    };
    let share = lit(&format!("{veil}, {wall}")) / lit(wall);
    assert!((share - 0.75).abs() < 1e-6, "{share}");
}

/// Emitted light is added to reflected light, also in a mirror, and lights nothing else.
#[test]
fn meshes_send_out_the_light_of_their_files() {
    let lamp = "Mesh(path: \"lamp.obj\")";
    let at = |scene: &Scene| light_at(scene, Vec3::new(1.0, 1.0, 0.0), Vec3::Z);
    assert_eq!(at(&scene("", lamp)), LinearRgb::new(0.75, 1.0, 2.5));
    assert_eq!(at(&scene("lecture: true,", lamp)), LinearRgb::grey(0.5));
    let mirror = "Quad(corner: (-9, -9, 1), edges: [(18, 0, 0), (0, 18, 0)], material: Diffuse(1), finish: Metal)";
    let text = format!(
        "(camera: (eye: (0, 0, 9), target: (0, 0, 0)), objects: [{lamp}, {mirror}, \
            Plane(point: (0, -0.01, 0), normal: (0, 1, 0))])"
    );
    let dark = Scene::from_ron("tests/images/scene.ron", &text).expect("a scene");
    let light = LinearRgb::new(0.25, 0.5, 2.0);
    assert_eq!(light_at(&dark, Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 0.5)), light);
    assert_eq!(light_at(&dark, Vec3::new(1.0, 1.0, 1.0), Vec3::new(0.0, 0.0, -0.5)), light);
    assert_eq!(light_at(&dark, Vec3::new(1.0, -0.01, 0.1), Vec3::Y), LinearRgb::BLACK);
    let lines = explain(&dark, dark.camera(), Resolution::square(9, 9), [4, 4]).lines().join("\n");
    assert!(!lines.contains("L_o"), "the middle shows the mirror: {lines}");
    let lit = scene("", lamp);
    let lines = explain(&lit, lit.camera(), Resolution::square(9, 9), [5, 3]).lines().join("\n");
    assert!(lines.contains("L_o        0.2500   0.5000   2.0000"), "{lines}");
}

/// Rays over many objects with holes, some of them far away, from many directions.
#[test]
fn all_kernels_see_the_same_through_holes() {
    let image = "material: Image(path: \"holes.png\", repeat: 3, cutoff: 0.5)";
    let scene = scene(
        "",
        &format!(
            "Sphere(center: (0, 0, 0), radius: 1, {image}, copies: (count: (4, 3, 2), step: (2, 2, -3))),
            Box(min: (-2, -2, -9), max: (9, 9, -8), {image}), Plane(point: (0, -3, 0), normal: (0, 1, 0), {image}),
            Sphere(center: (900, 0, -2000), radius: 300, {image}), Mesh(path: \"../meshes/square.obj\", {image}),
            Mesh(path: \"leaf.obj\", translate: (-2, -1, 2)),
            Cylinder(from: (-3, -3, 0), to: (-3, 3, -1), radius: 0.7, {image}, copies: (count: (1, 1, 12), \
                step: (0, 0, -2)))"
        ),
    );
    let mut state = 7_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 40) as f32 / 8_388_608.0 - 1.0
    };
    let rays: Vec<_> = (0..4096)
        .map(|at| {
            let (x, y) = ((at % 64) as f32 / 32.0 - 1.0, (at / 64) as f32 / 32.0 - 1.0);
            let direction = Vec3::new(x, y, -1.0) + Vec3::new(number(), number(), number()) * 1e-3;
            Ray { origin: Vec3::new(0.0, 0.5, 6.0), direction }
        })
        .collect();
    let groups: Vec<_> = rays.chunks(8).map(EightRays::of).collect();
    let hits = |kernel| {
        let mut hits = Vec::new();
        closest_hits(kernel, &scene, &groups, &mut hits);
        hits.iter().flat_map(|eight| (0..8).map(|lane| eight.hit(&scene, lane))).collect::<Vec<_>>()
    };
    let within = Interval { min: 0.0, max: 9.0 };
    let masks = |kernel| {
        let mut masks = Vec::new();
        any_hits(kernel, &scene, &groups, within, &mut masks);
        masks
    };
    let (single, near) = (hits(Kernel::Single), masks(Kernel::Single));
    let met = single.iter().flatten().count();
    assert!((1000..4000).contains(&met), "{met}");
    for kernel in [Kernel::Auto, Kernel::Packet, Kernel::Scalar] {
        assert_eq!(hits(kernel), single, "{kernel:?}");
        assert_eq!(masks(kernel), near, "{kernel:?}");
    }
    for (at, (ray, hit)) in rays.iter().zip(&single).enumerate() {
        assert_eq!(closest_hit_observed(&scene, ray, &mut TestCount::default()), *hit, "{ray:?}");
        let is_near = near[at / 8] >> (at % 8) & 1 == 1;
        assert_eq!(is_near, hit.is_some_and(|hit| hit.t <= within.max), "{ray:?}");
        assert_eq!(any_hit_observed(&scene, ray, within, &mut TestCount::default()).is_some(), is_near, "{ray:?}");
    }
}
