//! Boxes whose faces are perpendicular to the axes.

use super::described::size_in_words;
use super::exact::{self, Crossings, Exact, Inside, PlacedBounds};
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Shape, chart};
use crate::formula::Line;
use crate::ray::Ray;
use crate::scene_text::Span;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenVector};
use glam::{DVec3, Vec2, Vec3};

/// The surface of an axis-aligned box from `min` to `max`. Scene files call it `Box`.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Cuboid {
    min: DVec3,
    max: DVec3,
    placed_bounds: PlacedBounds,
}

impl Cuboid {
    pub(super) fn new(min: DVec3, max: DVec3) -> Self {
        exact::with_bounds(Self { min, max, placed_bounds: PlacedBounds::NONE })
    }

    /// Returns the part of a line between the planes of the two faces that are perpendicular to an
    /// axis.
    fn slab(&self, axis: usize, line: &Line, center: DVec3) -> Inside {
        let range = [self.min[axis] - center[axis], self.max[axis] - center[axis]];
        let parts = [2 * axis as u8, 2 * axis as u8 + 1];
        Inside::slab(line.origin[axis], line.direction[axis], range, parts)
    }
}

impl Exact for Cuboid {
    fn placed_bounds(&self) -> &PlacedBounds {
        &self.placed_bounds
    }

    fn placed_bounds_mut(&mut self) -> &mut PlacedBounds {
        &mut self.placed_bounds
    }

    fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }

    fn reach(&self, direction: DVec3) -> f64 {
        ((self.max - self.min) * 0.5).dot(direction.abs())
    }

    fn crossings(&self, line: &Line) -> Crossings {
        let [x, y, z] = [0, 1, 2].map(|axis| self.slab(axis, line, self.center()));
        x.and(y).and(z).crossings()
    }

    /// Returns the normal of a face: faces 0 and 1 are perpendicular to x.
    fn normal(&self, part: u8, _: DVec3) -> DVec3 {
        let mut normal = DVec3::ZERO;
        normal[usize::from(part / 2)] = if part.is_multiple_of(2) { -1.0 } else { 1.0 };
        normal
    }

    fn pattern_origin(&self) -> DVec3 {
        self.min
    }

    /// Returns the two axes along the face: z and y, x and z, or x and y.
    fn pattern_axes(&self, normal: Vec3) -> Option<[Vec3; 2]> {
        let axis = |along: f32, other: Vec3| if along.abs() > 0.5 { Vec3::Z } else { other };
        Some([axis(normal.x, Vec3::X), axis(normal.y, Vec3::Y)])
    }

    /// Returns coordinates with the picture upright on the four sides, and with its lower edge at
    /// the front (+z) on top and at the back below.
    fn chart_at(&self, at: DVec3, normal: DVec3) -> Option<Vec2> {
        let DVec3 { x, y, z } = at / (self.max - self.min);
        let normal = normal.abs();
        // The side is that of the point, as the normal may be on either side.
        let from = |side: f64, across: f64| if side < 0.0 { -across } else { across };
        Some(chart::on_face(if normal.y > normal.x.max(normal.z) {
            [x, from(y, z)]
        } else if normal.x > normal.z {
            [-from(x, z), -y]
        } else {
            [from(z, x), -y]
        }))
    }
}

impl Described for Cuboid {
    const KIND: &'static str = "box";

    fn described(&self, color: &str) -> String {
        format!("a {color} box, {}", size_in_words(self.placed_bounds.bounds()))
    }

    /// Solves o + t d = min and o + t d = max for each axis.
    ///
    /// The line is inside the box from the last of the three entries to the first of the three exits.
    fn equation(&self, ray: &Ray) -> Equation {
        let line = self.placed_bounds.line(ray);
        let mut steps = vec![EquationStep::Text("o + t d = min and max, each axis")];
        for (axis, name) in ["x: t in ", "y: t in ", "z: t in "].into_iter().enumerate() {
            let Inside { enters, leaves } = self.slab(axis, &line, DVec3::ZERO);
            steps.push(EquationStep::Values(name, " to ", vec![enters.t, leaves.t]));
        }
        steps.push(EquationStep::Text("inside where all three overlap"));
        exact::equation(self, ray, steps)
    }

    fn encloses(&self, point: Vec3) -> bool {
        let point = self.placed_bounds.scene_to_shape(point);
        point.cmpgt(self.min).all() && point.cmplt(self.max).all()
    }
}

/// A box as written: `Box(min: ..., max: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenBox {
    min: Option<WrittenVector>,
    max: Option<WrittenVector>,
    span: Span,
}

impl WrittenBox {
    /// Returns both corners, or `None` after a fault has been reported.
    pub(super) fn check(&self, validator: &mut Validator<'_>) -> Option<[DVec3; 2]> {
        let [min, max] = [self.min, self.max].map(|corner| validator.coordinates(corner?));
        let (min, max) = (min?, max?);
        if !min.as_vec3().cmplt(max.as_vec3()).all() {
            return validator.fault(self.span, || "each coordinate of min must be less than that of max".to_owned());
        }
        Some([min, max])
    }
}

impl InSceneFile for Cuboid {
    type Written = WrittenBox;

    const NAME: &'static str = "Box";
    const OWNER: &'static str = "a Box";
    const FORM: &'static str = "Box(min: ..., max: ...)";
    const FIELDS: &'static [&'static str] = &["min", "max"];
    const SUMMARY: &'static str = "A box along the axes.";
    const MEANINGS: &'static [&'static str] =
        &["the corner with the least coordinates", "the corner with the greatest coordinates"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenBox {
        let min = reader.required(fields, "min", NodeReader::point);
        let max = reader.required(fields, "max", NodeReader::point);
        WrittenBox { min, max, span: fields.head() }
    }
}

impl CheckedShape for Cuboid {
    const HAS_COORDINATES: bool = true;

    fn check(written: &WrittenBox, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let [min, max] = written.check(validator)?;
        Some(Self::new(min, max).into())
    }
}
