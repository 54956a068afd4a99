//! Where lines enter and leave solids.

use super::closed_mesh::MeshCrossing;
use super::{Body, FormulaRoots, Operation, Solid};
use crate::ray::{Probe, Ray};
use crate::shape::exact::{self, Crossings, Inside};
use crate::shape::{Plane, Shape, Sphere, Torus};
use glam::Vec3;
use std::cmp::Ordering;

/// The most shapes in a solid, those of the solids among its parts counted.
// Their numbers are the bits of a mask, and all shapes are tested against each ray that reaches the solid.
pub(super) const MAX_SHAPES: usize = 16;

/// The number of boundaries that are stored without an allocation, which is enough for most lines.
// Room is written before it is used, and for 64 boundaries that took longer than finding the few of most lines.
const FEW_BOUNDARIES: usize = 16;

/// The distance, relative to the largest t, within which two boundaries are one.
// Two parts that share a face compute its t with different roundings, of about 1e-15. Points in f32 are off by 1e-7.
const TOLERANCE: f64 = 1e-11;

/// The distance, relative to t, within which boundaries of two parts are one, if one is rounded.
// Roots and crossings of triangles are rounded to f32, by a few units of 2^-24. Without this, a hole whose face lies in
// that of a mesh would be covered by speckles.
const ROUNDED_TOLERANCE: f64 = 8.0 / 16_777_216.0;

/// An end of a piece of a line inside a solid.
#[derive(Clone, Copy)]
pub(super) struct Boundary {
    pub(super) t: f64,
    /// The number of the part on whose surface it is.
    part: u8,
    /// The number of the shape on whose surface it is, among the shapes of all parts.
    pub(super) shape: u8,
    /// The number of the triangle, if that shape is a mesh.
    pub(super) triangle: u32,
    /// Whether that shape is a plane.
    is_of_plane: bool,
    /// Whether t is rounded to f32, as those of formulas and meshes are.
    is_rounded: bool,
    /// Whether the line enters the solid here.
    pub(super) enters: bool,
}

/// A boundary whose values are not set yet.
const UNPLACED: Boundary =
    Boundary { t: 0.0, part: 0, shape: 0, triangle: 0, is_of_plane: false, is_rounded: false, enters: false };

/// A ray whose line's boundaries are searched for.
#[derive(Clone, Copy)]
pub(super) struct RayOfSolid<'a> {
    pub(super) probe: &'a Probe,
    /// The roots of the formulas in the solid along up to eight rays.
    pub(super) roots: &'a FormulaRoots,
    /// The lane of this ray among them.
    pub(super) lane: usize,
}

/// The boundaries of a solid along a line, in ascending order.
pub(super) struct Boundaries {
    few: [Boundary; FEW_BOUNDARIES],
    few_count: usize,
    /// All boundaries, if there are too many for `few`.
    many: Vec<Boundary>,
    /// Whether the line begins inside, at t = -infinity.
    pub(super) begins_inside: bool,
}

impl Boundaries {
    /// Returns the boundaries of a line that misses the solid.
    fn none() -> Self {
        Self { few: [UNPLACED; FEW_BOUNDARIES], few_count: 0, many: Vec::new(), begins_inside: false }
    }

    /// Adds a boundary of a part; one without a place on the line is left out.
    fn push(&mut self, boundary: Boundary) {
        if boundary.t.is_nan() {
            return;
        }
        match self.few.get_mut(self.few_count) {
            Some(free) if self.many.is_empty() => {
                *free = boundary;
                self.few_count += 1;
            }
            _ => {
                if self.many.is_empty() {
                    self.many.extend_from_slice(&self.few);
                }
                self.many.push(boundary);
            }
        }
    }

    fn all(&self) -> &[Boundary] {
        if self.many.is_empty() { &self.few[..self.few_count] } else { &self.many }
    }

    fn all_mut(&mut self) -> &mut [Boundary] {
        if self.many.is_empty() { &mut self.few[..self.few_count] } else { &mut self.many }
    }

