//! Reading of a mesh's side files: materials, textures and buffers that the mesh file names.

use super::fault::shown;
use super::limits::MAX_MESH_BYTES;
use crate::named_file;
use crate::progress::Reporter;
use crate::text::visible;
use std::collections::HashSet;
use std::io;
use std::path::{Component, Path, PathBuf};

/// Reads the side files of one mesh, with a limit on their total number of bytes.
pub(super) struct SideFiles<'a> {
    open: &'a mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
    bytes_left: usize,
    /// The path of the mesh file, whose folder messages put before a side file's name.
    mesh: PathBuf,
    /// The files that were reported as missing.
    missing: HashSet<PathBuf>,
    reporter: &'a Reporter<'a>,
}

impl<'a> SideFiles<'a> {
    /// Returns a reader of the side files of the mesh file `name`, whose bytes `open` returns.
    pub(super) fn new(
        name: &str,
        open: &'a mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
        reporter: &'a Reporter<'a>,
    ) -> Self {
        Self { open, bytes_left: MAX_MESH_BYTES, mesh: PathBuf::from(name), missing: HashSet::new(), reporter }
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
    /// `None` if the file is missing and the reporter has a callback for warnings. `what` names the kind of file in the
    /// warning.
    pub(super) fn read_colors(&mut self, path: &Path, what: &str) -> Result<Option<Vec<u8>>, String> {
        let opened = (self.open)(path);
        let is_missing = opened.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::NotFound);
        if is_missing && self.warn_of_missing(path, what) {
            return Ok(None);
        }
        self.counted_bytes(path, opened).map(Some)
    }

    /// Warns of a missing file, once per file. Returns whether the reporter has a callback for
    /// warnings.
    fn warn_of_missing(&mut self, path: &Path, what: &str) -> bool {
        // Many materials of a library may name the same texture.
        if self.missing.contains(path) {
            return true;
        }
        let warning = || format!("{}: {what} missing: {}", visible_path(&self.mesh), visible_path(path));
        let is_taken = self.reporter.warn(warning);
        if is_taken {
            self.missing.insert(path.to_owned());
        }
        is_taken
    }

    /// Returns the bytes of an opened side file, and counts them towards the limit of the mesh.
    fn counted_bytes(&mut self, path: &Path, opened: io::Result<Vec<u8>>) -> Result<Vec<u8>, String> {
        let name = self.name_of(path);
        let say = |what: &str| format!("{}: {what}", shown(name.as_bytes()));
        let bytes = opened.map_err(|error| say(&named_file::reason(&error)))?;
        let left = self.bytes_left.checked_sub(bytes.len());
        self.bytes_left = left.ok_or_else(|| say("with this file more than 2 GiB would be read"))?;
        Ok(bytes)
    }
}

fn visible_path(path: &Path) -> String {
    visible(&path.to_string_lossy())
}

/// Limit on the length of a path in bytes: no supported system allows longer file names, and
/// messages stay readable.
const MAX_PATH_BYTES: usize = 255;

/// Returns the path of a side file relative to the mesh, given the path `written` in a file that
/// lies in `folder`. `\` is a separator too, as on Windows. URLs, absolute paths and empty names are refused with a
/// message.
pub(super) fn local_path(folder: &Path, written: &str) -> Result<PathBuf, String> {
    let name = shown(written.as_bytes());
    let say = |what: &str| Err(format!("{name} {what}"));
    if written.len() > MAX_PATH_BYTES {
        return say("is longer than a path may be");
    }
    // URLs are refused: a picture must not depend on the network, and a mesh must not reveal who views it.
    if written.contains("://") || written.get(..5).is_some_and(|start| start.eq_ignore_ascii_case("data:")) {
        return say("is a URL; only files beside this one are read");
    }
    let path = PathBuf::from(written.replace('\\', "/"));
    // The file name of `.` and `a/..` is `None`: they are folders.
    if written.contains('\0') || path.file_name().is_none() {
        return say("is not a file name");
    }
    // Absolute paths would let a downloaded mesh read any file, and `C:` is one on Windows, where it was written.
    let has_drive = written.as_bytes().get(1) == Some(&b':');
    if has_drive || path.components().any(|part| matches!(part, Component::RootDir | Component::Prefix(_))) {
        return say("is an absolute path; write it relative to this file");
    }
    // Without `./` each file has one spelling: files that were already read are looked up by their path.
    Ok(folder.join(path.components().filter(|part| *part != Component::CurDir).collect::<PathBuf>()))
}

#[cfg(all(test, unit_tests))]
mod tests;
