//! PLY, as text and as binary in either byte order: faces and triangle strips, normals and colours
//! of vertices. Other elements and properties are skipped, whatever their type and order.

mod header;
mod body;

use super::builder::{MeshBuilder, TriangleIndices, unit};
use super::fault::MeshFault;
use super::{MeshFile, polygon};
use crate::color::{LinearRgb, Srgb8, linear_from_srgb};
use crate::progress::Meter;
use body::{AsciiRows, BinaryRows, RowReader};
use glam::Vec3;
use header::{Element, Encoding, Header, Property, PropertyType, ScalarType};

/// Reads a PLY file.
pub(super) fn read(bytes: &[u8], meter: Meter<'_>) -> Result<MeshFile, MeshFault> {
    let header = Header::read(bytes)?;
    match header.encoding {
        Encoding::Ascii => read_body(&header, AsciiRows::new(bytes, header.end, meter)),
        Encoding::LittleEndian => read_body(&header, BinaryRows::<false>::new(bytes, header.end, meter)),
        Encoding::BigEndian => read_body(&header, BinaryRows::<true>::new(bytes, header.end, meter)),
    }
}

fn read_body(header: &Header<'_>, mut rows: impl RowReader) -> Result<MeshFile, MeshFault> {
    let vertices = header.elements.iter().find(|element| element.name == "vertex");
    let vertex_count = vertices.map_or(0, |element| element.count);
    let mut mesh = MeshBuilder::default();
    for element in &header.elements {
        let indices = element.properties.iter().position(Property::is_indices);
        match (element.name, indices) {
            ("vertex", _) => read_vertices(element, &mut rows, &mut mesh)?,
            ("face", Some(at)) => read_faces(element, at, vertex_count, &mut rows, &mut mesh)?,
            ("tristrips", Some(at)) => read_strips(element, at, vertex_count, &mut rows, &mut mesh)?,
            // Rows without properties take no bytes and are not looped over: the header may claim 4 billion of them.
            _ if element.properties.is_empty() => {}
            _ => each_row(element, &mut rows, |rows| skip_properties(&element.properties, rows))?,
        }
    }
    let is_cloud = !mesh.positions.is_empty();
    mesh.finish(if is_cloud { "it has vertices but no faces (a cloud of points?)" } else { "it has no faces" })
}

/// Calls `read` for each row of an element, between `begin` and `end` of the row.
fn each_row<R: RowReader>(
    element: &Element<'_>,
    rows: &mut R,
    mut read: impl FnMut(&mut R) -> Result<(), MeshFault>,
) -> Result<(), MeshFault> {
    for row in 0..element.count {
        rows.begin_row(element, row)?;
        read(rows)?;
        rows.end_row(element)?;
    }
    Ok(())
}

