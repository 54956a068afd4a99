//! The statements of README, `docs/` and CONTRIBUTING, tested.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use termtrace::internals::control::{Key, KeyMode, Keymap};
use termtrace::{CameraPath, Scene};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the paths of all pages, relative to the root.
fn pages() -> Vec<PathBuf> {
    let docs = fs::read_dir(root().join("docs")).expect("docs is there");
    let docs = docs.map(|entry| Path::new("docs").join(entry.expect("it can be read").file_name()));
    let mut pages: Vec<_> = docs.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect();
    pages.extend(["README.md", "CONTRIBUTING.md"].map(PathBuf::from));
    pages.sort();
    pages
}

fn page(path: impl AsRef<Path>) -> String {
    let path = path.as_ref();
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns the text of all pages.
fn all_pages() -> String {
    pages().iter().map(page).collect()
}

/// Returns the blocks of code in one language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let start = format!("```{language}\n");
    text.split(&start).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn every_scene_and_path_loads() {
    let all = all_pages();
    let scenes = blocks(&all, "ron");
    assert!(scenes.len() >= 3, "the scenes were found");
    let any = Scene::from_ron("any", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))").expect("a scene");
    for text in scenes {
        // The camera path, too, is RON, and so are settings and keys, which are read in `tests/cli/config.rs`.
        let read = if text.contains("fps:") || text.contains("fly:") {
            continue;
        } else if text.contains("keyframes:") {
            CameraPath::from_ron("path.ron", text, any.camera()).map(|_| ())
        } else {
            Scene::from_ron("scene.ron", text).map(|_| ())
        };
        if let Err(error) = read {
            panic!("{error}\n{text}");
        }
    }
}

#[test]
fn every_kind_of_item_is_shown() {
    let page = page("docs/scenes.md");
    let scenes = blocks(&page, "ron").concat();
    for word in [
        "Point(",
        "Spot(",
        "Sun(",
        "Sphere(",
        "Plane(",
        "Diffuse(",
        "Checker(",
        "Stripes(",
        "Gradient(bottom",
        "Gradient(from",
        "Noise(",
        "Image(",
        "focal_length",
        "vertical_fov",
        "shift",
    ] {
        assert!(scenes.contains(word), "no scene of docs/scenes.md shows {word}");
    }
}

#[test]
fn the_message_is_the_programs() {
    let page = page("docs/scenes.md");
    let shown = blocks(&page, "text").concat();
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n    objects: [\n        Sphere(center: (0, 1, 0), radus: 1),\n])";
    let error = Scene::from_ron("my.ron", text).expect_err("it is wrong").to_string();
    assert!(error.contains(shown.trim_end()), "the page says\n{shown}\nthe program says\n{error}");
}

#[test]
fn the_size_of_the_live_picture_is_the_programs() {
    let cells = termtrace::internals::app::MAX_PIXELS / 2;
    let cells = format!("{},{:03},{:03} cells", cells / 1_000_000, cells / 1000 % 1000, cells % 1000);
    for name in ["docs/commands.md", "docs/limits.md"] {
        assert!(page(name).contains(&cells), "{name} lacks {cells}");
    }
}

#[test]
fn every_scene_file_is_listed() {
    let page = page("docs/scenes.md");
    for entry in fs::read_dir(root().join("scenes")).expect("scenes are there") {
        let name = entry.expect("it can be read").file_name().into_string().expect("a plain name");
        assert!(page.contains(&format!("`{name}`")) || name == "paths", "{name} is not in docs/scenes.md");
    }
}

#[test]
fn every_key_is_listed() {
    let page = page("docs/controls.md");
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
        assert!(page.contains(&listed), "{key} is not in docs/controls.md");
    }
}

/// Every key in quotes in the first column of the table of keys is bound.
#[test]
fn every_key_of_the_table_does_something() {
    let page = page("docs/controls.md");
    let (_, section) = page.split_once("\n## Keys\n").expect("there is a section on keys");
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

/// The table of assignments has each key once; every key that is bound while no panel is open is in
/// it, and none that is reserved is bound.
#[test]
fn no_key_is_assigned_twice() {
    let page = page("docs/controls.md");
    let (_, table) = page.split_once("| keys | assigned to |").expect("there is a table of assignments");
    let (mut assigned, mut reserved) = (Vec::new(), Vec::new());
    for row in table.lines().filter(|line| line.starts_with("| `")) {
        let keys = row.replace(r"\|", "\u{1}");
        let names = keys.split('`').skip(1).step_by(2).map(|name| name.replace('\u{1}', "|"));
        for name in names {
            let key = Key::from_name(&name).unwrap_or_else(|| panic!("{name} is no key: {row}"));
            let shift = Key::from_name(&name.to_uppercase()).filter(|shift| *shift != key);
            for key in [Some(key), shift.filter(|_| row.contains("with Shift too"))].into_iter().flatten() {
                assert!(!assigned.contains(&key) && !reserved.contains(&key), "{key} is assigned twice");
                if row.contains("| reserved: ") { &mut reserved } else { &mut assigned }.push(key);
            }
        }
    }
    let keymap = Keymap::default();
    let modes = [KeyMode::Fly, KeyMode::Orbit, KeyMode::Always];
    for key in modes.iter().flat_map(|&mode| keymap.of(mode)).flat_map(|row| &row.keys) {
        assert!(assigned.contains(key), "{key} is bound, but not assigned in docs/controls.md");
    }
    for key in &assigned {
        let meant = keymap.command(&modes, &key.pressed());
        assert!(meant.is_some(), "{key} is assigned in docs/controls.md, but not bound");
    }
}

/// Returns the headings' anchors as GitHub and crates.io make them.
fn anchors(text: &str) -> Vec<String> {
    let headings = outside_code(text).filter_map(|line| line.strip_prefix('#'));
    let slug = |heading: &str| {
        let kept = heading.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        kept.chars().filter(|letter| letter.is_alphanumeric() || "-_".contains(*letter)).collect()
    };
    headings.map(slug).collect()
}

/// Returns the lines outside blocks of code.
fn outside_code(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        is_code ^= line.starts_with("```");
        !is_code && !line.starts_with("```")
    })
}

