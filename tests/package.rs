//! The package and what is published beside it: the manifest, the workflows and the README agree.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Returns the lines of a section of the manifest.
fn section(header: &str) -> Vec<String> {
    let manifest = read("Cargo.toml");
    let lines = manifest.lines().skip_while(|line| *line != header).skip(1);
    lines.take_while(|line| !line.starts_with('[')).map(str::to_owned).collect()
}

/// Returns the value of a key of `[package]`.
fn value(key: &str) -> String {
    let found = section("[package]").iter().find_map(|line| {
        let (name, value) = line.split_once(" = ")?;
        (name == key).then(|| value.trim_matches('"').to_owned())
    });
    found.unwrap_or_else(|| panic!("[package] has no {key}"))
}

/// Returns all paths of a checkout, without Git's own folder and what builds make.
fn paths(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("a folder's entry can be read").path();
        if [".git", "target", "artifacts"].iter().any(|name| path.ends_with(name)) {
            continue;
        }
        if path.is_dir() {
            found.extend(paths(&path));
        }
        found.push(path);
    }
    found
}

/// Whether Windows cannot have a file of that name: a device's, with any extension, or with a character that it refuses.
fn is_refused_by_windows(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_ascii_lowercase();
    let is_numbered =
        |device: &str| stem.strip_prefix(device).is_some_and(|number| matches!(number.as_bytes(), [b'1'..=b'9']));
    ["con", "prn", "aux", "nul"].contains(&&*stem)
        || is_numbered("com")
        || is_numbered("lpt")
        || name.contains(['<', '>', ':', '"', '\\', '|', '?', '*'])
        || name.ends_with(['.', ' '])
}

#[test]
fn every_path_can_be_checked_out_on_windows() {
    let paths = paths(root());
    assert!(paths.len() > 500, "the files were found: {}", paths.len());
    let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let refused: Vec<_> = paths.iter().filter(|path| is_refused_by_windows(&name(path))).collect();
    assert!(refused.is_empty(), "{refused:?}");
    for name in ["nul.obj", "AUX", "com1.tar.gz", "a?.ron", "a."] {
        assert!(is_refused_by_windows(name), "{name}");
    }
    for name in ["null.obj", "com10", "command", "a.ron", ".ci"] {
        assert!(!is_refused_by_windows(name), "{name}");
    }
}

/// The compiler version of the manifest is the one that is promised and the one that is tried.
#[test]
fn the_compiler_version_is_the_same_everywhere() {
    let version = value("rust-version");
    let readme = read("README.md");
    assert!(readme.contains(&format!("a Rust toolchain ({version} or later")), "README.md: {version}");
    let workflow = read(".github/workflows/ci.yml");
    assert!(workflow.contains(&format!("RUST_VERSION: \"{version}\"")), "ci.yml: {version}");
}
