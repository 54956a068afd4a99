//! The caption of a scene: a field of its file, or the comment that the file begins with.

use crate::text::visible;
use std::sync::Arc;

/// Limit on the bytes of a caption: more than the largest screen shows.
const MAX_BYTES: usize = 8192;

/// Returns the text of the `//` comment that a scene file begins with.
pub(super) fn leading_comment(file: &str) -> Option<String> {
    let lines = file.trim_start_matches('\u{feff}').trim_start().lines();
    let comment = lines.map_while(|line| line.strip_prefix("//")).collect::<Vec<_>>().join("\n");
    (!comment.is_empty()).then_some(comment)
}

/// Returns the caption `written` as it is shown: each paragraph on one line, without control
/// characters.
///
/// Blank lines separate paragraphs. Returns `None` if the result is empty.
pub(super) fn displayed_caption(written: &str) -> Option<Arc<str>> {
    let mut paragraphs = vec![String::new()];
    let mut bytes = 0;
    // A caption that is too long is truncated at a line break, so that no character is cut in two.
    let lines = written.lines().map(str::trim).take_while(|line| {
        bytes += line.len();
        bytes <= MAX_BYTES
    });
    for line in lines {
        let Some(last) = paragraphs.last_mut() else { break };
        if !line.is_empty() {
            let gap = if last.is_empty() { "" } else { " " };
            last.extend([gap, &visible(line)]);
        } else if !last.is_empty() {
            paragraphs.push(String::new());
        }
    }
    let caption = paragraphs.join("\n");
    let caption = caption.trim_end();
    (!caption.is_empty()).then(|| caption.into())
}

#[cfg(all(test, unit_tests))]
mod tests;
