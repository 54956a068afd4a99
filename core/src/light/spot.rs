//! Spots: point sources whose light is limited to a cone.

use super::{Falloff, LightSource, PointLight, WrittenPointLight};
use crate::checks::{self, Message, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec3};

/// A point source whose light fades towards the edge of a cone, outside which it is dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    /// The light without the cone.
    source: PointLight,
    /// The direction from the target to the light. Unit length.
    axis: Vec3,
    cone: Cone,
}

/// The cone of a spot.
///
/// The share of the light is a smooth step of the cosine of the angle to the axis.
// Stores 1 minus each cosine, which keeps its precision in a narrow cone, where the cosine is near 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cone {
    /// The angle of the whole cone in degrees.
    degrees: f32,
    /// The share of half the angle over which the light fades.
    softness: f32,
    /// 1 minus the cosine of half the angle.
    outer: f32,
    /// The difference of 1 minus the cosine over which the light fades, up to `outer`.
    fade: f32,
}

impl Cone {
    const DEFAULT_DEGREES: f32 = 40.0;
    const DEFAULT_SOFTNESS: f32 = 0.2;

    /// Returns the cone of an angle whose light fades over a share of half of that angle.
    fn new(degrees: f32, softness: f32) -> Self {
        let half_angle = 0.5 * f64::from(degrees).to_radians();
        // 1 - cos a = 2 sin(a / 2)^2, without the cancellation of the left side.
        let below_one = |angle: f64| {
            let sine = libm::sin(0.5 * angle);
            2.0 * sine * sine
        };
        let (outer, inner) = (below_one(half_angle), below_one(half_angle * (1.0 - f64::from(softness))));
        Self { degrees, softness, outer: outer as f32, fade: (outer - inner) as f32 }
    }
}

impl SpotLight {
    /// Returns a light that shines towards `target`, in a cone of 40 degrees, with inverse square
    /// falloff.
    ///
    /// `intensity` is that of [`PointLight::new`], on the axis of the cone.
    ///
    /// # Errors
    /// If a coordinate is not within ±1e9, the position is the target, or a channel of the intensity is not within 0
    /// and 1e12.
    #[doc(hidden)]
    pub fn new(position: Vec3, target: Vec3, intensity: LinearRgb) -> Result<Self, SceneFault> {
        let source = PointLight::new(position, intensity)?;
        let Vec3 { x, y, z } = checks::checked_point("target", target)?;
        let axis = axis(position.as_dvec3(), target.as_dvec3());
        let axis = axis.map_err(|message| SceneFault::new(format!("target is ({x}, {y}, {z})"), message))?;
        Ok(Self { source, axis, cone: Cone::new(Cone::DEFAULT_DEGREES, Cone::DEFAULT_SOFTNESS) })
    }

    /// Returns the light with another cone.
    ///
    /// `degrees` is the angle of the whole cone, `softness` the share of half that angle over which the light fades.
    ///
    /// # Errors
    /// If the angle is not within 0.001 and 180, or the softness not within 0 and 1.
    #[doc(hidden)]
    pub fn with_cone(self, degrees: f32, softness: f32) -> Result<Self, SceneFault> {
        let degrees = checks::checked_number("angle", degrees, checks::cone_angle)?;
        let softness = checks::checked_number("softness", softness, checks::softness)?;
        Ok(Self { cone: Cone::new(degrees, softness), ..self })
    }

    /// Returns the light with another falloff.
    #[doc(hidden)]
    pub fn with_falloff(self, falloff: Falloff) -> Self {
        Self { source: self.source.with_falloff(falloff), ..self }
    }

    /// Returns the share of the light that the cone lets through.
    ///
    /// `l` is the unit vector to the light.
    #[inline(always)]
    fn share<N: Number>(&self, l: Vector<N>) -> N {
        let (zero, half, one) = (N::splat(0.0), N::splat(0.5), N::splat(1.0));
        let (two, three) = (N::splat(2.0), N::splat(3.0));
        let apart = Vector::splat(self.axis) - l;
        // 1 minus the cosine of the angle between two unit vectors is half the square of their distance.
        let below_one = half * apart.dot(apart);
        // Without softness this divides by 0. The quotient is then infinite, or NaN at the edge itself, for which `max`
        // returns 0.
        let inside = ((N::splat(self.cone.outer) - below_one) / N::splat(self.cone.fade)).max(zero).min(one);
        inside * inside * (three - two * inside)
    }
}

/// Returns the unit vector from the target to the position, rounded once.
fn axis(position: DVec3, target: DVec3) -> Result<Vec3, Message> {
    let away = position - target;
    let length = checks::distance("position", "target", away.length())?;
    Ok((away / length).as_vec3())
}

