//! `reference`, and the pictures of `--lecture`.

use super::Folder;
use std::fs;
use std::path::Path;

#[test]
fn the_reference_has_an_entry_for_each_name() {
    let folder = Folder::new();
    let all = folder.run("reference").text();
    for title in ["Scene", "Lights", "Materials", "Finishes", "Objects"] {
        assert!(all.lines().any(|line| line == title), "{title}: {all}");
    }
    let one = folder.run("reference globe").text();
    assert!(one.starts_with("  Globe(position: ..., radius: ...)\n    A luminous ball"), "{one}");
    assert!(one.contains("    radius     the radius of the ball [required]\n"), "{one}");
    assert!(one.contains("    intensity  the factor of the colour [default: 1]\n"), "{one}");
    assert!(all.contains(&one), "{one}");
}

/// All fields that a scene file may have are in the documentation of scenes too.
#[test]
fn the_documentation_names_all_of_the_reference() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scenes.md");
    let docs = fs::read_to_string(docs).expect("the documentation is there");
    let all = Folder::new().run("reference").text();
    let mut names = 0;
    for line in all.lines().filter(|line| line.starts_with("    ") && line.ends_with(']')) {
        let name = line.split_whitespace().next().expect("a name");
        assert!(docs.contains(&format!("`{name}`")) || docs.contains(&format!("{name}:")), "{name} is not in the docs");
        names += 1;
    }
    assert!(names > 70, "only {names} fields");
}

#[test]
fn an_unknown_name_is_refused_with_the_one_that_was_meant() {
    let run = Folder::new().run("reference Glob");
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("scene files have no \"Glob\"; did you mean Globe?"), "{}", run.stderr);
}

#[test]
fn the_lectures_model_leaves_out_all_else() {
    let folder = Folder::new();
    let scene = |fields: &str, light: &str, finish: &str| {
        format!(
            "(camera: (eye: (0, 1, 5), target: (0, 0.5, 0)), {fields} lights: [{light}], objects: [
                Sphere(center: (0, 1, 0), radius: 1, {finish}), Plane(point: (0, 0, 0), normal: (0, 1, 0))])"
        )
    };
    let globe = "Globe(position: (2, 4, 3), radius: 0.5, intensity: 20)";
    let fields = "fog: (distance: 5), ";
    folder.write("rich.ron", scene(fields, globe, "finish: Shiny, opacity: 0.5"));
    folder.write("field.ron", scene(&format!("lecture: true, {fields}"), globe, "finish: Metal"));
    folder.write("plain.ron", scene("", "Point(position: (2, 4, 3), intensity: 20)", ""));
    let frame = |arguments: &str| folder.run(&format!("frame --format ansi {arguments}")).text();
    let plain = frame("plain.ron");
    assert_eq!(frame("rich.ron --lecture"), plain);
    assert_eq!(frame("field.ron"), plain);
    assert_ne!(frame("rich.ron"), plain);
}
