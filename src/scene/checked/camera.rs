//! The camera, checked: degrees become radians, and what gives no basis is turned away.

use super::{Checker, SHORTEST};
use crate::camera::{Camera, CameraError, Pose, ViewRectangle};
use crate::scene_file::{Spanned, WrittenCamera, WrittenLens, WrittenNumber, WrittenVector};
use glam::{Vec2, Vec3};

/// Of the view rectangle's sides to its focal length and each other.
const LARGEST_RATIO: f64 = 1e6;
const LARGEST_SHIFT: f64 = 1e3;

impl Checker<'_> {
    pub(super) fn camera(&mut self, written: &WrittenCamera) -> Option<Camera> {
        let eye = written.eye.and_then(|eye| self.point(eye));
        let target = written.target.and_then(|target| self.point(target));
        let up = match written.up {
            Some(up) => self.up(up),
            None => Some(Vec3::Y),
        };
        let rectangle = self.view_rectangle(&written.lens);
        let shift = match &written.shift {
            Some(shift) => self.shift(shift),
            None => Some(Vec2::ZERO),
        };
        let (eye, target, up) = (eye?, target?, up?);
        let rectangle = match rectangle {
            Some(rectangle) => rectangle,
            // Enough to find out whether the pose is one.
            None => ViewRectangle::from_vertical_fov(1.0).ok()?,
        };
        let rectangle = rectangle.with_shift(shift?).ok()?;
        match Camera::new(Pose { eye, target, up }, rectangle) {
            Ok(camera) => Some(camera),
            Err(error) => {
                let target = written.target.map(|target| target.span);
                let place = match error {
                    CameraError::UpIsZero | CameraError::UpAlongView => written.up.map(|up| up.span).or(target),
                    _ => target,
                };
                self.fault(place.unwrap_or(written.span), || pose_fault(error, written.up.is_some()))
            }
        }
    }

    fn up(&mut self, written: WrittenVector) -> Option<Vec3> {
        self.unit_vector("up vector", written)?;
        let up = self.point(written)?;
        if up.abs().max_element() < SHORTEST as f32 {
            return self.fault(written.span, || "the up vector must be longer than 1e-9".to_owned());
        }
        Some(up)
    }

    fn view_rectangle(&mut self, lens: &WrittenLens) -> Option<ViewRectangle> {
        match *lens {
            WrittenLens::FieldOfView { vertical_fov, aspect_ratio } => {
                let rectangle = match vertical_fov {
                    Some(degrees) => self.rectangle_from_degrees(degrees),
                    None => ViewRectangle::from_vertical_fov(radians(45.0)).ok(),
                };
                match aspect_ratio {
                    Some(ratio) => {
                        let checked = self.ratio("aspect ratio", ratio);
                        rectangle?.with_aspect_ratio(checked?).ok()
                    }
                    None => rectangle,
                }
            }
            WrittenLens::FocalLength { focal_length, width, height } => {
                self.rectangle_from_focal_length(focal_length, width, height)
            }
        }
    }

    fn rectangle_from_degrees(&mut self, written: WrittenNumber) -> Option<ViewRectangle> {
        let Spanned { value, span } = written;
        match ViewRectangle::from_vertical_fov(radians(value)) {
            Ok(rectangle) => Some(rectangle),
            Err(_) => self.fault(span, || {
                "the vertical field of view is an angle between 0 and 180 degrees, both excluded".to_owned()
            }),
        }
    }

    fn rectangle_from_focal_length(
        &mut self,
        focal_length: Option<WrittenNumber>,
        width: Option<WrittenNumber>,
        height: Option<WrittenNumber>,
    ) -> Option<ViewRectangle> {
        let f = focal_length.and_then(|f| self.length("focal length", f));
        let w = width.and_then(|w| self.length("width of the view rectangle", w));
        let h = height.and_then(|h| self.length("height of the view rectangle", h));
        let (f, w, h) = (f?, w?, h?);
        for (side, written) in [(w, width), (h, height)] {
            let ratio = f64::from(side) / f64::from(f);
            if !(1.0 / LARGEST_RATIO..=LARGEST_RATIO).contains(&ratio) {
                return self.fault(written?.span, || {
                    "a side of the view rectangle must lie between 1e-6 and 1e6 focal lengths".to_owned()
                });
            }
        }
        ViewRectangle::from_focal_length(f, w, h).ok()
    }

    fn ratio(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        let Spanned { value, span } = written;
        if value <= 0.0 {
            return self.fault(span, || format!("the {what} must be greater than 0"));
        }
        if !(1.0 / LARGEST_RATIO..=LARGEST_RATIO).contains(&value) {
            return self.fault(span, || format!("the {what} must lie between 1e-6 and 1e6"));
        }
        Some(value as f32)
    }

    fn shift(&mut self, written: &[WrittenNumber; 2]) -> Option<Vec2> {
        let too_far = |number: &&WrittenNumber| number.value.abs() > LARGEST_SHIFT;
        if let Some(number) = written.iter().find(too_far) {
            return self
                .fault(number.span, || "the view rectangle can be shifted by at most 1000 of its heights".to_owned());
        }
        let [right, up] = written.map(|number| number.value as f32);
        Some(Vec2::new(right, up))
    }
}

fn pose_fault(error: CameraError, up_is_given: bool) -> String {
    match error {
        CameraError::UpAlongView if !up_is_given => {
            "the camera looks straight up or down, along its up vector (0, 1, 0); give it another `up`".to_owned()
        }
        _ => error.to_string(),
    }
}

/// Rounded once.
pub(in crate::scene) fn radians(degrees: f64) -> f32 {
    degrees.to_radians() as f32
}
