//! The files that a scene names: meshes and pictures.

use super::checked::SideFiles;
use crate::material::Images;
use crate::mesh_file::{self, MeshFile, Texture, TextureDecoder};
use crate::named_file::{self, Accepted};
use crate::progress::{Reporter, Unfinished};
use crate::shape::Meshes;
use crate::text::visible;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The meshes and pictures that a scene names.
///
/// Each file is read once, because several objects may use it, with different transforms.
pub(super) struct SceneSideFiles<'w> {
    folder: PathBuf,
    /// The names and bytes of files in memory, which are used instead of files in the folder.
    embedded: &'w [(&'w str, &'w [u8])],
    meshes: HashMap<PathBuf, Arc<MeshFile>>,
    /// The pictures, or the messages about those that cannot be shown.
    images: HashMap<PathBuf, Result<Arc<Texture>, String>>,
    decoder: TextureDecoder,
    reporter: &'w Reporter<'w>,
}

/// Limit on the bytes of a picture: 256 MiB, four for each of the texels that may be decoded.
const MAX_IMAGE_BYTES: usize = 4 * mesh_file::MAX_TEXELS;

impl<'w> SceneSideFiles<'w> {
    pub(super) fn in_folder_of(scene: &Path, embedded: &'w [(&'w str, &'w [u8])], reporter: &'w Reporter<'w>) -> Self {
        let folder = scene.parent().unwrap_or(Path::new("")).to_owned();
        let decoder = TextureDecoder::default();
        Self { folder, embedded, meshes: HashMap::new(), images: HashMap::new(), decoder, reporter }
    }

    /// Returns the bytes of a file in memory.
    fn embedded_bytes(&self, name: &str) -> Option<&'w [u8]> {
        self.embedded.iter().find(|(embedded, _)| *embedded == name).map(|&(_, bytes)| bytes)
    }

    /// Reads and decodes a picture.
    fn read_image(&mut self, name: &str, path: &Path) -> Result<Arc<Texture>, String> {
        let shown = visible(&path.to_string_lossy());
        let read;
        let bytes = if let Some(bytes) = self.embedded_bytes(name) {
            bytes
        } else {
            self.reporter.report_dependency(path);
            // As for meshes, pipes are not accepted.
            read = named_file::read(path, Accepted::Files, |_| MAX_IMAGE_BYTES, self.reporter)
                .map_err(|error| format!("{shown}: {}", named_file::reason(&error)))?;
            &read
        };
        self.decoder.decode(bytes).map(Arc::new).map_err(|what| format!("{shown} {what}"))
    }
}

impl SideFiles for SceneSideFiles<'_> {}

impl Images for SceneSideFiles<'_> {
    fn image(&mut self, name: &str) -> Result<Arc<Texture>, Unfinished<String>> {
        let path = self.folder.join(name);
        if !self.images.contains_key(&path) {
            let image = self.read_image(name, &path);
            // A cancelled read returns an I/O error, which must not be shown as a fault of the file.
            if self.reporter.is_cancelled() {
                return Err(Unfinished::Cancelled);
            }
            self.images.insert(path.clone(), image);
        }
        self.images[&path].clone().map_err(Unfinished::Failed)
    }
}

impl Meshes for SceneSideFiles<'_> {
    fn mesh(&mut self, name: &str) -> Result<Arc<MeshFile>, Unfinished<String>> {
        let path = self.folder.join(name);
        if let Some(mesh) = self.meshes.get(&path) {
            return Ok(Arc::clone(mesh));
        }
        let mesh = if let Some(bytes) = self.embedded_bytes(name) {
            MeshFile::of_file(&path, None, bytes, self.reporter)
        } else {
            self.reporter.report_dependency(&path);
            // Pipes are not accepted, as they can be read only once, and a scene is loaded again when it changes.
            MeshFile::read_whole(&path, Accepted::Files, self.reporter)
        };
        let mesh = Arc::new(mesh.map_err(|unfinished| unfinished.map(|error| error.to_string()))?);
        if !mesh.staging().is_empty() {
            // A scene file has its own.
            let name = visible(&path.to_string_lossy());
            self.reporter.notify_if_possible(|| format!("{name}: not shown: cameras and lights"));
        }
        self.meshes.insert(path, Arc::clone(&mesh));
        Ok(mesh)
    }
}
