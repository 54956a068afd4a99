//! Directional light, such as that of the sun.

use super::LightSource;
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::ray::Interval;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, WrittenNumber, WrittenVector};
use glam::Vec3;

/// A directional light, which has the same direction and irradiance everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The direction to the light. Unit length.
    direction: Vec3,
    /// The [intensity](Self::new), not negative.
    intensity: LinearRgb,
}

impl Sun {
    /// Returns a light at infinity; `direction` is the direction to the light, of any length but 0.
    ///
    /// `intensity` is the irradiance times 1/pi: the radiance of a white surface that faces the light.
    ///
    /// # Errors
    /// If a coordinate is not within ±1e9, the direction is 0, or a channel of the intensity is not within 0 and 1e12.
    #[doc(hidden)]
    pub fn new(direction: Vec3, intensity: LinearRgb) -> Result<Self, SceneFault> {
        let direction = checks::checked_direction("direction", direction)?;
        let intensity = checks::checked_color("intensity", intensity, checks::light)?;
        Ok(Self { direction, intensity })
    }
}

#[cfg(feature = "ron")]
impl Sun {
    /// Returns the unit vector to the light.
    pub(crate) fn direction(&self) -> Vec3 {
        self.direction
    }
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
        let LinearRgb { r, g, b } = self.intensity;
        [N::splat(r) * cosine, N::splat(g) * cosine, N::splat(b) * cosine]
    }

    fn color(&self) -> LinearRgb {
        self.intensity
    }

    fn check(written: &WrittenSun, validator: &mut Validator<'_>) -> Option<Self> {
        let direction = written.direction.and_then(|direction| validator.unit_vector("direction", direction));
        let intensity = validator.intensity(written.color, written.intensity);
        Some(Self { direction: direction?.as_vec3(), intensity: intensity? })
    }
}

/// A directional light as written: `Sun(direction: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenSun {
    /// The direction to the light.
    pub direction: Option<WrittenVector>,
    /// The colour; white if not given.
    pub color: Option<WrittenColor>,
    /// The factor of the colour; 1 if not given.
    pub intensity: Option<WrittenNumber>,
}

impl InSceneFile for Sun {
    type Written = WrittenSun;

    const NAME: &'static str = "Sun";
    const OWNER: &'static str = "a Sun";
    const FORM: &'static str = "Sun(direction: ...)";
    const FIELDS: &'static [&'static str] = &["direction", "color", "intensity"];
    const SUMMARY: &'static str = "Light from infinitely far, in parallel rays.";
    const MEANINGS: &'static [&'static str] =
        &["the direction to the light, of any length", "the colour; white", "the factor of the colour; 1"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenSun {
        WrittenSun {
            direction: reader.required(fields, "direction", NodeReader::direction),
            color: reader.optional(fields, "color", NodeReader::color),
            intensity: reader.optional(fields, "intensity", NodeReader::number),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
