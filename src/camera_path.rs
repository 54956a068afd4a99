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
    /// The error of that camera.
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
    /// The eye starts to the right and turns about the axis through the target along the up vector, at constant height.
    /// `seconds` must be greater than 0.
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
    /// Before the first and after the last keyframe the camera rests.
    ///
    /// Between two keyframes eye, target and up follow cubic Hermite curves. The velocity at a keyframe is the
    /// difference of its neighbours divided by that of their times (Catmull and Rom, "A class of local interpolating
    /// splines", 1974). A value that is equal in two consecutive keyframes stays exactly equal between them. The
    /// logarithm of the view rectangle's height follows the same kind of curve. Its aspect ratio and shift are those of
    /// the keyframe before.
    // With the keyframes' own times, velocities are continuous, and overshoot is bounded by the distances between
    // keyframes whatever their times. The logarithm makes zooming even, and keeps every angle in range.
    #[doc(hidden)]
    pub fn through(keyframes: Vec<Keyframe>) -> Option<Self> {
        let rise = keyframes.windows(2).all(|pair| pair[0].time < pair[1].time);
        (rise && !keyframes.is_empty()).then_some(Self(PathKind::Keyframes(keyframes)))
    }

    /// Returns the duration in seconds: of one turn, or up to the last keyframe.
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
    /// With the first time at which the camera is invalid.
    #[doc(hidden)]
    pub fn cameras(&self, frames: usize, frames_per_second: u32) -> Result<Vec<Camera>, PathError> {
        let camera = |frame: usize| {
            let time = frame as f64 / f64::from(frames_per_second);
            self.camera_at(time).map_err(|error| PathError { time, error })
        };
        (0..frames).map(camera).collect()
    }
}

/// Returns the camera turned about its target and up vector by an angle in radians.
// Written as a difference from the eye, so that angle 0 gives the same bits.
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

/// Returns the camera of the keyframes' curves at a time.
fn interpolate(keyframes: &[Keyframe], time: f64) -> Result<Camera, CameraError> {
    let passed = keyframes.partition_point(|keyframe| keyframe.time <= time);
    let before = &keyframes[passed.saturating_sub(1)];
    if passed == 0 || passed == keyframes.len() || before.time == time {
        return Ok(before.camera);
    }
    let interval = KeyframeInterval { keyframes, before: passed - 1, time };
    let pose = Pose {
        eye: interval.value(|camera| camera.pose().eye.as_dvec3()).as_vec3(),
        target: interval.value(|camera| camera.pose().target.as_dvec3()).as_vec3(),
        // Normalized first, because only the direction of an up vector matters: a long one must not outweigh the other.
        up: interval.value(|camera| camera.pose().up.as_dvec3().normalize()).as_vec3(),
    };
    let log_height = |camera: &Camera| libm::log(f64::from(camera.rectangle().height()));
    let zoom = libm::exp(interval.value(log_height) - log_height(&before.camera));
    Camera::new(pose, before.camera.rectangle().scaled(zoom as f32)?)
}

/// A time between two keyframes.
struct KeyframeInterval<'a> {
    keyframes: &'a [Keyframe],
    /// The index of the keyframe before the time.
    before: usize,
    time: f64,
}

impl KeyframeInterval<'_> {
    /// Returns a quantity of the camera by its cubic Hermite curve between both keyframes.
    fn value<T: Interpolated>(&self, of: impl Fn(&Camera) -> T) -> T {
        let (start, end) = (self.before, self.before + 1);
        let seconds = self.keyframes[end].time - self.keyframes[start].time;
        let t = (self.time - self.keyframes[start].time) / seconds;
        let [from, to] = [start, end].map(|at| of(&self.keyframes[at].camera));
        let [leaving, arriving] = [start, end].map(|at| self.velocity(at, &of) * seconds);
        let back = 1.0 - t;
        // In this form each term but the first is exactly 0 if nothing changes, so a resting camera keeps its bits.
        from + (to - from) * (t * t * (1.0 + 2.0 * back)) + leaving * (t * back * back) - arriving * (t * t * back)
    }

    /// Returns the velocity of a quantity at a keyframe: from the keyframe before to the one after.
    ///
    /// Zero if one of them has the same value as this one. At either end the keyframe itself takes the missing place.
    // The zero keeps a value that rests between two keyframes from overshooting.
    fn velocity<T: Interpolated>(&self, at: usize, of: impl Fn(&Camera) -> T) -> T {
        let value = |at: usize| of(&self.keyframes[at].camera);
        let (before, after) = (at.saturating_sub(1), (at + 1).min(self.keyframes.len() - 1));
        let rests = [before, after].into_iter().any(|other| other != at && value(other) == value(at));
        let way = value(after) - value(before);
        let rate = if rests { 0.0 } else { 1.0 / (self.keyframes[after].time - self.keyframes[before].time) };
        way * rate
    }
}

