//! Surfaces in the text of descriptions and explanations.

use super::placement::Placeable;
use super::{Equation, EquationStep, Primitive, Shape, Surface, surfaces};
use crate::bounds::Bounds;
use crate::ray::Ray;
use crate::text::number;
use glam::Vec3;

/// A surface that can be described in words, and whose equation for crossings can be shown.
pub trait Described {
    /// The name of the surface's kind: "sphere".
    const KIND: &'static str;

    /// Returns a noun phrase for the surface in a colour: "a red sphere of radius 1".
    fn described(&self, color: &str) -> String;

    /// Returns the equation of the lecture whose roots are the crossings of the ray.
    fn equation(&self, ray: &Ray) -> Equation;

    /// Returns whether the point lies inside the surface.
    ///
    /// False for surfaces that enclose no volume.
    fn encloses(&self, _point: Vec3) -> bool {
        false
    }

    /// Returns the centre and radius if the outline is a circle from every direction, as a sphere's
    /// is.
    fn silhouette_sphere(&self) -> Option<(Vec3, f32)> {
        None
    }
}

/// Implements methods of [`Shape`] and [`Primitive`] that call those of the variant's surface.
macro_rules! described {
    ($($(#[$on:meta])* $surface:ident, $of:meta;)*) => {
        impl Shape {
            /// Returns the name of the shape's kind: "sphere".
            #[doc(hidden)]
            pub fn kind(&self) -> &'static str {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::KIND,)*
                    Self::Mesh(_) => "mesh",
                }
            }

            /// Returns a noun phrase for the shape in a colour: "a red sphere of radius 1".
            #[doc(hidden)]
            pub fn described(&self, color: &str) -> String {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.described(color),)*
                    Self::Mesh(mesh) => {
                        let (count, size) = (mesh.triangle_count(), size_in_words(mesh.bounds()));
                        let motion = mesh.motion_length().map_or_else(String::new, |seconds| {
                            format!(", which moves in an animation of {} s", length_in_words(seconds))
                        });
                        format!("a {color} mesh of {count} triangles, {size}{motion}")
                    }
                }
            }

            /// Returns whether the point lies inside the shape.
            ///
            /// False for meshes, which need not be closed.
            #[doc(hidden)]
            pub fn encloses(&self, point: Vec3) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.encloses(point),)*
                    Self::Mesh(_) => false,
                }
            }

            /// Returns the smallest box around the shape, or `None` if it is unbounded.
            #[doc(hidden)]
            pub fn bounds(&self) -> Option<Bounds> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.bounds(),)*
                    Self::Mesh(mesh) => Some(*mesh.bounds()),
                }
            }
        }

        impl Primitive<'_> {
            /// Returns the equation of the lecture whose roots are the crossings of the ray.
            pub fn equation(&self, ray: &Ray) -> Equation {
                let (mut equation, has_map) = match self {
                    $($(#[$on])* Self::$surface(surface) => (surface.equation(ray), surface.has_map()),)*
                    Self::Facet(facet) => (facet.triangle().equation(ray), false),
                };
                if has_map {
                    equation.steps.insert(0, EquationStep::Text("o, d in coordinates of the shape:"));
                }
                equation
            }

            /// Returns the centre and radius if the outline is a circle from every direction, as a
            /// sphere's is.
            pub fn silhouette_sphere(&self) -> Option<(Vec3, f32)> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.silhouette_sphere(),)*
                    Self::Facet(facet) => facet.triangle().silhouette_sphere(),
                }
            }
        }
    };
}

surfaces! { described }

/// Returns the size of a box along each axis, in words.
pub(super) fn size_in_words(bounds: &Bounds) -> String {
    let [wide, high, deep] = bounds.extent().to_array().map(|side| length_in_words(side.into()));
    format!("{wide} wide, {high} high, {deep} deep")
}

/// Returns a length as text for prose: rounded, and without an exponent.
pub(super) fn length_in_words(length: f64) -> String {
    // Formatted again as f64 by the standard library, which writes no exponents.
    number(length as f32).parse().unwrap_or(length).to_string()
}
