use super::*;

fn hints(term: &str) -> Hints {
    Hints::gather(&|name| (name == "TERM").then(|| term.to_owned()), &|_| None)
}

fn replies(name: Option<&str>, attributes: Option<&[u16]>, synchronized_output: Option<bool>) -> Replies {
    let mut replies = Replies { synchronized_output, ..Replies::default() };
    if let Some(name) = name {
        replies.take_dcs(format!(">|{name}").as_bytes());
    }
    if let Some(attributes) = attributes {
        replies.take_secondary_attributes(attributes);
    }
    replies
}

#[test]
fn only_known_terminals_with_synchronized_output_shift_cells() {
    for (term, name, attributes, synchronized, expected) in [
        ("xterm-kitty", Some("kitty(0.26.5)"), None, Some(true), Shifts::Direct),
        ("xterm-256color", Some("XTerm(400)"), Some(&[41, 400, 0][..]), Some(true), Shifts::Direct),
        ("alacritty", None, Some(&[0, 1100, 1][..]), Some(true), Shifts::Direct),
        ("alacritty", None, Some(&[0, 1100, 1][..]), Some(false), Shifts::Off),
        ("xterm-kitty", Some("kitty(0.26.5)"), None, None, Shifts::Off),
        // zellij keeps the outer terminal's `TERM`.
        ("xterm-kitty", Some("Zellij(0.41.2)"), Some(&[0, 1100, 1][..]), Some(true), Shifts::Off),
        ("xterm-256color", None, None, Some(true), Shifts::Off),
        ("tmux-256color", None, None, Some(true), Shifts::ThroughTmux),
        ("tmux-256color", None, None, Some(false), Shifts::Off),
        ("screen-256color", None, None, Some(true), Shifts::Off),
        ("linux", None, None, None, Shifts::Off),
    ] {
        let found = shifts(&hints(term), &replies(name, attributes, synchronized));
        assert_eq!(found.value, expected, "{term}, {name:?}, {attributes:?}, {synchronized:?}");
    }
}

#[test]
fn a_user_who_refuses_shifts_gets_none() {
    let mut hints = hints("xterm-kitty");
    hints.refuses_shifts = true;
    let found = shifts(&hints, &replies(Some("kitty(0.26.5)"), None, Some(true)));
    assert_eq!(found, Detected { value: Shifts::Off, source: Source::User });
}
