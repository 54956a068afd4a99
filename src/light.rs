//! Light sources.
//!
//! All light starts from point sources (lecture, "Shading", assumptions 1 and 2): very small, and alike in all
//! directions.

use crate::color::LinearRgb;
use glam::Vec3;

/// A point source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Where it is, in world space.
    pub position: Vec3,
    /// Radiant intensity times 1/pi (the diffuse reflection's constant is folded in): a white surface that faces
    /// the light at distance 1 has this radiance. Not negative.
    pub intensity: LinearRgb,
    /// How the light grows weaker.
    pub falloff: Falloff,
}

/// How a light grows weaker with the distance d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Falloff {
    /// By 1 / d^2, as light does.
    #[default]
    InverseSquare,
    /// Not at all: the same at every distance, the lecture's simplest picture.
    None,
}
