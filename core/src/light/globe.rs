//! Spherical lights: luminous balls.

use super::{Falloff, LightSource, PartPosition, PointLight, WrittenPointLight};
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenNumber};
use glam::Vec3;

/// A luminous ball, whose shadows have penumbras.
///
/// A surface that faces it receives as much light as from a [`PointLight`] in its middle. The ball itself is not in
/// the picture; an object of the same place and size does not block its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Globe {
    /// The point source in the middle.
    middle: PointLight,
    /// The radius in world units, greater than 0.
    radius: f32,
}

/// The name of the field `radius` in messages.
const RADIUS: &str = "radius of a light";

impl Globe {
    /// Returns a luminous ball of this radius in world units.
    ///
    /// `intensity` is that of [`PointLight::new`].
    ///
    /// # Errors
    /// If a coordinate is not within ±1e9, the radius not between 1e-9 and 1e9, or a channel of the intensity not
    /// within 0 and 1e12.
    #[doc(hidden)]
    pub fn new(position: Vec3, radius: f32, intensity: LinearRgb) -> Result<Self, SceneFault> {
        let middle = PointLight::new(position, intensity)?;
        let radius = checks::checked_number("radius", radius, |radius| checks::length(RADIUS, radius))?;
        Ok(Self { middle, radius })
    }

    /// Returns the square of the sine, and the cosine, of the angle between the middle and the edge
    /// of the ball, as seen from a distance; 1 and 0 inside the ball.
    #[inline(always)]
    fn edge<N: Number>(&self, distance_squared: N) -> (N, N) {
        let (radius, one) = (N::splat(self.radius), N::splat(1.0));
        let sine_squared = (radius * radius / distance_squared).min(one);
        (sine_squared, (one - sine_squared).sqrt())
    }
}

impl LightSource for Globe {
    fn has_size(&self) -> bool {
        true
    }

    #[inline(always)]
    fn to_light<N: Number>(&self, point: Vector<N>) -> Vector<N> {
        self.middle.to_light(point)
    }

    /// Returns vectors of the length of [`to_light`](Self::to_light), evenly distributed over the
    /// solid angle of the ball.
    #[inline(always)]
    fn to_part<N: Number>(&self, point: Vector<N>, part: &PartPosition<N>) -> Vector<N> {
        let one = N::splat(1.0);
        let middle = self.to_light(point);
        let distance_squared = middle.dot(middle);
        let distance = distance_squared.sqrt();
        let towards = middle * (one / distance);
        // A solid angle is proportional to the height on the sphere (Archimedes), here the cosine.
        // 1 - cos a = sin^2 a / (1 + cos a), which keeps the size of a small ball that is far away.
        let (sine_squared, edge) = self.edge(distance_squared);
        let below_one = part.height * (sine_squared / (one + edge));
        let (cosine, sine) = (one - below_one, (below_one * (N::splat(2.0) - below_one)).sqrt());
        let ([u, v], [a, b]) = (towards.perpendicular_pair(), part.direction);
        let (a, b) = (a * sine, b * sine);
        let direction = towards * cosine + u * a + v * b;
        direction * distance
    }

    /// Returns the part of the way in front of the ball.
    #[inline(always)]
    fn blocking_share<N: Number>(&self, distance: N) -> N {
        // A little less, so that an object in the place of the ball does not block it by rounding. Just outside the
        // ball the way is not 0, because rays need a direction.
        ((N::splat(1.0) - N::splat(self.radius) / distance) * N::splat(0.9999)).max(N::splat(1e-3))
    }

    /// Returns the light of the middle, times 2 / (1 + cos a), where a is the angle between the
    /// middle and the edge of the ball.
    ///
    /// The radiance is intensity / r^2, the solid angle 2 pi (1 - cos a), and r^2 = D^2 (1 - cos^2 a). The mean over
    /// the ball has the factor (1 + cos a) / 2, so that all parts together give what a point source does.
    #[inline(always)]
    fn irradiance_over_pi<N: Number>(&self, l: Vector<N>, distance_squared: N, cosine: N) -> [N; 3] {
        let factor = N::splat(2.0) / (N::splat(1.0) + self.edge(distance_squared).1);
        // Inside the ball the radiance stays that of its surface.
        let distance_squared = distance_squared.max(N::splat(self.radius * self.radius));
        self.middle.irradiance_over_pi(l, distance_squared, cosine * factor)
    }

    fn formula(&self) -> &'static str {
        match self.middle.falloff() {
            Falloff::InverseSquare => "V I max(0, n.l) / D^2",
            Falloff::None => "V I max(0, n.l)",
        }
    }

    fn color(&self) -> LinearRgb {
        self.middle.color()
    }

    fn point_source(&self) -> Option<PointLight> {
        Some(self.middle)
    }

    fn position(&self) -> Option<Vec3> {
        LightSource::position(&self.middle)
    }

    fn moved_to(self, position: Vec3) -> Self {
        Self { middle: self.middle.moved_to(position), ..self }
    }

    fn check(written: &WrittenGlobe, validator: &mut Validator<'_>) -> Option<Self> {
        let middle = PointLight::check(&written.middle, validator);
        let radius = written.radius.and_then(|radius| validator.length(RADIUS, radius));
        Some(Self { middle: middle?, radius: radius? })
    }
}

/// A luminous ball as written: `Globe(position: ..., radius: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenGlobe {
    /// The fields of a point source.
    pub middle: WrittenPointLight,
    /// The radius.
    pub radius: Option<WrittenNumber>,
}

impl InSceneFile for Globe {
    type Written = WrittenGlobe;

    const NAME: &'static str = "Globe";
    const OWNER: &'static str = "a Globe";
    const FORM: &'static str = "Globe(position: ..., radius: ...)";
    const FIELDS: &'static [&'static str] = &["position", "radius", "color", "intensity", "falloff"];
    const SUMMARY: &'static str = "A luminous ball, whose shadows have soft edges.";
    const MEANINGS: &'static [&'static str] = &[
        "the middle of the ball",
        "the radius of the ball",
        "the colour; white",
        "the factor of the colour; 1",
        "InverseSquare, or None for the same light at every distance; InverseSquare",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenGlobe {
        WrittenGlobe {
            middle: PointLight::read(reader, fields),
            radius: reader.required(fields, "radius", NodeReader::number),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
