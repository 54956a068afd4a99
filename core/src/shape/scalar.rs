//! [`Scalar`]: a surface of any of the kinds that share one tree.

#[cfg(all(test, unit_tests))]
use super::Cube;
use super::surfaces_in_parts;
use super::{Capsule, Cone, Cuboid, Cylinder, Disk, Ellipsoid, Implicit, Quad, Solid, Surface, SurfacePoint, Torus};
use crate::bounds::Bounds;
use crate::lanes::F32x8;
use crate::ray::{EightRays, Interval, Probe, Ray};

/// Defines [`Scalar`] from the table of surfaces.
macro_rules! scalar {
    (own {$($own:tt)*} shared {$($(#[$on:meta])* $surface:ident, $of:meta;)*}) => {
        /// A surface of any of the kinds that share one tree.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Scalar {
            $(#[$of] $(#[$on])* $surface($surface),)*
        }

        $($(#[$on])* impl From<$surface> for Scalar {
            fn from(surface: $surface) -> Self {
                Self::$surface(surface)
            }
        })*

        impl Surface for Scalar {
            fn bounds(&self) -> Option<Bounds> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.bounds(),)*
                }
            }

            fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.closest_crossing(probe, within),)*
                }
            }

            fn closest_crossings(
                &self,
                rays: &EightRays,
                inside: &[F32x8; 2],
                within: &[F32x8; 2],
            ) -> (u32, F32x8) {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.closest_crossings(rays, inside, within),)*
                }
            }

            fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.at_crossing(ray, t),)*
                }
            }
        }
    };
}

surfaces_in_parts! { scalar }

impl Scalar {
    /// Returns the surface at a time in seconds.
    pub(crate) fn at_time(&self, seconds: f64) -> Self {
        match self {
            Self::Implicit(implicit) => implicit.at_time(seconds).into(),
            Self::Solid(solid) => solid.at_time(seconds).into(),
            other => other.clone(),
        }
    }
}
