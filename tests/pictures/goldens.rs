//! A golden frame of every shipped scene: 80x24 characters that can be read in a diff.
//!
//! After a wanted change of the pictures, `INSTA_UPDATE=always cargo test --test pictures goldens` writes them anew (a
//! golden whose scene is gone is removed by hand); read them before they are committed. Without that variable, a frame
//! that differs is written beside its golden as `.snap.new`, and the test fails.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use termtrace::{Scene, Size, text_frame};

const SIZE: Size = Size::new(80, 24);

pub(crate) fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Returns the names of a folder's files without this extension.
pub(crate) fn stems(folder: &Path, ending: &str) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    entries
        .map(|entry| entry.expect("the folder can be read").file_name().into_string().expect("names are UTF-8"))
        .filter_map(|name| name.strip_suffix(ending).map(str::to_owned))
        .collect()
}

pub(crate) fn scenes() -> BTreeSet<String> {
    stems(&folder("scenes"), ".ron")
}

/// Returns the frame with a bar on each side of a row.
///
/// Readers of goldens may drop blanks at the end of a line, which count here.
fn framed(frame: &str) -> String {
    let edge = format!("+{}+\n", "-".repeat(SIZE.columns.into()));
    let mut framed = edge.clone();
    for row in frame.lines() {
        let _ = writeln!(framed, "|{row}|");
    }
    framed + &edge
}

/// These checks are one test, in this order: where goldens are written anew, the later ones read
/// the new ones.
#[test]
fn every_scene_has_its_golden() {
    every_scene_looks_as_its_golden();
    assert_eq!(stems(&folder("tests/snapshots"), ".snap"), scenes(), "a golden without its scene, or a scene without");
    goldens_are_pictures();
}

fn every_scene_looks_as_its_golden() {
    let scenes = scenes();
    assert!(scenes.len() >= 8, "only {} scenes", scenes.len());
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    // Each golden is compared, so that one run shows all that differ.
    let differing: Vec<_> = scenes
        .into_iter()
        .filter(|name| {
            let scene = Scene::load(&folder("scenes").join(format!("{name}.ron"))).unwrap_or_else(|e| panic!("{e}"));
            let frame = framed(&text_frame(&scene, SIZE));
            settings.bind(|| catch_unwind(|| insta::assert_snapshot!(name.as_str(), frame))).is_err()
        })
        .collect();
    assert!(
        differing.is_empty(),
        "{differing:?}: see above; INSTA_UPDATE=always cargo test --test pictures goldens writes the goldens anew"
    );
}

/// Goldens can be read: 24 rows of 80 plain characters, no two scenes alike, and none of one glyph.
fn goldens_are_pictures() {
    let mut seen = BTreeSet::new();
    for name in stems(&folder("tests/snapshots"), ".snap") {
        let text = std::fs::read_to_string(folder("tests/snapshots").join(format!("{name}.snap"))).expect("readable");
        let rows: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix('|')?.strip_suffix('|')).collect();
        assert_eq!(rows.len(), usize::from(SIZE.rows), "{name}");
        for row in &rows {
            assert_eq!(row.len(), usize::from(SIZE.columns), "{name}: {row:?}");
            assert!(row.bytes().all(|byte| (b' '..=b'~').contains(&byte)), "{name}: {row:?}");
        }
        let characters: BTreeSet<u8> = rows.iter().flat_map(|row| row.bytes()).collect();
        assert!(characters.len() >= 3, "{name} has only {} kinds of characters", characters.len());
        assert!(seen.insert(rows.concat()), "{name} is another golden's picture");
    }
}
