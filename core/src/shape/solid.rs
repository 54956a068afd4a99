//! Solids: unions, intersections and differences of closed shapes.
//!
//! A line crosses each part in pairs of an entry and an exit. Sorted by t, they divide the line into pieces, on each of
//! which it is known which parts contain it; where the answer for the whole solid changes is a crossing of the solid
//! (Roth, Ray Casting for Modeling Solids, 1982).
//!
//! A formula encloses the points at which it is negative, within its bounds: it becomes the intersection of itself and
//! the shape of its bounds, which cap it. A mesh without open edges encloses a volume, too. The roots of formulas and
//! the triangles of meshes are searched for in front of a ray only.

use super::described::size_in_words;
use super::exact;
use super::placement::{Placeable, Placement};
use super::{Described, Equation, EquationStep, Implicit, Shape, Side, Surface, SurfacePoint};
use crate::bounds::Bounds;
use crate::checks::Message;
use crate::lanes::{F32x8, LANES};
use crate::ray::{EightRays, Interval, Probe, Ray};
use glam::Vec3;
use std::array::from_fn;
use std::sync::Arc;

mod body;
mod boundaries;
mod closed_mesh;
mod formula_roots;
mod written;

use body::Body;
use boundaries::{Boundaries, Boundary, MAX_SHAPES, RayOfSolid};
use formula_roots::FormulaRoots;

/// The operation by which a solid is made of its parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// All that is in at least one part.
    Union,
    /// All that is in every part.
    Intersection,
    /// All that is in the first part and in no other.
    Difference,
}

impl Operation {
    const ALL: [Self; 3] = [Self::Union, Self::Intersection, Self::Difference];

    /// Returns the name of the field of scene files.
    const fn field(self) -> &'static str {
        match self {
            Self::Union => "union",
            Self::Intersection => "intersection",
            Self::Difference => "difference",
        }
    }

    /// Returns whether a point is in the solid whose parts contain it by the mask `inside`.
    fn contains(self, inside: u32, parts: usize) -> bool {
        match self {
            Self::Union => inside != 0,
            Self::Intersection => inside.count_ones() as usize == parts,
            Self::Difference => inside == 1,
        }
    }

    /// Returns whether the solid lies inside the part with this number.
    ///
    /// A line that misses the part misses the solid then.
    fn needs(self, number: usize) -> bool {
        match self {
            Self::Union => false,
            Self::Intersection => true,
            Self::Difference => number == 0,
        }
    }

    /// Returns the bounds of the solid from those of its parts; `None` if it is unbounded.
    fn bounds(self, parts: &[Body]) -> Option<Bounds> {
        let mut bounds = parts.iter().map(Body::bounds);
        match self {
            Self::Difference => bounds.next().flatten(),
            Self::Union => bounds.reduce(|all, one| Some(all?.union(&one?))).flatten(),
            Self::Intersection => {
                bounds.flatten().reduce(|all, one| Bounds { min: all.min.max(one.min), max: all.max.min(one.max) })
            }
        }
    }
}

/// The distance from a hit, relative to its t, within which its boundary is searched for.
// A hundred times the rounding of t to f32.
const NEAR: f32 = 1e-5;

/// A solid that is made of closed shapes.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    operation: Operation,
    parts: Arc<[Part]>,
    bounds: Bounds,
    /// Whether any shape is a formula.
    has_formulas: bool,
    /// Whether boundaries are known in front of a ray only, as those of formulas and meshes are.
    is_known_in_front_only: bool,
}

/// A part of a solid.
#[derive(Debug, PartialEq)]
struct Part {
    body: Body,
    /// A box that no point of the part is outside of; `None` for half spaces.
    bounds: Option<Bounds>,
    /// The number of its first shape among the shapes of all parts.
    first_shape: u8,
}

