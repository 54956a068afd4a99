use super::*;

#[test]
fn a_tag_is_recognised_in_its_query_and_its_reply() {
    let mut tag = Tag::FIRST;
    for _ in 0..799 {
        tag = tag.next();
        assert_ne!(tag, Tag::FIRST);
        let query = [b"frame", &tag.query()[..]].concat();
        assert_eq!(Tag::at_end_of(&query), Some(tag));
        let text = std::str::from_utf8(&query).expect("a query is ASCII");
        let number = text.strip_prefix("frame\x1b[?").and_then(|rest| rest.strip_suffix("$p"));
        assert_eq!(number.and_then(|number| Tag::of_mode(number.parse().ok()?)), Some(tag));
    }
    assert_eq!(tag.next(), Tag::FIRST.next(), "the numbers begin again");
}

#[test]
fn other_queries_are_not_tags() {
    for bytes in [&b"\x1b[?2026$p"[..], b"\x1b[?1006$p", b"\x1b[?25$p", b"\x1b[c", b"300$p", b"$p", b"", b"\x1b[?3a0$p"]
    {
        assert_eq!(Tag::at_end_of(bytes), None, "{}", bytes.escape_ascii());
    }
    for mode in [1, 25, 199, 1000, 2026] {
        assert_eq!(Tag::of_mode(mode), None);
    }
}
