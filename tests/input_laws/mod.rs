//! What holds for any bytes fed to the parser of input: said once, for the fuzzer and for the replay of its corpus.

use termtrace::input::{Input, PASTE_PATIENCE, Parser};

/// Panics if a law is broken for these bytes, of which the first says how the rest is split.
pub(crate) fn hold_for(data: &[u8]) {
    let Some((&seed, bytes)) = data.split_first() else {
        return;
    };
    let whole = events(&[bytes]);
    let pieces = split(seed, bytes);
    assert!(events(&pieces) == whole, "split as {pieces:?}");
    keys_come_again(&pieces);
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

fn events(pieces: &[&[u8]]) -> Vec<Input> {
    let (mut parser, mut out) = (Parser::new(), Vec::new());
    for piece in pieces {
        parser.feed(piece, &mut out);
    }
    out
}

/// Gives up after each piece, and asks in the end that a key is still a key.
fn keys_come_again(pieces: &[&[u8]]) {
    let (mut parser, mut out) = (Parser::new(), Vec::new());
    for piece in pieces {
        parser.feed(piece, &mut out);
        parser.give_up_waiting(&mut out);
    }
    for _ in 0..PASTE_PATIENCE {
        parser.give_up_waiting(&mut out);
    }
    assert!(!parser.is_waiting());
    out.clear();
    parser.feed(b"\x03w", &mut out);
    assert_eq!(out, events(&[b"\x03w"]));
}
