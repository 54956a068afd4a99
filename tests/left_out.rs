//! Names what `cargo test` leaves out in the package.
//!
//! The package has no test data, so of the test programs it has this one alone, and it lacks the files of the
//! unit tests. There this program prints the other programs and the modules of these files by name; in the repository
//! it fails if a test program is missing from its list, or if it finds no such module.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

/// The other test programs, each with what it tests.
const LEFT_OUT: [(&str, &str); 14] = [
    ("cli", "the command line"),
    ("encoder", "cells to bytes, and ratatui's backend"),
    ("features", "the crates that each feature brings"),
    ("files", "scene files, meshes and textures, right and wrong"),
    ("input_corpus", "a fuzzer's inputs, once more"),
    ("laws", "the order of the modules, the language of comments"),
    ("live", "the live view on a pseudo-terminal"),
    ("package", "what is in the package"),
    ("pictures", "pictures, bit for bit"),
    ("public_api", "what the library promises"),
    ("readme", "what README and docs/ say"),
    ("serve", "the server over SSH"),
    ("slow", "limits in time"),
    ("slow_link", "a link of few bytes, late replies"),
];

fn main() -> ExitCode {
    // A test runner asks for names of tests, of which there are none.
    if std::env::args().any(|argument| argument == "--list") {
        return ExitCode::SUCCESS;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let there = programs(&root.join("tests"));
    let modules = modules(&root.join("src"));
    if modules.is_empty() {
        eprintln!("tests/left_out.rs finds no module behind {ATTRIBUTE}");
        return ExitCode::FAILURE;
    }
    if there.is_empty() {
        println!("The package has the documentation's examples. These tests are in the repository only:");
        for module in &modules {
            println!("unit tests {module} ... left out");
        }
        for (name, tests) in LEFT_OUT {
            println!("test program {name} ... left out: {tests}");
        }
        return ExitCode::SUCCESS;
    }
    let listed: BTreeSet<_> = LEFT_OUT.iter().map(|(name, _)| (*name).to_owned()).collect();
    if there == listed {
        return ExitCode::SUCCESS;
    }
    eprintln!("LEFT_OUT of tests/left_out.rs lists {listed:?}, but the test programs are {there:?}");
    ExitCode::FAILURE
}

/// The attribute of items that the package leaves out: build.rs sets `unit_tests` in the repository
/// alone.
const ATTRIBUTE: &str = "#[cfg(all(test, unit_tests))]";

/// Returns the paths of the modules behind [`ATTRIBUTE`] in the files of `folder`.
fn modules(folder: &Path) -> BTreeSet<String> {
    let mut modules = BTreeSet::new();
    for path in fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path()) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let below = |module: &str| format!("{name}::{module}");
        if path.is_dir() {
            modules.extend(self::modules(&path).iter().map(|module| below(module)));
            continue;
        }
        let text = fs::read_to_string(&path).unwrap_or_default();
        for (_, item) in text.lines().zip(text.lines().skip(1)).filter(|(attribute, _)| *attribute == ATTRIBUTE) {
            let module =
                item.trim_start_matches("pub ").strip_prefix("mod ").map(|rest| rest.trim_end_matches([';', '{', ' ']));
            modules.extend(module.map(below));
        }
    }
    modules
}

/// Returns the names of the test programs in `folder` but for this one.
fn programs(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path());
    let programs = entries.filter(|path| path.join("main.rs").exists() || path.extension().is_some_and(|e| e == "rs"));
    let names = programs.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()));
    names.filter(|name| name != "left_out").collect()
}
