//! The vertices of a PLY file.

use super::body::{Body, Piece, RowReader};
use super::header::{Element, Property, PropertyType, ScalarType};
use crate::color::{LinearRgb, Srgb8, linear_from_srgb};
use crate::mesh_file::builder::{MeshBuilder, unit};
use crate::mesh_file::fault::MeshFault;
use glam::{Vec2, Vec3};

/// Indices into an array that a row of the vertex element is read into: the first one for position,
/// normal, colour and texture coordinate, and one for values that are skipped. With the array a single pass reads the
/// properties in any order.
const POSITION: usize = 0;
const NORMAL: usize = 3;
const COLOR: usize = 6;
const TEXTURE: usize = 9;
const SKIPPED: usize = 11;

/// Returns the array index for the value of a vertex property.
fn slot_of(property: &Property<'_>) -> usize {
    match property.name {
        _ if matches!(property.shape, PropertyType::List { .. }) => SKIPPED,
        "x" => POSITION,
        "y" => POSITION + 1,
        "z" => POSITION + 2,
        "nx" => NORMAL,
        "ny" => NORMAL + 1,
        "nz" => NORMAL + 2,
        "s" | "u" | "texture_u" => TEXTURE,
        "t" | "v" | "texture_v" => TEXTURE + 1,
        _ => color_channel(property).map_or(SKIPPED, |channel| COLOR + channel),
    }
}

/// Returns the colour channel that a property holds: 0 for red, 1 for green, 2 for blue.
pub(super) fn color_channel(property: &Property<'_>) -> Option<usize> {
    match property.name {
        _ if matches!(property.shape, PropertyType::List { .. }) => None,
        "red" | "r" | "diffuse_red" => Some(0),
        "green" | "g" | "diffuse_green" => Some(1),
        "blue" | "b" | "diffuse_blue" => Some(2),
        _ => None,
    }
}

pub(super) fn read<R: RowReader>(element: &Element<'_>, body: &mut Body<'_, '_, R>) -> Result<(), MeshFault> {
    let slots: Vec<usize> = element.properties.iter().map(slot_of).collect();
    let has = |group: usize, count: usize| (group..group + count).all(|slot| slots.contains(&slot));
    if !has(POSITION, 3) {
        return Err(MeshFault::in_text(element.at, "the element vertex lacks one of the properties x, y and z"));
    }
    let color_type = slots.iter().position(|&slot| slot == COLOR).map(|i| element.properties[i].shape);
    let (has_normals, color_type) = (has(NORMAL, 3), color_type.filter(|_| has(COLOR, 3)));
    // Without a texture, texture coordinates would only take memory.
    let has_texture = has(TEXTURE, 2) && !body.mesh.materials.is_empty();
    let (capacity, mesh) = (row_capacity(element, &body.rows), &mut body.mesh);
    // Reserved exactly, because a vector that doubles needs up to three times the memory while it is copied.
    mesh.positions.reserve_exact(capacity);
    mesh.normals.values_mut().reserve_exact(if has_normals { capacity } else { 0 });
    mesh.colors.values_mut().reserve_exact(if color_type.is_some() { capacity } else { 0 });
    mesh.texture_coordinates.values_mut().reserve_exact(if has_texture { capacity } else { 0 });
    let read = |Piece { rows, mesh, left_out }: &mut Piece<'_, '_, R>, (): &mut ()| {
        // An array on the stack, so that a vertex costs no allocation.
        let mut values = [0.0; SKIPPED + 1];
        for (property, &slot) in element.properties.iter().zip(&slots) {
            match property.shape {
                PropertyType::Scalar(kind) if slot < NORMAL => values[slot] = rows.number(kind)?,
                PropertyType::Scalar(kind) if slot < SKIPPED => values[slot] = rows.any_number(kind)?,
                _ => rows.skip_properties(std::slice::from_ref(property))?,
            }
        }
        let [x, y, z, nx, ny, nz, r, g, b, u, v, ..] = values;
        mesh.positions.push(Vec3::new(x, y, z));
        if has_normals {
            let normal = Vec3::new(nx, ny, nz);
            if !normal.is_finite() {
                left_out.not_shown("normal (not finite)", 1);
            }
            mesh.normals.values_mut().push(unit(normal.as_dvec3()));
        }
        if let Some(shape) = color_type {
            mesh.colors.values_mut().push(color([r, g, b], shape));
        }
        if has_texture {
            mesh.texture_coordinates.values_mut().push(texture_coordinate(u, v));
        }
        Ok(())
    };
    // A faulty vertex still takes up its number, so that the indices of later ones are right.
    let leave_out = |mesh: &mut MeshBuilder, row: usize| {
        mesh.positions.resize(row + 1, Vec3::NAN);
        mesh.normals.values_mut().resize(if has_normals { row + 1 } else { 0 }, Vec3::ZERO);
        mesh.colors.values_mut().resize(if color_type.is_some() { row + 1 } else { 0 }, LinearRgb::BLACK);
        mesh.texture_coordinates.values_mut().resize(if has_texture { row + 1 } else { 0 }, Vec2::ZERO);
    };
    body.each_row(element, read, leave_out)
}

/// Converts texture coordinates: v is measured from the bottom of the image in PLY files, and from
/// its top in a mesh.
pub(super) fn texture_coordinate(u: f32, v: f32) -> Vec2 {
    let at = Vec2::new(u, 1.0 - v);
    if at.is_finite() { at } else { Vec2::ZERO }
}

/// Returns the number of rows to reserve memory for: as many as the element claims, but at most as
/// many as the rest of the file can hold.
pub(super) fn row_capacity(element: &Element<'_>, rows: &impl RowReader) -> usize {
    let least = rows.least_size(&element.properties).max(1);
    (element.count as usize).min(rows.bytes_left() / least)
}

/// Converts sRGB channels of a property type to linear light. Integers range from 0 to the type's
/// maximum, floats from 0 to 1.
pub(super) fn color(channels: [f32; 3], shape: PropertyType) -> LinearRgb {
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
    // `max` makes 0 of NaN.
    let [r, g, b] =
        channels.map(|channel| linear_from_srgb((f64::from(channel.max(0.0)) / white).clamp(0.0, 1.0)) as f32);
    LinearRgb::new(r, g, b)
}
