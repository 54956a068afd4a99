//! How surfaces are spoken of: in descriptions and explanations.

use super::{Equation, Mesh, Primitive, Shape, Surface, surfaces};
use crate::bounds::Bounds;
use crate::ray::Ray;
use crate::text::number;
use glam::Vec3;

/// What is said of a surface.
pub trait Described {
    /// What it is called: "sphere".
    const KIND: &'static str;

    /// Returns what it is, in that colour: "a red sphere of radius 1".
    fn described(&self, color: &str) -> String;

    /// Returns the lecture's equation for the ray.
    fn equation(&self, ray: &Ray) -> Equation;

    /// Returns whether the point lies inside it; nothing is inside a surface that encloses nothing.
    fn encloses(&self, _point: Vec3) -> bool {
        false
    }

    /// Returns the centre and radius of the circle that it is seen as from each side, if it is.
    fn circle(&self) -> Option<(Vec3, f32)> {
        None
    }
}

/// Hands what is asked of shapes and parts on to each surface of the table.
macro_rules! described {
    ($($(#[$on:meta])* $group:ident $name:ident: $surface:ident as $kept:ty, $of:literal;)*) => {
        impl Shape {
            /// What it is called: "sphere".
            #[doc(hidden)]
            pub fn kind(&self) -> &'static str {
                match self {
                    $($(#[$on])* Self::$surface(_) => super::$surface::KIND,)*
                    Self::Mesh(_) => "mesh",
                }
            }

            /// Returns what it is, in that colour: "a red sphere of radius 1".
            #[doc(hidden)]
            pub fn described(&self, color: &str) -> String {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.described(color),)*
                    Self::Mesh(mesh) => {
                        format!("a {color} mesh of {} triangles, {}", mesh.triangle_count(), sides(&whole(mesh)))
                    }
                }
            }

            /// Returns whether the point lies inside it; a mesh need not be closed, and encloses nothing.
            #[doc(hidden)]
            pub fn encloses(&self, point: Vec3) -> bool {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.encloses(point),)*
                    Self::Mesh(_) => false,
                }
            }

            /// Returns the smallest box around it; nothing where it has no end.
            #[doc(hidden)]
            pub fn bounds(&self) -> Option<Bounds> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.bounds(),)*
                    Self::Mesh(mesh) => Some(whole(mesh)),
                }
            }
        }

        impl Primitive<'_> {
            /// Returns the lecture's equation for the ray.
            pub fn equation(&self, ray: &Ray) -> Equation {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.equation(ray),)*
                    Self::Facet(facet) => facet.triangle().equation(ray),
                }
            }

            /// Returns the centre and radius of the circle that it is seen as from each side, if it is.
            pub fn circle(&self) -> Option<(Vec3, f32)> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.circle(),)*
                    Self::Facet(facet) => facet.triangle().circle(),
                }
            }
        }
    };
}

surfaces! { described }

fn whole(mesh: &Mesh) -> Bounds {
    Bounds::of(mesh.file().positions().iter().copied())
}

/// Returns how long a box is along each axis, in words.
pub(super) fn sides(bounds: &Bounds) -> String {
    let Vec3 { x, y, z } = bounds.extent();
    format!("{} by {} by {} in x, y and z", number(x), number(y), number(z))
}
