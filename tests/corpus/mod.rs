//! A fuzzer's corpus, replayed: what it once found stays found.

use std::{fs, path::Path};

/// Asks of each file of that target's corpus what the fuzzer asks of any bytes.
pub(crate) fn replay(target: &str, hold_for: impl Fn(&[u8])) {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    if !fuzz.exists() {
        // The published crate comes without the fuzzer, which is a package of its own.
        return;
    }
    let mut count = 0;
    for entry in fs::read_dir(fuzz.join("corpus").join(target)).expect("the corpus is in the repository") {
        let path = entry.expect("a folder can be read to its end").path();
        let data = fs::read(&path).expect("a file of the corpus can be read");
        // The name comes out with the failure of a law.
        println!("{}", path.display());
        hold_for(&data);
        count += 1;
    }
    assert!(count >= 20, "the corpus has shrunk to {count} files");
}