/// A quantity that a curve interpolates.
trait Interpolated: Copy + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {}

impl Interpolated for f64 {}

impl Interpolated for DVec3 {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::ViewRectangle;

    fn camera(eye: [f32; 3], target: [f32; 3], fov: f32) -> Camera {
        let pose = Pose { eye: eye.into(), target: target.into(), up: Vec3::new(0.1, 2.0, -0.3) };
        Camera::new(pose, ViewRectangle::from_vertical_fov(fov).unwrap()).unwrap()
    }

    fn keyframe(time: f64, eye: [f32; 3]) -> Keyframe {
        Keyframe { time, camera: camera(eye, [0.0; 3], 0.7) }
    }

    fn eye(path: &CameraPath, time: f64) -> Vec3 {
        path.camera_at(time).unwrap().pose().eye
    }

    /// Distance to the axis and height along it are constant over the whole circle, at a tilt.
    #[test]
    fn an_orbit_keeps_its_height_and_its_radius() {
        let tilted =
            Pose { eye: Vec3::new(1.0, 2.0, 6.3), target: Vec3::new(0.5, 0.7, -0.2), up: Vec3::new(0.3, 2.0, -0.4) };
        let first = camera([0.0, 0.0, 1.0], [0.0; 3], 0.7).with_pose(tilted).unwrap();
        let path = CameraPath::orbit(first, 8.0);
        assert_eq!(path.camera_at(0.0), Ok(first), "to the last bit");
        let axis = tilted.up.normalize();
        let measure = |eye: Vec3| {
            let height = axis.dot(eye - tilted.target);
            (height, (eye - tilted.target - axis * height).length())
        };
        let (height, radius) = measure(tilted.eye);
        let cameras = path.cameras(80, 10).unwrap();
        assert_eq!(cameras.len(), 80);
        let mut angle = 0.0;
        for pair in cameras.windows(2) {
            let (now_height, now_radius) = measure(pair[1].pose().eye);
            assert!((now_height - height).abs() < 1e-5 && (now_radius - radius).abs() < 1e-5);
            assert_eq!((pair[1].pose().target, pair[1].pose().up), (tilted.target, tilted.up));
            let [before, now] = [pair[0], pair[1]].map(|camera| camera.pose().eye - tilted.target);
            let sine = axis.dot(before.cross(now)) / (radius * radius);
            assert!(sine > 0.0, "to the right");
            angle += libm::asinf(sine);
        }
        assert!(
            (angle - std::f32::consts::TAU * 79.0 / 80.0).abs() < 1e-3,
            "all round but for the first frame: {angle}"
        );
        assert!(eye(&path, 8.0).abs_diff_eq(tilted.eye, 1e-5), "the circle is closed");
    }

    #[test]
    fn keyframes_are_passed_at_their_times_to_the_last_bit() {
        let keyframes = vec![
            Keyframe { time: 0.5, camera: camera([0.1, 0.7, 6.3], [0.3, 0.0, 0.0], 0.7) },
            Keyframe { time: 1.75, camera: camera([4.1, 0.2, 3.3], [0.0, 0.9, 0.0], 2.9) },
            Keyframe { time: 4.0, camera: camera([-4.1, 3.2, 3.3], [0.0, 0.0, 0.1], 0.01) },
        ];
        let path = CameraPath::through(keyframes.clone()).unwrap();
        for Keyframe { time, camera } in &keyframes {
            assert_eq!(path.camera_at(*time), Ok(*camera));
        }
        assert_eq!(path.camera_at(-1.0), Ok(keyframes[0].camera), "it stands still before");
        assert_eq!(path.camera_at(99.0), Ok(keyframes[2].camera), "and after");
        assert_eq!(path.camera_at(f64::NAN), Ok(keyframes[0].camera));
        assert_eq!(path.seconds(), 4.0);
    }

    /// Position and velocity have no jump: second differences of small steps are small.
    #[test]
    fn a_path_is_smooth() {
        let path = CameraPath::through(vec![
            keyframe(0.0, [0.0, 1.0, 6.0]),
            keyframe(1.0, [5.0, 2.0, 4.0]),
            keyframe(1.5, [6.0, 0.0, 1.0]),
            keyframe(4.0, [2.0, 3.0, -5.0]),
        ])
        .unwrap();
        let step = 1.0 / 128.0;
        let eyes: Vec<DVec3> = (0..=512).map(|i| eye(&path, f64::from(i) * step).as_dvec3()).collect();
        for (i, three) in eyes.windows(3).enumerate() {
            let bend = (three[2] - three[1] - (three[1] - three[0])).length();
            assert!(bend < 0.01, "{bend} after {i} steps");
        }
    }

