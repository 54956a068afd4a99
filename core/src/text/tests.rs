use super::*;

#[test]
fn control_characters_are_replaced() {
    let controls = (0..0x20).chain(0x7f..0xa0).chain(0x202a..=0x202e).chain(0x2066..=0x2069);
    for c in controls.chain([0x200e, 0x200f, 0x61c]).filter_map(char::from_u32).filter(|&c| c != '\t') {
        assert_eq!(visible(&format!("a{c}b")), "a\u{fffd}b", "{c:?}");
        let lines = if c == '\n' { "a\nb" } else { "a\u{fffd}b" };
        assert_eq!(visible_lines(&format!("a{c}b")), lines, "{c:?}");
    }
    assert_eq!(visible("tab\tété 地 👪"), "tab été 地 👪");
}
