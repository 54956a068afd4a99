//! The second pass over an OBJ file: faces, lines and points.

use super::materials::MaterialChange;
use super::vertices::{VertexPiece, VertexReader};
use super::{is_skipped, skip_statement};
use crate::mesh_file::builder::{MeshBuilder, TriangleIndices};
use crate::mesh_file::fault::{MeshFault, shown};
use crate::mesh_file::left_out::LeftOut;
use crate::mesh_file::marks::{Mark, MarkEnd};
use crate::mesh_file::polygon;
use crate::mesh_file::text::TextCursor;
use glam::Vec3;

/// The parts of the whole file to which faces may refer.
pub(super) struct FileParts<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) positions: &'a [Vec3],
    /// The index of the first position with a colour.
    pub(super) first_color: Option<usize>,
    pub(super) changes: &'a [MaterialChange],
    /// The byte offset of the statement about materials at which the reading ends.
    pub(super) stop: Option<usize>,
}

/// A reader of a piece, or of the faces that come before their vertices.
pub(super) struct FaceReader<'a> {
    text: TextCursor<'a>,
    parts: &'a FileParts<'a>,
    pub(super) mesh: MeshBuilder,
    /// The numbers of positions, texture coordinates and normals before the cursor.
    counts: [usize; 3],
    /// The corners of the current face; reused for all faces, so that a face costs no allocation.
    corners: FaceCorners,
    /// The offsets and materials of the faces that come before one of their vertices.
    pub(super) early_faces: Vec<(u32, Option<u32>)>,
    /// The number of positions that need a colour.
    // Vertices after the last coloured one need one as soon as a triangle with colours uses them.
    pub(super) colored: usize,
    /// Whether a corner may have a texture coordinate or a normal that the file does not have.
    // All vertices are known only at the end.
    forgives_absent: bool,
    /// Whether the reading ends in this piece, at a fault about materials.
    pub(super) is_stopped: bool,
}

/// The indices of a face's corners; [`NONE`] for a texture coordinate or normal that is missing.
#[derive(Default)]
struct FaceCorners {
    positions: Vec<u32>,
    texture_coordinates: Vec<u32>,
    normals: Vec<u32>,
    /// Whether a texture coordinate or normal is left out because the file does not have it.
    has_absent: bool,
}

/// The index of a texture coordinate or normal that a corner lacks.
// No valid index is this large, because a file has at most 2^31 bytes.
const NONE: u32 = u32::MAX;

impl<'a> FaceReader<'a> {
    pub(super) fn of_piece(parts: &'a FileParts<'a>, piece: &VertexPiece) -> Self {
        let text = TextCursor::of_piece(parts.bytes, &piece.range);
        Self::new(parts, text, piece.counts)
    }

    /// Returns a reader after the last line.
    ///
    /// The counts are those of texture coordinates and normals.
    pub(super) fn at_end(parts: &'a FileParts<'a>, [texture_coordinates, normals]: [usize; 2]) -> Self {
        let text = TextCursor::starting_at(parts.bytes, parts.bytes.len());
        Self::new(parts, text, [parts.positions.len(), texture_coordinates, normals])
    }

    fn new(parts: &'a FileParts<'a>, text: TextCursor<'a>, counts: [usize; 3]) -> Self {
        Self {
            text,
            parts,
            mesh: MeshBuilder::default(),
            counts,
            corners: FaceCorners::default(),
            early_faces: Vec::new(),
            colored: 0,
            forgives_absent: false,
            is_stopped: false,
        }
    }

