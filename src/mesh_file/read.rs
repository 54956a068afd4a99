//! Bytes of any format, or a file -> a mesh.

use super::fault::Fault;
use super::kind::{self, Kind};
use super::neighbours::Neighbours;
use super::{MAX_BYTES, MeshError, MeshFile, gltf, obj, ply, stl};
use crate::memory;
use crate::named_file::{self, Accepted};
use crate::progress::{Meter, Unfinished, Watcher};
use std::io;
use std::path::Path;

impl MeshFile {
    /// The mesh that the bytes describe. The name is used in messages, and its ending where the content does not say
    /// what it is; `open` gives the bytes of a file that the mesh names, by its path relative to the mesh.
    ///
    /// # Errors
    /// The first fault that is found.
    pub fn from_bytes(
        name: &str,
        bytes: &[u8],
        open: &mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
    ) -> Result<Self, MeshError> {
        Self::parse(name, bytes, open, &Watcher::patient()).map_err(Unfinished::failure)
    }

    fn parse(
        name: &str,
        bytes: &[u8],
        open: &mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
        watcher: &Watcher<'_>,
    ) -> Result<Self, Unfinished<MeshError>> {
        read(name, bytes, &mut Neighbours::new(name, open), watcher).map_err(|fault| fault.into_error(name, bytes))
    }

    /// The mesh in that file.
    ///
    /// ```no_run
    /// use std::path::Path;
    /// use termtrace::internals::mesh_file::MeshFile;
    ///
    /// match MeshFile::load(Path::new("meshes/teapot.obj")) {
    ///     Ok(mesh) => println!("{} triangles", mesh.triangles().len()),
    ///     Err(error) => println!("{error}"),
    /// }
    /// ```
    ///
    /// # Errors
    /// If the file cannot be read, or as [`MeshFile::from_bytes`].
    pub fn load(path: &Path) -> Result<Self, MeshError> {
        Self::load_or_cancel(path, &Watcher::patient()).map_err(Unfinished::failure)
    }

    /// [`load`](Self::load), until the watcher cancels it.
    ///
    /// # Errors
    /// As [`MeshFile::load`], and if the watcher cancels it.
    pub fn load_or_cancel(path: &Path, watcher: &Watcher<'_>) -> Result<Self, Unfinished<MeshError>> {
        Self::read_whole(path, Accepted::FilesAndPipes, watcher)
    }

    /// The mesh in that file, if it is of an accepted kind.
    pub(crate) fn read_whole(
        path: &Path,
        accepted: Accepted,
        watcher: &Watcher<'_>,
    ) -> Result<Self, Unfinished<MeshError>> {
        let read = named_file::read(path, accepted, |_| MAX_BYTES, watcher);
        if watcher.is_gone() {
            return Err(Unfinished::Cancelled);
        }
        let bytes = read.map_err(|error| {
            Unfinished::Failed(MeshError::of_file(&path.to_string_lossy(), &named_file::reason(&error)))
        })?;
        Self::of_file(path, &bytes, watcher)
    }

    /// The mesh in the file at that path, of which these are the bytes. The files that it names are read from beside it.
    pub(crate) fn of_file(path: &Path, bytes: &[u8], watcher: &Watcher<'_>) -> Result<Self, Unfinished<MeshError>> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut open = |relative: &Path| {
            let path = folder.join(relative);
            watcher.needs(&path);
            named_file::read(&path, Accepted::Files, |_| MAX_BYTES, watcher)
        };
        Self::parse(&path.to_string_lossy(), bytes, &mut open, watcher)
    }
}

/// Whether a file of that name, or with that beginning, is meant to be a mesh.
pub fn is_mesh(name: &str, bytes: &[u8]) -> bool {
    kind::by_ending(name).is_some() || bytes.starts_with(b"ply") || bytes.starts_with(b"glTF")
}

/// The one place where formats part.
fn read(name: &str, bytes: &[u8], neighbours: &mut Neighbours<'_>, watcher: &Watcher<'_>) -> Result<MeshFile, Fault> {
    if bytes.len() > MAX_BYTES {
        return Err(Fault::of_file("the file is larger than 2 GiB, too large to be read"));
    }
    let meter = Meter::new(watcher, name, bytes.len());
    has_memory(bytes.len() * PEAK_PER_BYTE, "to read it")?;
    let mesh = match kind::of(name, bytes)? {
        Kind::Obj => obj::read(bytes, neighbours, meter),
        Kind::StlText => stl::read_text(bytes, meter),
        Kind::StlBinary => stl::read_binary(bytes, meter),
        Kind::Ply => ply::read(bytes, meter),
        Kind::Gltf => gltf::read_json(bytes, neighbours, meter),
        Kind::Glb => gltf::read_binary(bytes, neighbours, meter),
    }?;
    let triangles = mesh.triangles().len();
    has_memory(triangles * PEAK_PER_TRIANGLE, &format!("for its {triangles} triangles"))?;
    Ok(mesh)
}

/// How many bytes of memory each byte of a file may take while it is read, besides itself. (PLY has the fewest bytes for a
/// triangle.)
const PEAK_PER_BYTE: usize = 8;

/// How many bytes of memory a triangle may take while trees are built over all of them: 230 (PLY) to 290 (STL) were
/// measured, with the file.
const PEAK_PER_TRIANGLE: usize = 320;

fn has_memory(bytes: usize, what_for: &str) -> Result<(), Fault> {
    memory::check(bytes).map_err(|error| Fault::of_file(format!("{error} {what_for}")))
}
