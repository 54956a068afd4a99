//! Tori: rings.

use super::described::length_in_words;
use super::exact::{self, Crossing, Crossings, Exact, PlacedBounds, reach_of_circle};
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Shape};
use crate::formula::Line;
use crate::ray::Ray;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec3};
use quartic::Quartic;

mod quartic;

/// Rounding error of a term of degree n in lengths, as a fraction of (outer radius)^n.
const ROUNDING: f64 = 1e-14;

/// A torus: all points x at the distance r from a circle of radius R around an axis a.
///
/// With x from the centre, (|x|^2 + R^2 - r^2)^2 = 4 R^2 (|x|^2 - (x.a)^2). If r is larger than R, the torus meets
/// itself, and only its outside counts.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Torus {
    center: DVec3,
    axis: DVec3,
    radius: f64,
    tube_radius: f64,
    placed_bounds: PlacedBounds,
}

impl Torus {
    fn new(center: DVec3, axis: DVec3, [radius, tube_radius]: [f64; 2]) -> Self {
        exact::with_bounds(Self { center, axis, radius, tube_radius, placed_bounds: PlacedBounds::NONE })
    }

    /// Returns whether a point in the coordinates of the shape is inside.
    fn contains(&self, point: DVec3) -> bool {
        let (height, distance) = self.height_and_distance(point - self.center);
        let from_ring = distance - self.radius;
        from_ring * from_ring + height * height < self.tube_radius * self.tube_radius
    }

    /// Returns whether a point of a ray's line is inside.
    pub(super) fn contains_at(&self, ray: &Ray, t: f64) -> bool {
        let Line { origin, direction } = self.placed_bounds.line(ray);
        self.contains(origin + direction * t)
    }

    /// Returns the height of a point over the plane of the ring, and its distance from the axis.
    fn height_and_distance(&self, at: DVec3) -> (f64, f64) {
        let height = at.dot(self.axis);
        (height, (at - self.axis * height).length())
    }

    /// Returns the quartic in s, the distance along a line from its point o closest to the centre.
    ///
    /// A point x of the line has |x|^2 = s^2 + |o|^2, so the coefficient of s^3 is 0.
    fn quartic(&self, line: &Line) -> Quartic {
        let (squared, rim, tube) = (line.origin.dot(line.origin), self.radius, self.tube_radius);
        let (height, distance) = self.height_and_distance(line.origin);
        let rise = line.direction.dot(self.axis) / line.direction.length();
        let (four, outer) = (4.0 * rim * rim, (rim + tube) * (rim + tube));
        // The two factors of f(o) are computed separately: expanded, their product would lose digits, the more the
        // thinner the tube.
        let factor = |rim: f64| (distance - rim) * (distance - rim) + height * height - tube * tube;
        Quartic {
            squares: 2.0 * (squared + rim * rim - tube * tube) - four * (1.0 - rise * rise),
            linear: 2.0 * four * height * rise,
            constant: factor(rim) * factor(-rim),
            rounding: ROUNDING * outer * outer,
        }
    }
}

impl Exact for Torus {
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
        self.radius * reach_of_circle(self.axis, direction) + self.tube_radius * direction.length()
    }

    fn crossings(&self, line: &Line) -> Crossings {
        let mut crossings = Crossings::NONE;
        let (outer, squared) = (self.radius + self.tube_radius, line.origin.dot(line.origin));
        // All roots are within the ball around the torus, up to rounding.
        let reach = (outer * outer * (1.0 + 1e-9) - squared).sqrt();
        if reach.is_nan() {
            return crossings;
        }
        let per_length = 1.0 / line.direction.length();
        let beyond_ring = squared + (self.radius - self.tube_radius) * (self.radius + self.tube_radius);
        for root in self.quartic(line).roots(reach) {
            // The squared equation also has roots inside the torus, where the tube of the opposite side reaches across
            // the axis (if r > R). There |x|^2 + R^2 - r^2 is negative.
            if root * root + beyond_ring >= -ROUNDING * outer * outer {
                crossings.push(Crossing { t: root * per_length, part: 0 });
            }
        }
        crossings
    }

    fn normal(&self, _: u8, at: DVec3) -> DVec3 {
        let across = at - self.axis * at.dot(self.axis);
        let distance = across.length();
        // On the axis, where a torus meets itself, the normal is along the axis.
        if distance == 0.0 { at } else { at - across * (self.radius / distance) }
    }
}

impl Described for Torus {
    const KIND: &'static str = "torus";

    fn described(&self, color: &str) -> String {
        let [radius, tube] = [self.radius, self.tube_radius].map(length_in_words);
        format!("a {color} torus of radius {radius} with a tube of radius {tube}")
            + &self.placed_bounds.scale_in_words()
    }

    /// Solves s^4 + P s^2 + Q s + C = 0.
    ///
    /// s is the distance along the line from its point closest to the centre.
    fn equation(&self, ray: &Ray) -> Equation {
        let Line { origin, direction: d } = self.placed_bounds.line(ray);
        let o = origin - self.center;
        let nearest = -o.dot(d) / d.dot(d);
        let Quartic { squares, linear, constant, .. } = self.quartic(&Line { origin: o + d * nearest, direction: d });
        let steps = vec![
            EquationStep::Text("(|x|^2 + R^2 - r^2)^2"),
            EquationStep::Text("  = 4 R^2 (|x|^2 - (x.a)^2)"),
            EquationStep::Text("x = o + t d - c, t = t0 + s / |d|"),
            EquationStep::Value("t0 = (c-o).d / d.d", nearest),
            EquationStep::Text("s^4 + P s^2 + Q s + C = 0"),
            EquationStep::Value("P", squares),
            EquationStep::Value("Q", linear),
            EquationStep::Value("C", constant),
        ];
        exact::equation(self, ray, steps)
    }

    fn encloses(&self, point: Vec3) -> bool {
        self.contains(self.placed_bounds.scene_to_shape(point))
    }
}

/// A torus as written: `Torus(center: ..., axis: ..., radius: ..., tube_radius: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenTorus {
    center: Option<WrittenVector>,
    axis: Option<WrittenVector>,
    radius: Option<WrittenNumber>,
    tube_radius: Option<WrittenNumber>,
}

impl InSceneFile for Torus {
    type Written = WrittenTorus;

    const NAME: &'static str = "Torus";
    const OWNER: &'static str = "a Torus";
    const FORM: &'static str = "Torus(center: ..., axis: ..., radius: ..., tube_radius: ...)";
    const FIELDS: &'static [&'static str] = &["center", "axis", "radius", "tube_radius"];
    const SUMMARY: &'static str = "A ring.";
    const MEANINGS: &'static [&'static str] = &[
        "the centre",
        "the axis, of any length",
        "the distance from the centre to the middle of the tube",
        "the radius of the tube",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenTorus {
        WrittenTorus {
            center: reader.required(fields, "center", NodeReader::point),
            axis: reader.required(fields, "axis", NodeReader::direction),
            radius: reader.required(fields, "radius", NodeReader::number),
            tube_radius: reader.required(fields, "tube_radius", NodeReader::number),
        }
    }
}

impl CheckedShape for Torus {
    fn check(written: &WrittenTorus, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let center = written.center.and_then(|center| validator.coordinates(center));
        let axis = written.axis.and_then(|axis| validator.unit_vector("axis", axis));
        let radius = written.radius.and_then(|radius| validator.length("radius", radius));
        let tube_radius = written.tube_radius.and_then(|radius| validator.length("tube_radius", radius));
        Some(Self::new(center?, axis?, [radius?.into(), tube_radius?.into()]).into())
    }
}
