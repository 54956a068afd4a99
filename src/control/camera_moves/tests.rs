use super::*;
use crate::camera::{Pose, ViewRectangle};

#[test]
fn a_turntable_turns_once_in_twenty_seconds_whatever_its_steps() {
    let pose = Pose { eye: Vec3::new(0.0, 1.0, 4.0), target: Vec3::ZERO, up: Vec3::Y };
    let start =
        ViewRectangle::from_vertical_fov(0.7).and_then(|rectangle| Camera::new(pose, rectangle)).expect("a pose");
    let once = on_turntable(&start, 20.0).pose().eye;
    assert!(once.abs_diff_eq(start.pose().eye, 1e-4), "{once}");
    let quarter = on_turntable(&start, 5.0).pose().eye;
    assert!(quarter.abs_diff_eq(Vec3::new(4.0, 1.0, 0.0), 1e-4), "{quarter}");
    let in_steps = (0..500).fold(start, |camera, _| on_turntable(&camera, 0.01)).pose().eye;
    assert!(in_steps.abs_diff_eq(quarter, 1e-3), "{in_steps}");
}
