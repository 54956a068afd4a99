//! Finishes: what a surface does with light besides reflecting it diffusely.
//!
//! A material says which light a surface reflects, and its finish says how: diffusely (as in the lecture), with
//! highlights, as a mirror, or by letting light through. Mirrors and glass follow Snell's law and Fresnel's equations
//! (Hecht, Optics, chapter 4).

use crate::checks::{self, Message, SceneFault};
use crate::lanes::{Number, Vector};
use crate::light::{Light, PartPosition};
use crate::ray::Ray;
use crate::scene_text::{Body, SyntaxNode, Value};
use crate::written::{NodeReader, ReferenceEntry, Validator, WrittenNumber};
use glam::Vec3;

/// The finish of an object.
///
/// R is the reflectance of the object's material, and F the mirrored part of the light by Fresnel's equations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Finish {
    /// Reflects diffusely, by R: the lecture's assumption.
    #[default]
    Matte,
    /// Reflects diffusely, by R, and mirrors the lights as soft highlights (Blinn, Models of Light
    /// Reflection for Computer Synthesized Pictures, 1977).
    Shiny {
        /// The exponent of n.h: the larger, the smaller the highlights.
        exponent: u32,
        /// The factor of the highlights, 0 or more.
        strength: f32,
    },
    /// A clear coat over a matte surface: mirrors F of the light, and reflects the rest diffusely.
    Polished {
        /// The index of refraction of the coat.
        index: f32,
    },
    /// Mirrors R of the light, without diffuse reflection.
    Metal {
        /// The roughness, from 0, a mirror, to 1.
        roughness: f32,
    },
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
    /// The default exponent of highlights.
    const EXPONENT: u32 = 50;
    /// The default strength of highlights.
    const STRENGTH: f32 = 0.5;

    /// A mirror without roughness.
    pub const MIRROR: Self = Self::Metal { roughness: 0.0 };

    /// Returns a finish with highlights.
    ///
    /// # Errors
    /// If the exponent is not between 1 and 10,000, or the strength not between 0 and 1e12.
    pub fn shiny(exponent: u32, strength: f32) -> Result<Self, SceneFault> {
        let checked = highlight_exponent(exponent.into());
        let exponent = checked.map_err(|message| SceneFault::new(format!("exponent is {exponent}"), message))?;
        Ok(Self::Shiny { exponent, strength: checks::checked_number("strength", strength, strength_of_highlight)? })
    }

    /// Returns metal with this roughness.
    ///
    /// # Errors
    /// If the roughness is not between 0 and 1.
    pub fn metal(roughness: f32) -> Result<Self, SceneFault> {
        Ok(Self::Metal { roughness: checks::checked_number("roughness", roughness, metal_roughness)? })
    }

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
            Self::Matte | Self::Shiny { .. } | Self::Glowing { .. } => 0.0,
            Self::Metal { .. } => 1.0,
            Self::Polished { index } | Self::Glass { index } => {
                let [direction, normal] = [ray.direction, normal].map(Vector::<f32>::splat);
                mirrored_part(direction, normal, 1.0 / index)
            }
        }
    }

    /// Returns an adjective for descriptions, such as "polished"; `None` for a matte surface.
    pub(crate) fn described(self) -> Option<&'static str> {
        match self {
            Self::Matte => None,
            Self::Shiny { .. } => Some("shiny"),
            Self::Polished { .. } => Some("polished"),
            Self::Metal { roughness: 0.0 } => Some("metal"),
            Self::Metal { .. } => Some("rough metal"),
            Self::Glass { .. } => Some("glass"),
            Self::Glowing { .. } => Some("glowing"),
        }
    }
}

/// Returns the part of the light along `direction` that the boundary between two media reflects.
///
/// `normal` is a unit vector on the side that the direction comes from, and `ratio` is that of [`fresnel`].
#[inline(always)]
pub(crate) fn mirrored_part<N: Number>(direction: Vector<N>, normal: Vector<N>, ratio: N) -> N {
    fresnel(cosine_of_incidence(direction, normal), ratio)
}

