//! Queries to the terminal, and replies to them: none, all at once, late, in pieces, forged.

use crate::pty::{self, Colour, SOON, Session, Size, Start, shows, until_in_time};
use rustix::process::Signal;
use std::fmt::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::time::{Duration, Instant};
use termtrace::internals::capabilities::Hints;
use termtrace::internals::protocol::InitialQueries;
use termtrace::{CellMode, Colors, Glyphs, Grid, Scene, Srgb8};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/ball.ron");
const FENCE: &[u8] = b"\x1b[c";
/// A time longer than the parser holds back an Escape byte that may begin a sequence.
///
/// No event reports the end of that time.
const PAST_ESCAPE_TIMEOUT: Duration = Duration::from_millis(150);
const FENCE_REPLY: &[u8] = b"\x1b[?62;22c";

/// Starts the view on a terminal whose name means 256 colours, and which replies to nothing.
fn live() -> Start {
    Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(SCENE).env("COLORTERM", "").mute()
}

/// Returns the picture of the scene in these cells, which are `aspect` times as high as wide.
fn picture(glyphs: Glyphs, colors: Colors, aspect: f32) -> Grid {
    let scene = Scene::load(Path::new(SCENE)).expect("the scene is fine");
    pty::picture(&scene, CellMode { glyphs, colors }, termtrace::Size::new(80, 24), aspect)
}

#[track_caller]
fn wait_for(session: &mut Session, glyphs: Glyphs, colors: Colors, aspect: f32) {
    let wanted = picture(glyphs, colors, aspect);
    session.wait_for(&format!("{glyphs:?} in {colors:?}"), SOON, |seen| shows(seen.screen(), &wanted));
}

/// Waits for the picture by the environment alone, and for the queries.
#[track_caller]
fn looking(start: Start) -> Session {
    let mut session = start.spawn();
    wait_for(&mut session, Glyphs::Half, Colors::Indexed256, 2.0);
    session
}