fn skip_properties(properties: &[Property<'_>], rows: &mut impl RowReader) -> Result<(), MeshFault> {
    properties.iter().try_for_each(|property| match property.shape {
        PropertyType::Scalar(kind) => rows.skip(kind, 1),
        PropertyType::List { length, item } => {
            let length = rows.length(length)?;
            rows.skip(item, length)
        }
    })
}

/// Indices into an array that a row of the vertex element is read into: the first of three for
/// position, normal and colour, and one for values that are skipped. With the array a single pass reads the properties
/// in any order.
const POSITION: usize = 0;
const NORMAL: usize = 3;
const COLOR: usize = 6;
const NOTHING: usize = 9;

/// Returns the array index for the value of a vertex property.
fn slot_of(property: &Property<'_>) -> usize {
    match property.name {
        _ if matches!(property.shape, PropertyType::List { .. }) => NOTHING,
        "x" => POSITION,
        "y" => POSITION + 1,
        "z" => POSITION + 2,
        "nx" => NORMAL,
        "ny" => NORMAL + 1,
        "nz" => NORMAL + 2,
        "red" | "r" | "diffuse_red" => COLOR,
        "green" | "g" | "diffuse_green" => COLOR + 1,
        "blue" | "b" | "diffuse_blue" => COLOR + 2,
        _ => NOTHING,
    }
}

fn read_vertices(element: &Element<'_>, rows: &mut impl RowReader, mesh: &mut MeshBuilder) -> Result<(), MeshFault> {
    let slots: Vec<usize> = element.properties.iter().map(slot_of).collect();
    let has = |group: usize| (group..group + 3).all(|slot| slots.contains(&slot));
    if !has(POSITION) {
        return Err(MeshFault::in_text(element.at, "the element vertex lacks one of the properties x, y and z"));
    }
    let color_type = slots.iter().position(|&slot| slot == COLOR).map(|i| element.properties[i].shape);
    let (has_normals, color_type) = (has(NORMAL), color_type.filter(|_| has(COLOR)));
    let capacity = row_capacity(element, rows);
    // Exact, because a vector that grows by doubling needs up to three times the memory while it is copied.
    mesh.positions.reserve_exact(capacity);
    mesh.normals.values_mut().reserve_exact(if has_normals { capacity } else { 0 });
    mesh.colors.values_mut().reserve_exact(if color_type.is_some() { capacity } else { 0 });
    each_row(element, rows, |rows| {
        // An array on the stack, so that a vertex costs no allocation.
        let mut values = [0.0; NOTHING + 1];
        for (property, &slot) in element.properties.iter().zip(&slots) {
            match property.shape {
                PropertyType::Scalar(kind) if slot < NOTHING => values[slot] = rows.number(kind)?,
                _ => skip_properties(std::slice::from_ref(property), rows)?,
            }
        }
        let [x, y, z, nx, ny, nz, r, g, b, _] = values;
        mesh.positions.push(Vec3::new(x, y, z));
        if has_normals {
            mesh.normals.values_mut().push(unit(Vec3::new(nx, ny, nz).as_dvec3()));
        }
        if let Some(shape) = color_type {
            mesh.colors.values_mut().push(color([r, g, b], shape));
        }
        Ok(())
    })
}

/// Returns the number of rows to reserve memory for: as many as the element claims, but at most as
/// many as the rest of the file can hold.
fn row_capacity(element: &Element<'_>, rows: &impl RowReader) -> usize {
    let least = rows.least_size(&element.properties).max(1);
    (element.count as usize).min(rows.bytes_left() / least)
}

/// Converts sRGB channels of a property type to linear light. Integers range from 0 to the type's
/// maximum, floats from 0 to 1.
fn color(channels: [f32; 3], shape: PropertyType) -> LinearRgb {
    let white = match shape {
        PropertyType::Scalar(ScalarType::U8) => {
            let [r, g, b] = channels.map(|channel| channel.clamp(0.0, 255.0) as u8);
            return LinearRgb::from_srgb8(Srgb8::new(r, g, b));
        }
        PropertyType::Scalar(ScalarType::I8) => f64::from(i8::MAX),
        PropertyType::Scalar(ScalarType::I16) => f64::from(i16::MAX),
        PropertyType::Scalar(ScalarType::U16) => f64::from(u16::MAX),
        PropertyType::Scalar(ScalarType::I32) => f64::from(i32::MAX),
        PropertyType::Scalar(ScalarType::U32) => f64::from(u32::MAX),
        PropertyType::Scalar(ScalarType::F32 | ScalarType::F64) | PropertyType::List { .. } => 1.0,
    };
    let [r, g, b] = channels.map(|channel| linear_from_srgb((f64::from(channel) / white).clamp(0.0, 1.0)) as f32);
    LinearRgb::new(r, g, b)
}

/// Reads faces. Property number `list_index` of the element lists the vertex indices of a face.
fn read_faces(
    element: &Element<'_>,
    list_index: usize,
    vertex_count: u32,
    rows: &mut impl RowReader,
    mesh: &mut MeshBuilder,
) -> Result<(), MeshFault> {
    let (before, indices, after) = split_at_property(element, list_index);
    mesh.triangles.reserve(row_capacity(element, rows));
    // One list, reused for all faces, so that a face costs no allocation.
    let mut corners = Vec::new();
    each_row(element, rows, |rows| {
        skip_properties(before, rows)?;
        let start = rows.position();
        read_corners(indices, vertex_count, rows, &mut corners)?;
        if corners.len() < 3 {
            let message = format!("a face has at least 3 corners; this one has {}", corners.len());
            return Err(rows.fault(start, message));
        }
        for triangle in polygon::triangulated(&corners, &mesh.positions) {
            push(mesh, triangle.map(|i| corners[i]))?;
        }
        skip_properties(after, rows)
    })
}

fn split_at_property<'a, 'b>(
    element: &'b Element<'a>,
    index: usize,
) -> (&'b [Property<'a>], PropertyType, &'b [Property<'a>]) {
    let (before, rest) = element.properties.split_at(index);
    (before, rest[0].shape, &rest[1..])
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
fn checked_index(index: i64, count: u32) -> Result<u32, String> {
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
fn read_strips(
    element: &Element<'_>,
    list_index: usize,
    vertex_count: u32,
    rows: &mut impl RowReader,
    mesh: &mut MeshBuilder,
) -> Result<(), MeshFault> {
    let (before, indices, after) = split_at_property(element, list_index);
    let PropertyType::List { length, item } = indices else { return Ok(()) };
    each_row(element, rows, |rows| {
        skip_properties(before, rows)?;
        let mut strip = Strip::default();
        for _ in 0..rows.length(length)? {
            let position = rows.position();
            match rows.integer(item)? {
                -1 => strip = Strip::default(),
                index => {
                    let corner = checked_index(index, vertex_count).map_err(|message| rows.fault(position, message))?;
                    if let Some(triangle) = strip.next(corner) {
                        push(mesh, triangle)?;
                    }
                }
            }
        }
        skip_properties(after, rows)
    })
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

/// Adds a triangle. In PLY, normals and colours belong to vertices, so they have the indices of the
/// positions.
fn push(mesh: &mut MeshBuilder, positions: [u32; 3]) -> Result<(), MeshFault> {
    let (normals, colors) = (!mesh.normals.values().is_empty(), !mesh.colors.values().is_empty());
    mesh.push(TriangleIndices {
        normals: normals.then_some(positions),
        colors: colors.then_some(positions),
        ..TriangleIndices::new(positions)
    })
}
