//! PLY, as text and as binary in either byte order: faces, triangle strips, edges and points, with
//! normals, colours and texture coordinates. Other elements and properties are skipped, whatever their type and order.

mod header;
mod body;
mod edges;
mod faces;
mod vertices;

use super::builder::MeshBuilder;
use super::fault::MeshFault;
use super::side_files::{SideFiles, side_file_path};
use super::texture::{TexelBudget, TexturePlacement, decode};
use super::{CLAY, MeshFile, MeshMaterial};
use crate::color::LinearRgb;
use crate::progress::Meter;
use body::{AsciiRows, BinaryRows, Body, RowReader};
use header::{Encoding, Header, Property};
use std::path::Path;
use std::sync::Arc;

/// Reads a PLY file.
pub(super) fn read(bytes: &[u8], side_files: &mut SideFiles<'_>, meter: Meter<'_>) -> Result<MeshFile, MeshFault> {
    let header = Header::read(bytes, &mut side_files.left_out)?;
    let rows = header.elements.iter().map(|element| element.count as usize).sum::<usize>();
    // The header may claim more rows than the file has bytes.
    side_files.left_out.set_fault_limit_for(rows.min(bytes.len()));
    match header.encoding {
        Encoding::Ascii => read_body(&header, AsciiRows::new(bytes, header.end), side_files, meter),
        Encoding::LittleEndian => read_body(&header, BinaryRows::<false>::new(bytes, header.end), side_files, meter),
        Encoding::BigEndian => read_body(&header, BinaryRows::<true>::new(bytes, header.end), side_files, meter),
    }
}

fn read_body<R: RowReader>(
    header: &Header<'_>,
    rows: R,
    side_files: &mut SideFiles<'_>,
    meter: Meter<'_>,
) -> Result<MeshFile, MeshFault> {
    let vertices = header.elements.iter().find(|element| element.name == "vertex");
    let vertex_count = vertices.map_or(0, |element| element.count);
    let mut mesh = MeshBuilder { materials: materials(header, side_files)?, ..MeshBuilder::default() };
    let material = (!mesh.materials.is_empty()).then_some(0);
    mesh.set_material(material);
    let mut body = Body { rows, mesh, left_out: &mut side_files.left_out, meter };
    let mut has_colors = false;
    for element in &header.elements {
        body.mesh.has_faces |= ["face", "tristrips"].contains(&element.name) && element.count > 0;
        let indices = element.properties.iter().position(Property::is_indices);
        match (element.name, indices) {
            ("vertex", _) => {
                vertices::read(element, &mut body)?;
                // Colours of faces, which come later, have other indices than vertices.
                has_colors = !body.mesh.colors.values().is_empty();
            }
            ("face", Some(at)) => faces::read(element, at, vertex_count, &mut body)?,
            ("tristrips", Some(at)) => faces::read_strips(element, at, vertex_count, &mut body)?,
            ("edge", _) if edges::are_read(element) => edges::read(element, vertex_count, has_colors, &mut body)?,
            // Rows without properties take no bytes and are not looped over: the header may claim 4 billion of them.
            _ if element.properties.is_empty() => {}
            (name, _) => {
                let what = if name == "edge" { "line" } else { "row (of other elements)" };
                body.left_out.not_shown(what, element.count as usize);
                body.each_row(element, |piece, ()| piece.rows.skip_properties(&element.properties), |_, _| {})?;
            }
        }
    }
    let Body { mesh, left_out, .. } = body;
    mesh.finish("it has no faces", left_out)
}

/// Returns the materials of the textures that the header names; none if it names none.
fn materials(header: &Header<'_>, side_files: &mut SideFiles<'_>) -> Result<Vec<MeshMaterial>, MeshFault> {
    let mut budget = TexelBudget::default();
    let mut materials = Vec::new();
    for &name in &header.textures {
        let name = String::from_utf8_lossy(name);
        let read = side_file_path(Path::new(""), &name).and_then(|path| side_files.read_colors(&path, "texture"));
        let decoded = read.and_then(|bytes| bytes.map(|bytes| decode(&bytes, &mut budget)).transpose());
        let (reflectance, texture) = match decoded {
            Ok(Some(texture)) => (LinearRgb::grey(1.0), Some(TexturePlacement::plain(Arc::new(texture)))),
            Ok(None) => (CLAY, None),
            Err(message) => {
                let message = format!("the texture {name} is missing: {message}");
                if !side_files.warn_instead_of_error(&message) {
                    return Err(MeshFault::of_file(message));
                }
                (CLAY, None)
            }
        };
        materials.push(MeshMaterial::opaque(reflectance, texture));
    }
    Ok(materials)
}
