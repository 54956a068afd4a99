//! Tests of the parser: a table of byte sequences with the expected inputs, and properties with
//! random bytes.
//!
//! The most important property is that the inputs do not depend on how the bytes are split.

use super::{Input, MAX_PASTE_BYTES, MAX_PASTE_WAITS, Parser, Reply};
use crossterm::event::{Event, KeyCode, KeyEventKind};
use proptest::prelude::*;

mod table;

use table::{
    ALT, CONTROL, NONE, key, keys_without_a_letter, kitty_keys, letter, of_kind, paste, replies,
    replies_in_strings_and_others, reply, table,
};

fn parse(pieces: &[&[u8]]) -> Vec<Input> {
    parse_with(Parser::new(), pieces)
}

/// Returns a parser for a terminal that sends every key as a sequence (kitty keyboard protocol).
fn parser_of_sequences() -> Parser {
    let mut parser = Parser::new();
    parser.set_keys_are_sequences(true);
    parser
}

fn parse_with(mut parser: Parser, pieces: &[&[u8]]) -> Vec<Input> {
    let mut out = Vec::new();
    for piece in pieces {
        parser.feed(piece, &mut out);
    }
    out
}

fn is_key(input: &Input) -> bool {
    matches!(input, Input::Event(Event::Key(_)))
}

#[test]
fn bytes_are_parsed_as_the_table_says() {
    for (bytes, expected) in table() {
        assert_eq!(parse(&[bytes]), expected, "{}", bytes.escape_ascii());
    }
}

#[test]
fn a_complete_sequence_leaves_no_wait() {
    for (bytes, expected) in table() {
        let (mut parser, mut out) = (Parser::new(), Vec::new());
        parser.feed(bytes, &mut out);
        assert!(!parser.is_waiting(), "{}", bytes.escape_ascii());
        parser.time_out(&mut out);
        assert_eq!(out, expected, "{}", bytes.escape_ascii());
    }
}

#[test]
fn the_split_of_the_bytes_does_not_matter() {
    for (bytes, expected) in table() {
        for at in 0..=bytes.len() {
            let (first, second) = bytes.split_at(at);
            assert_eq!(parse(&[first, second]), expected, "{} at {at}", bytes.escape_ascii());
        }
        let single: Vec<&[u8]> = bytes.chunks(1).collect();
        assert_eq!(parse(&single), expected, "{} byte by byte", bytes.escape_ascii());
    }
}

#[test]
fn a_reply_is_never_reported_as_a_key() {
    for (bytes, expected) in [replies(), replies_in_strings_and_others()].concat() {
        let wanted: Vec<&Input> = expected.iter().filter(|input| !is_key(input)).collect();
        let keys = expected.iter().filter(|input| is_key(input)).count();
        // Splits after an ESC are excluded: a timeout there reports the Escape key, so callers wait longer while a
        // reply is due.
        for at in (0..=bytes.len()).filter(|&at| at == 0 || !bytes[..at].ends_with(b"\x1b")) {
            let (mut parser, mut out) = (Parser::new(), Vec::new());
            parser.feed(&bytes[..at], &mut out);
            parser.time_out(&mut out);
            parser.feed(&bytes[at..], &mut out);
            let (heard, rest): (Vec<&Input>, Vec<&Input>) = out.iter().partition(|i| !is_key(i));
            assert_eq!(heard, wanted, "{} late from {at}", bytes.escape_ascii());
            assert_eq!(rest.len(), keys, "{} late from {at}", bytes.escape_ascii());
        }
    }
}

#[test]
fn a_string_whose_terminator_is_late_is_still_a_reply() {
    let (mut parser, mut out) = (Parser::new(), Vec::new());
    parser.feed(b"\x1b]11;?\x1b", &mut out);
    parser.time_out(&mut out);
    parser.feed(b"\\x", &mut out);
    assert_eq!(out, [reply(Reply::Osc(b"11;?".to_vec())), letter('x', NONE)]);
}

/// Parses `begun`, then a timeout, then `later`. Returns the inputs up to the timeout and those
/// after it.
fn parse_around_timeout(begun: &[u8], later: &[u8]) -> (Vec<Input>, Vec<Input>) {
    let (mut parser, mut at_once, mut out) = (Parser::new(), Vec::new(), Vec::new());
    parser.feed(begun, &mut at_once);
    assert!(parser.is_waiting(), "{}", begun.escape_ascii());
    parser.time_out(&mut at_once);
    assert!(!parser.is_waiting(), "{}", begun.escape_ascii());
    parser.feed(later, &mut out);
    (at_once, out)
}

