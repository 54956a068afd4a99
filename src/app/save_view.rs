//! Saving a view into its scene's file.

use super::watching::Dependency;
use crate::camera::Camera;
use crate::output_file::OutputFile;
use crate::scene::with_view;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// A view that is written into a scene file once the user has confirmed it.
pub(super) struct ProposedView {
    /// The scene file and its state when the user was asked.
    file: Dependency,
    camera: Camera,
}

impl ProposedView {
    /// Returns a proposal to write a view into `file`, or `None` if that is a pipe, device or
    /// folder.
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
    /// If the file cannot be written, is not a scene file, or has changed since the user was asked; it is then left as
    /// it was.
    pub(super) fn write(&self) -> io::Result<()> {
        let path = self.file.path();
        let text = fs::read_to_string(path)?;
        let written = with_view(&text, &self.camera).ok_or_else(|| io::Error::other("this is not a scene file"))?;
        let mut file = OutputFile::create(path)?;
        file.remove_stale();
        file.write_all(written.as_bytes())?;
        // Compared as late as possible, after writing the temporary file, because an editor may save at any moment.
        if self.file.has_changed() || fs::read_to_string(path)? != text {
            return Err(io::Error::other("it has changed in the meantime"));
        }
        file.finish()
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
