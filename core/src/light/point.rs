//! Point sources.

use super::LightSource;
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::scene_text::SyntaxNode;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, WrittenNumber, WrittenVector};
use glam::Vec3;

/// A point source (lecture, "Shading", assumptions 1 and 2).
///
/// Its intensity is the same in all directions.
///
/// ```
/// use glam::Vec3;
/// use termtrace::{Falloff, LinearRgb, PointLight};
///
/// let lamp = PointLight::new(Vec3::new(0.0, 3.0, 0.0), LinearRgb::grey(20.0))?;
/// let even = lamp.with_falloff(Falloff::None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    position: Vec3,
    /// The [intensity](Self::new), not negative.
    intensity: LinearRgb,
    falloff: Falloff,
}

impl PointLight {
    /// Returns a light at a point in world space, with inverse square falloff.
    ///
    /// `intensity` is the radiant intensity times 1/pi: the radiance of a white surface that faces the light at
    /// distance 1.
    ///
    /// # Errors
    /// If a coordinate is not within ±1e9, or a channel of the intensity not within 0 and 1e12.
    pub fn new(position: Vec3, intensity: LinearRgb) -> Result<Self, SceneFault> {
        let position = checks::checked_point("position", position)?;
        let intensity = checks::checked_color("intensity", intensity, checks::light)?;
        Ok(Self { position, intensity, falloff: Falloff::default() })
    }

    /// Returns the light with another falloff.
    pub fn with_falloff(self, falloff: Falloff) -> Self {
        Self { falloff, ..self }
    }

    /// Returns the position in world space.
    #[doc(hidden)]
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Returns the [intensity](Self::new).
    #[doc(hidden)]
    pub fn intensity(&self) -> LinearRgb {
        self.intensity
    }

    /// Returns the falloff.
    #[doc(hidden)]
    pub fn falloff(&self) -> Falloff {
        self.falloff
    }
}

/// The falloff of a light's irradiance with its distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Falloff {
    /// 1 / d^2, the falloff of physical light.
    #[default]
    InverseSquare,
    /// The same irradiance at every distance, as in the lecture's first version.
    None,
}

impl Falloff {
    /// Reads the name of a falloff.
    pub(super) fn read(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self> {
        reader.choice(node, "a falloff", &[("InverseSquare", Self::InverseSquare), ("None", Self::None)])
    }
}

impl LightSource for PointLight {
    #[inline(always)]
    fn to_light<N: Number>(&self, point: Vector<N>) -> Vector<N> {
        Vector::splat(self.position) - point
    }

    #[inline(always)]
    fn irradiance_over_pi<N: Number>(&self, _: Vector<N>, distance_squared: N, cosine: N) -> [N; 3] {
        // One factor for all channels needs one division instead of three.
        let weakening = match self.falloff {
            Falloff::InverseSquare => cosine / distance_squared,
            Falloff::None => cosine,
        };
        let LinearRgb { r, g, b } = self.intensity;
        [N::splat(r) * weakening, N::splat(g) * weakening, N::splat(b) * weakening]
    }

    fn formula(&self) -> &'static str {
        match self.falloff {
            Falloff::InverseSquare => "V I max(0, n.l) / D^2",
            Falloff::None => "V I max(0, n.l)",
        }
    }

    fn color(&self) -> LinearRgb {
        self.intensity
    }

    fn position(&self) -> Option<Vec3> {
        Some(self.position)
    }

    fn moved_to(self, position: Vec3) -> Self {
        checks::checked_point("position", position).map_or(self, |position| Self { position, ..self })
    }

    fn check(written: &WrittenPointLight, validator: &mut Validator<'_>) -> Option<Self> {
        let position = written.position.and_then(|position| validator.point(position));
        let intensity = validator.intensity(written.color, written.intensity);
        let falloff = written.falloff.unwrap_or_default();
        Some(Self { position: position?, intensity: intensity?, falloff })
    }
}

/// A point light as written: `Point(position: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenPointLight {
    /// The position.
    pub position: Option<WrittenVector>,
    /// The colour; white if not given.
    pub color: Option<WrittenColor>,
    /// The factor of the colour; 1 if not given.
    pub intensity: Option<WrittenNumber>,
    /// The falloff; inverse square if not given.
    pub falloff: Option<Falloff>,
}

impl InSceneFile for PointLight {
    type Written = WrittenPointLight;

    const NAME: &'static str = "Point";
    const OWNER: &'static str = "a Point light";
    const FORM: &'static str = "Point(position: ...)";
    const FIELDS: &'static [&'static str] = &["position", "color", "intensity", "falloff"];
    const SUMMARY: &'static str = "A point source, which shines in all directions.";
    const MEANINGS: &'static [&'static str] = &[
        "the point that the light comes from",
        "the colour; white",
        "the factor of the colour; 1",
        "InverseSquare, or None for the same light at every distance; InverseSquare",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenPointLight {
        WrittenPointLight {
            position: reader.required(fields, "position", NodeReader::point),
            color: reader.optional(fields, "color", NodeReader::color),
            intensity: reader.optional(fields, "intensity", NodeReader::number),
            falloff: reader.optional_keeping_none(fields, "falloff", Falloff::read),
        }
    }
}
