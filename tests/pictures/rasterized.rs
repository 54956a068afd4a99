//! Object order beside image order: the same object at every pixel except at edges.

use super::goldens::{folder, scenes, stems};
use glam::{Vec2, Vec3};
use termtrace::internals::hit::closest_hit;
use termtrace::internals::rasterize::rasterize;
use termtrace::{Camera, Pose, Resolution, Scene};

fn scene(name: &str) -> Scene {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.ron"));
    Scene::load(&path).expect("the scene is fine")
}

/// Returns the scene's own camera, two that have orbited, and two whose rectangle is tilted or
/// shifted.
fn cameras(scene: &Scene) -> [(Camera, &'static str); 5] {
    let own = *scene.camera();
    let tilted = own.rectangle().with_tilt(Vec2::new(0.3, -0.4)).map(|rectangle| own.with_rectangle(rectangle));
    let shifted = own.rectangle().with_shift(Vec2::new(-0.6, 0.4)).map(|rectangle| own.with_rectangle(rectangle));
    [
        (own, "own"),
        (own.orbited(0.7, 0.2), "orbited"),
        (own.orbited(-2.4, 0.5), "from behind"),
        (tilted.expect("in front of the eye"), "tilted"),
        (shifted.expect("in front of the eye"), "shifted"),
    ]
}

/// Compares both orders at each pixel, and returns the number of pixels that differ.
fn differing(scene: &Scene, camera: &Camera, name: &str) -> u32 {
    const SIZE: [u32; 2] = [97, 61];
    let resolution = Resolution::square(SIZE[0], SIZE[1]);
    let rays = camera.eye_rays(resolution.aspect_ratio());
    let traced = |x: u32, y: u32| {
        let (qu, qv) = ((x as f32 + 0.5) / SIZE[0] as f32, (SIZE[1] as f32 - (y as f32 + 0.5)) / SIZE[1] as f32);
        closest_hit(scene, &rays.through(qu, qv)).map(|hit| (hit.object, hit.t))
    };
    let drawn = rasterize(scene, camera, resolution);
    let mut different = 0;
    for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
        let (by_ray, by_object) = (traced(x, y), drawn.at(x, y));
        if by_ray.map(|seen| seen.0) == by_object.map(|seen| seen.0) {
            if let (Some((_, a)), Some((_, b))) = (by_ray, by_object) {
                // Where a surface is seen at a grazing angle, a rounded ray meets it elsewhere.
                assert!((a - b).abs() <= 2e-3 * a, "{name} ({x}, {y}): depths {a} and {b}");
            }
            continue;
        }
        different += 1;
        let is_edge = is_beside(by_object.map(|seen| seen.0), [x, y], |x, y| traced(x, y).map(|seen| seen.0));
        assert!(is_edge, "{name} ({x}, {y}): the ray meets {by_ray:?}, drawn is {by_object:?}");
    }
    different
}

/// Returns whether one of the eight pixels around a pixel shows an object, or none for `None`.
pub(crate) fn is_beside(object: Option<u32>, [x, y]: [u32; 2], shown: impl Fn(u32, u32) -> Option<u32>) -> bool {
    let around = [(0, 1), (2, 1), (1, 0), (1, 2), (0, 0), (2, 0), (0, 2), (2, 2)];
    around.iter().any(|(right, down)| shown((x + right).wrapping_sub(1), (y + down).wrapping_sub(1)) == object)
}

#[test]
fn both_orders_show_the_same_object_at_every_pixel_except_at_edges() {
    // Object order draws surfaces with holes as whole ones.
    for name in scenes().into_iter().filter(|name| name != "globe") {
        let scene = scene(&name);
        // Object order draws each of the 20 million triangles of `crowd`, which takes 3 s: one camera has to do.
        let cameras = cameras(&scene).into_iter().take(if scene.objects().len() < 10_000 { 5 } else { 1 });
        for (camera, place) in cameras {
            let different = differing(&scene, &camera, &name);
            assert!(different <= 12, "{name} {place}: {different} pixels differ");
        }
    }
}

/// Formulas are ray-cast within their projected bounds, also where the eye is within the bounds.
#[test]
fn both_orders_show_the_same_formulas_at_every_pixel_except_at_edges() {
    let names = stems(&folder("scenes/formulas"), ".ron");
    assert!(names.len() >= 10, "{names:?}");
    for name in names {
        let scene = scene(&format!("formulas/{name}"));
        let own = *scene.camera();
        let Pose { eye, target, up } = own.pose();
        let within = own.with_pose(Pose { eye: target.lerp(eye, 0.2), target, up }).expect("a pose");
        for (camera, place) in cameras(&scene).into_iter().chain([(within, "within")]) {
            let different = differing(&scene, &camera, &name);
            assert!(different <= 12, "{name} {place}: {different} pixels differ");
        }
    }
}

/// A triangle that reaches behind the eye is drawn as far as it is in front; objects behind it are
/// not drawn.
#[test]
fn objects_around_the_eye_are_drawn_where_rays_meet_them() {
    let text = "(camera: (eye: (0, 1, 0), target: (0, 0.7, -5)), objects: [
        Triangle(corners: [(-9, 0, 9), (9, 0, 9), (0, 0, -30)]),
        Triangle(corners: [(-1, 0, 9), (1, 0, 9), (0, 3, 30)]),
        Sphere(center: (0, 1, 8), radius: 2),
        Sphere(center: (0, 1, 0.5), radius: 3),
    ])";
    let scene = Scene::from_ron("around", text).expect("a scene");
    assert!(differing(&scene, scene.camera(), "around") <= 12);
    let inside = Pose { eye: Vec3::new(0.0, 2.0, 6.0), target: Vec3::new(0.0, 0.0, -5.0), up: Vec3::Y };
    let inside = scene.camera().with_pose(inside).expect("a pose");
    assert!(differing(&scene, &inside, "from behind") <= 12);
}

/// Objects and depths have the same bits on all CPUs, whose instruction sets differ.
#[test]
fn depth_buffers_have_the_same_bits_on_every_machine() {
    let hash = |name| {
        let (scene, resolution) = (scene(name), Resolution::square(97, 61));
        let drawn = rasterize(&scene, scene.camera(), resolution);
        let pixels = (0..61).flat_map(|y| (0..97).map(move |x| (x, y)));
        let pixels = pixels.map(|(x, y)| drawn.at(x, y).unwrap_or((u32::MAX, 0.0)));
        let bytes = pixels.flat_map(|(object, t)| [object, t.to_bits()]).flat_map(u32::to_le_bytes);
        // The hash is FNV-1a.
        let basis = 0xcbf2_9ce4_8422_2325_u64;
        let hash = bytes.fold(basis, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        format!("{hash:016x}")
    };
    let hashes = ["many_spheres", "teapots", "tilted_rectangle", "gyroid"].map(hash);
    assert_eq!(hashes, ["8c5ff1f61bc2ae72", "5b6ff2351bdaa7d8", "bc17fd77e1314546", "174b63df566455c9"]);
}
