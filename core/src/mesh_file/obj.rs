//! Wavefront OBJ: polygons, normals, texture coordinates, the colours that some programs write
//! after a position, lines, points, and materials of MTL files. Curves and surfaces are not shown.

use super::builder::{MeshBuilder, TriangleIndices, unit};
use super::fault::{MeshFault, shown};
use super::marks::{Mark, MarkEnd};
use super::mtl::{self, Library};
use super::side_files::{SideFiles, side_file_path};
use super::text::{TextCursor, without_utf16};
use super::{MeshFile, polygon};
use crate::color::{LinearRgb, linear_from_srgb};
use crate::progress::Meter;
use glam::{Vec2, Vec3};
use std::path::{Path, PathBuf};

/// Reads an OBJ file.
pub(super) fn read(bytes: &[u8], side_files: &mut SideFiles<'_>, mut meter: Meter<'_>) -> Result<MeshFile, MeshFault> {
    // Without this check the message about a binary file would say that its first "word" is not a keyword.
    if let Some(offset) = bytes.iter().position(|&byte| byte == 0) {
        return Err(MeshFault::at_byte(offset, "an OBJ file is text, and this byte is a NUL"));
    }
    let text = TextCursor::new(bytes);
    let mut reader = ObjReader {
        text,
        mesh: MeshBuilder::default(),
        library: None,
        corners: FaceCorners::default(),
        early_faces: Vec::new(),
        side_files,
    };
    while reader.text.go_to_statement() {
        let start = reader.text.at();
        meter.advance_to(start)?;
        if let Err(fault) = reader.statement() {
            reader.side_files.left_out.leave_out(fault)?;
            reader.skip_faulty_line(start);
        }
    }
    reader.early_faces()?;
    let ObjReader { mut mesh, library, side_files, .. } = reader;
    (mesh.materials, mesh.not_shown) = library.map(Library::into_materials_and_unshown).unwrap_or_default();
    mesh.finish("it has no faces (f) and no vertices", &mut side_files.left_out)
}

struct ObjReader<'a, 'b> {
    text: TextCursor<'a>,
    mesh: MeshBuilder,
    /// The materials of the MTL files named so far; `None` before the first one.
    library: Option<Library>,
    /// The corners of the current face; reused for all faces, so that a face costs no allocation.
    corners: FaceCorners,
    /// The offsets and materials of the faces that come before one of their vertices.
    early_faces: Vec<(u32, Option<u32>)>,
    side_files: &'a mut SideFiles<'b>,
}

/// The indices of a face's corners; [`NONE`] for a texture coordinate or normal that is missing.
#[derive(Default)]
struct FaceCorners {
    positions: Vec<u32>,
    texture_coordinates: Vec<u32>,
    normals: Vec<u32>,
}

/// The index of a texture coordinate or normal that a corner lacks.
// No valid index is this large, because a file has at most 2^31 bytes.
const NONE: u32 = u32::MAX;

impl ObjReader<'_, '_> {
    fn statement(&mut self) -> Result<(), MeshFault> {
        let word = self.text.word();
        let at = self.text.at() - word.len();
        match word {
            b"v" => self.vertex(),
            b"vn" => self.normal(),
            b"vt" => self.texture_coordinate(),
            b"f" | b"fo" => self.face(at),
            b"l" | b"p" => {
                self.marks(word == b"l");
                Ok(())
            }
            b"usemtl" => self.use_material(),
            b"mtllib" => self.library(),
            _ if is_skipped(word) => {
                self.count_not_shown(word);
                self.text.skip_line();
                Ok(())
            }
            _ => Err(MeshFault::in_text(at, format!("{} is not a keyword of OBJ (v, vt, vn, f, ...)", shown(word)))),
        }
    }

    /// Counts the curve or surface of a statement with the keyword `word`.
    fn count_not_shown(&mut self, word: &[u8]) {
        let what = match word {
            b"curv" | b"curv2" => "curve",
            b"surf" => "curved surface",
            _ => return,
        };
        self.mesh.has_faces = true;
        self.side_files.left_out.not_shown(what, 1);
    }

