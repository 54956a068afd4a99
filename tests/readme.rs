//! The statements of the README, tested.

use std::fs;
use std::path::Path;
use termtrace::internals::control::{Key, Keymap};
use termtrace::{CameraPath, Scene};

fn readme() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).expect("the README is there")
}

/// The blocks of code of one language.
fn blocks<'a>(readme: &'a str, language: &str) -> Vec<&'a str> {
    let start = format!("```{language}\n");
    readme.split(&start).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn every_scene_and_path_in_it_loads() {
    let readme = readme();
    let scenes = blocks(&readme, "ron");
    assert!(scenes.len() >= 2, "the scenes were found");
    let any = Scene::from_ron("any", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))").expect("a scene");
    for text in scenes {
        // The camera path, too, is RON, and so are settings and keys, which are read in `tests/cli/config.rs`.
        let read = if text.contains("fps:") || text.contains("fly:") {
            continue;
        } else if text.contains("keyframes:") {
            CameraPath::from_ron("README.md", text, any.camera()).map(|_| ())
        } else {
            Scene::from_ron("README.md", text).map(|_| ())
        };
        if let Err(error) = read {
            panic!("{error}");
        }
    }
}

#[test]
fn every_kind_of_item_is_shown() {
    let readme = readme();
    let scenes = blocks(&readme, "ron").concat();
    for word in
        ["Point(", "Sphere(", "Plane(", "Diffuse(", "Checker(", "Gradient(", "focal_length", "vertical_fov", "shift"]
    {
        assert!(scenes.contains(word), "no scene of the README shows {word}");
    }
}

#[test]
fn the_message_in_it_is_the_programs() {
    let readme = readme();
    let shown = blocks(&readme, "text").concat();
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n    objects: [\n        Sphere(center: (0, 1, 0), radus: 1),\n])";
    let error = Scene::from_ron("my.ron", text).expect_err("it is wrong").to_string();
    assert!(error.contains(shown.trim_end()), "the README says\n{shown}\nthe program says\n{error}");
}

#[test]
fn the_size_of_the_live_picture_is_the_programs() {
    let cells = termtrace::internals::app::MAX_PIXELS / 2;
    let cells = format!("{},{:03},{:03} cells", cells / 1_000_000, cells / 1000 % 1000, cells % 1000);
    assert!(readme().contains(&cells), "{cells}");
}

#[test]
fn every_scene_file_is_listed() {
    let readme = readme();
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")).expect("scenes are there") {
        let name = entry.expect("it can be read").file_name().into_string().expect("a plain name");
        assert!(readme.contains(&format!("`{name}`")) || name == "paths", "{name} is not in the README");
    }
}

#[test]
fn every_key_is_listed() {
    let readme = readme();
    for key in Keymap::default().bindings().iter().flat_map(|row| &row.keys).map(Key::to_string) {
        let listed = match &*key {
            "Left" | "Right" | "Up" | "Down" => "arrows".to_owned(),
            named if named.len() > 1 => named.to_owned(),
            // In a table a bar is written so.
            "|" => r"`\|`".to_owned(),
            // From the first to the last.
            "2" | "3" | "4" | "5" | "6" | "7" | "8" => "`1` to `9`".to_owned(),
            letter => format!("`{letter}`"),
        };
        assert!(readme.contains(&listed), "{key} is not in the README");
    }
}

/// Every key in quotes in the first column of the table of keys is bound.
#[test]
fn every_key_of_its_table_does_something() {
    let readme = readme();
    let (_, section) = readme.split_once("\n## Keys\n").expect("there is a section on keys");
    let rows = section.split("\n## ").next().unwrap_or_default().lines().filter(|line| line.starts_with("| "));
    let keymap = Keymap::default();
    let mut count = 0;
    for row in rows {
        let first = row.trim_start_matches("| ").replace(r"\|", "\u{7c}\u{7c}");
        let first = first.split(" | ").next().unwrap_or_default().replace("||", "|");
        for name in first.split('`').skip(1).step_by(2) {
            let key = Key::from_name(name);
            let is_bound = key.is_some_and(|key| keymap.bindings().iter().any(|row| row.keys.contains(&key)));
            assert!(is_bound, "{name} does nothing: {row}");
            count += 1;
        }
    }
    assert!(count > 25, "the table was read");
}
