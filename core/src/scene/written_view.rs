//! Insertion of a view into the text of a scene file.
//!
//! All other bytes stay, comments and blanks included.

use crate::camera::Camera;
use crate::progress::Reporter;
use crate::scene_file::SceneFile;
use crate::scene_text::{Body, Faults, Field, SyntaxNode, Value, parse};

/// Returns the text of a scene file with `camera` added as the last of its `views`.
///
/// Returns `None` if the text is not a scene.
///
/// ```
/// use termtrace::Scene;
/// use termtrace::internals::scene::with_view;
///
/// let text = "(\n    // From in front.\n    camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n)\n";
/// let camera = *Scene::from_ron("x.ron", &text.replace("0, 0, 5", "3, 1, 2"))?.camera();
/// assert_eq!(with_view(text, &camera).unwrap(), "(
///     // From in front.
///     camera: (eye: (0, 0, 5), target: (0, 0, 0)),
///     views: [
///         (eye: (3, 1, 2), target: (0, 0, 0)),
///     ],
/// )
/// ");
/// # Ok::<(), termtrace::SceneError>(())
/// ```
pub fn with_view(text: &str, camera: &Camera) -> Option<String> {
    let root = parse(text).ok()?;
    let view = camera.value_to_ron();
    let fields = fields(&root)?;
    let field = |name| fields.iter().find(|field: &&Field<'_>| field.name.text == name);
    let additions = match field("views") {
        Some(views) => insertion_into_list(text, &views.value, &view)?,
        None => insertion_after(text, field("camera")?, &view),
    };
    let written = with_insertions(text, additions);
    // The text will replace the user's file, so it is parsed again, and dropped if the insertion broke it.
    (count_views(&written)? == count_views(text)? + 1).then_some(written)
}

/// A text to insert, and the index of the byte before which it is inserted.
type Addition = (usize, String);

/// Returns the insertion of a view into an existing list, on a new line if the closing bracket is
/// on its own line.
fn insertion_into_list(text: &str, list: &SyntaxNode<'_>, view: &str) -> Option<Vec<Addition>> {
    let items = items(list)?;
    let close = list.span.end as usize - 1;
    let last = items.last().map(|item| item.span.end as usize);
    let before = text[..close].trim_end().len();
    // In a list on one line, the new view follows the last one on that line.
    if !text[before..close].contains('\n') {
        return Some(vec![last.map_or_else(|| (close, view.to_owned()), |end| (end, format!(", {view}")))]);
    }
    let indent = match items.last() {
        Some(item) => indent_of(text, item.span.start as usize).to_owned(),
        None => format!("{}    ", indent_of(text, close)),
    };
    let missing = last.filter(|&end| !text[skip_trivia(text, end)..].starts_with(','));
    // The comma is inserted directly after the value, as a comment may follow on its line.
    let comma = missing.map(|end| (end, ",".to_owned()));
    Some(comma.into_iter().chain([(before, format!("{}{indent}{view},", line_end(text)))]).collect())
}

/// Returns the insertion of a list of views after a field, on separate lines if nothing follows the
/// field on its line.
fn insertion_after(text: &str, field: &Field<'_>, view: &str) -> Vec<Addition> {
    let end = field.value.span.end as usize;
    let comma = Some(skip_trivia(text, end)).filter(|&at| text[at..].starts_with(','));
    let next = comma.map_or(end, |at| at + 1);
    let line = text[next..].lines().next().unwrap_or_default();
    if !(line.trim().is_empty() || line.trim_start().starts_with("//")) || !text[next..].contains('\n') {
        return match comma {
            Some(at) => vec![(at + 1, format!(" views: [{view}],"))],
            None => vec![(end, format!(", views: [{view}]"))],
        };
    }
    let (newline, indent) = (line_end(text), indent_of(text, field.name.span.start as usize));
    let list = format!("{newline}{indent}views: [{newline}{indent}    {view},{newline}{indent}],");
    let missing = comma.is_none().then(|| (end, ",".to_owned()));
    missing.into_iter().chain([(next + line.trim_end().len(), list)]).collect()
}

/// Returns the text with all insertions, which must be sorted by position.
fn with_insertions(text: &str, additions: Vec<Addition>) -> String {
    // The capacity is enough for the text and a view, so that the memory is allocated once.
    let mut written = String::with_capacity(text.len() + 200);
    let mut from = 0;
    for (at, addition) in additions {
        written.push_str(&text[from..at]);
        written.push_str(&addition);
        from = at;
    }
    written.push_str(&text[from..]);
    written
}

/// Returns the number of views in the text of a scene file, or `None` if it does not parse.
pub fn count_views(scene_text: &str) -> Option<usize> {
    let root = parse(scene_text).ok()?;
    Some(SceneFile::read(&root, &Reporter::silent(), &mut Faults::default()).views.len())
}

fn fields<'n, 'a>(node: &'n SyntaxNode<'a>) -> Option<&'n [Field<'a>]> {
    match &node.value {
        Value::Group(group) => match &group.body {
            Body::Fields(fields) => Some(fields),
            _ => None,
        },
        _ => None,
    }
}

fn items<'n, 'a>(node: &'n SyntaxNode<'a>) -> Option<&'n [SyntaxNode<'a>]> {
    match &node.value {
        Value::List(items) => Some(items),
        Value::Group(group) => match &group.body {
            Body::Values(items) => Some(items),
            _ => None,
        },
        _ => None,
    }
}

/// Returns the blanks at the start of the line that contains a byte.
fn indent_of(text: &str, offset: usize) -> &str {
    let start = text[..offset].rfind('\n').map_or(0, |newline| newline + 1);
    let line = &text[start..];
    &line[..line.len() - line.trim_start_matches([' ', '\t']).len()]
}

/// Returns the line ending that the text uses.
fn line_end(text: &str) -> &'static str {
    if text.contains("\r\n") { "\r\n" } else { "\n" }
}

/// Returns the index of the first byte from `offset` on outside white space and comments.
///
/// The text has been parsed, so every comment ends.
fn skip_trivia(text: &str, mut offset: usize) -> usize {
    loop {
        let rest = &text[offset..];
        let blanks = rest.len() - rest.trim_start().len();
        let rest = &rest[blanks..];
        let comment = match rest.get(..2) {
            Some("//") => rest.find('\n').unwrap_or(rest.len()),
            Some("/*") => block_comment_length(rest),
            _ => return offset + blanks,
        };
        offset += blanks + comment;
    }
}

/// Returns the length of the block comment at the start of the text, including nested comments.
fn block_comment_length(text: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < text.len() {
        match text.as_bytes().get(at..at + 2) {
            Some(b"/*") => (depth, at) = (depth + 1, at + 2),
            Some(b"*/") => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

#[cfg(all(test, unit_tests))]
mod tests;
