//! Wavefront OBJ: polygons, normals, texture coordinates, the colours that some programs write
//! after a position, and materials of MTL files. Lines, points, curves and surfaces are skipped.

use super::builder::{MeshBuilder, TriangleIndices, unit};
use super::fault::{MeshFault, shown};
use super::mtl::{self, Library};
use super::side_files::{SideFiles, local_path};
use super::text::TextCursor;
use super::{MeshFile, polygon};
use crate::color::{LinearRgb, linear_from_srgb};
use crate::progress::Meter;
use glam::{Vec2, Vec3};
use std::path::Path;

/// Reads an OBJ file.
pub(super) fn read(bytes: &[u8], side_files: &mut SideFiles<'_>, mut meter: Meter<'_>) -> Result<MeshFile, MeshFault> {
    // Without this check the message about a binary file would be that its first "word" is not a keyword.
    if let Some(offset) = bytes.iter().position(|&byte| byte == 0) {
        return Err(MeshFault::at_byte(offset, "an OBJ file is text, and this byte is a NUL"));
    }
    let text = TextCursor::new(bytes);
    let mut reader =
        ObjReader { text, mesh: MeshBuilder::default(), library: None, corners: FaceCorners::default(), side_files };
    while reader.text.go_to_statement() {
        meter.advance_to(reader.text.at())?;
        reader.statement()?;
    }
    let ObjReader { mut mesh, library, .. } = reader;
    mesh.materials = library.map(Library::into_materials).unwrap_or_default();
    mesh.finish("it has no faces (f)")
}

struct ObjReader<'a, 'b> {
    text: TextCursor<'a>,
    mesh: MeshBuilder,
    /// The materials of the MTL files named so far; `None` before the first one.
    library: Option<Library>,
    /// The corners of the current face; reused for all faces, so that a face costs no allocation.
    corners: FaceCorners,
    side_files: &'a mut SideFiles<'b>,
}

/// The indices of a face's corners. Either all corners have texture coordinates or none has, and
/// likewise for normals.
#[derive(Default)]
struct FaceCorners {
    positions: Vec<u32>,
    texture_coordinates: Vec<u32>,
    normals: Vec<u32>,
}

impl ObjReader<'_, '_> {
    fn statement(&mut self) -> Result<(), MeshFault> {
        let word = self.text.word();
        let at = self.text.at() - word.len();
        match word {
            b"v" => self.vertex(),
            b"vn" => self.normal(),
            b"vt" => self.texture_coordinate(),
            b"f" | b"fo" => self.face(at),
            b"usemtl" => self.use_material(),
            b"mtllib" => self.library(),
            _ if is_skipped(word) => {
                self.text.skip_line();
                Ok(())
            }
            _ => Err(MeshFault::in_text(at, format!("{} is not a keyword of OBJ (v, vt, vn, f, ...)", shown(word)))),
        }
    }

    /// Reads a vertex: `v x y z`, `v x y z w` or `v x y z r g b`. The weight w is for curves and is
    /// ignored.
    fn vertex(&mut self) -> Result<(), MeshFault> {
        let position = self.numbers()?;
        self.mesh.positions.push(Vec3::from(position));
        if !self.text.is_at_line_end() {
            let fourth = self.text.number()?;
            if !self.text.is_at_line_end() {
                let (fifth, sixth) = (self.text.number()?, self.text.number()?);
                self.add_srgb_color([fourth, fifth, sixth]);
            }
        }
        self.text.end_line()
    }

    fn numbers(&mut self) -> Result<[f32; 3], MeshFault> {
        Ok([self.text.number()?, self.text.number()?, self.text.number()?])
    }

    /// Adds the colour of the last vertex, `encoded` in sRGB. If only some vertices have colours,
    /// the others are white.
    fn add_srgb_color(&mut self, encoded: [f32; 3]) {
        let [r, g, b] = encoded.map(|channel| linear_from_srgb(f64::from(channel.clamp(0.0, 1.0))) as f32);
        self.pad_colors(self.mesh.positions.len() - 1);
        self.mesh.colors.values_mut().push(LinearRgb::new(r, g, b));
    }

