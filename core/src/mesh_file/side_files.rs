//! Reading of a mesh's side files: materials, textures and buffers that the mesh file names.

use super::MeshError;
use super::fault::{MeshFault, shown_path};
use super::left_out::LeftOut;
use super::limits::{MAX_MESH_BYTES, MAX_PATH_BYTES};
use crate::named_file;
use crate::progress::{Reporter, Unfinished};
use crate::text::visible;
use std::collections::HashSet;
use std::io;
use std::path::{Component, Path, PathBuf};

/// Limit on the warnings about the colours of one mesh; more are only counted.
const MAX_WARNINGS: usize = 8;

/// A reader of the side files of one mesh, with a limit on their total number of bytes.
///
/// It also records the parts that are left out of the mesh.
pub(super) struct SideFiles<'a> {
    open: &'a mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
    bytes_left: usize,
    /// The path of the mesh file, whose folder precedes the names of side files in messages.
    mesh: PathBuf,
    /// The warnings about colours reported so far; none is reported twice.
    warnings: HashSet<String>,
    reporter: &'a Reporter<'a>,
    pub(super) left_out: LeftOut<'a>,
}

impl<'a> SideFiles<'a> {
    /// Returns a reader of the side files of the mesh file `name`; `open` returns their bytes.
    pub(super) fn new(
        name: &'a str,
        bytes: &'a [u8],
        open: &'a mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
        reporter: &'a Reporter<'a>,
    ) -> Self {
        let left_out = LeftOut::new(reporter, name, bytes);
        let mesh = PathBuf::from(name);
        Self { open, bytes_left: MAX_MESH_BYTES, mesh, warnings: HashSet::new(), reporter, left_out }
    }

    /// Returns whether the mesh may be parsed on all threads of the current rayon pool.
    pub(super) fn is_parallel(&self) -> bool {
        self.reporter.is_parallel()
    }

    /// Returns a side file's name for messages: relative to the user's current folder, like the
    /// mesh's own.
    pub(super) fn name_of(&self, path: &Path) -> String {
        self.mesh.parent().unwrap_or(Path::new("")).join(path).to_string_lossy().into_owned()
    }

    /// Returns the bytes of a side file, or the message of a fault.
    pub(super) fn read(&mut self, path: &Path) -> Result<Vec<u8>, String> {
        let opened = (self.open)(path);
        self.counted_bytes(path, opened)
    }

    /// Returns the bytes of a side file that only adds colours, or the message of a fault.
    ///
    /// If the file is not there, its name is also looked for in the folder of the mesh. `None`, after a
    /// warning, if it is missing and warnings are not errors. `what` names the kind of file in the warning.
    // A warning instead of an error: among 2,418 third-party files 105 lack an MTL file, and 26 a texture.
    pub(super) fn read_colors(&mut self, path: &Path, what: &str) -> Result<Option<Vec<u8>>, String> {
        let is_missing =
            |opened: &io::Result<Vec<u8>>| opened.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::NotFound);
        let mut opened = (self.open)(path);
        if is_missing(&opened)
            && let Some(name) = path.file_name().map(Path::new).filter(|name| *name != path)
        {
            // A downloaded file often lies beside the mesh instead of in its original folder.
            let beside = (self.open)(name);
            opened = if beside.is_ok() { beside } else { opened };
        }
        if is_missing(&opened) && self.warn_instead_of_error(&format!("{what} missing: {}", path.to_string_lossy())) {
            return Ok(None);
        }
        self.counted_bytes(path, opened).map(Some)
    }

    /// Warns of colours that are not shown, once with each message.
    ///
    /// Returns false if the caller should return an error.
    pub(super) fn warn_instead_of_error(&mut self, message: &str) -> bool {
        // Many materials of a library may name the same texture, which gives the same message.
        if self.warnings.contains(message) {
            return true;
        }
        if self.warnings.len() >= MAX_WARNINGS {
            self.left_out.not_shown("fault of colours", 1);
            return true;
        }
        let is_taken =
            self.reporter.warn_instead_of_error(|| visible(&format!("{}: {message}", self.mesh.to_string_lossy())));
        if is_taken {
            self.warnings.insert(message.to_owned());
        }
        is_taken
    }

    /// Warns of a fault that costs colours only.
    ///
    /// # Errors
    /// The fault, if warnings are errors or it is a cancellation.
    pub(super) fn warn_of(&mut self, fault: Unfinished<MeshError>) -> Result<(), MeshFault> {
        if let Unfinished::Failed(error) = &fault {
            let is_in_mesh = Path::new(error.name()) == self.mesh;
            let message = if is_in_mesh { error.message().to_owned() } else { error.to_string() };
            if self.warn_instead_of_error(&format!("colours missing: {message}")) {
                return Ok(());
            }
        }
        Err(fault.into())
    }

    /// Returns the bytes of an opened side file, and counts them towards the limit of the mesh.
    fn counted_bytes(&mut self, path: &Path, opened: io::Result<Vec<u8>>) -> Result<Vec<u8>, String> {
        let name = self.name_of(path);
        let say = |what: &str| format!("{}: {what}", shown_path(&name));
        let bytes = opened.map_err(|error| say(&named_file::reason(&error)))?;
        let left = self.bytes_left.checked_sub(bytes.len());
        self.bytes_left = left.ok_or_else(|| say("with this file more than 2 GiB would be read"))?;
        Ok(bytes)
    }
}