    /// Keeps the first boundaries only.
    fn truncate(&mut self, count: usize) {
        if self.many.is_empty() {
            self.few_count = count;
        } else if count > 0 {
            self.many.truncate(count);
        } else {
            (self.few_count, self.many) = (0, Vec::new());
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Boundary> {
        self.all().iter().copied()
    }

    /// Adds the boundaries of the part with this number along a line, in ascending order.
    ///
    /// `first_shape` is the number of the part's first shape. Returns whether the line begins inside the part, at t =
    /// -infinity.
    fn add_part(&mut self, number: u8, body: &Body, first_shape: u8, line: RayOfSolid<'_>) -> bool {
        let ray = &line.probe.ray;
        let unplaced = Boundary { part: number, shape: first_shape, ..UNPLACED };
        let shape = match body {
            Body::Shape(shape) => shape,
            Body::Mesh(mesh) => {
                let crossings = mesh.crossings(ray);
                for &MeshCrossing { t, triangle, enters, .. } in &crossings {
                    self.push(Boundary { t: t.into(), triangle, enters, is_rounded: true, ..unplaced });
                }
                return crossings.first().is_some_and(|crossing| !crossing.enters);
            }
        };
        let crossings = match shape {
            Shape::Solid(solid) => {
                let mut boundaries = Self::none();
                solid.find(line, first_shape, &mut boundaries);
                for boundary in boundaries.iter() {
                    self.push(Boundary { part: number, ..boundary });
                }
                return boundaries.begins_inside;
            }
            Shape::Plane(plane) => return self.add_half_space(unplaced, plane, ray),
            Shape::Torus(torus) => {
                self.add_torus(unplaced, torus, ray);
                return false;
            }
            Shape::Implicit(_) => {
                for (t, enters) in line.roots.of_lane(first_shape, line.lane) {
                    self.push(Boundary { t: t.into(), enters, is_rounded: true, ..unplaced });
                }
                return line.roots.begins_inside(first_shape, line.lane);
            }
            Shape::Sphere(sphere) => sphere_crossings(sphere, ray),
            Shape::Cuboid(shape) => exact::crossings(shape, ray),
            Shape::Cylinder(shape) => exact::crossings(shape, ray),
            Shape::Cone(shape) => exact::crossings(shape, ray),
            Shape::Capsule(shape) => exact::crossings(shape, ray),
            Shape::Ellipsoid(shape) => exact::crossings(shape, ray),
            _ => Crossings::NONE,
        };
        for (number, crossing) in crossings.iter().enumerate() {
            self.push(Boundary { t: crossing.t, enters: number % 2 == 0, ..unplaced });
        }
        false
    }

    /// Adds the boundaries of a torus, without the points at which a line only touches it.
    fn add_torus(&mut self, unplaced: Boundary, torus: &Torus, ray: &Ray) {
        let crossings = exact::crossings(torus, ray);
        let mut crossings = crossings.iter().map(|crossing| crossing.t).peekable();
        let mut is_inside = false;
        while let Some(t) = crossings.next() {
            let enters = crossings.peek().is_some_and(|next| torus.contains_at(ray, 0.5 * (t + next)));
            if enters != is_inside {
                is_inside = enters;
                self.push(Boundary { t, enters, ..unplaced });
            }
        }
    }

    /// Adds the boundary of all that is behind a plane, and returns whether the line begins there.
    fn add_half_space(&mut self, unplaced: Boundary, plane: &Plane, ray: &Ray) -> bool {
        let [point, normal] = [plane.point(), plane.normal()].map(Vec3::as_dvec3);
        let height = (ray.origin.as_dvec3() - point).dot(normal);
        let change = ray.direction.as_dvec3().dot(normal);
        if change == 0.0 {
            return height < 0.0;
        }
        self.push(Boundary { t: -height / change, is_of_plane: true, enters: change < 0.0, ..unplaced });
        change > 0.0
    }

    /// Replaces the boundaries of the parts by those of the solid.
    ///
    /// `inside` is the mask of the parts in which the line begins, and `count` the number of parts.
    fn combine(&mut self, operation: Operation, mut inside: u32, count: usize) {
        let contains = |inside| operation.contains(inside, count);
        self.begins_inside = contains(inside);
        let begins_inside = self.begins_inside;
        let events = self.all_mut();
        // A stable sort, so that boundaries at one t keep the order of the parts.
        events.sort_by(|a, b| a.t.partial_cmp(&b.t).unwrap_or(Ordering::Equal));
        // The t of a plane that is almost parallel to the line is no measure of the solid.
        let bounded = events.iter().filter(|boundary| !boundary.is_of_plane);
        let largest = bounded.map(|boundary| boundary.t.abs()).filter(|t| t.is_finite()).fold(0.0, f64::max);
        let (mut start, mut was_inside, mut kept) = (0, begins_inside, 0);
        while start < events.len() {
            let mut end = start;
            let mut decisive = None;
            while let Some(event) = events.get(end)
                && (end == start || are_one(&events[start..end], event, largest))
            {
                let before = contains(inside);
                inside ^= 1 << event.part;
                if contains(inside) != before {
                    decisive = Some(*event);
                }
                end += 1;
            }
            if contains(inside) != was_inside
                && let Some(boundary) = decisive
            {
                was_inside = !was_inside;
                // At most one boundary is kept of each group, so the place has been read.
                events[kept] = Boundary { enters: was_inside, ..boundary };
                kept += 1;
            }
            start = end;
        }
        self.truncate(kept);
    }
}

/// Returns whether a boundary is at the same point as those before it.
///
/// `largest` is the largest t of the solid.
fn are_one(before: &[Boundary], next: &Boundary, largest: f64) -> bool {
    let distance = next.t - before[0].t;
    // Two boundaries of one formula may be that near to each other: a thin sheet is not lost.
    let is_rounded = |one: &Boundary| (one.is_rounded || next.is_rounded) && one.part != next.part;
    distance <= TOLERANCE * largest || distance <= ROUNDED_TOLERANCE * next.t.abs() && before.iter().all(is_rounded)
}

/// Returns the crossings of a sphere, computed in f64.
fn sphere_crossings(sphere: &Sphere, ray: &Ray) -> Crossings {
    let from_center = ray.origin.as_dvec3() - sphere.center().as_dvec3();
    Inside::ball(from_center, ray.direction.as_dvec3(), sphere.radius().into()).crossings()
}

impl Solid {
    /// Returns where the line of a ray enters and leaves the solid.
    pub(super) fn boundaries(&self, line: RayOfSolid<'_>) -> Boundaries {
        let mut boundaries = Boundaries::none();
        self.find(line, 0, &mut boundaries);
        boundaries
    }

    /// Adds where a line enters and leaves the solid, whose first shape has the number
    /// `first_shape`, to no boundaries.
    // Into a place of the caller's, because returned values are copied.
    fn find(&self, line: RayOfSolid<'_>, first_shape: u8, boundaries: &mut Boundaries) {
        let mut inside = 0_u32;
        for (number, part) in (0..).zip(&*self.parts) {
            let before = boundaries.all().len();
            // Most lines miss most parts. No crossing is lost (`culling.md`, 3).
            if part.bounds.is_none_or(|bounds| bounds.is_crossed(line.probe)) {
                let begins_inside = boundaries.add_part(number, &part.body, first_shape + part.first_shape, line);
                inside |= u32::from(begins_inside) << number;
            }
            // The line is outside the whole part, and so outside the solid.
            let is_outside = boundaries.all().len() == before && inside >> number & 1 == 0;
            if is_outside && self.operation.needs(number.into()) {
                boundaries.truncate(0);
                return;
            }
        }
        boundaries.combine(self.operation, inside, self.parts.len());
    }
}
