//! Motions of the camera by angles, distances and factors of any size.
//!
//! No motion turns the picture upside down. A motion to an invalid pose, such as an eye beyond ±1e9, changes nothing.

use super::{Basis, Camera, Pose};
use super::{CameraError, radians};
use crate::bounds::Bounds;
use glam::{BVec3, Vec2, Vec3};

/// The smallest angle between the view and straight up or down, in radians.
// In a view straight up or down no direction of the picture would be vertical. One degree away from it, a turn about
// the up vector still moves the picture sideways instead of rotating it on the spot.
const POLE_MARGIN: f32 = 0.02;

/// The smallest distance from the eye to the target, as a multiple of the scene's size.
pub(super) const MIN_TARGET_DISTANCE: f32 = 1e-3;
/// The largest distance from the eye to the target, as a multiple of the scene's size.
// At this distance a scene is smaller than a pixel. Both limits keep squares and differences of coordinates well within
// the range and the precision of f32.
pub(super) const MAX_TARGET_DISTANCE: f32 = 1e4;

/// The fraction of the picture's width or height that a framed box fills.
// A share of 0.95 leaves a margin of 2.5 % on each side: about a cell in a terminal of 80x24.
pub(crate) const FRAMED_SHARE: f32 = 0.95;

/// The range of the vertical field of view, in radians: 1 to 150 degrees.
// Beyond 150 degrees, shapes at the border are stretched more than 14 times as much as those in the middle.
const FOV_RANGE: [f32; 2] = [0.017_453_3, 2.617_994];

/// The step of the shift by a key, in heights of the view rectangle.
const SHIFT_STEP: f32 = 0.05;
/// The step of the tilt by a key.
const TILT_STEP_DEGREES: f32 = 2.0;

impl Camera {
    /// Returns the camera with the eye moved around the target by angles in radians.
    ///
    /// The angles are to the right and upwards. The eye keeps its distance from the target, and stops 0.02 radians
    /// before the poles straight above and below the target. An angle that is not finite changes nothing.
    ///
    /// ```
    /// use glam::Vec3;
    /// use std::f32::consts::FRAC_PI_2;
    /// use termtrace::Scene;
    ///
    /// let scene = Scene::from_ron("x.ron", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))")?;
    /// let from_the_right = scene.camera().orbited(FRAC_PI_2, 0.0);
    /// assert!(from_the_right.pose().eye.abs_diff_eq(Vec3::new(5.0, 0.0, 0.0), 1e-5));
    /// # Ok::<(), termtrace::SceneError>(())
    /// ```
    #[must_use]
    pub fn orbited(&self, right: f32, up: f32) -> Self {
        if is_no_turn(right, up) {
            return *self;
        }
        let pose = self.pose;
        // When the eye moves to the right around the target, its view turns to the left.
        self.with_valid_pose(Pose { eye: pose.target - self.turned_view(right, -up), ..pose })
    }

    /// Returns the camera with the target moved around the eye by angles in radians.
    ///
    /// The angles are to the right and upwards. The view stops 0.02 radians before straight up and straight down. An
    /// angle that is not finite changes nothing.
    #[must_use]
    pub fn turned(&self, right: f32, up: f32) -> Self {
        if is_no_turn(right, up) {
            return *self;
        }
        self.with_valid_pose(Pose { target: self.pose.eye + self.turned_view(-right, up), ..self.pose })
    }

    /// Returns the camera with eye and target moved by distances in world units.
    ///
    /// The distances are to the right, along the up vector, and forward.
    #[must_use]
    pub fn moved(&self, right: f32, up: f32, forward: f32) -> Self {
        if (right, up, forward) == (0.0, 0.0, 0.0) {
            return *self;
        }
        let by = right * self.basis.u + up * self.pose.up.normalize_or_zero() + -forward * self.basis.w;
        self.shifted(by)
    }

    /// Returns the camera with the distance from eye to target multiplied by `distance_factor`.
    ///
    /// The target and the direction of view do not change. A single call changes the distance by a factor from 0.001 to
    /// 10,000, and the distance stays above 1e-15.
    #[must_use]
    pub fn nearer(&self, distance_factor: f32) -> Self {
        // Clamped, because squares of smaller or larger distances are out of the range of f32.
        self.nearer_within(distance_factor, self.target_distance().clamp(1e-12, 1e12))
    }

    /// Returns the camera with the sides of its view rectangle multiplied by `rectangle_factor`.
    ///
    /// A factor below 1 zooms in. The vertical field of view stays between 1 and 150 degrees.
    #[must_use]
    pub fn zoomed(&self, rectangle_factor: f32) -> Self {
        let rectangle = self.rectangle;
        let [least, most] = FOV_RANGE.map(|angle| 2.0 * libm::tanf(0.5 * angle));
        let height = rectangle.height();
        let wanted = (rectangle_factor * height).clamp(least.min(height), most.max(height));
        rectangle.scaled(wanted / height).map_or(*self, |rectangle| self.with_rectangle(rectangle))
    }

