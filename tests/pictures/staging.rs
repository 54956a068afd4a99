//! The cameras and lights of mesh files in the scenes around them.
//!
//! The meshes in `tests/odd_meshes` that have them are a white square from (0, 0, 0) to (1, 1, 0). Light is worked out
//! here in f64, from the candela and lux of the file.

use glam::Vec3;
use std::f64::consts::FRAC_PI_4;
use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Mutex;
use termtrace::internals::mesh_file::UpAxis;
use termtrace::internals::progress::Reporter;
use termtrace::internals::scene::Draft;
use termtrace::{Camera, Falloff, Light, LinearRgb, Pose, Resolution, Scene, describe, render};

/// Returns the draft around a mesh, and the notices.
fn draft_and_notices(name: &str, up: UpAxis) -> (Draft, Vec<String>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/odd_meshes").join(name);
    let notices = Mutex::new(Vec::new());
    let on_notice = |notice: String| notices.lock().expect("no thread panicked").push(notice);
    let draft = Draft::load_turned(&path, Some(up), &Reporter::silent().with_warnings(&on_notice));
    (draft.expect("it can be read"), notices.into_inner().expect("no thread panicked"))
}

fn draft(name: &str, up: UpAxis) -> Draft {
    draft_and_notices(name, up).0
}

fn scene(name: &str) -> Scene {
    draft(name, UpAxis::Y).finish()
}

/// Returns the light that the square sends out at a point, without the ambient light.
fn light_at(scene: &Scene, x: f32, y: f32) -> [f64; 3] {
    let pose = Pose { eye: Vec3::new(x, y, 1.0), target: Vec3::new(x, y, 0.0), up: Vec3::Y };
    let camera = scene.camera().with_pose(pose).expect("a camera");
    let LinearRgb { r, g, b } = render(scene, &camera, Resolution::square(1, 1), NonZeroU32::MIN).pixel(0, 0);
    let ambient = scene.ambient();
    [(r, ambient.r), (g, ambient.g), (b, ambient.b)].map(|(light, ambient)| f64::from(light) - f64::from(ambient))
}

#[track_caller]
fn assert_close(found: [f64; 3], expected: [f64; 3]) {
    let is_close = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-5);
    assert!(is_close, "found {found:?}, expected {expected:?}");
}

#[test]
fn a_point_light_of_a_file_weakens_with_the_square_of_its_distance() {
    let scene = scene("s3_point.gltf");
    // 100 candela times (1, 0.5, 0), 2 in front of the middle: all lights are dimmed until the luminance there is 1.
    let luminance = 0.2126 + 0.7152 * 0.5;
    assert_close(light_at(&scene, 0.5, 0.5), [1.0 / luminance, 0.5 / luminance, 0.0]);
    // At (1, 1) the squared distance is 4.5, and the cosine 2 / sqrt(4.5).
    let share = 4.0 / 4.5 * 2.0 / 4.5_f64.sqrt();
    assert_close(light_at(&scene, 0.999_999, 0.999_999), [share / luminance, 0.5 * share / luminance, 0.0]);
}

/// Returns the cosine times the share of a spot's light at (1, 0.5), 0.5 beside the axis.
///
/// The spot is at distance 2, and its cone ends at 45 degrees.
fn beside_axis() -> f64 {
    let cosine = 2.0 / 4.25_f64.sqrt();
    let inside = (cosine - libm::cos(FRAC_PI_4)) / (1.0 - libm::cos(FRAC_PI_4));
    cosine * inside * inside * (3.0 - 2.0 * inside)
}

#[test]
fn lux_and_candela_of_a_file_keep_their_ratio_and_a_spot_its_cone() {
    let scene = scene("s3_two.gltf");
    // 300 lux, and 100 candela at distance 2, which are 25.
    let factor = 1.0 / (300.0 + 100.0 / 4.0);
    assert_close(light_at(&scene, 0.5, 0.5), [1.0; 3]);
    assert_close(light_at(&scene, 0.999_999, 0.5), [factor * (300.0 + 100.0 / 4.25 * beside_axis()); 3]);
}

#[test]
fn distant_lights_of_a_file_are_suns_where_they_reach_the_mesh() {
    let scene = scene("s3_far.gltf");
    let [Light::Sun(_), Light::Sun(_), Light::Spot(_)] = scene.lights() else { panic!("{:?}", scene.lights()) };
    // 1e14 candela at distance 2e6 are 25 lux, 9e14 at 3e6 are 100, and 100 at 2 are 25. The second light, which counts,
    // shines away from the mesh.
    let factor = 1.0 / 150.0;
    assert_close(light_at(&scene, 0.5, 0.5), [factor * 50.0; 3]);
    assert_close(light_at(&scene, 0.999_999, 0.5), [factor * (25.0 + 100.0 / 4.25 * beside_axis()); 3]);
}

