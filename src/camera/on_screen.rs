//! The camera and what is seen through it, moved by places in its picture: parts of the picture's width and height, counted
//! from its upper left corner.

use super::{Camera, Pose};
use glam::{Vec2, Vec3};

/// What a drag does to the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Grip {
    /// It turns the view: usually with the left button.
    Turn,
    /// It shifts the picture: usually with the right or the middle button, or with the left one and Shift.
    Pan,
}

/// The angle around the target for the whole height of the picture, in radians.
const ORBIT_PER_HEIGHT: f32 = std::f32::consts::PI;

/// The share of a distance that a notch of the wheel leaves.
pub(super) const WHEEL_NOTCH_FACTOR: f32 = 0.88;

impl Camera {
    /// Returns where a point is in a picture of that aspect ratio; `None` for a point that is not in front of the eye.
    #[doc(hidden)]
    pub fn project(&self, point: Vec3, aspect_ratio: f32) -> Option<Vec2> {
        let (basis, way) = (self.basis, point - self.pose.eye);
        let (width, height, centre) = self.rectangle.fitted_to(aspect_ratio);
        let depth = -way.dot(basis.w);
        let on_plane = Vec2::new(way.dot(basis.u), way.dot(basis.v)) / depth - centre;
        let place = 0.5 + on_plane / Vec2::new(width, -height);
        (depth > 0.0 && place.is_finite()).then_some(place)
    }

    /// Returns the camera after the picture has been dragged to the right and down: the target goes along.
    pub(crate) fn panned(&self, by: Vec2, aspect_ratio: f32) -> Self {
        let across = self.across(by, aspect_ratio);
        self.shifted(self.target_distance() * (across.y * self.basis.v - across.x * self.basis.u))
    }

    /// Returns the camera after the scene has been dragged to the right and down, about the target.
    pub(crate) fn dragged_around(&self, by: Vec2, aspect_ratio: f32) -> Self {
        let turn = ORBIT_PER_HEIGHT * Vec2::new(by.x * aspect_ratio, by.y);
        self.orbited(-turn.x, turn.y)
    }

    /// Returns the camera after the scene has been dragged to the right and down, about the eye.
    #[cfg(feature = "live")]
    pub(crate) fn dragged_view(&self, by: Vec2, aspect_ratio: f32) -> Self {
        let turn = self.across(by, aspect_ratio);
        self.turned(-turn.x, turn.y)
    }

    /// Returns the camera after the eye has come nearer to a point, which stays where it is in the picture, by notches of the
    /// wheel. The target moves as the eye does.
    #[cfg(feature = "live")]
    pub(crate) fn wheeled(&self, point: Vec3, notches: f32) -> Self {
        let factor = libm::powf(WHEEL_NOTCH_FACTOR, notches);
        self.shifted((1.0 - factor) * (point - self.pose.eye))
    }

    /// Returns the camera after eye and target have come nearer to a point, which stays where it is in the picture, by notches
    /// of the wheel, in a scene of that size.
    pub(crate) fn wheeled_around(&self, point: Vec3, notches: f32, size: f32) -> Self {
        let Pose { eye, target, up } = self.pose;
        let after = self.nearer_within(libm::powf(WHEEL_NOTCH_FACTOR, notches), size);
        let factor = after.target_distance() / self.target_distance();
        let moved = point + factor * (target - point);
        self.with_valid_pose(Pose { eye: moved + factor * (eye - target), target: moved, up })
    }

    /// Returns a point after it has been dragged to the right and down in the picture, in which it stays as deep as it is.
    #[doc(hidden)]
    pub fn point_dragged(&self, point: Vec3, by: Vec2, aspect_ratio: f32) -> Vec3 {
        let across = self.across(by, aspect_ratio);
        // A point behind the eye, or beside it, goes as far as the target would.
        let depth = Some((self.pose.eye - point).dot(self.basis.w)).filter(|depth| *depth > 0.0);
        point + depth.unwrap_or(self.target_distance()) * (across.x * self.basis.u - across.y * self.basis.v)
    }

    /// Returns a point after it has gone away from the eye by notches of the wheel; it stays where it is in the picture.
    #[doc(hidden)]
    pub fn point_wheeled(&self, point: Vec3, notches: f32) -> Vec3 {
        let eye = self.pose.eye;
        eye + libm::powf(WHEEL_NOTCH_FACTOR, -notches) * (point - eye)
    }

    /// A distance in the picture as one on the plane at distance 1.
    fn across(&self, by: Vec2, aspect_ratio: f32) -> Vec2 {
        let (width, height, _) = self.rectangle.fitted_to(aspect_ratio);
        by * Vec2::new(width, height)
    }
}