impl Solid {
    /// Returns a solid of these parts.
    fn new(operation: Operation, parts: Vec<Body>) -> Result<Self, Message> {
        let count: usize = parts.iter().map(Body::shape_count).sum();
        if count > MAX_SHAPES {
            return Err(format!(
                "a solid may have up to {MAX_SHAPES} shapes, where an Implicit counts as two; this one has {count}"
            )
            .into());
        }
        let Some(bounds) = operation.bounds(&parts) else {
            return Err("a Solid must be bounded; a Plane can only cut other parts, in an intersection or after the \
                first part of a difference"
                .into());
        };
        if !bounds.min.cmplt(bounds.max).all() {
            return Err("the parts have no volume in common; nothing is left of the intersection".into());
        }
        let mut first_shape = 0;
        let parts = parts.into_iter().map(|body| {
            let first = first_shape;
            first_shape += body.shape_count() as u8;
            // The box of a sphere is rounded to the nearest numbers, and may cut off the outermost points.
            Part { bounds: body.bounds().map(Bounds::one_step_larger), body, first_shape: first }
        });
        let parts: Arc<[Part]> = parts.collect();
        let has_formulas = parts.iter().any(|part| part.body.has_formulas());
        let is_known_in_front_only = has_formulas || parts.iter().any(|part| part.body.has_meshes());
        // Boundaries in front of the box are not known, so the rounding of the box must not cut off any.
        let bounds = if is_known_in_front_only { bounds.one_step_larger() } else { bounds };
        Ok(Self { operation, parts, bounds, has_formulas, is_known_in_front_only })
    }

    /// Returns the first boundary that a ray may reach, as [`exact::first_in_box`] does.
    fn first(&self, ray: RayOfSolid<'_>, inside: Interval, within: Interval) -> Option<f32> {
        let boundaries = self.boundaries(ray);
        let from = f64::from(inside.min.max(0.0));
        let is_in_front = |t: &f64| *t >= from || !self.is_known_in_front_only;
        exact::first_reached(boundaries.iter().map(|boundary| boundary.t).filter(is_in_front), inside, within)
    }

    /// Returns the number of shapes, those of the solids among the parts counted.
    fn shape_count(&self) -> usize {
        self.parts.iter().map(|part| part.body.shape_count()).sum()
    }

    /// Returns the body with this number among the shapes of all parts.
    fn body(&self, number: u8) -> &Body {
        let part = self.parts.iter().rfind(|part| part.first_shape <= number).unwrap_or(&self.parts[0]);
        match &part.body {
            Body::Shape(Shape::Solid(solid)) => solid.body(number - part.first_shape),
            body => body,
        }
    }

    /// Visits the formulas with their numbers among the shapes of all parts, counted from `first`.
    fn visit_formulas(&self, first: u8, visit: &mut impl FnMut(u8, &Implicit)) {
        for Part { body, first_shape, .. } in &*self.parts {
            match body {
                Body::Shape(Shape::Implicit(implicit)) => visit(first + first_shape, implicit),
                Body::Shape(Shape::Solid(solid)) => solid.visit_formulas(first + first_shape, visit),
                _ => {}
            }
        }
    }

    /// Returns whether any part has interpolated normals.
    pub(crate) fn is_smooth(&self) -> bool {
        self.parts.iter().any(|part| part.body.is_smooth())
    }

    /// Returns whether the solid depends on the time.
    pub(crate) fn moves(&self) -> bool {
        self.parts.iter().any(|part| part.body.moves())
    }

    /// Returns the solid at a time in seconds.
    pub(crate) fn at_time(&self, seconds: f64) -> Self {
        if !self.moves() {
            return self.clone();
        }
        // The bounds of formulas do not move.
        let at_time = |part: &Part| Part { body: part.body.at_time(seconds), ..*part };
        Self { parts: self.parts.iter().map(at_time).collect(), ..self.clone() }
    }

    /// Returns the boundaries along a single ray, those of formulas from a t up to the first one
    /// after another.
    fn boundaries_of_ray(&self, ray: &Ray, [from, until]: [f32; 2]) -> Boundaries {
        let [from, until] = [from, until].map(|number| F32x8([number; LANES]));
        let roots = FormulaRoots::of(self, &EightRays::of(&[*ray]), &from, &until);
        self.boundaries(RayOfSolid { probe: &Probe::new(*ray), roots: &roots, lane: 0 })
    }
}

