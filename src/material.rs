//! Materials: how much of the light that arrives is reflected.
//!
//! All of them reflect diffusely (lecture, "Shading", assumption 3): equally in all directions, so that a point has
//! the same colour from every viewpoint.

use crate::color::LinearRgb;
use crate::shape::SurfacePoint;

/// A diffuse surface, plain or patterned. Reflectances are linear, each band in 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// The same reflectance everywhere.
    Diffuse(LinearRgb),
    /// Squares of two reflectances in turn, laid out on the surface's own coordinates (of a plane).
    Checker {
        /// Reflectance of the square that begins at the pattern's origin, and of every second one from there.
        a: LinearRgb,
        /// Reflectance of the others.
        b: LinearRgb,
        /// A square's side in world units, greater than 0.
        size: f32,
    },
}

impl Material {
    /// What an object is made of when nothing is said: a light grey.
    pub const DEFAULT: Self = Self::Diffuse(LinearRgb::grey(0.8));

    /// The diffuse reflectance at a point of the surface.
    pub fn reflectance(&self, point: &SurfacePoint) -> LinearRgb {
        match *self {
            Self::Diffuse(reflectance) => reflectance,
            Self::Checker { a, b, size } => {
                let square = (point.uv / size).floor();
                if is_even(square.x + square.y) { a } else { b }
            }
        }
    }
}

/// For whole numbers of any size; those above 2^24 are all even in f32.
fn is_even(whole: f32) -> bool {
    let half = whole * 0.5;
    half.floor() == half
}
