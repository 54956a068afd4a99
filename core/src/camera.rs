//! The camera: pose, intrinsic parameters, and the eye rays (lecture, "Generating eye rays").
//!
//! World space is right-handed. Angles are in radians; only scene files and `with_fov_degrees` have degrees.

use crate::checks::{self, TOO_FAR};
use crate::lanes::{Number, Vector};
use crate::ray::Ray;
use glam::{DVec3, Vec2, Vec3};
use std::fmt;

mod motion;
mod on_screen;
#[cfg(all(test, unit_tests))]
mod tests;

pub(crate) use motion::{FRAMED_SHARE, framing_distance};
pub use on_screen::Grip;

/// A camera: a checked pose and intrinsic parameters.
///
/// Every camera can take a picture: its eye is not at its target, and its up vector is not along the view.
#[derive(Clone, Copy, PartialEq)]
pub struct Camera {
    pose: Pose,
    basis: Basis,
    rectangle: ViewRectangle,
}

/// Formats the parameters without the basis, which is computed from the pose.
impl fmt::Debug for Camera {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pose: Pose { eye, target, up }, rectangle, .. } = self;
        let ViewRectangle { width, height, shift, tilt } = rectangle;
        // With `{:#?}` a vector is one line here, while glam's output would take a line for each coordinate.
        let mut camera = f.debug_struct("Camera");
        camera.field("eye", &format_args!("{eye:?}"));
        camera.field("target", &format_args!("{target:?}"));
        camera.field("up", &format_args!("{up:?}"));
        camera.field("width", &format_args!("{width:?}")).field("height", height);
        camera.field("shift", &format_args!("{shift:?}")).field("tilt", &format_args!("{tilt:?}")).finish()
    }
}

/// The position and orientation of a camera, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The eye point: the centre of projection.
    pub eye: Vec3,
    /// The target point, which appears in the middle of the picture.
    pub target: Vec3,
    /// The direction that appears vertical in the picture, of any length from 1e-9 to 1e9.
    pub up: Vec3,
}

/// The camera's right-handed orthonormal basis: u to the right, v up, w away from the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// The horizontal axis of the view plane. Unit length.
    pub u: Vec3,
    /// The vertical axis of the view plane. Unit length.
    pub v: Vec3,
    /// The direction from the target to the eye. Unit length.
    pub w: Vec3,
}

/// The view rectangle: the intrinsic parameters, on the plane that the w axis pierces at distance 1
/// in front of the eye.
///
/// ```
/// use glam::Vec3;
/// use termtrace::{Camera, Pose, ViewRectangle};
///
/// let pose = Pose { eye: Vec3::new(0.0, 1.0, 5.0), target: Vec3::ZERO, up: Vec3::Y };
/// let camera = Camera::new(pose, ViewRectangle::from_vertical_fov(0.7)?)?;
/// assert_eq!(camera.pose(), pose);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
// The picture depends only on the ratios of the lecture's f, w and h, so the focal length is always scaled to 1. Equal
// views then have equal values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRectangle {
    /// The width of the rectangle divided by the focal length; `None` if it follows from the
    /// picture's aspect ratio.
    width: Option<f32>,
    /// The height of the rectangle divided by the focal length.
    height: f32,
    /// The offset of the rectangle's middle from the w axis, to the right and upwards, in heights
    /// of the rectangle.
    shift: Vec2,
    /// The angles between the direction of view and the normal of the plane, to the right and
    /// upwards, in radians.
    tilt: Vec2,
}

