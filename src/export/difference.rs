//! Comparison of two frames as text, row by row.

use super::format_row::GoldenDifference;
use super::sgr::{self, TextStyle};
use crate::text::visible_char;
use std::fmt;
use unicode_width::UnicodeWidthChar;

/// Largest number of differing rows in a report: more than most screens have.
const MAX_SHOWN_ROWS: usize = 60;

/// Compares two frames as text, row by row; returns `None` if they are equal.
///
/// The text is plain, or has colours as [`ansi`](super::ansi()) writes them.
///
/// ```
/// use termtrace::compare;
///
/// let difference = compare("  -+-  \n  +*+  \n", "  -+-  \n  +#+  \n").ok_or("they differ")?;
/// assert_eq!(difference.to_string(), "\
/// 1 of 2 rows differs: line 2, column 4
///   1 |  -+-  |
/// - 2 |  +*+  |
/// + 2 |  +#+  |
///         ^
/// ");
/// assert_eq!(compare("equal\n", "equal\n"), None);
/// # Ok::<(), &str>(())
/// ```
// Rows are compared by position, not aligned as in a line diff: the rows of two screens correspond, so each differing
// cell can be marked, even if only colours differ.
pub fn compare(expected: &str, found: &str) -> Option<Difference> {
    if expected == found {
        return None;
    }
    let [expected_rows, found_rows] = [expected, found].map(rows);
    let same = expected_rows.iter().zip(&found_rows).take_while(|(a, b)| a == b).count();
    // Equal rows at the end must not overlap equal rows at the start, which they would if all rows are equal and one
    // text is shorter.
    let left = expected_rows.len().min(found_rows.len()) - same;
    // Texts with equally many rows are compared row by row. Otherwise everything between the equal rows at the start
    // and the end is reported as one block.
    let mut same_after = 0;
    if expected_rows.len() != found_rows.len() {
        let from_end = expected_rows.iter().rev().zip(found_rows.iter().rev());
        same_after = from_end.take(left).take_while(|(a, b)| a == b).count();
    }
    Some(Difference {
        ends: [expected, found].map(|text| text.ends_with('\n')),
        expected: expected_rows,
        found: found_rows,
        same,
        same_after,
    })
}

/// The difference of two frames.
///
/// Its [`Display`](fmt::Display) form is a short report: the number of differing rows and the first difference, the
/// rows that were expected (`-`) and found (`+`) between bars that show their ends, a mark below each differing cell,
/// and a row of context on either side. Lines and columns are counted from 1, as in editors. The text contains no
/// escape sequences; the alternate form (`{:#}`) colours the rows red and green for a terminal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    expected: Vec<Row>,
    found: Vec<Row>,
    /// The number of rows at the top that are equal in both texts.
    same: usize,
    /// The number of equal rows at the bottom; 0 if both texts have equally many rows.
    same_after: usize,
    /// Whether each text ends with a line feed.
    ends: [bool; 2],
}

/// The characters of a row and their styles.
type Row = Vec<(char, TextStyle)>;

fn rows(text: &str) -> Vec<Row> {
    // Only one line feed is removed, because an empty last row counts as a row.
    let text = text.strip_suffix('\n').unwrap_or(text);
    text.split('\n').map(sgr::parse_row).collect()
}

/// Returns the width of a character, as a message shows it, in columns.
fn char_width(character: char) -> usize {
    visible_char(character).width().unwrap_or(1)
}

fn row_width(row: &[(char, TextStyle)]) -> usize {
    row.iter().map(|&(character, _)| char_width(character)).sum()
}

/// Returns a line with a mark below each differing cell, and below the end of the shorter row.
fn marks(a: &Row, b: &Row) -> String {
    let mut marks = String::new();
    for (a, b) in a.iter().zip(b) {
        let mark = if a == b { ' ' } else { '^' };
        marks.extend(std::iter::repeat_n(mark, char_width(a.0).max(char_width(b.0))));
    }
    if a.len() != b.len() {
        marks.push('^');
    }
    marks.trim_end().to_owned()
}

impl Difference {
    /// Returns the index of the first differing row, from 0.
    ///
    /// If one text has more rows, the row may exist in the longer text only.
    #[doc(hidden)]
    pub fn row(&self) -> usize {
        self.same
    }

    /// Returns the column of the first differing cell in the first differing row, from 0.
    #[doc(hidden)]
    pub fn column(&self) -> usize {
        let (Some(a), Some(b)) = (self.expected.get(self.same), self.found.get(self.same)) else { return 0 };
        let same = a.iter().zip(b).take_while(|(a, b)| a == b).count();
        row_width(&a[..same])
    }

    /// Returns for each text the index of its first row that belongs to the equal rows at the
    /// bottom.
    fn equal_end_starts(&self) -> [usize; 2] {
        [&self.expected, &self.found].map(|rows| rows.len() - self.same_after)
    }

    /// Returns the indices of the differing rows; both texts must have equally many rows.
    fn differing_rows(&self) -> impl Iterator<Item = usize> {
        let pairs = self.expected.iter().zip(&self.found).enumerate();
        pairs.filter(|(_, (a, b))| a != b).map(|(row, _)| row)
    }

