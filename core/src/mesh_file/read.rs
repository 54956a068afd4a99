//! Reading of a mesh from bytes in any format, or from a file.

use super::fault::MeshFault;
use super::format::{self, MeshFormat};
use super::side_files::{SideFiles, in_any_case};
use super::{MAX_MESH_BYTES, MeshError, MeshFile, gltf, obj, ply, stl, text};
use crate::memory;
use crate::named_file::{self, Accepted};
use crate::progress::{Meter, Reporter, Unfinished};
use std::borrow::Cow;
use std::io;
use std::path::Path;

impl MeshFile {
    /// Returns the mesh of a file's bytes. `name` is used in messages, and its extension where the
    /// content does not tell the format; `open` returns the bytes of a side file by its path relative to the mesh.
    ///
    /// # Errors
    /// If the bytes are not a valid mesh: the first fault.
    pub fn from_bytes(
        name: &str,
        bytes: &[u8],
        open: &mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
    ) -> Result<Self, MeshError> {
        Self::parse(name, None, bytes, open, &Reporter::silent()).map_err(Unfinished::failure)
    }

    /// Returns the mesh as [`from_bytes`](Self::from_bytes) does, without its faulty parts if
    /// `reporter` takes notices of them. `stated` is the extension of the format if the user states it.
    ///
    /// # Errors
    /// If no mesh can be made of the bytes, or the reporter cancels.
    pub fn parse(
        name: &str,
        stated: Option<&str>,
        bytes: &[u8],
        open: &mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
        reporter: &Reporter<'_>,
    ) -> Result<Self, Unfinished<MeshError>> {
        let text = as_utf8(bytes);
        let bytes = &*text;
        let mut side_files = SideFiles::new(name, bytes, open, reporter);
        let mesh = read(name, stated, bytes, &mut side_files, reporter);
        let mesh = mesh.map_err(|fault| fault.into_error(name, bytes))?;
        side_files.left_out.report();
        Ok(mesh)
    }

    /// Loads a mesh file.
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
        Self::load_or_cancel(path, &Reporter::silent()).map_err(Unfinished::failure)
    }

    /// Loads a mesh file as [`load`](Self::load) does, with progress reports, until `reporter`
    /// cancels.
    ///
    /// # Errors
    /// Those of [`MeshFile::load`], and [`Unfinished::Cancelled`] if the reporter cancels.
    pub fn load_or_cancel(path: &Path, reporter: &Reporter<'_>) -> Result<Self, Unfinished<MeshError>> {
        Self::read_whole(path, Accepted::FilesAndPipes, reporter)
    }

    /// Loads a mesh file, which may be a pipe only if `accepted` allows it.
    pub(crate) fn read_whole(
        path: &Path,
        accepted: Accepted,
        reporter: &Reporter<'_>,
    ) -> Result<Self, Unfinished<MeshError>> {
        let read = named_file::read(path, accepted, |_| MAX_MESH_BYTES, reporter);
        // A cancelled read returns an I/O error (`Interrupted`), which must not be shown as a fault of the file.
        if reporter.is_cancelled() {
            return Err(Unfinished::Cancelled);
        }
        let bytes = read.map_err(|error| {
            Unfinished::Failed(MeshError::of_file(&path.to_string_lossy(), &named_file::reason(&error)))
        })?;
        Self::of_file(path, None, &bytes, reporter)
    }

    /// Returns the mesh of these bytes of the file at `path`. Side files are read from the same
    /// folder. `stated` is the extension of the format if the user states it.
    pub(crate) fn of_file(
        path: &Path,
        stated: Option<&str>,
        bytes: &[u8],
        reporter: &Reporter<'_>,
    ) -> Result<Self, Unfinished<MeshError>> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut open = |relative: &Path| {
            let path = folder.join(relative);
            reporter.report_dependency(&path);
            let read = |path: &Path| named_file::read(path, Accepted::Files, |_| MAX_MESH_BYTES, reporter);
            match read(&path) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    in_any_case(folder, relative).map_or(Err(error), |path| read(&path))
                }
                read => read,
            }
        };
        Self::parse(&path.to_string_lossy(), stated, bytes, &mut open, reporter)
    }
}

