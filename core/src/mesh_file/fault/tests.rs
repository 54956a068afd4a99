use super::*;

#[test]
fn lines_end_in_three_ways_and_columns_are_characters() {
    assert_eq!(line_and_column(b"", 0), (1, 1));
    assert_eq!(line_and_column(b"ab", 9), (1, 3));
    assert_eq!(line_and_column(b"a\nb\r\nc\rd", 7), (4, 1));
    assert_eq!(line_and_column(b"a\r\nb", 2), (1, 3));
    assert_eq!(line_and_column("\u{feff}\u{e9}x".as_bytes(), 5), (1, 2));
}
