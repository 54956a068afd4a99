//! The camera: pose, intrinsic parameters, and the eye rays (lecture, "Generating eye rays").
//!
//! World space is right-handed. Angles are radians here, degrees where a person writes them.

use crate::checks::{self, TOO_FAR};
use crate::lanes::{Number, Vector};
use crate::ray::Ray;
use glam::{DVec3, Vec2, Vec3};
use std::fmt;

mod motion;
#[cfg(feature = "ratatui")]
mod on_screen;
#[cfg(test)]
mod tests;

pub(crate) use motion::{FRAMED_SHARE, framing_distance};
#[cfg(feature = "ratatui")]
pub use on_screen::Grip;

/// A pose and intrinsic parameters that give a picture: the eye is not at the target, up is not along the view.
#[derive(Clone, Copy, PartialEq)]
pub struct Camera {
    pose: Pose,
    basis: Basis,
    rectangle: ViewRectangle,
}

/// What it was made of: the basis follows from that.
impl fmt::Debug for Camera {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pose: Pose { eye, target, up }, rectangle: ViewRectangle { width, height, shift }, .. } = self;
        // Each vector in one line.
        let mut camera = f.debug_struct("Camera");
        camera.field("eye", &format_args!("{eye:?}"));
        camera.field("target", &format_args!("{target:?}"));
        camera.field("up", &format_args!("{up:?}"));
        camera.field("width", &format_args!("{width:?}")).field("height", height);
        camera.field("shift", &format_args!("{shift:?}")).finish()
    }
}

/// How the camera stands in space, as the lecture's user says it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The eye point: the viewpoint, the centre of projection.
    pub eye: Vec3,
    /// The target point, which appears in the middle of the picture.
    pub target: Vec3,
    /// A direction that appears vertical in the picture; of any length but 0.
    pub up: Vec3,
}

/// The camera's orthonormal basis: right-handed, u to the right, v up, and the camera looks along -w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// The horizontal axis of the view plane. Unit length.
    pub u: Vec3,
    /// The vertical axis of the view plane. Unit length.
    pub v: Vec3,
    /// Away from the target. Unit length.
    pub w: Vec3,
}

/// The view rectangle on the plane at distance 1 in front of the eye. What is seen depends only on the ratios of the
/// lecture's f, w and h (scaling all three changes nothing), so the focal length is always made 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRectangle {
    /// Width over focal length; `None`: as wide as the picture is.
    width: Option<f32>,
    /// Height over focal length.
    height: f32,
    /// Where the middle of the rectangle lies, to the right of and above the point that the w axis pierces, in
    /// heights of the rectangle.
    shift: Vec2,
}

/// Why there is no picture from these numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CameraError {
    /// A coordinate is infinite or not a number.
    NotFinite,
    /// A coordinate is beyond ±1e9.
    TooFar,
    /// The eye and the target are one point: there is no direction to look in.
    EyeIsTarget,
    /// The up vector has no length.
    UpIsZero,
    /// The up vector is shorter than 1e-9.
    UpTooShort,
    /// The up vector lies along the view: no direction of the picture would be vertical.
    UpAlongView,
    /// A vertical field of view that is not between 0 and 180 degrees.
    FieldOfView,
    /// A view rectangle with a side or a focal length that is not greater than 0.
    ViewRectangle,
    /// A side of the view rectangle that is not between 1e-6 and 1e6 focal lengths.
    Sides,
    /// An aspect ratio that is not between 1e-6 and 1e6.
    AspectRatio,
    /// A shift of more than 1000 heights of the view rectangle.
    Shift,
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
        })
    }
}

impl std::error::Error for CameraError {}

/// The vertical field of view where none is given, in degrees.
const DEFAULT_FOV_DEGREES: f64 = 45.0;

