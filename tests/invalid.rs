//! What a person is told about a broken scene file, word for word: `tests/invalid/NAME.ron` is the file, `NAME.txt` the
//! message. `BLESS=1 cargo test --test invalid` writes the messages anew; read them before they are committed.

use std::path::{Path, PathBuf};
use termtrace::scene::Scene;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/invalid")
}

fn files(ending: &str) -> Vec<PathBuf> {
    let mut files: Vec<_> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == ending))
        .collect();
    files.sort();
    files
}

fn message(path: &Path) -> String {
    let name = path.file_name().unwrap().to_string_lossy();
    let bytes = std::fs::read(path).unwrap();
    match Scene::from_bytes(&name, &bytes) {
        Ok(_) => format!("{name} is a valid scene"),
        Err(error) => format!("{error}\n"),
    }
}

#[test]
fn every_fault_has_its_message() {
    let mut wrong = Vec::new();
    for path in files("ron") {
        let (found, expected) = (message(&path), path.with_extension("txt"));
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&expected, &found).unwrap();
        }
        let expected = std::fs::read_to_string(&expected).unwrap_or_default();
        if found != expected {
            wrong.push(format!("expected:\n{expected}\nfound:\n{found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_and_messages_come_in_pairs() {
    let files = files("ron");
    assert!(files.len() >= 35, "only {} files", files.len());
    let stems = |files: Vec<PathBuf>| -> Vec<_> { files.iter().map(|path| path.with_extension("")).collect() };
    assert_eq!(stems(files), stems(self::files("txt")));
}

/// The message stands where its first line says, and nothing in it moves a cursor.
#[test]
fn messages_are_plain_text() {
    for path in files("ron") {
        let message = message(&path);
        let strange = message.chars().find(|&c| c.is_control() && c != '\n');
        assert_eq!(strange, None, "{}", path.display());
        let name = path.file_name().unwrap().to_string_lossy();
        assert!(message.starts_with(&format!("{name}:")), "{message}");
    }
}
