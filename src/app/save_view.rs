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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::os::unix::fs::{PermissionsExt, symlink};

    const TEXT: &str = "( // mine\n    camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n)\n";

    fn camera() -> Camera {
        *Scene::from_ron("x", &TEXT.replace('5', "7")).expect("a scene").camera()
    }

    #[test]
    fn a_view_is_written_and_all_else_stays() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let (file, link) = (folder.path().join("x.ron"), folder.path().join("link.ron"));
        fs::write(&file, TEXT).expect("written");
        fs::set_permissions(&file, PermissionsExt::from_mode(0o640)).expect("it is ours");
        symlink("x.ron", &link).expect("a link can be made");
        ProposedView::new(&link, camera()).expect("a file").write().expect("written");
        let written = fs::read_to_string(&file).expect("it is there");
        assert_eq!(Some(written.as_str()), with_view(TEXT, &camera()).as_deref());
        assert_eq!(fs::metadata(&file).expect("it is there").permissions().mode() & 0o777, 0o640);
        assert!(fs::symlink_metadata(&link).expect("it is there").is_symlink());
        assert_eq!(fs::read_dir(folder.path()).expect("it is there").count(), 2, "nothing is left over");
    }

    /// Checks nothing for a user who may write every file, such as root.
    #[test]
    fn a_file_that_may_not_be_written_is_left_alone() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let file = folder.path().join("x.ron");
        fs::write(&file, TEXT).expect("written");
        fs::set_permissions(&file, PermissionsExt::from_mode(0o444)).expect("it is ours");
        if fs::File::options().append(true).open(&file).is_err() {
            let error = ProposedView::new(&file, camera()).expect("a file").write().expect_err("it may not be written");
            assert_eq!(error.kind(), io::ErrorKind::PermissionDenied);
            assert_eq!(fs::read_to_string(&file).expect("it is there"), TEXT);
        }
    }

    #[test]
    fn a_hard_link_is_not_cut() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let (file, other) = (folder.path().join("x.ron"), folder.path().join("y.ron"));
        fs::write(&file, TEXT).expect("written");
        fs::hard_link(&file, &other).expect("a link can be made");
        ProposedView::new(&file, camera()).expect("a file").write().expect("written");
        assert_eq!(fs::read_to_string(&other).ok(), with_view(TEXT, &camera()));
    }

    #[test]
    fn a_file_that_changes_or_is_no_scene_is_left_alone() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let file = folder.path().join("x.ron");
        fs::write(&file, TEXT).expect("written");
        let asked = ProposedView::new(&file, camera()).expect("a file");
        let changed = TEXT.replace("mine", "not mine");
        fs::write(&file, &changed).expect("written");
        assert!(asked.write().is_err());
        assert_eq!(fs::read_to_string(&file).expect("it is there"), changed);
        fs::write(&file, "no scene").expect("written");
        assert!(ProposedView::new(&file, camera()).is_some_and(|asked| asked.write().is_err()));
        fs::remove_file(&file).expect("it can be removed");
        assert!(ProposedView::new(&file, camera()).is_some_and(|asked| asked.write().is_err()));
        assert_eq!(fs::read_dir(folder.path()).expect("it is there").count(), 0, "nothing is left over");
    }
}