    /// Reads the points `p v v ...`, or the line `l v v ...`, where `/vt` may follow each vertex.
    ///
    /// A point, or a part of a line, whose vertex does not exist above is not shown.
    fn marks(&mut self, is_line: bool) {
        let has_colors = !self.mesh.colors.values().is_empty();
        if has_colors {
            self.pad_colors(self.mesh.positions.len());
        }
        let material = self.mesh.current_material();
        let mut last = None;
        while !self.text.is_at_line_end() {
            let vertex = self.index("vertex", self.mesh.positions.len()).ok();
            // The rest of the word, with the index of a texture coordinate.
            if !self.text.is_at_word_end() {
                self.text.word();
            }
            let end = vertex.map(|position| MarkEnd { position, color: has_colors.then_some(position) });
            match (last.replace(end), end) {
                (_, Some(end)) if !is_line => self.mesh.marks.push(Mark { ends: [end; 2], material }),
                (Some(Some(last)), Some(end)) => self.mesh.marks.push(Mark { ends: [last, end], material }),
                (_, None) => self.side_files.left_out.not_shown(if is_line { "line" } else { "point" }, 1),
                _ => {}
            }
        }
        self.text.skip_line();
    }

    /// Skips the faulty line that begins at `line_start`.
    ///
    /// A faulty vertex, normal or texture coordinate still takes up its number, so that the indices of later ones are
    /// right.
    fn skip_faulty_line(&mut self, line_start: usize) {
        self.text = self.text.cursor_at(line_start);
        match self.text.word() {
            // `MeshBuilder::finish` flattens the triangles at a position that is not finite.
            b"v" => self.mesh.positions.push(Vec3::NAN),
            b"vn" => self.mesh.normals.values_mut().push(Vec3::ZERO),
            b"vt" => self.mesh.texture_coordinates.values_mut().push(Vec2::ZERO),
            _ => {}
        }
        self.text.skip_line();
    }

