//! Serialization of plain values by serde; deserialization checks their invariants.

use crate::camera::{Camera, CameraError, Pose, ViewRectangle};
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::{Resolution, ResolutionError};
use crate::maps::Map;
use crate::render::Sampling;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::convert::Infallible;
use std::num::NonZeroU32;

/// Implements `Serialize` and `Deserialize` for `$Type` by conversion to `$Form`, a type with the
/// structure of the format, and a checked conversion back.
// The impls are not derived, because derived ones would bypass the constructors' checks and make private fields a part
// of the format.
macro_rules! serialize_as {
    ($($Type:ty as $Form:ty: $to:expr, $from:expr;)*) => {
        $(impl Serialize for $Type {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let to: fn(&$Type) -> $Form = $to;
                to(self).serialize(serializer)
            }
        }

        impl<'de> Deserialize<'de> for $Type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let form = <$Form>::deserialize(deserializer)?;
                ($from)(form).map_err(D::Error::custom)
            }
        })*
    };
}

serialize_as! {
    LinearRgb as [f32; 3]: |light| [light.r, light.g, light.b], |channels| Ok::<_, Infallible>(Self::from(channels));
    Srgb8 as [u8; 3]: |color| [color.r, color.g, color.b], |channels| Ok::<_, Infallible>(Self::from(channels));
    // A map is stored by its name, not its number, so that new maps do not change the meaning of old files.
    Map as String: |map| map.name().to_owned(), |name: String| name.parse::<Self>();
    Sampling as SamplingForm: |&sampling| sampling.into(), |form: SamplingForm| Ok::<_, Infallible>(form.into());
    Pose as PoseForm: |&Pose { eye, target, up }| PoseForm { eye: eye.into(), target: target.into(), up: up.into() },
        |PoseForm { eye, target, up }| {
            Ok::<_, Infallible>(Self { eye: eye.into(), target: target.into(), up: up.into() })
        };
    ViewRectangle as RectangleForm: RectangleForm::of, RectangleForm::checked;
    Camera as CameraForm: |camera| CameraForm { pose: camera.pose(), rectangle: camera.rectangle() },
        |CameraForm { pose, rectangle }| Self::new(pose, rectangle);
    Resolution as ResolutionForm: ResolutionForm::of, ResolutionForm::checked;
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SamplingForm {
    Coarse,
    Split,
    Each(NonZeroU32),
    UpTo(NonZeroU32),
}

impl From<Sampling> for SamplingForm {
    fn from(sampling: Sampling) -> Self {
        match sampling {
            Sampling::Coarse => Self::Coarse,
            Sampling::Split => Self::Split,
            Sampling::Each(samples) => Self::Each(samples),
            Sampling::UpTo(samples) => Self::UpTo(samples),
        }
    }
}

impl From<SamplingForm> for Sampling {
    fn from(form: SamplingForm) -> Self {
        match form {
            SamplingForm::Coarse => Self::Coarse,
            SamplingForm::Split => Self::Split,
            SamplingForm::Each(samples) => Self::Each(samples),
            SamplingForm::UpTo(samples) => Self::UpTo(samples),
        }
    }
}

#[derive(Serialize, Deserialize)]
struct PoseForm {
    eye: [f32; 3],
    target: [f32; 3],
    up: [f32; 3],
}

#[derive(Serialize, Deserialize)]
struct RectangleForm {
    // `None` for a rectangle as wide as the picture.
    width: Option<f32>,
    height: f32,
    shift: [f32; 2],
    // Files of older versions have no `tilt`.
    #[serde(default)]
    tilt: [f32; 2],
}

impl RectangleForm {
    fn of(rectangle: &ViewRectangle) -> Self {
        let (shift, tilt) = (rectangle.shift().into(), rectangle.tilt().into());
        Self { width: rectangle.width(), height: rectangle.height(), shift, tilt }
    }

    fn checked(self) -> Result<ViewRectangle, CameraError> {
        ViewRectangle::from_sides(self.width, self.height)?.with_shift(self.shift.into())?.with_tilt(self.tilt.into())
    }
}

#[derive(Serialize, Deserialize)]
struct CameraForm {
    pose: Pose,
    rectangle: ViewRectangle,
}

#[derive(Serialize, Deserialize)]
struct ResolutionForm {
    width: u32,
    height: u32,
    pixel_aspect: f32,
}

impl ResolutionForm {
    fn of(resolution: &Resolution) -> Self {
        Self { width: resolution.width(), height: resolution.height(), pixel_aspect: resolution.pixel_aspect() }
    }

    fn checked(self) -> Result<Resolution, ResolutionError> {
        Resolution::new(self.width, self.height)?.with_pixel_aspect(self.pixel_aspect)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