/// The error of camera parameters that give no picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CameraError {
    /// A coordinate is infinite or not a number.
    NotFinite,
    /// A coordinate is beyond ±1e9.
    TooFar,
    /// The eye and the target are the same point, so the direction of view is undefined.
    EyeIsTarget,
    /// The up vector is zero.
    UpIsZero,
    /// The up vector is shorter than 1e-9.
    UpTooShort,
    /// The up vector is parallel to the view, so no direction of the picture would be vertical.
    UpAlongView,
    /// The vertical field of view is not between 0 and 180 degrees.
    FieldOfView,
    /// A side or the focal length of the view rectangle is not greater than 0 and finite.
    ViewRectangle,
    /// A side of the view rectangle is not between 1e-6 and 1e6 focal lengths.
    Sides,
    /// The aspect ratio is not between 1e-6 and 1e6.
    AspectRatio,
    /// The shift is more than 1000 heights of the view rectangle.
    Shift,
    /// An angle of the tilt is more than 89 degrees.
    #[doc(hidden)]
    Tilt,
    /// An edge of the view rectangle is beside or behind the eye.
    #[doc(hidden)]
    BehindEye,
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "the camera's numbers must be finite",
            Self::EyeIsTarget => "the eye and the target are the same point; the camera has no direction to look in",
            Self::TooFar => TOO_FAR,
            Self::UpIsZero => "the up vector must have a length; (0, 0, 0) points nowhere",
            Self::UpTooShort => "the up vector must be longer than 1e-9",
            Self::UpAlongView => "up is parallel to the view (target - eye); it must point to one side of it",
            Self::FieldOfView => "the vertical field of view is an angle between 0 and 180 degrees, both excluded",
            Self::ViewRectangle => {
                "the view rectangle's focal length, width, height and aspect ratio must be greater than 0"
            }
            Self::Sides => "a side of the view rectangle must lie between 1e-6 and 1e6 focal lengths",
            Self::AspectRatio => "the aspect ratio must lie between 1e-6 and 1e6",
            Self::Shift => "the view rectangle can be shifted by at most 1000 of its heights",
            // In the next two messages, the part before the semicolon fits into a note of 40 columns, which has no room
            // for the rest.
            Self::Tilt => "the tilt can be at most 89 degrees; at 90 the view rectangle would contain the eye",
            Self::BehindEye => "the rectangle passes behind the eye; tilt it less, shift it less, or make it smaller",
        })
    }
}

impl std::error::Error for CameraError {}

/// The default vertical field of view, in degrees.
pub(crate) const DEFAULT_FOV_DEGREES: f64 = 45.0;

impl Camera {
    /// Returns the camera at `eye` that looks at `target`, with +y up.
    ///
    /// The vertical field of view is 45 degrees.
    ///
    /// ```
    /// use glam::Vec3;
    /// use termtrace::Camera;
    ///
    /// let camera = Camera::look_at(Vec3::new(0.0, 1.5, 6.0), Vec3::ZERO)?.with_fov_degrees(40.0)?;
    /// assert_eq!(camera.pose().eye, Vec3::new(0.0, 1.5, 6.0));
    ///
    /// let error = Camera::look_at(Vec3::ONE, Vec3::ONE).unwrap_err();
    /// assert!(error.to_string().starts_with("the eye and the target are the same point"));
    /// # Ok::<(), termtrace::CameraError>(())
    /// ```
    ///
    /// # Errors
    /// If both are the same point, a coordinate is not within ±1e9, or the camera would look straight up or down. For
    /// such a view call [`Camera::new`] with another up vector.
    pub fn look_at(eye: Vec3, target: Vec3) -> Result<Self, CameraError> {
        Self::new(Pose { eye, target, up: Vec3::Y }, ViewRectangle::from_vertical_fov(radians(DEFAULT_FOV_DEGREES))?)
    }

    /// Returns the camera with another up vector, of any length from 1e-9 to 1e9.
    ///
    /// # Errors
    /// If the length of the up vector is out of this range, or the vector is parallel to the view.
    pub fn with_up(self, up: Vec3) -> Result<Self, CameraError> {
        self.with_pose(Pose { up, ..self.pose })
    }

    /// Returns the camera with another vertical field of view, in degrees.
    ///
    /// The view rectangle keeps its aspect ratio.
    ///
    /// # Errors
    /// If the angle is not between 0 and 180 degrees, both excluded.
    pub fn with_fov_degrees(self, degrees: f32) -> Result<Self, CameraError> {
        Ok(Self { rectangle: self.rectangle.with_vertical_fov(radians(degrees.into()))?, ..self })
    }

    /// Returns the camera with the given pose and view rectangle.
    ///
    /// ```
    /// use glam::Vec3;
    /// use termtrace::{Camera, Pose, ViewRectangle};
    ///
    /// let above = Pose { eye: Vec3::new(0.0, 9.0, 0.0), target: Vec3::ZERO, up: Vec3::NEG_Z };
    /// let camera = Camera::new(above, ViewRectangle::from_vertical_fov(0.7)?)?;
    /// assert_eq!(camera.pose(), above);
    /// # Ok::<(), termtrace::CameraError>(())
    /// ```
    ///
    /// # Errors
    /// If the eye is at the target, the up vector is zero or parallel to the view, or a number is out of range: see
    /// [`CameraError`].
    pub fn new(pose: Pose, rectangle: ViewRectangle) -> Result<Self, CameraError> {
        Ok(Self { pose, basis: Basis::from_pose(&pose)?, rectangle })
    }