#[test]
fn a_lone_escape_is_the_escape_key() {
    let escape = || key(KeyCode::Esc, NONE);
    assert_eq!(parse_around_timeout(b"\x1b", b"x"), (vec![escape()], vec![letter('x', NONE)]));
    assert_eq!(parse_around_timeout(b"\x1b\x1b", b"x"), (vec![escape(), escape()], vec![letter('x', NONE)]));
    assert_eq!(parse_around_timeout(b"\x1b\x1b[1", b"\x03"), (vec![escape()], vec![letter('c', CONTROL)]));
}

#[test]
fn an_incomplete_sequence_is_dropped_with_its_late_rest() {
    for begun in [&b"\x1b["[..], b"\x1b[1;", b"\x1bO", b"\x1bO5"] {
        assert_eq!(parse_around_timeout(begun, b"Ax"), (vec![], vec![letter('x', NONE)]));
    }
    for begun in [&b"\xc3"[..], b"\xf0\x9f", b"\x1b[[", b"\x1b[M #", b"\x1bX", b"\x1b]", b"\x1bP"] {
        assert_eq!(parse_around_timeout(begun, b"x"), (vec![], vec![letter('x', NONE)]));
    }
}

#[test]
fn an_incomplete_sequence_drops_a_bounded_number_of_late_bytes() {
    let interrupt = vec![letter('c', CONTROL)];
    for begun in [&b"\x1b["[..], b"\x1b[1;", b"\x1bO", b"\x1b]11;", b"\x1bP1$", b"\x1b_G", b"\x1b]0\x1b"] {
        assert_eq!(parse_around_timeout(begun, b"\x03").1, interrupt, "{}", begun.escape_ascii());
        assert_eq!(parse_around_timeout(begun, b"\x1b[A").1, [key(KeyCode::Up, NONE)]);
        let typed = [b'1'; 400];
        assert!(parse_around_timeout(begun, &typed).1.len() > 100, "{}", begun.escape_ascii());
    }
}

#[test]
fn an_escape_after_a_timed_out_string_ends_it() {
    let (_, out) = parse_around_timeout(b"\x1b]11;", b"abc\x1bOAx");
    assert_eq!(out, [key(KeyCode::Up, NONE), letter('x', NONE)]);
}

#[test]
fn an_unfinished_paste_ends_after_its_timeouts() {
    let (mut parser, mut out) = (Parser::new(), Vec::new());
    parser.feed(b"\x1b[200~ab", &mut out);
    for _ in 1..MAX_PASTE_WAITS {
        parser.time_out(&mut out);
        assert!(parser.is_waiting());
    }
    parser.feed(b"c", &mut out);
    for _ in 0..MAX_PASTE_WAITS {
        assert_eq!(out, []);
        parser.time_out(&mut out);
    }
    assert!(!parser.is_waiting());
    parser.feed(b"x", &mut out);
    assert_eq!(out, [paste("abc"), letter('x', NONE)]);
}

#[test]
fn a_paste_is_truncated_at_its_limit() {
    let mut bytes = b"\x1b[200~".to_vec();
    bytes.resize(bytes.len() + 3 * MAX_PASTE_BYTES, b'q');
    bytes.extend(b"\x1b[201~x");
    let out = parse(&[&bytes]);
    let [Input::Event(Event::Paste(text)), last] = &out[..] else {
        panic!("not a paste and a key: {} inputs", out.len());
    };
    assert_eq!((text.len(), last), (MAX_PASTE_BYTES, &letter('x', NONE)));
}

#[test]
fn an_endless_string_or_sequence_takes_bounded_memory() {
    for introducer in [&b"\x1b]0;"[..], b"\x1bP1$r", b"\x1b_G", b"\x1bX", b"\x1b[", b"\x1bO"] {
        let (mut parser, mut out) = (Parser::new(), Vec::new());
        parser.feed(introducer, &mut out);
        parser.feed(&vec![b'1'; 1 << 20], &mut out);
        assert!(parser.text.capacity() <= 2 * super::MAX_STRING_BYTES);
        assert!(parser.is_waiting());
        parser.feed(b"\x1b\\\x1b[Ax", &mut out);
        let [.., up, x] = &out[..] else { panic!("{out:?}") };
        assert_eq!((up, x), (&key(KeyCode::Up, NONE), &letter('x', NONE)));
    }
}

#[test]
fn sequences_mean_the_same_with_the_kitty_protocol() {
    for (bytes, expected) in [kitty_keys(), keys_without_a_letter(), replies()].concat() {
        // One legacy key of the table is followed by a plain x, which the kitty protocol reports as pressed and
        // released.
        if !bytes.ends_with(b"x") {
            assert_eq!(parse_with(parser_of_sequences(), &[bytes]), expected, "{}", bytes.escape_ascii());
        }
    }
}