#[test]
fn lights_of_a_file_beyond_the_range_of_intensities_have_no_falloff() {
    let scene = scene("s3_huge.gltf");
    let [Light::Point(point), Light::Spot(spot)] = scene.lights() else { panic!("{:?}", scene.lights()) };
    let position = Vec3::new(5e5, 5e5, 2e6);
    assert_eq!((point.position(), point.falloff()), (position, Falloff::None));
    let half = |LinearRgb { r, g, b }: LinearRgb| [r, g, b].iter().all(|channel| (channel - 0.5).abs() < 1e-5);
    assert!(half(point.intensity()) && half(Light::Spot(*spot).color()), "{:?}", scene.lights());
    let text = scene.around_mesh_to_ron("x.gltf", scene.camera()).expect("it is around a mesh");
    assert_eq!(text.matches("falloff: None").count(), 2, "{text}");
}

#[test]
fn cameras_out_of_range_are_told() {
    let (draft, notices) = draft_and_notices("s2_range.gltf", UpAxis::Y);
    assert_eq!(draft.finish().views().len(), 1);
    let [notice] = &notices[..] else { panic!("{notices:?}") };
    assert!(notice.ends_with("s2_range.gltf: not shown: 1 camera (out of range)"), "{notice}");
}

#[test]
fn a_file_without_lights_has_the_three_default_ones() {
    assert_eq!(scene("s2_cameras.gltf").lights().len(), 3);
    assert_eq!(scene("s3_unused.gltf").lights().len(), 1);
}

#[test]
fn cameras_of_a_file_are_views_at_their_nodes() {
    let scene = scene("s2_cameras.gltf");
    let [front, side] = scene.views() else { panic!("{:?}", scene.views()) };
    let is_at = |camera: &Camera, eye: Vec3, target: Vec3| {
        let pose = camera.pose();
        pose.eye.distance(eye) < 1e-6 && pose.target.distance(target) < 1e-6 && pose.up.distance(Vec3::Y) < 1e-6
    };
    assert!(is_at(front, Vec3::new(0.5, 0.5, 3.0), Vec3::new(0.5, 0.5, 0.0)), "{front:?}");
    assert!(is_at(side, Vec3::new(4.0, 0.5, 0.0), Vec3::new(0.5, 0.5, 0.0)), "{side:?}");
    assert!(
        (front.rectangle().vertical_fov() - 0.5).abs() < 1e-6 && (side.rectangle().vertical_fov() - 1.0).abs() < 1e-6
    );
    assert_eq!((front.rectangle().aspect_ratio(), side.rectangle().aspect_ratio()), (Some(1.5), None));
    let text = describe("x", &scene, scene.camera(), Resolution::square(80, 48));
    assert!(text.contains("\nCameras of the file, by their keys: 1 \"Front\" and 2 \"Side\u{fffd}\".\n"), "{text}");
}

#[test]
fn cameras_and_lights_turn_with_the_mesh() {
    // Up is +z: (x, y, z) of the file becomes (x, z, -y).
    let scene = draft("s2_cameras.gltf", UpAxis::Z).finish();
    let Pose { eye, target, up } = scene.views()[0].pose();
    assert!(eye.distance(Vec3::new(0.5, 3.0, -0.5)) < 1e-6 && target.distance(Vec3::new(0.5, 0.0, -0.5)) < 1e-6);
    assert!(up.distance(Vec3::NEG_Z) < 1e-6);
    let scene = draft("s3_point.gltf", UpAxis::Z).finish();
    assert_eq!(scene.lights()[0].position(), Some(Vec3::new(0.5, 2.0, -0.5)));
}

/// The text of a scene around a mesh has the cameras and lights of the mesh's file.
#[test]
fn a_saved_scene_keeps_the_lights_and_views_of_the_file() {
    for name in ["s3_two.gltf", "s3_point.gltf", "s3_far.gltf", "s3_huge.gltf", "s2_cameras.gltf", "a3.gltf"] {
        let scene = scene(name);
        let text = scene.around_mesh_to_ron(name, scene.camera()).expect("it is around a mesh");
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/odd_meshes/saved.ron");
        let notices = Mutex::new(Vec::new());
        let on_notice = |notice: String| notices.lock().expect("no thread panicked").push(notice);
        let reporter = Reporter::silent().with_warnings(&on_notice);
        let saved = Draft::from_bytes(&path.to_string_lossy(), text.as_bytes(), &reporter).expect("a scene").finish();
        assert_eq!(saved.views(), scene.views(), "{text}");
        assert_eq!(saved.lights().len(), scene.lights().len(), "{text}");
        let kinds = |scene: &Scene| scene.lights().iter().map(std::mem::discriminant).collect::<Vec<_>>();
        assert_eq!(kinds(&saved), kinds(&scene), "{text}");
        for (x, y) in [(0.5, 0.5), (0.9, 0.2)] {
            assert_close(light_at(&saved, x, y), light_at(&scene, x, y));
        }
        let is_told = notices
            .lock()
            .expect("no thread panicked")
            .iter()
            .any(|notice| notice.ends_with("not shown: cameras and lights"));
        assert_eq!(is_told, name != "a3.gltf");
    }
}
