//! The frames in `docs/glyphs.md` are those that their commands print.
//!
//! `BLESS=1 cargo test --test cli glyphs` writes them anew.

use super::Folder;
use std::fmt::Write;
use std::fs;
use std::path::Path;

#[test]
fn the_page_of_glyphs_shows_what_is_printed() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/glyphs.md");
    let text = fs::read_to_string(&page).expect("the page is there");
    let (folder, mut written, mut frames) = (Folder::new(), String::new(), 0);
    let mut lines = text.lines();
    let mut command = None;
    while let Some(line) = lines.next() {
        let _ = writeln!(written, "{line}");
        if let Some(arguments) = line.strip_prefix("termtrace ") {
            command = Some(arguments);
        } else if line == "```text" {
            let frame = folder.run(command.take().expect("a command stands above the frame")).text();
            let _ = writeln!(written, "{frame}```");
            frames += 1;
            lines.by_ref().find(|&line| line == "```").expect("the frame ends");
        }
    }
    assert!(frames >= 4);
    if std::env::var_os("BLESS").is_some() {
        fs::write(&page, &written).expect("the page can be written");
    }
    assert!(
        text == written || std::env::var_os("BLESS").is_some(),
        "docs/glyphs.md is not up to date: BLESS=1 writes it"
    );
}
