//! Solids: unions, intersections and differences of closed shapes.
//!
//! A line crosses each part in pairs of an entry and an exit. Sorted by t, they divide the line into pieces, on each of
//! which it is known which parts contain it; where the answer for the whole solid changes is a crossing of the solid
//! (Roth, Ray Casting for Modeling Solids, 1982).

use super::described::size_in_words;
use super::exact;
use super::placement::{Placeable, Placement, WrittenPlacement};
use super::{
    CheckedShape, Described, Equation, EquationStep, Meshes, Shape, Side, Surface, SurfacePoint, WrittenShape,
};
use crate::bounds::Bounds;
use crate::checks::Message;
use crate::lanes::F32x8;
use crate::ray::{EightRays, Interval, Probe, Ray};
use crate::scene_text::{Span, SyntaxNode};
use crate::written::{Fields, InSceneFile, NodeReader, Spanned, Validator};
use glam::Vec3;
use std::sync::Arc;

mod boundaries;

use boundaries::{Boundary, FEW_BOUNDARIES, MAX_BOUNDARIES, MAX_SHAPES};

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
    fn bounds(self, parts: &[Shape]) -> Option<Bounds> {
        let mut bounds = parts.iter().map(Shape::bounds);
        match self {
            Self::Difference => bounds.next().flatten(),
            Self::Union => bounds.reduce(|all, one| Some(all?.union(&one?))).flatten(),
            Self::Intersection => {
                bounds.flatten().reduce(|all, one| Bounds { min: all.min.max(one.min), max: all.max.min(one.max) })
            }
        }
    }
}

/// A solid that is made of closed shapes.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    operation: Operation,
    parts: Arc<[Part]>,
    bounds: Bounds,
    /// Whether no line has more than [`FEW_BOUNDARIES`] boundaries.
    has_few_boundaries: bool,
}

/// A part of a solid.
#[derive(Debug, PartialEq)]
struct Part {
    shape: Shape,
    /// A box that no point of the part is outside of; `None` for half spaces.
    bounds: Option<Bounds>,
    /// The number of its first shape among the shapes of all parts.
    first_shape: u8,
}

impl Solid {
    /// Returns a solid of these parts, which are closed shapes, half spaces (planes) and solids.
    fn new(operation: Operation, parts: Vec<Shape>) -> Result<Self, Message> {
        let count: usize = parts.iter().map(shape_count).sum();
        if count > MAX_SHAPES {
            return Err(format!("a solid may have up to {MAX_SHAPES} shapes; this one has {count}").into());
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
        let parts = parts.into_iter().map(|shape| {
            let first = first_shape;
            first_shape += shape_count(&shape) as u8;
            // The box of a sphere is rounded to the nearest numbers, and may cut off the outermost points.
            Part { bounds: shape.bounds().map(Bounds::one_step_larger), shape, first_shape: first }
        });
        let mut solid = Self { operation, parts: parts.collect(), bounds, has_few_boundaries: false };
        solid.has_few_boundaries = solid.most_boundaries() <= FEW_BOUNDARIES;
        Ok(solid)
    }

    /// Returns the first boundary that a ray may reach, as [`exact::first_in_box`] does.
    fn first(&self, ray: &Ray, inside: Interval, within: Interval) -> Option<f32> {
        if self.has_few_boundaries {
            self.first_boundary::<FEW_BOUNDARIES>(ray, inside, within)
        } else {
            self.first_boundary::<MAX_BOUNDARIES>(ray, inside, within)
        }
    }

    /// Returns the number of shapes, those of the solids among the parts counted.
    fn shape_count(&self) -> usize {
        self.parts.iter().map(|part| shape_count(&part.shape)).sum()
    }

    /// Returns the shape with this number among the shapes of all parts.
    fn shape(&self, number: u8) -> &Shape {
        let part = self.parts.iter().rfind(|part| part.first_shape <= number).unwrap_or(&self.parts[0]);
        match &part.shape {
            Shape::Solid(solid) => solid.shape(number - part.first_shape),
            shape => shape,
        }
    }
}

/// Returns the number of shapes that a shape is made of.
fn shape_count(shape: &Shape) -> usize {
    match shape {
        Shape::Solid(solid) => solid.shape_count(),
        _ => 1,
    }
}

/// Returns whether a shape can be a part of a solid.
fn is_closed(shape: &Shape) -> bool {
    match shape {
        Shape::Cylinder(cylinder) => !cylinder.is_open(),
        Shape::Cone(cone) => !cone.is_open(),
        Shape::Plane(_)
        | Shape::Sphere(_)
        | Shape::Cuboid(_)
        | Shape::Capsule(_)
        | Shape::Ellipsoid(_)
        | Shape::Torus(_)
        | Shape::Solid(_) => true,
        _ => false,
    }
}

impl Surface for Solid {
    fn bounds(&self) -> Option<Bounds> {
        Some(self.bounds)
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        self.first(&probe.ray, self.bounds.crossed(probe), within)
    }

