//! The tokeniser: the crate `vte`, which is passed one byte at a time.
//!
//! It splits UTF-8 into characters and CSI sequences into parameters. The parser handles everything else itself:
//! - a lone ESC: a control character, DEL or a non-ASCII character after it is Alt with a key, but `vte` does not end
//!   the sequence there;
//! - `ESC O`, which `vte` dispatches at once, so that the letter after it would be printed;
//! - strings, which `vte` keeps without a limit.

use vte::{Params, Perform};

use super::csi::{self, Meaning};

/// A token completed by a byte.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum InputToken {
    /// A character; U+FFFD for invalid bytes.
    Print(char),
    /// A control character.
    Control(u8),
    /// A CSI sequence.
    Csi(Meaning),
}

/// The parser of `vte`. To drop an incomplete sequence, replace it: it has no reset.
#[derive(Default)]
pub(super) struct Tokeniser(vte::Parser);

impl Tokeniser {
    /// Puts the tokeniser into the state after `ESC [`.
    pub(super) fn begin_csi(&mut self) {
        // The caller has not passed the ESC to `vte`, because its meaning depends on the next byte, here `[`.
        self.0.advance(&mut InputTokens { tokens: Vec::new(), csi_bytes: &[] }, b"\x1b[");
    }

    /// Advances the parser by `byte`, and returns the tokens that it completes.
    ///
    /// There are two if the byte also shows that the bytes before it are an invalid character. `csi_bytes` contains the
    /// bytes since `ESC [`, including this one.
    pub(super) fn advance(&mut self, byte: u8, csi_bytes: &[u8]) -> Vec<InputToken> {
        let mut performer = InputTokens { tokens: Vec::new(), csi_bytes };
        self.0.advance(&mut performer, &[byte]);
        performer.tokens
    }
}

/// Collects the tokens that `vte` reports.
struct InputTokens<'a> {
    tokens: Vec<InputToken>,
    csi_bytes: &'a [u8],
}

impl Perform for InputTokens<'_> {
    fn print(&mut self, c: char) {
        self.tokens.push(InputToken::Print(c));
    }

    fn execute(&mut self, byte: u8) {
        self.tokens.push(InputToken::Control(byte));
    }

    fn csi_dispatch(&mut self, params: &Params, marks: &[u8], ignored: bool, last: char) {
        let meaning = csi::meaning(params, marks, ignored, last, self.csi_bytes);
        self.tokens.push(InputToken::Csi(meaning));
    }
}
