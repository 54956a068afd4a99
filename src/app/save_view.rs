//! Saving a view into its scene's file.

use super::watching::Dependency;
use crate::camera::Camera;
use crate::output_file::OutputFile;
use crate::scene::{count_views, with_view};
use crate::text::visible;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file to be written once the user confirms it.
pub(super) enum Proposal {
    /// A view to add to a scene file that exists.
    View(ProposedView),
    /// The path of a new scene file, and its text.
    Scene(PathBuf, String),
}

impl Proposal {
    /// Proposes to write a view into `file`. Returns `None` if that is a pipe, device or folder.
    pub(super) fn view(file: &Path, camera: Camera) -> Option<Self> {
        ProposedView::new(file, camera).map(Self::View)
    }

    /// Proposes to write a scene into a new file beside a mesh, under the first unused name.
    pub(super) fn scene_beside(mesh: &Path, text: String) -> Self {
        let stem = mesh.file_stem().unwrap_or_default().to_string_lossy();
        let name = |number: u32| match number {
            1 => mesh.with_file_name(format!("{stem}.ron")),
            number => mesh.with_file_name(format!("{stem}-{number}.ron")),
        };
        // `write_new` checks the name again, because another program may create the file meanwhile. At most 1000 names
        // are tried, which bounds the time in a folder with many scenes. If all are taken, `write_new` reports that the
        // last one exists.
        let path = (1..1000).map(name).find(|path| path.symlink_metadata().is_err()).unwrap_or_else(|| name(1000));
        Self::Scene(path, text)
    }

    /// Returns whether a new file would be written.
    pub(super) fn is_new(&self) -> bool {
        matches!(self, Self::Scene(..))
    }

    /// Returns the name, without its folder, of the file that would be written.
    pub(super) fn file_name(&self) -> String {
        let path = match self {
            Self::View(view) => view.file.path(),
            Self::Scene(path, _) => path,
        };
        path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// Writes the file and returns a note for the user: that it was written, or why not.
    pub(super) fn carry_out(&self) -> String {
        match self {
            Self::View(view) => match view.save_as_numbered_view() {
                Ok(number) => format!("saved as view {number} in {}", visible(&self.file_name())),
                Err(error) => format!("scene file left unchanged: {error}"),
            },
            Self::Scene(path, text) => match write_new(path, text) {
                Ok(()) => format!("written: {}", visible(&path.to_string_lossy())),
                Err(error) => format!("could not write {}: {error}", self.file_name()),
            },
        }
    }
}

fn write_new(path: &Path, text: &str) -> io::Result<()> {
    let mut file = OutputFile::create_new(path)?;
    file.remove_stale();
    file.write_all(text.as_bytes())?;
    file.finish()
}

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
        Some(Dependency::in_current_state(file))
            .filter(|file| !file.is_special_file())
            .map(|file| Self { file, camera })
    }

    /// Adds the view to the file and returns the view's number.
    ///
    /// The file is replaced atomically and keeps all other text.
    ///
    /// # Errors
    /// If the file cannot be written, is not a scene file, or has changed since the user was asked; it is then left as
    /// it was.
    fn save_as_numbered_view(&self) -> io::Result<usize> {
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
        file.finish()?;
        Ok(count_views(&written).unwrap_or_default())
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
