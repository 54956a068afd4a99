//! Materials: the reflected share of the arriving light.
//!
//! All materials are diffuse (lecture, "Shading", assumption 3): they reflect equally in all directions, so that a
//! point has the same colour from every viewpoint.
//!
//! Each material is a file under `material/`. To add one, write that file with implementations of [`Reflecting`] and
//! [`InSceneFile`], and add a line to the table here.

use crate::checks::SceneFault;
use crate::color::LinearRgb;
use crate::lanes::Number;
use crate::scene_text::SyntaxNode;
use crate::written::{InSceneFile, NodeReader, Validator};

mod checker;
mod diffuse;
#[cfg(test)]
mod stripes;

pub use checker::{Checker, WrittenChecker};
pub use diffuse::Diffuse;
#[cfg(test)]
pub use stripes::Stripes;

/// A diffuse surface, plain or patterned. Reflectances are linear, each channel in 0..=1.
pub trait Reflecting: InSceneFile + Copy {
    /// Its pattern after a pronoun, for messages: "its squares". Only surfaces with coordinates can have it.
    const PATTERN: Option<&'static str> = None;

    /// Returns the diffuse reflectances of red, green and blue at the surface coordinates `uv`, filtered over
    /// `footprint`, the extent of a pixel there; zero for a point sample.
    fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3];

    /// Returns an adjective for the name of a shape, such as "red"; the function names colours.
    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String;

    /// Returns the checked material; if `None`, a fault has been reported.
    fn check(written: &Self::Written, validator: &mut Validator<'_>) -> Option<Self>;
}

/// Defines [`Material`] and [`WrittenMaterial`] by the table of materials.
macro_rules! materials {
    ($($(#[$on:meta])* $material:ident, $of:literal;)*) => {
        /// Any material, or the surface's own.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Material {
            $(#[doc = $of] #[doc(hidden)] $(#[$on])* $material($material),)*
            /// The surface's own: the colours and textures of a mesh's file; without any, [`DEFAULT`](Self::DEFAULT).
            Own,
        }

        impl Material {
            /// See [`Reflecting::reflectance`]; for [`Own`](Self::Own), that of a surface without colours.
            #[doc(hidden)]
            #[inline(always)]
            pub fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3] {
                match self {
                    $($(#[$on])* Self::$material(material) => material.reflectance(uv, footprint),)*
                    Self::Own => channels(Self::DEFAULT_REFLECTANCE),
                }
            }

            /// Returns its name with an article, and its [pattern](Reflecting::PATTERN), if it has one.
            pub(crate) fn pattern(&self) -> Option<(&'static str, &'static str)> {
                match self {
                    $($(#[$on])* Self::$material(_) => $material::PATTERN.map(|pattern| ($material::OWNER, pattern)),)*
                    Self::Own => None,
                }
            }

            /// See [`Reflecting::described`]; empty for [`Own`](Self::Own).
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

        /// A material as written.
        #[derive(Clone, Debug, PartialEq)]
        pub enum WrittenMaterial {
            $(#[doc = $of] $(#[$on])* $material(<$material as InSceneFile>::Written),)*
        }

        #[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
        impl WrittenMaterial {
            /// The names of materials.
            pub(crate) const NAMES: &'static [&'static str] = &[$($(#[$on])* $material::NAME,)*];

            /// Reads the material with this name.
            pub(crate) fn read(name: &str, reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self> {
                $($(#[$on])* if name == $material::NAME {
                    return $material::read_node(reader, node).map(Self::$material);
                })*
                None
            }

            /// Returns the checked material; if `None`, a fault has been reported.
            pub(crate) fn check(&self, validator: &mut Validator<'_>) -> Option<Material> {
                match self {
                    $($(#[$on])* Self::$material(written) => $material::check(written, validator).map(Material::from),)*
                }
            }

            /// Returns its name with an article, and its [pattern](Reflecting::PATTERN), if it has one.
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

/// Returns the material of an object without one: a light grey.
impl Default for Material {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Material {
    /// The material of an object without one: a light grey.
    #[doc(hidden)]
    pub const DEFAULT: Self = Self::Diffuse(Diffuse::DEFAULT);

    /// The reflectance of [`DEFAULT`](Self::DEFAULT).
    pub(crate) const DEFAULT_REFLECTANCE: LinearRgb = LinearRgb::grey(0.8);

    /// Returns a material with the same reflectance everywhere, linear.
    ///
    /// # Errors
    /// Unless each channel is within 0 and 1.
    pub fn diffuse(reflectance: LinearRgb) -> Result<Self, SceneFault> {
        Diffuse::new(reflectance).map(Self::Diffuse)
    }

    /// Returns a material of squares with alternating reflectances, linear, and sides of this length. Only a plane can
    /// have it.
    ///
    /// # Errors
    /// Unless each channel is within 0 and 1, and the size between 1e-9 and 1e9.
    pub fn checker(a: LinearRgb, b: LinearRgb, size: f32) -> Result<Self, SceneFault> {
        Checker::new(a, b, size).map(Self::Checker)
    }
}

/// Returns the channels of a colour as constants.
#[inline(always)]
fn channels<N: Number>(LinearRgb { r, g, b }: LinearRgb) -> [N; 3] {
    [N::splat(r), N::splat(g), N::splat(b)]
}