/// Returns whether a file is meant to be a mesh, by its name's extension or its first bytes.
pub fn is_mesh(name: &str, bytes: &[u8]) -> bool {
    // No text has the size of a binary STL file. OBJ and text STL files are recognised by their names only.
    format::by_ending(name).is_some()
        || bytes.starts_with(b"ply")
        || bytes.starts_with(b"glTF")
        || stl::size_fits(bytes)
}

/// Returns the name of the format of these bytes, for people; empty if they are no mesh.
pub fn format_name(name: &str, stated: Option<&str>, bytes: &[u8]) -> &'static str {
    format::recognised(name, stated, &as_utf8(bytes)).map_or("", MeshFormat::name)
}

/// Returns a mesh file's text in UTF-16 as UTF-8, and other bytes unchanged.
fn as_utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    // The header of a binary STL file may begin with any bytes.
    if stl::size_fits(bytes) { Cow::Borrowed(bytes) } else { text::without_utf16(bytes) }
}

/// Recognises the format and reads the mesh.
fn read(
    name: &str,
    stated: Option<&str>,
    bytes: &[u8],
    side_files: &mut SideFiles<'_>,
    reporter: &Reporter<'_>,
) -> Result<MeshFile, MeshFault> {
    if bytes.len() > MAX_MESH_BYTES {
        return Err(MeshFault::of_file("the file is larger than 2 GiB, too large to be read"));
    }
    let meter = Meter::new(reporter, name, bytes.len());
    // A failed allocation aborts the process and leaves the terminal in raw mode, so memory is checked beforehand.
    // Fallible allocations would need a `Result` in every signature of the readers and the tree builder.
    has_memory(bytes.len() * PEAK_PER_BYTE, "to read it")?;
    let mesh = match format::recognised(name, stated, bytes)? {
        MeshFormat::Obj => obj::read(without_end_marks(bytes), side_files, meter),
        MeshFormat::StlText => stl::read_text(without_end_marks(bytes), &mut side_files.left_out, meter),
        MeshFormat::StlBinary => stl::read_binary(bytes, &mut side_files.left_out, meter),
        MeshFormat::Ply => ply::read(bytes, side_files, meter),
        MeshFormat::Gltf => gltf::read_json(bytes, side_files, meter),
        MeshFormat::Glb => gltf::read_binary(bytes, side_files, meter),
    }?;
    // The trees over the triangles are built later. If memory will not suffice for them, the error should come from
    // here, where it names the mesh file.
    let triangles = mesh.triangles().len() + mesh.motion().map_or(0, |motion| motion.triangle_count());
    has_memory(triangles * PEAK_PER_TRIANGLE, &format!("for its {triangles} triangles"))?;
    Ok(mesh)
}

/// Returns a text without the NUL and Ctrl-Z characters at its end, which old programs write there.
fn without_end_marks(text: &[u8]) -> &[u8] {
    let is_text = |byte: &u8| !matches!(byte, 0 | 0x1a);
    &text[..text.iter().rposition(is_text).map_or(0, |last| last + 1)]
}

/// Greatest memory that reading takes, in bytes per byte of the file, besides the file itself.
///
/// PLY takes the most, because it has the fewest bytes per triangle.
const PEAK_PER_BYTE: usize = 8;

/// Greatest memory that is in use while trees are built, in bytes per triangle.
///
/// Measured: up to 120 (STL), of which the mesh, already read here, takes 48.
const PEAK_PER_TRIANGLE: usize = 128;

fn has_memory(bytes: usize, what_for: &str) -> Result<(), MeshFault> {
    memory::check(bytes).map_err(|error| MeshFault::of_file(format!("{error} {what_for}")))
}
