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
    ProposedView::new(&link, camera()).expect("a file").save_as_numbered_view().expect("written");
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
        let error = ProposedView::new(&file, camera())
            .expect("a file")
            .save_as_numbered_view()
            .expect_err("it may not be written");
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
    ProposedView::new(&file, camera()).expect("a file").save_as_numbered_view().expect("written");
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
    assert!(asked.save_as_numbered_view().is_err());
    assert_eq!(fs::read_to_string(&file).expect("it is there"), changed);
    fs::write(&file, "no scene").expect("written");
    assert!(ProposedView::new(&file, camera()).is_some_and(|asked| asked.save_as_numbered_view().is_err()));
    fs::remove_file(&file).expect("it can be removed");
    assert!(ProposedView::new(&file, camera()).is_some_and(|asked| asked.save_as_numbered_view().is_err()));
    assert_eq!(fs::read_dir(folder.path()).expect("it is there").count(), 0, "nothing is left over");
}
