//! Properties of the input parser for any bytes, and of the camera that its keys move.
//!
//! For the fuzzer and for the replay of its corpus.

use crossterm::event::{Event, KeyEvent, KeyEventKind, KeyModifiers};
use std::time::Duration;
use termtrace::internals::control::{AGAIN_TIME, COAST_TIME, KeyMode, Keymap, Motion};
use termtrace::internals::input::{Input, MAX_PASTE_WAITS, Parser};

/// Panics if a law is broken for these bytes, of which the first says how the rest is split.
pub(crate) fn hold_for(data: &[u8]) {
    let Some((&seed, bytes)) = data.split_first() else {
        return;
    };
    let pieces = split(seed, bytes);
    for keys_are_sequences in [false, true] {
        let start = || parser(keys_are_sequences);
        assert!(events(start(), &pieces) == events(start(), &[bytes]), "split as {pieces:?}");
        keys_come_again(start(), &pieces);
        no_key_is_invented(start(), bytes);
        no_key_is_stuck(keys_are_sequences, &pieces);
    }
}

fn parser(keys_are_sequences: bool) -> Parser {
    let mut parser = Parser::new();
    parser.set_keys_are_sequences(keys_are_sequences);
    parser
}

/// Pieces of one to eight bytes, or of sixteen times as many, as the bits of the seed have it.
fn split(seed: u8, bytes: &[u8]) -> Vec<&[u8]> {
    let longest = if seed & 0x80 == 0 { 8 } else { 128 };
    let mut state = u32::from(seed) | 0x100;
    let mut rest = bytes;
    std::iter::from_fn(|| {
        // The generator of Numerical Recipes: any will do that spreads.
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let length = (1 + (state >> 16) as usize % longest).min(rest.len());
        let (piece, after) = rest.split_at(length);
        rest = after;
        (!piece.is_empty()).then_some(piece)
    })
    .collect()
}

fn events(mut parser: Parser, pieces: &[&[u8]]) -> Vec<Input> {
    let mut out = Vec::new();
    for piece in pieces {
        parser.feed(piece, &mut out);
    }
    out
}

/// Flushes the parser after each piece, and asserts that a key is still read in either encoding.
fn keys_come_again(mut parser: Parser, pieces: &[&[u8]]) {
    let mut out = Vec::new();
    for piece in pieces {
        parser.feed(piece, &mut out);
        parser.time_out(&mut out);
    }
    for _ in 0..MAX_PASTE_WAITS {
        parser.time_out(&mut out);
    }
    assert!(!parser.is_waiting());
    out.clear();
    parser.feed(b"\x03w\x1b[119;1:2u", &mut out);
    let presses = |inputs: Vec<Input>| inputs.into_iter().filter(|input| !is_release(input)).collect::<Vec<_>>();
    assert_eq!(presses(out), presses(events(Parser::new(), &[b"\x03w\x1b[119;1:2u"])));
}

fn is_release(input: &Input) -> bool {
    matches!(input, Input::Event(Event::Key(KeyEvent { kind: KeyEventKind::Release, .. })))
}

fn is_key(input: &Input) -> bool {
    matches!(input, Input::Event(Event::Key(_)))
}

/// Asserts that no key comes from a paste or a reply.
fn no_key_is_invented(start: Parser, bytes: &[u8]) {
    let held_by = |opening: &[u8], bytes: &[u8], closing: &[u8]| [opening, bytes, closing].concat();
    let end = b"\x1b[201~";
    if !bytes.windows(end.len()).any(|window| window == end) {
        let inputs = events(start, &[&held_by(b"\x1b[200~", bytes, end)]);
        assert!(matches!(inputs[..], [Input::Event(Event::Paste(_))]), "{inputs:?}");
    }
    // Control letters end an answer, or are the keys that they always are.
    let text: Vec<u8> = bytes.iter().copied().filter(|&byte| byte >= 0x20).collect();
    for opening in [&b"\x1b]"[..], b"\x1bP", b"\x1b_", b"\x1bX", b"\x1b^"] {
        let inputs = events(Parser::new(), &[&held_by(opening, &text, b"\x1b\\")]);
        assert!(!inputs.iter().any(is_key), "{inputs:?}");
    }
    // A number says what a private sequence is about, never that it is a key.
    let numbers: Vec<u8> = bytes.iter().copied().filter(|&byte| matches!(byte, b'0'..=b';')).collect();
    let inputs = events(Parser::new(), &[&held_by(b"\x1b[?", &numbers, b"u")]);
    assert!(!inputs.iter().any(is_key), "{inputs:?}");
}

/// Asserts that no key is stuck.
///
/// Moves as the live view does, a piece every 30 ms. When the focus is lost, when all keys are released, and when a
/// terminal without releases is silent, the camera stands still.
fn no_key_is_stuck(keys_are_sequences: bool, pieces: &[&[u8]]) {
    let mut motion = Motion::default();
    motion.set_reports_releases(keys_are_sequences);
    let (mut parser, mut now) = (parser(keys_are_sequences), Duration::ZERO);
    for piece in pieces {
        let mut out = Vec::new();
        parser.feed(piece, &mut out);
        for input in &out {
            take(&mut motion, input, now);
        }
        now += Duration::from_millis(30);
    }
    let mut let_go = motion.clone();
    for key in Keymap::default().bindings().iter().flat_map(|row| &row.keys) {
        for state in [crossterm::event::KeyEventState::NONE, crossterm::event::KeyEventState::KEYPAD] {
            let kind = KeyEventKind::Release;
            let release = KeyEvent::new_with_kind_and_state(key.code, KeyModifiers::NONE, kind, state);
            let_go.take_key(&release, None, now);
        }
    }
    // A tap goes on for as long after its release.
    assert!(!let_go.is_moving(now + AGAIN_TIME), "all keys are let go: {let_go:?}");
    if !keys_are_sequences {
        assert!(!motion.is_moving(now + AGAIN_TIME), "{motion:?}");
    }
    take(&mut motion, &Input::Event(Event::FocusLost), now);
}

fn take(motion: &mut Motion, input: &Input, now: Duration) {
    match input {
        Input::Event(Event::Key(key)) => {
            let before = motion.is_moving(now);
            motion.take_key(key, Keymap::default().command(&[KeyMode::Fly, KeyMode::Always], key), now);
            if key.kind == KeyEventKind::Release {
                // Of two opposite keys, the other is then alone.
                assert!(before || motion.reports_releases() || !motion.is_moving(now), "a release began a movement");
            }
            if key.kind == KeyEventKind::Repeat && !motion.reports_releases() {
                assert!(!motion.is_moving(now + COAST_TIME), "a repeat goes on for too long");
            }
        }
        Input::Event(Event::FocusLost) => {
            motion.stop();
            assert!(!motion.is_moving(now), "the focus is lost");
        }
        _ => {}
    }
}