/// Returns the part of unpolarized light that the boundary between two media reflects.
///
/// `cosine` is that of the angle of incidence, from 0 to 1, and `ratio` the index of refraction of the first medium
/// over that of the second. The part is 1 for total internal reflection (Hecht, 4.6 and 4.7).
#[inline(always)]
pub fn fresnel<N: Number>(cosine: N, ratio: N) -> N {
    let squared = squared_refracted_cosine(cosine, ratio);
    let refracted = squared.sqrt();
    let perpendicular = (ratio * cosine - refracted) / (ratio * cosine + refracted);
    let parallel = (cosine - ratio * refracted) / (cosine + ratio * refracted);
    let reflected = N::splat(0.5) * (perpendicular * perpendicular + parallel * parallel);
    let (zero, one) = (N::splat(0.0), N::splat(1.0));
    // Both quotients are 0 / 0 for a ratio of 1 at grazing incidence, where nothing is reflected.
    let reflected = N::select(reflected.le(one), reflected, zero);
    N::select(zero.le(squared), reflected, one)
}

/// Returns the square of the cosine of the angle of refraction; negative or NaN for total internal
/// reflection.
#[inline(always)]
fn squared_refracted_cosine<N: Number>(cosine: N, ratio: N) -> N {
    // This form is exact for a ratio of 1, and keeps small cosines, which `1 - cosine * cosine` loses.
    (N::splat(1.0) - ratio * ratio) + ratio * ratio * (cosine * cosine)
}

/// Returns the mirror image of a direction; the length stays the same.
///
/// `normal` is a unit vector on the side that the direction comes from.
#[inline(always)]
pub fn reflect<N: Number>(direction: Vector<N>, normal: Vector<N>) -> Vector<N> {
    direction - normal * (N::splat(2.0) * direction.dot(normal))
}

/// Returns the direction after refraction by Snell's law, or `None` for total internal reflection.
///
/// The length stays the same. `normal` is a unit vector on the side that the direction comes from, and `ratio` is that
/// of [`fresnel`].
pub fn refract(direction: Vec3, normal: Vec3, ratio: f32) -> Option<Vec3> {
    let length = direction.dot(direction).sqrt();
    let cosine = cosine_of_incidence(Vector::<f32>::splat(direction), Vector::splat(normal));
    let squared = squared_refracted_cosine(cosine, ratio);
    let refracted = (squared >= 0.0).then(|| squared.sqrt())?;
    Some(direction * ratio + normal * (length * (ratio * cosine - refracted)))
}

/// The largest light of a highlight: times the largest strength, 1e12, it is finite.
const MAX_HIGHLIGHT: f32 = 1e18;

/// Returns the light of a highlight, for a strength of 1: I (n.h)^p / d^2.
///
/// h is the unit vector halfway between l and the direction to the eye. `direction` is that of the ray from the eye,
/// `normal` n, and `exponent` p.
#[inline(always)]
pub(crate) fn highlight<N: Number>(
    light: &Light,
    to_light: Vector<N>,
    direction: Vector<N>,
    normal: Vector<N>,
    exponent: u32,
) -> [N; 3] {
    let one = N::splat(1.0);
    let distance_squared = to_light.dot(to_light);
    let l = to_light * (one / distance_squared.sqrt());
    let halfway = l - direction * (one / direction.dot(direction).sqrt());
    let cosine = halfway.dot(normal) / halfway.dot(halfway).sqrt();
    let power = whole_power(cosine.max(N::splat(0.0)), exponent);
    let [r, g, b] = light.irradiance_over_pi(l, distance_squared, one);
    let most = N::splat(MAX_HIGHLIGHT);
    [r.min(most) * power, g.min(most) * power, b.min(most) * power]
}

