//! A directional light for tests, which shows that a new light takes one file and one line in the
//! table `lights`.

use super::LightSource;
use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::ray::Interval;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenVector};
use glam::Vec3;

/// White directional light with the same irradiance everywhere.
///
/// A white surface that faces it has the radiance 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The direction to the light. Unit length.
    pub direction: Vec3,
}

impl LightSource for Sun {
    /// An object blocks the light at any distance.
    const BLOCKING_INTERVAL: Interval = Interval { min: f32::MIN_POSITIVE, max: f32::INFINITY };

    #[inline(always)]
    fn to_light<N: Number>(&self, _: Vector<N>) -> Vector<N> {
        Vector::splat(self.direction)
    }

    #[inline(always)]
    fn irradiance_over_pi<N: Number>(&self, _: Vector<N>, _: N, cosine: N) -> [N; 3] {
        [cosine; 3]
    }

    fn color(&self) -> LinearRgb {
        LinearRgb::grey(1.0)
    }

    fn check(&written: &Option<WrittenVector>, validator: &mut Validator<'_>) -> Option<Self> {
        Some(Self { direction: validator.unit_vector("direction", written?)?.as_vec3() })
    }
}

impl InSceneFile for Sun {
    /// The written direction.
    type Written = Option<WrittenVector>;

    const NAME: &'static str = "Sun";
    const OWNER: &'static str = "a Sun";
    const FORM: &'static str = "Sun(direction: ...)";
    const FIELDS: &'static [&'static str] = &["direction"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> Option<WrittenVector> {
        reader.required(fields, "direction", NodeReader::direction)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
