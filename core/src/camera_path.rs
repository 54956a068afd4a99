//! Camera paths: an orbit around the target, or an interpolation of keyframes.
//!
//! A path is a pure function of time in seconds, computed in f64 and rounded once. [`CameraPath::load`] reads files of
//! keyframes.

use crate::camera::{Camera, CameraError, Pose};
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;
use std::fmt;
use std::ops::{Add, Mul, Sub};

/// A camera as a function of time.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath(PathKind);

#[derive(Clone, Debug, PartialEq)]
enum PathKind {
    Orbit {
        camera: Camera,
        seconds: f64,
    },
    /// At least one keyframe, with increasing times.
    Keyframes(Vec<Keyframe>),
}

/// The camera of a path at a given time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// The time in seconds from the film's start.
    pub time: f64,
    /// The camera at that time.
    pub camera: Camera,
}

/// The error of a path with an invalid camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathError {
    /// The time of the first invalid camera, in seconds.
    pub time: f64,
    /// The error of the first invalid camera.
    pub error: CameraError,
}

impl fmt::Display for PathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, error } = self;
        write!(f, "at {} seconds: {error}", (time * 1000.0).round() / 1000.0)
    }
}

impl std::error::Error for PathError {}

impl CameraPath {
    /// Returns a path from `camera` once around its target in `seconds`.
    ///
    /// The eye first moves to the right, and circles the axis through the target along the up vector at constant
    /// height. `seconds` must be greater than 0.
    ///
    /// ```
    /// use termtrace::{CameraPath, Scene};
    ///
    /// let scene = Scene::from_ron("x.ron", "(camera: (eye: (0, 1, 5), target: (0, 0, 0)))")?;
    /// let path = CameraPath::orbit(*scene.camera(), 8.0);
    /// let quarter = path.camera_at(2.0)?.pose().eye;
    /// assert!(quarter.abs_diff_eq(glam::Vec3::new(5.0, 1.0, 0.0), 1e-6));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn orbit(camera: Camera, seconds: f64) -> Self {
        Self(PathKind::Orbit { camera, seconds })
    }

    /// Returns a smooth path through keyframes.
    ///
    /// Returns `None` if there are none, or their times do not increase.
    ///
    /// Before the first and after the last keyframe the camera does not move.
    ///
    /// Between two keyframes eye, target and up follow cubic Hermite curves. The velocity at a keyframe is the
    /// difference of its neighbours divided by that of their times (Catmull and Rom, "A class of local interpolating
    /// splines", 1974). A value that is equal in two consecutive keyframes stays exactly equal between them. The
    /// logarithm of the view rectangle's height follows the same kind of curve. The rectangle's aspect ratio, shift and
    /// tilt are those of the last keyframe before.
    // Dividing by the times makes velocities continuous also for uneven times, and bounds the overshoot by the
    // distances between keyframes. The logarithm makes zooming even, and keeps every angle in range.
    #[doc(hidden)]
    pub fn through(keyframes: Vec<Keyframe>) -> Option<Self> {
        let rise = keyframes.windows(2).all(|pair| pair[0].time < pair[1].time);
        (rise && !keyframes.is_empty()).then_some(Self(PathKind::Keyframes(keyframes)))
    }

    /// Returns the duration in seconds: that of one turn, or the time of the last keyframe.
    #[doc(hidden)]
    pub fn seconds(&self) -> f64 {
        match &self.0 {
            PathKind::Orbit { seconds, .. } => *seconds,
            PathKind::Keyframes(keyframes) => keyframes.last().map_or(0.0, |last| last.time),
        }
    }

    /// Returns the camera at a time in seconds.
    ///
    /// # Errors
    /// If the camera is invalid at that time, for example because the eye passes through the target.
    pub fn camera_at(&self, time: f64) -> Result<Camera, CameraError> {
        match &self.0 {
            PathKind::Orbit { camera, seconds } => turned(camera, TAU * (time / seconds)),
            PathKind::Keyframes(keyframes) => interpolate(keyframes, time),
        }
    }

    /// Returns the cameras of a film: that of frame k is at `k / frames_per_second` seconds.
    ///
    /// # Errors
    /// If a camera is invalid. The error has the first such time.
    #[doc(hidden)]
    pub fn cameras(&self, frames: usize, frames_per_second: u32) -> Result<Vec<Camera>, PathError> {
        let camera = |frame: usize| {
            let time = frame as f64 / f64::from(frames_per_second);
            self.camera_at(time).map_err(|error| PathError { time, error })
        };
        (0..frames).map(camera).collect()
    }
}

