//! Paths that comments name: each is a file or folder of the repository.

use crate::comments::{of_rust, of_script};
use crate::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The folders at the root whose contents comments name.
const FOLDERS: [&str; 11] =
    ["core", "src", "tests", "benches", "examples", "fuzz", "docs", "scenes", "assets", ".ci", ".github"];

/// The endings of scripts and settings, whose comments start with `#`.
const SCRIPTS: [&str; 3] = ["toml", "yml", "sh"];

/// Returns all files of the repository, relative to its root.
///
/// Left out are the folders of builds and fuzzers.
fn repository_files() -> BTreeSet<String> {
    let (mut files, mut folders) = (BTreeSet::new(), vec![PathBuf::new()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).expect("the folder can be read") {
            let name = entry.expect("the entry can be read").file_name();
            let path = folder.join(&name);
            if !root().join(&path).is_dir() {
                files.insert(path.to_str().expect("names are UTF-8").to_owned());
            } else if !["target", ".git", "artifacts"].iter().any(|left_out| name == *left_out) {
                folders.push(path);
            }
        }
    }
    files
}

/// Returns the paths that a comment names: those in one of [`FOLDERS`], and names of Rust files.
fn named_paths(comment: &str) -> Vec<&str> {
    let is_part = |c: char| c.is_alphanumeric() || ['_', '-', '.', '/'].contains(&c);
    let words = comment.split(|c| !is_part(c)).map(|word| word.trim_end_matches('.'));
    let in_folder =
        |word: &str| word.split_once('/').is_some_and(|(folder, rest)| FOLDERS.contains(&folder) && !rest.is_empty());
    let is_rust =
        |word: &str| Path::new(word).extension().is_some_and(|ending| ending == "rs") && !word.starts_with(['.', '/']);
    // The site of documentation has the name of a Rust file.
    words.filter(|&word| (in_folder(word) || is_rust(word)) && word != "docs.rs").collect()
}

/// Returns whether a path is a file or folder of the repository.
///
/// It may start at the root, at a crate's root or at any folder.
fn exists(files: &BTreeSet<String>, path: &str) -> bool {
    let path = path.trim_end_matches('/');
    files.iter().any(|file| {
        let is_file = file.strip_suffix(path).is_some_and(|folder| folder.is_empty() || folder.ends_with('/'));
        is_file || file.strip_prefix(path).is_some_and(|rest| rest.starts_with('/'))
    })
}

/// Returns the paths in the comments of a file that do not exist, each with its line.
fn dangling(files: &BTreeSet<String>, file: &str, text: &str) -> Vec<String> {
    let comments = match Path::new(file).extension().and_then(|ending| ending.to_str()) {
        Some("rs") => of_rust(text),
        Some(ending) if SCRIPTS.contains(&ending) => of_script(text),
        // A script without an ending.
        None if file.starts_with(".ci/") => of_script(text),
        _ => return Vec::new(),
    };
    let named =
        comments.iter().flat_map(|comment| named_paths(comment.text).into_iter().map(move |path| (comment, path)));
    let dangling = named.filter(|(_, path)| !exists(files, path));
    dangling.map(|(comment, path)| format!("{file}:{}: there is no {path}", comment.line)).collect()
}

#[test]
fn paths_in_comments_exist() {
    let files = repository_files();
    assert!(files.len() > 600, "{} files were found", files.len());
    let mut found = Vec::new();
    for file in &files {
        let read = fs::read(root().join(file)).expect("the file can be read");
        found.extend(dangling(&files, file, &String::from_utf8_lossy(&read)));
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// Each snapshot names the test program that wrote it.
#[test]
fn snapshots_name_files_that_exist() {
    let files = repository_files();
    let snapshots: Vec<_> =
        files.iter().filter(|file| Path::new(file).extension().is_some_and(|ending| ending == "snap")).collect();
    assert!(snapshots.len() > 20, "{} snapshots were found", snapshots.len());
    for snapshot in snapshots {
        let text = fs::read_to_string(root().join(snapshot)).expect("snapshots are UTF-8");
        // insta writes the path below the workspace.
        let workspace = if snapshot.starts_with("downstream/") { "downstream/" } else { "" };
        let source = text.lines().find_map(|line| line.strip_prefix("source: "));
        let exists = source.is_some_and(|source| files.contains(&format!("{workspace}{source}")));
        assert!(exists, "{snapshot} names {source:?}");
    }
}

/// The tests above can fail.
#[test]
fn paths_that_do_not_exist_are_found() {
    let files = ["src/hit/packet.rs", "tests/laws.rs", "scenes/ball.ron"].map(str::to_owned).into();
    let found = |file: &str, text: &str| dangling(&files, file, text).len();
    assert_eq!(found("src/a.rs", "/// See `tests/goldens.rs` and hit/single.rs.\nf(); // src/ray.rs"), 3);
    assert_eq!(
        found("src/a.rs", "/// See `tests/laws.rs`, `hit/packet.rs`, packet.rs and src/hit/.\n\"src/ray.rs\";"),
        0
    );
    assert_eq!(found("src/a.rs", "//! `scenes/*.ron`, scenes/ball.ron, read/write, a.ron, src/, docs.rs"), 0);
    assert_eq!(found("Cargo.toml", "# In scenes/cube.ron.\na = \"src/ray.rs\" # src/ray.rs"), 2);
    assert_eq!(found(".ci/run", "# As tests/goldens.rs says."), 1);
    assert_eq!(found("README.md", "tests/goldens.rs"), 0);
}
