//! Messages about broken files, word for word.
//!
//! In `tests/invalid`, `NAME.ron` is a scene and `NAME.txt` the message about it; in `tests/invalid_paths`, `NAME.ron`
//! is a camera path. `BLESS=1 cargo test --test files invalid` writes the messages anew; read them before they are
//! committed.

use std::path::{Path, PathBuf};
use termtrace::{CameraPath, Scene, SceneError};

/// A folder of broken files, their least number, and the function that reads them.
struct Kind {
    folder: &'static str,
    at_least: usize,
    read: fn(&str, &[u8]) -> Result<(), SceneError>,
}

const KINDS: [Kind; 2] = [
    Kind { folder: "tests/invalid", at_least: 35, read: |name, bytes| Scene::from_bytes(name, bytes).map(|_| ()) },
    Kind {
        folder: "tests/invalid_paths",
        at_least: 14,
        read: |name, bytes| {
            let scene = Scene::from_ron("scene", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))").unwrap();
            CameraPath::from_bytes(name, bytes, scene.camera()).map(|_| ())
        },
    },
];

impl Kind {
    fn files(&self, ending: &str) -> Vec<PathBuf> {
        let mut files: Vec<_> = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(self.folder))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|extension| extension == ending))
            .collect();
        files.sort();
        files
    }

    fn message(&self, path: &Path) -> String {
        let name = path.file_name().unwrap().to_string_lossy();
        let bytes = std::fs::read(path).unwrap();
        match (self.read)(&name, &bytes) {
            Ok(()) => format!("{name} is valid"),
            Err(error) => format!("{error}\n"),
        }
    }
}

#[test]
fn every_fault_has_its_message() {
    let mut wrong = Vec::new();
    for kind in KINDS {
        for path in kind.files("ron") {
            let (found, expected) = (kind.message(&path), path.with_extension("txt"));
            if std::env::var_os("BLESS").is_some() {
                std::fs::write(&expected, &found).unwrap();
            }
            let expected = std::fs::read_to_string(&expected).unwrap_or_default();
            if found != expected {
                wrong.push(format!("expected:\n{expected}\nfound:\n{found}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_and_messages_come_in_pairs() {
    let stems = |files: Vec<PathBuf>| -> Vec<_> { files.iter().map(|path| path.with_extension("")).collect() };
    for kind in KINDS {
        let files = kind.files("ron");
        assert!(files.len() >= kind.at_least, "only {} files in {}", files.len(), kind.folder);
        assert_eq!(stems(files), stems(kind.files("txt")));
    }
}

/// Each message begins with its position, and has no control characters.
#[test]
fn messages_are_plain_text() {
    for kind in KINDS {
        for path in kind.files("ron") {
            let message = kind.message(&path);
            let strange = message.chars().find(|&c| c.is_control() && c != '\n');
            assert_eq!(strange, None, "{}", path.display());
            let name = path.file_name().unwrap().to_string_lossy();
            assert!(message.starts_with(&format!("{name}:")), "{message}");
        }
    }
}