    /// Returns the camera with its view rectangle shifted by steps to the right and upwards.
    ///
    /// A step is 0.05 heights of the rectangle. Along each axis with steps, the new shift is rounded to a whole number
    /// of steps.
    ///
    /// # Errors
    /// If the rectangle cannot be shifted farther.
    #[doc(hidden)]
    pub fn shifted_rectangle(&self, steps: Vec2) -> Result<Self, CameraError> {
        let shift = plus_whole_steps(self.rectangle.shift / SHIFT_STEP, steps) * SHIFT_STEP;
        Ok(self.with_rectangle(self.rectangle.with_shift(shift)?))
    }

    /// Returns the camera with its view rectangle tilted to the right and upwards by some steps.
    ///
    /// A step is 2 degrees. A vertical step ends early where the rectangle becomes parallel to the up vector, so that
    /// the user can reach this angle exactly.
    ///
    /// # Errors
    /// If the rectangle cannot be tilted farther.
    #[doc(hidden)]
    pub fn tilted_rectangle(&self, steps: Vec2) -> Result<Self, CameraError> {
        let Vec2 { x: right, y: up } = self.rectangle.tilt;
        let degrees = Vec2::new(right.to_degrees(), up.to_degrees()) / TILT_STEP_DEGREES;
        let [right, next] =
            (plus_whole_steps(degrees, steps) * TILT_STEP_DEGREES).to_array().map(|angle| radians(angle.into()));
        let upright = self.upright_tilt();
        let passes = (up < upright && upright < next) || (next < upright && upright < up);
        let tilt = Vec2::new(right, if passes { upright } else { next });
        Ok(self.with_rectangle(self.rectangle.with_tilt(tilt)?))
    }

    /// Returns whether the view rectangle is parallel to the up vector.
    ///
    /// Lines along the up vector are then parallel in the picture.
    #[doc(hidden)]
    pub fn has_upright_rectangle(&self) -> bool {
        (self.rectangle.tilt.y - self.upright_tilt()).abs() < 1e-5
    }

    /// Returns the upward tilt at which the view rectangle is parallel to the up vector.
    fn upright_tilt(&self) -> f32 {
        let up = self.pose.up.normalize_or_zero();
        // At this angle the rectangle's normal is perpendicular to `up`: the dot products of `up` with the normal's
        // part along v and with its part in the plane of u and w cancel out.
        libm::atanf(libm::cosf(self.rectangle.tilt.x) * up.dot(self.basis.w) / up.dot(self.basis.v))
    }

    /// Returns the camera at the distance from which a box fills 95 % of a picture.
    ///
    /// The direction of view does not change. The target becomes the box's centre, or a point beside it if the view
    /// rectangle is shifted.
    ///
    /// `aspect_ratio` is the picture's width divided by its height. A box of size 0 changes nothing.
    #[must_use]
    pub fn framing(&self, bounds: &Bounds, aspect_ratio: f32) -> Self {
        let (width, height, centre) = self.rectangle.width_height_middle(aspect_ratio);
        let half = 0.5 * FRAMED_SHARE * Vec2::new(width, height);
        let Basis { u, v, w } = self.rectangle_basis();
        let distance = framing_distance(bounds, [u, v, w], half, centre);
        if distance <= 0.0 {
            return *self;
        }
        // With a shifted view rectangle the picture's centre is not straight ahead, so the target is moved aside to
        // put the box into the centre.
        let shift = centre - self.rectangle.view_axis_point();
        let target = centre_of(bounds) - distance * (shift.x * u + shift.y * v);
        let eye = target + distance / self.rectangle.plane_distance() * self.basis.w;
        self.with_valid_pose(Pose { eye, target, ..self.pose })
    }

    /// Returns the camera as [`nearer`](Self::nearer) does, within the limits of a scene's size.
    ///
    /// The distance stays between [`MIN_TARGET_DISTANCE`] and [`MAX_TARGET_DISTANCE`] times the size. If it is outside
    /// these limits, it only changes towards them.
    #[doc(hidden)]
    pub fn nearer_within(&self, distance_factor: f32, scene_size: f32) -> Self {
        let target = self.pose.target;
        let distance = self.target_distance();
        // Far from the origin the spacing of f32 limits the distance. 1e-5 is 84 times the relative spacing.
        let nearest = (MIN_TARGET_DISTANCE * scene_size).max(1e-5 * target.abs().max_element()).min(distance);
        let wanted = (distance_factor * distance).clamp(nearest, (MAX_TARGET_DISTANCE * scene_size).max(distance));
        if distance_factor == 1.0 || wanted == distance {
            return *self;
        }
        self.with_valid_pose(Pose { eye: target + wanted * self.basis.w, ..self.pose })
    }

