use super::*;

/// Returns the text without its colour sequences.
fn plain(text: &str) -> String {
    [RED, YELLOW, GREEN, CYAN, PLAIN].iter().fold(text.to_owned(), |text, color| text.replace(color, ""))
}

#[test]
fn errors_are_colored_by_their_parts() {
    let text = "error: a.ron:1:2: unknown field; did you mean \"b\"?\n  a\n  ^\n\n  tip: c\n\nUsage: termtrace\n";
    let colored = colored_error(text);
    assert_eq!(plain(&colored), text);
    for part in [
        format!("{RED}error:"),
        format!("{RED}^"),
        format!("{CYAN}tip:"),
        format!("{CYAN}\"b\"?"),
        format!("{GREEN}Usage:"),
    ] {
        assert!(colored.contains(&part), "{part:?}: {colored:?}");
    }
    assert_eq!(colored_error("warning: a: no b\n"), format!("{YELLOW}warning:{PLAIN} a: no b\n"));
    assert!(!colored_error("error: x: Usage: y\n").contains(GREEN), "only a line's own heading is colored");
}

#[test]
fn help_is_colored_by_its_headings_and_literals() {
    let text = "About: it\n\nUsage: termtrace\n\nCommands:\n  frame, record  write\n\n".to_owned()
        + "Options:\n  -h, --help  Print\n      more\n";
    let colored = colored_help(&text);
    assert_eq!(plain(&colored), text);
    for part in ["Usage:", "Commands:", "Options:"].map(|part| format!("{GREEN}{part}{PLAIN}")) {
        assert!(colored.contains(&part), "{part:?}: {colored:?}");
    }
    for part in ["frame, record", "-h, --help"].map(|part| format!("{CYAN}{part}{PLAIN}")) {
        assert!(colored.contains(&part), "{part:?}: {colored:?}");
    }
    assert!(!colored.contains(&format!("{GREEN}About")) && !colored.contains(&format!("{CYAN}more")), "{colored:?}");
}