/// Returns the camera with its eye turned about the target and the up vector by an angle in
/// radians.
// The formula adds the change of position to the eye, so that an angle of 0 leaves the bits of the eye unchanged.
fn turned(camera: &Camera, angle: f64) -> Result<Camera, CameraError> {
    let pose = camera.pose();
    let [eye, target, up] = [pose.eye, pose.target, pose.up].map(Vec3::as_dvec3);
    let axis = up.normalize();
    let from_target = eye - target;
    let radius = from_target - axis * axis.dot(from_target);
    let (sin, cos) = libm::sincos(angle);
    let eye = eye + radius * (cos - 1.0) + axis.cross(radius) * sin;
    camera.with_pose(Pose { eye: eye.as_vec3(), ..pose })
}

/// Returns the camera at a time on the curves through the keyframes.
fn interpolate(keyframes: &[Keyframe], time: f64) -> Result<Camera, CameraError> {
    let passed = keyframes.partition_point(|keyframe| keyframe.time <= time);
    let before = &keyframes[passed.saturating_sub(1)];
    if passed == 0 || passed == keyframes.len() || before.time == time {
        return Ok(before.camera);
    }
    let interval = KeyframeInterval { keyframes, before: passed - 1, time };
    let pose = Pose {
        eye: interval.interpolated(|camera| camera.pose().eye.as_dvec3()).as_vec3(),
        target: interval.interpolated(|camera| camera.pose().target.as_dvec3()).as_vec3(),
        // Normalized first, because only the direction of an up vector matters: a long vector must not outweigh a short
        // one.
        up: interval.interpolated(|camera| camera.pose().up.as_dvec3().normalize()).as_vec3(),
    };
    let log_height = |camera: &Camera| libm::log(f64::from(camera.rectangle().height()));
    let zoom = libm::exp(interval.interpolated(log_height) - log_height(&before.camera));
    Camera::new(pose, before.camera.rectangle().scaled(zoom as f32)?)
}

/// A time between two keyframes.
struct KeyframeInterval<'a> {
    keyframes: &'a [Keyframe],
    /// The index of the last keyframe before `time`.
    before: usize,
    time: f64,
}

impl KeyframeInterval<'_> {
    /// Returns the value of a `quantity` of the camera, on its cubic Hermite curve between both
    /// keyframes.
    fn interpolated<T: Interpolated>(&self, quantity: impl Fn(&Camera) -> T) -> T {
        let (start, end) = (self.before, self.before + 1);
        let seconds = self.keyframes[end].time - self.keyframes[start].time;
        let t = (self.time - self.keyframes[start].time) / seconds;
        let [from, to] = [start, end].map(|at| quantity(&self.keyframes[at].camera));
        let [leaving, arriving] = [start, end].map(|at| self.velocity(at, &quantity) * seconds);
        let back = 1.0 - t;
        // In this form all terms but the first are exactly 0 if nothing changes, so a resting camera keeps its bits.
        from + (to - from) * (t * t * (1.0 + 2.0 * back)) + leaving * (t * back * back) - arriving * (t * t * back)
    }

    /// Returns the velocity of a quantity at a keyframe: the mean velocity from the keyframe before
    /// to the one after.
    ///
    /// At the ends of the path the keyframe itself replaces the missing one. The velocity is zero if a neighbouring
    /// keyframe has the same value.
    // A value that is equal in two keyframes must not change between them; a velocity other than zero would make it
    // overshoot.
    fn velocity<T: Interpolated>(&self, keyframe: usize, quantity: impl Fn(&Camera) -> T) -> T {
        let value = |index: usize| quantity(&self.keyframes[index].camera);
        let (before, after) = (keyframe.saturating_sub(1), (keyframe + 1).min(self.keyframes.len() - 1));
        let rests = [before, after].into_iter().any(|other| other != keyframe && value(other) == value(keyframe));
        let way = value(after) - value(before);
        let rate = if rests { 0.0 } else { 1.0 / (self.keyframes[after].time - self.keyframes[before].time) };
        way * rate
    }
}

/// A quantity that a curve interpolates.
trait Interpolated: Copy + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {}

impl Interpolated for f64 {}

impl Interpolated for DVec3 {}

#[cfg(all(test, unit_tests))]
mod tests;
