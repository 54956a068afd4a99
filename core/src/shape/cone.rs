//! Cones, pointed or cut off, with caps or open.

use super::cylinder::{CAPS, SIDE};
use super::described::length_in_words;
use super::exact::{self, Crossings, Exact, Inside, PlacedBounds};
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Shape};
use crate::formula::Line;
use crate::ray::Ray;
use crate::written::{Axis, Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec3};

/// A cone: all points x at the distance r + k x.a from an axis a, between two caps.
///
/// |x|^2 - (x.a)^2 = (r + k x.a)^2.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Cone {
    axis: Axis,
    /// The radii at both ends, of which the second may be 0.
    radii: [f64; 2],
    /// Whether the cone has no caps.
    open: bool,
    placed_bounds: PlacedBounds,
}

/// The coefficients of A t^2 + 2 B t + C, which is negative inside the infinite double cone.
struct Quadratic {
    a: f64,
    half_b: f64,
    c: f64,
}

impl Cone {
    fn new(axis: Axis, radii: [f64; 2], open: bool) -> Self {
        exact::with_bounds(Self { axis, radii, open, placed_bounds: PlacedBounds::NONE })
    }

    /// Returns the growth of the radius per unit of length along the axis.
    fn slope(&self) -> f64 {
        (self.radii[1] - self.radii[0]) / (2.0 * self.axis.half_length)
    }

    /// Returns the quadratic of a line; `radius` is the cone's radius at the origin of the
    /// coordinates.
    fn quadratic(&self, line: &Line, radius: f64) -> Quadratic {
        let [o, d] = [line.origin, line.direction].map(|vector| self.axis.across(vector));
        let [along, change] = [line.origin, line.direction].map(|vector| vector.dot(self.axis.direction));
        let (radius, growth) = (radius + self.slope() * along, self.slope() * change);
        Quadratic { a: d.dot(d) - growth * growth, half_b: o.dot(d) - radius * growth, c: o.dot(o) - radius * radius }
    }

    /// Returns the part of `between` in which a line is inside the infinite double cone.
    fn side(&self, line: &Line, between: Inside) -> Inside {
        let Quadratic { a, half_b, c } = self.quadratic(line, 0.5 * (self.radii[0] + self.radii[1]));
        let under_root = half_b * half_b - a * c;
        // A line that is steeper than the side always crosses the double cone. Near the tip, rounding must not turn the
        // two crossings into none.
        let root = if a < 0.0 { under_root.max(0.0) } else { under_root }.sqrt();
        if root.is_nan() {
            return Inside::NOTHING;
        }
        // The two terms have the same sign, so they do not cancel. Roots that do not exist become infinite or NaN.
        let q = -(half_b + root.copysign(half_b));
        let (one, other) = (q / a, if q == 0.0 { q / a } else { c / q });
        let (first, second) = if one < other { (one, other) } else { (other, one) };
        let [before, after] = [[f64::NEG_INFINITY, first], [second, f64::INFINITY]];
        let ends = |range| Inside::of(range, [SIDE; 2]).and(between);
        let length = |inside: &Inside| inside.leaves.t - inside.enters.t;
        if a > 0.0 {
            return ends([first, second]);
        }
        if a < 0.0 {
            // The line is inside both halves of the double cone. The half beyond the tip is not part of the cone;
            // between the ends, the part of the line in that half is the shorter one.
            let (before, after) = (ends(before), ends(after));
            return if length(&before) < length(&after) { after } else { before };
        }
        // The line is parallel to the side, and crosses it once or never.
        match -0.5 * c / half_b {
            t if half_b > 0.0 => ends([f64::NEG_INFINITY, t]),
            t if half_b < 0.0 => ends([t, f64::INFINITY]),
            _ if c <= 0.0 => between,
            _ => Inside::NOTHING,
        }
    }

    /// Returns whether the shape has no caps, so that it encloses nothing.
    pub(super) fn is_open(&self) -> bool {
        self.open
    }
}