    fn closest_crossings(&self, rays: &EightRays, inside: &[F32x8; 2], within: &[F32x8; 2]) -> (u32, F32x8) {
        exact::first_in_boxes(rays, inside, within, |ray, inside, within| self.first(ray, inside, within))
    }

    /// Returns the point on the part that the boundary belongs to; its side is that of the solid.
    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let off = |boundary: &Boundary| (boundary.t as f32 - t).abs();
        let boundaries = self.boundaries::<MAX_BOUNDARIES>(&Probe::new(*ray));
        let nearest = boundaries.iter().min_by(|one, other| off(one).total_cmp(&off(other)));
        let (shape, t, enters) =
            nearest.map_or((self.shape(0), t, true), |found| (self.shape(found.shape), found.t as f32, found.enters));
        let point = shape.primitive(0).at_crossing(ray, t);
        SurfacePoint { side: if enters { Side::Front } else { Side::Back }, ..point }
    }
}

impl Placeable for Solid {
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let parts: Option<Vec<_>> =
            self.parts.iter().map(|part| part.shape.clone().placed_anywhere(placement)).collect();
        Some(Self::new(self.operation, parts?).ok()?.into())
    }
}

impl Described for Solid {
    const KIND: &'static str = "solid";

    fn described(&self, color: &str) -> String {
        format!("a {color} solid of {} shapes, {}", self.shape_count(), size_in_words(&self.bounds))
    }

    /// Returns the boundaries of the solid, without the equations of its parts.
    fn equation(&self, ray: &Ray) -> Equation {
        let boundaries = self.boundaries::<MAX_BOUNDARIES>(&Probe::new(*ray));
        let mut roots: Vec<_> = boundaries.iter().map(|boundary| boundary.t).collect();
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
        let encloses = |part: &Part| match &part.shape {
            Shape::Plane(plane) => (point.as_dvec3() - plane.point().as_dvec3()).dot(plane.normal().as_dvec3()) < 0.0,
            part => part.encloses(point),
        };
        let inside = (0..).zip(self.parts.iter()).map(|(number, part)| u32::from(encloses(part)) << number);
        self.operation.contains(inside.sum(), self.parts.len())
    }
}

/// A solid as written: `Solid(union: [...])`, `Solid(intersection: [...])` or
/// `Solid(difference: [...])`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenSolid {
    /// The operation and its parts; `None` after a fault.
    parts: Option<(Operation, Spanned<Vec<WrittenPart>>)>,
}

/// A part of a solid as written.
#[derive(Clone, Debug, PartialEq)]
struct WrittenPart {
    shape: Box<WrittenShape>,
    placement: Option<Box<WrittenPlacement>>,
    /// The range of the name of the shape in the text.
    span: Span,
}

impl InSceneFile for Solid {
    type Written = WrittenSolid;