impl Surface for Solid {
    fn bounds(&self) -> Option<Bounds> {
        Some(self.bounds)
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let inside = self.bounds.crossed(probe);
        if !exact::overlap(inside, within) {
            return None;
        }
        let [from, until] = [inside.min, inside.max.min(within.max)].map(|number| F32x8([number; LANES]));
        let roots = FormulaRoots::of(self, &EightRays::of(&[probe.ray]), &from, &until);
        self.first(RayOfSolid { probe, roots: &roots, lane: 0 }, inside, within)
    }

    fn closest_crossings(&self, rays: &EightRays, inside: &[F32x8; 2], within: &[F32x8; 2]) -> (u32, F32x8) {
        let until = F32x8(from_fn(|lane| inside[1].0[lane].min(within[1].0[lane])));
        let roots = FormulaRoots::of(self, rays, &inside[0], &until);
        exact::first_in_boxes(rays, inside, within, |lane, ray, inside, within| {
            let is_reached = exact::overlap(inside, within);
            is_reached
                .then(|| self.first(RayOfSolid { probe: &Probe::new(*ray), roots: &roots, lane }, inside, within))?
        })
    }

    /// Returns the point on the part that the boundary belongs to; its side is that of the solid.
    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        // Other roots of formulas than those near t are not searched for.
        let size = ray.origin.abs().max_element() / ray.direction.abs().max_element();
        let near = NEAR * t.abs().max(size);
        let off = |boundary: &Boundary| (boundary.t as f32 - t).abs();
        let nearest = |range| {
            let boundaries = self.boundaries_of_ray(ray, range);
            boundaries.iter().min_by(|one, other| off(one).total_cmp(&off(other)))
        };
        let found = nearest([t - near, t + near]).filter(|boundary| off(boundary) <= near);
        let nearest = found.or_else(|| nearest([0.0, f32::MAX]));
        let (shape, triangle, t, enters) =
            nearest.map_or((0, 0, t, true), |found| (found.shape, found.triangle, found.t as f32, found.enters));
        let point = self.body(shape).at_crossing(triangle, ray, t);
        SurfacePoint { side: if enters { Side::Front } else { Side::Back }, ..point }
    }
}

impl Placeable for Solid {
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let parts: Option<Vec<_>> = self.parts.iter().map(|part| part.body.placed(placement)).collect();
        Some(Self::new(self.operation, parts?).ok()?.into())
    }
}

impl Described for Solid {
    const KIND: &'static str = "solid";

    fn described(&self, color: &str) -> String {
        // The shape that caps a formula is not counted.
        let mut count = self.shape_count();
        self.visit_formulas(0, &mut |_, _| count -= 1);
        format!("a {color} solid of {count} shapes, {}", size_in_words(&self.bounds))
    }

    /// Returns the boundaries of the solid, without the equations of its parts.
    fn equation(&self, ray: &Ray) -> Equation {
        let boundaries = self.boundaries_of_ray(ray, [0.0, f32::MAX]);
        let mut roots: Vec<_> = boundaries.iter().map(|boundary| boundary.t).collect();
        if self.is_known_in_front_only {
            roots.retain(|&root| root >= 0.0);
        }
        // Two are shown, preferably in front of the eye.
        let behind = roots.iter().filter(|&&root| root < 0.0).count();
        roots.drain(..behind.min(roots.len().saturating_sub(2)));
        roots.truncate(2);
        let rule = match self.operation {
            Operation::Union => "inside = inside any part",
            Operation::Intersection => "inside = inside all parts",
            Operation::Difference => "inside = in the first part alone",
        };
        let steps = vec![
            EquationStep::Text("o + t d crosses each part"),
            EquationStep::Text(rule),
            EquationStep::Values("t = ", " or ", roots.clone()),
        ];
        Equation { steps, roots, without_root: "miss", is_outside: false }
    }

    fn encloses(&self, point: Vec3) -> bool {
        let encloses = |part: &Part| part.body.encloses(point);
        let inside = (0..).zip(self.parts.iter()).map(|(number, part)| u32::from(encloses(part)) << number);
        self.operation.contains(inside.sum(), self.parts.len())
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
