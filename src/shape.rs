//! Surfaces: where a ray crosses them, and what they are like at that point.
//!
//! The lecture's way: a surface is given implicitly by f(x) = 0, and putting the ray's x = p + t d into it leaves one
//! equation in t. Each surface solves its own in a file of its own under `shape/`. To add one, write that file and give
//! [`Shape`] its variant here; for scene files, [`scene_file`](crate::scene_file) reads its fields and
//! [`scene`](crate::scene) checks them.
//!
//! This module knows nothing of materials and light.

use crate::ray::{Interval, Ray};
use glam::{Vec2, Vec3};

pub mod plane;
pub mod sphere;

pub use plane::Plane;
pub use sphere::Sphere;

/// What every surface can answer.
pub trait Surface {
    /// The least t inside the interval at which the ray crosses the surface: a root of f(origin + t direction) = 0.
    fn closest_crossing(&self, ray: &Ray, within: Interval) -> Option<f32>;

    /// The surface at the crossing `t` that [`closest_crossing`](Self::closest_crossing) found for this ray.
    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint;
}

/// A point on a surface, as seen from where the ray came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The lecture's **p**, moved onto the surface as exactly as f32 can say.
    pub position: Vec3,
    /// The normal **n** on the side that the ray came from. Unit length.
    pub normal: Vec3,
    /// Which side of the surface is seen.
    pub side: Side,
    /// How far, along the normal, the true surface may lie from `position`, and as far again as a ray that starts
    /// there needs to be clear of it. In proportion to the coordinates involved; no constant of the scene's size.
    pub clearance: f32,
    /// Coordinates on the surface for a pattern, in world units; zero where the surface has none.
    pub uv: Vec2,
}

impl SurfacePoint {
    /// Where a ray that leaves the surface starts: off it by the clearance, so that the surface does not shadow
    /// itself (after Waechter and Binder, Ray Tracing Gems, chapter 6, and pbrt's `OffsetRayOrigin`: the hit's error
    /// box is left behind, whatever the scale; a fixed epsilon fails in small and in large scenes).
    pub fn ray_origin(&self) -> Vec3 {
        self.position + self.normal * self.clearance
    }
}

/// A surface's two sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side that the surface's own normal points to: the outside of a sphere.
    Front,
    /// The other one: the inside of a sphere.
    Back,
}

/// The relative clearance. The coordinates of a point are off by a few units of 2^-24, and so is what a second ray
/// computes from them; 32 of these units are clear of both (the property tests count false shadows at all scales).
const CLEARANCE: f32 = 32.0 / 16_777_216.0;

/// The largest absolute coordinate.
fn largest_coordinate(v: Vec3) -> f32 {
    v.abs().max_element()
}

/// The enum of all surfaces: a variant for each, which hands every question on to it.
macro_rules! shapes {
    ($($(#[$doc:meta])* $surface:ident,)*) => {
        /// Any of the surfaces.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Shape {
            $($(#[$doc])* $surface($surface),)*
        }

        impl Surface for Shape {
            fn closest_crossing(&self, ray: &Ray, within: Interval) -> Option<f32> {
                match self {
                    $(Self::$surface(surface) => surface.closest_crossing(ray, within),)*
                }
            }

            fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
                match self {
                    $(Self::$surface(surface) => surface.at_crossing(ray, t),)*
                }
            }
        }

        $(impl From<$surface> for Shape {
            fn from(surface: $surface) -> Self {
                Self::$surface(surface)
            }
        })*
    };
}

shapes! {
    /// All points at one distance from a centre.
    Sphere,
    /// All points whose difference to a given one is perpendicular to the normal.
    Plane,
}