/// Returns `base` raised to a power by repeated squaring, in the same order on every CPU.
#[inline(always)]
fn whole_power<N: Number>(base: N, mut exponent: u32) -> N {
    let (mut power, mut square) = (N::splat(1.0), base);
    while exponent > 0 {
        if exponent % 2 == 1 {
            power = power * square;
        }
        square = square * square;
        exponent /= 2;
    }
    power
}

/// Returns the normal of a facet of rough metal, by which one of its rays is mirrored.
///
/// The facets' normals have the distribution of Trowbridge and Reitz (GGX) with alpha = roughness^2, drawn as in
/// Walter et al., Microfacet Models for Refraction through Rough Surfaces, 2007, equations 35 and 36. All mirrored rays
/// have the same weight: facets do not hide each other.
pub(crate) fn facet_normal(normal: Vec3, roughness: f32, part: &PartPosition<f32>) -> Vec3 {
    let alpha = roughness * roughness;
    let tangent_squared = alpha * alpha * part.height / (1.0 - part.height);
    let cosine = 1.0 / (1.0 + tangent_squared).sqrt();
    let [a, b] = part.direction.map(|coordinate| coordinate * (cosine * tangent_squared.sqrt()));
    let [u, v] = Vector::<f32>::splat(normal).perpendicular_pair().map(Vec3::from);
    normal * cosine + u * a + v * b
}

/// Returns the cosine of the angle of incidence, from 0 to 1.
#[inline(always)]
fn cosine_of_incidence<N: Number>(direction: Vector<N>, normal: Vector<N>) -> N {
    let cosine = -direction.dot(normal) / direction.dot(direction).sqrt();
    let (zero, one) = (N::splat(0.0), N::splat(1.0));
    // The comparisons keep NaN, for which `fresnel` returns total reflection.
    let cosine = N::select(cosine.lt(zero), zero, cosine);
    N::select(one.lt(cosine), one, cosine)
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

/// Checks the exponent of highlights.
// At 10,000 a highlight of the sun has about the sun's own width, half a degree.
fn highlight_exponent(exponent: f64) -> Result<u32, Message> {
    if (1.0..=10_000.0).contains(&exponent) && libm::trunc(exponent) == exponent {
        Ok(exponent as u32)
    } else {
        Err("the exponent of a highlight must be a whole number from 1, wide and soft, to 10000, a point".into())
    }
}

/// Checks the strength of highlights.
fn strength_of_highlight(strength: f64) -> Result<f32, Message> {
    checks::light_amount("the strength", strength)
}

/// Checks the roughness of metal.
fn metal_roughness(roughness: f64) -> Result<f32, Message> {
    if (0.0..=1.0).contains(&roughness) {
        Ok(roughness as f32)
    } else {
        Err("the roughness must lie within 0, a mirror, and 1".into())
    }
}

/// Returns the reference of a finish.
const fn entry(
    name: &'static str,
    form: &'static str,
    summary: &'static str,
    fields: &'static [&'static str],
    meanings: &'static [&'static str],
) -> ReferenceEntry {
    ReferenceEntry { name, form, summary, fields, meanings }.checked()
}

/// A finish as written: `Metal`, `Glass(index: 1.5)`. A number that is not given is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrittenFinish {
    /// `Matte`.
    Matte,
    /// `Shiny`, with the exponent and the strength.
    Shiny([Option<WrittenNumber>; 2]),
    /// `Polished`, with the index.
    Polished(Option<WrittenNumber>),
    /// `Metal`, with the roughness.
    Metal(Option<WrittenNumber>),
    /// `Glass`, with the index.
    Glass(Option<WrittenNumber>),
    /// `Glowing`, with the strength.
    Glowing(Option<WrittenNumber>),
}

