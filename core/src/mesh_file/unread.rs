//! Stand-in for the readers when the feature `mesh` is off: mesh files are recognised, and reading
//! one is an error.

use super::{MeshError, MeshFile, Texture};
use crate::named_file::Accepted;
use crate::progress::{Reporter, Unfinished};
use std::path::Path;

impl MeshFile {
    /// Always fails.
    pub(crate) fn read_whole(path: &Path, _: Accepted, reporter: &Reporter<'_>) -> Result<Self, Unfinished<MeshError>> {
        Self::of_file(path, None, &[], reporter)
    }

    /// Always fails.
    pub(crate) fn of_file(
        path: &Path,
        _: Option<&str>,
        _: &[u8],
        _: &Reporter<'_>,
    ) -> Result<Self, Unfinished<MeshError>> {
        let message = "meshes are read with the feature `mesh` of the crate termtrace, which is off in this program";
        Err(Unfinished::Failed(MeshError::of_file(&path.to_string_lossy(), message)))
    }
}

/// A decoder that refuses every picture.
#[derive(Default)]
pub(crate) struct TextureDecoder;

impl TextureDecoder {
    /// Always fails.
    pub(crate) fn decode(&mut self, _: &[u8]) -> Result<Texture, String> {
        Err("is read with the feature `mesh` of the crate termtrace, which is off in this program".to_owned())
    }
}

/// Returns an empty name: without readers no format is known.
pub fn format_name(_: &str, _: Option<&str>, _: &[u8]) -> &'static str {
    ""
}

/// Returns whether a file is meant to be a mesh, by its name's extension or its first bytes.
pub fn is_mesh(name: &str, bytes: &[u8]) -> bool {
    let ending = Path::new(name).extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    let is_known = ending.is_some_and(|ending| ["obj", "stl", "ply", "gltf", "glb"].contains(&&*ending));
    is_known || bytes.starts_with(b"ply") || bytes.starts_with(b"glTF")
}