    /// Target and up run as the eye does.
    #[test]
    fn all_of_the_pose_moves() {
        let [from, to] = [camera([0.0, 0.0, 8.0], [0.0; 3], 0.7), camera([2.0, 0.0, 8.0], [0.0, 4.0, 0.0], 0.7)];
        let to = to.with_pose(Pose { up: Vec3::X, ..to.pose() }).unwrap();
        let keyframes = vec![Keyframe { time: 0.0, camera: from }, Keyframe { time: 4.0, camera: to }];
        let pose = CameraPath::through(keyframes).unwrap().camera_at(1.0).unwrap().pose();
        assert!(pose.eye.abs_diff_eq(Vec3::new(0.5, 0.0, 8.0), 1e-6), "{pose:?}");
        assert!(pose.target.abs_diff_eq(Vec3::new(0.0, 1.0, 0.0), 1e-6), "{pose:?}");
        let up = 0.75 * from.pose().up.normalize() + 0.25 * Vec3::X;
        assert!(pose.up.abs_diff_eq(up, 1e-6), "{pose:?}");
    }

    #[test]
    fn two_keyframes_are_a_straight_line_at_even_speed() {
        let path = CameraPath::through(vec![keyframe(1.0, [0.0, 0.0, 4.0]), keyframe(3.0, [4.0, 2.0, 4.0])]).unwrap();
        for (time, expected) in [(1.5, [1.0, 0.5, 4.0]), (2.0, [2.0, 1.0, 4.0]), (2.5, [3.0, 1.5, 4.0])] {
            assert!(eye(&path, time).abs_diff_eq(Vec3::from(expected), 1e-6), "{}", eye(&path, time));
        }
    }

    #[test]
    fn equal_keyframes_hold_the_camera_still() {
        let path = CameraPath::through(vec![
            keyframe(0.0, [0.1, 1.3, 6.7]),
            keyframe(1.0, [5.1, 2.3, 4.7]),
            keyframe(3.0, [5.1, 2.3, 4.7]),
            keyframe(4.0, [0.1, 2.3, 4.7]),
        ])
        .unwrap();
        for step in 0..=20 {
            assert_eq!(eye(&path, 1.0 + 0.1 * f64::from(step)), Vec3::new(5.1, 2.3, 4.7));
        }
        for step in 0..=40 {
            let rectangle = path.camera_at(0.1 * f64::from(step)).unwrap().rectangle();
            assert_eq!(rectangle, keyframe(0.0, [1.0; 3]).camera.rectangle(), "nothing is said of the lens");
        }
    }

    /// The velocity between a fast and a slow segment does not make the camera overshoot.
    #[test]
    fn unequal_times_do_not_throw_the_camera_out() {
        let path = CameraPath::through(vec![
            keyframe(0.0, [1.0, 0.0, 0.0]),
            keyframe(0.1, [6.0, 0.0, 0.0]),
            keyframe(5.0, [7.0, 0.0, 0.0]),
        ])
        .unwrap();
        let farthest = (0..500).map(|i| eye(&path, 0.01 * f64::from(i)).x).fold(0.0, f32::max);
        assert!(farthest < 8.0, "{farthest}");
    }

    #[test]
    fn zooming_is_even_and_stays_an_angle() {
        let lens = |time, fov| Keyframe { time, camera: camera([0.0, 0.0, 5.0], [0.0; 3], fov) };
        let path = CameraPath::through(vec![lens(0.0, 0.1), lens(2.0, 3.1)]).unwrap();
        let height = |time| path.camera_at(time).unwrap().rectangle().height();
        assert!((height(1.0) / (height(0.0) * height(2.0)).sqrt() - 1.0).abs() < 1e-5, "the geometric mean");
        let path = CameraPath::through(vec![lens(0.0, 3.1), lens(1.0, 0.001), lens(2.0, 3.1), lens(3.0, 0.5)]).unwrap();
        assert!(path.cameras(300, 100).is_ok());
    }

    #[test]
    fn an_eye_in_the_target_is_an_error_with_its_time() {
        let path = CameraPath::through(vec![keyframe(0.0, [0.0, 0.0, 4.0]), keyframe(2.0, [0.0, 0.0, -4.0])]).unwrap();
        let error = path.cameras(61, 30).unwrap_err();
        assert_eq!(error, PathError { time: 1.0, error: CameraError::EyeIsTarget });
        assert!(error.to_string().starts_with("at 1 seconds: the eye and the target are the same point"), "{error}");
    }

    #[test]
    fn times_have_to_rise() {
        let at = |time| keyframe(time, [0.0, 0.0, 4.0]);
        assert!(CameraPath::through(vec![at(0.0)]).is_some());
        for times in [&[][..], &[0.0, 0.0], &[1.0, 0.5], &[0.0, f64::NAN, 1.0]] {
            assert!(CameraPath::through(times.iter().map(|&time| at(time)).collect()).is_none(), "{times:?}");
        }
    }
}
