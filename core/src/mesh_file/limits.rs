//! Limits on the size of meshes and textures.

/// Limit on the bytes read for one mesh, side files included: 2 GiB, so that numbers of vertices
/// and triangles fit into 31 bits.
pub const MAX_MESH_BYTES: usize = 2 << 30;

/// Limit on the triangles of a mesh: 64 Mi. A glTF file, whose nodes may repeat the same triangles,
/// may have at most one per byte of the file and 1 Mi more.
pub const MAX_TRIANGLES: usize = 64 << 20;

/// Limit on the texels in all textures of a mesh: 64 Mi, as in one texture of 8192 x 8192.
pub const MAX_TEXELS: usize = 64 << 20;

/// Limit on the length of a side file's path in bytes: no supported system allows longer file
/// names, and messages stay readable.
#[cfg(feature = "mesh")]
pub(super) const MAX_PATH_BYTES: usize = 255;
