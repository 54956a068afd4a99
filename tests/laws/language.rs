//! The language of comments: plain technical English, with a first line that says what an item is.

use crate::comments::{Comment, of_rust};
use crate::{root, rust_files};
use std::fs;
use std::path::Path;

/// The most columns of the first line of a doc comment. Lists of items show this line alone.
const SUMMARY_WIDTH: usize = 100;

/// The most columns of a line of source or prose.
const LINE_WIDTH: usize = 120;

/// Words that open a doc comment without a subject that says what the item is.
const OPENINGS: [&str; 5] = ["Who", "Whoever", "What", "Whatever", "The same of"];

/// Words that stand for a number, a size or a part of the program without naming it.
const VAGUE: [&str; 10] =
    ["so many", "so much", "so long", "nobody", "somebody", "anybody", "whoever", "he", "him", "his"];

/// Returns what is wrong with the comments of a Rust file, each fault with its line.
fn faults_of_comments(source: &str) -> Vec<String> {
    let lines: Vec<_> = source.lines().collect();
    let mut faults = Vec::new();
    for Comment { line, text, opens_doc } in of_rust(source) {
        let words = lower_words(text);
        if opens_doc {
            let opening = OPENINGS.iter().find(|opening| words.starts_with(&lower_words(opening)));
            faults.extend(opening.map(|opening| format!("{line}: a doc comment opens with `{opening}`")));
            let width = lines[line - 1].chars().count();
            if width > SUMMARY_WIDTH {
                faults.push(format!("{line}: the first line of a doc comment has {width} columns"));
            }
        }
        let vague = VAGUE.iter().filter(|vague| words.contains(&lower_words(vague)));
        faults.extend(vague.map(|vague| format!("{line}: a comment says `{vague}`")));
    }
    faults
}

/// Returns the words of a comment in lower case, with a space before and after each.
///
/// A code span is one word.
fn lower_words(text: &str) -> String {
    let prose: Vec<_> = text.split('`').step_by(2).collect();
    let prose = prose.join(" code ").to_lowercase();
    let words = prose.split(|c: char| !c.is_alphanumeric() && c != '\'').filter(|word| !word.is_empty());
    words.fold(" ".to_owned(), |words, word| words + word + " ")
}

/// Returns the lines that are too wide, but for the tables and code of Markdown.
fn wide_lines(path: &Path, text: &str) -> Vec<String> {
    let is_markdown = path.extension().is_some_and(|ending| ending == "md");
    let mut in_code = false;
    let lines = text.lines().enumerate().filter(|(_, line)| {
        let is_fence = is_markdown && line.trim_start().starts_with("```");
        in_code ^= is_fence;
        let is_exempt = is_markdown && (in_code || is_fence || line.starts_with('|'));
        !is_exempt && line.chars().count() > LINE_WIDTH
    });
    lines.map(|(index, line)| format!("{}: the line has {} columns", index + 1, line.chars().count())).collect()
}

/// Returns the files of text below a folder: Rust and Markdown.
fn text_files(folder: &str) -> Vec<(String, String)> {
    let mut files = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("the folder is there") {
            let path = entry.expect("the entry can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs" || ending == "md") {
                files.push((relative(&path), fs::read_to_string(&path).expect("text is UTF-8")));
            }
        }
    }
    files
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root()).expect("below the root").to_str().expect("names are UTF-8").to_owned()
}

/// Returns all that breaks the laws of this file, as path, line and fault.
fn faults() -> Vec<String> {
    let mut faults = Vec::new();
    let mut rust: Vec<_> = ["core", "src", "tests", "benches", "examples", "fuzz"]
        .iter()
        .flat_map(|folder| rust_files(&root().join(folder)).into_iter().map(|(path, text)| (relative(&path), text)))
        .collect();
    rust.push(("build.rs".to_owned(), fs::read_to_string(root().join("build.rs")).expect("build.rs is there")));
    assert!(rust.len() > 300, "{} Rust files were read", rust.len());
    for (path, text) in &rust {
        faults.extend(faults_of_comments(text).iter().map(|fault| format!("{path}:{fault}")));
    }
    let front = ["README.md", "CONTRIBUTING.md"]
        .map(|name| (name.to_owned(), fs::read_to_string(root().join(name)).expect("the page is there")));
    let wide = ["core/src", "src", "docs"].into_iter().flat_map(text_files).chain(front);
    for (path, text) in wide {
        faults.extend(wide_lines(Path::new(&path), &text).iter().map(|fault| format!("{path}:{fault}")));
    }
    faults.sort();
    faults
}

#[test]
fn comments_are_written_in_the_fields_language() {
    let faults = faults();
    assert!(faults.is_empty(), "{faults:#?}");
}

/// The test above can fail.
#[test]
fn the_old_language_is_found() {
    let found = |source: &str| faults_of_comments(source).len();
    assert_eq!(found("/// What is drawn.\n/// Who draws.\nfn f() {}"), 1, "the first line only");
    assert_eq!(
        found("//! Whatever is drawn.\n/// Who draws it.\nmod a {\n    /// The same of all.\n    fn f() {}\n}"),
        3
    );
    assert_eq!(found("/// Whole numbers.\n// What is drawn depends on the cells.\n/// Whose\nfn f() {}"), 0);
    assert_eq!(found("    // Nobody reads so many\n    f(); // as he does"), 3);
    assert_eq!(found("/// Returns `nobody`.\n/// The history of the whole.\nlet a = \"so much // his\";"), 0);
    let summary = format!("/// {}", "a".repeat(SUMMARY_WIDTH - 4));
    assert_eq!([found(&summary), found(&format!("{summary}a")), found(&format!("/// A\n{summary}a"))], [0, 1, 0]);
    let wide = "a".repeat(LINE_WIDTH + 1);
    let found = |path: &str, text: &str| wide_lines(Path::new(path), text).len();
    assert_eq!(found("a.rs", &format!("{wide}\n{}\n| {wide}", &wide[1..])), 2);
    assert_eq!(found("a.md", &format!("| {wide}\n```text\n{wide}\n```\n{wide}\n")), 1);
}