    /// Returns the camera with another pose.
    ///
    /// # Errors
    /// As [`Camera::new`].
    #[doc(hidden)]
    pub fn with_pose(&self, pose: Pose) -> Result<Self, CameraError> {
        Self::new(pose, self.rectangle)
    }

    /// Returns the camera with another view rectangle.
    #[must_use]
    #[doc(hidden)]
    pub fn with_rectangle(&self, rectangle: ViewRectangle) -> Self {
        Self { rectangle, ..*self }
    }

    /// Returns the eye, the target and the up vector, as given.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Returns the basis vectors u, v and w.
    #[doc(hidden)]
    pub fn basis(&self) -> Basis {
        self.basis
    }

    /// Returns the view rectangle.
    #[doc(hidden)]
    pub fn rectangle(&self) -> ViewRectangle {
        self.rectangle
    }

    /// Returns the basis of the view rectangle: u and v along its sides, w perpendicular to it.
    ///
    /// It is the camera's basis unless the rectangle is tilted.
    // A camera with a tilted rectangle has the same rays as one that looks along the normal of the rectangle, with
    // another shift. So code that works with positions in the picture uses this basis, and needs no other formulas.
    #[doc(hidden)]
    pub fn rectangle_basis(&self) -> Basis {
        let Basis { u, v, w } = self.basis;
        // Without tilt, the sums below could still turn a coordinate of -0 into 0.
        if self.rectangle.tilt == Vec2::ZERO {
            return self.basis;
        }
        let [(sin_right, cos_right), (sin_up, cos_up)] = self.rectangle.tilt.to_array().map(libm::sincosf);
        let level = w * cos_right - u * sin_right;
        Basis { u: u * cos_right + w * sin_right, v: v * cos_up + level * sin_up, w: level * cos_up - v * sin_up }
    }

    /// Returns the eye rays of a picture with the given aspect ratio (width / height).
    #[doc(hidden)]
    pub fn eye_rays(&self, aspect_ratio: f32) -> EyeRays {
        let Basis { u, v, w } = self.rectangle_basis();
        let (width, height, middle) = self.rectangle.width_height_middle(aspect_ratio);
        let q0 = u * (middle.x - 0.5 * width) + v * (middle.y - 0.5 * height) - w;
        EyeRays { eye: self.pose.eye, q0, across: u * width, upward: v * height }
    }
}

impl Basis {
    /// Returns the basis of a pose by the lecture's construction from two vectors.
    ///
    /// With a = -(target - eye) and b = up it is w = a / |a|, u = b x w / |b x w|, v = w x u.
    // Computed in f64 and rounded once at the end, so that a target far away, or an up vector nearly along the view,
    // does not lose digits.
    fn from_pose(pose: &Pose) -> Result<Self, CameraError> {
        let [eye, target, up] = [pose.eye, pose.target, pose.up].map(Vec3::as_dvec3);
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        if ![eye, target, up].into_iter().all(checks::is_within_range) {
            return Err(CameraError::TooFar);
        }
        let w = unit_vector(eye - target).ok_or(CameraError::EyeIsTarget)?;
        if up != DVec3::ZERO && !checks::is_long_enough(pose.up) {
            return Err(CameraError::UpTooShort);
        }
        let up = unit_vector(up).ok_or(CameraError::UpIsZero)?;
        let across = up.cross(w);
        // The length is the sine of the angle between up and the view. For vectors that are parallel as written,
        // rounding to f32 makes it up to a tenth of this limit.
        if across.length() < 1e-6 {
            return Err(CameraError::UpAlongView);
        }
        let u = across / across.length();
        Ok(Self { u: u.as_vec3(), v: w.cross(u).as_vec3(), w: w.as_vec3() })
    }
}

