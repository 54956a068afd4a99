//! The fuzzer's corpus, replayed: what it once found stays found.

mod input_laws;

use std::{fs, path::Path};

#[test]
fn the_laws_of_input_hold_for_the_corpus() {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    if !fuzz.exists() {
        // The published crate comes without the fuzzer, which is a package of its own.
        return;
    }
    let mut count = 0;
    for entry in fs::read_dir(fuzz.join("corpus/input")).expect("the corpus is in the repository") {
        let path = entry.expect("a folder can be read to its end").path();
        let data = fs::read(&path).expect("a file of the corpus can be read");
        // The name comes out with the failure of a law.
        println!("{}", path.display());
        input_laws::hold_for(&data);
        count += 1;
    }
    assert!(count >= 20, "the corpus has shrunk to {count} files");
}
