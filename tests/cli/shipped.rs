//! The scenes that are part of the program.

use super::Folder;

#[test]
fn every_listed_scene_opens_by_name_from_any_folder() {
    let folder = Folder::new();
    let list = folder.run("scenes").text();
    let names: Vec<_> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.len() >= 12, "{list}");
    for name in names {
        let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
        assert_eq!(
            folder.run(&format!("frame {name}")).text(),
            folder.run(&format!("frame {shipped}/{name}.ron")).text()
        );
    }
}

#[test]
fn a_file_of_a_built_in_scenes_name_wins() {
    let folder = Folder::new();
    let ball = std::fs::read(folder.path("ball.ron")).expect("the scene is there");
    folder.write("corridor", ball);
    assert_eq!(folder.run("frame corridor").text(), folder.run("frame ball.ron").text());
}

#[test]
fn every_command_but_check_has_a_default_scene() {
    let folder = Folder::new();
    assert_eq!(folder.run("").text(), folder.run("three_spheres").text());
    assert_eq!(folder.run("frame").text(), folder.run("frame three_spheres").text());
    assert!(folder.run("describe").text().starts_with("three_spheres: 4 objects"));
    assert!(folder.run("explain --pixel 40,24").text().contains("sphere"));
    folder.run("record --seconds 0.1 -o film.cast").done();
    folder.run("check").is_misused("<SCENE>");
}

#[test]
fn a_misspelt_built_in_scene_gets_a_suggestion() {
    let folder = Folder::new();
    folder.run("coridor").fails_in_a_line(2, "did you mean corridor?");
    folder.run("frame teapot").fails_in_a_line(2, "did you mean teapots?");
}
