use super::*;
use crate::scene_text::{Faults, SceneError, Span};

const TEXT: &str = "(\n  radus: 1)";

fn panel() -> ErrorPanel {
    let faults = ["unknown field \"radus\"; did you mean \"radius\"?", "another"].map(str::to_owned);
    let mut found = Faults::default();
    for (message, span) in faults.into_iter().zip([Span { start: 4, end: 9 }, Span { start: 11, end: 12 }]) {
        found.add(span, || message);
    }
    ErrorPanel(SceneError::new("my.ron", TEXT, found).notice())
}

#[test]
fn a_fault_fits_any_width() {
    let panel = panel();
    let wide = [
        "my.ron:2:3: unknown field \"radus\"; did you mean \"radius\"?",
        "  2 |   radus: 1)",
        "    |   ^^^^^",
        "more errors: termtrace check lists them all",
    ];
    assert_eq!(panel.lines(78), wide);
    for width in 1..100 {
        let lines = panel.lines(width);
        assert!(lines.iter().all(|line| line.trim_end().width() <= width), "{width}: {lines:?}");
        let caret = lines.iter().position(|line| line.contains('^')).expect("a caret");
        let column = lines[caret].find('^').expect("a caret");
        assert_eq!(lines[caret - 1].chars().nth(column), Some('r'), "{width}: {lines:?}");
    }
    assert_eq!(wrapped("a bird in the hand", 9), ["a bird in ", "the hand"].map(str::to_owned));
    assert_eq!(wrapped("abcdefgh ij", 3), ["abc", "def", "gh ", "ij"].map(str::to_owned));
}

#[test]
fn errors_of_one_line_have_no_excerpt() {
    let lines = |message: &str| ErrorPanel(message.to_owned().into()).lines(40);
    assert_eq!(lines("x.ron: there is no such file"), ["x.ron: there is no such file"]);
    assert_eq!(lines(""), [""]);
}
