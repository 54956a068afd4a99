//! The edges of a PLY file, which are drawn as lines.

use super::body::{Body, Piece, RowReader};
use super::faces::checked_index;
use super::header::{Element, PropertyType, ScalarType};
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::marks::{Mark, MarkEnd};

/// The names of the properties that hold the vertices of an edge.
const ENDS: [&str; 2] = ["vertex1", "vertex2"];

/// Returns whether an element has the two vertices of an edge, as integers.
pub(super) fn are_read(element: &Element<'_>) -> bool {
    let has = |name: &str| {
        let found = element.properties.iter().find(|property| property.name == name);
        found.is_some_and(|property| integer_type(property.shape).is_some())
    };
    ENDS.into_iter().all(has)
}

fn integer_type(shape: PropertyType) -> Option<ScalarType> {
    match shape {
        PropertyType::Scalar(kind) if !kind.is_float() => Some(kind),
        _ => None,
    }
}

/// Reads edges. `has_colors` tells whether the vertices have colours.
pub(super) fn read<R: RowReader>(
    element: &Element<'_>,
    vertex_count: u32,
    has_colors: bool,
    body: &mut Body<'_, '_, R>,
) -> Result<(), MeshFault> {
    let material = body.mesh.current_material();
    let read = |Piece { rows, mesh, .. }: &mut Piece<'_, '_, R>, (): &mut ()| {
        let mut ends = [0; 2];
        for property in &element.properties {
            let end = ENDS.iter().position(|name| *name == property.name);
            match (end, integer_type(property.shape)) {
                (Some(end), Some(kind)) => {
                    let at = rows.position();
                    ends[end] =
                        checked_index(rows.integer(kind)?, vertex_count).map_err(|message| rows.fault(at, message))?;
                }
                _ => rows.skip_properties(std::slice::from_ref(property))?,
            }
        }
        let end = |position| MarkEnd { position, color: has_colors.then_some(position) };
        mesh.marks.push(Mark { ends: ends.map(end), material });
        Ok(())
    };
    body.each_row(element, read, |_, _| {})
}