    fn pad_colors(&mut self, count: usize) {
        self.mesh.colors.values_mut().resize(count, LinearRgb::grey(1.0));
    }

    fn normal(&mut self) -> Result<(), MeshFault> {
        let direction = self.numbers()?;
        self.mesh.normals.values_mut().push(unit(Vec3::from(direction).as_dvec3()));
        self.text.end_line()
    }

    /// Reads `vt u`, `vt u v` or `vt u v w`. In OBJ files v is measured from the bottom of the
    /// image, in a `MeshFile` from its top.
    fn texture_coordinate(&mut self) -> Result<(), MeshFault> {
        let u = self.text.number()?;
        let v = if self.text.is_at_line_end() { 0.0 } else { self.text.number()? };
        self.mesh.texture_coordinates.values_mut().push(Vec2::new(u, 1.0 - v));
        // The optional third coordinate w is for 3D textures and is ignored.
        self.text.skip_line();
        Ok(())
    }

    fn face(&mut self, at: usize) -> Result<(), MeshFault> {
        self.corners.positions.clear();
        self.corners.texture_coordinates.clear();
        self.corners.normals.clear();
        while !self.text.is_at_line_end() {
            self.corner()?;
        }
        self.text.skip_line();
        let FaceCorners { positions, texture_coordinates, normals } = &self.corners;
        let count = positions.len();
        if count < 3 {
            let message = format!("a face has at least 3 corners; this one has {count}");
            return Err(MeshFault::in_text(at, message));
        }
        let (has_uv, has_normals) = (!texture_coordinates.is_empty(), !normals.is_empty());
        if (has_uv && texture_coordinates.len() != count) || (has_normals && normals.len() != count) {
            let message = "the corners of this face are not written alike: all v, all v/vt, all v//vn or all v/vt/vn";
            return Err(MeshFault::in_text(at, message));
        }
        self.triangles()
    }

    /// Adds the triangles of the current face.
    fn triangles(&mut self) -> Result<(), MeshFault> {
        let has_colors = !self.mesh.colors.values().is_empty();
        // Vertices after the last coloured one have no colour yet, and each position needs one as soon as a triangle
        // uses it.
        if has_colors {
            self.pad_colors(self.mesh.positions.len());
        }
        let FaceCorners { positions, texture_coordinates, normals } = &self.corners;
        let pick = |indices: &[u32], corners: [usize; 3]| corners.map(|i| indices[i]);
        let pick_any = |indices: &[u32], corners| (!indices.is_empty()).then(|| pick(indices, corners));
        for corners in polygon::triangulated(positions, &self.mesh.positions) {
            let positions = pick(positions, corners);
            self.mesh.push(TriangleIndices {
                positions,
                normals: pick_any(normals, corners),
                texture_coordinates: pick_any(texture_coordinates, corners),
                colors: has_colors.then_some(positions),
            })?;
        }
        Ok(())
    }

