//! Messages about broken meshes, word for word.
//!
//! In `tests/invalid_meshes`, `NAME` is a mesh and `NAME.txt` the message about it; `beside/` has the files that the
//! meshes name. `BLESS=1 cargo test --test files invalid_mesh_files` writes the messages anew; read them before they
//! are committed.

use std::path::{Path, PathBuf};
use termtrace::internals::mesh_file::MeshFile;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/invalid_meshes")
}

/// Returns the messages of the folder, or its other files.
fn files(are_messages: bool) -> Vec<PathBuf> {
    let mut files: Vec<_> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file() && path.extension().is_some_and(|ending| ending == "txt") == are_messages)
        .collect();
    files.sort();
    files
}

fn message_file(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".txt");
    name.into()
}

fn message(path: &Path) -> String {
    let name = path.file_name().unwrap().to_string_lossy();
    let bytes = std::fs::read(path).unwrap();
    match MeshFile::from_bytes(&name, &bytes, &mut |relative| std::fs::read(folder().join(relative))) {
        Ok(_) => format!("{name} is valid"),
        Err(error) => format!("{error}\n"),
    }
}

#[test]
fn every_fault_of_a_mesh_has_its_message() {
    let mut wrong = Vec::new();
    for path in files(false) {
        let found = message(&path);
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(message_file(&path), &found).unwrap();
        }
        let expected = std::fs::read_to_string(message_file(&path)).unwrap_or_default();
        if found != expected {
            wrong.push(format!("expected:\n{expected}\nfound:\n{found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn meshes_and_messages_come_in_pairs() {
    let meshes = files(false);
    assert!(meshes.len() >= 100, "only {}", meshes.len());
    let mut expected: Vec<_> = meshes.iter().map(|path| message_file(path)).collect();
    expected.sort();
    assert_eq!(files(true), expected);
}

/// Each message is one line without control characters, after the name of the file.
#[test]
fn messages_are_one_plain_line() {
    for path in files(false) {
        let message = message(&path);
        let line = message.strip_suffix('\n').unwrap();
        assert!(!line.contains(char::is_control), "{message:?}");
        let name = path.file_name().unwrap().to_string_lossy();
        assert!(line.starts_with(&format!("{name}:")) || line.starts_with("beside/"), "{message}");
    }
}
