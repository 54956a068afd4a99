use super::*;
use std::collections::BTreeSet;

#[test]
fn every_scene_of_the_folder_is_shipped_with_a_title() {
    let files = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")).expect("the folder is there");
    let files = files.map(|file| file.expect("the folder can be read").file_name().into_string().expect("UTF-8"));
    let names: BTreeSet<_> = files.filter_map(|file| file.strip_suffix(".ron").map(str::to_owned)).collect();
    assert_eq!(ShippedScene::names().map(str::to_owned).collect::<BTreeSet<_>>(), names);
    for scene in SHIPPED {
        assert!((10..=120).contains(&scene.title().len()), "{}: {:?}", scene.name, scene.title());
    }
}
