//! STL, text and binary: triangles without shared vertices. The facets' normals are not read,
//! because the corners give them with more digits. Colours are read if the attribute bytes are known to hold colours.

use super::MeshFile;
use super::attribute::{Attribute, of_piece};
use super::builder::{MeshBuilder, TriangleIndices, too_many_triangles};
use super::fault::{MeshFault, shown};
use super::left_out::LeftOut;
use super::limits::MAX_TRIANGLES;
use super::pieces::parse_in_order;
use super::polygon;
use super::text::{self, TextCursor};
use crate::color::{LinearRgb, Srgb8};
use crate::progress::Meter;
use crate::threads;
use glam::Vec3;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};

/// Size of the header in bytes: 80 arbitrary ones, and 4 for the number of triangles.
const HEADER: usize = 84;
/// Size of a triangle in bytes: a normal, three corners, two attribute bytes.
const FACET: usize = 50;
/// The offsets of the corners in a facet: it begins with its normal, and each has 12 bytes.
const OFFSETS: [usize; 3] = [12, 24, 36];

/// The number of facets from which on a binary file is read on several threads.
// Fewer are read in a millisecond or two, for which no threads need to be started.
const MIN_PARALLEL_FACETS: usize = 1 << 16;

/// The number of facets that are read in one go: 256 KiB, after which progress is reported.
const BLOCK_FACETS: usize = (256 << 10) / FACET + 1;

/// Returns the size in bytes that a binary file should have, by the number of triangles in its
/// header.
fn claimed_size(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.try_into().map(u32::from_le_bytes).ok()?;
    Some(HEADER as u64 + u64::from(count) * FACET as u64)
}

/// Returns whether the bytes have the size of a binary STL file with the number of triangles given.
///
/// The header gives this number. A text never has that size: four characters in the place of the number are more than
/// 150 million triangles, and such a file would exceed [`MAX_MESH_BYTES`](super::MAX_MESH_BYTES).
pub(super) fn size_fits(bytes: &[u8]) -> bool {
    claimed_size(bytes) == Some(bytes.len() as u64)
}

/// Reads a binary STL file.
///
/// A count in the header that does not fit the size of the file is a fault. If the fault is left out, the facets that
/// the file holds are read.
pub(super) fn read_binary(
    bytes: &[u8],
    left_out: &mut LeftOut<'_>,
    mut meter: Meter<'_>,
) -> Result<MeshFile, MeshFault> {
    let size = claimed_size(bytes).ok_or_else(|| {
        let message = "the file ends within the header of 84 bytes that a binary STL file begins with";
        MeshFault::at_byte(bytes.len(), message)
    })?;
    let facets = bytes[HEADER..].chunks_exact(FACET);
    left_out.set_fault_limit_for(facets.len());
    if size != bytes.len() as u64 {
        let (triangles, found) = ((size - HEADER as u64) / FACET as u64, bytes.len());
        let message = format!(
            "a binary STL file of {triangles} triangles, as it says here, has {size} bytes; this file has {found}"
        );
        left_out.leave_out(MeshFault::at_byte(HEADER - 4, message))?;
    }
    if facets.len() > MAX_TRIANGLES {
        return Err(MeshFault::at_byte(HEADER - 4, too_many_triangles()));
    }
    // Equal corners are not merged: the tracer needs no shared vertices.
    let mut mesh = MeshBuilder { positions: Vec::with_capacity(3 * facets.len()), ..MeshBuilder::default() };
    let (coloring, has_faults) = (Coloring::of(bytes), AtomicBool::new(false));
    let is_parallel = meter.is_parallel() && facets.len() >= MIN_PARALLEL_FACETS;
    let offset = |corner: usize| HEADER + corner / 3 * FACET + OFFSETS[corner % 3];
    for block in (0..facets.len()).step_by(BLOCK_FACETS) {
        meter.advance_to(HEADER + block * FACET)?;
        let count = BLOCK_FACETS.min(facets.len() - block);
        let corner = |i: usize| {
            let vertex = vertex_at(bytes, offset(3 * block + i));
            if !vertex.is_finite() {
                has_faults.store(true, Ordering::Relaxed);
            }
            vertex
        };
        if is_parallel {
            threads::extend(&mut mesh.positions, 3 * count, corner);
        } else {
            mesh.positions.extend((0..3 * count).map(corner));
        }
        if let Some(coloring) = &coloring {
            let facets = facets.clone().skip(block).take(count);
            mesh.colors.values_mut().extend(facets.flat_map(|facet| [coloring.color(facet); 3]));
        }
    }
    if has_faults.into_inner() {
        for (corner, position) in mesh.positions.iter_mut().enumerate().filter(|(_, position)| !position.is_finite()) {
            left_out.leave_out(fault_of_vertex(*position, offset(corner)))?;
            *position = Vec3::NAN;
        }
    }
    if coloring.is_some() {
        mesh.colors = Attribute::of_positions(std::mem::take(mesh.colors.values_mut()));
    }
    let triangle = |i: usize| [0, 1, 2].map(|corner| (3 * i + corner) as u32); // at most three times MAX_TRIANGLES
    let count = facets.len();
    mesh.triangles = if is_parallel { threads::map(count, triangle) } else { (0..count).map(triangle).collect() };
    mesh.finish("its count is 0", left_out)
}

