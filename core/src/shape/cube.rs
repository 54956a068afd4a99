//! Ray-cube intersection: a surface for tests.
//!
//! It shows that a new surface takes one file and one line in the table `surfaces`.

use super::placement::{Placeable, Placement};
use super::{CheckedShape, Described, Equation, EquationStep, Meshes, Points, Shape, Surface, SurfacePoint};
use crate::bounds::{Bounds, crossed};
use crate::lanes::Vector;
use crate::ray::{Interval, Probe, Ray};
use crate::text::number;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::Vec3;

/// A cube: all points x with max |x - c| - h = 0, whose faces are perpendicular to the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cube {
    center: Vec3,
    half_side: f32,
}

impl Cube {
    /// Returns the cube about `center` with sides of twice `half_side`.
    pub fn new(center: Vec3, half_side: f32) -> Self {
        Self { center, half_side }
    }
}

impl Surface for Cube {
    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds { min: self.center - self.half_side, max: self.center + self.half_side })
    }

    /// Intersects the ray with the cube's bounding box, which is the cube itself.
    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let Bounds { min, max } = self.bounds()?;
        let [enters, leaves] = crossed([Vector::splat(min), Vector::splat(max)], &probe.rays);
        let t = if within.min <= enters { enters } else { leaves };
        (enters <= leaves && within.contains(t)).then_some(t)
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let outward = ray.at(t) - self.center;
        let axis = (0..3).fold(0, |axis, next| if outward[axis].abs() < outward[next].abs() { next } else { axis });
        let mut normal = Vec3::ZERO;
        normal[axis] = outward[axis].signum();
        let mut position = ray.at(t);
        // Moves the point exactly onto the face, because t is rounded.
        position[axis] = self.center[axis] + normal[axis] * self.half_side;
        let size = self.center.abs().max_element() + self.half_side;
        let (position, normal) = (Vector::splat(position), Vector::splat(normal));
        Points::seen_by(&Probe::new(*ray).rays, position, normal, size, [0.0; 2]).point()
    }
}

impl Described for Cube {
    const KIND: &'static str = "cube";

    fn described(&self, color: &str) -> String {
        format!("a {color} cube with sides of {}", number(2.0 * self.half_side))
    }

    /// Solves for the t at which the line enters and leaves the cube.
    fn equation(&self, ray: &Ray) -> Equation {
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (c, h) = (self.center.as_dvec3(), f64::from(self.half_side));
        let (one, other) = ((c - h - o) / d, (c + h - o) / d);
        let (enters, leaves) = (one.min(other).max_element(), one.max(other).min_element());
        let roots = if enters <= leaves { vec![enters, leaves] } else { Vec::new() };
        Equation {
            steps: vec![EquationStep::Values("t = ", " or ", roots.clone())],
            roots,
            without_root: "miss",
            is_outside: false,
        }
    }

    fn encloses(&self, point: Vec3) -> bool {
        (point - self.center).abs().max_element() < self.half_side
    }
}

#[cfg(all(test, unit_tests))]
mod tests;

/// A cube as written: `Cube(center: ..., side: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenCube {
    center: Option<WrittenVector>,
    /// The length of a side; 1 if none is given.
    side: Option<WrittenNumber>,
}

impl InSceneFile for Cube {
    type Written = WrittenCube;

    const NAME: &'static str = "Cube";
    const OWNER: &'static str = "a Cube";
    const FORM: &'static str = "Cube(center: ..., side: ...)";
    const FIELDS: &'static [&'static str] = &["center", "side"];
    const SUMMARY: &'static str = "A cube along the axes.";
    const MEANINGS: &'static [&'static str] = &["the centre", "the side; 2"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenCube {
        WrittenCube {
            center: reader.required(fields, "center", NodeReader::point),
            side: reader.optional(fields, "side", NodeReader::number),
        }
    }
}

impl CheckedShape for Cube {
    fn check(written: &WrittenCube, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let center = written.center.and_then(|center| validator.point(center));
        let side = written.side.map_or(Some(1.0), |side| validator.length("side", side));
        Some(Self::new(center?, 0.5 * side?).into())
    }
}

impl Placeable for Cube {
    /// Maps the centre; a cube cannot be rotated, or scaled differently along the axes.
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let scale = placement.uniform_scale()? as f32;
        Some(Self::new(placement.map().point(self.center.as_dvec3()).as_vec3(), self.half_side * scale).into())
    }
}