impl Camera {
    /// Returns the camera at `eye` that looks at `target`, with +y up and a vertical field of view of 45 degrees.
    ///
    /// ```
    /// use glam::Vec3;
    /// use termtrace::Camera;
    ///
    /// let camera = Camera::look_at(Vec3::new(0.0, 1.5, 6.0), Vec3::ZERO)?.with_fov_degrees(40.0)?;
    /// assert!((camera.rectangle().vertical_fov().to_degrees() - 40.0).abs() < 1e-4);
    ///
    /// let error = Camera::look_at(Vec3::ONE, Vec3::ONE).unwrap_err();
    /// assert_eq!(error.to_string(), "the eye and the target are the same point; the camera has no direction to look in");
    /// # Ok::<(), termtrace::CameraError>(())
    /// ```
    ///
    /// # Errors
    /// If both are one point, or a coordinate is not within ±1e9; and if the camera would look straight up or down, which
    /// takes another up vector: see [`Camera::new`].
    pub fn look_at(eye: Vec3, target: Vec3) -> Result<Self, CameraError> {
        Self::new(Pose { eye, target, up: Vec3::Y }, ViewRectangle::from_vertical_fov(radians(DEFAULT_FOV_DEGREES))?)
    }

    /// Returns the camera with another up vector, of any length from 1e-9 to 1e9.
    ///
    /// # Errors
    /// If the up vector has no such length, or lies along the view.
    pub fn with_up(self, up: Vec3) -> Result<Self, CameraError> {
        self.with_pose(Pose { up, ..self.pose })
    }

    /// Returns the camera with another vertical field of view, in degrees; its view rectangle keeps its shape.
    ///
    /// # Errors
    /// Unless the angle is between 0 and 180 degrees, both excluded.
    pub fn with_fov_degrees(self, degrees: f32) -> Result<Self, CameraError> {
        Ok(Self { rectangle: self.rectangle.with_vertical_fov(radians(degrees.into()))?, ..self })
    }

    /// The camera with that pose and view rectangle.
    ///
    /// # Errors
    /// Where the pose gives no basis: see [`CameraError`].
    pub fn new(pose: Pose, rectangle: ViewRectangle) -> Result<Self, CameraError> {
        Ok(Self { pose, basis: Basis::from_pose(&pose)?, rectangle })
    }

    /// The same intrinsic parameters from another pose.
    ///
    /// # Errors
    /// As [`Camera::new`].
    #[doc(hidden)]
    pub fn with_pose(&self, pose: Pose) -> Result<Self, CameraError> {
        Self::new(pose, self.rectangle)
    }

    /// The same pose with another view rectangle.
    #[must_use]
    #[doc(hidden)]
    pub fn with_rectangle(&self, rectangle: ViewRectangle) -> Self {
        Self { rectangle, ..*self }
    }

    /// Eye, target and up as they were given.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// u, v and w.
    #[doc(hidden)]
    pub fn basis(&self) -> Basis {
        self.basis
    }

    /// The intrinsic parameters.
    #[doc(hidden)]
    pub fn rectangle(&self) -> ViewRectangle {
        self.rectangle
    }

    /// The eye rays of a picture of that aspect ratio (width / height).
    #[doc(hidden)]
    pub fn eye_rays(&self, aspect_ratio: f32) -> EyeRays {
        let Basis { u, v, w } = self.basis;
        let (width, height, middle) = self.rectangle.fitted_to(aspect_ratio);
        let q0 = u * (middle.x - 0.5 * width) + v * (middle.y - 0.5 * height) - w;
        EyeRays { eye: self.pose.eye, q0, across: u * width, upward: v * height }
    }
}

impl Basis {
    /// The lecture's construction from two vectors, a = -(target - eye) and b = up:
    /// w = a / |a|, u = b x w / |b x w|, v = w x u.
    ///
    /// It is done in f64 and rounded once, so that a target far away, or an up nearly along the view, costs no digits.
    fn from_pose(pose: &Pose) -> Result<Self, CameraError> {
        let [eye, target, up] = [pose.eye, pose.target, pose.up].map(Vec3::as_dvec3);
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        if ![eye, target, up].into_iter().all(checks::is_near) {
            return Err(CameraError::TooFar);
        }
        let w = unit_vector(eye - target).ok_or(CameraError::EyeIsTarget)?;
        if up != DVec3::ZERO && !checks::is_long(pose.up) {
            return Err(CameraError::UpTooShort);
        }
        let up = unit_vector(up).ok_or(CameraError::UpIsZero)?;
        let across = up.cross(w);
        // The sine of the angle between up and the view. What a person wrote as parallel is off by f32's rounding.
        if across.length() < 1e-6 {
            return Err(CameraError::UpAlongView);
        }
        let u = across / across.length();
        Ok(Self { u: u.as_vec3(), v: w.cross(u).as_vec3(), w: w.as_vec3() })
    }
}