/// Returns the unit vector in the direction of `v`, or `None` for the zero vector.
// Divides by the largest coordinate first, so that the squares of very large or small coordinates neither overflow nor
// vanish.
fn unit_vector(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    (largest > 0.0).then(|| v / largest).map(|v| v / v.dot(v).sqrt())
}

/// Converts degrees to radians in f64, and rounds the result to f32.
pub(crate) fn radians(degrees: f64) -> f32 {
    degrees.to_radians() as f32
}

impl ViewRectangle {
    /// The largest angle, in degrees along each axis, between the direction of view and the
    /// rectangle's normal; see [`with_tilt`](Self::with_tilt).
    // The plane is then at least cos^2(89 degrees) = 3e-4 in front of the eye, and f32 has digits left for directions.
    pub(crate) const MAX_TILT_DEGREES: f32 = 89.0;

    /// The largest [shift](Self::with_shift) along each axis, in heights of the rectangle.
    // A thousand heights are far beyond any lens, and f32 still resolves 6e-5 of a height there.
    pub(crate) const MAX_SHIFT: f32 = 1e3;

    /// Returns the rectangle with a vertical field of view in radians: h = 2 f tan(alpha / 2).
    ///
    /// Its width follows from the picture's aspect ratio.
    ///
    /// # Errors
    /// If the angle is not between 0 and pi, both excluded.
    pub fn from_vertical_fov(radians: f32) -> Result<Self, CameraError> {
        let height = (2.0 * libm::tan(0.5 * f64::from(radians))) as f32;
        if radians > 0.0 && radians < std::f32::consts::PI && height > 0.0 && height.is_finite() {
            Ok(Self { width: None, height, shift: Vec2::ZERO, tilt: Vec2::ZERO })
        } else {
            Err(CameraError::FieldOfView)
        }
    }

    /// Returns the rectangle with the lecture's f, w and h, all in the same unit.
    ///
    /// # Errors
    /// If one of them is not greater than 0 and finite, or a side is not between 1e-6 and 1e6 focal lengths.
    #[doc(hidden)]
    pub fn from_focal_length(focal_length: f32, width: f32, height: f32) -> Result<Self, CameraError> {
        let (width, height) = (width / focal_length, height / focal_length);
        if !(focal_length > 0.0 && is_positive(width) && is_positive(height)) {
            return Err(CameraError::ViewRectangle);
        }
        if ![width, height].into_iter().all(|side| checks::is_ratio_within_range(side.into())) {
            return Err(CameraError::Sides);
        }
        Ok(Self { width: Some(width), height, shift: Vec2::ZERO, tilt: Vec2::ZERO })
    }

    /// Returns the rectangle with the given sides at focal length 1, without shift or tilt.
    #[cfg(feature = "serde")]
    pub(crate) fn from_sides(width: Option<f32>, height: f32) -> Result<Self, CameraError> {
        if is_positive(height) && width.is_none_or(is_positive) {
            Ok(Self { width, height, shift: Vec2::ZERO, tilt: Vec2::ZERO })
        } else {
            Err(CameraError::ViewRectangle)
        }
    }

    /// Returns the rectangle with another vertical field of view, in radians.
    ///
    /// The aspect ratio, the shift and the tilt do not change.
    ///
    /// # Errors
    /// As [`ViewRectangle::from_vertical_fov`], or if the rectangle would pass behind the eye.
    #[doc(hidden)]
    pub fn with_vertical_fov(self, radians: f32) -> Result<Self, CameraError> {
        let Self { height, .. } = Self::from_vertical_fov(radians)?;
        Self { height, width: self.width.map(|width| width * (height / self.height)), ..self }.checked_in_front()
    }

    /// Returns the rectangle with both sides multiplied by `factor`.
    ///
    /// # Errors
    /// If a side is no longer greater than 0 and finite, the vertical field of view reaches 180 degrees, or the
    /// rectangle would pass behind the eye.
    #[doc(hidden)]
    pub fn scaled(self, factor: f32) -> Result<Self, CameraError> {
        let (width, height) = (self.width.map(|width| width * factor), self.height * factor);
        if !(is_positive(height) && width.is_none_or(is_positive)) {
            return Err(CameraError::ViewRectangle);
        }
        let scaled = Self { width, height, ..self };
        if scaled.vertical_fov() < std::f32::consts::PI {
            scaled.checked_in_front()
        } else {
            Err(CameraError::FieldOfView)
        }
    }

