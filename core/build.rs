//! Tells the library what its compiler has and which of its files are present.
//!
//! AVX-512 came with Rust 1.89. The published package leaves out the files of the larger unit tests.

use std::env;
use std::path::Path;
use std::process::Command;

const FIRST: u32 = 89;

/// One of the files that the package leaves out, for all of them.
const UNIT_TESTS: &str = "src/shape/cube.rs";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(compiler_has_avx512)");
    if minor_version().is_some_and(|minor| minor >= FIRST) {
        println!("cargo::rustc-cfg=compiler_has_avx512");
    }
    println!("cargo::rustc-check-cfg=cfg(unit_tests)");
    if Path::new(UNIT_TESTS).exists() {
        println!("cargo::rustc-cfg=unit_tests");
    }
}

/// Returns the 95 of `rustc 1.95.0 (...)`.
fn minor_version() -> Option<u32> {
    let output = Command::new(env::var_os("RUSTC")?).arg("--version").output().ok()?;
    String::from_utf8(output.stdout).ok()?.split('.').nth(1)?.parse().ok()
}
