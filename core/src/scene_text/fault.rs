//! Faults of a text and their display: all faults at once, in the order of the text, as compilers
//! do.

use super::Span;
use crate::progress::Unfinished;
use crate::text::{Notice, visible, visible_char};
use std::fmt;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// A fault of a text and its span.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The message: one line without a full stop. Where possible it says what would be right.
    pub message: String,
    /// The span that the message refers to.
    pub span: Span,
}

impl From<Fault> for Unfinished<Fault> {
    fn from(fault: Fault) -> Self {
        Self::Failed(fault)
    }
}

/// The faults found so far. The first thousand are stored, the others only counted.
#[derive(Clone, Debug, Default)]
pub struct Faults {
    kept: Vec<Fault>,
    more: usize,
}

impl Faults {
    /// The largest number of faults that are stored.
    // A generated file may have the same fault a million times, and sorting and excerpts of all would take seconds.
    const MAX_KEPT: usize = 1000;

    /// Adds a fault. `message` is called only if the fault is stored.
    pub fn add(&mut self, span: Span, message: impl FnOnce() -> String) {
        // The messages of faults that are only counted are never made.
        if self.kept.len() < Self::MAX_KEPT {
            let message = message();
            self.kept.push(Fault { message, span });
        } else {
            self.more += 1;
        }
    }

    /// Returns whether there are no faults.
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }
}

impl From<Fault> for Faults {
    fn from(fault: Fault) -> Self {
        Self { kept: vec![fault], more: 0 }
    }
}

/// The error of a text that is not a valid scene or camera path, with all faults found in it.
///
/// It is displayed like a compiler's message:
///
/// ```
/// use termtrace::Scene;
///
/// let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n objects: [Sphere(center: (0, 1, 0), radus: 1)])";
/// let error = Scene::from_ron("x.ron", text).expect_err("a field is misspelt");
/// assert_eq!(error.to_string(), r#"
/// x.ron:2:38: unknown field "radus"; did you mean "radius"?
///   2 |  objects: [Sphere(center: (0, 1, 0), radus: 1)])
///     |                                      ^^^^^
/// "#.trim());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    name: String,
    reports: Vec<FaultReport>,
    more: usize,
}

/// A fault prepared for display, with all control characters replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaultReport {
    /// The line of the fault, counted from 1.
    pub line: usize,
    /// The column of the fault, in characters, counted from 1.
    pub column: usize,
    /// The message about the fault.
    pub message: String,
    /// The span that the message refers to.
    pub span: Span,
    /// The line of the text, or the part of a long line around the fault.
    pub source: String,
    /// The number of terminal columns before the fault in `source`.
    pub caret: usize,
    /// The number of terminal columns of the fault in `source`, at least 1.
    pub caret_width: usize,
}

impl FaultReport {
    /// Returns the message, preceded by the file's name and the position.
    fn message_in(&self, name: &str) -> String {
        let Self { line, column, message, .. } = self;
        format!("{name}:{line}:{column}: {message}")
    }

    /// Returns the line of the text with its number, and a line of carets below it; `None` if there
    /// is no source line.
    fn excerpt(&self) -> Option<[String; 2]> {
        let Self { line, source, caret, caret_width, .. } = self;
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        let below = format!("  {margin} | {:caret$}{}", "", "^".repeat(*caret_width));
        (!source.is_empty()).then(|| [format!("  {number} | {source}"), below])
    }
}

impl SceneError {
    /// The largest number of faults that are printed.
    // More faults would scroll the first ones, which often cause the others, off the screen.
    const MAX_PRINTED: usize = 50;

    /// Returns the error with the faults of a text. `name` is the file's name for messages.
    #[doc(hidden)]
    pub fn new(name: &str, text: &str, faults: impl Into<Faults>) -> Self {
        let Faults { mut kept, more } = faults.into();
        // Faults are sorted here because those of fields and those of checks are found in two passes.
        kept.sort_by_key(|fault| (fault.span.start, fault.span.end));
        let mut counter = LineCounter::new(text);
        let reports = kept.iter().map(|fault| counter.report(fault)).collect();
        Self { name: visible(name), reports, more }
    }

