//! Disks: the part of a plane within a circle.

use super::described::length_in_words;
use super::exact::{self, Crossing, Crossings, Exact, PlacedBounds, reach_of_circle};
use super::plane::{self, pattern_axis};
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Shape, chart};
use crate::formula::Line;
use crate::ray::Ray;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec2, Vec3};

/// A disk: all points x with (x - c).n = 0 and |x - c| <= r. It is visible from both sides.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Disk {
    center: DVec3,
    normal: DVec3,
    radius: f64,
    /// Unit vectors in the plane of the disk, along which patterns are measured.
    axes: [Vec3; 2],
    placed_bounds: PlacedBounds,
}

impl Disk {
    fn new(center: DVec3, normal: DVec3, radius: f64) -> Self {
        let u = pattern_axis(normal.as_vec3());
        let axes = [u, u.cross(normal.as_vec3())];
        exact::with_bounds(Self { center, normal, radius, axes, placed_bounds: PlacedBounds::NONE })
    }
}

impl Exact for Disk {
    fn placed_bounds(&self) -> &PlacedBounds {
        &self.placed_bounds
    }

    fn placed_bounds_mut(&mut self) -> &mut PlacedBounds {
        &mut self.placed_bounds
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    fn reach(&self, direction: DVec3) -> f64 {
        self.radius * reach_of_circle(self.normal, direction)
    }

    /// Returns the crossing, if any. A ray in the plane of the disk has none: it would see only the
    /// edge.
    fn crossings(&self, Line { origin, direction }: &Line) -> Crossings {
        let mut crossings = Crossings::NONE;
        let t = -origin.dot(self.normal) / direction.dot(self.normal);
        let at = *origin + *direction * t;
        if t.is_finite() && at.dot(at) <= self.radius * self.radius {
            crossings.push(Crossing { t, part: 0 });
        }
        crossings
    }

    fn normal(&self, _: u8, _: DVec3) -> DVec3 {
        self.normal
    }

    fn pattern_origin(&self) -> DVec3 {
        self.center
    }

    fn pattern_axes(&self, _: Vec3) -> Option<[Vec3; 2]> {
        Some(self.axes)
    }

    /// Returns coordinates in the square around the disk.
    fn chart_at(&self, at: DVec3, _: DVec3) -> Option<Vec2> {
        Some(chart::on_face(self.axes.map(|axis| axis.as_dvec3().dot(at) / (2.0 * self.radius))))
    }
}

impl Described for Disk {
    const KIND: &'static str = "disk";

    fn described(&self, color: &str) -> String {
        format!("a {color} disk of radius {}", length_in_words(self.radius)) + &self.placed_bounds.scale_in_words()
    }

    /// Solves t = (c - o).n / d.n for the plane of the disk.
    fn equation(&self, ray: &Ray) -> Equation {
        let line = self.placed_bounds.line(ray);
        let mut equation = plane::equation(&line, self.center, self.normal);
        if let Some(&t) = equation.roots.first() {
            let from_center = (line.origin + line.direction * t).distance(self.center);
            equation.steps.push(EquationStep::Value("|o + t d - a|", from_center));
            equation.is_outside = from_center > self.radius;
        }
        equation
    }
}

/// A disk as written: `Disk(center: ..., normal: ..., radius: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenDisk {
    center: Option<WrittenVector>,
    normal: Option<WrittenVector>,
    radius: Option<WrittenNumber>,
}

impl InSceneFile for Disk {
    type Written = WrittenDisk;

    const NAME: &'static str = "Disk";
    const OWNER: &'static str = "a Disk";
    const FORM: &'static str = "Disk(center: ..., normal: ..., radius: ...)";
    const FIELDS: &'static [&'static str] = &["center", "normal", "radius"];
    const SUMMARY: &'static str = "A flat disk, seen from both sides.";
    const MEANINGS: &'static [&'static str] = &["the centre", "the normal, of any length", "the radius"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenDisk {
        WrittenDisk {
            center: reader.required(fields, "center", NodeReader::point),
            normal: reader.required(fields, "normal", NodeReader::direction),
            radius: reader.required(fields, "radius", NodeReader::number),
        }
    }
}

impl CheckedShape for Disk {
    const HAS_COORDINATES: bool = true;
    const HAS_INSIDE: bool = false;

    fn check(written: &WrittenDisk, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let center = written.center.and_then(|center| validator.coordinates(center));
        let normal = written.normal.and_then(|normal| validator.unit_vector("normal", normal));
        let radius = written.radius.and_then(|radius| validator.length("radius", radius));
        Some(Self::new(center?, normal?, radius?.into()).into())
    }
}
