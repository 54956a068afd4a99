//! Light sources.
//!
//! Each kind of light is a file of its own under `light/`. To add one, write that file, with implementations of
//! [`LightSource`] and [`InSceneFile`], and give it a line in the table here.

use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::ray::Interval;
use crate::scene_text::Node;
use crate::written::{InSceneFile, Reader, Validator};
use glam::Vec3;

mod point;
#[cfg(test)]
mod sun;

pub use point::{Falloff, PointLight, WrittenPointLight};
#[cfg(test)]
pub use sun::Sun;

/// What every light can answer.
pub trait LightSource: InSceneFile + Copy {
    /// Where on a ray from a point along [`to_light`](Self::to_light) an object is in the light's way. Not at t = 0: at the
    /// origin of the coordinates a clearance in proportion to them is nothing, and the point lies in its surface exactly.
    const IN_THE_WAY: Interval = Interval { min: f32::MIN_POSITIVE, max: 1.0 };

    /// Returns the vectors from points to the light; of a light that is infinitely far, the unit vector towards it.
    fn to_light<N: Number>(&self, point: Vector<N>) -> Vector<N>;

    /// Returns what arrives at surfaces, times 1/pi: where the unit vector to the light is `l`, the squared length of
    /// [`to_light`](Self::to_light) `distance_squared`, and n.l `cosine`.
    fn irradiance<N: Number>(&self, l: Vector<N>, distance_squared: N, cosine: N) -> [N; 3];

    /// Returns its colour, as bright as it likes.
    fn color(&self) -> LinearRgb;

    /// Returns where it is, in world space; nothing if it is infinitely far.
    fn position(&self) -> Option<Vec3> {
        None
    }

    /// Returns the light at another place, if it has one; where no light can be, it stays.
    #[must_use]
    fn moved_to(self, _position: Vec3) -> Self {
        self
    }

    /// Returns the light, if nothing is wrong with it; else faults are added, or were.
    fn check(written: &Self::Written, validator: &mut Validator<'_>) -> Option<Self>;
}

/// Makes [`Light`] and [`WrittenLight`] from the table of lights.
macro_rules! lights {
    ($($(#[$on:meta])* $name:ident: $light:ident, $of:literal;)*) => {
        /// Any of the lights. It hands every question on to [`LightSource`].
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Light {
            $(#[doc = $of] $(#[$on])* $name($light),)*
        }

        impl Light {
            /// [`LightSource::IN_THE_WAY`].
            #[doc(hidden)]
            pub fn in_the_way(&self) -> Interval {
                match self {
                    $($(#[$on])* Self::$name(_) => $light::IN_THE_WAY,)*
                }
            }

            /// [`LightSource::to_light`].
            #[doc(hidden)]
            #[inline(always)]
            pub fn to_light<N: Number>(&self, point: Vector<N>) -> Vector<N> {
                match self {
                    $($(#[$on])* Self::$name(light) => light.to_light(point),)*
                }
            }

            /// [`LightSource::irradiance`].
            #[doc(hidden)]
            #[inline(always)]
            pub fn irradiance<N: Number>(&self, l: Vector<N>, distance_squared: N, cosine: N) -> [N; 3] {
                match self {
                    $($(#[$on])* Self::$name(light) => light.irradiance(l, distance_squared, cosine),)*
                }
            }

            /// [`LightSource::color`].
            #[doc(hidden)]
            pub fn color(&self) -> LinearRgb {
                match self {
                    $($(#[$on])* Self::$name(light) => light.color(),)*
                }
            }

            /// [`LightSource::position`].
            #[doc(hidden)]
            pub fn position(&self) -> Option<Vec3> {
                match self {
                    $($(#[$on])* Self::$name(light) => LightSource::position(light),)*
                }
            }

            /// [`LightSource::moved_to`].
            #[doc(hidden)]
            #[must_use]
            pub fn moved_to(self, position: Vec3) -> Self {
                match self {
                    $($(#[$on])* Self::$name(light) => light.moved_to(position).into(),)*
                }
            }
        }

        $($(#[$on])* impl From<$light> for Light {
            fn from(light: $light) -> Self {
                Self::$name(light)
            }
        })*

        /// A light as it is written.
        #[derive(Clone, Debug, PartialEq)]
        pub enum WrittenLight {
            $(#[doc = $of] $(#[$on])* $name(<$light as InSceneFile>::Written),)*
        }

        #[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
        impl WrittenLight {
            /// The words that name lights.
            pub(crate) const NAMES: &'static [&'static str] = &[$($(#[$on])* $light::NAME,)*];

            /// Reads the light of that name.
            pub(crate) fn read(name: &str, reader: &mut Reader<'_>, node: &Node<'_>) -> Option<Self> {
                $($(#[$on])* if name == $light::NAME {
                    return $light::read_node(reader, node).map(Self::$name);
                })*
                None
            }

            /// Returns the light, if nothing is wrong with it; else faults are added, or were.
            pub(crate) fn check(&self, validator: &mut Validator<'_>) -> Option<Light> {
                match self {
                    $($(#[$on])* Self::$name(written) => $light::check(written, validator).map(Light::from),)*
                }
            }
        }
    };
}

lights! {
    Point: PointLight, "A point source.";
    #[cfg(test)]
    Sun: Sun, "Light from infinitely far.";
}