    /// Returns the line of the first fault, counted from 1.
    pub fn line(&self) -> usize {
        self.reports.first().map_or(1, |report| report.line)
    }

    /// Returns the column of the first fault, in characters, counted from 1.
    pub fn column(&self) -> usize {
        self.reports.first().map_or(1, |report| report.column)
    }

    /// Returns the message of the first fault: one line without a full stop.
    ///
    /// ```
    /// use termtrace::Scene;
    ///
    /// let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n objects: [Sphere(center: (0, 1, 0), radus: 1)])";
    /// let error = Scene::from_ron("x.ron", text).expect_err("a field is misspelt");
    /// assert_eq!((error.line(), error.column()), (2, 38));
    /// assert!(error.message().contains("did you mean \"radius\"?"));
    /// ```
    pub fn message(&self) -> &str {
        self.reports.first().map_or("", |report| &report.message)
    }

    /// Returns the faults in the order of the text, at most a thousand.
    #[doc(hidden)]
    pub fn reports(&self) -> &[FaultReport] {
        &self.reports
    }

    /// Returns the first fault as a notice: its message, its excerpt, and whether there are more
    /// faults.
    #[doc(hidden)]
    pub fn notice(&self) -> Notice {
        let has_more = self.count() > 1;
        let Some(first) = self.reports.first() else { return Notice { has_more, ..Notice::default() } };
        Notice { message: first.message_in(&self.name), excerpt: first.excerpt(), has_more }
    }

    /// Returns the number of faults.
    #[doc(hidden)]
    pub fn count(&self) -> usize {
        self.reports.len() + self.more
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, report) in self.reports.iter().take(Self::MAX_PRINTED).enumerate() {
            let end = if i == 0 { "" } else { "\n" };
            write!(f, "{end}{}", report.message_in(&self.name))?;
            for line in report.excerpt().iter().flatten() {
                write!(f, "\n{line}")?;
            }
        }
        match self.count().saturating_sub(Self::MAX_PRINTED) {
            0 => Ok(()),
            1 => write!(f, "\n... and 1 more fault"),
            more => write!(f, "\n... and {more} more faults"),
        }
    }
}

impl std::error::Error for SceneError {}

/// A position in the text that is moved from fault to fault, with its line and column.
// A thousand faults take one pass over the file; counting from the start for each fault would take a thousand passes.
struct LineCounter<'a> {
    text: &'a str,
    at: usize,
    line: usize,
    column: usize,
    line_start: usize,
}

impl<'a> LineCounter<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, at: 0, line: 1, column: 1, line_start: 0 }
    }

    fn advance_to(&mut self, offset: usize) {
        for c in self.text[self.at..offset].chars() {
            self.at += c.len_utf8();
            if c == '\n' {
                self.line += 1;
                self.column = 1;
                self.line_start = self.at;
            } else {
                self.column += 1;
            }
        }
    }

    fn report(&mut self, fault: &Fault) -> FaultReport {
        let start = character_start(self.text, fault.span.start as usize);
        let end = character_start(self.text, fault.span.end as usize).max(start);
        self.advance_to(start);
        let excerpt = Excerpt::new(&self.text[self.line_start..], start - self.line_start, end - self.line_start);
        FaultReport {
            line: self.line,
            column: self.column,
            message: visible(&fault.message),
            span: fault.span,
            source: excerpt.source,
            caret: excerpt.caret,
            caret_width: excerpt.caret_width,
        }
    }
}

/// Returns the index of the first byte of the character that contains the byte at `offset`.
fn character_start(text: &str, offset: usize) -> usize {
    // A fault may point after the last byte, or into a character that a lossy conversion replaced.
    let offset = offset.min(text.len());
    (0..=offset).rev().find(|&byte| text.is_char_boundary(byte)).unwrap_or(0)
}

/// Returns the line and column of the byte at `offset`, both counted from 1.
pub fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let mut counter = LineCounter::new(text);
    counter.advance_to(offset);
    (counter.line, counter.column)
}

