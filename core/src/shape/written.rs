//! The surfaces and meshes of scene files, before they are checked.

use super::placement::{Placeable, Placement, WrittenPlacement};
use super::{Shape, surfaces};
use crate::mesh_file::MeshFile;
use crate::progress::Unfinished;
use crate::scene_text::SyntaxNode;
use crate::text;
use crate::written::{Fields, InSceneFile, NodeReader, ReferenceEntry, Validator};
use std::sync::Arc;

/// A surface in a scene file, and its check.
pub trait CheckedShape: InSceneFile {
    /// Whether the surface has coordinates, on which patterns are laid out.
    const HAS_COORDINATES: bool = false;

    /// Whether the surface has a [chart](super::chart), on which pictures are laid out.
    const HAS_CHART: bool = Self::HAS_COORDINATES;

    /// Whether the surface has an inside, also an endless one, through which glass refracts light.
    const HAS_INSIDE: bool = true;

    /// Returns whether the surface may have its own colours, as meshes have from their files.
    fn brings_colors(_: &Self::Written) -> bool {
        false
    }

    /// Returns the shape, or `None` after a fault has been reported to `validator`.
    fn check(written: &Self::Written, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Shape>;
}

/// A source of meshes by their paths.
pub trait Meshes {
    /// Returns the mesh whose path in a scene file is `path`.
    ///
    /// # Errors
    /// The message for the user, or a cancellation.
    fn mesh(&mut self, path: &str) -> Result<Arc<MeshFile>, Unfinished<String>>;
}

/// The fields of all objects, whatever their shape.
const OF_OBJECTS: [&str; 7] = {
    let [scale, rotate, translate, copies] = WrittenPlacement::FIELDS;
    [scale, rotate, translate, copies, "material", "finish", "opacity"]
};

/// The reference of the fields of all objects.
#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have a reference"))]
pub(crate) const OBJECT_REFERENCE: ReferenceEntry = ReferenceEntry {
    name: "object",
    form: "Sphere(..., material: ..., finish: ...)",
    summary: "Fields of every object, whatever its shape.",
    fields: &OF_OBJECTS,
    meanings: &[
        "a factor, or one along each axis (x, y, z); 1",
        "angles in degrees about x, then y, then z; (0, 0, 0)",
        "a vector by which the object is moved; (0, 0, 0)",
        "rows of copies along the axes, (count: (x, y, z), step: (x, y, z)); one copy",
        "a material, or the name of one in quotes; light grey, or the colours of a mesh's file",
        "a finish; Matte",
        "the part of the light that does not pass straight through, 0 to 1; 1",
    ],
}
.checked();

/// Returns the fields of a shape, followed by those of all objects.
const fn with_those_of_objects<const ALL: usize>(own: &[&'static str]) -> [&'static str; ALL] {
    let (mut all, mut at) = ([""; ALL], 0);
    while at < ALL {
        all[at] = if at < own.len() { own[at] } else { OF_OBJECTS[at - own.len()] };
        at += 1;
    }
    all
}

/// Defines [`WrittenShape`] from the table of surfaces.
macro_rules! written {
    ($($(#[$on:meta])* $surface:ident, $of:meta;)*) => {
        written! { all $($(#[$on])* $surface,)* Mesh, }
    };
    (all $($(#[$on:meta])* $surface:ident,)*) => {
        /// A surface or a mesh in a scene file.
        #[derive(Clone, Debug, PartialEq)]
        pub enum WrittenShape {
            $($(#[$on])* #[doc = concat!("`", stringify!($surface), "(...)`")]
            $surface(<super::$surface as InSceneFile>::Written),)*
        }

        #[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
        impl WrittenShape {
            /// The reference of all shapes.
            pub(crate) const REFERENCE: &'static [ReferenceEntry] =
                &[$($(#[$on])* ReferenceEntry::of::<super::$surface>(),)*];

            /// The names of all shapes.
            pub(crate) const NAMES: &'static [&'static str] = &[$($(#[$on])* <super::$surface as InSceneFile>::NAME,)*];

            /// Reads the fields of the shape called `name`.
            ///
            /// Also returns all fields of the node, which include those of the object, such as its material.
            pub(crate) fn read<'n>(
                name: &str,
                reader: &mut NodeReader<'_>,
                node: &'n SyntaxNode<'n>,
            ) -> Option<(Self, Fields<'n>)> {
                $($(#[$on])* if name == super::$surface::NAME {
                    use super::$surface as Surface;
                    const COUNT: usize = Surface::FIELDS.len() + OF_OBJECTS.len();
                    const FIELDS: [&str; COUNT] = with_those_of_objects(Surface::FIELDS);
                    let fields = reader.fields(node, Surface::OWNER, Surface::FORM, &FIELDS)?;
                    return Some((Self::$surface(Surface::read(reader, &fields)), fields));
                })*
                None
            }

            /// Returns the shape, or `None` after a fault has been reported to `validator`.
            pub(crate) fn check(&self, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Shape> {
                match self {
                    $($(#[$on])* Self::$surface(written) => super::$surface::check(written, validator, meshes),)*
                }
            }

            /// Returns the name of the kind of shape with an article, for messages: "a Sphere".
            pub(crate) fn owner(&self) -> &'static str {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::OWNER,)*
                }
            }

            /// Returns the names, with articles, of surfaces that have coordinates for patterns.
            pub(crate) fn with_coordinates() -> Vec<&'static str> {
                let all = [$($(#[$on])* (super::$surface::HAS_COORDINATES, super::$surface::OWNER),)*];
                all.into_iter().filter_map(|(has_coordinates, owner)| has_coordinates.then_some(owner)).collect()
            }

            /// Returns whether the shape has coordinates for patterns.
            pub(crate) fn has_coordinates(&self) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::HAS_COORDINATES,)*
                }
            }

            /// Returns the names, with articles, of surfaces that have a chart for pictures.
            pub(crate) fn with_chart() -> Vec<&'static str> {
                let all = [$($(#[$on])* (super::$surface::HAS_CHART, super::$surface::OWNER),)*];
                all.into_iter().filter_map(|(has_chart, owner)| has_chart.then_some(owner)).collect()
            }

            /// Returns whether the shape has a chart for pictures.
            pub(crate) fn has_chart(&self) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::HAS_CHART,)*
                }
            }

            /// Returns whether the shape has an inside.
            pub(crate) fn has_inside(&self) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::HAS_INSIDE,)*
                }
            }

            /// Returns whether the shape may have colours of its own.
            pub(crate) fn brings_colors(&self) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(written) => super::$surface::brings_colors(written),)*
                }
            }
        }
    };
}

surfaces! { written }

/// Defines the methods of [`Shape`] that return constants of its kind, from the table of surfaces.
macro_rules! of_kind {
    ($($(#[$on:meta])* $surface:ident, $of:meta;)*) => {
        impl Shape {
            /// Returns the name of the kind of shape with an article, for messages: "a Sphere".
            pub(crate) fn owner(&self) -> &'static str {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::OWNER,)*
                    Self::Mesh(_) => super::Mesh::OWNER,
                }
            }

            /// Returns the placed shape, without the check that rays can be traced to it.
            pub(super) fn placed_anywhere(self, placement: &Placement) -> Option<Self> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.placed(placement),)*
                    Self::Mesh(mesh) => Arc::unwrap_or_clone(mesh).placed(placement),
                }
            }

            /// Returns whether the shape has an inside.
            pub(crate) fn has_inside(&self) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::HAS_INSIDE,)*
                    Self::Mesh(_) => super::Mesh::HAS_INSIDE,
                }
            }

            /// Returns whether the shape has coordinates for patterns.
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

/// Returns the message for glass of a shape without an inside, whose name has an article.
pub(crate) fn without_inside(shape: &str) -> String {
    format!("{shape} has no inside, which Glass needs; use a closed shape, such as a Box")
}

/// Returns the message for a material with a pattern on a shape without coordinates.
///
/// `material` and `shape` are names with an article; `pattern` is the material's
/// [`PATTERN`](crate::material::Reflecting::PATTERN).
pub(crate) fn without_coordinates((material, pattern): (&str, &str), shape: &str) -> String {
    let wanted = text::any_of(&WrittenShape::with_coordinates());
    format!("{material} needs {wanted}, on which {pattern} are laid out; this is {shape}")
}

/// Returns the message for a picture on a shape without a chart, as [`without_coordinates`].
#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have pictures"))]
pub(crate) fn without_chart((material, pattern): (&str, &str), shape: &str) -> String {
    let wanted = text::any_of(&WrittenShape::with_chart());
    format!("{material} needs {wanted}, on which {pattern} are laid out; this is {shape}")
}