    /// Returns the rectangle with the same height and a fixed aspect ratio (width / height).
    ///
    /// # Errors
    /// If the aspect ratio is not between 1e-6 and 1e6, or the rectangle would pass behind the eye.
    #[doc(hidden)]
    pub fn with_aspect_ratio(self, aspect_ratio: f32) -> Result<Self, CameraError> {
        if !checks::is_ratio_within_range(aspect_ratio.into()) {
            return Err(CameraError::AspectRatio);
        }
        let width = self.height * aspect_ratio;
        if !is_positive(width) {
            return Err(CameraError::ViewRectangle);
        }
        Self { width: Some(width), ..self }.checked_in_front()
    }

    /// Returns the rectangle with its middle shifted from the w axis, to the right and upwards.
    ///
    /// The shift is in heights of the rectangle.
    ///
    /// # Errors
    /// If the shift is not finite, or more than 1000 heights along an axis, or the rectangle would pass behind the eye.
    #[doc(hidden)]
    pub fn with_shift(self, shift: Vec2) -> Result<Self, CameraError> {
        if !shift.is_finite() {
            return Err(CameraError::NotFinite);
        }
        let is_far = shift.abs().max_element() > Self::MAX_SHIFT;
        if is_far { Err(CameraError::Shift) } else { Self { shift, ..self }.checked_in_front() }
    }

    /// Returns the rectangle with another tilt, to the right and upwards, in radians.
    ///
    /// These are the angles between the direction of view and the normal of the rectangle, away from the eye. The
    /// rectangle turns about the point that the w axis pierces: first about v, then about its own horizontal axis.
    ///
    /// # Errors
    /// If an angle is not finite or more than 89 degrees, or the rectangle would pass behind the eye.
    #[doc(hidden)]
    pub fn with_tilt(self, tilt: Vec2) -> Result<Self, CameraError> {
        if !tilt.is_finite() {
            return Err(CameraError::NotFinite);
        }
        let is_steep = tilt.abs().max_element() > radians(Self::MAX_TILT_DEGREES.into());
        if is_steep { Err(CameraError::Tilt) } else { Self { tilt, ..self }.checked_in_front() }
    }

    /// Returns the rectangle, or an error if a part of it is beside or behind the eye.
    // For a rectangle whose width follows from the picture, only the line through its middle is checked. A wide picture
    // may extend it past the eye, and is still right, because the eye is never on the plane.
    fn checked_in_front(self) -> Result<Self, CameraError> {
        let Self { width, height, shift, tilt } = self;
        let [(sin_right, cos_right), (sin_up, _)] = tilt.to_array().map(libm::sincosf);
        // The decrease of depth, along -w, per unit step along each side of the rectangle.
        let towards = Vec2::new(sin_right, sin_up * cos_right);
        let half = 0.5 * Vec2::new(width.unwrap_or(0.0), height);
        let least_depth = 1.0 - towards.dot(shift * height) - towards.abs().dot(half);
        // Without tilt `least_depth` is 1, or NaN for sides beyond the range of f32, which other checks refuse.
        if tilt == Vec2::ZERO || least_depth > 0.0 { Ok(self) } else { Err(CameraError::BehindEye) }
    }

    /// Returns the vertical field of view of the unshifted, untilted rectangle, in radians.
    #[doc(hidden)]
    pub fn vertical_fov(&self) -> f32 {
        2.0 * libm::atanf(0.5 * self.height)
    }

    /// Returns the width divided by the focal length; `None` if it follows from the picture's
    /// aspect ratio.
    #[doc(hidden)]
    pub fn width(&self) -> Option<f32> {
        self.width
    }

    /// Returns the height divided by the focal length.
    #[doc(hidden)]
    pub fn height(&self) -> f32 {
        self.height
    }

    /// Returns the aspect ratio (width / height); `None` if it is that of the picture.
    #[doc(hidden)]
    pub fn aspect_ratio(&self) -> Option<f32> {
        self.width.map(|width| width / self.height)
    }

    /// Returns the offset of the middle from the w axis, to the right and upwards, in heights of
    /// the rectangle.
    #[doc(hidden)]
    pub fn shift(&self) -> Vec2 {
        self.shift
    }

