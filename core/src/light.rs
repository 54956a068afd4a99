//! Light sources.
//!
//! Each kind of light is a file under `light/`. To add one, write that file with implementations of [`LightSource`] and
//! [`InSceneFile`], and add a line to the table `lights` here.

use crate::color::LinearRgb;
use crate::lanes::{F32x8, Number, Vector};
use crate::ray::Interval;
use crate::scene_text::SyntaxNode;
use crate::written::{InSceneFile, NodeReader, ReferenceEntry, Validator};
use glam::Vec3;

mod globe;
mod panel;
mod point;
mod spot;
mod sun;

pub use globe::{Globe, WrittenGlobe};
pub use panel::{Panel, WrittenPanel};
pub use point::{Falloff, PointLight, WrittenPointLight};
pub use spot::{SpotLight, WrittenSpotLight};
pub use sun::{Sun, WrittenSun};

/// The number of parts of a light with a size.
// Sixteen shadow rays leave steps of 6 % of the light in a penumbra: about the contrast from which on a pixel gets more
// samples, which make the steps finer.
pub(crate) const PARTS: u32 = 16;

/// The position of a part on a light, by which each kind of light places its parts.
#[derive(Clone, Copy, Debug)]
pub struct PartPosition<N> {
    /// The coordinates in the unit square.
    pub square: [N; 2],
    /// A unit vector in a plane.
    pub direction: [N; 2],
    /// A number from 0 to 1, evenly distributed for each direction.
    pub height: N,
}

impl PartPosition<F32x8> {
    /// Returns the position in one lane.
    pub(crate) fn of_lane(&self, lane: usize) -> PartPosition<f32> {
        let Self { square: [x, y], direction: [a, b], height } = self;
        PartPosition { square: [x.0[lane], y.0[lane]], direction: [a.0[lane], b.0[lane]], height: height.0[lane] }
    }
}

/// A kind of light source.
pub trait LightSource: InSceneFile + Copy {
    /// The interval of a shadow ray's t in which an object blocks the light.
    // Excludes t = 0: a ray's origin is offset from its surface in proportion to the coordinates, so that at the origin
    // of the world the ray starts exactly on the surface.
    const BLOCKING_INTERVAL: Interval = Interval { min: f32::MIN_POSITIVE, max: 1.0 };

    /// Returns the vectors from points to the light; for a light at infinity, the unit vector
    /// towards it.
    fn to_light<N: Number>(&self, point: Vector<N>) -> Vector<N>;

    /// Returns 1/pi times the irradiance at surface points, per channel.
    ///
    /// `l` is the unit vector to the light, `distance_squared` the squared length of [`to_light`](Self::to_light),
    /// `cosine` is n.l.
    // The result includes the factor 1/pi of diffuse reflection, so that no later step needs pi.
    fn irradiance_over_pi<N: Number>(&self, l: Vector<N>, distance_squared: N, cosine: N) -> [N; 3];

    /// Returns the mask of the directions in which the light shines; `None` if it shines in all.
    ///
    /// `l` is the unit vector to the light.
    #[inline(always)]
    fn shines_along<N: Number>(&self, _l: Vector<N>) -> Option<N::Mask> {
        None
    }

    /// Returns whether the light has a size, so that its shadows have penumbras.
    fn has_size(&self) -> bool {
        false
    }

    /// Returns the vectors from points to a part of the light.
    ///
    /// Each of the 16 parts gives an equal share of [`irradiance_over_pi`](Self::irradiance_over_pi) at its vector.
    #[inline(always)]
    fn to_part<N: Number>(&self, point: Vector<N>, _part: &PartPosition<N>) -> Vector<N> {
        self.to_light(point)
    }

    /// Returns the part of the way to a part of the light on which an object blocks it, from 0 to
    /// 1.
    ///
    /// `distance` is the length of [`to_part`](Self::to_part).
    #[inline(always)]
    fn blocking_share<N: Number>(&self, _distance: N) -> N {
        N::splat(1.0)
    }