    /// Returns the camera between this one and `end`: this one at `share` 0, exactly `end` at 1.
    ///
    /// The direction of view turns evenly, about the target or about the eye, whichever of them moves less.
    #[doc(hidden)]
    pub fn interpolated(&self, end: &Self, share: f32) -> Self {
        if share >= 1.0 {
            return *end;
        }
        let [from, to] = [self.pose, end.pose];
        let [a, b] = [from, to].map(|pose| pose.target - pose.eye);
        // Clamped, because rounding may take the cosine beyond 1.
        let angle = libm::acosf(a.normalize_or_zero().dot(b.normalize_or_zero()).clamp(-1.0, 1.0));
        // Opposite directions have no common normal: the camera then turns horizontally, about its own v axis.
        let axis = a.cross(b).try_normalize().unwrap_or(self.basis.v);
        let even = |from: f32, to: f32| libm::powf(to / from, share);
        let view = rotated(a, axis, share * angle) * even(a.length(), b.length());
        let up = from.up.normalize_or_zero().lerp(to.up.normalize_or_zero(), share);
        let pose = if from.target.distance(to.target) < from.eye.distance(to.eye) {
            let target = from.target.lerp(to.target, share);
            Pose { eye: target - view, target, up }
        } else {
            let eye = from.eye.lerp(to.eye, share);
            Pose { eye, target: eye + view, up }
        };
        let zoom = even(self.rectangle.height(), end.rectangle.height());
        let [from, to] = [self, end].map(|camera| camera.rectangle);
        let (shift, tilt) = (from.shift.lerp(to.shift, share), from.tilt.lerp(to.tilt, share));
        let rectangle = from.scaled(zoom).and_then(|scaled| scaled.with_shift(shift)?.with_tilt(tilt)).unwrap_or(from);
        self.with_valid_pose(pose).with_rectangle(rectangle)
    }

    /// Returns the distance from the eye to the target, in world units.
    #[doc(hidden)]
    pub fn target_distance(&self) -> f32 {
        self.pose.eye.distance(self.pose.target)
    }

    /// Returns the camera with eye and target moved by the same vector.
    pub(super) fn shifted(&self, offset: Vec3) -> Self {
        let Pose { eye, target, up } = self.pose;
        self.with_valid_pose(Pose { eye: eye + offset, target: target + offset, up })
    }

    /// Returns the camera at another pose, or unchanged if the pose is invalid.
    pub(super) fn with_valid_pose(&self, pose: Pose) -> Self {
        self.with_pose(pose).unwrap_or(*self)
    }

    /// Returns the vector from the eye to the target, turned to the left and upwards by angles in
    /// radians.
    fn turned_view(&self, left: f32, upwards: f32) -> Vec3 {
        let Pose { eye, target, up } = self.pose;
        let upwards = self.limited_upward_turn(upwards);
        let axis_up = up.normalize_or_zero();
        let u = rotated(self.basis.u, axis_up, left);
        rotated(rotated(target - eye, axis_up, left), u, upwards)
    }

    /// Returns the angle of an upward turn, limited so that the view stays [`POLE_MARGIN`] away
    /// from the poles.
    ///
    /// A view beyond this limit can only turn away from the pole.
    fn limited_upward_turn(&self, angle: f32) -> f32 {
        let limit = std::f32::consts::FRAC_PI_2 - POLE_MARGIN;
        let sine = -self.basis.w.dot(self.pose.up.normalize_or_zero());
        let elevation = libm::asinf(sine.clamp(-1.0, 1.0));
        if angle > 0.0 { angle.min((limit - elevation).max(0.0)) } else { angle.max((-limit - elevation).min(0.0)) }
    }
}

/// Returns whether a turn by these angles changes nothing.
fn is_no_turn(right: f32, up: f32) -> bool {
    (right, up) == (0.0, 0.0) || !(right.is_finite() && up.is_finite())
}

/// Returns the distance from a box's centre, along w, at which an eye sees all corners of the box.
///
/// A corner is seen if its projection to the plane at distance 1 is within `half` of `middle`, along u and v.
pub(crate) fn framing_distance(bounds: &Bounds, [u, v, w]: [Vec3; 3], half: Vec2, middle: Vec2) -> f32 {
    let centre = centre_of(bounds);
    let distance = (0..8).map(|corner| {
        let is_max = |axis: u32| corner >> axis & 1 == 1;
        let corner = Vec3::select(BVec3::new(is_max(0), is_max(1), is_max(2)), bounds.max, bounds.min) - centre;
        let nearer = corner.dot(w);
        let aside = Vec2::new(corner.dot(u), corner.dot(v)) + nearer * middle;
        nearer + (aside.abs() / half).max_element()
    });
    distance.fold(0.0, f32::max)
}

fn centre_of(bounds: &Bounds) -> Vec3 {
    bounds.min + 0.5 * bounds.extent()
}

/// Returns `v` rotated about a unit axis by an angle in radians (Rodrigues' formula).
///
/// The rotation is counterclockwise when seen from the end of the axis.
// The length of `v` is restored, because the rounding errors of many small turns would add up.
fn rotated(v: Vec3, axis: Vec3, angle: f32) -> Vec3 {
    let (sin, cos) = libm::sincosf(angle);
    let turned = v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    turned * (v.length() / turned.length())
}

/// Returns `number` plus `steps`, rounded to a whole number along axes where `steps` is not 0.
fn plus_whole_steps(number: Vec2, steps: Vec2) -> Vec2 {
    Vec2::select(steps.cmpeq(Vec2::ZERO), number, (number + steps).round())
}
