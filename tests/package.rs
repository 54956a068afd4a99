//! The package and what is published beside it: the manifest, the workflows and the README agree.

use std::collections::BTreeSet;
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
    section_of("Cargo.toml", header)
}

/// Returns the lines of a section of a manifest.
fn section_of(manifest: &str, header: &str) -> Vec<String> {
    let manifest = read(manifest);
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

/// Returns the names of the features.
fn features() -> BTreeSet<String> {
    let names = section("[features]").into_iter().filter_map(|line| Some(line.split_once(" = ")?.0.to_owned()));
    names.filter(|name| !name.starts_with('#')).collect()
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

/// Returns whether Windows refuses a file name.
///
/// A device's, with any extension, or one with a reserved character.
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

/// Lists of features end in a quote, a blank or a line's end.
fn named_features(text: &str, flag: &str) -> BTreeSet<String> {
    let lists = text.split(flag).skip(1).filter_map(|rest| rest.trim_start_matches(['"', '=', ' ']).lines().next());
    let names = lists.filter_map(|list| list.split(['"', ' ']).next()).flat_map(|list| list.split(','));
    names.filter(|name| !name.is_empty()).map(str::to_owned).collect()
}

/// The two packages are published together: one depends on exactly this version of the other.
#[test]
fn both_packages_have_the_same_version() {
    let core = section_of("core/Cargo.toml", "[package]");
    for key in ["version", "edition", "rust-version", "license"] {
        let line = format!("{key} = \"{}\"", value(key));
        assert!(core.contains(&line), "core/Cargo.toml lacks {line}");
    }
    let dependency = format!("termtrace-core = {{ version = \"={}\", path = \"core\" }}", value("version"));
    assert!(section("[dependencies]").contains(&dependency), "Cargo.toml lacks {dependency}");
}

#[test]
fn workflows_and_documentation_name_features_that_exist() {
    let known = features();
    let in_workflow = named_features(&read(".github/workflows/ci.yml"), "--features ");
    assert!(!in_workflow.is_empty(), "ci.yml names features");
    let in_docs = section("[package.metadata.docs.rs]").into_iter().find(|line| line.starts_with("features = "));
    let in_docs: BTreeSet<_> =
        in_docs.iter().flat_map(|line| line.split('"').skip(1).step_by(2)).map(str::to_owned).collect();
    assert!(!in_docs.is_empty(), "[package.metadata.docs.rs] names features");
    for name in in_workflow.union(&in_docs) {
        assert!(known.contains(name), "there is no feature {name}; there are {known:?}");
    }
    let undocumented: Vec<_> = known.difference(&in_docs).filter(|name| !UNDOCUMENTED.contains(&&***name)).collect();
    assert!(undocumented.is_empty(), "not in the documentation on docs.rs: {undocumented:?}");
}

/// Features without an item of the library.
const UNDOCUMENTED: [&str; 4] = ["default", "cli", "serve", "test-hooks"];

/// A gated file that is packed would be dead weight; one that is left out without its gate would
/// break `cargo test` in the package.
#[test]
fn the_packages_leave_out_the_files_of_gated_modules() {
    assert_gated_files_are_left_out("Cargo.toml", "src");
    assert_gated_files_are_left_out("core/Cargo.toml", "core/src");
}

fn assert_gated_files_are_left_out(manifest: &str, src: &str) {
    let src = root().join(src);
    let mut gated = BTreeSet::new();
    for path in paths(&src).into_iter().filter(|path| path.extension().is_some_and(|extension| extension == "rs")) {
        let text = fs::read_to_string(&path).expect("a source file can be read");
        for (_, item) in text.lines().zip(text.lines().skip(1)).filter(|(attribute, _)| GATES.contains(attribute)) {
            let module = item.trim_start_matches("pub ").strip_prefix("mod ").and_then(|rest| rest.strip_suffix(';'));
            gated.extend(module.map(|module| path.with_extension("").join(module).with_extension("rs")));
        }
    }
    assert!(gated.len() > 10, "{gated:?}");
    let patterns = section_of(manifest, "[package]")
        .into_iter()
        .filter_map(|line| Some(line.trim().strip_prefix("\"!/src/")?.trim_end_matches("\",").to_owned()));
    let patterns: Vec<_> = patterns.collect();
    let is_left_out = |path: &Path| {
        let name = path.strip_prefix(&src).expect("below src").to_string_lossy().into_owned();
        patterns.iter().any(|pattern| pattern.strip_prefix("**/").map_or(name == *pattern, |end| name.ends_with(end)))
    };
    let packed: Vec<_> = gated.iter().filter(|path| !is_left_out(path)).collect();
    assert!(packed.is_empty(), "add to `include` of {manifest}: {packed:?}");
    let left_out: BTreeSet<_> = paths(&src).into_iter().filter(|path| path.is_file() && is_left_out(path)).collect();
    let ungated: Vec<_> = left_out.difference(&gated).collect();
    assert!(ungated.is_empty(), "put one of {GATES:?} before their `mod`: {ungated:?}");
}

/// The attributes of modules whose files the package leaves out.
///
/// The second one stands before a module that a fuzz target uses as well as unit tests.
const GATES: [&str; 2] =
    ["#[cfg(all(test, unit_tests))]", "#[cfg(all(unit_tests, any(test, feature = \"test-hooks\")))]"];