#[cfg(feature = "ron")]
impl SpotLight {
    /// Returns the unit vector from the target to the position.
    pub(crate) fn axis(&self) -> Vec3 {
        self.axis
    }

    /// Returns the angle of the whole cone in degrees, and its softness.
    pub(crate) fn cone(&self) -> [f32; 2] {
        [self.cone.degrees, self.cone.softness]
    }
}

impl LightSource for SpotLight {
    #[inline(always)]
    fn to_light<N: Number>(&self, point: Vector<N>) -> Vector<N> {
        self.source.to_light(point)
    }

    #[inline(always)]
    fn irradiance_over_pi<N: Number>(&self, l: Vector<N>, distance_squared: N, cosine: N) -> [N; 3] {
        let (zero, share) = (N::splat(0.0), self.share(l));
        let [r, g, b] = self.source.irradiance_over_pi(l, distance_squared, cosine);
        // Selects, because very near the light the irradiance may be infinite, and 0 times infinity is NaN.
        let is_lit = zero.lt(share);
        [N::select(is_lit, r * share, zero), N::select(is_lit, g * share, zero), N::select(is_lit, b * share, zero)]
    }

    #[inline(always)]
    fn shines_along<N: Number>(&self, l: Vector<N>) -> Option<N::Mask> {
        Some(N::splat(0.0).lt(self.share(l)))
    }

    fn formula(&self) -> &'static str {
        match self.source.falloff() {
            Falloff::InverseSquare => "V I S max(0, n.l) / D^2",
            Falloff::None => "V I S max(0, n.l)",
        }
    }

    fn cone_share(&self, l: Vec3) -> Option<f32> {
        Some(self.share(Vector::<f32>::splat(l)))
    }

    fn cone_angle(&self) -> Option<f32> {
        Some(self.cone.degrees)
    }

    fn color(&self) -> LinearRgb {
        self.source.color()
    }

    fn point_source(&self) -> Option<PointLight> {
        Some(self.source)
    }

    fn position(&self) -> Option<Vec3> {
        LightSource::position(&self.source)
    }

    /// Returns the light at another position; the direction of the cone stays.
    fn moved_to(self, position: Vec3) -> Self {
        Self { source: self.source.moved_to(position), ..self }
    }

    fn check(written: &WrittenSpotLight, validator: &mut Validator<'_>) -> Option<Self> {
        let source = PointLight::check(&written.source, validator);
        let target = written.target.and_then(|target| Some((validator.coordinates(target)?, target.span)));
        let degrees = written
            .angle
            .map_or(Some(Cone::DEFAULT_DEGREES), |angle| validator.accept(angle.span, checks::cone_angle(angle.value)));
        let softness = written.softness.map_or(Some(Cone::DEFAULT_SOFTNESS), |softness| {
            validator.accept(softness.span, checks::softness(softness.value))
        });
        let (position, (target, span)) = (written.source.position?.components.map(|number| number.value), target?);
        let source = source?;
        let axis = validator.accept(span, axis(DVec3::from_array(position), target));
        Some(Self { source, axis: axis?, cone: Cone::new(degrees?, softness?) })
    }
}

/// A spot as written: `Spot(position: ..., target: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenSpotLight {
    /// The fields of a point source.
    pub source: WrittenPointLight,
    /// A point on the axis of the cone.
    pub target: Option<WrittenVector>,
    /// The angle of the whole cone in degrees; 40 if not given.
    pub angle: Option<WrittenNumber>,
    /// The share of half the angle over which the light fades; 0.2 if not given.
    pub softness: Option<WrittenNumber>,
}

impl InSceneFile for SpotLight {
    type Written = WrittenSpotLight;

    const NAME: &'static str = "Spot";
    const OWNER: &'static str = "a Spot light";
    const FORM: &'static str = "Spot(position: ..., target: ...)";
    const FIELDS: &'static [&'static str] =
        &["position", "target", "angle", "softness", "color", "intensity", "falloff"];
    const SUMMARY: &'static str = "A point source whose light is limited to a cone.";
    const MEANINGS: &'static [&'static str] = &[
        "the point that the light comes from",
        "a point on the axis of the cone",
        "the angle of the whole cone in degrees, 0.001 to 180; 40",
        "the share of half the angle over which the light fades, 0 to 1; 0.2",
        "the colour; white",
        "the factor of the colour; 1",
        "InverseSquare, or None for the same light at every distance; InverseSquare",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenSpotLight {
        WrittenSpotLight {
            source: PointLight::read(reader, fields),
            target: reader.required(fields, "target", NodeReader::point),
            angle: reader.optional(fields, "angle", NodeReader::number),
            softness: reader.optional(fields, "softness", NodeReader::number),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
