//! `tour`, `new`, a folder in the place of a scene, and warnings about a scene without light.

use super::{BALL, Folder};

#[test]
fn the_tour_prints_the_caption_of_every_built_in_scene() {
    let folder = Folder::new();
    let (tour, list) = (folder.run("tour").text(), folder.run("scenes").text());
    let names: Vec<_> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    let mut from = 0;
    for name in names {
        let at = tour[from..].find(&format!("{name}\n")).unwrap_or_else(|| panic!("{name} comes in order: {tour}"));
        from += at;
        let caption = tour[from..].split("\n\n").next().expect("a caption");
        assert!(caption.contains("\nLook at: ") && caption.contains("\nKeys: "), "{caption}");
    }
}

#[test]
fn a_new_scene_is_fine_and_is_never_written_over_a_file() {
    let folder = Folder::new();
    assert_eq!(folder.run("new my.ron").text(), "written: my.ron; termtrace my.ron opens it\n");
    assert_eq!(folder.run("check my.ron").text(), "my.ron: OK (3 objects, 2 lights)\n");
    folder.run("new ball.ron").fails_in_a_line(1, "ball.ron: this file exists and is left as it is");
    assert_eq!(folder.read("ball.ron"), BALL.as_bytes());
    folder.run("new my.obj").fails_in_a_line(2, "a scene is a text file such as my.ron");
    folder.run("new missing/my.ron").fails_in_a_line(1, "missing/my.ron");
}

#[test]
fn a_folder_stands_for_its_scenes_in_the_order_of_their_names() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("scenes")).expect("a folder can be made");
    folder.run("scenes/").fails_in_a_line(2, "scenes/: this is a directory without a scene (.ron) or mesh");
    folder.write("scenes/.hidden.ron", "");
    folder.write("scenes/notes.txt", "");
    folder.write("scenes/b.ron", BALL);
    // With one scene there is a frame to print.
    assert_eq!(folder.run("./scenes").text(), folder.run("ball.ron").text());
    folder.write("scenes/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.run("./scenes").fails_in_a_line(2, "\"./scenes/b.ron\" follows \"./scenes/a.obj\"");
    // The name of a command wins.
    assert!(folder.run("scenes").text().starts_with("three_spheres "));
}

const UNLIT: &str = "no lights and no ambient light: the picture is black";

#[test]
fn a_scene_without_light_is_warned_of() {
    let folder = Folder::new();
    let dark = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1)])";
    folder.write("dark.ron", dark);
    assert_eq!(folder.run("check dark.ron").text(), format!("dark.ron: OK (1 object, 0 lights), but {UNLIT}\n"));
    for command in ["frame dark.ron", "dark.ron"] {
        let run = folder.run(command);
        assert_eq!((run.code, run.stderr), (Some(0), format!("warning: {UNLIT}\n")), "{command}");
    }
    // A map needs no light.
    folder.run("frame dark.ron --map depth").done();
    let described = folder.run("describe dark.ron").text();
    assert!(described.contains("No lights and no ambient light: the picture is black."), "{described}");
    folder.write("lit.ron", dark.replace("objects", "ambient: 0.1, objects"));
    folder.run("frame lit.ron").done();
    folder.write("sky.ron", dark.replace("objects", "background: \"navy\", objects"));
    assert!(folder.run("check sky.ron").text().contains("but no lights and no ambient light: every object is black"));
}

/// The scene that the error about an empty file proposes shows something.
#[test]
fn the_smallest_scene_shows_something() {
    let folder = Folder::new();
    folder.write("empty.ron", "");
    let error = folder.run("check empty.ron").stderr;
    let (_, scene) = error.split_once(" is (").expect("a proposed scene");
    folder.write("smallest.ron", format!("({scene}"));
    let frame = folder.run("frame smallest.ron").text();
    assert!(frame.contains(['#', '%', '@']), "{frame}");
}
