//! The features in the crate's documentation, against the manifest and the crates that cargo
//! resolves.

use std::collections::BTreeSet;
use std::env;
use std::process::Command;
use std::thread;

const LIB: &str = include_str!("../src/lib.rs");
const MANIFEST: &str = include_str!("../Cargo.toml");

/// The most crates that may be compiled with these features, this one included.
const MAX_CRATES: [(&str, usize); 3] = [("", 5), ("`ron`, `parallel`", 26), ("`cli`", 140)];

/// The rows of the table: features, and how many crates are said to be compiled with them.
fn rows() -> Vec<(&'static str, usize)> {
    let rows = LIB.lines().filter_map(|line| {
        let row = line.strip_prefix("//! | ")?.strip_suffix(" |")?;
        let (features, _) = row.split_once(" |")?;
        let (_, count) = row.rsplit_once(' ')?;
        Some((if features == "(none)" { "" } else { features }, count.parse().ok()?))
    });
    rows.collect()
}

/// Returns the number of crates that cargo compiles for the library with these features.
fn crates(features: &str) -> usize {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut tree = Command::new(cargo);
    tree.current_dir(env!("CARGO_MANIFEST_DIR")).args(["tree", "--locked", "--offline"]);
    tree.args(["--edges", "normal", "--prefix", "none", "--format", "{p}", "--target", "x86_64-unknown-linux-gnu"]);
    tree.args(["--package", "termtrace", "--no-default-features", "--features", &features.replace('`', "")]);
    let output = tree.output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let packages = String::from_utf8(output.stdout).expect("names of packages are UTF-8");
    packages.lines().map(|line| line.trim_end_matches(" (*)")).collect::<BTreeSet<_>>().len()
}

#[test]
fn the_table_has_every_feature() {
    let features = MANIFEST.split("[features]").nth(1).and_then(|rest| rest.split("\n[").next()).expect("features");
    let names = features.lines().filter_map(|line| Some(line.split_once(" = [")?.0));
    let of_users = names.filter(|name| !["default", "test-hooks"].contains(name));
    let expected: BTreeSet<_> = of_users.map(|name| format!("`{name}`")).collect();
    let alone = rows().into_iter().filter(|(features, _)| features.matches('`').count() == 2);
    let found: BTreeSet<_> = alone.map(|(feature, _)| feature.to_owned()).collect();
    assert_eq!(found, expected);
}

#[test]
fn the_table_counts_crates() {
    let rows = rows();
    thread::scope(|scope| {
        for &(features, count) in &rows {
            scope.spawn(move || assert_eq!(crates(features), count, "crates with {features:?}"));
        }
    });
    for (features, most) in MAX_CRATES {
        let count = rows.iter().find(|&&(row, _)| row == features).map(|&(_, count)| count);
        assert!(count.is_some_and(|count| count <= most), "{count:?} crates with {features:?}");
    }
}