/// Leaves. Where the kitty keyboard protocol was pushed, one more query is sent, and its reply is
/// the last.
#[track_caller]
fn leave(session: &mut Session) {
    let keyboard = session.seen().has(b"\x1b[>15u");
    session.send(b"q");
    if keyboard {
        session.wait_for("the last question", SOON, |seen| seen.has(b"\x1b[?1049l\x1b[c"));
        session.send(FENCE_REPLY);
    }
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

#[test]
fn a_key_cycles_through_all_kinds_of_cells() {
    let mut session = looking(live());
    let of_kind = |glyphs, shown: char| match glyphs {
        Glyphs::Half => shown == '▄',
        Glyphs::Blocks => ('▖'..='▟').contains(&shown),
        Glyphs::Octants => ('\u{1CD00}'..='\u{1CDE5}').contains(&shown),
        Glyphs::Sextants => ('\u{1FB00}'..='\u{1FB3B}').contains(&shown),
        Glyphs::Braille => ('⠁'..='⣿').contains(&shown),
        _ => shown.is_ascii_punctuation(),
    };
    for &glyphs in Glyphs::ALL[1..].iter().chain(&Glyphs::ALL[..1]) {
        session.send(b"B");
        session.wait_for_text(&format!("(--glyphs {glyphs})"));
        // The lowest row holds the note.
        session.wait_for(&format!("a picture of {glyphs}"), SOON, |seen| {
            let rows = seen.screen().text();
            let picture: String = rows[..rows.len() - 1].concat();
            (glyphs == Glyphs::Spaces || picture.chars().any(|shown| of_kind(glyphs, shown)))
                && picture.chars().all(|shown| glyphs.has_blocks() || shown.is_ascii())
        });
    }
    leave(&mut session);
}

/// Returns the replies of a terminal that supports all queries, in order, without the fence's.
fn all_replies() -> Vec<u8> {
    [
        &b"\x1b[1;2R"[..],
        b"\x1b]11;rgb:1e1e/1e1e/1e1e\x1b\\",
        b"\x1b[?2026;2$y\x1b[?1006;2$y\x1b[?1016;2$y",
        b"\x1b[?0u",
        b"\x1b[6;20;10t",
        b"\x1bP1$r0;48:2::1:2:3m\x1b\\",
    ]
    .concat()
}

/// Returns the end of the first queries in the output. They are sent again after a stop.
fn end_of_queries(seen: &pty::Seen) -> usize {
    let ask = b"\x1b]11;?";
    let asked = seen.bytes().windows(ask.len()).rposition(|bytes| bytes == ask).expect("it was asked");
    let fence = seen.bytes()[asked..].windows(FENCE.len()).position(|bytes| bytes == FENCE).expect("queries end");
    asked + fence + FENCE.len()
}

/// Sends the last reply to the first queries, and the replies to those of frames.
fn send_last_replies(session: &mut Session) {
    session.send(FENCE_REPLY);
    reply_to_frames(session);
}

/// Answers the queries of frames from now on. A terminal replies in order: so the earlier ones are
/// answered.
fn reply_to_frames(session: &mut Session) {
    let from = end_of_queries(session.seen());
    session.answer_from(from);
}

/// Asserts that no key was pressed: the help is not open, and the eye is where it was.
#[track_caller]
fn nothing_was_pressed(session: &mut Session) {
    session.send(b"i");
    session.wait_for_text("eye 0.00 1.00 5.00");
    let text = session.seen().screen().text().join("");
    assert!(!text.contains("WASD"), "{text}");
}

#[test]
fn a_terminal_that_never_replies_gets_its_picture_at_once() {
    let mut session = looking(live());
    let bytes = session.seen().bytes();
    let asked = bytes.windows(FENCE.len()).position(|bytes| bytes == FENCE).expect("it was asked");
    assert!(bytes[..asked].windows(4).any(|bytes| bytes == b"$qm\x1b"), "the fence is behind the queries");
    leave(&mut session);
}

#[test]
fn all_replies_at_once_improve_the_picture() {
    let mut session = looking(live().size(Size::cells(80, 24).of_pixels(0, 0)));
    assert!(!session.seen().has(b"\x1b[?2026h"));
    session.send(&String::from_utf8_lossy(&all_replies()).replace("6;20;10t", "6;24;10t").into_bytes());
    send_last_replies(&mut session);
    wait_for(&mut session, Glyphs::Half, Colors::Truecolor, 2.4);
    assert!(session.seen().has(b"\x1b[?2026h") && session.seen().has(b"\x1b[?2026l"));
    nothing_was_pressed(&mut session);
    leave(&mut session);
}

#[test]
fn replies_count_once_the_last_has_come() {
    let mut session = looking(live());
    session.send(&all_replies());
    let wanted = picture(Glyphs::Half, Colors::Truecolor, 2.0);
    session.wait_until_read();
    nothing_was_pressed(&mut session);
    session.send(b"i");
    assert!(!shows(session.seen().screen(), &wanted));
    send_last_replies(&mut session);
    wait_for(&mut session, Glyphs::Half, Colors::Truecolor, 2.0);
    leave(&mut session);
}

#[test]
fn late_replies_count_too() {
    let mut session = looking(live());
    // The picture is shown when the program has stopped waiting for the first replies.
    session.send(b"i");
    session.wait_for_text("eye 0.00 1.00 5.00");
    session.send(b"i");
    session.send(&all_replies());
    send_last_replies(&mut session);
    wait_for(&mut session, Glyphs::Half, Colors::Truecolor, 2.0);
    nothing_was_pressed(&mut session);
    leave(&mut session);
}

/// Each prefix of the replies comes alone, and the rest later than a lone Escape is held back for.
///
/// The help is open, which Escape would close.
#[test]
fn replies_split_at_any_byte_press_no_key() {
    let replies = [&b"\x1b[1;2R"[..], b"\x1b]11;rgb:0/0/0\x1b\\", b"\x1bP1$r48;2;1;2;3m\x1b\\", FENCE_REPLY].concat();
    let places: Vec<_> = (1..replies.len()).collect();
    // Eight run at a time, again if the machine was too busy for them.
    for places in places.chunks(8) {
        assert!((0..10).any(|_| split_replies_at(places, &replies)), "no session replied in time in 10 attempts");
    }
}

/// Time after the start of a session by which the replies must be sent.
///
/// The program takes a terminal that has not replied for 3 s for one that never does, and then a lone Escape is a key.
const LATEST_REPLY: Duration = Duration::from_millis(2_500);
/// Time after the first part of a reply by which its second part must be sent, and after `q` by
/// which all replies must be: 1 s, with a margin.
const LONGEST_SPLIT: Duration = Duration::from_millis(700);

/// Sends the replies in two parts, to a session for each place of the split, and asserts that no
/// key was pressed: the help, which is open, can still be turned to its next page.
///
/// Returns false, and asserts nothing, if a part was sent too late.
fn split_replies_at(places: &[usize], replies: &[u8]) -> bool {
    let begun = Instant::now();
    let mut sessions: Vec<_> = places.iter().map(|&at| (replies.split_at(at), live().spawn())).collect();
    for (_, session) in &mut sessions {
        session.wait_for("the queries", SOON, |seen| seen.has(FENCE));
        session.send(b"i?");
        session.wait_for_text("page 1 of 2");
    }
    let split = Instant::now();
    for ((beginning, _), session) in &mut sessions {
        session.send(beginning);
    }
    std::thread::sleep(PAST_ESCAPE_TIMEOUT);
    for ((_, rest), session) in &mut sessions {
        session.send(rest);
        reply_to_frames(session);
    }
    if begun.elapsed() > LATEST_REPLY || split.elapsed() > LONGEST_SPLIT {
        return false;
    }
    for (_, session) in &mut sessions {
        // The next page comes only if the help is open and nothing was typed into its filter.
        session.send(b" ");
        session.wait_for_text("page 2 of 2");
        session.send(b"qq");
        assert_eq!(session.wait_exit(SOON).code(), Some(0));
        session.assert_clean();
    }
    true
}

#[test]
fn every_byte_alone_is_the_same_as_all_at_once() {
    let mut session = looking(live());
    for byte in [&all_replies()[..], FENCE_REPLY].concat() {
        session.send(&[byte]);
        session.wait_until_read();
    }
    reply_to_frames(&mut session);
    wait_for(&mut session, Glyphs::Half, Colors::Truecolor, 2.0);
    nothing_was_pressed(&mut session);
    leave(&mut session);
}

/// Replies without a query, nonsense and replies after the last one change nothing and press
/// nothing.
#[test]
fn forged_replies_change_nothing() {
    let mut session = looking(live());
    session.send(b"\x1b]11;rgb:q/q/q\x1b\\\x1bP1$rqqqm\x1b\\\x1b[?9999;1$y\x1b[6;0;0t\x1b]4;99;rgb:0/0/0\x07");
    send_last_replies(&mut session);
    session.send(&all_replies());
    session.send(b"\x1b[1;9R\x1b[?1;2c");
    nothing_was_pressed(&mut session);
    session.send(b"i");
    wait_for(&mut session, Glyphs::Half, Colors::Indexed256, 2.0);
    assert!(!session.seen().has(b"\x1b[?2026h"));
    leave(&mut session);
}

#[test]
fn blocks_that_are_not_one_column_wide_are_not_used() {
    for (answer, glyphs) in
        [(&b"\x1b[1;2R"[..], Glyphs::Half), (b"\x1b[1;3R", Glyphs::Spaces), (b"\x1b[1;4R", Glyphs::Spaces)]
    {
        let mut session = looking(live());
        session.send(answer);
        send_last_replies(&mut session);
        wait_for(&mut session, glyphs, Colors::Indexed256, 2.0);
        leave(&mut session);
    }
}

#[test]
fn sixteen_colours_are_the_terminals_own() {
    let mut session = live().arg("--color=16").spawn();
    wait_for(&mut session, Glyphs::Half, Colors::SIXTEEN, 2.0);
    assert!(session.seen().has(b"\x1b]4;15;?"));
    let mut values = [Srgb8::default(); 16];
    let mut replies = String::new();
    for (index, value) in values.iter_mut().enumerate() {
        let grey = 17 * index as u8;
        *value = Srgb8::new(grey, grey, 255 - grey);
        let _ =
            write!(replies, "\x1b]4;{index};rgb:{0:02x}{0:02x}/{0:02x}{0:02x}/{1:02x}{1:02x}\x1b\\", grey, 255 - grey);
    }
    session.send(replies.as_bytes());
    send_last_replies(&mut session);
    wait_for(&mut session, Glyphs::Half, Colors::Indexed16(values), 2.0);
    leave(&mut session);
}

#[test]
fn a_light_background_inverts_ink() {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(SCENE).arg("--color=never").arg("--glyphs=ramp").mute();
    let mut session = start.spawn();
    let dark = picture(Glyphs::Ramp, Colors::None, 2.0);
    session.wait_for("light on dark", SOON, |seen| shows(seen.screen(), &dark));
    session.send(b"\x1b]11;rgb:ffff/ffff/ffff\x07");
    send_last_replies(&mut session);
    // Ink is blank, and blank is ink.
    session.wait_for("dark on light", SOON, |seen| {
        let inked = |screen: &pty::Screen, at: usize| screen.cell(at % 80, at / 80).glyph != ' ';
        let turned = dark.cells().enumerate().filter(|(_, cell)| cell.glyph == ' ');
        turned.clone().count() > 0 && turned.into_iter().all(|(at, _)| inked(seen.screen(), at))
    });
    leave(&mut session);
}

#[test]
fn outstanding_replies_are_waited_for_and_none_is_left() {
    let wanted = picture(Glyphs::Half, Colors::Indexed256, 2.0);
    until_in_time(|| {
        let begun = Instant::now();
        let mut session = live().spawn();
        session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
        let left = Instant::now();
        session.send(b"q");
        session.wait_for("the terminal to be given back", SOON, |seen| !seen.screen().is_alternate());
        session.send(&all_replies());
        // The last reply comes in two parts.
        session.send(&FENCE_REPLY[..4]);
        if left.elapsed() > LONGEST_SPLIT {
            return false;
        }
        session.wait_until_read();
        session.send(&FENCE_REPLY[4..]);
        reply_to_frames(&mut session);
        if begun.elapsed() > LATEST_REPLY || left.elapsed() > LONGEST_SPLIT {
            return false;
        }
        assert_eq!(session.wait_exit(SOON).code(), Some(0));
        session.assert_clean();
        assert_eq!(session.typed_ahead(), b"");
        assert!(!session.seen().has(b"rgb:"), "nothing is echoed");
        true
    });
}

/// A program that is stopped before the replies came asks again: they may have had another reader.
#[test]
fn a_stopped_program_queries_again() {
    let mut session = looking(live());
    session.signal(Signal::STOP);
    session.wait_stopped(SOON);
    session.signal(Signal::CONT);
    let question = b"\x1bP$qm\x1b\\\x1b[0m\x1b[c";
    let asked = |seen: &pty::Seen| seen.bytes().windows(question.len()).filter(|bytes| bytes == question).count();
    session.wait_for("the queries again", SOON, |seen| asked(seen) == 2);
    session.send(&all_replies());
    send_last_replies(&mut session);
    wait_for(&mut session, Glyphs::Half, Colors::Truecolor, 2.0);
    leave(&mut session);
}

#[test]
fn a_signal_waits_for_replies_up_to_a_limit() {
    let mut session = looking(live());
    session.signal(Signal::TERM);
    assert_eq!(session.wait_exit(SOON).signal(), Some(Signal::TERM.as_raw()));
    session.assert_clean();
}

/// No letter of a query is seen, no half a sequence, and no mode or colour is left on.
#[test]
fn no_query_leaves_a_trace_on_the_screen() {
    for term in ["xterm-256color", "tmux-256color", "screen-256color", "linux", "dumb", "vt100"] {
        let variable = |name: &str| (name == "TERM").then(|| term.to_owned());
        let queries = InitialQueries::all_safe(&Hints::gather(&variable, &|_| None));
        let mut screen = pty::Screen::new(80, 24);
        screen.feed(queries.bytes());
        for text in [screen.text().concat(), screen.second_opinion().contents()] {
            assert_eq!(text, "", "{term}");
        }
        screen.feed(b"x");
        let shown = screen.cell(0, 0);
        assert_eq!(
            (shown.glyph, shown.foreground, shown.background),
            ('x', Colour::Default, Colour::Default),
            "{term}"
        );
        assert_eq!(pty::Modes::after(queries.bytes()), pty::Modes::after(b""), "{term}");
        assert_eq!(queries.bytes().is_empty(), ["dumb", "vt100"].contains(&term), "{term}");
    }
}

#[test]
fn doctor_queries_and_reports_the_replies() {
    let doctor = || Start::new(env!("CARGO_BIN_EXE_termtrace")).arg("doctor").env("COLORTERM", "").mute();
    let mut session = doctor().size(Size::cells(80, 24)).spawn();
    session.wait_for("the queries", SOON, |seen| seen.has(FENCE));
    session.send(&[&all_replies()[..], b"\x1b]4;0;rgb:0/0/0\x07", FENCE_REPLY].concat());
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
    assert_eq!(session.typed_ahead(), b"");
    let text = session.seen().screen().text();
    let rows: Vec<String> =
        text[1..12].iter().map(|row| row.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    assert!(rows[0].starts_with("queries sent all replies after "), "{rows:#?}");
    assert_eq!(
        rows[1..],
        [
            "colours truecolor its reply",
            "locale C.UTF-8 LC_ALL",
            "cells half blocks, 1 column LC_ALL",
            "cell, height/width 2.000 (10x20 pixels) the window's pixels",
            "half blocks join yes the window's pixels",
            "background dark, #1e1e1e its reply",
            "palette 1 of 16 colours known its reply",
            "synchronized output yes its reply",
            "kitty keyboard yes its reply",
            "mouse reports in cells and in pixels its reply",
        ]
    );
    let all = text.join("\n");
    assert!(all.contains("Circle not round?") && all.contains("--cell-aspect (now 2.00)"), "{all}");
    assert!(all.contains("Gradient not smooth?") && all.contains("Stripes uneven or crooked?"), "{all}");
    assert!(all.contains('▄') && all.contains('▀'), "the card is of half blocks:\n{all}");
}

#[test]
fn doctor_sends_a_dumb_terminal_no_escape_byte() {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg("doctor").env("TERM", "dumb").env("COLORTERM", "");
    let mut session = start.mute().spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    assert!(!session.seen().bytes().contains(&0x1b));
    session.wait_for_text("none, because of its name");
    session.wait_for_text("Circle not round?");
}

#[test]
fn doctor_waits_up_to_a_limit_and_ends_on_signals() {
    let doctor = || Start::new(env!("CARGO_BIN_EXE_termtrace")).arg("doctor").mute();
    let mut session = doctor().spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
    session.wait_for_text("replies incomplete after 2 s");
    let mut session = doctor().spawn();
    session.wait_for("the queries", SOON, |seen| seen.has(FENCE));
    session.signal(Signal::TERM);
    assert_eq!(session.wait_exit(SOON).signal(), Some(Signal::TERM.as_raw()));
    session.assert_clean();
}
