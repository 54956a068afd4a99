use super::LogLine;

#[test]
fn values_add_neither_keys_nor_lines() {
    let line = LogLine::event("refused").with("from", "192.0.2.0/24").with("reason", "rate");
    assert_eq!(line.text(), "event=refused from=192.0.2.0/24 reason=rate");
    let line = LogLine::event("x").with("error", "a \"b\"\nevent=y \x1b[2J\u{202e}").with("empty", "");
    assert_eq!(line.text(), r#"event=x error="a \"b\"\nevent=y \u{1b}[2J\u{202e}" empty="""#);
}