/// Returns the path of a side file relative to the mesh, or the message of an error.
///
/// `reference` is the path as written in a file that lies in `folder`. `\` is a separator too, as on Windows. Of an
/// absolute path the last part is taken. URLs, and texts that are no file names, are refused.
pub(super) fn side_file_path(folder: &Path, reference: &str) -> Result<PathBuf, String> {
    let reference = reference.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(reference);
    let say = |what: &str| Err(format!("{} {what}", shown_path(reference)));
    if reference.len() > MAX_PATH_BYTES {
        return say("is longer than a path may be");
    }
    // URLs are refused: a picture must not depend on the network, and a mesh must not reveal who views it.
    if reference.contains("://") || reference.get(..5).is_some_and(|start| start.eq_ignore_ascii_case("data:")) {
        return say("is a URL; only files beside this one are read");
    }
    let mut path = PathBuf::from(reference.replace('\\', "/"));
    // Absolute paths would let a downloaded mesh read any file. `C:` begins one if the file was written on Windows. An
    // absolute path names a file of the author's computer, which mostly lies beside the mesh here.
    let has_drive = reference.as_bytes().get(1) == Some(&b':');
    if has_drive || path.components().any(|part| matches!(part, Component::RootDir | Component::Prefix(_))) {
        let last = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        path = PathBuf::from(last.rsplit(':').next().unwrap_or_default());
    }
    // The file name of `.` and `a/..` is `None`: they are folders.
    if reference.contains('\0') || path.file_name().is_none() {
        return say("is not a file name");
    }
    // Without `./` each file has one spelling: files that were already read are looked up by their path.
    Ok(folder.join(path.components().filter(|part| *part != Component::CurDir).collect::<PathBuf>()))
}

/// Returns the path of an existing file below `folder` that differs from `relative` in upper and
/// lower case only, as on systems that take both for the same name.
pub(super) fn in_any_case(folder: &Path, relative: &Path) -> Option<PathBuf> {
    /// Limit on the names of a folder that are compared.
    const MAX_LISTED: usize = 10_000;
    let mut found = folder.to_owned();
    for part in relative.components() {
        let exact = found.join(part);
        if exact.symlink_metadata().is_ok() {
            found = exact;
            continue;
        }
        let wanted = part.as_os_str().to_string_lossy().to_lowercase();
        let listed = if found.as_os_str().is_empty() { Path::new(".") } else { &found };
        let names = std::fs::read_dir(listed).ok()?.take(MAX_LISTED).filter_map(|entry| Some(entry.ok()?.file_name()));
        // The first match in alphabetical order, whatever the order in which the folder lists its names.
        let name = names.filter(|name| name.to_string_lossy().to_lowercase() == wanted).min()?;
        found.push(name);
    }
    Some(found)
}

#[cfg(all(test, unit_tests))]
mod tests;