/// Unit length, or nothing for the zero vector. Scaled first: a square must neither overflow nor vanish.
fn unit_vector(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    (largest > 0.0).then(|| v / largest).map(|v| v / v.dot(v).sqrt())
}

/// Returns the angle in radians, rounded once.
pub(crate) fn radians(degrees: f64) -> f32 {
    degrees.to_radians() as f32
}

impl ViewRectangle {
    /// The most that the rectangle can be [shifted](Self::with_shift), in its heights.
    pub(crate) const MAX_SHIFT: f32 = 1e3;

    /// As wide as the picture; as high as the angle, in radians, that it takes up vertically:
    /// h = 2 f tan(alpha / 2).
    ///
    /// # Errors
    /// Unless the angle is between 0 and pi, both excluded.
    pub fn from_vertical_fov(radians: f32) -> Result<Self, CameraError> {
        let height = (2.0 * libm::tan(0.5 * f64::from(radians))) as f32;
        if radians > 0.0 && radians < std::f32::consts::PI && height > 0.0 && height.is_finite() {
            Ok(Self { width: None, height, shift: Vec2::ZERO })
        } else {
            Err(CameraError::FieldOfView)
        }
    }

    /// The lecture's f, w and h, in one unit.
    ///
    /// # Errors
    /// Unless each of them is greater than 0 and finite, and each side between 1e-6 and 1e6 focal lengths.
    #[doc(hidden)]
    pub fn from_focal_length(focal_length: f32, width: f32, height: f32) -> Result<Self, CameraError> {
        let (width, height) = (width / focal_length, height / focal_length);
        if !(focal_length > 0.0 && is_positive(width) && is_positive(height)) {
            return Err(CameraError::ViewRectangle);
        }
        if ![width, height].into_iter().all(|side| checks::is_ratio(side.into())) {
            return Err(CameraError::Sides);
        }
        Ok(Self { width: Some(width), height, shift: Vec2::ZERO })
    }

    /// The rectangle with these sides at focal length 1, in the middle.
    #[cfg(feature = "serde")]
    pub(crate) fn from_sides(width: Option<f32>, height: f32) -> Result<Self, CameraError> {
        if is_positive(height) && width.is_none_or(is_positive) {
            Ok(Self { width, height, shift: Vec2::ZERO })
        } else {
            Err(CameraError::ViewRectangle)
        }
    }

    /// The rectangle of the same shape and shift that takes up that angle, in radians, vertically.
    ///
    /// # Errors
    /// As [`ViewRectangle::from_vertical_fov`].
    #[doc(hidden)]
    pub fn with_vertical_fov(self, radians: f32) -> Result<Self, CameraError> {
        let Self { height, .. } = Self::from_vertical_fov(radians)?;
        Ok(Self { height, width: self.width.map(|width| width * (height / self.height)), ..self })
    }

    /// The rectangle of the same shape and shift with sides that many times as long.
    ///
    /// # Errors
    /// Unless both sides stay greater than 0 and finite, and the vertical field of view below 180 degrees.
    #[doc(hidden)]
    pub fn scaled(self, factor: f32) -> Result<Self, CameraError> {
        let (width, height) = (self.width.map(|width| width * factor), self.height * factor);
        if !(is_positive(height) && width.is_none_or(is_positive)) {
            return Err(CameraError::ViewRectangle);
        }
        let scaled = Self { width, height, ..self };
        if scaled.vertical_fov() < std::f32::consts::PI { Ok(scaled) } else { Err(CameraError::FieldOfView) }
    }

