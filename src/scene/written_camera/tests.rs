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
        "vertical_fov: 45",
        "vertical_fov: 12.5",
        "vertical_fov: 40, aspect_ratio: 1.5",
        "focal_length: 1, width: 1.8, height: 1.2",
        "focal_length: 1, width: 1.8, height: 1.2, shift: (0, 0.35)",
        "vertical_fov: 100, shift: (-0.25, 1)",
    ] {
        let line = format!("camera: (eye: (0.1, -3e-20, 4), target: (1000000, 0, 0), up: (0, 0.3, 0), {lens})");
        let scene = Scene::from_ron("x", &format!("({line})")).unwrap();
        assert_eq!(scene.camera().to_ron(), line);
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
    (prop_oneof![by_angle, by_ratio, by_length], -2.0_f32..2.0, -2.0_f32..2.0)
        .prop_map(|(rectangle, right, up)| rectangle.with_shift(Vec2::new(right, up)).unwrap())
}

proptest! {
    #[test]
    fn every_camera_is_read_back_bit_for_bit(eye in point(), target in point(), rectangle in rectangle()) {
        let pose = Pose { eye, target, up: Vec3::new(0.3, 1.0, -0.1) };
        prop_assume!(Camera::new(pose, rectangle).is_ok());
        let camera = Camera::new(pose, rectangle).unwrap();
        prop_assert_eq!(read_back(&camera), camera);
    }
}
