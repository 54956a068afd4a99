//! Limits on what is read.

/// Limit on the bytes read for one mesh, side files included: 2 GiB, so that every count fits into
/// 31 bits.
pub const MAX_MESH_BYTES: usize = 2 << 30;

/// Limit on the triangles of a mesh: 64 Mi. A glTF file that instantiates the same triangles
/// repeatedly makes at most 1 Mi of them and one for each of its bytes.
pub const MAX_TRIANGLES: usize = 64 << 20;

/// Limit on the texels in all textures of a mesh: 64 Mi, as in one texture of 8192 x 8192.
pub const MAX_TEXELS: usize = 64 << 20;
