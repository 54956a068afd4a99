use super::*;
use crate::camera::{Pose, ViewRectangle};

/// All points of the horizon are as high as the eye, and its image is level in an upright picture.
#[test]
fn the_horizon_is_at_the_height_of_the_eye() {
    let pose = Pose { eye: Vec3::new(1.0, 2.0, 3.0), target: Vec3::new(0.0, 0.5, 0.0), up: Vec3::Y };
    let camera = ViewRectangle::from_vertical_fov(1.0).and_then(|rectangle| Camera::new(pose, rectangle));
    let camera = camera.expect("a camera");
    let points: Vec<_> = horizon(&camera).flatten().collect();
    assert!(points.iter().all(|point| (point.y - 2.0).abs() < 1e-6));
    // Points beside the eye have no place in the picture; rounding decides on which side of it they are.
    let ahead = points.iter().filter(|&&point| (point - pose.eye).dot(camera.basis().w) < -0.01);
    let heights: Vec<_> = ahead.filter_map(|&point| camera.project(point, 1.5)).map(|place| place.y).collect();
    // The camera looks down by 25.4 degrees, so the horizon is tan(25.4) / (2 tan(0.5)) of the height above the middle.
    let expected = 0.5 - libm::tanf(libm::atanf(1.5 / 10_f32.sqrt())) / (2.0 * libm::tanf(0.5));
    assert!(heights.len() > 20 && heights.iter().all(|height| (height - expected).abs() < 1e-4), "{heights:?}");
}

/// Lines along an axis that go away from the eye end at the vanishing point of the axis.
#[test]
fn lines_along_an_axis_lead_to_its_vanishing_point() {
    let pose = Pose { eye: Vec3::new(4.0, 3.0, 5.0), target: Vec3::ZERO, up: Vec3::Y };
    let rectangle = ViewRectangle::from_vertical_fov(1.0).and_then(|r| r.with_tilt(Vec2::new(0.1, -0.2)));
    let camera = Camera::new(pose, rectangle.expect("a rectangle")).expect("a camera");
    let mut seen = 0;
    for (direction, name, _) in vanishing_directions() {
        let Some(vanishing) = camera.project(pose.eye + direction, 1.0) else { continue };
        let far = camera.project(Vec3::new(0.3, -0.2, 0.1) + 1e6 * direction, 1.0).expect("in front of the eye");
        assert!(far.abs_diff_eq(vanishing, 1e-4), "{name}: {far} {vanishing}");
        seen += 1;
    }
    assert_eq!(seen, 3, "one of the two ends of each axis");
}
