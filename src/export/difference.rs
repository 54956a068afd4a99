//! How two files differ that are lines of text.

use crate::text::visible_lines;
use std::fmt::Write;
use std::iter::repeat_n;
use std::ops::Range;

/// How many unchanged lines are shown before and after a change.
const CONTEXT: usize = 1;

/// The most pairs of lines that are compared. Texts that differ in more, such as two files of 2,000 lines with nothing in
/// common at either end, are shown as one change.
const MOST_PAIRS: usize = 1 << 22;

/// A line of both files, of the golden one only, or of the other one only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Line<'a> {
    Kept(&'a str),
    Gone(&'a str),
    New(&'a str),
}

/// Returns what differs line by line, as `diff -u` writes it; nothing if the files are the same.
pub(super) fn by_lines(golden: &[u8], file: &[u8], name: &str) -> String {
    let [golden, file] = [golden, file].map(String::from_utf8_lossy);
    // A golden file may be anything.
    visible_lines(&unified(&golden, &file, name))
}

fn unified(golden: &str, file: &str, name: &str) -> String {
    let [golden, file] = [golden, file].map(|text| text.split_inclusive('\n').collect::<Vec<_>>());
    let lines = aligned(&golden, &file);
    let mut text = String::new();
    for hunk in hunks(&lines) {
        if text.is_empty() {
            let _ = writeln!(text, "--- {name}\n+++ this frame");
        }
        let _ = writeln!(text, "@@ -{} +{} @@", range(&lines, &hunk, is_old), range(&lines, &hunk, is_new));
        for line in &lines[hunk] {
            let (tag, line) = match line {
                Line::Kept(line) => (' ', line),
                Line::Gone(line) => ('-', line),
                Line::New(line) => ('+', line),
            };
            let end = if line.ends_with('\n') { "" } else { "\n\\ No newline at end of file\n" };
            let _ = write!(text, "{tag}{line}{end}");
        }
    }
    text
}

fn is_old(line: &Line<'_>) -> bool {
    !matches!(line, Line::New(_))
}

fn is_new(line: &Line<'_>) -> bool {
    !matches!(line, Line::Gone(_))
}

/// Returns the lines of both files in one order, with as few changes as there can be; what is gone comes before what is
/// new in its place.
fn aligned<'a>(golden: &[&'a str], file: &[&'a str]) -> Vec<Line<'a>> {
    let equal = |(a, b): &(&&str, &&str)| a == b;
    let start = golden.iter().zip(file).take_while(equal).count();
    let (golden, file, before) = (&golden[start..], &file[start..], &golden[..start]);
    let end = golden.iter().rev().zip(file.iter().rev()).take_while(equal).count();
    let (golden, after) = golden.split_at(golden.len() - end);
    let file = &file[..file.len() - end];

    let mut lines: Vec<_> = before.iter().map(|&line| Line::Kept(line)).collect();
    align_changed(golden, file, &mut lines);
    lines.extend(after.iter().map(|&line| Line::Kept(line)));
    lines
}

/// The same for the part between what both begin and end with.
fn align_changed<'a>(golden: &[&'a str], file: &[&'a str], lines: &mut Vec<Line<'a>>) {
    let common = (golden.len() * file.len() <= MOST_PAIRS).then(|| common_lengths(golden, file));
    let common = |i: usize, j: usize| common.as_ref().map_or(0, |lengths| lengths[i * (file.len() + 1) + j]);
    let (mut i, mut j) = (0, 0);
    while i < golden.len() && j < file.len() {
        if golden[i] == file[j] && common(i, j) > 0 {
            lines.push(Line::Kept(golden[i]));
            (i, j) = (i + 1, j + 1);
        } else if common(i + 1, j) >= common(i, j + 1) {
            lines.push(Line::Gone(golden[i]));
            i += 1;
        } else {
            lines.push(Line::New(file[j]));
            j += 1;
        }
    }
    lines.extend(golden[i..].iter().map(|&line| Line::Gone(line)));
    lines.extend(file[j..].iter().map(|&line| Line::New(line)));
}

/// Returns for each pair of places how many lines the rests of both files have in common at most, row by row.
fn common_lengths(golden: &[&str], file: &[&str]) -> Vec<u32> {
    let width = file.len() + 1;
    let mut lengths: Vec<u32> = repeat_n(0, (golden.len() + 1) * width).collect();
    for (i, golden) in golden.iter().enumerate().rev() {
        for (j, file) in file.iter().enumerate().rev() {
            lengths[i * width + j] = if golden == file {
                lengths[(i + 1) * width + j + 1] + 1
            } else {
                lengths[(i + 1) * width + j].max(lengths[i * width + j + 1])
            };
        }
    }
    lengths
}

/// Returns where lines have changed, with the lines around them.
fn hunks(lines: &[Line<'_>]) -> Vec<Range<usize>> {
    let mut hunks: Vec<Range<usize>> = Vec::new();
    for (at, _) in lines.iter().enumerate().filter(|(_, line)| !matches!(line, Line::Kept(_))) {
        let around = at.saturating_sub(CONTEXT)..(at + 1 + CONTEXT).min(lines.len());
        match hunks.last_mut().filter(|last| around.start <= last.end) {
            Some(last) => last.end = around.end,
            None => hunks.push(around),
        }
    }
    hunks
}

/// Returns the hunk's first line, counted from 1, and how many there are, in the file whose lines these are. An empty range
/// begins at the line before it.
fn range(lines: &[Line<'_>], hunk: &Range<usize>, is_in_file: fn(&Line<'_>) -> bool) -> String {
    let count = |lines: &[Line<'_>]| lines.iter().filter(|line| is_in_file(line)).count();
    let before = count(&lines[..hunk.start]);
    match count(&lines[hunk.clone()]) {
        0 => format!("{before},0"),
        1 => (before + 1).to_string(),
        length => format!("{},{length}", before + 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use similar::TextDiff;

    fn by_similar(golden: &str, file: &str) -> String {
        let difference = TextDiff::from_lines(golden, file);
        difference.unified_diff().context_radius(CONTEXT).header("golden", "this frame").to_string()
    }

    fn changes(difference: &str) -> usize {
        difference.lines().skip(2).filter(|line| line.starts_with(['+', '-'])).count()
    }

    /// Every line of one letter, so that most are there several times.
    fn text() -> impl Strategy<Value = String> {
        (prop::collection::vec("[a-c]", 0..12), any::<bool>()).prop_map(|(lines, ends)| {
            let text = lines.join("\n");
            if ends { text + "\n" } else { text }
        })
    }

    fn numbered(word: &str, numbers: Range<usize>) -> String {
        let mut text = String::new();
        for number in numbers {
            let _ = writeln!(text, "{word}{number}");
        }
        text
    }

    #[test]
    fn it_is_written_as_others_write_it() {
        let rows = numbered("row ", 0..20);
        for file in [
            rows.clone(),
            rows.replace("row 7\n", "row seven\n"),
            rows.replace("row 7\n", "").replace("row 9\n", "9\n9\n"),
            rows.replace("row 7\n", "7\n").replace("row 11\n", ""),
            rows.replace("row 0\n", "").replace("row 19\n", "row 19"),
            rows.replace("row", "line"),
            String::new(),
        ] {
            for (golden, file) in [(&rows, &file), (&file, &rows)] {
                assert_eq!(unified(golden, file, "golden"), by_similar(golden, file));
            }
        }
    }

    #[test]
    fn more_lines_than_can_be_compared_are_one_change() {
        let difference = unified(&numbered("", 0..3000), &numbered("", 1500..4500), "golden");
        assert_eq!((changes(&difference), difference.matches("@@ ").count()), (6000, 1));
    }

    proptest! {
        #[test]
        fn no_shorter_way_is_found(golden in text(), file in text()) {
            let [ours, theirs] = [unified(&golden, &file, "golden"), by_similar(&golden, &file)];
            prop_assert!(changes(&ours) <= changes(&theirs), "{ours}\n{theirs}");
            let lines = aligned(&golden.split_inclusive('\n').collect::<Vec<_>>(), &file.split_inclusive('\n').collect::<Vec<_>>());
            let of = |is_in_file: fn(&Line<'_>) -> bool| -> String {
                let text = |line: &Line<'_>| match *line { Line::Kept(text) | Line::Gone(text) | Line::New(text) => text.to_owned() };
                lines.iter().filter(|line| is_in_file(line)).map(text).collect()
            };
            prop_assert_eq!((of(is_old), of(is_new)), (golden, file));
        }
    }
}
