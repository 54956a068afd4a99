//! Finishes: what a surface does with light besides reflecting it diffusely.
//!
//! A material says which light a surface reflects, and its finish says how: diffusely (as in the lecture), as a
//! mirror, or by letting light through. Mirrors and glass follow Snell's law and Fresnel's equations (Hecht, Optics,
//! chapter 4).

use crate::checks::{self, Message, SceneFault};
use crate::ray::Ray;
use crate::scene_text::{Body, SyntaxNode, Value};
use crate::written::{NodeReader, Validator, WrittenNumber};
use glam::Vec3;

/// The finish of an object.
///
/// R is the reflectance of the object's material, and F the mirrored part of the light by Fresnel's equations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Finish {
    /// Reflects diffusely, by R: the lecture's assumption.
    #[default]
    Matte,
    /// A clear coat over a matte surface: mirrors F of the light, and reflects the rest diffusely.
    Polished {
        /// The index of refraction of the coat.
        index: f32,
    },
    /// Mirrors R of the light, without diffuse reflection.
    Metal,
    /// Mirrors F of the light, and refracts the rest, of which R enters.
    Glass {
        /// The index of refraction.
        index: f32,
    },
    /// Sends out light of its own, `strength` times R, whatever arrives.
    Glowing {
        /// The factor of R, 0 or more.
        strength: f32,
    },
}

impl Finish {
    /// The index of refraction of window glass, the default.
    pub(crate) const GLASS_INDEX: f32 = 1.5;

    /// Returns a clear coat with this index of refraction.
    ///
    /// # Errors
    /// If the index is not between 1 and 4.
    pub fn polished(index: f32) -> Result<Self, SceneFault> {
        Ok(Self::Polished { index: checks::checked_number("index", index, refractive_index)? })
    }

    /// Returns glass with this index of refraction.
    ///
    /// # Errors
    /// If the index is not between 1 and 4.
    pub fn glass(index: f32) -> Result<Self, SceneFault> {
        Ok(Self::Glass { index: checks::checked_number("index", index, refractive_index)? })
    }

    /// Returns a finish that sends out `strength` times the reflectance of the material.
    ///
    /// # Errors
    /// If the strength is not between 0 and 1e12.
    pub fn glowing(strength: f32) -> Result<Self, SceneFault> {
        Ok(Self::Glowing { strength: checks::checked_number("strength", strength, strength_of_glow)? })
    }

    /// Returns whether the surface only reflects diffusely.
    pub(crate) fn is_matte(self) -> bool {
        self == Self::Matte
    }

    /// Returns the part of the light that the surface mirrors, for a ray from outside.
    pub(crate) fn mirrored_part(self, ray: &Ray, normal: Vec3) -> f32 {
        match self {
            Self::Matte | Self::Glowing { .. } => 0.0,
            Self::Metal => 1.0,
            Self::Polished { index } | Self::Glass { index } => {
                fresnel(cosine_of_incidence(ray.direction, normal), 1.0 / index)
            }
        }
    }

    /// Returns an adjective for descriptions, such as "polished"; `None` for a matte surface.
    pub(crate) fn described(self) -> Option<&'static str> {
        match self {
            Self::Matte => None,
            Self::Polished { .. } => Some("polished"),
            Self::Metal => Some("metal"),
            Self::Glass { .. } => Some("glass"),
            Self::Glowing { .. } => Some("glowing"),
        }
    }
}

/// Returns the part of unpolarized light that the boundary between two media reflects.
///
/// `cosine` is that of the angle of incidence, from 0 to 1, and `ratio` the index of refraction of the first medium
/// over that of the second. The part is 1 for total internal reflection (Hecht, 4.6 and 4.7).
pub fn fresnel(cosine: f32, ratio: f32) -> f32 {
    let Some(refracted) = refracted_cosine(cosine, ratio) else { return 1.0 };
    let perpendicular = (ratio * cosine - refracted) / (ratio * cosine + refracted);
    let parallel = (cosine - ratio * refracted) / (cosine + ratio * refracted);
    let reflected = 0.5 * (perpendicular * perpendicular + parallel * parallel);
    // Both quotients are 0 / 0 for a ratio of 1 at grazing incidence, where nothing is reflected.
    if reflected <= 1.0 { reflected } else { 0.0 }
}

/// Returns the cosine of the angle of refraction, or `None` for total internal reflection.
fn refracted_cosine(cosine: f32, ratio: f32) -> Option<f32> {
    // This form is exact for a ratio of 1, and keeps small cosines, which `1 - cosine * cosine` loses.
    let squared = (1.0 - ratio * ratio) + ratio * ratio * (cosine * cosine);
    (squared >= 0.0).then(|| squared.sqrt())
}