    /// Reads all statements of a piece but those that the first pass has read.
    pub(super) fn read(&mut self, piece: &VertexPiece, left_out: &mut LeftOut<'_>) -> Result<(), MeshFault> {
        if !piece.has_others && piece.faults.is_empty() {
            return Ok(());
        }
        let changes = self.parts.changes;
        let mut next_change = changes.partition_point(|&(at, _)| at < piece.range.start);
        if let Some(&(_, material)) = next_change.checked_sub(1).and_then(|last| changes.get(last)) {
            self.mesh.set_material(material);
        }
        let mut faults = piece.faults.iter().copied().peekable();
        while self.text.go_to_statement() {
            let start = self.text.at();
            let word = self.text.word();
            let vertex_kind = [&b"v"[..], b"vt", b"vn"].iter().position(|kind| *kind == word);
            if let Some(kind) = vertex_kind {
                self.counts[kind] += 1;
                if faults.next_if_eq(&start).is_some()
                    && let Some(fault) = VertexReader::new(self.text.cursor_at(start)).fault()
                {
                    left_out.leave_out(fault)?;
                }
                skip_statement(&mut self.text, word);
                continue;
            }
            if matches!(word, b"usemtl" | b"mtllib") {
                if self.parts.stop == Some(start) {
                    self.is_stopped = true;
                    return Ok(());
                }
                if let Some(&(_, material)) = changes.get(next_change).filter(|&&(at, _)| at == start) {
                    self.mesh.set_material(material);
                    next_change += 1;
                }
                skip_statement(&mut self.text, word);
                continue;
            }
            if let Err(fault) = self.statement(word, left_out) {
                left_out.leave_out(fault)?;
                self.text = self.text.cursor_at(start);
                self.text.word();
            }
            skip_statement(&mut self.text, word);
        }
        Ok(())
    }

    /// Reads a statement with the keyword `word`, but not to the end of its line.
    fn statement(&mut self, word: &[u8], left_out: &mut LeftOut<'_>) -> Result<(), MeshFault> {
        let at = self.text.at() - word.len();
        match word {
            b"f" | b"fo" => self.face(at, left_out),
            b"l" | b"p" => {
                self.marks(word == b"l", left_out);
                Ok(())
            }
            _ if is_skipped(word) => {
                self.count_not_shown(word, left_out);
                Ok(())
            }
            _ => Err(MeshFault::in_text(at, format!("{} is not a keyword of OBJ (v, vt, vn, f, ...)", shown(word)))),
        }
    }

    /// Returns whether a vertex before the cursor has a colour.
    fn has_colors(&self) -> bool {
        self.parts.first_color.is_some_and(|first| first < self.counts[0])
    }

    /// Counts the curve or surface of a statement with the keyword `word`.
    fn count_not_shown(&mut self, word: &[u8], left_out: &mut LeftOut<'_>) {
        let what = match word {
            b"curv" | b"curv2" => "curve",
            b"surf" => "curved surface",
            b"t" => "tag (of a subdivision surface)",
            b"vw" => "weight (of a skin)",
            _ => return,
        };
        // A file of curves and surfaces alone is not one of points.
        self.mesh.has_faces |= what.starts_with("curve");
        left_out.not_shown(what, 1);
    }

    /// Reads the points `p v v ...`, or the line `l v v ...`, where `/vt` may follow each vertex.
    ///
    /// A point, or a part of a line, whose vertex does not exist above is not shown.
    fn marks(&mut self, is_line: bool, left_out: &mut LeftOut<'_>) {
        let has_colors = self.has_colors();
        if has_colors {
            self.colored = self.counts[0];
        }
        let material = self.mesh.current_material();
        let mut last = None;
        while !self.text.is_at_line_end() {
            let vertex = self.index("vertex", self.counts[0]).ok();
            // The rest of the word, with the index of a texture coordinate.
            if !self.text.is_at_word_end() {
                self.text.word();
            }
            let end = vertex.map(|position| MarkEnd { position, color: has_colors.then_some(position) });
            match (last.replace(end), end) {
                (_, Some(end)) if !is_line => self.mesh.marks.push(Mark { ends: [end; 2], material }),
                (Some(Some(last)), Some(end)) => self.mesh.marks.push(Mark { ends: [last, end], material }),
                (_, None) => left_out.not_shown(if is_line { "line" } else { "point" }, 1),
                _ => {}
            }
        }
    }