    const NAME: &'static str = "Solid";
    const OWNER: &'static str = "a Solid";
    const FORM: &'static str = "Solid(difference: [Box(...), Sphere(...)])";
    const FIELDS: &'static [&'static str] =
        &[Operation::ALL[0].field(), Operation::ALL[1].field(), Operation::ALL[2].field()];
    const SUMMARY: &'static str = "A solid made of closed shapes; one of the three fields is given.";
    const MEANINGS: &'static [&'static str] = &[
        "shapes, of which it has all that is in any; none",
        "shapes, of which it has what all have in common; none",
        "shapes, of which it has the first one without the others; none",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenSolid {
        let given: Vec<_> = Operation::ALL
            .into_iter()
            .filter_map(|operation| Some((operation, fields.get(operation.field())?)))
            .collect();
        match *given {
            [(operation, node)] => WrittenSolid { parts: read_parts(reader, node).map(|parts| (operation, parts)) },
            [_, (_, second), ..] => {
                reader.fault(second.head(), || {
                    "a Solid has one of union, intersection and difference; make another Solid a part of it".to_owned()
                });
                WrittenSolid { parts: None }
            }
            [] => {
                reader.fault(fields.head(), || {
                    "a Solid needs union, intersection or difference: a list of shapes".to_owned()
                });
                WrittenSolid { parts: None }
            }
        }
    }
}

fn read_parts<'n>(reader: &mut NodeReader<'_>, node: &'n SyntaxNode<'n>) -> Option<Spanned<Vec<WrittenPart>>> {
    let items = reader.list(node, "a list of shapes [Box(...), Sphere(...)]")?;
    let parts = reader.read_all(items, read_part);
    // The fault of a part that could not be read has been reported.
    (parts.len() == items.len()).then_some(Spanned { value: parts, span: node.span })
}

fn read_part(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<WrittenPart> {
    const FORM: &str = "a shape, such as Sphere(center: ..., radius: ...)";
    let name = reader.group_name(node, "a shape", FORM, WrittenShape::NAMES)?;
    let (shape, fields) = WrittenShape::read(name, reader, node)?;
    for of_whole in ["material", "finish", "opacity", "copies"] {
        if let Some(value) = fields.get(of_whole) {
            reader.fault(value.head(), || format!("a part of a Solid has no {of_whole}; give it to the Solid"));
        }
    }
    let placement = WrittenPlacement::read(reader, &fields).map(Box::new);
    Some(WrittenPart { shape: Box::new(shape), placement, span: node.head() })
}

impl WrittenPart {
    fn check(&self, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Shape> {
        if matches!(*self.shape, WrittenShape::Mesh(_) | WrittenShape::Implicit(_)) {
            let owner = self.shape.owner();
            return validator
                .fault(self.span, || format!("{owner} cannot be a part of a Solid; a Box or a Sphere can"));
        }
        let shape = self.shape.check(validator, meshes);
        let placement = self.placement.as_ref().map(|placement| placement.check(validator));
        let shape = shape?;
        if !is_closed(&shape) {
            let kind = shape.kind();
            return validator.fault(self.span, || {
                format!("this {kind} encloses nothing, so it cannot be a part of a Solid; use a closed shape")
            });
        }
        match placement {
            None => Some(shape),
            Some(placements) => {
                let placed = shape.placed(placements?.first()?);
                validator.accept(self.span, placed.map_err(|fault| fault.message().to_owned().into()))
            }
        }
    }
}

impl CheckedShape for Solid {
    fn check(written: &WrittenSolid, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Shape> {
        let (operation, Spanned { value: parts, span }) = written.parts.as_ref()?;
        let checked: Vec<_> = parts.iter().filter_map(|part| part.check(validator, meshes)).collect();
        if checked.len() < parts.len() {
            return None;
        }
        if checked.len() < 2 {
            return validator.fault(*span, || "a Solid needs at least two parts".to_owned());
        }
        validator.accept(*span, Self::new(*operation, checked)).map(Shape::from)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
