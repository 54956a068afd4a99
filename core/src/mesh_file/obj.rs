//! Wavefront OBJ: polygons, normals, texture coordinates, the colours that some programs write
//! after a position, lines, points, and materials of MTL files. Curves and surfaces are not shown.
//!
//! A file is read in two passes over its pieces: first the vertices, to which any later face may refer, then the rest.
//! In between, the materials are read in the order of the file.

mod faces;
mod materials;
mod vertices;

use super::MeshFile;
use super::builder::MeshBuilder;
use super::fault::MeshFault;
use super::mtl::Library;
use super::pieces::parse_in_order;
use super::side_files::SideFiles;
use super::text::{TextCursor, pieces};
use crate::color::LinearRgb;
use crate::progress::Meter;
use faces::{FaceReader, FileParts};
use std::ops::ControlFlow;
use vertices::{VertexPiece, Vertices};

/// Reads an OBJ file.
pub(super) fn read(bytes: &[u8], side_files: &mut SideFiles<'_>, mut meter: Meter<'_>) -> Result<MeshFile, MeshFault> {
    // Without this check the message about a binary file would say that its first "word" is not a keyword.
    if let Some(offset) = bytes.iter().position(|&byte| byte == 0) {
        return Err(MeshFault::at_byte(offset, "an OBJ file is text, and this byte is a NUL"));
    }
    let pieces = pieces(bytes, TextCursor::new(bytes).at(), meter.piece_bytes(), |_| true);
    let Vertices { mesh, first_color, events, pieces } = Vertices::read(bytes, &pieces, side_files, &mut meter)?;
    let MeshBuilder { positions, normals, texture_coordinates, colors, .. } = mesh;
    let (library, changes, mut fault) = materials::read(bytes, &events, side_files);
    let stop = fault.as_ref().map(|(at, _)| *at);
    let parts = FileParts { bytes, positions: &positions, first_color, changes: &changes, stop };
    let mut mesh = MeshBuilder { normals, texture_coordinates, colors, ..MeshBuilder::default() };
    let (mut early_faces, mut colored) = (Vec::new(), mesh.colors.values().len());
    let left_out = &mut side_files.left_out;
    // The second half of the work: the first was reported by the first pass.
    let offsets_of = |piece: &VertexPiece| {
        let half = |offset| usize::midpoint(bytes.len(), offset);
        half(piece.range.start)..half(piece.range.end)
    };
    let parse = |piece: &VertexPiece, left_out: &mut _| {
        let mut reader = FaceReader::of_piece(&parts, piece);
        let read = reader.read(piece, left_out);
        (reader, read)
    };
    parse_in_order(&pieces, offsets_of, (&mut *left_out, &mut meter), parse, |_, reader| {
        colored = colored.max(reader.colored);
        early_faces.extend(reader.early_faces);
        mesh.append(reader.mesh, None)?;
        match fault.take_if(|_| reader.is_stopped) {
            Some((_, fault)) => Err(fault),
            None => Ok(ControlFlow::Continue(())),
        }
    })?;
    let counts = [mesh.texture_coordinates.values().len(), mesh.normals.values().len()];
    let mut reader = FaceReader::at_end(&parts, counts);
    reader.read_early_faces(early_faces, left_out)?;
    colored = colored.max(reader.colored);
    mesh.append(reader.mesh, None)?;
    // Without faces the vertices are points, of the last material.
    mesh.set_material(changes.last().and_then(|&(_, material)| material));
    mesh.positions = positions;
    // Vertices without a colour, after or between those with one, are white.
    mesh.colors.values_mut().resize(colored, LinearRgb::grey(1.0));
    (mesh.materials, mesh.not_shown) = library.map(Library::into_materials_and_unshown).unwrap_or_default();
    mesh.finish("it has no faces (f) and no vertices", left_out)
}

/// A statement about materials: its byte offset, and whether it names MTL files.
struct MaterialEvent {
    at: usize,
    is_library: bool,
}

/// Moves past the statement that begins with `word`, which the cursor has passed.
///
/// The numbers of a statement may go on in the next line, after a backslash.
fn skip_statement(text: &mut TextCursor<'_>, word: &[u8]) {
    match word {
        b"v" | b"vn" | b"vt" | b"f" | b"fo" | b"l" | b"p" => text.skip_continued_line(),
        _ => text.skip_line(),
    }
}

/// Returns whether a line of an OBJ file may start with this word.
pub(super) fn is_statement(word: &[u8]) -> bool {
    [&b"v"[..], b"vn", b"vt", b"f", b"fo", b"l", b"p", b"usemtl", b"mtllib"].contains(&word) || is_skipped(word)
}

/// Returns whether a word is a keyword of OBJ whose line is skipped, because it adds no triangles.
/// A word that is not a keyword of OBJ is a fault: it is the first sign of a file that is not OBJ.
fn is_skipped(word: &[u8]) -> bool {
    const WORDS: [&str; 38] = [
        "g",
        "o",
        "s",
        "vp",
        "mg",
        "deg",
        "bmat",
        "step",
        "cstype",
        "curv",
        "curv2",
        "surf",
        "parm",
        "trim",
        "hole",
        "scrv",
        "sp",
        "end",
        "con",
        "bevel",
        "c_interp",
        "d_interp",
        "lod",
        "shadow_obj",
        "trace_obj",
        "ctech",
        "stech",
        "maplib",
        "usemap",
        "call",
        "csh",
        "bzp",
        "bsp",
        "cdc",
        "cdp",
        "res",
        // Extensions by other programs: OpenSubdiv's tags, and the weights of joints.
        "t",
        "vw",
    ];
    WORDS.iter().any(|known| known.as_bytes() == word)
}
