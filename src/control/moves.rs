//! One move of the camera, of any size. None of them turns the picture upside down, and where one would give no picture
//! (an eye too far out for f32), the view stays.

use crate::camera::{Camera, Pose};
use glam::{Vec2, Vec3};

/// The view keeps this far, in radians, from straight up and straight down, where no direction would be vertical.
const POLE: f32 = 0.02;

/// World units per second at which a scene is pleasant to fly through: half the way to the target.
pub fn speed(camera: &Camera) -> f32 {
    let Pose { eye, target, .. } = camera.pose();
    0.5 * eye.distance(target)
}

fn with_pose(camera: &Camera, pose: Pose) -> Camera {
    camera.with_pose(pose).unwrap_or(*camera)
}

/// Eye and target go along u, up and w.
pub(super) fn moved(camera: &Camera, way: Vec3) -> Camera {
    if way == Vec3::ZERO {
        return *camera;
    }
    let Pose { eye, target, up } = camera.pose();
    let basis = camera.basis();
    let by = way.x * basis.u + way.y * up.normalize_or_zero() + way.z * basis.w;
    with_pose(camera, Pose { eye: eye + by, target: target + by, up })
}

/// The view turns to the left about up, and upwards about u, by angles in radians.
pub(super) fn turned(camera: &Camera, turn: Vec2) -> Camera {
    if turn == Vec2::ZERO {
        return *camera;
    }
    let Pose { eye, up, .. } = camera.pose();
    with_pose(camera, Pose { eye, target: eye + turned_view(camera, turn), up })
}

/// The eye goes around the target to the left about up, and upwards, by angles in radians.
pub(super) fn around(camera: &Camera, turn: Vec2) -> Camera {
    if turn == Vec2::ZERO {
        return *camera;
    }
    let Pose { target, up, .. } = camera.pose();
    // Who goes to the left has to look to the right.
    with_pose(camera, Pose { eye: target - turned_view(camera, -turn), target, up })
}

/// From the eye to the target after a turn.
fn turned_view(camera: &Camera, turn: Vec2) -> Vec3 {
    let Pose { eye, target, up } = camera.pose();
    let (left, upwards) = (turn.x, up_to_the_pole(camera, turn.y));
    let axis_up = up.normalize_or_zero();
    let u = rotated(camera.basis().u, axis_up, left);
    rotated(rotated(target - eye, axis_up, left), u, upwards)
}

/// The eye to the target may come so near, and go so far away, in parts of a scene's size: there is always something
/// between them, and never too much for f32.
const NEAREST: f32 = 1e-3;
const FARTHEST: f32 = 1e4;

/// The distance from the eye to the target becomes that many times as much, in a scene of about that size. It stays away
/// from nothing and from infinity; where it is too near to them already, it can but go back.
pub(super) fn nearer(camera: &Camera, factor: f32, size: f32) -> Camera {
    let Pose { eye, target, up } = camera.pose();
    let distance = eye.distance(target);
    // Where numbers are large, neighbours of them are far from each other.
    let nearest = (NEAREST * size).max(1e-5 * target.abs().max_element()).min(distance);
    let wanted = (factor * distance).clamp(nearest, (FARTHEST * size).max(distance));
    if factor == 1.0 || wanted == distance {
        return *camera;
    }
    with_pose(camera, Pose { eye: target + wanted * camera.basis().w, target, up })
}

/// As much of an upward turn as the pole leaves. A view that begins beyond the limit may turn away from the pole only.
fn up_to_the_pole(camera: &Camera, angle: f32) -> f32 {
    let limit = std::f32::consts::FRAC_PI_2 - POLE;
    let sine = -camera.basis().w.dot(camera.pose().up.normalize_or_zero());
    let elevation = libm::asinf(sine.clamp(-1.0, 1.0));
    if angle > 0.0 { angle.min((limit - elevation).max(0.0)) } else { angle.max((-limit - elevation).min(0.0)) }
}

/// Rodrigues' rotation of `v` about a unit axis, to the left when seen against it; the length is kept.
fn rotated(v: Vec3, axis: Vec3, angle: f32) -> Vec3 {
    let (sin, cos) = libm::sincosf(angle);
    let turned = v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    turned * (v.length() / turned.length())
}