impl Exact for Cone {
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
        self.axis.reach_of_circles(self.radii, direction)
    }

    fn crossings(&self, line: &Line) -> Crossings {
        // The tip of an open cone counts as a part of the side, because crossings on the caps are dropped.
        let caps = if self.open && self.radii[1] == 0.0 { [CAPS[0], SIDE] } else { CAPS };
        let inside = self.side(line, self.axis.slab(line, caps));
        let mut crossings = Crossings::NONE;
        inside.crossings().iter().filter(|at| !self.open || at.part == SIDE).for_each(|at| crossings.push(at));
        crossings
    }

    fn normal(&self, part: u8, at: DVec3) -> DVec3 {
        if part != SIDE {
            return self.axis.normal_of_cap(part);
        }
        let across = self.axis.across(at);
        let normal = across - self.axis.direction * (self.slope() * across.length());
        // At the tip the normal is along the axis.
        if normal == DVec3::ZERO { -self.axis.direction * self.slope() } else { normal }
    }
}

impl Described for Cone {
    const KIND: &'static str = "cone";

    fn described(&self, color: &str) -> String {
        let [wide, narrow, length] = [self.radii[0], self.radii[1], 2.0 * self.axis.half_length].map(length_in_words);
        let open = if self.open { "open " } else { "" };
        let radius =
            if self.radii[1] == 0.0 { format!("of radius {wide}") } else { format!("of radii {wide} to {narrow}") };
        format!("a {color} {open}cone {radius} and length {length}") + &self.placed_bounds.scale_in_words()
    }

    /// Solves A t^2 + 2 B t + C = 0 for the infinite double cone, with x relative to the end
    /// `from`.
    fn equation(&self, ray: &Ray) -> Equation {
        let Quadratic { a, half_b, c } =
            self.quadratic(&self.axis.relative_to_start(self.placed_bounds.line(ray)), self.radii[0]);
        let steps = vec![
            EquationStep::Text("|x|^2 - h^2 - (r + k h)^2 = 0"),
            EquationStep::Text("x = o + t d - from, h = x.a"),
            EquationStep::Value("k", self.slope()),
            EquationStep::Text("A t^2 + 2 B t + C = 0"),
            EquationStep::Value("A", a),
            EquationStep::Value("B", half_b),
            EquationStep::Value("C", c),
            EquationStep::Text("and 0 <= h <= length"),
        ];
        exact::equation(self, ray, steps)
    }

    fn encloses(&self, point: Vec3) -> bool {
        let from_middle = self.placed_bounds.scene_to_shape(point) - self.axis.middle;
        let along = from_middle.dot(self.axis.direction);
        let radius = 0.5 * (self.radii[0] + self.radii[1]) + self.slope() * along;
        !self.open && along.abs() < self.axis.half_length && self.axis.across(from_middle).length() < radius
    }
}

/// A cone as written: `Cone(from: ..., to: ..., radius: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenCone {
    ends: [Option<WrittenVector>; 2],
    radius: Option<WrittenNumber>,
    /// The radius at `to`; 0 if none is given.
    to_radius: Option<WrittenNumber>,
    open: Option<bool>,
}

impl InSceneFile for Cone {
    type Written = WrittenCone;

    const NAME: &'static str = "Cone";
    const OWNER: &'static str = "a Cone";
    const FORM: &'static str = "Cone(from: ..., to: ..., radius: ...)";
    const FIELDS: &'static [&'static str] = &["from", "to", "radius", "to_radius", "open"];
    const SUMMARY: &'static str = "A cone, or a part of one, between two points.";
    const MEANINGS: &'static [&'static str] = &[
        "the middle of one end",
        "the middle of the other end",
        "the radius at `from`",
        "the radius at `to`; 0, a tip",
        "true leaves out both caps; false",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenCone {
        WrittenCone {
            ends: ["from", "to"].map(|end| reader.required(fields, end, NodeReader::point)),
            radius: reader.required(fields, "radius", NodeReader::number),
            to_radius: reader.optional(fields, "to_radius", NodeReader::number),
            open: reader.optional(fields, "open", NodeReader::boolean),
        }
    }
}

impl CheckedShape for Cone {
    fn check(written: &WrittenCone, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let axis = validator.axis(written.ends);
        let radius = written.radius.and_then(|radius| validator.length("radius", radius));
        let to_radius = match written.to_radius {
            Some(radius) if radius.value != 0.0 => validator.length("to_radius", radius),
            _ => Some(0.0),
        };
        Some(Self::new(axis?, [radius?.into(), to_radius?.into()], written.open == Some(true)).into())
    }
}