    /// Returns the formula of the [irradiance over pi](Self::irradiance_over_pi), for explanations.
    ///
    /// V is the visibility, I the [`color`](Self::color), D the distance and S the [share](Self::cone_share).
    fn formula(&self) -> &'static str {
        "V I max(0, n.l)"
    }

    /// Returns the share of the light that a spot's cone lets through in a direction.
    ///
    /// `l` is the unit vector to the light. `None` for a light without a cone.
    fn cone_share(&self, _l: Vec3) -> Option<f32> {
        None
    }

    /// Returns the angle of the cone in degrees; `None` for a light without a cone.
    fn cone_angle(&self) -> Option<f32> {
        None
    }

    /// Returns the light's colour, multiplied by its intensity.
    fn color(&self) -> LinearRgb;

    /// Returns the position in world space; `None` for a light at infinity.
    fn position(&self) -> Option<Vec3> {
        None
    }

    /// Returns the point source that the light is in the lecture's model; `None` for one at
    /// infinity.
    fn point_source(&self) -> Option<PointLight> {
        None
    }

    /// Returns the light without its size, if it is at infinity.
    #[must_use]
    fn without_size(self) -> Self {
        self
    }

    /// Returns the light at another position; unchanged if it is at infinity or the position is
    /// invalid.
    #[must_use]
    fn moved_to(self, _position: Vec3) -> Self {
        self
    }

    /// Returns the checked light, or `None` after a fault has been reported to `validator`.
    fn check(written: &Self::Written, validator: &mut Validator<'_>) -> Option<Self>;
}

