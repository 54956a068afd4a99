//! Quads: rectangles and other parallelograms.

use super::described::length_in_words;
use super::exact::{self, Crossing, Crossings, Exact, PlacedBounds};
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Shape, chart, plane};
use crate::formula::Line;
use crate::ray::Ray;
use crate::scene_text::Span;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenVector};
use glam::{DVec3, Vec2, Vec3};

/// The fraction of an edge's length by which a quad is extended beyond each of its sides.
// Without the extension, a ray through a common edge of two quads could miss both, because each quad computes the
// crossing by itself. The fraction is a million times smaller than the rounding of a point to f32.
const OVERLAP: f64 = 1e-13;

/// The least sine of the angle between the edges of a quad.
const MIN_SINE: f64 = 1e-6;

/// A quad: all points x = corner + s a + t b, with s and t from 0 to 1.
///
/// It is visible from both sides.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Quad {
    corner: DVec3,
    edges: [DVec3; 2],
    normal: DVec3,
    /// The vectors whose dot products with the offset of a point from the corner are its s and t.
    shares: [DVec3; 2],
    placed_bounds: PlacedBounds,
}

impl Quad {
    fn new(corner: DVec3, edges: [DVec3; 2]) -> Self {
        let [a, b] = edges;
        let normal = a.cross(b);
        let shares = [b.cross(normal), normal.cross(a)].map(|across| across / normal.dot(normal));
        exact::with_bounds(Self { corner, edges, normal, shares, placed_bounds: PlacedBounds::NONE })
    }
}

impl Exact for Quad {
    fn placed_bounds(&self) -> &PlacedBounds {
        &self.placed_bounds
    }

    fn placed_bounds_mut(&mut self) -> &mut PlacedBounds {
        &mut self.placed_bounds
    }

    fn center(&self) -> DVec3 {
        self.corner + (self.edges[0] + self.edges[1]) * 0.5
    }

    fn reach(&self, direction: DVec3) -> f64 {
        0.5 * self.edges.iter().map(|edge| edge.dot(direction).abs()).sum::<f64>()
    }

    fn crossings(&self, Line { origin, direction }: &Line) -> Crossings {
        let mut crossings = Crossings::NONE;
        let t = -origin.dot(self.normal) / direction.dot(self.normal);
        let at = *origin + *direction * t;
        if t.is_finite() && self.shares.iter().all(|share| share.dot(at).abs() <= 0.5 + OVERLAP) {
            crossings.push(Crossing { t, part: 0 });
        }
        crossings
    }

    fn normal(&self, _: u8, _: DVec3) -> DVec3 {
        self.normal
    }

    fn pattern_origin(&self) -> DVec3 {
        self.corner
    }

    /// Returns axes whose coordinates u and v grow from 0 to an edge's length along that edge.
    fn pattern_axes(&self, _: Vec3) -> Option<[Vec3; 2]> {
        let axis = |at: usize| (self.shares[at] * self.edges[at].length()).as_vec3();
        Some([axis(0), axis(1)])
    }

    /// Returns coordinates with the picture's lower left corner at the corner, and its lower edge
    /// along the first edge.
    fn chart_at(&self, at: DVec3, _: DVec3) -> Option<Vec2> {
        Some(chart::on_face([self.shares[0].dot(at), -self.shares[1].dot(at)]))
    }
}

impl Described for Quad {
    const KIND: &'static str = "quad";

    fn described(&self, color: &str) -> String {
        let [a, b] = self.edges.map(|edge| length_in_words(edge.length()));
        format!("a {color} quad with edges of {a} and {b}") + &self.placed_bounds.scale_in_words()
    }

    /// Solves t = (a - o).n / d.n for the plane of the quad.
    fn equation(&self, ray: &Ray) -> Equation {
        let line = self.placed_bounds.line(ray);
        let mut equation = plane::equation(&line, self.corner, self.normal.normalize());
        if let Some(&t) = equation.roots.first() {
            let from_corner = line.origin + line.direction * t - self.corner;
            let shares = self.shares.map(|share| share.dot(from_corner));
            equation.is_outside = shares.iter().any(|share| !(0.0..=1.0).contains(share));
            equation.steps.push(EquationStep::Values("edges at ", " ", shares.to_vec()));
        }
        equation
    }
}

/// A quad as written: `Quad(corner: ..., edges: [..., ...])`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenQuad {
    corner: Option<WrittenVector>,
    edges: Option<([WrittenVector; 2], Span)>,
}

impl InSceneFile for Quad {
    type Written = WrittenQuad;

    const NAME: &'static str = "Quad";
    const OWNER: &'static str = "a Quad";
    const FORM: &'static str = "Quad(corner: ..., edges: [..., ...])";
    const FIELDS: &'static [&'static str] = &["corner", "edges"];
    const SUMMARY: &'static str = "A parallelogram, seen from both sides.";
    const MEANINGS: &'static [&'static str] = &["a corner", "two vectors from the corner along the edges"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenQuad {
        WrittenQuad {
            corner: reader.required(fields, "corner", NodeReader::point),
            edges: reader.required(fields, "edges", NodeReader::two_edges),
        }
    }
}

impl CheckedShape for Quad {
    const HAS_COORDINATES: bool = true;
    const HAS_INSIDE: bool = false;

    fn check(written: &WrittenQuad, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let corner = written.corner.and_then(|corner| validator.coordinates(corner));
        let ([a, b], span) = written.edges?;
        let edges = [a, b].map(|edge| validator.coordinates(edge));
        let (corner, [Some(a), Some(b)]) = (corner?, edges) else { return None };
        let area = a.cross(b).length();
        // For an edge of length 0 the first comparison is false, so the area must also be at least 1e-18.
        if area < MIN_SINE * a.length() * b.length() || area < 1e-18 {
            let message = "the edges of a quad must have lengths and different directions; no ray would meet it";
            return validator.fault(span, || message.to_owned());
        }
        Some(Self::new(corner, [a, b]).into())
    }
}
