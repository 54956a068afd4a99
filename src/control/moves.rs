//! One move of the camera, of any size. None of them turns the picture upside down, and where one would give no picture
//! (an eye too far out for f32), the view stays.

use super::{Grip, Mode};
use crate::bounds::Bounds;
use crate::camera::{Camera, Pose};
use glam::{BVec3, Vec2, Vec3};

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

/// Around the target, across the whole height of the picture: half a round.
const TURN_OF_HEIGHT: f32 = std::f32::consts::PI;

/// What is taken hold of in a picture of that aspect ratio goes so far to the right and down, in parts of the picture's
/// width and height: the view turns, in `orbit` about the target, or shifts as far as makes the target follow.
pub fn dragged(camera: &Camera, mode: Mode, grip: Grip, by: Vec2, aspect_ratio: f32) -> Camera {
    let (width, height, _) = camera.rectangle().fitted_to(aspect_ratio);
    // On the plane at distance 1.
    let across = by * Vec2::new(width, height);
    match grip {
        Grip::Pan => {
            let (Pose { eye, target, up }, basis) = (camera.pose(), camera.basis());
            let way = eye.distance(target) * (across.y * basis.v - across.x * basis.u);
            with_pose(camera, Pose { eye: eye + way, target: target + way, up })
        }
        Grip::Turn if mode == Mode::Orbit => around(camera, TURN_OF_HEIGHT * Vec2::new(by.x * aspect_ratio, by.y)),
        Grip::Turn => turned(camera, across),
    }
}

/// A notch of the wheel leaves so much of the distance.
const NOTCH: f32 = 0.88;

/// The eye comes nearer to the point by so many notches of the wheel, which stays where it is in the picture. In `orbit`
/// the target comes as much nearer to it, in a scene of about that size.
pub fn wheeled(camera: &Camera, mode: Mode, point: Vec3, notches: f32, size: f32) -> Camera {
    let Pose { eye, target, up } = camera.pose();
    let factor = libm::powf(NOTCH, notches);
    if mode != Mode::Orbit {
        let way = (1.0 - factor) * (point - eye);
        return with_pose(camera, Pose { eye: eye + way, target: target + way, up });
    }
    let after = nearer(camera, factor, size).pose();
    let factor = after.eye.distance(target) / eye.distance(target);
    let target = point + factor * (target - point);
    with_pose(camera, Pose { eye: target + factor * (eye - camera.pose().target), target, up })
}

/// Where a point is in a picture of that aspect ratio, in parts of its width and height from its upper left corner; nothing
/// for one that is not in front of the eye.
pub fn place_of(camera: &Camera, point: Vec3, aspect_ratio: f32) -> Option<Vec2> {
    let (basis, way) = (camera.basis(), point - camera.pose().eye);
    let (width, height, centre) = camera.rectangle().fitted_to(aspect_ratio);
    let depth = -way.dot(basis.w);
    let on_plane = Vec2::new(way.dot(basis.u), way.dot(basis.v)) / depth - centre;
    let place = 0.5 + on_plane / Vec2::new(width, -height);
    (depth > 0.0 && place.is_finite()).then_some(place)
}

/// A point goes so far to the right and down in a picture of that aspect ratio, in parts of its width and height, and
/// stays as deep in it as it is.
pub fn point_dragged(camera: &Camera, point: Vec3, by: Vec2, aspect_ratio: f32) -> Vec3 {
    let (Pose { eye, target, .. }, basis) = (camera.pose(), camera.basis());
    let (width, height, _) = camera.rectangle().fitted_to(aspect_ratio);
    // What is behind the eye, or beside it, goes as far as what is looked at would.
    let depth = Some((eye - point).dot(basis.w)).filter(|depth| *depth > 0.0).unwrap_or(eye.distance(target));
    point + depth * (by.x * width * basis.u - by.y * height * basis.v)
}

/// A point goes away from the eye by so many notches of the wheel, and stays where it is in the picture.
pub fn point_wheeled(camera: &Camera, point: Vec3, notches: f32) -> Vec3 {
    let eye = camera.pose().eye;
    eye + libm::powf(NOTCH, -notches) * (point - eye)
}

/// The turntable turns so many radians a second: once around in twenty seconds.
const TURNTABLE_SPEED: f32 = std::f32::consts::PI / 10.0;

/// The eye goes around the target as it would stand before a turntable, for so many seconds.
pub fn on_turntable(camera: &Camera, seconds: f32) -> Camera {
    around(camera, Vec2::new(-TURNTABLE_SPEED * seconds, 0.0))
}

/// So much of the picture's sides is filled by what is framed.
const FILLED: f32 = 0.95;

/// The same direction of view, from where a picture of that aspect ratio (width / height) is filled by the box, in whose
/// middle the target then is.
pub fn framing(camera: &Camera, bounds: &Bounds, aspect_ratio: f32) -> Camera {
    let (width, height, centre) = camera.rectangle().fitted_to(aspect_ratio);
    let half = 0.5 * FILLED * Vec2::new(width, height);
    let basis = camera.basis();
    let middle = bounds.min + 0.5 * bounds.extent();
    // How far away the eye has to be for a corner to be inside the picture.
    let distance = (0..8).map(|corner| {
        let is_max = |axis: u32| corner >> axis & 1 == 1;
        let corner = Vec3::select(BVec3::new(is_max(0), is_max(1), is_max(2)), bounds.max, bounds.min) - middle;
        let nearer = corner.dot(basis.w);
        let aside = Vec2::new(corner.dot(basis.u), corner.dot(basis.v)) + nearer * centre;
        nearer + (aside.abs() / half).max_element()
    });
    let distance = distance.fold(0.0, f32::max);
    if distance <= 0.0 {
        return *camera;
    }
    // Where the picture's middle is not straight ahead, the box is where that is.
    let target = middle - distance * (centre.x * basis.u + centre.y * basis.v);
    with_pose(camera, Pose { eye: target + distance * basis.w, target, ..camera.pose() })
}

/// The vertical field of view stays between these, in radians: 1 and 150 degrees.
const FIELD_OF_VIEW: [f32; 2] = [0.017_453_3, 2.617_994];

/// The same pose with a view rectangle that many times as large, as far as a field of view can be.
pub fn zoomed(camera: &Camera, factor: f32) -> Camera {
    let rectangle = camera.rectangle();
    let [least, most] = FIELD_OF_VIEW.map(|angle| 2.0 * libm::tanf(0.5 * angle));
    let height = rectangle.height();
    let wanted = (factor * height).clamp(least.min(height), most.max(height));
    rectangle.scaled(wanted / height).map_or(*camera, |rectangle| camera.with_rectangle(rectangle))
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

#[cfg(test)]
mod tests;
