//! Checking of camera paths: times increase, and every keyframe is a camera.

use super::camera::PoseSpans;
use crate::camera::{Camera, Pose};
use crate::camera_path::{CameraPath, Keyframe};
use crate::scene_file::{PathFile, WrittenKeyframe};
use crate::scene_text::Faults;
use crate::written::{Spanned, Validator, WrittenNumber};

/// The largest time in seconds: more than eleven days.
// f64 represents every time up to this limit to a nanosecond.
const MAX_SECONDS: f64 = 1e6;

/// Returns the path, or `None` after all faults have been added to `faults`.
///
/// Parameters that a keyframe does not give are those of `default_camera`.
pub(in crate::scene) fn check(file: &PathFile, default_camera: &Camera, faults: &mut Faults) -> Option<CameraPath> {
    let mut validator = Validator { faults };
    let (written, span) = file.keyframes.as_ref()?;
    let cameras: Vec<_> = written.iter().map(|keyframe| validator.keyframe(keyframe, default_camera)).collect();
    validator.check_times(written);
    if !validator.faults.is_empty() {
        return None;
    }
    let cameras: Option<Vec<Keyframe>> = cameras.into_iter().collect();
    let path = CameraPath::through(cameras?);
    path.or_else(|| validator.fault(*span, || "a camera path needs at least one keyframe".to_owned()))
}

impl Validator<'_> {
    fn keyframe(&mut self, written: &WrittenKeyframe, default_camera: &Camera) -> Option<Keyframe> {
        let time = written.time.and_then(|time| self.time(time));
        let eye = written.eye.and_then(|eye| self.point(eye));
        let target = written.target.and_then(|target| self.point(target));
        let up = match written.up {
            Some(up) => self.up_vector(up),
            None => Some(default_camera.pose().up),
        };
        let rectangle = match written.vertical_fov {
            Some(degrees) => {
                self.rectangle_from_degrees(degrees, |fov| default_camera.rectangle().with_vertical_fov(fov))
            }
            None => Some(default_camera.rectangle()),
        };
        let pose = Pose { eye: eye?, target: target?, up: up? };
        let spans = PoseSpans {
            whole: written.span,
            target: written.target.map(|target| target.span),
            up: written.up.map(|up| up.span),
            up_if_none: "the scene's up vector",
        };
        // If the angle has a fault, the pose is checked with the camera's angle, so that its faults are reported as
        // well.
        let camera = self.camera_of(pose, rectangle.unwrap_or(default_camera.rectangle()), spans)?;
        rectangle.and(Some(Keyframe { time: time?, camera }))
    }

    fn time(&mut self, written: WrittenNumber) -> Option<f64> {
        let Spanned { value, span } = written;
        if (0.0..=MAX_SECONDS).contains(&value) {
            return Some(value);
        }
        self.fault(span, || "the time must lie between 0 and 1e6 seconds".to_owned())
    }

    /// Reports each time that is not greater than that of the keyframe before.
    fn check_times(&mut self, written: &[WrittenKeyframe]) {
        let times: Vec<WrittenNumber> = written.iter().filter_map(|keyframe| keyframe.time).collect();
        for pair in times.windows(2).filter(|pair| pair[1].value <= pair[0].value) {
            self.faults.add(pair[1].span, || {
                format!("the times of keyframes must rise; the one before is at {} seconds", pair[0].value)
            });
        }
    }
}
