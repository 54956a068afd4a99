//! The first pass over an OBJ file: vertices, normals, texture coordinates, and the places of
//! statements about materials.

use super::{MaterialEvent, skip_statement};
use crate::color::{LinearRgb, linear_from_srgb};
use crate::mesh_file::builder::{MeshBuilder, unit};
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::left_out::LeftOut;
use crate::mesh_file::pieces::parse_in_order;
use crate::mesh_file::side_files::SideFiles;
use crate::mesh_file::text::TextCursor;
use crate::progress::Meter;
use glam::{Vec2, Vec3};
use std::ops::{ControlFlow, Range};

/// All vertices of a file, in the lists of a mesh without triangles.
#[derive(Default)]
pub(super) struct Vertices {
    pub(super) mesh: MeshBuilder,
    /// The index of the first position with a colour.
    pub(super) first_color: Option<usize>,
    pub(super) events: Vec<MaterialEvent>,
    pub(super) pieces: Vec<VertexPiece>,
}

/// A piece as the second pass needs it.
pub(super) struct VertexPiece {
    pub(super) range: Range<usize>,
    /// The numbers of positions, texture coordinates and normals before the piece.
    pub(super) counts: [usize; 3],
    /// The byte offsets of the faulty lines of vertices.
    pub(super) faults: Vec<usize>,
    /// Whether the piece has other statements than vertices.
    pub(super) has_others: bool,
}

/// A reader of the vertices of a piece.
pub(super) struct VertexReader<'a> {
    text: TextCursor<'a>,
    mesh: MeshBuilder,
    events: Vec<MaterialEvent>,
    faults: Vec<usize>,
    has_others: bool,
    /// The index of the first position of the piece with a colour.
    first_color: Option<usize>,
    /// The number of normals, and of texture coordinates, that are not finite.
    not_finite: [usize; 2],
}

impl Vertices {
    /// Reads the vertices of all pieces.
    ///
    /// A faulty vertex, normal or texture coordinate still takes up its number, so that the indices of later ones are
    /// right. Its fault is told by the second pass.
    pub(super) fn read(
        bytes: &[u8],
        pieces: &[Range<usize>],
        side_files: &mut SideFiles<'_>,
        meter: &mut Meter<'_>,
    ) -> Result<Self, MeshFault> {
        let (mut all, mut faults) = (Self::default(), 0);
        // With more faults than this, the second pass refuses the file before it is through with these pieces.
        let most_faults = side_files.left_out.upper_fault_limit();
        let parse = |piece: &Range<usize>, left_out: &mut LeftOut<'_>| {
            let mut reader = VertexReader::new(TextCursor::of_piece(bytes, piece));
            reader.read();
            let [normals, texture_coordinates] = reader.not_finite;
            left_out.not_shown("normal (not finite)", normals);
            left_out.not_shown("texture coordinate (not finite)", texture_coordinates);
            (reader, Ok(()))
        };
        // The first half of the work.
        let offsets_of = |piece: &Range<usize>| piece.start / 2..piece.end / 2;
        parse_in_order(pieces, offsets_of, (&mut side_files.left_out, meter), parse, |range, reader| {
            faults += reader.faults.len();
            all.add(range.clone(), reader);
            Ok(if faults > most_faults { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        })?;
        Ok(all)
    }

    fn add(&mut self, range: Range<usize>, reader: VertexReader<'_>) {
        let VertexReader { mut mesh, events, faults, has_others, first_color, .. } = reader;
        let all = &mut self.mesh;
        let counts = [all.positions.len(), all.texture_coordinates.values().len(), all.normals.values().len()];
        if let Some(first) = first_color {
            self.first_color.get_or_insert(counts[0] + first);
            // Vertices without a colour before those of the piece are white.
            all.colors.values_mut().resize(counts[0], LinearRgb::grey(1.0));
            all.colors.values_mut().append(mesh.colors.values_mut());
        }
        all.positions.append(&mut mesh.positions);
        all.texture_coordinates.values_mut().append(mesh.texture_coordinates.values_mut());
        all.normals.values_mut().append(mesh.normals.values_mut());
        self.events.extend(events);
        self.pieces.push(VertexPiece { range, counts, faults, has_others });
    }
}

impl<'a> VertexReader<'a> {
    pub(super) fn new(text: TextCursor<'a>) -> Self {
        Self {
            text,
            mesh: MeshBuilder::default(),
            events: Vec::new(),
            faults: Vec::new(),
            has_others: false,
            first_color: None,
            not_finite: [0; 2],
        }
    }

