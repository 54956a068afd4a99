//! Materials: the reflectance of surfaces.
//!
//! All materials are diffuse (lecture, "Shading", assumption 3): they reflect equally in all directions, so a point has
//! the same colour from every viewpoint.
//!
//! Each material is a file under `material/`. To add one, write that file with implementations of [`Reflecting`] and
//! [`InSceneFile`], and add a line to the table `materials` here. An [`Image`] is not in the table, as its texels
//! cannot be copied into each object; they are found lane by lane.

use crate::checks::SceneFault;
use crate::color::{LinearRgb, Srgb8};
use crate::lanes::Number;
use crate::scene_text::SyntaxNode;
use crate::written::{InSceneFile, NodeReader, ReferenceEntry, Validator, WrittenColor};
use std::sync::Arc;

mod checker;
mod diffuse;
mod gradient;
mod image;
mod noise;
mod stripes;
mod waves;

pub use checker::{Checker, WrittenChecker};
pub use diffuse::Diffuse;
pub use gradient::{Gradient, WrittenGradient};
pub use image::{Image, Images, WrittenImage};
pub use noise::{Noise, WrittenNoise};
pub use stripes::{Stripes, WrittenStripes};

/// A diffuse material, plain or patterned. Reflectances are linear, each channel in 0..=1.
// The enum `Material` is used instead of trait objects, as `reflectance` is generic over the lanes and inlined into the
// kernels.
pub trait Reflecting: InSceneFile + Copy {
    /// The name of the material's pattern for messages, such as "its squares"; `None` for a plain
    /// material, whose reflectance ignores coordinates and footprint.
    ///
    /// Only a surface that has surface coordinates can have a pattern.
    const PATTERN: Option<&'static str> = None;

    /// Returns the reflectances of red, green and blue at the surface coordinates `uv`.
    ///
    /// They are means over `footprint`, the extent of a sample in these coordinates. A footprint of 0 is a point.
    fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3];

    /// Returns an adjective for descriptions, such as "red". `name` returns the name of a colour.
    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String;

    /// Returns the checked material, or `None` after a fault has been reported to `validator`.
    fn check(written: &Self::Written, validator: &mut Validator<'_>) -> Option<Self>;
}

/// Defines [`Material`] and [`WrittenMaterial`] from the table of materials.
macro_rules! materials {
    ($($material:ident, $of:literal;)*) => {
        /// A material of an object.
        ///
        /// ```
        /// use termtrace::{LinearRgb, Material};
        ///
        /// let floor = Material::checker(LinearRgb::grey(0.7), LinearRgb::grey(0.1), 0.5)?;
        /// let error = Material::diffuse(LinearRgb::grey(1.5)).unwrap_err();
        /// assert!(error.to_string().contains("1.5"));
        /// # Ok::<(), Box<dyn std::error::Error>>(())
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Material {
            $(#[doc = $of] #[doc(hidden)] $material($material),)*
            /// The colours and textures of a mesh's file, the colours that the formulas of an
            /// implicit surface give, or the picture that a scene file lays on the shape.
            ///
            /// If there are none, a diffuse light grey.
            Own,
        }

        impl Material {
            /// Returns [`Reflecting::reflectance`], or the default reflectance for
            /// [`Own`](Self::Own).
            #[doc(hidden)]
            #[inline(always)]
            pub fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3] {
                match self {
                    $(Self::$material(material) => material.reflectance(uv, footprint),)*
                    Self::Own => channels(Self::DEFAULT_REFLECTANCE),
                }
            }

            /// Returns a patterned material's name with an article, and its pattern's name.
            pub(crate) fn material_and_pattern_names(&self) -> Option<(&'static str, &'static str)> {
                match self {
                    $(Self::$material(_) => $material::PATTERN.map(|pattern| ($material::OWNER, pattern)),)*
                    Self::Own => None,
                }
            }

            /// Returns whether the reflectance differs from point to point by a pattern.
            #[inline(always)]
            pub(crate) fn is_patterned(&self) -> bool {
                match self {
                    $(Self::$material(_) => $material::PATTERN.is_some(),)*
                    Self::Own => false,
                }
            }

            /// Returns the adjective of [`Reflecting::described`]; `None` for [`Own`](Self::Own).
            pub(crate) fn described(&self, name: fn(LinearRgb) -> &'static str) -> Option<String> {
                match self {
                    $(Self::$material(material) => Some(material.described(name)),)*
                    Self::Own => None,
                }
            }
        }

        $(impl From<$material> for Material {
            fn from(material: $material) -> Self {
                Self::$material(material)
            }
        })*

        /// A material as written in a scene file.
        #[derive(Clone, Debug, PartialEq)]
        pub enum WrittenMaterial {
            $(#[doc = $of] $material(<$material as InSceneFile>::Written),)*
            /// A picture from a file.
            Image(WrittenImage),
        }

        #[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
        impl WrittenMaterial {
            /// The reference of all materials.
            pub(crate) const REFERENCE: &'static [ReferenceEntry] =
                &[$(ReferenceEntry::of::<$material>(),)* ReferenceEntry::of::<Image>()];

            /// The names of all materials in scene files.
            pub(crate) const NAMES: &'static [&'static str] = &[$($material::NAME,)* Image::NAME];

            /// Reads the material called `name`.
            ///
            /// Returns `None` if the name is unknown or `node` has no fields or values that can be read.
            pub(crate) fn read(name: &str, reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self> {
                $(if name == $material::NAME {
                    return $material::read_node(reader, node).map(Self::$material);
                })*
                if name == Image::NAME {
                    return Image::read_node(reader, node).map(Self::Image);
                }
                None
            }

            /// Returns the checked colours, or `None` after a fault has been reported to
            /// `validator`.
            pub(crate) fn check(&self, validator: &mut Validator<'_>, images: &mut dyn Images) -> Option<Coloring> {
                match self {
                    $(Self::$material(written) => {
                        $material::check(written, validator).map(|checked| Material::from(checked).into())
                    })*
                    Self::Image(written) => Image::check(written, validator, images).map(Coloring::from),
                }
            }

            /// Returns a patterned material's name with an article, and its pattern's name.
            pub(crate) fn material_and_pattern_names(&self) -> Option<(&'static str, &'static str)> {
                match self {
                    $(Self::$material(_) => $material::PATTERN.map(|pattern| ($material::OWNER, pattern)),)*
                    Self::Image(_) => Some((Image::OWNER, Image::PATTERN)),
                }
            }
        }
    };
}

materials! {
    Diffuse, "The same reflectance everywhere.";
    Checker, "Squares of two reflectances in turn.";
    Stripes, "Stripes of two reflectances in turn.";
    Gradient, "Reflectances from one to another and back.";
    Noise, "Irregular spots of two reflectances.";
}

/// The colours of an object: its material, or the picture on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Coloring {
    /// The material; [`Material::Own`] if there is a picture.
    pub material: Material,
    /// The picture.
    pub image: Option<Arc<Image>>,
}

