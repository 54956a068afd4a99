//! How much is read at most.

/// The most bytes that are read for one mesh, the files that it names included: 2 GiB.
pub const MAX_BYTES: usize = 2 << 30;

/// The most triangles that a mesh has: 64 Mi. A glTF file that shows the same triangles again and again makes at most
/// 1 Mi of them and one for each of its bytes.
pub const MAX_TRIANGLES: usize = 64 << 20;

/// The most texels in all textures of a mesh: 64 Mi, as in one texture of 8192 x 8192.
pub const MAX_TEXELS: usize = 64 << 20;
