//! The statements of an OBJ file about materials, in the order of the file.

use super::MaterialEvent;
use crate::mesh_file::fault::{MeshFault, shown};
use crate::mesh_file::mtl::{self, Library};
use crate::mesh_file::side_files::{SideFiles, side_file_path};
use crate::mesh_file::text::{TextCursor, without_utf16};
use std::path::{Path, PathBuf};

/// A statement that changes the material of the faces behind it: its byte offset, and the material.
pub(super) type MaterialChange = (usize, Option<u32>);

/// Reads the statements about materials, and the MTL files that they name.
///
/// Returns the materials, their changes, and the fault that ended the reading, with the offset of its statement.
pub(super) fn read(
    bytes: &[u8],
    events: &[MaterialEvent],
    side_files: &mut SideFiles<'_>,
) -> (Option<Library>, Vec<MaterialChange>, Option<(usize, MeshFault)>) {
    let mut reader = MaterialReader { text: TextCursor::new(bytes), library: None, side_files };
    let mut changes = Vec::new();
    for &MaterialEvent { at, is_library } in events {
        reader.text = reader.text.cursor_at(at);
        // The keyword.
        reader.text.word();
        let read = if is_library {
            reader.library()
        } else {
            reader.use_material().map(|material| changes.push((at, material)))
        };
        if let Err(fault) = read {
            return (reader.library, changes, Some((at, fault)));
        }
    }
    (reader.library, changes, None)
}

struct MaterialReader<'a, 'b, 's> {
    text: TextCursor<'a>,
    /// The materials of the MTL files named so far; `None` before the first one.
    library: Option<Library>,
    side_files: &'s mut SideFiles<'b>,
}

impl MaterialReader<'_, '_, '_> {
    /// Reads `usemtl` and returns the material from there on.
    fn use_material(&mut self) -> Result<Option<u32>, MeshFault> {
        let name = self.text.rest_of_line();
        let at = self.text.at() - name.len();
        // A model without its MTL files is shown without its colours.
        let material = self.library.as_ref().and_then(|library| library.index_of(name));
        // If no MTL file is missing, an unknown material is a fault. Otherwise it may be in the missing file.
        if material.is_none()
            && self.library.as_ref().is_some_and(|library| !library.is_incomplete())
            && !is_no_material(name)
        {
            let name = shown(name);
            if !self.side_files.warn_instead_of_error(&format!("colours missing: material {name} is in no MTL file")) {
                let message = format!("material {name} is not in any MTL file named above this line");
                return Err(self.side_files.left_out.never_left_out(MeshFault::in_text(at, message)));
            }
        }
        Ok(material)
    }

    fn library(&mut self) -> Result<(), MeshFault> {
        let names = self.text.rest_of_line();
        let at = self.text.at() - names.len();
        let text = String::from_utf8_lossy(names);
        for name in library_names(&text) {
            self.read_library(name).map_err(|message| {
                let message = format!("the materials are missing: {message}; add the file, or remove this line");
                self.side_files.left_out.never_left_out(MeshFault::in_text(at, message))
            })??;
        }
        Ok(())
    }

    /// Reads an MTL file. The outer error tells why the file cannot be read, the inner error is a
    /// fault in its contents.
    fn read_library(&mut self, name: &str) -> Result<Result<(), MeshFault>, String> {
        let library = self.library.get_or_insert_default();
        let path = match side_file_path(Path::new(""), name) {
            Ok(path) => path,
            Err(message) if self.side_files.warn_instead_of_error(&format!("materials missing: {message}")) => {
                library.record_missing(PathBuf::from(name));
                return Ok(Ok(()));
            }
            Err(message) => return Err(message),
        };
        // Some files repeat the same `mtllib` line before each group.
        if library.has_file(&path) {
            return Ok(Ok(()));
        }
        if let Some(bytes) = self.side_files.read_colors(&path, "materials")? {
            return Ok(mtl::read(&path, &without_utf16(&bytes), self.side_files, library));
        }
        library.record_missing(path);
        Ok(Ok(()))
    }
}

/// Returns whether exporters write this material name for a face without a material.
// An MTL file may define such a name nevertheless: in 13 of 24 third-party files that use one, it has a colour or
// texture.
fn is_no_material(name: &[u8]) -> bool {
    [&b""[..], b"None", b"(null)", b"null"].contains(&name)
}

/// Splits the file names of a `mtllib` line. There may be several, and each may contain blanks: a
/// name ends with `.mtl`.
fn library_names(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    let mut start = 0;
    for (at, _) in text.match_indices([' ', '\t']) {
        let name = &text[start..at];
        let ends = name.len() >= 4 && name.as_bytes()[name.len() - 4..].eq_ignore_ascii_case(b".mtl");
        if ends {
            names.push(name);
        }
        if ends || name.is_empty() {
            start = at + 1;
        }
    }
    names.push(&text[start..]);
    names
}