    /// Writes the sizes, if they differ, the number of differing rows, and the first difference.
    fn write_summary(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = |rows: &[Row]| (rows.iter().map(|row| row_width(row)).max().unwrap_or(0), rows.len());
        let (expected, found) = (size(&self.expected), size(&self.found));
        // The report starts with the sizes if they differ, because that usually causes all other differences.
        if expected != found {
            writeln!(f, "{}x{} characters were expected, {}x{} found", expected.0, expected.1, found.0, found.1)?;
        }
        let (line, column) = (self.row() + 1, self.column() + 1);
        if expected.1 != found.1 {
            return writeln!(f, "the first difference: line {line}, column {column}");
        }
        match self.differing_rows().count() {
            0 if self.ends[0] != self.ends[1] => {
                let which = if self.ends[0] { "expected" } else { "found" };
                writeln!(f, "only the text that was {which} ends with a line feed")
            }
            0 => writeln!(f, "only escape sequences that change nothing differ"),
            1 => writeln!(f, "1 of {} rows differs: line {line}, column {column}", expected.1),
            count => writeln!(f, "{count} of {} rows differ, first line {line}, column {column}", expected.1),
        }
    }

    /// Writes each pair of differing rows, and a row of context before and after it.
    fn write_pairs(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let differing: Vec<usize> = self.differing_rows().take(MAX_SHOWN_ROWS).collect();
        // One row of context on either side shows where in the picture a difference is.
        let is_near = |row: usize| differing.iter().any(|&other| row.abs_diff(other) <= 1);
        let mut last = None;
        for (row, (a, b)) in self.expected.iter().zip(&self.found).enumerate().filter(|&(row, _)| is_near(row)) {
            if last.is_some_and(|last| last + 1 != row) {
                writeln!(f, "  ...")?;
            }
            last = Some(row);
            if a == b {
                self.write_row(f, ' ', row, a)?;
            } else if !differing.contains(&row) {
                break;
            } else {
                self.write_row(f, '-', row, a)?;
                self.write_row(f, '+', row, b)?;
                self.write_marks(f, a, b)?;
            }
        }
        match self.differing_rows().count() - differing.len() {
            0 => Ok(()),
            more => writeln!(f, "  ... and {more} more"),
        }
    }

    /// Writes the block of expected rows, and the block of found rows that replaces it, for texts
    /// with different numbers of rows.
    fn write_block(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [expected_end, found_end] = self.equal_end_starts();
        if let Some(before) = self.same.checked_sub(1) {
            self.write_row(f, ' ', before, &self.expected[before])?;
        }
        for (sign, rows, end) in [('-', &self.expected, expected_end), ('+', &self.found, found_end)] {
            for (row, text) in rows.iter().enumerate().take(end).skip(self.same).take(MAX_SHOWN_ROWS) {
                self.write_row(f, sign, row, text)?;
            }
            if end - self.same > MAX_SHOWN_ROWS {
                writeln!(f, "{sign} ... and {} more", end - self.same - MAX_SHOWN_ROWS)?;
            }
        }
        if let Some(after) = self.found.get(found_end) {
            self.write_row(f, ' ', found_end, after)?;
        }
        Ok(())
    }

    /// Returns the number of digits of the largest line number.
    fn line_number_digits(&self) -> usize {
        self.expected.len().max(self.found.len()).to_string().len()
    }

    fn write_row(&self, f: &mut fmt::Formatter<'_>, sign: char, row: usize, text: &Row) -> fmt::Result {
        let text: String = text.iter().map(|&(character, _)| visible_char(character)).collect();
        let (on, off) = match sign {
            // Sequences are put only around the whole line, so that none interrupts the row's text.
            '-' if f.alternate() => ("\x1b[31m", "\x1b[m"),
            '+' if f.alternate() => ("\x1b[32m", "\x1b[m"),
            _ => ("", ""),
        };
        writeln!(f, "{on}{sign} {:digits$} |{text}|{off}", row + 1, digits = self.line_number_digits())
    }

    /// Writes the marks below a pair of differing rows; if only styles differ, also the first
    /// differing style.
    fn write_marks(&self, f: &mut fmt::Formatter<'_>, a: &Row, b: &Row) -> fmt::Result {
        write!(f, "  {:digits$}  {}", "", marks(a, b), digits = self.line_number_digits())?;
        let glyphs = |row: &Row| row.iter().map(|&(character, _)| character).collect::<Vec<_>>();
        // If all glyphs are equal, no difference is visible, so the first differing styles are described.
        if glyphs(a) == glyphs(b)
            && let Some(((_, was), (_, is))) = a.iter().zip(b).find(|(a, b)| a != b)
        {
            write!(f, " {was} became {is}")?;
        }
        writeln!(f)
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write_summary(f)?;
        if self.expected.len() == self.found.len() { self.write_pairs(f) } else { self.write_block(f) }
    }
}

/// Returns a readable report, row by row, of how a text file differs from the golden file.
pub(super) fn by_rows(golden: &[u8], file: &[u8]) -> GoldenDifference {
    let [expected, found] = [golden, file].map(String::from_utf8_lossy);
    // The texts may be equal although the bytes differ, because a golden file may contain invalid UTF-8.
    let difference = compare(&expected, &found).map(|difference| difference.to_string());
    difference.unwrap_or_else(|| "only bytes that are not text differ\n".to_owned()).into()
}

#[cfg(all(test, unit_tests))]
mod tests;
