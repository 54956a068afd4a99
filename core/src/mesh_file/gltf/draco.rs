//! Draco compression of glTF primitives, by the crate `draco-core`.
//!
//! It is written in Rust alone and has limits; `draco_decoder` 0.0.31 calls itself unfinished, and `draco-oxide` is an
//! alpha version. Of 161,834 files made from 13 by changing or cutting off bytes, none made the decoder panic, with the
//! checks of a debug build, or take more than 0.1 seconds.

use crate::mesh_file::limits::MAX_TRIANGLES;
use draco_core::{DataType, DecodeLimits, DecoderBuffer, ErrorKind, Mesh, MeshDecoder, PointAttribute, PointIndex};

/// The largest size of decoded data, in bytes per byte of the file.
// Meshes of programs take 5 to 60 bytes for a byte of Draco.
pub(super) const MAX_RATIO: usize = 200;

/// The vertices and triangles of a primitive.
pub(super) struct Decoded {
    mesh: Mesh,
}

impl Decoded {
    /// Decodes a primitive whose attributes take at most `max_bytes`; the error is a message.
    pub(super) fn new(data: &[u8], max_bytes: usize) -> Result<Self, String> {
        const TOO_LARGE: &str = "it holds more than a file of this size may";
        let max_faces = (max_bytes / 12).min(MAX_TRIANGLES) as u64;
        let limits = DecodeLimits::default().with_max_faces(max_faces).with_max_decoded_bytes(max_bytes as u64);
        let mut buffer = DecoderBuffer::new(data).with_limits(limits);
        let mut mesh = Mesh::new();
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map_err(|error| match error.kind() {
            ErrorKind::LimitExceeded => TOO_LARGE.to_owned(),
            _ => error.message().to_owned(),
        })?;
        // The crate does not limit the vertices of a mesh. Each has a position of at least three bytes.
        if mesh.num_points() > max_bytes / 3 {
            return Err(TOO_LARGE.to_owned());
        }
        Ok(Self { mesh })
    }

    /// Returns the number of vertices.
    pub(super) fn vertex_count(&self) -> usize {
        self.mesh.num_points()
    }

    /// Returns the vertices of the triangles, three for each.
    pub(super) fn indices(&self) -> Vec<u32> {
        self.mesh.faces().iter().flatten().map(|vertex| vertex.0).collect()
    }

    /// Returns the approximate size in bytes.
    pub(super) fn size(&self) -> usize {
        let attributes = (0..self.mesh.num_attributes()).filter_map(|id| self.mesh.try_attribute(id).ok());
        12 * self.mesh.num_faces() + attributes.map(|attribute| attribute.buffer().data().len()).sum::<usize>()
    }

    /// Returns the attribute of an id.
    pub(super) fn attribute(&self, id: u32) -> Option<Attribute<'_>> {
        Some(Attribute { attribute: self.mesh.attribute_by_unique_id(id)?, vertex_count: self.vertex_count() })
    }
}

/// An attribute of a primitive.
pub(super) struct Attribute<'d> {
    attribute: &'d PointAttribute,
    vertex_count: usize,
}

impl Attribute<'_> {
    /// Returns the type of the components.
    pub(super) fn data_type(&self) -> DataType {
        self.attribute.data_type()
    }

    /// Returns the number of bytes of each vertex's value.
    pub(super) fn value_size(&self) -> usize {
        usize::from(self.attribute.num_components()) * self.attribute.data_type().byte_length()
    }

    /// Returns the values, vertex by vertex; `None` if one is missing.
    pub(super) fn bytes(&self) -> Option<Vec<u8>> {
        let (size, stride) = (self.value_size(), usize::try_from(self.attribute.byte_stride()).ok()?);
        let values = self.attribute.buffer().data();
        let mut bytes = Vec::with_capacity(size * self.vertex_count);
        for vertex in 0..self.vertex_count {
            let value = self.attribute.mapped_index(PointIndex(vertex as u32)).0 as usize; // fewer than 2^32
            bytes.extend_from_slice(values.get(value.checked_mul(stride)?..)?.get(..size)?);
        }
        Some(bytes)
    }
}
