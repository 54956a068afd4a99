//! The faces and triangle strips of a PLY file.

use super::body::{Body, Piece, RowReader};
use super::header::{Element, Property, PropertyType, ScalarType};
use super::vertices::{color, color_channel, row_capacity, texture_coordinate};
use crate::color::LinearRgb;
use crate::mesh_file::attribute::of_piece;
use crate::mesh_file::builder::{MeshBuilder, TriangleIndices};
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::polygon;
use glam::Vec3;

/// A face, which is filled property by property as its row is read.
#[derive(Default)]
struct Face {
    /// The vertex indices of its corners.
    corners: Vec<u32>,
    /// The u and v of its corners.
    texture_coordinates: Vec<f32>,
    texture: usize,
    color: [f32; 3],
}

/// The meaning of a property of a face.
enum Role {
    Corners,
    TextureCoordinates(ScalarType, ScalarType),
    Texture(ScalarType),
    Color(usize, ScalarType),
    Other,
}

impl Role {
    /// Returns the role of property number `i`. Property number `list_index` lists the corners.
    fn of(property: &Property<'_>, i: usize, list_index: usize, has_texture: bool) -> Self {
        match property.shape {
            _ if i == list_index => Self::Corners,
            PropertyType::List { length, item } if has_texture && property.is_list("texcoord") => {
                Self::TextureCoordinates(length, item)
            }
            PropertyType::Scalar(kind) if has_texture && property.name == "texnumber" => Self::Texture(kind),
            PropertyType::Scalar(kind) => {
                color_channel(property).map_or(Self::Other, |channel| Self::Color(channel, kind))
            }
            PropertyType::List { .. } => Self::Other,
        }
    }
}

/// Reads faces. Property number `list_index` of the element lists the vertex indices of a face.
pub(super) fn read<R: RowReader>(
    element: &Element<'_>,
    list_index: usize,
    vertex_count: u32,
    body: &mut Body<'_, '_, R>,
) -> Result<(), MeshFault> {
    let material_count = body.mesh.materials.len();
    let role = |(i, property)| Role::of(property, i, list_index, material_count > 0);
    let roles: Vec<Role> = element.properties.iter().enumerate().map(role).collect();
    let color_type = element.properties.iter().find(|property| color_channel(property) == Some(0)).map(|red| red.shape);
    body.mesh.triangles.reserve(row_capacity(element, &body.rows));
    // Faces add no positions, so that all pieces can use those of the mesh.
    let positions = std::mem::take(&mut body.mesh.positions);
    let surroundings =
        Surroundings { attributes: VertexAttributes::of(&body.mesh), positions: &positions, material_count };
    let read = |Piece { rows, mesh, .. }: &mut Piece<'_, '_, R>, face: &mut Face| {
        let start = rows.position();
        for (property, role) in element.properties.iter().zip(&roles) {
            match *role {
                Role::Corners => read_corners(property.shape, vertex_count, rows, &mut face.corners)?,
                Role::TextureCoordinates(length, item) => {
                    face.texture_coordinates.clear();
                    for _ in 0..rows.length(length)? {
                        face.texture_coordinates.push(rows.any_number(item)?);
                    }
                }
                Role::Texture(kind) => face.texture = rows.any_number(kind)?.max(0.0) as usize,
                Role::Color(channel, kind) => face.color[channel] = rows.any_number(kind)?,
                Role::Other => rows.skip_properties(std::slice::from_ref(property))?,
            }
        }
        if face.corners.len() < 3 {
            let message = format!("a face has at least 3 corners; this one has {}", face.corners.len());
            return Err(rows.fault(start, message));
        }
        face.add_to(mesh, &surroundings, color_type.map(|shape| color(face.color, shape)))
    };
    let read = body.each_row(element, read, |_, _| {});
    body.mesh.positions = positions;
    read
}

/// The parts of the whole mesh that the faces of a piece use.
struct Surroundings<'m> {
    attributes: VertexAttributes,
    positions: &'m [Vec3],
    material_count: usize,
}

impl Face {
    /// Adds the triangles of the face, which has the colour `color`, to those of its piece.
    fn add_to(
        &self,
        mesh: &mut MeshBuilder,
        surroundings: &Surroundings<'_>,
        color: Option<LinearRgb>,
    ) -> Result<(), MeshFault> {
        let (corners, material_count) = (&self.corners, surroundings.material_count);
        if material_count > 1 && self.texture < material_count {
            mesh.set_material(Some(self.texture as u32)); // fewer than the file's bytes
        }
        let own_colors = color.map(|color| of_piece(index_of_last(mesh.colors.values_mut(), color)));
        let first_coordinate = (self.texture_coordinates.len() == 2 * corners.len()).then(|| {
            let values = mesh.texture_coordinates.values_mut();
            let first = values.len() as u32; // fewer than the file's bytes
            values.extend(self.texture_coordinates.chunks_exact(2).map(|uv| texture_coordinate(uv[0], uv[1])));
            first
        });
        for triangle in polygon::triangulated(corners, surroundings.positions) {
            let indices = surroundings.attributes.indices(triangle.map(|i| corners[i]));
            mesh.push(TriangleIndices {
                colors: own_colors.map(|color| [color; 3]).or(indices.colors),
                texture_coordinates: first_coordinate
                    .map(|first| triangle.map(|i| of_piece(first + i as u32)))
                    .or(indices.texture_coordinates),
                ..indices
            })?;
        }
        Ok(())
    }
}

