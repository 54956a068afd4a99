//! How two files differ that are lines of text.

use crate::text::visible_lines;
use similar::TextDiff;

/// Line by line, as `diff -u`.
pub(super) fn by_lines(golden: &[u8], file: &[u8], name: &str) -> String {
    let [golden, file] = [golden, file].map(String::from_utf8_lossy);
    let difference = TextDiff::from_lines(&*golden, &*file);
    // A golden file may be anything.
    visible_lines(&difference.unified_diff().context_radius(1).header(name, "this frame").to_string())
}