/// The encoding of a facet's colour in its two attribute bytes, with five bits for each channel.
struct Coloring {
    /// The colour of facets without one of their own.
    default: LinearRgb,
    /// The value of the highest attribute bit of facets that have a colour of their own.
    own_color_bit: bool,
    /// Whether red has the lowest bits; otherwise blue has them.
    is_red_low: bool,
}

impl Coloring {
    /// Returns the colouring of a file; `None` if the facets have no colours.
    ///
    /// The colouring is that of Materialise Magics, whose header has `COLOR=`, or of `VisCAM`, which sets the highest
    /// bit.
    fn of(bytes: &[u8]) -> Option<Self> {
        const MARK: &[u8] = b"COLOR=";
        if let Some(at) = bytes[..HEADER - 4].windows(MARK.len()).position(|window| window == MARK)
            && let Some(&[r, g, b]) = bytes[at + MARK.len()..HEADER - 4].first_chunk()
        {
            let default = LinearRgb::from_srgb8(Srgb8::new(r, g, b));
            return Some(Self { default, own_color_bit: false, is_red_low: true });
        }
        // Programs other than `VisCAM` may write other numbers into the attribute bytes, such as checksums.
        let mut attributes = bytes[HEADER..].chunks_exact(FACET).map(attribute);
        let is_viscam =
            attributes.clone().any(|bits| bits != 0) && attributes.all(|bits| bits == 0 || bits & 0x8000 != 0);
        is_viscam.then_some(Self { default: LinearRgb::grey(0.5), own_color_bit: true, is_red_low: false })
    }

    fn color(&self, facet: &[u8]) -> LinearRgb {
        let bits = attribute(facet);
        if (bits & 0x8000 != 0) != self.own_color_bit {
            return self.default;
        }
        let channel = |shift: u16| ((bits >> shift & 0x1f) * 255 / 31) as u8;
        let [low, middle, high] = [0, 5, 10].map(channel);
        let [r, b] = if self.is_red_low { [low, high] } else { [high, low] };
        LinearRgb::from_srgb8(Srgb8::new(r, middle, b))
    }
}

/// Returns the attribute bytes of a facet.
fn attribute(facet: &[u8]) -> u16 {
    u16::from_le_bytes([facet[FACET - 2], facet[FACET - 1]])
}

/// Returns the vertex in the twelve bytes from `offset` on.
fn vertex_at(bytes: &[u8], offset: usize) -> Vec3 {
    let bytes = &bytes[offset..offset + 12];
    let coordinate = |axis: usize| f32::from_le_bytes(std::array::from_fn(|i| bytes[4 * axis + i]));
    Vec3::new(coordinate(0), coordinate(1), coordinate(2))
}

/// Returns the fault of a vertex that is not finite. `offset` is its offset in the file.
#[cold]
fn fault_of_vertex(vertex: Vec3, offset: usize) -> MeshFault {
    // The index of the first coordinate that is not finite.
    let axis = usize::from(vertex.x.is_finite()) * (1 + usize::from(vertex.y.is_finite()));
    MeshFault::at_byte(offset + 4 * axis, format!("{} is not a finite number", vertex[axis]))
}

/// Reads a text STL file, of one or several solids.
pub(super) fn read_text(bytes: &[u8], left_out: &mut LeftOut<'_>, mut meter: Meter<'_>) -> Result<MeshFile, MeshFault> {
    let start = TextCursor::new(bytes).at();
    let begins_facet = |text: &mut TextCursor<'_>| text.word().eq_ignore_ascii_case(b"facet");
    let pieces = text::pieces(bytes, start, meter.piece_bytes(), begins_facet);
    let mut mesh = read_pieces(bytes, &pieces, left_out, &mut meter)?;
    if mesh.is_none() {
        // A facet that begins within a loop is a fault, and what follows depends on what is before it.
        *left_out = left_out.anew();
        mesh = read_pieces(bytes, std::slice::from_ref(&(start..bytes.len())), left_out, &mut meter)?;
    }
    mesh.unwrap_or_default().finish("it has no facets", left_out)
}