/// Adds a colour to the list, unless it equals the last one, and returns its index.
fn index_of_last(colors: &mut Vec<LinearRgb>, color: LinearRgb) -> u32 {
    if colors.last() != Some(&color) {
        colors.push(color);
    }
    colors.len() as u32 - 1 // fewer than the file's bytes
}

fn read_corners(
    indices: PropertyType,
    vertex_count: u32,
    rows: &mut impl RowReader,
    corners: &mut Vec<u32>,
) -> Result<(), MeshFault> {
    let PropertyType::List { length, item } = indices else { return Ok(()) };
    corners.clear();
    for _ in 0..rows.length(length)? {
        let position = rows.position();
        let index = rows.integer(item)?;
        corners.push(checked_index(index, vertex_count).map_err(|message| rows.fault(position, message))?);
    }
    Ok(())
}

#[inline]
pub(super) fn checked_index(index: i64, count: u32) -> Result<u32, String> {
    u32::try_from(index).ok().filter(|&index| index < count).ok_or_else(|| no_such_vertex(index, count))
}

#[cold]
fn no_such_vertex(index: i64, count: u32) -> String {
    match count.checked_sub(1) {
        Some(last) => format!("vertex {index} does not exist: they are counted from 0 to {last}"),
        None => format!("vertex {index} does not exist: the file has no vertices"),
    }
}

/// Reads triangle strips, as in the older files of the Stanford repository.
///
/// Property number `list_index` lists vertex indices, where -1 ends a strip.
pub(super) fn read_strips<R: RowReader>(
    element: &Element<'_>,
    list_index: usize,
    vertex_count: u32,
    body: &mut Body<'_, '_, R>,
) -> Result<(), MeshFault> {
    let (before, rest) = element.properties.split_at(list_index);
    let PropertyType::List { length, item } = rest[0].shape else { return Ok(()) };
    let attributes = VertexAttributes::of(&body.mesh);
    let read = |Piece { rows, mesh, .. }: &mut Piece<'_, '_, R>, (): &mut ()| {
        rows.skip_properties(before)?;
        let mut strip = Strip::default();
        for _ in 0..rows.length(length)? {
            let position = rows.position();
            match rows.integer(item)? {
                -1 => strip = Strip::default(),
                index => {
                    let corner = checked_index(index, vertex_count).map_err(|message| rows.fault(position, message))?;
                    if let Some(triangle) = strip.next(corner) {
                        mesh.push(attributes.indices(triangle))?;
                    }
                }
            }
        }
        rows.skip_properties(&rest[1..])
    };
    body.each_row(element, read, |_, _| {})
}

/// The last two corners of a strip, and the number of corners so far.
#[derive(Default)]
struct Strip {
    last: [u32; 2],
    length: usize,
}

impl Strip {
    /// Adds a corner and returns the triangle that it completes. In a strip the orientation
    /// alternates, so two corners of every second triangle are exchanged.
    fn next(&mut self, corner: u32) -> Option<[u32; 3]> {
        let [a, b] = self.last;
        self.last = [b, corner];
        self.length += 1;
        let triangle = if self.length.is_multiple_of(2) { [b, a, corner] } else { [a, b, corner] };
        (self.length >= 3).then_some(triangle)
    }
}

/// The attributes that vertices have. In PLY, these have the indices of the positions.
#[derive(Clone, Copy)]
struct VertexAttributes {
    normals: bool,
    texture_coordinates: bool,
    colors: bool,
}

impl VertexAttributes {
    /// Returns the attributes of the vertices of a mesh that has no faces yet.
    fn of(mesh: &MeshBuilder) -> Self {
        Self {
            normals: !mesh.normals.values().is_empty(),
            texture_coordinates: !mesh.texture_coordinates.values().is_empty(),
            colors: !mesh.colors.values().is_empty(),
        }
    }

    fn indices(self, positions: [u32; 3]) -> TriangleIndices {
        TriangleIndices {
            positions,
            normals: self.normals.then_some(positions),
            texture_coordinates: self.texture_coordinates.then_some(positions),
            colors: self.colors.then_some(positions),
        }
    }
}