    /// The rectangle of the same height with that aspect ratio (width / height) of its own.
    ///
    /// # Errors
    /// Unless the aspect ratio is between 1e-6 and 1e6.
    #[doc(hidden)]
    pub fn with_aspect_ratio(self, aspect_ratio: f32) -> Result<Self, CameraError> {
        if !checks::is_ratio(aspect_ratio.into()) {
            return Err(CameraError::AspectRatio);
        }
        let width = self.height * aspect_ratio;
        if is_positive(width) { Ok(Self { width: Some(width), ..self }) } else { Err(CameraError::ViewRectangle) }
    }

    /// The rectangle off centre: its middle to the right of and above the w axis, in heights of the rectangle.
    ///
    /// # Errors
    /// Unless the shift is finite, and at most 1000 heights either way.
    #[doc(hidden)]
    pub fn with_shift(self, shift: Vec2) -> Result<Self, CameraError> {
        if !shift.is_finite() {
            return Err(CameraError::NotFinite);
        }
        let is_far = shift.abs().max_element() > Self::MAX_SHIFT;
        if is_far { Err(CameraError::Shift) } else { Ok(Self { shift, ..self }) }
    }

    /// The angle that the rectangle takes up vertically when it is not shifted, in radians.
    #[doc(hidden)]
    pub fn vertical_fov(&self) -> f32 {
        2.0 * libm::atanf(0.5 * self.height)
    }

    /// Width over focal length, where the rectangle has a width of its own.
    #[doc(hidden)]
    pub fn width(&self) -> Option<f32> {
        self.width
    }

    /// Height over focal length.
    #[doc(hidden)]
    pub fn height(&self) -> f32 {
        self.height
    }

    /// The rectangle's own aspect ratio, where it has one.
    #[doc(hidden)]
    pub fn aspect_ratio(&self) -> Option<f32> {
        self.width.map(|width| width / self.height)
    }

    /// The middle of the rectangle off the w axis, in heights of the rectangle.
    #[doc(hidden)]
    pub fn shift(&self) -> Vec2 {
        self.shift
    }

    /// Width, height and middle for a picture of another shape. The whole rectangle stays in view and nothing is
    /// stretched: it grows about its middle, to the sides in a wider picture, up and down in a narrower one.
    pub(crate) fn fitted_to(&self, aspect_ratio: f32) -> (f32, f32, Vec2) {
        let (width, height) = match self.width {
            Some(width) if width > self.height * aspect_ratio => (width, width / aspect_ratio),
            _ => (self.height * aspect_ratio, self.height),
        };
        (width, height, self.shift * self.height)
    }
}

fn is_positive(x: f32) -> bool {
    x > 0.0 && x.is_finite()
}

/// The rays from the eye through a picture's points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeRays {
    eye: Vec3,
    /// From the eye to the lower left corner of the view rectangle, on the plane at distance 1. (The lecture's q0 is
    /// eye + this; the difference is what is kept, so that an eye far from the origin costs no digits.)
    q0: Vec3,
    /// The bottom edge: w * u of the lecture.
    across: Vec3,
    /// The left edge: h * v of the lecture.
    upward: Vec3,
}

impl EyeRays {
    /// The ray through the point (qu, qv) of the unit square, (0, 0) being the picture's lower left corner:
    /// q = q0 + w qu u + h qv v. Its direction is q - eye, whose part along -w is 1: t is the depth.
    pub fn through(&self, qu: f32, qv: f32) -> Ray {
        Ray { origin: self.eye, direction: self.direction(qu, qv).into() }
    }

    /// The direction of the ray [`through`](Self::through) a point, or of several.
    #[inline(always)]
    pub fn direction<N: Number>(&self, qu: N, qv: N) -> Vector<N> {
        Vector::splat(self.q0) + Vector::splat(self.across) * qu + Vector::splat(self.upward) * qv
    }

    /// Where all of them begin.
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// By how much the direction changes from a pixel to the next one across and the next one upward, in a picture of so
    /// many.
    pub fn steps(&self, width: u32, height: u32) -> [Vec3; 2] {
        [self.across / width as f32, self.upward / height as f32]
    }
}
