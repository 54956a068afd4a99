//! Camera motions that keys and the mouse cause.

use super::KeyMode;
use crate::camera::{Camera, Grip};
use glam::{Vec2, Vec3};

/// Returns the speed of flight in world units per second: half the distance to the target.
// The speed is proportional to the distance to the target, because scenes differ in scale by orders of magnitude: the
// Stanford bunny is 0.15 units high.
pub fn speed(camera: &Camera) -> f32 {
    0.5 * camera.target_distance()
}

/// Returns the camera after the mouse is dragged by `by`: to the right and down, as shares of the
/// picture's width and height.
///
/// [`Grip::Turn`] turns the view, or in orbit mode the eye about the target. [`Grip::Pan`] shifts eye and target so
/// that the target follows the pointer.
pub fn dragged(camera: &Camera, mode: KeyMode, grip: Grip, by: Vec2, aspect_ratio: f32) -> Camera {
    match grip {
        Grip::Pan => camera.panned(by, aspect_ratio),
        Grip::Turn if mode == KeyMode::Orbit => camera.dragged_around(by, aspect_ratio),
        Grip::Turn => camera.dragged_view(by, aspect_ratio),
    }
}

/// Returns the camera after the wheel has moved the eye towards `point` by `notches`.
///
/// The point stays at its position in the picture. In orbit mode the target moves towards the point as well, and
/// `size`, the scene's size in world units, limits the distance from eye to target.
pub fn wheeled(camera: &Camera, mode: KeyMode, point: Vec3, notches: f32, size: f32) -> Camera {
    if mode == KeyMode::Orbit { camera.scaled_about(point, notches, size) } else { camera.wheeled(point, notches) }
}

/// Angular speed of the turntable in radians per second: one turn in 20 s.
const TURNTABLE_SPEED: f32 = std::f32::consts::PI / 10.0;

/// Returns the camera after `seconds` on the turntable, which orbits the target.
pub fn on_turntable(camera: &Camera, seconds: f32) -> Camera {
    camera.orbited(TURNTABLE_SPEED * seconds, 0.0)
}

#[cfg(all(test, unit_tests))]
mod tests;
