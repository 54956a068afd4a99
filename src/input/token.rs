//! The tokeniser: `vte`, fed one byte at a time.
//!
//! It cuts UTF-8 into characters and CSI sequences into numbers. It is given nothing else. Not a lone ESC: it takes ESC
//! and a control letter, a DEL or an umlaut for a sequence still going on, where a person pressed Alt and a key. Not
//! `ESC O`: it dispatches that, and then prints the letter. No strings: it keeps them without limit.

use vte::{Params, Perform};

use super::csi::{self, Meaning};

/// What one byte finished.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Token {
    /// A character; U+FFFD for bytes that are none.
    Print(char),
    /// A control letter.
    Control(u8),
    /// A CSI sequence.
    Csi(Meaning),
}

/// `vte`'s parser. To make it forget what it has begun, make a new one: it has no other way to be told.
#[derive(Default)]
pub(super) struct Tokeniser(vte::Parser);

impl Tokeniser {
    /// Stands after `ESC [`.
    pub(super) fn begin_csi(&mut self) {
        self.0.advance(&mut Listener { said: Vec::new(), text: &[] }, b"\x1b[");
    }

    /// What `byte` finishes: two things at most, where it also shows that the bytes before it were no character.
    /// `text` is what has come since `ESC [`, with this byte.
    pub(super) fn take(&mut self, byte: u8, text: &[u8]) -> Vec<Token> {
        let mut listener = Listener { said: Vec::new(), text };
        self.0.advance(&mut listener, &[byte]);
        listener.said
    }
}

struct Listener<'a> {
    said: Vec<Token>,
    text: &'a [u8],
}

impl Perform for Listener<'_> {
    fn print(&mut self, c: char) {
        self.said.push(Token::Print(c));
    }

    fn execute(&mut self, byte: u8) {
        self.said.push(Token::Control(byte));
    }

    fn csi_dispatch(&mut self, params: &Params, marks: &[u8], ignored: bool, last: char) {
        let meaning = csi::meaning(params, marks, ignored, last, self.text);
        self.said.push(Token::Csi(meaning));
    }
}