    /// Reads a corner of a face: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self) -> Result<(), MeshFault> {
        let start = self.text.at();
        let vertex = self.index("vertex", self.mesh.positions.len())?;
        self.corners.positions.push(vertex);
        if self.text.skip_byte(b'/') {
            if !self.text.skip_byte(b'/') {
                let count = self.mesh.texture_coordinates.values().len();
                let texture_coordinate = self.index("texture coordinate", count)?;
                self.corners.texture_coordinates.push(texture_coordinate);
                if !self.text.skip_byte(b'/') {
                    return self.end_corner(start);
                }
            }
            let normal = self.index("normal", self.mesh.normals.values().len())?;
            self.corners.normals.push(normal);
        }
        self.end_corner(start)
    }

    fn end_corner(&mut self, start: usize) -> Result<(), MeshFault> {
        if self.text.is_at_word_end() { Ok(()) } else { Err(self.bad_corner(start)) }
    }

    #[cold]
    fn bad_corner(&mut self, start: usize) -> MeshFault {
        self.text = self.text.cursor_at(start);
        self.text.expected("a corner (v, v/vt, v//vn or v/vt/vn)")
    }

    /// Reads an index that counts from 1 or, if negative, back from the last of `count` items.
    /// Returns it counted from 0.
    #[inline]
    fn index(&mut self, what: &str, count: usize) -> Result<u32, MeshFault> {
        let at = self.text.at();
        let Some(written) = self.text.digits() else { return Err(self.bad_corner(at)) };
        let size = written.unsigned_abs() as usize; // 64 bits on all that termtrace runs on
        let index = if written < 0 { count.checked_sub(size) } else { size.checked_sub(1) };
        match index.filter(|&index| index < count) {
            // No list has 2^31 items, because a file has at most 2^31 bytes.
            Some(index) => Ok(index as u32),
            None => Err(MeshFault::in_text(at, no_such_index(what, written, count))),
        }
    }

    fn use_material(&mut self) -> Result<(), MeshFault> {
        let name = self.text.rest_of_line();
        let at = self.text.at() - name.len();
        let material = match &self.library {
            Some(library) if !is_no_material(name) => match library.index_of(name) {
                // With all MTL files at hand, an unknown material is an error. Otherwise it may be in the missing file.
                None if !library.is_incomplete() => {
                    let name = shown(name);
                    let message = format!("material {name} is not in any MTL file named above this line");
                    return Err(MeshFault::in_text(at, message));
                }
                material => material,
            },
            // A model without its MTL files is shown without its colours.
            _ => None,
        };
        self.mesh.set_material(material);
        self.text.skip_line();
        Ok(())
    }

    fn library(&mut self) -> Result<(), MeshFault> {
        let names = self.text.rest_of_line();
        let at = self.text.at() - names.len();
        let text = String::from_utf8_lossy(names);
        for name in library_names(&text) {
            let path = local_path(Path::new(""), name).map_err(|message| MeshFault::in_text(at, message))?;
            let library = self.library.get_or_insert_default();
            // Some files repeat the same `mtllib` line before each group.
            if library.has_file(&path) {
                continue;
            }
            let bytes = self.side_files.read_colors(&path, "materials").map_err(|message| {
                MeshFault::in_text(
                    at,
                    format!("the materials are missing: {message}; add the file, or remove this line"),
                )
            })?;
            match bytes {
                Some(bytes) => mtl::read(&path, &bytes, self.side_files, library)?,
                None => library.miss(path),
            }
        }
        self.text.skip_line();
        Ok(())
    }
}

fn no_such_index(what: &str, written: i64, count: usize) -> String {
    let are = if count == 1 { "is" } else { "are" };
    match (written, count) {
        (0, _) => format!("there is no {what} 0: the first one is 1, the last one before this line -1"),
        (_, 0) => format!("{what} {written} does not exist: none is defined above this line"),
        _ => format!("{what} {written} does not exist: {count} {are} defined above this line"),
    }
}

/// Returns whether a name is one of those that exporters write for a face without a material.
fn is_no_material(name: &[u8]) -> bool {
    [&b""[..], b"None", b"(null)", b"null"].contains(&name)
}

/// Splits the file names of a `mtllib` line. There may be several, and each may contain blanks: a
/// name ends with `.mtl`.
fn library_names(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    let mut start = 0;
    for (at, _) in text.match_indices([' ', '\t']) {
        let name = &text[start..at];
        let ends = name.len() >= 4 && name.as_bytes()[name.len() - 4..].eq_ignore_ascii_case(b".mtl");
        if ends {
            names.push(name);
        }
        if ends || name.is_empty() {
            start = at + 1;
        }
    }
    names.push(&text[start..]);
    names
}

/// Returns whether a line of an OBJ file may start with this word.
pub(super) fn is_statement(word: &[u8]) -> bool {
    [&b"v"[..], b"vn", b"vt", b"f", b"fo", b"usemtl", b"mtllib"].contains(&word) || is_skipped(word)
}

/// Returns whether a word is a keyword of OBJ that makes no triangles. Any other word is a fault:
/// it is the first sign of a file that is not OBJ.
fn is_skipped(word: &[u8]) -> bool {
    const WORDS: [&str; 38] = [
        "g",
        "o",
        "s",
        "l",
        "p",
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
    ];
    WORDS.iter().any(|known| known.as_bytes() == word)
}