#[test]
fn a_plain_character_is_pressed_and_released_with_the_kitty_protocol() {
    let typed = |code, modifiers| {
        [KeyEventKind::Press, KeyEventKind::Release].map(|kind| of_kind(code, modifiers, kind)).to_vec()
    };
    let (w, c) = (KeyCode::Char('w'), KeyCode::Char('c'));
    let out = parse_with(parser_of_sequences(), &[b"w\x03\x1bw\x1b[1;\x035A"]);
    let mut expected = [typed(w, NONE), typed(c, CONTROL), typed(w, ALT), typed(c, CONTROL)].concat();
    expected.push(key(KeyCode::Up, CONTROL));
    assert_eq!(out, expected);
}

#[test]
fn a_lone_escape_is_not_a_key_with_the_kitty_protocol() {
    let inputs_after_timeout = |begun: &[u8], later: &[u8]| {
        let (mut parser, mut out) = (parser_of_sequences(), Vec::new());
        parser.feed(begun, &mut out);
        parser.time_out(&mut out);
        assert!(!parser.is_waiting());
        assert_eq!(out, [], "{}", begun.escape_ascii());
        parser.feed(later, &mut out);
        out
    };
    for begun in [&b"\x1b"[..], b"\x1b\x1b"] {
        assert_eq!(inputs_after_timeout(begun, b"\x1b[27u"), [key(KeyCode::Esc, NONE)]);
    }
    // A key sequence completed after the timeout is dropped, unless it is a release.
    let released = || of_kind(KeyCode::Char('w'), NONE, KeyEventKind::Release);
    for at in 1..b"\x1b[119;1:3u".len() {
        let (begun, rest) = b"\x1b[119;1:3u".split_at(at);
        assert_eq!(inputs_after_timeout(begun, rest), [released()], "{at}");
        let (begun, rest) = b"\x1b[119;1:1u".split_at(at);
        assert_eq!(inputs_after_timeout(begun, rest), [], "{at}");
    }
    assert_eq!(inputs_after_timeout(b"\x1b", b"[?62c"), [reply(Reply::DeviceAttributes(vec![62]))]);
}

/// Generates random bytes in which escape sequences are frequent.
fn noise() -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![
        4 => prop::sample::select(b"\x1b\x1b\x1b[[O]P_<>?;:0123456789~uMmtcRA$\\\x07\x18".to_vec()),
        1 => any::<u8>(),
    ];
    prop::collection::vec(byte, 0..200)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn noise_is_parsed_alike_however_it_is_split(bytes in noise(), at in any::<prop::sample::Index>()) {
        let (first, second) = bytes.split_at(at.index(bytes.len() + 1));
        prop_assert_eq!(parse(&[first, second]), parse(&[&bytes]));
        let parse_sequences = |reads: &[&[u8]]| parse_with(parser_of_sequences(), reads);
        prop_assert_eq!(parse_sequences(&[first, second]), parse_sequences(&[&bytes]));
    }

    #[test]
    fn keys_are_reported_again_after_any_noise(bytes in noise()) {
        let (mut parser, mut out) = (Parser::new(), Vec::new());
        parser.feed(&bytes, &mut out);
        for _ in 0..MAX_PASTE_WAITS {
            parser.time_out(&mut out);
        }
        prop_assert!(!parser.is_waiting());
        out.clear();
        parser.feed(b"\x03w", &mut out);
        prop_assert_eq!(out, vec![letter('c', CONTROL), letter('w', NONE)]);
    }

    /// Checks with random CSI sequences that only those with the final byte of a key are reported
    /// as keys.
    #[test]
    fn unknown_sequences_are_not_keys(
        mark in prop::sample::select(vec!["", "?", ">", "<", "="]),
        numbers in "[0-9;:]{0,12}",
        between in prop::sample::select(vec!["", "$", " ", "!", "'"]),
        last in 0x40_u8..0x7f,
    ) {
        let bytes = format!("\x1b[{mark}{numbers}{between}{}", char::from(last));
        let names_a_key = mark.is_empty() && between.is_empty()
            && b"ABCDEFHPQRSZabcd~^@u".contains(&last);
        let out = parse(&[bytes.as_bytes()]);
        prop_assert!(names_a_key || !out.iter().any(is_key), "{:?} {:?}", bytes, out);
    }
}

#[test]
fn a_megabyte_of_random_bytes_is_parsed_without_hanging() {
    const SEED: u64 = 0x7465_726d_7472_6163;
    let mut state = SEED;
    let bytes: Vec<u8> = std::iter::repeat_with(|| {
        // xorshift64
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 32) as u8
    })
    .take(1 << 20)
    .collect();
    let whole = parse(&[&bytes]);
    let pieces: Vec<&[u8]> = bytes.chunks(7).collect();
    assert!(parse(&pieces) == whole, "split in sevens, seed {SEED:#x}");
    // Half of the bytes are ASCII, and most of these are keys unless they are part of a string or paste.
    assert!(whole.len() > 10_000, "{} inputs, seed {SEED:#x}", whole.len());
}
