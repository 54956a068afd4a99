//! Checking of cameras: converts degrees to radians, and reports poses without a basis u, v, w.

use crate::camera::{Camera, CameraError, DEFAULT_FOV_DEGREES, Pose, ViewRectangle, radians};
use crate::checks;
use crate::scene_file::{WrittenCamera, WrittenLens};
use crate::scene_text::Span;
use crate::written::{Spanned, Validator, WrittenNumber, WrittenVector};
use glam::{Vec2, Vec3};

impl Validator<'_> {
    pub(super) fn camera(&mut self, written: &WrittenCamera) -> Option<Camera> {
        let rectangle = self.rectangle_of(written);
        self.camera_with(written, (Vec3::Y, "its up vector (0, 1, 0)"), rectangle)
    }

    /// Checks a view.
    ///
    /// If the view gives no up vector, it takes that of the scene's camera; if it gives no intrinsic parameter at all,
    /// it takes all of them from the scene's camera.
    ///
    /// If the camera has a fault and is `None`, the view is still checked.
    pub(super) fn view(&mut self, written: &WrittenCamera, camera: Option<&Camera>) -> Option<Camera> {
        let rectangle = match camera {
            Some(camera) if written.has_no_intrinsics() => Some(camera.rectangle()),
            _ => self.rectangle_of(written),
        };
        let up = camera.map_or(Vec3::Y, |camera| camera.pose().up);
        self.camera_with(written, (up, "the camera's up vector"), rectangle)
    }

    /// Checks a camera with the given view rectangle.
    ///
    /// `up_if_none` is the up vector to use if the file has none, and `name` is what messages call it.
    fn camera_with(
        &mut self,
        written: &WrittenCamera,
        (up_if_none, name): (Vec3, &'static str),
        rectangle: Option<ViewRectangle>,
    ) -> Option<Camera> {
        let eye = written.eye.and_then(|eye| self.point(eye));
        let target = written.target.and_then(|target| self.point(target));
        let up = match written.up {
            Some(up) => self.up_vector(up),
            None => Some(up_if_none),
        };
        let pose = Pose { eye: eye?, target: target?, up: up? };
        let spans = PoseSpans {
            whole: written.span,
            target: written.target.map(|target| target.span),
            up: written.up.map(|up| up.span),
            up_if_none: name,
        };
        // If the lens has a fault, the pose is checked with a default lens, so that faults of the pose are reported as
        // well.
        let any = || ViewRectangle::from_vertical_fov(1.0).ok();
        let camera = self.camera_of(pose, rectangle.or_else(any)?, spans)?;
        rectangle.and(Some(camera))
    }

    fn rectangle_of(&mut self, written: &WrittenCamera) -> Option<ViewRectangle> {
        let rectangle = self.view_rectangle(&written.lens);
        let shift = match &written.shift {
            Some(shift) => self.shift(shift),
            None => Some(Vec2::ZERO),
        };
        let rectangle = rectangle.and_then(|rectangle| rectangle.with_shift(shift?).ok());
        match &written.tilt {
            Some(tilt) => self.tilted(rectangle, tilt),
            None => rectangle,
        }
    }

    /// Returns the rectangle with a written tilt, in degrees.
    ///
    /// If the rectangle has a fault and is `None`, the tilt is still checked.
    fn tilted(&mut self, rectangle: Option<ViewRectangle>, written: &[WrittenNumber; 2]) -> Option<ViewRectangle> {
        let too_steep = |angle: &&WrittenNumber| angle.value.abs() > f64::from(ViewRectangle::MAX_TILT_DEGREES);
        if let Some(angle) = written.iter().find(too_steep) {
            return self.camera_fault(angle.span, CameraError::Tilt);
        }
        let [right, up] = written.map(|angle| radians(angle.value));
        match rectangle?.with_tilt(Vec2::new(right, up)) {
            Ok(tilted) => Some(tilted),
            // The fault is reported at the larger of both angles, which turns an edge of the rectangle farther back.
            Err(error) => self.camera_fault(written[usize::from(up.abs() >= right.abs())].span, error),
        }
    }

    /// Returns the camera with a pose, or reports a fault at the part of the pose that is wrong.
    pub(super) fn camera_of(&mut self, pose: Pose, rectangle: ViewRectangle, spans: PoseSpans) -> Option<Camera> {
        let error = match Camera::new(pose, rectangle) {
            Ok(camera) => return Some(camera),
            Err(error) => error,
        };
        let span = match error {
            // Without an up vector in the file, the fault is reported at the target, because the default up vector is
            // along the view.
            CameraError::UpIsZero | CameraError::UpAlongView => spans.up.or(spans.target),
            _ => spans.target,
        };
        self.fault(span.unwrap_or(spans.whole), || match error {
            CameraError::UpAlongView if spans.up.is_none() => {
                format!("the camera looks straight up or down, along {}; give it another `up`", spans.up_if_none)
            }
            _ => error.to_string(),
        })
    }

    fn camera_fault<T>(&mut self, span: Span, error: CameraError) -> Option<T> {
        self.fault(span, || error.to_string())
    }

    pub(super) fn up_vector(&mut self, written: WrittenVector) -> Option<Vec3> {
        // `unit_vector` is called only to report faults: the camera keeps the vector with its length as in the file, so
        // that it is written back unchanged.
        self.unit_vector("up vector", written)?;
        let up = self.point(written)?;
        if !checks::is_long_enough(up) {
            return self.camera_fault(written.span, CameraError::UpTooShort);
        }
        Some(up)
    }

    fn view_rectangle(&mut self, lens: &WrittenLens) -> Option<ViewRectangle> {
        match *lens {
            WrittenLens::FieldOfView { vertical_fov, aspect_ratio } => {
                let rectangle = match vertical_fov {
                    Some(degrees) => self.rectangle_from_degrees(degrees, ViewRectangle::from_vertical_fov),
                    None => ViewRectangle::from_vertical_fov(radians(DEFAULT_FOV_DEGREES)).ok(),
                };
                match aspect_ratio {
                    Some(ratio) => {
                        let checked = self.aspect_ratio(ratio);
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

    /// Checks an angle in degrees, and returns the view rectangle that `from_radians` makes of it.
    pub(super) fn rectangle_from_degrees(
        &mut self,
        written: WrittenNumber,
        from_radians: impl FnOnce(f32) -> Result<ViewRectangle, CameraError>,
    ) -> Option<ViewRectangle> {
        let Spanned { value, span } = written;
        match from_radians(radians(value)) {
            Ok(rectangle) => Some(rectangle),
            Err(error) => self.camera_fault(span, error),
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
        // Focal length, width and height are all checked before a fault ends the function, so that all faults are
        // reported.
        let (f, w, h) = (f?, w?, h?);
        for (side, written) in [(w, width), (h, height)] {
            if !checks::is_ratio_within_range(f64::from(side) / f64::from(f)) {
                return self.camera_fault(written?.span, CameraError::Sides);
            }
        }
        ViewRectangle::from_focal_length(f, w, h).ok()
    }

    fn aspect_ratio(&mut self, written: WrittenNumber) -> Option<f32> {
        let Spanned { value, span } = written;
        if value <= 0.0 {
            return self.fault(span, || "the aspect ratio must be greater than 0".to_owned());
        }
        if !checks::is_ratio_within_range(value) {
            return self.camera_fault(span, CameraError::AspectRatio);
        }
        Some(value as f32)
    }

    /// Checks a shift, in heights of the view rectangle.
    fn shift(&mut self, written: &[WrittenNumber; 2]) -> Option<Vec2> {
        let too_far = |number: &&WrittenNumber| number.value.abs() > f64::from(ViewRectangle::MAX_SHIFT);
        if let Some(number) = written.iter().find(too_far) {
            return self.camera_fault(number.span, CameraError::Shift);
        }
        let [right, up] = written.map(|number| number.value as f32);
        Some(Vec2::new(right, up))
    }
}

/// The spans at which faults of a written pose are reported: the whole pose, target and up vector.
#[derive(Clone, Copy)]
pub(super) struct PoseSpans {
    pub(super) whole: Span,
    pub(super) target: Option<Span>,
    pub(super) up: Option<Span>,
    /// The name, in messages, of the up vector that is used if the pose has none.
    pub(super) up_if_none: &'static str,
}
