//! Fog: what the air between a surface and the eye does to light.

use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::scene_text::SyntaxNode;
use crate::written::{NodeReader, ReferenceEntry, Validator, WrittenColor, WrittenNumber};

/// Fog of the same density everywhere.
///
/// Over the way d, T = exp(-d / distance) of the light is left (law of Beer and Lambert), and the fog adds 1 - T of its
/// own colour. A ray that hits nothing ends in the fog, whatever the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// The light along a ray that never leaves the fog.
    color: LinearRgb,
    /// The way in world units after which 1/e of the light is left, greater than 0.
    distance: f32,
}

/// The name of the field `distance` in messages.
const DISTANCE: &str = "distance of a fog";

impl Fog {
    /// Returns fog of this colour; after `distance` world units, 1/e (37 %) of the light is left.
    ///
    /// # Errors
    /// If a channel is not within 0 and 1e12, or the distance not between 1e-9 and 1e9.
    pub fn new(color: LinearRgb, distance: f32) -> Result<Self, SceneFault> {
        let color = checks::checked_color("color", color, checks::light)?;
        let distance = checks::checked_number("distance", distance, |distance| checks::length(DISTANCE, distance))?;
        Ok(Self { color, distance })
    }

    /// Returns T, the part of the light that is left after `way` world units, possibly infinite.
    pub fn transmittance(&self, way: f32) -> f32 {
        libm::expf(-way / self.distance)
    }

    /// Returns the light at the end of a way of which T is `transmittance`.
    pub fn dimmed(&self, light: LinearRgb, transmittance: f32) -> LinearRgb {
        light * transmittance + self.color * (1.0 - transmittance)
    }

    /// Returns the way in world units after which 1/e of the light is left.
    pub fn distance(&self) -> f32 {
        self.distance
    }

    /// Returns the light along a ray that never leaves the fog.
    pub fn color(&self) -> LinearRgb {
        self.color
    }
}

/// Fog as written: `(color: ..., distance: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenFog {
    /// The colour; white if not given.
    pub color: Option<WrittenColor>,
    /// The way after which 1/e of the light is left.
    pub distance: Option<WrittenNumber>,
}

#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
impl WrittenFog {
    /// The reference of fog.
    pub(crate) const REFERENCE: ReferenceEntry = ReferenceEntry {
        name: "fog",
        form: "(color: ..., distance: ...)",
        summary: "Air that takes away light between what is seen and the eye.",
        fields: &["color", "distance"],
        meanings: &["the light of endless fog, a colour; white", "the way after which 1/e (37 %) of the light is left"],
    }
    .checked();

    /// Reads fog.
    pub(crate) fn read(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self> {
        let fields = reader.fields(node, "a fog", "(color: ..., distance: ...)", Self::REFERENCE.fields)?;
        Some(Self {
            color: reader.optional(&fields, "color", NodeReader::color),
            distance: reader.required(&fields, "distance", NodeReader::number),
        })
    }

    /// Returns the checked fog, or `None` after a fault has been reported to `validator`.
    pub(crate) fn check(&self, validator: &mut Validator<'_>) -> Option<Fog> {
        let color = self.color.map_or(Some(LinearRgb::grey(1.0)), |color| validator.light_color(color));
        let distance = self.distance.and_then(|distance| validator.length(DISTANCE, distance));
        Some(Fog { color: color?, distance: distance? })
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