    /// Reads a face whose keyword is at `at`.
    ///
    /// If some of its vertices come later in the file, the face is read at the end of the file.
    fn face(&mut self, at: usize, left_out: &mut LeftOut<'_>) -> Result<(), MeshFault> {
        self.mesh.has_faces = true;
        let start = self.text.at();
        match self.face_corners(left_out) {
            Err(Corner::Early(_)) => {
                self.early_faces.push((start as u32, self.mesh.current_material())); // a file has at most 2^31 bytes
                Ok(())
            }
            Err(Corner::Faulty(fault)) => Err(fault),
            Ok(()) => self.add_face(at, left_out),
        }
    }

    /// Reads the faces that come before their vertices.
    pub(super) fn read_early_faces(
        &mut self,
        early_faces: Vec<(u32, Option<u32>)>,
        left_out: &mut LeftOut<'_>,
    ) -> Result<(), MeshFault> {
        self.forgives_absent = left_out.takes_notices();
        for (start, material) in early_faces {
            self.text = self.text.cursor_at(start as usize);
            self.mesh.set_material(material);
            let read = match self.face_corners(left_out) {
                Ok(()) => self.add_face(start as usize, left_out),
                Err(Corner::Early(fault) | Corner::Faulty(fault)) => Err(fault),
            };
            if let Err(fault) = read {
                left_out.leave_out(fault)?;
            }
        }
        Ok(())
    }

    fn face_corners(&mut self, left_out: &mut LeftOut<'_>) -> Result<(), Corner> {
        self.corners.positions.clear();
        self.corners.texture_coordinates.clear();
        self.corners.normals.clear();
        self.corners.has_absent = false;
        while !self.text.is_at_line_end() {
            self.corner(left_out)?;
        }
        Ok(())
    }

    /// Adds the triangles of the face at byte `face_at`, whose corners have been read.
    fn add_face(&mut self, face_at: usize, left_out: &mut LeftOut<'_>) -> Result<(), MeshFault> {
        let FaceCorners { positions, texture_coordinates, normals, has_absent } = &mut self.corners;
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
        if is_uneven && !*has_absent {
            let message = "the corners of this face are not written alike: all v, all v/vt, all v//vn or all v/vt/vn";
            left_out.leave_out(MeshFault::in_text(face_at, message))?;
        }
        self.add_triangles()
    }

    /// Adds the triangles of the current face.
    fn add_triangles(&mut self) -> Result<(), MeshFault> {
        let has_colors = self.has_colors();
        if has_colors {
            self.colored = self.counts[0];
        }
        let FaceCorners { positions, texture_coordinates, normals, .. } = &self.corners;
        let pick = |indices: &[u32], corners: [usize; 3]| corners.map(|i| indices[i]);
        let pick_any = |indices: &[u32], corners| (!indices.is_empty()).then(|| pick(indices, corners));
        for corners in polygon::triangulated(positions, self.parts.positions) {
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
    fn corner(&mut self, left_out: &mut LeftOut<'_>) -> Result<(), Corner> {
        let start = self.text.at();
        let vertex = self.index("vertex", self.counts[0])?;
        let (mut texture_coordinate, mut normal) = (NONE, NONE);
        if self.text.skip_byte(b'/') {
            if !self.text.is_at_slash() && !self.text.is_at_word_end() {
                texture_coordinate = self.attribute_index("texture coordinate", self.counts[1], left_out)?;
            }
            if self.text.skip_byte(b'/') && !self.text.is_at_word_end() {
                normal = self.attribute_index("normal", self.counts[2], left_out)?;
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

    /// Reads the index of a texture coordinate or normal; [`NONE`] if the file has none of this
    /// number, and a face without it is still drawn.
    #[inline]
    fn attribute_index(&mut self, what: &'static str, count: usize, left_out: &mut LeftOut<'_>) -> Result<u32, Corner> {
        match self.index(what, count) {
            Err(Corner::Early(_)) if self.forgives_absent => {
                left_out.not_shown(format!("{what} (not in the file)"), 1);
                self.corners.has_absent = true;
                Ok(NONE)
            }
            index => index,
        }
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
