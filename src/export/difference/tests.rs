use super::*;

#[track_caller]
fn shown(expected: &str, found: &str) -> String {
    compare(expected, found).expect("they differ").to_string()
}

#[test]
fn rows_far_apart_each_have_their_neighbours() {
    let text = |a, b| format!("1\n{a}\n3\n4\n5\n{b}\n");
    let expected = concat!(
        "2 of 6 rows differ, first line 2, column 1\n",
        "  1 |1|\n- 2 |2|\n+ 2 |x|\n     ^\n  3 |3|\n  ...\n",
        "  5 |5|\n- 6 |6|\n+ 6 |66|\n      ^\n",
    );
    let with_size = format!("1x6 characters were expected, 2x6 found\n{expected}");
    assert_eq!(shown(&text("2", "6"), &text("x", "66")), with_size);
}

/// Checks that rows before and after an insertion are not reported as changed.
#[test]
fn inserted_rows_are_found() {
    let expected = concat!(
        "1x3 characters were expected, 1x4 found\nthe first difference: line 3, column 1\n",
        "  2 |b|\n+ 3 |x|\n  4 |c|\n",
    );
    assert_eq!(shown("a\nb\nc\n", "a\nb\nx\nc\n"), expected);
    assert!(shown("a\na\n", "a\n").contains("\n- 2 |a|\n"));
}

#[test]
fn blanks_and_line_feeds_at_the_end_count() {
    assert!(shown("a  \n", "a\n").contains("\n- 1 |a  |\n+ 1 |a|\n      ^\n"));
    assert_eq!(shown("a\n", "a"), "only the text that was expected ends with a line feed\n");
    assert_eq!(shown("a", "a\n"), "only the text that was found ends with a line feed\n");
}

/// Checks that marks are below their cells, even after wide characters.
#[test]
fn wide_characters_take_two_columns() {
    let difference = compare("世界x\n", "世界y\n").expect("they differ");
    assert_eq!(difference.column(), 4);
    assert!(difference.to_string().ends_with("|\n         ^\n"), "{difference}");
}

#[test]
fn colours_are_compared_and_named() {
    let line = |channels: &str| format!("\x1b[38;2;1;2;3mab\x1b[38;2;{channels}mc\x1b[39;1md\x1b[0m\n");
    let difference = compare(&line("4;5;6"), &line("4;5;7")).expect("they differ");
    assert_eq!((difference.row(), difference.column()), (0, 2));
    let text = difference.to_string();
    assert!(text.contains("- 1 |abcd|\n+ 1 |abcd|\n       ^ 38;2;4;5;6 became 38;2;4;5;7\n"), "{text}");
    assert!(!text.contains('\x1b'));
    assert!(format!("{difference:#}").contains("\x1b[32m+ 1 |abcd|\x1b[m\n"));
}

/// Checks that escape sequences of a golden file are not written to the terminal.
#[test]
fn no_escape_sequence_is_passed_on() {
    for strange in ["\x1b[2J", "\x07\r", "\x1b", "\x1b[", "\x1b[38;5m\x1b[1;;m\x1b[99999999999m"] {
        let text = shown(&format!("{strange}a\n"), "b\n");
        assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
    }
    assert_eq!(shown("\x1b[ma\n", "a\n"), "only escape sequences that change nothing differ\n");
}
