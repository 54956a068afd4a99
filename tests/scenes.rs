//! The scenes that come with the program.

use std::path::Path;
use termtrace::scene::Scene;

#[test]
fn every_scene_loads_and_says_what_to_look_at() {
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
