//! The camera over time: once around its target, or through keyframes.
//!
//! A path is a pure function of time, in seconds, in f64 until the pose is rounded once. Files of keyframes are read
//! where scenes are: see [`CameraPath::load`].

use crate::camera::{Camera, CameraError, Pose};
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;
use std::fmt;
use std::ops::{Add, Mul, Sub};

/// Where the camera is at each time.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath(PathKind);

#[derive(Clone, Debug, PartialEq)]
enum PathKind {
    Orbit {
        camera: Camera,
        seconds: f64,
    },
    /// At least one; their times rise.
    Keyframes(Vec<Keyframe>),
}

/// A camera that the path is to pass at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// In seconds from the film's beginning.
    pub time: f64,
    /// The camera at that time.
    pub camera: Camera,
}

/// A time at which the path gives no picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathError {
    /// In seconds.
    pub time: f64,
    /// What is wrong with the camera there.
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
    /// Once around the target in that many seconds, which are greater than 0: to the right at first, about the axis
    /// through the target along up, at the same height over the target all the time. It begins with `camera` itself.
    ///
    /// ```
    /// use termtrace::{CameraPath, Scene};
    ///
    /// let scene = Scene::from_ron("x.ron", "(camera: (eye: (0, 1, 5), target: (0, 0, 0)))")?;
    /// let path = CameraPath::orbit(*scene.camera(), 8.0);
    /// let quarter = path.camera_at(2.0).unwrap().pose().eye;
    /// assert!(quarter.abs_diff_eq(glam::Vec3::new(5.0, 1.0, 0.0), 1e-6));
    /// # Ok::<(), termtrace::SceneError>(())
    /// ```
    pub fn orbit(camera: Camera, seconds: f64) -> Self {
        Self(PathKind::Orbit { camera, seconds })
    }

    /// Through all of these, smoothly, each at its time; before the first and after the last the camera stands still.
    /// `None` unless there are any and their times rise.
    ///
    /// Between two keyframes eye, target and up run along cubic Hermite curves whose velocity at a keyframe is that from
    /// the keyframe before to the one after (Catmull and Rom, "A class of local interpolating splines", 1974, with the
    /// keyframes' own times). So a film never jerks, and how far a curve swings out is bounded by the ways between the
    /// keyframes, whatever their times. A value that is the same at two neighbours stays exactly the same between them.
    /// Of the view rectangle the height runs in the same way, by its logarithm: zooming is even, and no angle is ever
    /// out of range. Its shape and its shift are those of the keyframe before.
    #[doc(hidden)]
    pub fn through(keyframes: Vec<Keyframe>) -> Option<Self> {
        let rise = keyframes.windows(2).all(|pair| pair[0].time < pair[1].time);
        (rise && !keyframes.is_empty()).then_some(Self(PathKind::Keyframes(keyframes)))
    }

    /// When the path ends: back at the first view, or at the last keyframe.
    #[doc(hidden)]
    pub fn seconds(&self) -> f64 {
        match &self.0 {
            PathKind::Orbit { seconds, .. } => *seconds,
            PathKind::Keyframes(keyframes) => keyframes.last().map_or(0.0, |last| last.time),
        }
    }

    /// The camera at that time.
    ///
    /// # Errors
    /// Where the path gives no picture, as when the eye runs through the target.
    pub fn camera_at(&self, time: f64) -> Result<Camera, CameraError> {
        match &self.0 {
            PathKind::Orbit { camera, seconds } => turned(camera, TAU * (time / seconds)),
            PathKind::Keyframes(keyframes) => interpolate(keyframes, time),
        }
    }

    /// The cameras of a film of this path: frame k is seen at `k / frames_per_second` seconds.
    ///
    /// # Errors
    /// The first time at which there is no picture.
    #[doc(hidden)]
    pub fn cameras(&self, frames: usize, frames_per_second: u32) -> Result<Vec<Camera>, PathError> {
        let camera = |frame: usize| {
            let time = frame as f64 / f64::from(frames_per_second);
            self.camera_at(time).map_err(|error| PathError { time, error })
        };
        (0..frames).map(camera).collect()
    }
}

/// The camera turned about the axis through its target along up. At angle 0 it is the same to the last bit.
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
        // Only its direction says something.
        up: interval.value(|camera| camera.pose().up.as_dvec3().normalize()).as_vec3(),
    };
    let log_height = |camera: &Camera| libm::log(f64::from(camera.rectangle().height()));
    let zoom = libm::exp(interval.value(log_height) - log_height(&before.camera));
    Camera::new(pose, before.camera.rectangle().scaled(zoom as f32)?)
}

/// A time between two keyframes.
struct KeyframeInterval<'a> {
    keyframes: &'a [Keyframe],
    /// The index of the earlier one.
    before: usize,
    time: f64,
}

impl KeyframeInterval<'_> {
    /// Something of the camera at that time: the cubic Hermite curve from its values and velocities at both keyframes.
    fn value<T: Interpolated>(&self, of: impl Fn(&Camera) -> T) -> T {
        let (start, end) = (self.before, self.before + 1);
        let seconds = self.keyframes[end].time - self.keyframes[start].time;
        let t = (self.time - self.keyframes[start].time) / seconds;
        let [from, to] = [start, end].map(|at| of(&self.keyframes[at].camera));
        let [leaving, arriving] = [start, end].map(|at| self.velocity(at, &of) * seconds);
        let back = 1.0 - t;
        // Each term but the first is 0 when nothing changes: then rounding does not change anything either.
        from + (to - from) * (t * t * (1.0 + 2.0 * back)) + leaving * (t * back * back) - arriving * (t * t * back)
    }

    /// From the keyframe before to the one after; at the ends, from or to the end itself. Nothing where one of them has
    /// the same value: what stands still between two keyframes does not swing out.
    fn velocity<T: Interpolated>(&self, at: usize, of: impl Fn(&Camera) -> T) -> T {
        let value = |at: usize| of(&self.keyframes[at].camera);
        let (before, after) = (at.saturating_sub(1), (at + 1).min(self.keyframes.len() - 1));
        let rests = [before, after].into_iter().any(|other| other != at && value(other) == value(at));
        let way = value(after) - value(before);
        let rate = if rests { 0.0 } else { 1.0 / (self.keyframes[after].time - self.keyframes[before].time) };
        way * rate
    }
}

/// What can lie on a curve.
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

    /// At any tilt: the distance to the axis and the height along it stay, and all of the circle is gone round.
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

    /// Neither the way nor the speed has a jump: the second differences of small steps are small everywhere.
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

    /// A slow way after a fast one: the speed at the keyframe between them does not throw the camera far out.
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