/// The part of a line that is shown for a fault, with the position of its carets.
struct Excerpt {
    source: String,
    caret: usize,
    caret_width: usize,
}

impl Excerpt {
    /// The largest number of columns shown: with the line number they fit on a screen of 120
    /// columns.
    const MAX_EXCERPT_WIDTH: usize = 100;
    /// The last column at which a fault is shown together with the whole start of its line.
    // For a fault farther right, less than a quarter of the excerpt would be left for the text after the fault.
    const WHOLE_START: usize = 75;
    /// The number of columns shown before a fault beyond [`WHOLE_START`](Self::WHOLE_START): half
    /// of the excerpt.
    const CONTEXT_BEFORE: usize = 50;

    /// Returns the part to show of the first line of `text`, with a fault at bytes `start` to
    /// `end`.
    fn new(text: &str, start: usize, end: usize) -> Self {
        // Counts only as many characters as needed, because a generated file may be one line of megabytes.
        let is_long =
            text.chars().take(Self::MAX_EXCERPT_WIDTH + 1).take_while(|&c| c != '\n').count() > Self::MAX_EXCERPT_WIDTH;
        let is_far = is_long && columns_back(text, start, Self::WHOLE_START) > 0;
        let from = if is_far { columns_back(text, start, Self::CONTEXT_BEFORE) } else { 0 };
        let mut excerpt =
            Self { source: if from > 0 { "...".to_owned() } else { String::new() }, caret: 0, caret_width: 0 };
        excerpt.append_line(text, from, start, end);
        excerpt
    }

    /// Appends the text from byte `from` to the line's end or the width limit, and finds the
    /// columns of the carets.
    ///
    /// The fault is at bytes `start` to `end`.
    fn append_line(&mut self, text: &str, from: usize, start: usize, end: usize) {
        let (mut caret_end, mut budget) = (None, Self::MAX_EXCERPT_WIDTH);
        let mut caret = None;
        for (i, c) in text[from..].char_indices() {
            let (at, rest) = (from + i, &text[from + i..]);
            if at >= start && caret.is_none() {
                caret = Some(self.source.width());
            }
            if at >= end && caret_end.is_none() {
                caret_end = Some(self.source.width());
            }
            // A lone carriage return does not end a line; it is shown as a replacement character.
            if c == '\n' || rest.starts_with("\r\n") || rest == "\r" {
                break;
            }
            // The width is that of the shown replacement, because a control character itself has no width.
            let shown = visible_char(c);
            budget = budget.saturating_sub(shown.width().unwrap_or(1).max(1));
            if budget == 0 {
                caret_end.get_or_insert(self.source.width());
                self.source.push_str("...");
                break;
            }
            self.source.push(shown);
        }
        self.source.truncate(self.source.trim_end().len());
        let width = self.source.width();
        self.caret = caret.unwrap_or(width);
        // At least one caret, also for an empty span, as at the end of the file.
        self.caret_width = caret_end.unwrap_or(width).saturating_sub(self.caret).max(1);
    }
}

/// Returns the index of the character that is `columns` terminal columns before `offset`, or 0.
fn columns_back(text: &str, offset: usize, columns: usize) -> usize {
    let mut left = columns;
    for (i, c) in text[..offset].char_indices().rev() {
        let width = visible_char(c).width().unwrap_or(1).max(1);
        if width > left {
            return i + c.len_utf8();
        }
        left -= width;
    }
    0
}

/// Returns a part of the file's text for a message, truncated if it is long.
pub fn clipped(text: &str) -> String {
    // Long enough for any name in a real scene, and short enough for a message on one line.
    const MAX_QUOTED_CHARS: usize = 40;
    let mut shown: String = text.chars().take(MAX_QUOTED_CHARS).map(visible_char).collect();
    if text.chars().nth(MAX_QUOTED_CHARS).is_some() {
        shown.push_str("...");
    }
    shown
}

/// Returns a part of the file's text for a message, [`clipped`] and in quotes.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", clipped(text))
}