    /// Reads a vertex: `v x y z`, `v x y z w`, `v x y z r g b` or `v x y z r g b a`.
    ///
    /// The weight w is for curves and is ignored, as is the opacity a.
    fn vertex(&mut self) -> Result<(), MeshFault> {
        let position = self.numbers()?;
        let mut color = None;
        if !self.text.is_at_line_end() {
            let fourth = self.text.number()?;
            if !self.text.is_at_line_end() {
                color = Some([fourth, self.text.number()?, self.text.number()?]);
                if !self.text.is_at_line_end() {
                    self.text.number()?;
                }
            }
        }
        self.text.end_line()?;
        self.mesh.positions.push(Vec3::from(position));
        if let Some(color) = color {
            self.add_srgb_color(color);
        }
        Ok(())
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

    /// Reads `vn x y z`. A normal that is not finite counts as none.
    fn normal(&mut self) -> Result<(), MeshFault> {
        let direction = Vec3::new(self.text.any_number()?, self.text.any_number()?, self.text.any_number()?);
        self.text.end_line()?;
        self.mesh.normals.values_mut().push(unit(direction.as_dvec3()));
        if !direction.is_finite() {
            self.side_files.left_out.not_shown("normal (not finite)", 1);
        }
        Ok(())
    }

    /// Reads `vt u`, `vt u v` or `vt u v w`. In OBJ files v is measured from the bottom of the
    /// image, in a `MeshFile` from its top.
    fn texture_coordinate(&mut self) -> Result<(), MeshFault> {
        let u = self.text.any_number()?;
        let v = if self.text.is_at_line_end() { 0.0 } else { self.text.any_number()? };
        let mut uv = Vec2::new(u, 1.0 - v);
        if !uv.is_finite() {
            self.side_files.left_out.not_shown("texture coordinate (not finite)", 1);
            uv = Vec2::ZERO;
        }
        self.mesh.texture_coordinates.values_mut().push(uv);
        // The optional third coordinate w is for 3D textures and is ignored.
        self.text.skip_line();
        Ok(())
    }

    /// Reads a face whose keyword is at `at`.
    ///
    /// If some of its vertices come later in the file, the face is read at the end of the file.
    fn face(&mut self, at: usize) -> Result<(), MeshFault> {
        self.mesh.has_faces = true;
        let start = self.text.at();
        match self.face_corners() {
            Err(Corner::Early(_)) => {
                self.early_faces.push((start as u32, self.mesh.current_material())); // a file has at most 2^31 bytes
                self.text.skip_line();
                return Ok(());
            }
            Err(Corner::Faulty(fault)) => return Err(fault),
            Ok(()) => self.text.skip_line(),
        }
        self.add_face(at)
    }

    /// Reads the faces that come before their vertices.
    fn early_faces(&mut self) -> Result<(), MeshFault> {
        for (start, material) in std::mem::take(&mut self.early_faces) {
            self.text = self.text.cursor_at(start as usize);
            self.mesh.set_material(material);
            let read = match self.face_corners() {
                Ok(()) => self.add_face(start as usize),
                Err(Corner::Early(fault) | Corner::Faulty(fault)) => Err(fault),
            };
            if let Err(fault) = read {
                self.side_files.left_out.leave_out(fault)?;
            }
        }
        Ok(())
    }

    fn face_corners(&mut self) -> Result<(), Corner> {
        self.corners.positions.clear();
        self.corners.texture_coordinates.clear();
        self.corners.normals.clear();
        while !self.text.is_at_line_end() {
            self.corner()?;
        }
        Ok(())
    }

    /// Adds the triangles of the face at byte `face_at`, whose corners have been read.
    fn add_face(&mut self, face_at: usize) -> Result<(), MeshFault> {
        let FaceCorners { positions, texture_coordinates, normals } = &mut self.corners;
        let count = positions.len();
        if count < 3 {
            let message = format!("a face has at least 3 corners; this one has {count}");
            return Err(MeshFault::in_text(face_at, message));
        }
        let mut is_uneven = false;
        for indices in [texture_coordinates, normals] {
            if indices.contains(&NONE) {
                is_uneven |= indices.iter().any(|&index| index != NONE);
                indices.clear();
            }
        }
        if is_uneven {
            let message = "the corners of this face are not written alike: all v, all v/vt, all v//vn or all v/vt/vn";
            self.side_files.left_out.leave_out(MeshFault::in_text(face_at, message))?;
        }
        self.add_triangles()
    }

    /// Adds the triangles of the current face.
    fn add_triangles(&mut self) -> Result<(), MeshFault> {
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

    /// Reads a corner of a face: `v`, `v/vt`, `v//vn` or `v/vt/vn`. After a slash the index may be
    /// missing.
    #[inline]
    fn corner(&mut self) -> Result<(), Corner> {
        let start = self.text.at();
        let vertex = self.index("vertex", self.mesh.positions.len())?;
        let (mut texture_coordinate, mut normal) = (NONE, NONE);
        if self.text.skip_byte(b'/') {
            if !self.text.is_at_slash() && !self.text.is_at_word_end() {
                let count = self.mesh.texture_coordinates.values().len();
                texture_coordinate = self.index("texture coordinate", count)?;
            }
            if self.text.skip_byte(b'/') && !self.text.is_at_word_end() {
                normal = self.index("normal", self.mesh.normals.values().len())?;
            }
        }
        if !self.text.is_at_word_end() {
            return Err(Corner::Faulty(self.bad_corner(start)));
        }
        self.corners.positions.push(vertex);
        self.corners.texture_coordinates.push(texture_coordinate);
        self.corners.normals.push(normal);
        Ok(())
    }

    #[cold]
    fn bad_corner(&mut self, start: usize) -> MeshFault {
        self.text = self.text.cursor_at(start);
        self.text.expected("a corner (v, v/vt, v//vn or v/vt/vn)")
    }

    /// Reads an index that counts from 1 or, if negative, back from the last of `count` items.
    /// Returns it counted from 0.
    #[inline]
    fn index(&mut self, what: &str, count: usize) -> Result<u32, Corner> {
        let at = self.text.at();
        let Some(written) = self.text.digits() else { return Err(Corner::Faulty(self.bad_corner(at))) };
        let size = written.unsigned_abs() as usize; // 64 bits on all that termtrace runs on
        let index = if written < 0 { count.checked_sub(size) } else { size.checked_sub(1) };
        match index.filter(|&index| index < count) {
            // No list has 2^31 items, because a file has at most 2^31 bytes.
            Some(index) => Ok(index as u32),
            None => Err(no_such_index(at, what, written, count)),
        }
    }

    fn use_material(&mut self) -> Result<(), MeshFault> {
        let name = self.text.rest_of_line();
        let at = self.text.at() - name.len();
        // A model without its MTL files is shown without its colours.
        let material = self.library.as_ref().and_then(|library| library.index_of(name));
        // If no MTL file is missing, an unknown material is a fault. Otherwise it may be in the missing file.
        if material.is_none()
            && self.library.as_ref().is_some_and(|library| !library.is_incomplete())
            && !is_no_material(name)
        {
            let name = shown(name);
            if !self.side_files.warn_instead_of_error(&format!("colours missing: material {name} is in no MTL file")) {
                let message = format!("material {name} is not in any MTL file named above this line");
                return Err(self.side_files.left_out.never_left_out(MeshFault::in_text(at, message)));
            }
        }
        self.mesh.set_material(material);
        self.text.skip_line();
        Ok(())
    }

    fn library(&mut self) -> Result<(), MeshFault> {
        let names = self.text.rest_of_line();
        let at = self.text.at() - names.len();
        let text = String::from_utf8_lossy(names);
        for name in library_names(&text) {
            self.read_library(name).map_err(|message| {
                let message = format!("the materials are missing: {message}; add the file, or remove this line");
                self.side_files.left_out.never_left_out(MeshFault::in_text(at, message))
            })??;
        }
        self.text.skip_line();
        Ok(())
    }

    /// Reads an MTL file. The outer error tells why the file cannot be read, the inner error is a
    /// fault in its contents.
    fn read_library(&mut self, name: &str) -> Result<Result<(), MeshFault>, String> {
        let library = self.library.get_or_insert_default();
        let path = match side_file_path(Path::new(""), name) {
            Ok(path) => path,
            Err(message) if self.side_files.warn_instead_of_error(&format!("materials missing: {message}")) => {
                library.record_missing(PathBuf::from(name));
                return Ok(Ok(()));
            }
            Err(message) => return Err(message),
        };
        // Some files repeat the same `mtllib` line before each group.
        if library.has_file(&path) {
            return Ok(Ok(()));
        }
        if let Some(bytes) = self.side_files.read_colors(&path, "materials")? {
            return Ok(mtl::read(&path, &without_utf16(&bytes), self.side_files, library));
        }
        library.record_missing(path);
        Ok(Ok(()))
    }
}

/// The reason why a corner cannot be read now.
enum Corner {
    /// It refers to a vertex, texture coordinate or normal that may come later in the file.
    Early(MeshFault),
    Faulty(MeshFault),
}

#[cold]
fn no_such_index(at: usize, what: &str, written: i64, count: usize) -> Corner {
    let are = if count == 1 { "is" } else { "are" };
    let message = match (written, count) {
        (0, _) => format!("there is no {what} 0: the first one is 1, the last one before this line -1"),
        (1.., 0) => format!("{what} {written} does not exist: the file has none"),
        (1.., _) => format!("{what} {written} does not exist: the file has {count}"),
        (_, 0) => format!("{what} {written} does not exist: none is defined above this line"),
        _ => format!("{what} {written} does not exist: {count} {are} defined above this line"),
    };
    let fault = MeshFault::in_text(at, message);
    if written > 0 { Corner::Early(fault) } else { Corner::Faulty(fault) }
}

/// Returns whether exporters write this material name for a face without a material.
// An MTL file may define such a name nevertheless: in 13 of 24 third-party files that use one, it has a colour or
// texture.
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
    [&b"v"[..], b"vn", b"vt", b"f", b"fo", b"l", b"p", b"usemtl", b"mtllib"].contains(&word) || is_skipped(word)
}

/// Returns whether a word is a keyword of OBJ whose line is skipped, because it adds no triangles.
/// A word that is not a keyword of OBJ is a fault: it is the first sign of a file that is not OBJ.
fn is_skipped(word: &[u8]) -> bool {
    const WORDS: [&str; 36] = [
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
    ];
    WORDS.iter().any(|known| known.as_bytes() == word)
}
