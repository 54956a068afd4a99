//! Directional light, such as that of the sun.

use super::{LightSource, PartPosition};
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::ray::Interval;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, WrittenNumber, WrittenVector};
use glam::Vec3;

/// A directional light, which has the same direction and irradiance everywhere.
///
/// It is infinitely far away. With a size it is a disc in the sky, whose shadows have penumbras.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The direction to the light. Unit length.
    direction: Vec3,
    /// The [intensity](Self::new), not negative.
    intensity: LinearRgb,
    disc: Disc,
}

/// The disc of a sun in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Disc {
    /// 1 minus the cosine of the angle between the middle and the edge; 0 without a size.
    below_one: f32,
    /// The factor of the light of a part.
    ///
    /// The mean cosine of a surface's normal and the directions to a disc above the horizon is that of the middle,
    /// times the mean of 1 and the cosine of the angle to the edge. All parts together give what the middle does.
    brightness: f32,
}

impl Disc {
    /// The disc of a sun without a size.
    const POINT: Self = Self { below_one: 0.0, brightness: 1.0 };

    /// Returns the disc of this angular diameter.
    fn new(degrees: f32) -> Self {
        // 1 - cos a = 2 sin^2 (a / 2), which keeps the size of a small disc.
        let sine = libm::sin(0.25 * f64::from(degrees).to_radians());
        let below_one = 2.0 * sine * sine;
        Self { below_one: below_one as f32, brightness: (2.0 / (2.0 - below_one)) as f32 }
    }
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
        Ok(Self { direction, intensity, disc: Disc::POINT })
    }

    /// Returns the light with a size, its angular diameter in degrees.
    ///
    /// The Sun seen from the Earth has 0.53 degrees. A surface that faces the whole disc receives as much light as from
    /// a sun without a size.
    ///
    /// # Errors
    /// If the angle is not within 0 and 90.
    #[doc(hidden)]
    pub fn with_size(self, degrees: f32) -> Result<Self, SceneFault> {
        let degrees = checks::checked_number("size", degrees, checks::sun_size)?;
        Ok(Self { disc: Disc::new(degrees), ..self })
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
        // Without a size, this multiplies by 1.
        let cosine = cosine * N::splat(self.disc.brightness);
        [N::splat(r) * cosine, N::splat(g) * cosine, N::splat(b) * cosine]
    }

    fn has_size(&self) -> bool {
        self.disc.below_one > 0.0
    }

    /// Returns unit vectors that are evenly distributed over the solid angle of the disc.
    #[inline(always)]
    fn to_part<N: Number>(&self, point: Vector<N>, part: &PartPosition<N>) -> Vector<N> {
        let towards = self.to_light(point);
        // A solid angle is proportional to the height on the sphere (Archimedes), here the cosine.
        let below_one = part.height * N::splat(self.disc.below_one);
        let (cosine, sine) = (N::splat(1.0) - below_one, (below_one * (N::splat(2.0) - below_one)).sqrt());
        let ([u, v], [a, b]) = (towards.perpendicular_pair(), part.direction);
        let (a, b) = (a * sine, b * sine);
        towards * cosine + u * a + v * b
    }

    fn without_size(self) -> Self {
        Self { disc: Disc::POINT, ..self }
    }

    fn color(&self) -> LinearRgb {
        self.intensity
    }

    fn check(written: &WrittenSun, validator: &mut Validator<'_>) -> Option<Self> {
        let direction = written.direction.and_then(|direction| validator.unit_vector("direction", direction));
        let intensity = validator.intensity(written.color, written.intensity);
        let disc = written
            .size
            .map_or(Some(Disc::POINT), |size| validator.accept(size.span, checks::sun_size(size.value)).map(Disc::new));
        Some(Self { direction: direction?.as_vec3(), intensity: intensity?, disc: disc? })
    }
}

/// A directional light as written: `Sun(direction: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenSun {
    /// The direction to the light.
    pub direction: Option<WrittenVector>,
    /// The angular diameter in degrees; 0 if not given.
    pub size: Option<WrittenNumber>,
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
    const FIELDS: &'static [&'static str] = &["direction", "size", "color", "intensity"];
    const SUMMARY: &'static str = "Light from infinitely far, such as that of the sun.";
    const MEANINGS: &'static [&'static str] = &[
        "the direction to the light, of any length",
        "the angular diameter in degrees, 0 to 90; 0",
        "the colour; white",
        "the factor of the colour; 1",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenSun {
        WrittenSun {
            direction: reader.required(fields, "direction", NodeReader::direction),
            size: reader.optional(fields, "size", NodeReader::number),
            color: reader.optional(fields, "color", NodeReader::color),
            intensity: reader.optional(fields, "intensity", NodeReader::number),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
