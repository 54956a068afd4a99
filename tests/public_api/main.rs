//! The promised surface: `tests/public_api.txt` lists its items, methods, fields, variants and
//! traits.
//!
//! A change of the surface that the list does not have fails here. Read the lines it shows: a removal or change needs a
//! breaking release. `BLESS=1 cargo test --test public_api` accepts it. It runs rustdoc, and is not part of `cargo
//! test`.

mod listing;
mod merge;
mod signature;

use listing::{Listing, listing};
use merge::with_items_of;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The most items and methods of the surface. Each is a promise.
///
/// An item that no task needs goes to `internals`, or is hidden.
const MAX_ITEMS: usize = 200;

/// The crates, and the features that are on: what docs.rs shows.
const TERMTRACE: [&str; 2] = ["termtrace", "backend"];
const CORE: [&str; 2] = ["termtrace-core", "ron,mesh,parallel,posix"];

/// The format of rustdoc's JSON that the reader was written for.
const FORMAT: u64 = 57;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Has rustdoc write the items of a crate, and reads them.
fn items([package, features]: [&str; 2]) -> serde_json::Value {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("it is in the folder of the build");
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut rustdoc = Command::new(cargo);
    rustdoc.current_dir(root()).env("RUSTDOC", root().join("tests/public_api/rustdoc"));
    rustdoc.args(["rustdoc", "--quiet", "--locked", "--lib", "--package", package, "--features", features]);
    rustdoc.arg("--target-dir").arg(target);
    rustdoc.args(["--", "-Z", "unstable-options", "--output-format", "json"]);
    assert!(rustdoc.status().expect("cargo runs").success(), "rustdoc fails");
    let json =
        fs::read(target.join(format!("doc/{}.json", package.replace('-', "_")))).expect("rustdoc has written it");
    serde_json::from_slice(&json).expect("it is JSON")
}

/// Which format the items have, if the reader was written for another one.
fn warning(items: &serde_json::Value) -> String {
    match items["format_version"].as_u64() {
        Some(FORMAT) => String::new(),
        found => format!("(rustdoc's JSON has format {found:?}; this test reads format {FORMAT})\n"),
    }
}

/// The lines of one list that the other does not have, behind a sign.
fn only_in(one: &str, other: &str, sign: &str) -> String {
    let other: BTreeSet<_> = other.lines().collect();
    let lines = one.lines().filter(|line| !other.contains(line));
    lines.flat_map(|line| [sign, " ", line, "\n"]).collect()
}

#[test]
fn the_surface_is_the_one_that_is_listed() {
    let items = with_items_of(items(TERMTRACE), items(CORE), "termtrace_core");
    let Listing { text, count, unpromised } = listing(&items);
    let path: PathBuf = root().join("tests/public_api.txt");
    if env::var_os("BLESS").is_some() {
        fs::write(&path, &text).expect("the list can be written");
    }
    println!("{count} items and methods, {} lines", text.lines().count());
    let listed = fs::read_to_string(&path).expect("the list is there");
    let (gone, new) = (only_in(&listed, &text, "-"), only_in(&text, &listed, "+"));
    assert!(
        text == listed,
        "{}the surface has changed:\n{gone}{new}If that is wanted (what is gone needs a breaking release), \
         `BLESS=1 cargo test --test public_api` writes tests/public_api.txt anew.",
        warning(&items)
    );
    assert!(unpromised.is_empty(), "types without a promise in promised signatures:\n{}", unpromised.join("\n"));
    assert!(count <= MAX_ITEMS, "{count} items and methods are promised, which is more than {MAX_ITEMS}");
}