    fn read(&mut self) {
        while self.text.go_to_statement() {
            let start = self.text.at();
            let word = self.text.word();
            match word {
                b"v" | b"vn" | b"vt" => {
                    if self.vertex_statement(word).is_err() {
                        self.leave_out(start, word);
                    }
                }
                _ => {
                    self.has_others = true;
                    if matches!(word, b"usemtl" | b"mtllib") {
                        self.events.push(MaterialEvent { at: start, is_library: word == b"mtllib" });
                    }
                    skip_statement(&mut self.text, word);
                }
            }
        }
    }

    /// Returns the fault of the faulty line of a vertex at the cursor.
    pub(super) fn fault(mut self) -> Option<MeshFault> {
        let word = self.text.word();
        self.vertex_statement(word).err()
    }

    /// Records the faulty line that begins at `start`.
    #[cold]
    fn leave_out(&mut self, start: usize, word: &[u8]) {
        self.faults.push(start);
        match word {
            // `MeshBuilder::finish` flattens the triangles at a position that is not finite.
            b"v" => self.mesh.positions.push(Vec3::NAN),
            b"vn" => self.mesh.normals.values_mut().push(Vec3::ZERO),
            _ => self.mesh.texture_coordinates.values_mut().push(Vec2::ZERO),
        }
        self.text = self.text.cursor_at(start);
        self.text.word();
        skip_statement(&mut self.text, word);
    }

    #[inline]
    fn vertex_statement(&mut self, word: &[u8]) -> Result<(), MeshFault> {
        match word {
            b"v" => self.vertex(),
            b"vn" => self.normal(),
            _ => self.texture_coordinate(),
        }
    }

    /// Reads a vertex: `v x y z`, `v x y z w`, `v x y z r g b` or `v x y z r g b a`.
    ///
    /// The weight w is for curves and is ignored, as is the opacity a.
    fn vertex(&mut self) -> Result<(), MeshFault> {
        let position = [self.text.number()?, self.text.number()?, self.text.number()?];
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

    /// Adds the colour of the last vertex, `encoded` in sRGB. If only some vertices have colours,
    /// the others are white.
    fn add_srgb_color(&mut self, encoded: [f32; 3]) {
        let [r, g, b] = encoded.map(|channel| linear_from_srgb(f64::from(channel.clamp(0.0, 1.0))) as f32);
        let before = self.mesh.positions.len() - 1;
        self.first_color.get_or_insert(before);
        self.mesh.colors.values_mut().resize(before, LinearRgb::grey(1.0));
        self.mesh.colors.values_mut().push(LinearRgb::new(r, g, b));
    }

    /// Reads `vn x y z`. A normal that is not finite counts as none.
    fn normal(&mut self) -> Result<(), MeshFault> {
        let direction = Vec3::new(self.text.any_number()?, self.text.any_number()?, self.text.any_number()?);
        self.text.end_line()?;
        self.mesh.normals.values_mut().push(unit(direction.as_dvec3()));
        self.not_finite[0] += usize::from(!direction.is_finite());
        Ok(())
    }

    /// Reads `vt u`, `vt u v` or `vt u v w`. In OBJ files v is measured from the bottom of the
    /// image, in a `MeshFile` from its top.
    fn texture_coordinate(&mut self) -> Result<(), MeshFault> {
        let u = self.text.any_number()?;
        let v = if self.text.is_at_line_end() { 0.0 } else { self.text.any_number()? };
        let mut uv = Vec2::new(u, 1.0 - v);
        if !uv.is_finite() {
            self.not_finite[1] += 1;
            uv = Vec2::ZERO;
        }
        self.mesh.texture_coordinates.values_mut().push(uv);
        // The optional third coordinate w is for 3D textures and is ignored.
        skip_statement(&mut self.text, b"vt");
        Ok(())
    }
}
