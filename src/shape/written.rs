//! Surfaces as they are written in scene files, and meshes beside them.

use super::{Shape, surfaces};
use crate::mesh_file::MeshFile;
use crate::progress::Unfinished;
use crate::scene_text::SyntaxNode;
use crate::text;
use crate::written::{Fields, InSceneFile, NodeReader, Validator};

/// A surface as it is written, and its check.
pub trait CheckedShape: InSceneFile {
    /// Whether patterns can be laid out on it.
    const HAS_COORDINATES: bool = false;

    /// Whether it may bring colours of its own.
    const BRINGS_COLORS: bool = false;

    /// Returns the shape, if nothing is wrong with it; else faults are added, or were.
    fn check(written: &Self::Written, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Shape>;
}

/// Where meshes come from.
pub trait Meshes {
    /// Returns the mesh of that path, as the scene's file has it.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    fn mesh(&mut self, path: &str) -> Result<MeshFile, Unfinished<String>>;
}

/// Makes [`WrittenShape`] from the table of surfaces.
macro_rules! written {
    ($($(#[$on:meta])* $group:ident $name:ident: $surface:ident as $kept:ty, $of:literal;)*) => {
        written! { all $($(#[$on])* $surface,)* Mesh, }
    };
    (all $($(#[$on:meta])* $surface:ident,)*) => {
        /// A surface as it is written, or a mesh.
        #[derive(Clone, Debug, PartialEq)]
        pub enum WrittenShape {
            $($(#[$on])* #[doc = concat!("`", stringify!($surface), "(...)`")]
            $surface(<super::$surface as InSceneFile>::Written),)*
        }

        #[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
        impl WrittenShape {
            /// The words that name shapes.
            pub(crate) const NAMES: &'static [&'static str] = &[$($(#[$on])* <super::$surface as InSceneFile>::NAME,)*];

            /// Reads the fields of the shape of that name. Returns them, too, for the object's other fields.
            pub(crate) fn read<'n>(name: &str, reader: &mut NodeReader<'_>, node: &'n SyntaxNode<'n>) -> Option<(Self, Fields<'n>)> {
                $($(#[$on])* if name == super::$surface::NAME {
                    use super::$surface as Surface;
                    let fields = reader.fields(node, Surface::OWNER, Surface::FORM, Surface::FIELDS)?;
                    return Some((Self::$surface(Surface::read(reader, &fields)), fields));
                })*
                None
            }

            /// Returns the shape, if nothing is wrong with it; else faults are added, or were.
            pub(crate) fn check(&self, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Shape> {
                match self {
                    $($(#[$on])* Self::$surface(written) => super::$surface::check(written, validator, meshes),)*
                }
            }

            /// Its name after an article, for messages.
            pub(crate) fn owner(&self) -> &'static str {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::OWNER,)*
                }
            }

            /// The names, after articles, of the surfaces on which patterns can be laid out.
            pub(crate) fn with_coordinates() -> Vec<&'static str> {
                let all = [$($(#[$on])* (super::$surface::HAS_COORDINATES, super::$surface::OWNER),)*];
                all.into_iter().filter_map(|(has_coordinates, owner)| has_coordinates.then_some(owner)).collect()
            }

            /// Whether patterns can be laid out on it.
            pub(crate) fn has_coordinates(&self) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::HAS_COORDINATES,)*
                }
            }

            /// Whether it may bring colours of its own.
            pub(crate) fn brings_colors(&self) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::BRINGS_COLORS,)*
                }
            }
        }
    };
}

surfaces! { written }

/// Makes what is asked of a checked [`Shape`] about its kind from the table of surfaces.
macro_rules! of_kind {
    ($($(#[$on:meta])* $group:ident $name:ident: $surface:ident as $kept:ty, $of:literal;)*) => {
        impl Shape {
            /// Its name after an article, for messages.
            pub(crate) fn owner(&self) -> &'static str {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::OWNER,)*
                    Self::Mesh(_) => super::Mesh::OWNER,
                }
            }

            /// Whether patterns can be laid out on it.
            pub(crate) fn has_coordinates(&self) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::HAS_COORDINATES,)*
                    Self::Mesh(_) => super::Mesh::HAS_COORDINATES,
                }
            }
        }
    };
}

surfaces! { of_kind }

/// The message for a material and its [pattern](crate::material::Reflecting::PATTERN) on a shape without coordinates, each
/// after an article.
pub(crate) fn without_coordinates((material, pattern): (&str, &str), shape: &str) -> String {
    let wanted = text::any_of(&WrittenShape::with_coordinates());
    format!("{material} needs {wanted}, on which {pattern} are laid out; this is {shape}")
}
