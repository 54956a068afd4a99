//! Flat lights: luminous rectangles and other parallelograms.

use super::{LightSource, PartPosition, PointLight};
use crate::checks::{self, Message, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::{Number, Vector};
use crate::scene_text::Span;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec3};

/// The least sine of the angle between the edges of a panel.
const MIN_SINE: f64 = 1e-6;

/// A luminous parallelogram, which shines equally bright from all of its points, on both sides.
///
/// A surface far away that faces it, straight in front of it, receives as much light as from a point source of the same
/// intensity. The panel itself is not in the picture; an object of the same place and size does not block its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    middle: Vec3,
    /// The edges.
    edges: [Vec3; 2],
    /// The normal. Unit length.
    normal: Vec3,
    /// The [intensity](Self::new), not negative.
    intensity: LinearRgb,
}

impl Panel {
    /// Returns a panel with a corner and two edges, given as vectors from that corner.
    ///
    /// `intensity` is the radiant intensity along the normal, times 1/pi: the radiance of a white surface that faces
    /// the panel at distance 1, if the panel is small.
    ///
    /// # Errors
    /// If a coordinate is not within ±1e9, the edges have no length or the same direction, or a channel of the
    /// intensity is not within 0 and 1e12.
    #[doc(hidden)]
    pub fn new(corner: Vec3, edges: [Vec3; 2], intensity: LinearRgb) -> Result<Self, SceneFault> {
        let corner = checks::checked_point("corner", corner)?;
        let [a, b] = [checks::checked_point("edge", edges[0])?, checks::checked_point("edge", edges[1])?];
        let intensity = checks::checked_color("intensity", intensity, checks::light)?;
        Self::of(corner.as_dvec3(), [a, b].map(Vec3::as_dvec3), intensity)
            .map_err(|message| SceneFault::new(format!("edges are {a} and {b}"), message))
    }

    fn of(corner: DVec3, [a, b]: [DVec3; 2], intensity: LinearRgb) -> Result<Self, Message> {
        let (normal, lengths) = (a.cross(b), a.length() * b.length());
        // For an edge of length 0 the first comparison is false.
        if normal.length() < MIN_SINE * lengths || lengths < 1e-18 {
            return Err("the edges of a panel must have lengths and different directions".into());
        }
        let middle = corner + (a + b) * 0.5;
        if !checks::is_within_range(middle) {
            return Err("the middle of a panel must lie within ±1e9".into());
        }
        Ok(Self {
            middle: middle.as_vec3(),
            edges: [a.as_vec3(), b.as_vec3()],
            normal: (normal / normal.length()).as_vec3(),
            intensity,
        })
    }
}

impl LightSource for Panel {
    fn has_size(&self) -> bool {
        true
    }

    #[inline(always)]
    fn to_light<N: Number>(&self, point: Vector<N>) -> Vector<N> {
        Vector::splat(self.middle) - point
    }

    #[inline(always)]
    fn to_part<N: Number>(&self, point: Vector<N>, part: &PartPosition<N>) -> Vector<N> {
        let ([x, y], half) = (part.square, N::splat(0.5));
        let [a, b] = [Vector::splat(self.edges[0]), Vector::splat(self.edges[1])];
        self.to_light(point) + (a * (x - half) + b * (y - half))
    }

    /// Returns a part just below 1, so that an object in the same place does not block the light.
    #[inline(always)]
    fn blocking_share<N: Number>(&self, _: N) -> N {
        N::splat(0.9999)
    }

    /// Returns the intensity times m.l n.l / D^2, where m is the panel's normal (Lambert's cosine
    /// law).
    #[inline(always)]
    fn irradiance_over_pi<N: Number>(&self, l: Vector<N>, distance_squared: N, cosine: N) -> [N; 3] {
        let share = Vector::splat(self.normal).dot(l).abs() * cosine / distance_squared;
        let LinearRgb { r, g, b } = self.intensity;
        [N::splat(r) * share, N::splat(g) * share, N::splat(b) * share]
    }

    fn formula(&self) -> &'static str {
        "V I |m.l| max(0, n.l)/D^2"
    }

    fn color(&self) -> LinearRgb {
        self.intensity
    }

    fn point_source(&self) -> Option<PointLight> {
        PointLight::new(self.middle, self.intensity).ok()
    }

    fn position(&self) -> Option<Vec3> {
        Some(self.middle)
    }

    fn moved_to(self, position: Vec3) -> Self {
        checks::checked_point("position", position).map_or(self, |middle| Self { middle, ..self })
    }

    fn check(written: &WrittenPanel, validator: &mut Validator<'_>) -> Option<Self> {
        let corner = written.corner.and_then(|corner| validator.coordinates(corner));
        let intensity = validator.intensity(written.color, written.intensity);
        let (edges, span) = written.edges?;
        let [a, b] = edges.map(|edge| validator.coordinates(edge));
        validator.accept(span, Self::of(corner?, [a?, b?], intensity?))
    }
}

/// A panel as written: `Panel(corner: ..., edges: [..., ...])`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenPanel {
    /// A corner.
    pub corner: Option<WrittenVector>,
    /// The vectors from the corner along the edges, and the span of both.
    pub edges: Option<([WrittenVector; 2], Span)>,
    /// The colour; white if not given.
    pub color: Option<WrittenColor>,
    /// The factor of the colour; 1 if not given.
    pub intensity: Option<WrittenNumber>,
}

impl InSceneFile for Panel {
    type Written = WrittenPanel;

    const NAME: &'static str = "Panel";
    const OWNER: &'static str = "a Panel";
    const FORM: &'static str = "Panel(corner: ..., edges: [..., ...])";
    const FIELDS: &'static [&'static str] = &["corner", "edges", "color", "intensity"];
    const SUMMARY: &'static str = "A luminous parallelogram, whose shadows have soft edges.";
    const MEANINGS: &'static [&'static str] = &[
        "a corner",
        "two vectors from the corner along the edges",
        "the colour; white",
        "the factor of the colour; 1",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenPanel {
        WrittenPanel {
            corner: reader.required(fields, "corner", NodeReader::point),
            edges: reader.required(fields, "edges", NodeReader::two_edges),
            color: reader.optional(fields, "color", NodeReader::color),
            intensity: reader.optional(fields, "intensity", NodeReader::number),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