/// Defines [`Light`] and [`WrittenLight`] from the table of lights.
macro_rules! lights {
    ($($(#[$attribute:meta])* $name:ident: $light:ident, $of:literal;)*) => {
        /// A light source of any kind.
        // `Light` is an enum, not a trait object, because its methods are generic over the lanes and inlined into the
        // kernels.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Light {
            $(#[doc = $of] $(#[$attribute])* $name($light),)*
        }

        impl Light {
            /// Returns the interval of a shadow ray's t in which an object blocks the light, by
            /// [`LightSource::BLOCKING_INTERVAL`].
            #[doc(hidden)]
            pub fn blocking_interval(&self) -> Interval {
                match self {
                    $(Self::$name(_) => $light::BLOCKING_INTERVAL,)*
                }
            }

            /// Returns the vectors from points to the light, by [`LightSource::to_light`].
            #[doc(hidden)]
            #[inline(always)]
            pub fn to_light<N: Number>(&self, point: Vector<N>) -> Vector<N> {
                match self {
                    $(Self::$name(light) => light.to_light(point),)*
                }
            }

            /// Returns 1/pi times the irradiance at surface points.
            ///
            /// It is computed by [`LightSource::irradiance_over_pi`].
            #[doc(hidden)]
            #[inline(always)]
            pub fn irradiance_over_pi<N: Number>(&self, l: Vector<N>, distance_squared: N, cosine: N) -> [N; 3] {
                match self {
                    $(Self::$name(light) => light.irradiance_over_pi(l, distance_squared, cosine),)*
                }
            }

            /// Returns the mask of the directions in which the light shines, by
            /// [`LightSource::shines_along`].
            #[inline(always)]
            pub(crate) fn shines_along<N: Number>(&self, l: Vector<N>) -> Option<N::Mask> {
                match self {
                    $(Self::$name(light) => light.shines_along(l),)*
                }
            }

            /// Returns whether the light has a size, by [`LightSource::has_size`].
            #[doc(hidden)]
            pub fn has_size(&self) -> bool {
                match self {
                    $(Self::$name(light) => LightSource::has_size(light),)*
                }
            }

            /// Returns the vectors to a part of the light, by [`LightSource::to_part`].
            #[inline(always)]
            pub(crate) fn to_part<N: Number>(self, point: Vector<N>, part: &PartPosition<N>) -> Vector<N> {
                match self {
                    $(Self::$name(light) => light.to_part(point, part),)*
                }
            }

            /// Returns the part of the way on which an object blocks the light, by
            /// [`LightSource::blocking_share`].
            #[inline(always)]
            pub(crate) fn blocking_share<N: Number>(&self, distance: N) -> N {
                match self {
                    $(Self::$name(light) => light.blocking_share(distance),)*
                }
            }

            /// Returns the formula of the arriving light, by [`LightSource::formula`].
            pub(crate) fn formula(&self) -> &'static str {
                match self {
                    $(Self::$name(light) => light.formula(),)*
                }
            }

            /// Returns the share of the light in a direction, by [`LightSource::cone_share`].
            pub(crate) fn cone_share(&self, l: Vec3) -> Option<f32> {
                match self {
                    $(Self::$name(light) => light.cone_share(l),)*
                }
            }

            /// Returns the angle of the cone in degrees, by [`LightSource::cone_angle`].
            pub(crate) fn cone_angle(&self) -> Option<f32> {
                match self {
                    $(Self::$name(light) => light.cone_angle(),)*
                }
            }

            /// Returns the light's colour with its intensity, by [`LightSource::color`].
            #[doc(hidden)]
            pub fn color(&self) -> LinearRgb {
                match self {
                    $(Self::$name(light) => light.color(),)*
                }
            }

            /// Returns the position, or `None` at infinity, by [`LightSource::position`].
            #[doc(hidden)]
            pub fn position(&self) -> Option<Vec3> {
                match self {
                    $(Self::$name(light) => LightSource::position(light),)*
                }
            }

            /// Returns the light as it is in the lecture's model, by [`LightSource::point_source`]
            /// or [`LightSource::without_size`].
            pub(crate) fn as_in_lecture(&self) -> Self {
                match self {
                    $(Self::$name(light) => {
                        light.point_source().map_or_else(|| light.without_size().into(), Self::from)
                    })*
                }
            }

            /// Returns the light at another position, by [`LightSource::moved_to`].
            #[doc(hidden)]
            #[must_use]
            pub fn moved_to(self, position: Vec3) -> Self {
                match self {
                    $(Self::$name(light) => light.moved_to(position).into(),)*
                }
            }
        }

        $(impl From<$light> for Light {
            fn from(light: $light) -> Self {
                Self::$name(light)
            }
        })*

        /// A light as written in a scene file.
        #[derive(Clone, Debug, PartialEq)]
        pub enum WrittenLight {
            $(#[doc = $of] $name(<$light as InSceneFile>::Written),)*
        }

        #[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written values"))]
        impl WrittenLight {
            /// The reference of all lights.
            pub(crate) const REFERENCE: &'static [ReferenceEntry] = &[$(ReferenceEntry::of::<$light>(),)*];

            /// The names of all lights in scene files.
            pub(crate) const NAMES: &'static [&'static str] = &[$($light::NAME,)*];

            /// Reads the light called `name`; `None` if it is unknown or `node` has no fields.
            pub(crate) fn read(name: &str, reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self> {
                $(if name == $light::NAME {
                    return $light::read_node(reader, node).map(Self::$name);
                })*
                None
            }

            /// Returns the checked light, or `None` after a fault has been reported to `validator`.
            pub(crate) fn check(&self, validator: &mut Validator<'_>) -> Option<Light> {
                match self {
                    $(Self::$name(written) => $light::check(written, validator).map(Light::from),)*
                }
            }
        }
    };
}

lights! {
    Point: PointLight, "A point source.";
    #[doc(hidden)]
    Sun: Sun, "Light from infinitely far.";
    #[doc(hidden)]
    Spot: SpotLight, "A point source with a cone of light.";
    #[doc(hidden)]
    Globe: Globe, "A luminous ball.";
    #[doc(hidden)]
    Panel: Panel, "A luminous parallelogram.";
}
