use crate::camera::{Camera, Pose, ViewRectangle};
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use proptest::prelude::*;

fn read_back(camera: &Camera) -> Camera {
    let text = format!("({})", camera.to_ron());
    *Scene::from_ron("camera", &text).unwrap().camera()
}

#[test]
fn a_written_camera_reads_back_equal() {
    for lens in [
        "vertical_fov: 44",
        "vertical_fov: 12.5",
        "vertical_fov: 40, aspect_ratio: 1.5",
        "focal_length: 1, width: 1.8, height: 1.2",
        "focal_length: 1, width: 1.8, height: 1.2, shift: (0, 0.35)",
        "vertical_fov: 100, shift: (-0.25, 1)",
        "vertical_fov: 30, shift: (0.1, 0), tilt: (-0.3, 12.5)",
        "vertical_fov: 60, tilt: (0, -23.7)",
    ] {
        let line = format!("camera: (eye: (0.1, -3e-20, 4), target: (1000000, 0, 0), up: (0, 0.3, 0), {lens})");
        let scene = Scene::from_ron("x", &format!("({line})")).unwrap();
        assert_eq!(scene.camera().to_ron(), line);
    }
}

#[test]
fn defaults_are_left_out() {
    let line = "camera: (eye: (0, 1, 5), target: (0, 0, 0))";
    let full = line.replace("0))", "0), up: (0, 1, 0), vertical_fov: 45)");
    assert_eq!(Scene::from_ron("x", &format!("({full})")).unwrap().camera().to_ron(), line);
}

#[test]
fn a_rounded_camera_has_few_digits_and_shows_the_same_picture() {
    let text = "(camera: (eye: (-1.23456789, 1.5000001, 6), target: (-0.17689514, 0.8999982, 0.0024704933),
        vertical_fov: 39.284))";
    let camera = *Scene::from_ron("x", text).unwrap().camera();
    let line = "camera: (eye: (-1.2346, 1.5, 6), target: (-0.1769, 0.9, 0.0025), vertical_fov: 39.28)";
    assert_eq!(camera.rounded().to_ron(), line);
    for digit in [1e-3, 1.0, 1e4, 1e7] {
        let pose = camera.pose();
        let far = camera.with_pose(Pose { eye: pose.eye * digit, target: pose.target * digit, ..pose }).unwrap();
        let rounded = far.rounded();
        assert_eq!(rounded.rounded(), rounded, "{digit}");
        let points = [[0.0, 0.0], [0.3, 0.9], [1.0, 1.0]]
            .map(|[x, y]| far.eye_rays(1.5).through(x, y).at(far.target_distance()));
        for point in points {
            let moved = [far, rounded].map(|camera| camera.project(point, 1.5).unwrap());
            assert!(moved[0].distance(moved[1]) < 1.0 / 1000.0, "{digit}: {moved:?}");
        }
    }
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![-10.0_f32..10.0, -1e9_f32..1e9, -1e-30_f32..1e-30, Just(-0.0)]
}

fn point() -> impl Strategy<Value = Vec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from_array)
}

fn rectangle() -> impl Strategy<Value = ViewRectangle> {
    let by_angle = (0.001_f32..3.1).prop_map(|angle| ViewRectangle::from_vertical_fov(angle).unwrap());
    let by_ratio = (0.1_f32..3.0, 0.01_f32..100.0)
        .prop_map(|(angle, ratio)| ViewRectangle::from_vertical_fov(angle).unwrap().with_aspect_ratio(ratio).unwrap());
    let by_length = (0.1_f32..10.0, 0.1_f32..10.0, 0.1_f32..10.0)
        .prop_map(|(f, w, h)| ViewRectangle::from_focal_length(f, w, h).unwrap());
    let pair = |most: f32| [-most..most, -most..most].prop_map(Vec2::from_array);
    let tilt = prop_oneof![Just(Vec2::ZERO), pair(1e-6), pair(1.55)];
    (prop_oneof![by_angle, by_ratio, by_length], pair(2.0), tilt).prop_map(|(rectangle, shift, tilt)| {
        let shifted = rectangle.with_shift(shift).unwrap();
        shifted.with_tilt(tilt).unwrap_or(shifted)
    })
}

proptest! {
    #[test]
    fn every_camera_can_be_rounded(eye in point(), target in point(), rectangle in rectangle()) {
        let pose = Pose { eye, target, up: Vec3::new(0.3, 1.0, -0.1) };
        prop_assume!(Camera::new(pose, rectangle).is_ok());
        let rounded = Camera::new(pose, rectangle).unwrap().rounded();
        prop_assert_eq!(read_back(&rounded), rounded);
    }

    #[test]
    fn every_camera_is_read_back_bit_for_bit(eye in point(), target in point(), rectangle in rectangle()) {
        let pose = Pose { eye, target, up: Vec3::new(0.3, 1.0, -0.1) };
        prop_assume!(Camera::new(pose, rectangle).is_ok());
        let camera = Camera::new(pose, rectangle).unwrap();
        prop_assert_eq!(read_back(&camera), camera);
    }
}

#[test]
fn a_camera_is_written_as_flags() {
    let line = "(camera: (eye: (0.5, 1, 5), target: (0, 0, 0), vertical_fov: 40.5))";
    let camera = *Scene::from_ron("x", line).unwrap().camera();
    assert_eq!(camera.to_flags(), "--eye 0.5,1,5 --target 0,0,0 --fov 40.5");
    let line = line.replace("vertical", "up: (0, 0, 1), vertical");
    let camera = *Scene::from_ron("x", &line).unwrap().camera();
    assert_eq!(camera.to_flags(), "--eye 0.5,1,5 --target 0,0,0 --up 0,0,1 --fov 40.5");
}
