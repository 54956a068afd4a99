//! Capsules: cylinders with round ends.

use super::described::length_in_words;
use super::exact::{self, Crossings, Exact, Inside, PlacedBounds};
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Shape};
use crate::formula::Line;
use crate::ray::Ray;
use crate::written::{Axis, Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec3};

/// A capsule: all points at one distance from a segment.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Capsule {
    axis: Axis,
    radius: f64,
    placed_bounds: PlacedBounds,
}

impl Capsule {
    fn new(axis: Axis, radius: f64) -> Self {
        exact::with_bounds(Self { axis, radius, placed_bounds: PlacedBounds::NONE })
    }

    /// Returns the vector to a point from the nearest point of the segment.
    fn outward(&self, at: DVec3) -> DVec3 {
        let Axis { direction, half_length, .. } = self.axis;
        at - direction * at.dot(direction).clamp(-half_length, half_length)
    }
}

impl Exact for Capsule {
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
        self.axis.half_length * direction.dot(self.axis.direction).abs() + self.radius * direction.length()
    }

    /// Joins the parts of the line in the cylinder and in the balls at both ends.
    ///
    /// They form one interval, because a capsule is convex.
    fn crossings(&self, line: &Line) -> Crossings {
        let [origin, direction] = [line.origin, line.direction].map(|vector| self.axis.across(vector));
        let middle = Inside::ball(origin, direction, self.radius).and(self.axis.slab(line, [0; 2]));
        let [from, to] =
            self.axis.end_offsets().map(|end| Inside::ball(line.origin - end, line.direction, self.radius));
        middle.around(from).around(to).crossings()
    }

    fn normal(&self, _: u8, at: DVec3) -> DVec3 {
        self.outward(at)
    }
}

impl Described for Capsule {
    const KIND: &'static str = "capsule";

    fn described(&self, color: &str) -> String {
        let [radius, length] = [self.radius, 2.0 * (self.axis.half_length + self.radius)].map(length_in_words);
        format!("a {color} capsule of radius {radius} and length {length}") + &self.placed_bounds.scale_in_words()
    }

    /// States the equation, whose parts are those of a cylinder and of two spheres.
    fn equation(&self, ray: &Ray) -> Equation {
        let steps = vec![
            EquationStep::Text("|x - h a| = r, x = o + t d - from"),
            EquationStep::Text("h = x.a, from 0 to the length"),
            EquationStep::Text("sides: A t^2 + 2 B t + C = 0"),
            EquationStep::Text("as of cylinder and two spheres"),
        ];
        exact::equation(self, ray, steps)
    }

    fn encloses(&self, point: Vec3) -> bool {
        self.outward(self.placed_bounds.scene_to_shape(point) - self.axis.middle).length() < self.radius
    }
}

/// A capsule as written: `Capsule(from: ..., to: ..., radius: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenCapsule {
    ends: [Option<WrittenVector>; 2],
    radius: Option<WrittenNumber>,
}

impl InSceneFile for Capsule {
    type Written = WrittenCapsule;

    const NAME: &'static str = "Capsule";
    const OWNER: &'static str = "a Capsule";
    const FORM: &'static str = "Capsule(from: ..., to: ..., radius: ...)";
    const FIELDS: &'static [&'static str] = &["from", "to", "radius"];
    const SUMMARY: &'static str = "A cylinder with round ends about two points.";
    const MEANINGS: &'static [&'static str] = &["the middle of one end", "the middle of the other end", "the radius"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenCapsule {
        WrittenCapsule {
            ends: ["from", "to"].map(|end| reader.required(fields, end, NodeReader::point)),
            radius: reader.required(fields, "radius", NodeReader::number),
        }
    }
}

impl CheckedShape for Capsule {
    fn check(written: &WrittenCapsule, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let axis = validator.axis(written.ends);
        let radius = written.radius.and_then(|radius| validator.length("radius", radius));
        Some(Self::new(axis?, radius?.into()).into())
    }
}