/// Reads the pieces of a text; `None` if a piece but the last ends within a loop.
fn read_pieces<'a>(
    bytes: &[u8],
    pieces: &[Range<usize>],
    left_out: &mut LeftOut<'a>,
    meter: &mut Meter<'_>,
) -> Result<Option<MeshBuilder>, MeshFault> {
    let mut mesh = MeshBuilder::default();
    let mut ends_within_loop = false;
    let parse = |piece: &Range<usize>, left_out: &mut LeftOut<'a>| {
        let text = TextCursor::of_piece(bytes, piece);
        let mut reader = TextReader { text, mesh: MeshBuilder::default(), open: None };
        let read = reader.read(piece.end == bytes.len(), left_out);
        ((reader.mesh, reader.open.is_some()), read)
    };
    parse_in_order(pieces, Range::clone, (left_out, meter), parse, |_, (piece, is_open)| {
        ends_within_loop = is_open;
        if is_open {
            return Ok(ControlFlow::Break(()));
        }
        mesh.append(piece, None).map(ControlFlow::Continue)
    })?;
    Ok((!ends_within_loop).then_some(mesh))
}

struct TextReader<'a> {
    text: TextCursor<'a>,
    mesh: MeshBuilder,
    /// Index of the first vertex of the current `outer loop`; `None` between loops.
    open: Option<u32>,
}

impl TextReader<'_> {
    /// Reads all lines of a piece. `is_last` tells whether it is the last one.
    fn read(&mut self, is_last: bool, left_out: &mut LeftOut<'_>) -> Result<(), MeshFault> {
        while self.text.go_to_statement() {
            let start = self.text.at();
            if let Err(fault) = self.statement() {
                left_out.leave_out(fault)?;
                self.skip_faulty_line(start);
            }
        }
        if is_last && self.open.is_some() {
            return Err(self.text.expected("the rest of this facet (vertex, endloop, endfacet)"));
        }
        Ok(())
    }

    fn statement(&mut self) -> Result<(), MeshFault> {
        let word = self.text.word();
        let at = self.text.at() - word.len();
        match word.to_ascii_lowercase().as_slice() {
            b"vertex" if self.open.is_some() => return self.vertex(),
            b"outer" if self.open.is_none() => self.open = Some(self.mesh.positions.len() as u32), // below 2^31 bytes
            b"endloop" if self.open.is_some() => self.triangulate_loop(at)?,
            // The order of these lines is not checked: some writers leave some out, and only vertices and loops matter.
            b"solid" | b"facet" | b"endfacet" | b"endsolid" | b"color" if self.open.is_none() => {}
            _ if self.open.is_some() => {
                return Err(MeshFault::in_text(at, format!("expected vertex or endloop, found {}", shown(word))));
            }
            _ => {
                let wanted = "solid, facet, outer loop, endfacet or endsolid";
                return Err(MeshFault::in_text(at, format!("expected {wanted}, found {}", shown(word))));
            }
        }
        self.text.skip_line();
        Ok(())
    }

    /// Skips the faulty line that begins at `line_start`.
    fn skip_faulty_line(&mut self, line_start: usize) {
        self.text = self.text.cursor_at(line_start);
        let is_vertex = self.text.word().eq_ignore_ascii_case(b"vertex");
        self.text.skip_line();
        if is_vertex && self.open.is_some() {
            // The faulty corner gets a position that is not finite, by which its facet is left out.
            self.mesh.positions.push(Vec3::NAN);
        }
    }

    fn vertex(&mut self) -> Result<(), MeshFault> {
        let vertex = Vec3::new(self.text.number()?, self.text.number()?, self.text.number()?);
        self.text.end_line()?;
        self.mesh.positions.push(vertex);
        Ok(())
    }

    /// Adds the triangles of a loop. The format allows only triangles, but some programs write
    /// larger polygons.
    fn triangulate_loop(&mut self, offset: usize) -> Result<(), MeshFault> {
        let corners: Vec<u32> = (self.open.take().unwrap_or_default()..self.mesh.positions.len() as u32).collect();
        if corners.len() < 3 {
            self.mesh.positions.truncate(self.mesh.positions.len() - corners.len());
            let message = format!("this loop has {} vertices; a facet has at least 3", corners.len());
            return Err(MeshFault::in_text(offset, message));
        }
        for triangle in polygon::triangulated(&corners, &self.mesh.positions) {
            self.mesh.push(TriangleIndices::new(triangle.map(|i| of_piece(corners[i]))))?;
        }
        Ok(())
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
