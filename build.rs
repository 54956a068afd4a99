//! Tells the library which of its files are present.
//!
//! The published package leaves out the files of the larger unit tests.

use std::path::Path;

/// One of the files that the package leaves out, for all of them.
const UNIT_TESTS: &str = "src/pace/tests.rs";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(unit_tests)");
    if Path::new(UNIT_TESTS).exists() {
        println!("cargo::rustc-cfg=unit_tests");
    }
}
