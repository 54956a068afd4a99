//! Writing a view into its scene's file.

use super::watching::Dependency;
use crate::camera::Camera;
use crate::output_file::OutputFile;
use crate::scene::with_view;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// A view that the user is asked to confirm before it is written.
pub(super) struct ProposedView {
    /// The file and its state when the question was put.
    file: Dependency,
    camera: Camera,
}

impl ProposedView {
    /// Proposes to write a view into `file`. `None` if that is not a plain file.
    pub(super) fn new(file: &Path, camera: Camera) -> Option<Self> {
        Some(Dependency::now(file)).filter(|file| !file.is_other()).map(|file| Self { file, camera })
    }

    /// Returns the file's name without its folder.
    pub(super) fn file_name(&self) -> String {
        self.file.path().file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// Adds the view to the file, which is replaced atomically and keeps all other text.
    ///
    /// # Errors
    /// If the file cannot be written, is not a scene file, or has changed since the question was put; it is then left
    /// as it was.
    pub(super) fn write(&self) -> io::Result<()> {
        let path = self.file.path();
        let text = fs::read_to_string(path)?;
        let written = with_view(&text, &self.camera).ok_or_else(|| io::Error::other("this is not a scene file"))?;
        let mut file = OutputFile::create(path)?;
        file.remove_stale();
        file.write_all(written.as_bytes())?;
        // Compared after writing the temporary file, as late as possible: an editor may save at any moment.
        if self.file.has_changed() || fs::read_to_string(path)? != text {
            return Err(io::Error::other("it has changed in the meantime"));
        }
        file.finish()
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
