use super::*;

fn hints(term: &str, colorterm: &str) -> Hints {
    let variable = |name: &str| match name {
        "TERM" => Some(term.to_owned()),
        "COLORTERM" => Some(colorterm.to_owned()),
        _ => None,
    };
    Hints::gather(&variable, &|_| None)
}

fn has(queries: &InitialQueries, part: &[u8]) -> bool {
    queries.bytes().windows(part.len()).any(|bytes| bytes == part)
}

#[test]
fn a_batch_ends_with_its_fence_and_holds_one() {
    for term in ["xterm", "tmux-256color", "screen", "linux"] {
        let queries = InitialQueries::all_safe(&hints(term, ""));
        assert!(queries.bytes().ends_with(FENCE) && queries.is_open(), "{term}");
        assert_eq!(queries.bytes().windows(3).filter(|bytes| *bytes == FENCE).count(), 1, "{term}");
    }
}

#[test]
fn each_terminal_gets_the_queries_that_it_understands() {
    let parts: [&[u8]; 8] =
        [b"\x1b[6n", b"\x1b]11;?", b"?2026$p", b"?1006$p", b"\x1b[16t", b"\x1b[>q\x1b[>c", b"\x1bP$qm", b"\x1b]4;15;?"];
    for (term, expected) in [
        ("xterm", [true; 8]),
        ("tmux-256color", [true, true, true, false, false, false, false, false]),
        ("screen", [true, false, false, false, false, false, false, false]),
        ("linux", [true, false, false, false, false, false, false, false]),
        ("dumb", [false; 8]),
    ] {
        let queries = InitialQueries::all_safe(&hints(term, ""));
        assert_eq!(parts.map(|part| has(&queries, part)), expected, "{term}");
    }
    assert!(InitialQueries::all_safe(&hints("dumb", "")).bytes().is_empty());
}

#[test]
fn known_facts_are_not_queried() {
    let mut known = hints("xterm", "truecolor");
    let queries = InitialQueries::needed(&known);
    assert!(!has(&queries, b"$qm") && !has(&queries, b"\x1b]4;"));
    // The terminal's name decides the glyphs at rest and shifts, unless the user has decided both.
    assert!(has(&queries, b"\x1b[>q"));
    known.glyphs = Some(crate::capabilities::Glyphs::Half);
    assert!(has(&InitialQueries::needed(&known), b"\x1b[>q"));
    known.refuses_shifts = true;
    assert!(!has(&InitialQueries::needed(&known), b"\x1b[>"));
    assert!(has(&InitialQueries::needed(&hints("xterm", "")), b"$qm"));
    assert!(has(&InitialQueries::needed(&hints("xterm-16color", "")), b"\x1b]4;0;?"));
}

#[test]
fn replies_count_up_to_the_fence() {
    let mut queries = InitialQueries::all_safe(&hints("xterm", ""));
    let replies = [
        Reply::CursorPosition { row: 1, column: 2 },
        Reply::Mode { mode: 2026, state: 2 },
        Reply::KeyboardFlags(0),
        Reply::CellPixels { width: 10, height: 20 },
        Reply::Osc(b"11;rgb:ffff/ffff/ffff".to_vec()),
        Reply::Dcs(b"1$r48;2;1;2;3m".to_vec()),
        Reply::Status(0),
    ];
    for reply in &replies {
        assert!(!queries.take_and_check_end(reply), "{reply:?}");
    }
    assert!(queries.take_and_check_end(&Reply::DeviceAttributes(vec![62])));
    let replies = queries.replies().clone();
    assert_eq!((replies.block_width, replies.synchronized_output), (Some(1), Some(true)));
    assert_eq!((replies.kitty_keyboard, replies.cell_pixels), (Some(true), Some((10, 20))));
    assert_eq!((replies.truecolor, replies.light_background()), (Some(true), Some(true)));
    // Replies that arrive after the reply to the fence are forged or for another program, and are ignored.
    assert!(!queries.take_and_check_end(&Reply::CursorPosition { row: 1, column: 3 }));
    assert!(!queries.take_and_check_end(&Reply::DeviceAttributes(vec![62])));
    assert_eq!(queries.replies(), &replies);
}

/// Alacritty replies to DA2, but not to XTVERSION. tmux replies to both queries itself.
#[test]
fn a_terminal_is_known_by_its_name_or_type() {
    let truecolor = |replies: &[Reply]| {
        let mut queries = InitialQueries::needed(&hints("xterm-256color", ""));
        assert!(!replies.iter().any(|reply| queries.take_and_check_end(reply)));
        queries.replies().supports_truecolor()
    };
    let refusal = Reply::Dcs(b"1$r48;5;16m".to_vec());
    let named = |name: &str| Reply::Dcs(format!(">|{name}").into_bytes());
    let typed = |attributes: &[u16]| Reply::SecondaryAttributes(attributes.to_vec());
    assert_eq!(truecolor(&[typed(&[0, 1100, 1])]), Some(true));
    assert_eq!(truecolor(&[named("kitty(0.26.5)")]), Some(true));
    assert_eq!(truecolor(&[named("Konsole 22.12"), refusal.clone()]), Some(true));
    assert_eq!(truecolor(&[named("tmux 3.3a"), typed(&[84, 0, 0])]), None);
    assert_eq!(truecolor(&[named("XTerm(379)"), typed(&[41, 379, 0]), refusal]), Some(false));
}

#[test]
fn a_batch_with_a_lost_fence_is_closed_once() {
    let mut queries = InitialQueries::all_safe(&hints("xterm", ""));
    queries.take_and_check_end(&Reply::Mode { mode: 2026, state: 2 });
    assert!(queries.close() && !queries.close() && !queries.is_open());
    assert_eq!(queries.replies().synchronized_output, Some(true));
}

#[test]
fn tags_are_tried_where_modes_are_queried() {
    for (term, expected) in [("xterm", true), ("tmux-256color", true), ("screen", false), ("linux", false)] {
        assert_eq!(has(&InitialQueries::needed(&hints(term, "")), &Tag::FIRST.query()), expected, "{term}");
    }
}

#[test]
fn replies_without_queries_are_ignored() {
    let mut queries = InitialQueries::all_safe(&hints("dumb", ""));
    assert!(!queries.take_and_check_end(&Reply::DeviceAttributes(vec![62])));
    assert!(!queries.take_and_check_end(&Reply::CursorPosition { row: 1, column: 3 }));
    assert_eq!(queries.replies(), &Replies::default());
}
