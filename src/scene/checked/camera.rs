//! The camera, checked: degrees become radians, and what gives no basis is turned away.

use crate::camera::{Camera, CameraError, Pose, ViewRectangle};
use crate::scene_file::{WrittenCamera, WrittenLens};
use crate::scene_text::Span;
use crate::written::{SHORTEST, Spanned, Validator, WrittenNumber, WrittenVector};
use glam::{Vec2, Vec3};

/// Of the view rectangle's sides to its focal length and each other.
const LARGEST_RATIO: f64 = 1e6;
const LARGEST_SHIFT: f64 = 1e3;

impl Validator<'_> {
    pub(super) fn camera(&mut self, written: &WrittenCamera) -> Option<Camera> {
        let rectangle = self.rectangle_of(written);
        self.camera_with(written, (Vec3::Y, "its up vector (0, 1, 0)"), rectangle)
    }

    /// Another view: what it does not say is as the camera has it. (Where that is wrong, this is checked all the same.)
    pub(super) fn view(&mut self, written: &WrittenCamera, camera: Option<&Camera>) -> Option<Camera> {
        let rectangle = match camera {
            Some(camera) if written.is_without_lens() => Some(camera.rectangle()),
            _ => self.rectangle_of(written),
        };
        let up = camera.map_or(Vec3::Y, |camera| camera.pose().up);
        self.camera_with(written, (up, "the camera's up vector"), rectangle)
    }

    /// With that up vector, and its name, if none was written.
    fn camera_with(
        &mut self,
        written: &WrittenCamera,
        (up_if_none, name): (Vec3, &'static str),
        rectangle: Option<ViewRectangle>,
    ) -> Option<Camera> {
        let eye = written.eye.and_then(|eye| self.point(eye));
        let target = written.target.and_then(|target| self.point(target));
        let up = match written.up {
            Some(up) => self.up(up),
            None => Some(up_if_none),
        };
        let pose = Pose { eye: eye?, target: target?, up: up? };
        let places = Places {
            whole: written.span,
            target: written.target.map(|target| target.span),
            up: written.up.map(|up| up.span),
            up_if_none: name,
        };
        // Where the lens is wrong, the pose may be wrong as well: any rectangle tells.
        let any = || ViewRectangle::from_vertical_fov(1.0).ok();
        let camera = self.camera_of(pose, rectangle.or_else(any)?, places)?;
        rectangle.and(Some(camera))
    }

    fn rectangle_of(&mut self, written: &WrittenCamera) -> Option<ViewRectangle> {
        let rectangle = self.view_rectangle(&written.lens);
        let shift = match &written.shift {
            Some(shift) => self.shift(shift),
            None => Some(Vec2::ZERO),
        };
        rectangle?.with_shift(shift?).ok()
    }

    /// The camera, or a fault where its pose was written.
    pub(super) fn camera_of(&mut self, pose: Pose, rectangle: ViewRectangle, places: Places) -> Option<Camera> {
        let error = match Camera::new(pose, rectangle) {
            Ok(camera) => return Some(camera),
            Err(error) => error,
        };
        let place = match error {
            CameraError::UpIsZero | CameraError::UpAlongView => places.up.or(places.target),
            _ => places.target,
        };
        self.fault(place.unwrap_or(places.whole), || match error {
            CameraError::UpAlongView if places.up.is_none() => {
                format!("the camera looks straight up or down, along {}; give it another `up`", places.up_if_none)
            }
            _ => error.to_string(),
        })
    }

    pub(super) fn up(&mut self, written: WrittenVector) -> Option<Vec3> {
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
                    Some(degrees) => self.rectangle_from_degrees(degrees, ViewRectangle::from_vertical_fov),
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

    /// The rectangle that is made from the angle.
    pub(super) fn rectangle_from_degrees(
        &mut self,
        written: WrittenNumber,
        from_radians: impl FnOnce(f32) -> Result<ViewRectangle, CameraError>,
    ) -> Option<ViewRectangle> {
        let Spanned { value, span } = written;
        match from_radians(radians(value)) {
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

/// Where a pose was written, to point there when it is wrong.
#[derive(Clone, Copy)]
pub(super) struct Places {
    pub(super) whole: Span,
    pub(super) target: Option<Span>,
    pub(super) up: Option<Span>,
    /// What up is where none was written.
    pub(super) up_if_none: &'static str,
}

/// Rounded once.
pub(in crate::scene) fn radians(degrees: f64) -> f32 {
    degrees.to_radians() as f32
}
