//! Frames for the web: SVG and HTML, byte for byte as last checked in a browser.
//!
//! `BLESS=1 cargo test --test cli web` writes them anew; look at them before they are committed.

use super::Folder;
use std::fs;
use std::path::Path;

/// The frames. Cells that are not square show that a cell's aspect is used.
const FRAMES: [(&str, &str); 8] = [
    ("half.svg", "--size 24x8"),
    ("half.html", "--size 24x8"),
    ("shape.svg", "--size 24x8 --glyphs shape --cell-aspect 1.9"),
    ("blocks.svg", "--size 24x8 --glyphs blocks"),
    ("octants.html", "--size 24x8 --glyphs octants"),
    ("shape.html", "--size 24x8 --glyphs shape --cell-aspect 1.9"),
    ("plain.svg", "--size 24x8 --color never"),
    ("few.html", "--size 24x8 --color 16"),
];

#[test]
fn frames_for_the_web_are_golden() {
    let folder = Folder::new();
    let goldens = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/web");
    for (name, flags) in FRAMES {
        folder.frame(&format!("ball.ron {flags} -o {name}"));
        let frame = folder.read(name);
        if std::env::var_os("BLESS").is_some() {
            fs::write(goldens.join(name), &frame).expect("the golden file can be written");
        }
        assert!(fs::read(goldens.join(name)).is_ok_and(|golden| golden == frame), "{name}");
        assert!(folder.frame(&format!("ball.ron {flags} -o {name} --threads 3")).is_empty());
        assert!(folder.read(name) == frame, "{name} on three threads");
    }
}

/// A frame runs no script and loads nothing, and escapes the characters of HTML's tags.
#[test]
fn frames_for_the_web_load_nothing() {
    let folder = Folder::new();
    for format in ["svg", "html"] {
        for flags in ["", "--glyphs shape", "--glyphs shape --color never", "--glyphs ramp --color 256"] {
            let text = folder.run(&format!("frame ball.ron --format {format} {flags}")).text();
            let start = if format == "svg" { "<svg xmlns=\"http://www.w3.org/2000/svg\"" } else { "<!DOCTYPE html>" };
            assert!(text.starts_with(start) && text.ends_with(">\n"), "{flags}");
            let rest = &text[start.len()..];
            for word in ["<script", "http", "url(", "href", "src=", "@import", "&#"] {
                assert!(!rest.contains(word), "{word} in {flags} {format}");
            }
            assert_eq!(text.matches('<').count(), text.matches('>').count(), "{flags} {format}");
            assert!(text.len() < 400_000, "{} bytes", text.len());
        }
    }
    let shapes = folder.run("frame ball.ron --format text --glyphs shape").text();
    let page = folder.run("frame ball.ron --format html --glyphs shape --color never").text();
    let shown = page.split("<pre>").nth(1).and_then(|rest| rest.split("</pre>").next()).expect("text");
    let shown = shown.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    let trimmed: Vec<_> = shapes.lines().map(str::trim_end).collect();
    assert_eq!(shown.lines().collect::<Vec<_>>(), trimmed);
}

#[test]
fn a_page_is_named_after_its_scene_and_in_the_middle() {
    let folder = Folder::new();
    folder.write("a<b.ron", super::BALL);
    let page = folder.run("frame a<b.ron --format html --size 8x4").text();
    assert!(page.contains("<title>a&lt;b</title>") && page.contains("place-content:safe center"), "{page}");
}

/// The drawing has the width and height of its cells.
#[test]
fn frames_for_the_web_have_the_right_shape() {
    let folder = Folder::new();
    for (flags, size) in [
        ("--size 40x10", "width=\"400\" height=\"200\""),
        ("--size 40x10 --cell-aspect 1.9", "width=\"400\" height=\"190\""),
        ("--pixels 40x10", "width=\"400\" height=\"100\""),
    ] {
        let svg = folder.run(&format!("frame ball.ron --format svg {flags}")).text();
        assert!(svg.contains(size), "{}", &svg[..200]);
    }
    let html = folder.run("frame ball.ron --format html --size 40x10 --cell-aspect 1.9").text();
    assert!(html.contains("width:40ch") && html.contains("height:calc(10ch*1.9)"), "{}", &html[..600]);
}
