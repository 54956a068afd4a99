//! Reading the comments of a source file.

use std::iter;

/// A line of a comment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Comment<'a> {
    /// The line of the file, from 1.
    pub(crate) line: usize,
    /// The comment without its marker.
    pub(crate) text: &'a str,
    /// Whether this is the first line of a doc comment.
    pub(crate) opens_doc: bool,
}

/// Returns the comments of Rust source, line by line.
pub(crate) fn of_rust(source: &str) -> Vec<Comment<'_>> {
    let markers = iter::once(None).chain(source.lines().map(doc_marker));
    let lines = source.lines().zip(markers).enumerate();
    let comments = lines.filter_map(|(index, (line, marker_above))| {
        let marker = doc_marker(line);
        let text = rust_comment(line)?;
        Some(Comment { line: index + 1, text, opens_doc: marker.is_some() && marker != marker_above })
    });
    comments.collect()
}

/// Returns the comments of a file whose comments start with `#`: TOML, YAML and shell.
pub(crate) fn of_script(source: &str) -> Vec<Comment<'_>> {
    let comments = source.lines().enumerate().filter_map(|(index, line)| {
        let text = line.strip_prefix('#').or_else(|| Some(line.split_once(" #")?.1))?;
        Some(Comment { line: index + 1, text: text.trim(), opens_doc: false })
    });
    comments.collect()
}

/// Returns the marker of a doc comment, `///` or `//!`.
fn doc_marker(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let marker = line.get(..3)?;
    (["///", "//!"].contains(&marker) && !line[3..].starts_with('/')).then_some(marker)
}

/// Returns the text of the comment that a line is, or ends in.
fn rust_comment(line: &str) -> Option<&str> {
    let text = line.trim_start().strip_prefix("//").or_else(|| {
        let (before, comment) = line.split_once(" // ")?;
        // An odd number of quotes: the slashes are inside a string.
        let escaped = before.matches("\\\"").count();
        ((before.matches('"').count() - escaped) % 2 == 0).then_some(comment)
    })?;
    Some(text.trim_start_matches(['/', '!']).trim())
}

#[test]
fn comments_are_told_from_code() {
    let source = "//! Guide.\n//! More.\n/// Item.\n/// More.\nfn f() {\n    // Reason.\n    g(1); // Why.\n    \"a \\\" // b\"\n}";
    let read = of_rust(source);
    let texts: Vec<_> = read.iter().map(|comment| (comment.line, comment.text)).collect();
    assert_eq!(texts, [(1, "Guide."), (2, "More."), (3, "Item."), (4, "More."), (6, "Reason."), (7, "Why.")]);
    let opening: Vec<_> = read.iter().filter(|comment| comment.opens_doc).map(|comment| comment.line).collect();
    assert_eq!(opening, [1, 3]);
    let script = of_script("# Why.\na = 1 # One.\nb = \"#fff\"\n");
    assert_eq!(script.iter().map(|comment| comment.text).collect::<Vec<_>>(), ["Why.", "One."]);
}