/// Returns what is wrong with the relative links of a page.
fn broken_links(path: &Path, text: &str) -> Vec<String> {
    let text: String = outside_code(text).flat_map(|line| [line, "\n"]).collect();
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let targets = targets.filter(|target| !target.starts_with("https://"));
    let fault = |target: &str| {
        let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
        let linked = if file.is_empty() { path.to_owned() } else { path.with_file_name(file) };
        if !root().join(&linked).exists() {
            return Some(format!("{}: {target}: there is no such file", path.display()));
        }
        let is_there = anchor.is_empty() || anchors(&page(linked)).iter().any(|found| found == anchor);
        (!is_there).then(|| format!("{}: {target}: there is no such heading", path.display()))
    };
    targets.filter_map(fault).collect()
}

#[test]
fn every_link_leads_somewhere() {
    let faults: Vec<_> = pages().iter().flat_map(|path| broken_links(path, &page(path))).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    let found = |text: &str| broken_links(Path::new("README.md"), text).len();
    assert_eq!(found("[a](docs/none.md) [b](#none) ![c](media/none.png) [d](docs/scenes.md#none)"), 4);
    assert_eq!(found("[a](docs/README.md) [b](https://example.org)\n```\n[c](none)\n```\n"), 0);
}

/// The index of `docs/` names each of its pages.
#[test]
fn every_page_is_in_the_index() {
    let index = page("docs/README.md");
    for path in pages() {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        let is_listed = ["", "../"].iter().any(|folder| index.contains(&format!("]({folder}{name})")));
        assert!(is_listed, "docs/README.md lacks {name}");
    }
}

/// Moving pictures load at once on a slow link.
#[test]
fn no_picture_is_large() {
    let pictures = fs::read_dir(root().join("media")).expect("media is there");
    for picture in pictures.map(|picture| picture.expect("it can be read")) {
        let bytes = picture.metadata().expect("it can be read").len();
        assert!(bytes < 1_000_000, "{}: {bytes} bytes", picture.path().display());
    }
}

/// README is in the package, and is read first.
#[test]
fn the_readme_is_short() {
    let lines = page("README.md").lines().count();
    assert!(lines <= 200, "{lines} lines");
}

/// Returns the code spans in a section of README that begin with `termtrace `, without that word.
fn commands_of<'a>(readme: &'a str, section: &str) -> Vec<&'a str> {
    let (_, section) = readme.split_once(&format!("\n## {section}\n")).expect("README has this section");
    let section = section.split("\n## ").next().unwrap_or_default();
    section.split('`').skip(1).step_by(2).filter_map(|code| code.strip_prefix("termtrace ")).collect()
}

/// Each command of the table of features succeeds; films are cut short.
#[test]
fn each_command_of_the_readme_works() {
    let readme = page("README.md");
    let commands = commands_of(&readme, "What it can do");
    assert!(commands.len() >= 10, "{commands:?}");
    let folder = tempfile::tempdir().expect("a folder can be made");
    let scene = page("docs/scenes.md");
    fs::write(folder.path().join("my.ron"), blocks(&scene, "ron")[0]).expect("a scene can be written");
    fs::copy(root().join("tests/meshes/tetrahedron.ply"), folder.path().join("bunny.ply"))
        .expect("a mesh can be copied");
    for command in commands {
        let mut arguments: Vec<_> = command.split(' ').collect();
        if arguments[0] == "record" {
            arguments.extend(["--seconds", "0.1"]);
        }
        let mut program = Command::new(env!("CARGO_BIN_EXE_termtrace"));
        program.current_dir(&folder).env("XDG_CONFIG_HOME", folder.path()).args(arguments).stdin(Stdio::null());
        let output = program.output().expect("the program starts");
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    }
}
