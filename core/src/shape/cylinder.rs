//! Cylinders, with caps or open.

use super::described::length_in_words;
use super::exact::{self, Crossings, Exact, Inside, PlacedBounds, reach_of_circle};
use super::plane::pattern_axis;
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Shape, chart};
use crate::formula::Line;
use crate::ray::Ray;
use crate::written::{Axis, Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec2, Vec3};

/// The parts of a cylinder or cone: the side, and the caps at both ends.
pub(super) const SIDE: u8 = 0;
pub(super) const CAPS: [u8; 2] = [1, 2];

/// A cylinder: all points x at one distance r from an axis a, between two caps.
///
/// |x|^2 - (x.a)^2 = r^2.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Cylinder {
    axis: Axis,
    radius: f64,
    /// Whether the cylinder has no caps.
    open: bool,
    placed_bounds: PlacedBounds,
}

impl Cylinder {
    fn new(axis: Axis, radius: f64, open: bool) -> Self {
        exact::with_bounds(Self { axis, radius, open, placed_bounds: PlacedBounds::NONE })
    }

    /// Returns whether the shape has no caps, so that it encloses nothing.
    pub(super) fn is_open(&self) -> bool {
        self.open
    }
}

impl Axis {
    /// Returns the largest dot product of a vector and a point of the circles about both ends.
    pub(super) fn reach_of_circles(&self, radii: [f64; 2], direction: DVec3) -> f64 {
        let (along, circle) = (direction.dot(self.direction), reach_of_circle(self.direction, direction));
        (radii[0] * circle - along * self.half_length).max(radii[1] * circle + along * self.half_length)
    }

    /// Returns the part of a line between the planes of both ends.
    pub(super) fn slab(&self, line: &Line, parts: [u8; 2]) -> Inside {
        let [along, change] = [line.origin, line.direction].map(|vector| vector.dot(self.direction));
        Inside::slab(along, change, [-self.half_length, self.half_length], parts)
    }

    /// Returns the part of a vector that is perpendicular to the axis.
    pub(super) fn across(&self, vector: DVec3) -> DVec3 {
        vector - self.direction * vector.dot(self.direction)
    }

    /// Returns the outward normal of a cap.
    pub(super) fn normal_of_cap(&self, part: u8) -> DVec3 {
        if part == CAPS[0] { -self.direction } else { self.direction }
    }

    /// Returns a line relative to the end `from`.
    pub(super) fn relative_to_start(&self, line: Line) -> Line {
        Line { origin: line.origin - (self.middle + self.end_offsets()[0]), ..line }
    }
}

impl Exact for Cylinder {
    fn placed_bounds(&self) -> &PlacedBounds {
        &self.placed_bounds
    }

    fn placed_bounds_mut(&mut self) -> &mut PlacedBounds {
        &mut self.placed_bounds
    }

    fn center(&self) -> DVec3 {
        self.axis.middle
    }

    fn reach(&self, direction: DVec3) -> f64 {
        self.axis.reach_of_circles([self.radius; 2], direction)
    }

    fn crossings(&self, line: &Line) -> Crossings {
        let [origin, direction] = [line.origin, line.direction].map(|vector| self.axis.across(vector));
        let (side, between) = (Inside::ball(origin, direction, self.radius), self.axis.slab(line, CAPS));
        if self.open { side.crossings_within(&between) } else { side.and(between).crossings() }
    }

    fn normal(&self, part: u8, at: DVec3) -> DVec3 {
        if part == SIDE { self.axis.across(at) } else { self.axis.normal_of_cap(part) }
    }

    /// Returns coordinates with the picture once around the side, its upper edge at the end `to`,
    /// and on each cap in the square around it.
    fn chart_at(&self, at: DVec3, normal: DVec3) -> Option<Vec2> {
        let (axis, along) = (self.axis.direction, at.dot(self.axis.direction));
        let right = pattern_axis(axis.as_vec3()).as_dvec3();
        let (right, front) = (at.dot(right), at.dot(right.cross(axis)));
        if normal.dot(axis).abs() > 0.5 {
            let down = if along < 0.0 { -front } else { front };
            return Some(chart::on_face([right, down].map(|across| across / (2.0 * self.radius))));
        }
        let down = 0.5 - 0.5 * along / self.axis.half_length;
        Some(Vec2::new(chart::around(right, front), down as f32))
    }
}

impl Described for Cylinder {
    const KIND: &'static str = "cylinder";

    fn described(&self, color: &str) -> String {
        let [radius, length] = [self.radius, 2.0 * self.axis.half_length].map(length_in_words);
        format!("a {color} {}cylinder of radius {radius} and length {length}", if self.open { "open " } else { "" })
            + &self.placed_bounds.scale_in_words()
    }

    /// Solves A t^2 + 2 B t + C = 0 for the infinite cylinder, with x relative to the end `from`.
    fn equation(&self, ray: &Ray) -> Equation {
        let line = self.axis.relative_to_start(self.placed_bounds.line(ray));
        let [o, d] = [line.origin, line.direction].map(|vector| self.axis.across(vector));
        let steps = vec![
            EquationStep::Text("|x|^2 - (x.a)^2 - r^2 = 0"),
            EquationStep::Text("x = o + t d - from, a its axis"),
            EquationStep::Text("A t^2 + 2 B t + C = 0"),
            EquationStep::Value("A = d.d - (d.a)^2", d.dot(d)),
            EquationStep::Value("B", o.dot(d)),
            EquationStep::Value("C", o.dot(o) - self.radius * self.radius),
            EquationStep::Text("and 0 <= x.a <= length"),
        ];
        exact::equation(self, ray, steps)
    }

    fn encloses(&self, point: Vec3) -> bool {
        let from_middle = self.placed_bounds.scene_to_shape(point) - self.axis.middle;
        let is_between = from_middle.dot(self.axis.direction).abs() < self.axis.half_length;
        !self.open && is_between && self.axis.across(from_middle).length() < self.radius
    }
}

/// A cylinder as written: `Cylinder(from: ..., to: ..., radius: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenCylinder {
    ends: [Option<WrittenVector>; 2],
    radius: Option<WrittenNumber>,
    open: Option<bool>,
}

impl InSceneFile for Cylinder {
    type Written = WrittenCylinder;

    const NAME: &'static str = "Cylinder";
    const OWNER: &'static str = "a Cylinder";
    const FORM: &'static str = "Cylinder(from: ..., to: ..., radius: ...)";
    const FIELDS: &'static [&'static str] = &["from", "to", "radius", "open"];
    const SUMMARY: &'static str = "A cylinder between two points.";
    const MEANINGS: &'static [&'static str] =
        &["the middle of one end", "the middle of the other end", "the radius", "true leaves out both caps; false"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenCylinder {
        WrittenCylinder {
            ends: ["from", "to"].map(|end| reader.required(fields, end, NodeReader::point)),
            radius: reader.required(fields, "radius", NodeReader::number),
            open: reader.optional(fields, "open", NodeReader::boolean),
        }
    }
}

impl CheckedShape for Cylinder {
    const HAS_CHART: bool = true;

    fn check(written: &WrittenCylinder, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let axis = validator.axis(written.ends);
        let radius = written.radius.and_then(|radius| validator.length("radius", radius));
        Some(Self::new(axis?, radius?.into(), written.open == Some(true)).into())
    }
}