    /// Returns the tilt of the view rectangle: the angles from the direction of view to its normal.
    ///
    /// The first is to the right, the second upwards, both in radians.
    #[doc(hidden)]
    pub fn tilt(&self) -> Vec2 {
        self.tilt
    }

    /// Returns texts with the shift, and with the tilt in degrees: `shift 0 0.34` and `tilt 0 -21`.
    ///
    /// The shift is in heights of the rectangle. A text is missing if both of its numbers are 0.
    #[doc(hidden)]
    pub fn offset_texts(&self) -> Vec<String> {
        // Adding 0 turns -0 into 0, so that the text is never `-0`.
        let number = |x: f32| (100.0 * x).round() / 100.0 + 0.0;
        let tilt = self.tilt.to_array().map(f32::to_degrees);
        let texts = [("shift", self.shift.to_array()), ("tilt", tilt)].into_iter();
        texts
            .filter(|(_, offset)| *offset != [0.0; 2])
            .map(|(name, [x, y])| format!("{name} {} {}", number(x), number(y)))
            .collect()
    }

    /// Returns the distance from the eye to the plane of the rectangle; 1 unless the rectangle is
    /// tilted.
    #[doc(hidden)]
    pub fn plane_distance(&self) -> f32 {
        libm::cosf(self.tilt.x) * libm::cosf(self.tilt.y)
    }

    /// Returns the point that the w axis pierces, on the plane at distance 1 along the normal.
    ///
    /// Its coordinates are along the sides of the rectangle; (0, 0) unless the rectangle is tilted.
    fn view_axis_point(&self) -> Vec2 {
        let Vec2 { x: right, y: up } = self.tilt;
        -Vec2::new(libm::tanf(right) / libm::cosf(up), libm::tanf(up))
    }

    /// Returns width, height and middle of the rectangle, extended to a picture's aspect ratio.
    ///
    /// They are lengths on the plane at distance 1 along the normal of the rectangle.
    // The rectangle is extended instead of cropped or stretched, so that all of it is visible in a terminal of any
    // shape: to the left and right in a wider picture, up and down in a narrower one.
    pub(crate) fn width_height_middle(&self, aspect_ratio: f32) -> (f32, f32, Vec2) {
        let (width, height) = match self.width {
            Some(width) if width > self.height * aspect_ratio => (width, width / aspect_ratio),
            _ => (self.height * aspect_ratio, self.height),
        };
        let distance = self.plane_distance();
        let shift = self.shift * (self.height / distance);
        (width / distance, height / distance, self.view_axis_point() + shift)
    }
}

/// Returns whether a number is greater than 0 and finite.
fn is_positive(x: f32) -> bool {
    x > 0.0 && x.is_finite()
}

/// The eye rays of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeRays {
    eye: Vec3,
    /// The vector from the eye to the lower left corner of the view rectangle.
    // The lecture's q0 is the sum of the eye and this vector. Without the eye, a camera far from the origin loses no
    // digits.
    q0: Vec3,
    /// The bottom edge of the view rectangle: w * u of the lecture.
    across: Vec3,
    /// The left edge of the view rectangle: h * v of the lecture.
    upward: Vec3,
}

impl EyeRays {
    /// Returns the ray through a position in the picture, from (0, 0) at the lower left corner to
    /// (1, 1).
    ///
    /// It goes through the lecture's q = q0 + w qu u + h qv v. The direction is q - eye. Its component along -w of
    /// [`Camera::rectangle_basis`] is 1, so that t is the depth.
    // Normalizing the direction would cost a square root and a division per ray, and t would no longer be the depth.
    pub fn through(&self, qu: f32, qv: f32) -> Ray {
        Ray { origin: self.eye, direction: self.direction(qu, qv).into() }
    }

    /// Returns the direction of the ray [`through`](Self::through) a position, for each lane.
    #[inline(always)]
    pub fn direction<N: Number>(&self, qu: N, qv: N) -> Vector<N> {
        Vector::splat(self.q0) + Vector::splat(self.across) * qu + Vector::splat(self.upward) * qv
    }

    /// Returns the origin of all eye rays.
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// Returns the changes of direction from a pixel to the next one on the right and to the next
    /// one above.
    ///
    /// `width` and `height` are those of the picture in pixels.
    pub fn steps(&self, width: u32, height: u32) -> [Vec3; 2] {
        [self.across / width as f32, self.upward / height as f32]
    }
}
