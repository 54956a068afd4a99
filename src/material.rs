//! Materials: how much of the light that arrives is reflected.
//!
//! All of them reflect diffusely (lecture, "Shading", assumption 3): equally in all directions, so that a point has
//! the same colour from every viewpoint.
//!
//! Each material is a file of its own under `material/`. To add one, write that file, with implementations of
//! [`Reflecting`] and [`InSceneFile`], and give it a line in the table here.

use crate::checks::SceneFault;
use crate::color::LinearRgb;
use crate::lanes::Number;
use crate::scene_text::Node;
use crate::written::{InSceneFile, Reader, Validator};

mod checker;
mod diffuse;
#[cfg(test)]
mod stripes;

pub use checker::{Checker, WrittenChecker};
pub use diffuse::Diffuse;
#[cfg(test)]
pub use stripes::Stripes;

/// A diffuse surface, plain or patterned. Reflectances are linear, each band in 0..=1.
pub trait Reflecting: InSceneFile + Copy {
    /// Its pattern after a pronoun, for messages: "its squares". Only surfaces with coordinates can have it.
    const PATTERN: Option<&'static str> = None;

    /// Returns the diffuse reflectances of red, green and blue, where the surface has the coordinates `uv` and a pixel
    /// reaches over `footprint` of them: zero for a point alone.
    fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3];

    /// Returns what is said of it before the name of a shape, such as "red", with a function that names colours.
    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String;

    /// Returns the material, if nothing is wrong with it; else faults are added, or were.
    fn check(written: &Self::Written, validator: &mut Validator<'_>) -> Option<Self>;
}

/// Makes [`Material`] and [`WrittenMaterial`] from the table of materials.
macro_rules! materials {
    ($($(#[$on:meta])* $material:ident, $of:literal;)*) => {
        /// Any of the materials, or what a surface brings itself.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Material {
            $(#[doc = $of] $(#[$on])* $material($material),)*
            /// What the surface brings itself: the colours and textures of a mesh's file; where there are none, as
            /// [`DEFAULT`](Self::DEFAULT).
            Own,
        }

        impl Material {
            /// [`Reflecting::reflectance`]; for what is [`Own`](Self::Own), that of a surface that brings nothing.
            #[doc(hidden)]
            #[inline(always)]
            pub fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3] {
                match self {
                    $($(#[$on])* Self::$material(material) => material.reflectance(uv, footprint),)*
                    Self::Own => bands(Self::DEFAULT_REFLECTANCE),
                }
            }

            /// Returns its name after an article, and its [pattern](Reflecting::PATTERN), if it has one.
            pub(crate) fn pattern(&self) -> Option<(&'static str, &'static str)> {
                match self {
                    $($(#[$on])* Self::$material(_) => $material::PATTERN.map(|pattern| ($material::OWNER, pattern)),)*
                    Self::Own => None,
                }
            }

            /// [`Reflecting::described`]; nothing for what is [`Own`](Self::Own).
            pub(crate) fn described(&self, name: fn(LinearRgb) -> &'static str) -> Option<String> {
                match self {
                    $($(#[$on])* Self::$material(material) => Some(material.described(name)),)*
                    Self::Own => None,
                }
            }
        }

        $($(#[$on])* impl From<$material> for Material {
            fn from(material: $material) -> Self {
                Self::$material(material)
            }
        })*

        /// A material as it is written.
        #[derive(Clone, Debug, PartialEq)]
        pub enum WrittenMaterial {
            $(#[doc = $of] $(#[$on])* $material(<$material as InSceneFile>::Written),)*
        }

        #[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
        impl WrittenMaterial {
            /// The words that name materials.
            pub(crate) const NAMES: &'static [&'static str] = &[$($(#[$on])* $material::NAME,)*];

            /// Reads the material of that name.
            pub(crate) fn read(name: &str, reader: &mut Reader<'_>, node: &Node<'_>) -> Option<Self> {
                $($(#[$on])* if name == $material::NAME {
                    return $material::read_node(reader, node).map(Self::$material);
                })*
                None
            }

            /// Returns the material, if nothing is wrong with it; else faults are added, or were.
            pub(crate) fn check(&self, validator: &mut Validator<'_>) -> Option<Material> {
                match self {
                    $($(#[$on])* Self::$material(written) => $material::check(written, validator).map(Material::from),)*
                }
            }

            /// Returns its name after an article, and its [pattern](Reflecting::PATTERN), if it has one.
            pub(crate) fn pattern(&self) -> Option<(&'static str, &'static str)> {
                match self {
                    $($(#[$on])* Self::$material(_) => $material::PATTERN.map(|pattern| ($material::OWNER, pattern)),)*
                }
            }
        }
    };
}

materials! {
    Diffuse, "The same reflectance everywhere.";
    Checker, "Squares of two reflectances in turn.";
    #[cfg(test)]
    Stripes, "Stripes of two reflectances in turn.";
}

/// The material of an object that is given none: a light grey.
impl Default for Material {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Material {
    /// The material of an object that is given none: a light grey.
    #[doc(hidden)]
    pub const DEFAULT: Self = Self::Diffuse(Diffuse::DEFAULT);

    /// The reflectance of [`DEFAULT`](Self::DEFAULT).
    pub(crate) const DEFAULT_REFLECTANCE: LinearRgb = LinearRgb::grey(0.8);

    /// Returns the material with the same reflectance everywhere, linear.
    ///
    /// # Errors
    /// Unless each band lies within 0 and 1.
    pub fn diffuse(reflectance: LinearRgb) -> Result<Self, SceneFault> {
        Diffuse::new(reflectance).map(Self::Diffuse)
    }

    /// Returns the material of squares with two reflectances in turn, linear, whose side has that length. Only a plane can
    /// have it.
    ///
    /// # Errors
    /// Unless each band lies within 0 and 1, and the size between 1e-9 and 1e9.
    pub fn checker(a: LinearRgb, b: LinearRgb, size: f32) -> Result<Self, SceneFault> {
        Checker::new(a, b, size).map(Self::Checker)
    }
}

/// Returns the bands of a colour, the same in every place.
#[inline(always)]
fn bands<N: Number>(LinearRgb { r, g, b }: LinearRgb) -> [N; 3] {
    [N::splat(r), N::splat(g), N::splat(b)]
}
