//! Camera motions for keys and the mouse.

use super::KeyMode;
use crate::camera::{Camera, Grip};
use glam::{Vec2, Vec3};

/// World units per second at which a scene is pleasant to fly through: half the way to the target.
pub fn speed(camera: &Camera) -> f32 {
    0.5 * camera.target_distance()
}

/// Returns the camera after the picture has been dragged to the right and down by that part of its width and height:
/// the view turns, in `orbit` about the target, or shifts so that the target follows.
pub fn dragged(camera: &Camera, mode: KeyMode, grip: Grip, by: Vec2, aspect_ratio: f32) -> Camera {
    match grip {
        Grip::Pan => camera.panned(by, aspect_ratio),
        Grip::Turn if mode == KeyMode::Orbit => camera.dragged_around(by, aspect_ratio),
        Grip::Turn => camera.dragged_view(by, aspect_ratio),
    }
}

/// Returns the camera after the eye has come nearer to a point, which stays where it is in the picture, by notches of
/// the wheel. In `orbit` the target comes nearer to it, too, in a scene of that size.
pub fn wheeled(camera: &Camera, mode: KeyMode, point: Vec3, notches: f32, size: f32) -> Camera {
    if mode == KeyMode::Orbit { camera.wheeled_around(point, notches, size) } else { camera.wheeled(point, notches) }
}

/// The turntable turns so many radians a second: once around in twenty seconds.
const TURNTABLE_SPEED: f32 = std::f32::consts::PI / 10.0;

/// The eye goes around the target as it would stand before a turntable, for so many seconds.
pub fn on_turntable(camera: &Camera, seconds: f32) -> Camera {
    camera.orbited(TURNTABLE_SPEED * seconds, 0.0)
}

#[cfg(test)]
mod tests {
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
}
