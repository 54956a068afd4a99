//! Ellipsoids whose axes are parallel to the coordinate axes.

use super::described::size_in_words;
use super::exact::{self, Crossings, Exact, Inside, PlacedBounds};
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Shape, chart};
use crate::formula::Line;
use crate::ray::Ray;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec2, Vec3};

/// An ellipsoid: all points x with |(x - c) / r|^2 = 1, where r is the radius along each axis.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipsoid {
    center: DVec3,
    radii: DVec3,
    placed_bounds: PlacedBounds,
}

impl Ellipsoid {
    /// Returns the ellipsoid about `center`.
    pub(super) fn new(center: DVec3, radii: DVec3) -> Self {
        exact::with_bounds(Self { center, radii, placed_bounds: PlacedBounds::NONE })
    }
}

impl Exact for Ellipsoid {
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
        (self.radii * direction).length()
    }

    /// Divides the line by the radii, and intersects it with the unit ball.
    fn crossings(&self, line: &Line) -> Crossings {
        Inside::ball(line.origin / self.radii, line.direction / self.radii, 1.0).crossings()
    }

    fn normal(&self, _: u8, at: DVec3) -> DVec3 {
        at / self.radii / self.radii
    }

    /// Returns the coordinates on the ball that the ellipsoid is before it is scaled by its radii.
    fn chart_at(&self, at: DVec3, _: DVec3) -> Option<Vec2> {
        Some(chart::on_ball(at / self.radii))
    }
}

impl Described for Ellipsoid {
    const KIND: &'static str = "ellipsoid";

    fn described(&self, color: &str) -> String {
        format!("a {color} ellipsoid, {}", size_in_words(self.placed_bounds.bounds()))
    }

    /// Solves A t^2 + 2 B t + C = 0, as for a sphere of radius 1, for the line divided by the
    /// radii.
    fn equation(&self, ray: &Ray) -> Equation {
        let Line { origin, direction } = self.placed_bounds.line(ray);
        let (d, from_center) = (direction / self.radii, (origin - self.center) / self.radii);
        let steps = vec![
            EquationStep::Text("|(o + t d - c) / r|^2 - 1 = 0"),
            EquationStep::Text("e = d / r, f = (o - c) / r"),
            EquationStep::Text("A t^2 + 2 B t + C = 0"),
            EquationStep::Value("A = e.e", d.dot(d)),
            EquationStep::Value("B = f.e", from_center.dot(d)),
            EquationStep::Value("C = f.f - 1", from_center.dot(from_center) - 1.0),
        ];
        exact::equation(self, ray, steps)
    }

    fn encloses(&self, point: Vec3) -> bool {
        ((self.placed_bounds.scene_to_shape(point) - self.center) / self.radii).length() < 1.0
    }
}

/// An ellipsoid as written: `Ellipsoid(center: ..., radii: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenEllipsoid {
    center: Option<WrittenVector>,
    radii: Option<[WrittenNumber; 3]>,
}

impl InSceneFile for Ellipsoid {
    type Written = WrittenEllipsoid;

    const NAME: &'static str = "Ellipsoid";
    const OWNER: &'static str = "an Ellipsoid";
    const FORM: &'static str = "Ellipsoid(center: ..., radii: (..., ..., ...))";
    const FIELDS: &'static [&'static str] = &["center", "radii"];
    const SUMMARY: &'static str = "An ellipsoid along the axes.";
    const MEANINGS: &'static [&'static str] = &["the centre", "the radii along x, y and z"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenEllipsoid {
        WrittenEllipsoid {
            center: reader.required(fields, "center", NodeReader::point),
            radii: reader
                .required(fields, "radii", |reader, node| reader.numbers(node, "the radii along x, y and z (x, y, z)")),
        }
    }
}

impl CheckedShape for Ellipsoid {
    const HAS_CHART: bool = true;

    fn check(written: &WrittenEllipsoid, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let center = written.center.and_then(|center| validator.coordinates(center));
        let radii = written.radii?.map(|radius| validator.length("radius", radius));
        let (center, [Some(x), Some(y), Some(z)]) = (center?, radii) else { return None };
        let radii = Vec3::new(x, y, z).as_dvec3();
        Some(Self::new(center, radii).into())
    }
}