#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
impl WrittenFinish {
    /// The reference of all finishes. Their forms show the defaults.
    pub(crate) const REFERENCE: [ReferenceEntry; 6] = [
        entry("Matte", "Matte", "Reflects in all directions.", &[], &[]),
        entry(
            "Shiny",
            "Shiny(exponent: 50, strength: 0.5)",
            "Reflects in all directions, with highlights.",
            &["exponent", "strength"],
            &["how small the highlights are, 1 to 10000; 50", "the factor of the highlights; 0.5"],
        ),
        entry(
            "Polished",
            "Polished(index: 1.5)",
            "A clear coat that mirrors by Fresnel's equations, over a matte surface.",
            &["index"],
            &["the index of refraction, 1 to 4; 1.5"],
        ),
        entry(
            "Metal",
            "Metal(roughness: 0)",
            "A mirror in the colour of the material.",
            &["roughness"],
            &["how blurred the mirror is, 0 to 1; 0"],
        ),
        entry(
            "Glass",
            "Glass(index: 1.5)",
            "Mirrors and refracts by Fresnel's equations.",
            &["index"],
            &["the index of refraction, 1 to 4; 1.5"],
        ),
        entry(
            "Glowing",
            "Glowing(strength: 1)",
            "Sends out light of its own.",
            &["strength"],
            &["the factor of the material's colour; 1"],
        ),
    ];

    /// Reads a finish: its name, alone or with its fields.
    pub(crate) fn read(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self> {
        const FORM: &str = "a finish, such as Metal or Glass(index: 1.5)";
        let known = Self::REFERENCE.map(|finish| finish.name);
        let name = reader.group_name(node, "a finish", FORM, &known)?;
        let &ReferenceEntry { form, fields: names, .. } = Self::REFERENCE.iter().find(|finish| finish.name == name)?;
        let is_bare = matches!(&node.value, Value::Group(group) if group.body == Body::Nothing);
        let mut numbers = [None; 2];
        if !is_bare {
            if names.is_empty() {
                reader.fault(node.head(), || format!("{name} has no fields; write {name} alone"));
                return None;
            }
            let fields = reader.fields(node, name, form, names)?;
            for (number, field) in numbers.iter_mut().zip(names) {
                *number = reader.optional(&fields, field, NodeReader::number);
            }
        }
        let [first, _] = numbers;
        Some(match name {
            "Shiny" => Self::Shiny(numbers),
            "Polished" => Self::Polished(first),
            "Metal" => Self::Metal(first),
            "Glass" => Self::Glass(first),
            "Glowing" => Self::Glowing(first),
            _ => Self::Matte,
        })
    }

    /// Returns the checked finish, or `None` after a fault has been reported to `validator`.
    pub(crate) fn check(self, validator: &mut Validator<'_>) -> Option<Finish> {
        let number = |validator: &mut Validator<'_>, written: Option<WrittenNumber>, rule: Rule, default: f32| {
            written.map_or(Some(default), |written| validator.accept(written.span, rule(written.value)))
        };
        Some(match self {
            Self::Matte => Finish::Matte,
            Self::Shiny([exponent, strength]) => {
                let exponent = exponent.map_or(Some(Finish::EXPONENT), |exponent| {
                    validator.accept(exponent.span, highlight_exponent(exponent.value))
                });
                let strength = number(validator, strength, strength_of_highlight, Finish::STRENGTH);
                Finish::Shiny { exponent: exponent?, strength: strength? }
            }
            Self::Polished(index) => {
                Finish::Polished { index: number(validator, index, refractive_index, Finish::GLASS_INDEX)? }
            }
            Self::Metal(roughness) => Finish::Metal { roughness: number(validator, roughness, metal_roughness, 0.0)? },
            Self::Glass(index) => {
                Finish::Glass { index: number(validator, index, refractive_index, Finish::GLASS_INDEX)? }
            }
            Self::Glowing(strength) => {
                Finish::Glowing { strength: number(validator, strength, strength_of_glow, 1.0)? }
            }
        })
    }
}

/// A rule that checks a number.
type Rule = fn(f64) -> Result<f32, Message>;

#[cfg(all(test, unit_tests))]
mod tests;