/// Returns the mirror image of a direction; the length stays the same.
///
/// `normal` is a unit vector on the side that the direction comes from.
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - normal * (2.0 * direction.dot(normal))
}

/// Returns the direction after refraction by Snell's law, or `None` for total internal reflection.
///
/// The length stays the same. `normal` is a unit vector on the side that the direction comes from, and `ratio` is that
/// of [`fresnel`].
pub fn refract(direction: Vec3, normal: Vec3, ratio: f32) -> Option<Vec3> {
    let length = direction.dot(direction).sqrt();
    let cosine = cosine_of_incidence(direction, normal);
    let refracted = refracted_cosine(cosine, ratio)?;
    Some(direction * ratio + normal * (length * (ratio * cosine - refracted)))
}

/// Returns the cosine of the angle of incidence, from 0 to 1.
pub fn cosine_of_incidence(direction: Vec3, normal: Vec3) -> f32 {
    let cosine = -direction.dot(normal) / direction.dot(direction).sqrt();
    // `clamp` keeps NaN, for which `refracted_cosine` returns `None`: total reflection.
    cosine.clamp(0.0, 1.0)
}

/// Checks an index of refraction.
// Diamond has 2.4, and germanium 4.0 in the infrared. No transparent solid has less than 1.
fn refractive_index(index: f64) -> Result<f32, Message> {
    if (1.0..=4.0).contains(&index) {
        Ok(index as f32)
    } else {
        Err("an index of refraction must lie between 1 and 4: water has 1.33, glass 1.5, diamond 2.42".into())
    }
}

/// Checks the strength of a glow.
fn strength_of_glow(strength: f64) -> Result<f32, Message> {
    checks::light_amount("the strength", strength)
}

/// A finish as written: `Metal`, `Glass(index: 1.5)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrittenFinish {
    /// `Matte`.
    Matte,
    /// `Polished`, with the index if given.
    Polished(Option<WrittenNumber>),
    /// `Metal`.
    Metal,
    /// `Glass`, with the index if given.
    Glass(Option<WrittenNumber>),
    /// `Glowing`, with the strength if given.
    Glowing(Option<WrittenNumber>),
}

#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
impl WrittenFinish {
    const NAMES: [&'static str; 5] = ["Matte", "Polished", "Metal", "Glass", "Glowing"];

    /// Reads a finish: its name, alone or with its field.
    pub(crate) fn read(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self> {
        const FORM: &str = "a finish, such as Metal or Glass(index: 1.5)";
        let name = reader.group_name(node, "a finish", FORM, &Self::NAMES)?;
        let form = match name {
            "Polished" => "Polished(index: 1.5)",
            "Glass" => "Glass(index: 1.5)",
            "Glowing" => "Glowing(strength: 1)",
            _ => name,
        };
        let field = if name == "Glowing" { "strength" } else { "index" };
        let is_bare = matches!(&node.value, Value::Group(group) if group.body == Body::Nothing);
        let number = match name {
            _ if is_bare => None,
            "Matte" | "Metal" => {
                reader.fault(node.head(), || format!("{name} has no fields; write {name} alone"));
                return None;
            }
            _ => {
                let fields = reader.fields(node, name, form, &[field])?;
                reader.optional(&fields, field, NodeReader::number)
            }
        };
        Some(match name {
            "Polished" => Self::Polished(number),
            "Metal" => Self::Metal,
            "Glass" => Self::Glass(number),
            "Glowing" => Self::Glowing(number),
            _ => Self::Matte,
        })
    }

    /// Returns the checked finish, or `None` after a fault has been reported to `validator`.
    pub(crate) fn check(self, validator: &mut Validator<'_>) -> Option<Finish> {
        let mut index = |written: Option<WrittenNumber>| match written {
            Some(index) => validator.accept(index.span, refractive_index(index.value)),
            None => Some(Finish::GLASS_INDEX),
        };
        Some(match self {
            Self::Matte => Finish::Matte,
            Self::Polished(written) => Finish::Polished { index: index(written)? },
            Self::Metal => Finish::Metal,
            Self::Glass(written) => Finish::Glass { index: index(written)? },
            Self::Glowing(None) => Finish::Glowing { strength: 1.0 },
            Self::Glowing(Some(strength)) => {
                Finish::Glowing { strength: validator.accept(strength.span, strength_of_glow(strength.value))? }
            }
        })
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
