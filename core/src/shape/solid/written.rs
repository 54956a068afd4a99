//! Solids as they are written in scene files.

use super::body::Body;
use super::closed_mesh::ClosedMesh;
use super::{Operation, Solid};
use crate::checks::Message;
use crate::scene_text::{Span, SyntaxNode};
use crate::shape::implicit::WrittenImplicit;
use crate::shape::placement::{OUT_OF_REACH, WrittenPlacement};
use crate::shape::{CheckedShape, Implicit, Mesh, Meshes, Shape, WrittenMesh, WrittenShape};
use crate::written::{Fields, InSceneFile, NodeReader, Spanned, Validator};
use std::sync::Arc;

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
    fn check(&self, validator: &mut Validator<'_>, meshes: &mut dyn Meshes) -> Option<Body> {
        let body = match &*self.shape {
            WrittenShape::Mesh(written) => self.check_mesh(written, validator, meshes),
            WrittenShape::Implicit(written) => self.check_formula(written, validator, meshes),
            shape => shape.check(validator, meshes).and_then(|shape| self.check_shape(shape, validator)),
        };
        let placement = self.placement.as_ref().map(|placement| placement.check(validator));
        let body = body?;
        match placement {
            None => Some(body),
            Some(placements) => {
                let placed = body.placed(placements?.first()?).filter(Body::is_within_reach);
                validator.accept(self.span, placed.ok_or_else(|| OUT_OF_REACH.into()))
            }
        }
    }

    fn check_shape(&self, shape: Shape, validator: &mut Validator<'_>) -> Option<Body> {
        let kind = shape.kind();
        let fault = || format!("this {kind} encloses nothing, so it cannot be a part of a Solid; use a closed shape");
        Body::of_shape(shape).or_else(|| validator.fault(self.span, fault))
    }

    /// Returns the intersection of what a formula encloses and its bounds.
    fn check_formula(
        &self,
        written: &WrittenImplicit,
        validator: &mut Validator<'_>,
        meshes: &mut dyn Meshes,
    ) -> Option<Body> {
        if Implicit::brings_colors(written) {
            return validator
                .fault(self.span, || "a part of a Solid has no color; give the Solid a material".to_owned());
        }
        let Shape::Implicit(formula) = Implicit::check(written, validator, meshes)? else { return None };
        let parts = [formula.shape_of_bounds(), formula.into()].map(Body::Shape);
        validator.accept(self.span, Solid::new(Operation::Intersection, parts.into())).map(Body::from)
    }

    fn check_mesh(
        &self,
        written: &WrittenMesh,
        validator: &mut Validator<'_>,
        meshes: &mut dyn Meshes,
    ) -> Option<Body> {
        let Shape::Mesh(mesh) = Mesh::check(written, validator, meshes)? else { return None };
        let file = mesh.shared_file();
        if file.motion().is_some() {
            return validator.fault(self.span, || "this Mesh moves, so it cannot be a part of a Solid".to_owned());
        }
        let closed = ClosedMesh::new(Arc::clone(file))
            .map_err(|reason| format!("this Mesh encloses no volume, so it cannot be a part of a Solid: {reason}"));
        let mesh = validator.accept(self.span, closed.map_err(Message::from)).map(Body::Mesh)?;
        let is_near = mesh.is_within_reach();
        validator.accept(self.span, is_near.then_some(mesh).ok_or_else(|| OUT_OF_REACH.into()))
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