impl From<Material> for Coloring {
    fn from(material: Material) -> Self {
        Self { material, image: None }
    }
}

impl From<Image> for Coloring {
    fn from(image: Image) -> Self {
        Self { material: Material::Own, image: Some(image.into()) }
    }
}

/// Returns the material of an object without one: a diffuse light grey.
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
    // The reflectance of matt white paint. It is below 1, so that an object stays visible in front of a white one.
    #[doc(hidden)]
    pub const DEFAULT_REFLECTANCE: LinearRgb = LinearRgb::grey(0.8);

    /// Returns a material with the same linear reflectance everywhere.
    ///
    /// # Errors
    /// If a channel is not within 0 and 1.
    pub fn diffuse(reflectance: LinearRgb) -> Result<Self, SceneFault> {
        Diffuse::new(reflectance).map(Self::Diffuse)
    }

    /// Returns a material of squares with alternating linear reflectances and side `size`.
    ///
    /// Only a surface with coordinates for patterns, such as a plane, can have this material.
    ///
    /// # Errors
    /// If a channel is not within 0 and 1, or the size not between 1e-9 and 1e9.
    pub fn checker(a: LinearRgb, b: LinearRgb, size: f32) -> Result<Self, SceneFault> {
        Checker::new(a, b, size).map(Self::Checker)
    }
}

/// Returns the sum of two reflectances, each multiplied by its share.
#[inline(always)]
fn mixed<N: Number>([a, b]: [LinearRgb; 2], [of_a, of_b]: [N; 2]) -> [N; 3] {
    let ([r0, g0, b0], [r1, g1, b1]) = (channels::<N>(a), channels::<N>(b));
    [r0 * of_a + r1 * of_b, g0 * of_a + g1 * of_b, b0 * of_a + b1 * of_b]
}

/// Checks the two reflectances of a pattern, by default a light and a dark grey.
fn check_two([a, b]: [Option<WrittenColor>; 2], validator: &mut Validator<'_>) -> Option<[LinearRgb; 2]> {
    let mut color_or = |color: Option<WrittenColor>, grey: u8| match color {
        Some(color) => validator.reflectance(color),
        None => Some(LinearRgb::from_srgb8(Srgb8::new(grey, grey, grey))),
    };
    let (a, b) = (color_or(a, 0xdd), color_or(b, 0x33));
    Some([a?, b?])
}

/// Returns the channels of a colour in all lanes.
#[inline(always)]
fn channels<N: Number>(LinearRgb { r, g, b }: LinearRgb) -> [N; 3] {
    [N::splat(r), N::splat(g), N::splat(b)]
}

#[cfg(all(test, unit_tests))]
mod tests;
