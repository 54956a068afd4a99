//! The scenes that come with the program.

use std::path::Path;
use termtrace::{CameraPath, Scene};

#[test]
fn every_scene_loads_and_begins_with_a_comment() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "ron") {
            continue;
        }
        let scene = Scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
        assert!(!scene.objects().is_empty(), "{}", path.display());
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("// "), "{} begins with a comment", path.display());
        count += 1;
    }
    assert!(count >= 11, "only {count} scenes");
}

#[test]
fn every_path_through_a_scene_gives_a_picture_at_every_time() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let scene = Scene::load(&scenes.join("three_spheres.ron")).unwrap_or_else(|error| panic!("{error}"));
    let mut count = 0;
    for entry in std::fs::read_dir(scenes.join("paths")).unwrap() {
        let file = entry.unwrap().path();
        let path = CameraPath::load(&file, scene.camera()).unwrap_or_else(|error| panic!("{error}"));
        let frames = (120.0 * path.seconds()) as usize;
        let cameras = path.cameras(frames, 120).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(cameras.len() >= 120, "{}", file.display());
        let text = std::fs::read_to_string(&file).unwrap();
        assert!(text.starts_with("// "), "{} begins with a comment", file.display());
        assert!(text.contains("three_spheres.ron"), "{} says which scene it is for", file.display());
        count += 1;
    }
    assert!(count >= 1, "no path");
}
