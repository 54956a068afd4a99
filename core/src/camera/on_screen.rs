//! Camera motions by positions in the picture, for the mouse.
//!
//! Positions and distances (`shares`) are fractions of the picture's width and height, to the right and down.
//! Positions are relative to the upper left corner.

use super::{Camera, Pose};
use glam::{Vec2, Vec3};

/// The action of a mouse drag on the camera.
///
/// ```
/// use termtrace::Grip;
///
/// let with_shift = true;
/// let grip = if with_shift { Grip::Pan } else { Grip::Turn };
/// assert_eq!(grip, Grip::Pan);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Grip {
    /// Orbits the target, or looks around in flight; usually with the left button.
    Turn,
    /// Shifts the picture; usually with the right or middle button, or with Shift and the left.
    Pan,
}

/// The angle of an orbit for a drag over the whole height of the picture, in radians.
// With half a turn, one drag over the whole height brings the back of an object to the front.
const ORBIT_PER_HEIGHT: f32 = std::f32::consts::PI;

/// The factor by which one notch of the wheel multiplies the distance.
// Five or six notches halve the distance. With a factor, each notch changes the size on the screen by the same ratio.
pub(super) const WHEEL_NOTCH_FACTOR: f32 = 0.88;

impl Camera {
    /// Returns the position of a point in a picture with the given aspect ratio (width / height).
    ///
    /// Returns `None` if the point is not in front of the eye.
    #[doc(hidden)]
    pub fn project(&self, point: Vec3, aspect_ratio: f32) -> Option<Vec2> {
        let (basis, way) = (self.rectangle_basis(), point - self.pose.eye);
        let (width, height, centre) = self.rectangle.width_height_middle(aspect_ratio);
        let depth = -way.dot(basis.w);
        let on_plane = Vec2::new(way.dot(basis.u), way.dot(basis.v)) / depth - centre;
        let place = 0.5 + on_plane / Vec2::new(width, -height);
        (depth > 0.0 && place.is_finite()).then_some(place)
    }

    /// Returns the camera shifted with its target by a drag of the picture to the right and down.
    // The shift is the distance of the drag at the target's depth, so that the target stays under the pointer.
    #[doc(hidden)]
    pub fn panned(&self, shares: Vec2, aspect_ratio: f32) -> Self {
        let (across, basis) = (self.on_view_plane(shares, aspect_ratio), self.rectangle_basis());
        let depth = self.target_distance() * self.rectangle.plane_distance();
        self.shifted(depth * (across.y * basis.v - across.x * basis.u))
    }

    /// Returns the camera turned about its target by a drag of the scene to the right and down.
    #[doc(hidden)]
    pub fn dragged_around(&self, shares: Vec2, aspect_ratio: f32) -> Self {
        let turn = ORBIT_PER_HEIGHT * Vec2::new(shares.x * aspect_ratio, shares.y);
        self.orbited(-turn.x, turn.y)
    }

    /// Returns the camera turned about its eye by a drag of the scene to the right and down.
    #[doc(hidden)]
    pub fn dragged_view(&self, shares: Vec2, aspect_ratio: f32) -> Self {
        let turn = self.on_view_plane(shares, aspect_ratio);
        self.turned(-turn.x, turn.y)
    }

    /// Returns the camera with eye and target moved towards a point by notches of the wheel.
    ///
    /// The point keeps its position in the picture.
    #[doc(hidden)]
    pub fn wheeled(&self, point: Vec3, notches: f32) -> Self {
        let factor = libm::powf(WHEEL_NOTCH_FACTOR, notches);
        self.shifted((1.0 - factor) * (point - self.pose.eye))
    }

    /// Returns the camera with eye and target scaled about a point by notches of the wheel.
    ///
    /// The point keeps its position in the picture. The distance from eye to target stays within the limits of
    /// [`nearer_within`](Self::nearer_within) for a scene of `scene_size`.
    #[doc(hidden)]
    pub fn scaled_about(&self, point: Vec3, notches: f32, scene_size: f32) -> Self {
        let Pose { eye, target, up } = self.pose;
        let after = self.nearer_within(libm::powf(WHEEL_NOTCH_FACTOR, notches), scene_size);
        let factor = after.target_distance() / self.target_distance();
        let moved = point + factor * (target - point);
        self.with_valid_pose(Pose { eye: moved + factor * (eye - target), target: moved, up })
    }

    /// Returns a point moved by a drag to the right and down in the picture, at constant depth.
    #[doc(hidden)]
    pub fn point_dragged(&self, point: Vec3, by: Vec2, aspect_ratio: f32) -> Vec3 {
        let (across, basis) = (self.on_view_plane(by, aspect_ratio), self.rectangle_basis());
        // A point behind or beside the eye has no position in the picture. It moves as far as the target would.
        let depth = Some((self.pose.eye - point).dot(basis.w)).filter(|depth| *depth > 0.0);
        point + depth.unwrap_or(self.target_distance()) * (across.x * basis.u - across.y * basis.v)
    }

    /// Returns a point moved away from the eye by notches of the wheel.
    ///
    /// The point keeps its position in the picture.
    #[doc(hidden)]
    pub fn point_pushed_away(&self, point: Vec3, notches: f32) -> Vec3 {
        let eye = self.pose.eye;
        eye + libm::powf(WHEEL_NOTCH_FACTOR, -notches) * (point - eye)
    }

    /// Converts a distance, in shares of the picture's width and height, to one on the plane at
    /// distance 1 from the eye.
    fn on_view_plane(&self, shares: Vec2, aspect_ratio: f32) -> Vec2 {
        let (width, height, _) = self.rectangle.width_height_middle(aspect_ratio);
        shares * Vec2::new(width, height)
    }
}
