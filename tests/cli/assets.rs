//! The manual and the completions in `assets/`, which packagers install, are those that the program
//! prints.
//!
//! `BLESS=1 cargo test --test cli assets` writes them anew.

use super::Folder;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Each file in `assets/`, and the command that prints it.
const ASSETS: [(&str, &str); 23] = [
    ("completions/termtrace.bash", "completions bash"),
    ("completions/termtrace.elv", "completions elvish"),
    ("completions/termtrace.fish", "completions fish"),
    ("completions/_termtrace.ps1", "completions powershell"),
    ("completions/_termtrace", "completions zsh"),
    ("man/termtrace.1", "man"),
    ("man/termtrace-bench.1", "man bench"),
    ("man/termtrace-check.1", "man check"),
    ("man/termtrace-completions.1", "man completions"),
    ("man/termtrace-config.1", "man config"),
    ("man/termtrace-describe.1", "man describe"),
    ("man/termtrace-doctor.1", "man doctor"),
    ("man/termtrace-explain.1", "man explain"),
    ("man/termtrace-frame.1", "man frame"),
    ("man/termtrace-help.1", "man help"),
    ("man/termtrace-man.1", "man man"),
    ("man/termtrace-new.1", "man new"),
    ("man/termtrace-record.1", "man record"),
    ("man/termtrace-reference.1", "man reference"),
    ("man/termtrace-scenes.1", "man scenes"),
    ("man/termtrace-serve.1", "man serve"),
    ("man/termtrace-tour.1", "man tour"),
    ("man/termtrace-version.1", "man version"),
];

fn assets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets")
}

#[test]
#[cfg_attr(feature = "serve", ignore = "those in `assets` are of the default features")]
fn the_manual_and_the_completions_are_current() {
    let folder = Folder::new();
    let mut stale = vec![];
    for (name, command) in ASSETS {
        let (path, printed) = (assets().join(name), folder.run(command).done());
        if std::env::var_os("BLESS").is_some() {
            fs::create_dir_all(path.parent().expect("a folder")).expect("the folder can be made");
            fs::write(&path, &printed).expect("the file can be written");
        }
        if fs::read(&path).ok() != Some(printed) {
            stale.push(name);
        }
    }
    assert!(stale.is_empty(), "{stale:?}: BLESS=1 cargo test --test cli assets writes them anew");
}

/// Each page that the manual refers to exists, and the folder has no file that is in no list.
#[test]
fn the_manual_is_whole() {
    let listed: BTreeSet<_> = ASSETS.iter().map(|(name, _)| (*name).to_owned()).collect();
    let mut there = BTreeSet::new();
    for part in ["completions", "man"] {
        for entry in fs::read_dir(assets().join(part)).expect("the folder is there") {
            let name = entry.expect("it can be read").file_name();
            there.insert(format!("{part}/{}", name.to_string_lossy()));
        }
    }
    assert_eq!(there, listed);
    let manual = fs::read_to_string(assets().join("man/termtrace.1")).expect("the manual is there");
    let pages = manual.split("termtrace\\-").skip(1).filter_map(|rest| rest.split_once("(1)")).map(|(name, _)| name);
    let pages: BTreeSet<_> = pages.filter(|name| name.chars().all(|c| c.is_ascii_lowercase())).collect();
    assert!(pages.len() > 5, "the manual refers to its pages: {pages:?}");
    for page in pages {
        assert!(there.contains(&format!("man/termtrace-{page}.1")), "{page} has no page");
    }
}
