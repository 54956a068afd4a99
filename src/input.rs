//! Parser of a terminal's bytes: events and replies. Pure: no I/O and no clock.
//!
//! Every source of bytes (a terminal, an SSH channel, a test) is parsed by a [`Parser`]. The user's actions are
//! reported as crossterm's [`Event`], the terminal's answers to queries as [`Reply`]; a reply is never reported as a
//! key. crossterm's own reader is not used: it swallows replies, and it spins when the terminal disappears.
//!
//! ```
//! use crossterm::event::{Event, KeyCode};
//! use termtrace::internals::input::{Input, Parser, Reply};
//!
//! let mut parser = Parser::new();
//! let mut out = Vec::new();
//! parser.feed(b"w\x1b[?62;22c\x1b", &mut out);
//! assert_eq!(out[0], Input::Event(Event::Key(KeyCode::Char('w').into())));
//! assert_eq!(out[1], Input::Reply(Reply::DeviceAttributes(vec![62, 22])));
//!
//! // The Escape key, or the first byte of an arrow key: only a timeout can decide.
//! assert!(parser.is_waiting());
//! parser.give_up_waiting(&mut out);
//! assert_eq!(out[2], Input::Event(Event::Key(KeyCode::Esc.into())));
//! ```
//!
//! # Ambiguities and how they are resolved
//! - **A lone Escape** is undecided until [`Parser::give_up_waiting`] is called. While a reply is outstanding the
//!   caller should wait for a round trip, because the reply's first byte may arrive alone.
//! - **`ESC ESC [ A`** is Alt+Up (rxvt, `PuTTY`, Terminal.app). `ESC ESC [ ? 62 c` is the Escape key and a reply.
//! - **`CSI row ; column R`** is a cursor report, although some terminals send Shift+F3 as `CSI 1 ; 2 R`. F3 itself is
//!   `SS3 R`, `CSI R` or `CSI 13 ~`, and under the kitty protocol only the last.
//! - **An incomplete sequence** (`ESC [`, `ESC O`, `ESC ] 1 1`) is dropped at the timeout. Its rest is dropped as well
//!   if it arrives later, unless it completes a reply, which is then reported. As a consequence Alt+`[` and Alt+O,
//!   which look like such beginnings, are not recognised. Control characters end a sequence, so Ctrl-C always takes
//!   effect.
//! - **Invalid UTF-8, U+FFFD and the C1 controls** are not keys.
//! - **With the kitty keyboard protocol** ([`Parser::set_keys_are_sequences`]) there is no ambiguity: every key is a
//!   sequence, Escape included. A lone `ESC` then starts a sequence. A plain character is typed text, reported as
//!   pressed and released at once, because no release follows.
//! - **A key release** is reported even if its sequence is completed after the timeout: it can only end a movement.
//! - **A paste** ends with its closing sequence, or after [`MAX_PASTE_WAITS`] timeouts in a row. Bytes beyond
//!   [`MAX_PASTE_BYTES`] are dropped.

use crossterm::event::{Event, KeyEvent, KeyEventKind, KeyModifiers};

mod csi;
mod key;
mod mouse;
mod paste;
mod state;
mod reply;
#[cfg(all(test, unit_tests))]
mod tests;
mod token;

use csi::Meaning;
use paste::Paste;
pub use paste::{MAX_PASTE_BYTES, MAX_PASTE_WAITS};
pub use reply::Reply;
use state::{State, Text};
use token::{Token, Tokeniser};

/// Limit on the bytes of an OSC, DCS or APC string. A longer string is dropped as a whole.
// A truncated reply would be a wrong one. The longest reply that is used has about 40 bytes; the limit bounds what a
// hostile terminal can make the parser keep.
const MAX_STRING_BYTES: usize = 4096;

/// Limit on the bytes of a CSI or SS3 sequence that are kept.
// The longest useful ones, DA1 replies with all their parameters, have about 40 bytes.
const MAX_SEQUENCE_BYTES: usize = 256;

/// Limit on the bytes that are dropped as the late rest of an incomplete sequence.
// Without it, a lone `ESC [` would swallow everything typed after it.
const MAX_LATE_BYTES: usize = 256;

const ESC: u8 = 0x1b;
const BEL: u8 = 0x07;
// These two abort a sequence or a string, as in the VT100.
const CAN: u8 = 0x18;
const SUB: u8 = 0x1a;

/// An item of parsed input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// A user's action: a key, the mouse, a paste, or a change of the window's focus.
    Event(Event),
    /// The terminal's answer to a query.
    Reply(Reply),
}

impl From<KeyEvent> for Input {
    fn from(key: KeyEvent) -> Self {
        Self::Event(Event::Key(key))
    }
}

/// An incremental parser from bytes to [`Input`].
///
/// The result does not depend on how the bytes are split.
#[derive(Default)]
pub struct Parser {
    tokeniser: Tokeniser,
    state: State,
    /// Whether a second ESC precedes the current sequence.
    ///
    /// It stands for Alt, or for the Escape key if the sequence is not a key.
    escaped: bool,
    /// Whether ESC precedes the current character, so that Alt was held.
    alt: bool,
    /// The bytes of the current sequence or string, up to its limit.
    text: Vec<u8>,
    /// Whether the current string exceeds its limit.
    overflow: bool,
    paste: Paste,
    /// Number of late bytes that may still be dropped, after a timeout within a sequence.
    late: Option<usize>,
    key_encoding: KeyEncoding,
}

/// The encoding of keys.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum KeyEncoding {
    /// Characters as themselves, Escape as `ESC`, other keys as sequences.
    #[default]
    Legacy,
    /// Every key as a sequence, as the kitty keyboard protocol does with flag 8.
    Sequences,
}

impl Parser {
    /// Returns a parser for the start of a stream.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets whether the terminal sends every key as a sequence and reports releases.
    ///
    /// These are flags 2 and 8 of the kitty keyboard protocol.
    pub fn set_keys_are_sequences(&mut self, keys_are_sequences: bool) {
        self.key_encoding = if keys_are_sequences { KeyEncoding::Sequences } else { KeyEncoding::Legacy };
    }

    /// Parses the next bytes of the stream and appends the completed inputs to `out`.
    pub fn feed(&mut self, bytes: &[u8], out: &mut Vec<Input>) {
        // Byte by byte, so that the result cannot depend on how the bytes are split. Input is rare and short.
        for &byte in bytes {
            self.take(byte, out);
        }
    }

    /// Returns whether more bytes may complete an input.
    ///
    /// This is so after a lone `ESC`, in a sequence, a character or a paste.
    ///
    /// The caller then waits a short time (some 50 ms) for more bytes, and calls [`Parser::give_up_waiting`] if none
    /// arrive.
    pub fn is_waiting(&self) -> bool {
        self.state != State::Ground && self.late.is_none()
    }

    /// Reports a timeout: a lone `ESC` becomes the Escape key, and an incomplete sequence is
    /// dropped.
    ///
    /// Afterwards the parser no longer waits, except for a paste, which ends after [`MAX_PASTE_WAITS`] such calls.
    pub fn give_up_waiting(&mut self, out: &mut Vec<Input>) {
        // Called too late by a driver, bytes may have completed the sequence in the meantime.
        if !self.is_waiting() {
            return;
        }
        self.release_escape(out);
        match self.state {
            State::Escape if self.key_encoding == KeyEncoding::Legacy => {
                out.push(key::escape().into());
                self.reset();
            }
            State::Escape | State::Ss3 | State::Csi | State::Text(_) | State::TextEscape(_) => {
                self.late = Some(MAX_LATE_BYTES);
            }
            // A paste is not ended by a single pause, as a sequence is.
            State::Paste if self.paste.survives_timeout() => {}
            State::Paste => self.finish_paste(out),
            _ => self.reset(),
        }
    }

    fn take(&mut self, byte: u8, out: &mut Vec<Input>) {
        if self.late.is_some() && !self.continues_late_sequence(byte) {
            self.reset();
        }
        match self.state {
            State::Ground | State::Character => self.take_plain(byte, out),
            State::Escape => self.take_after_escape(byte, out),
            State::Ss3 => self.take_ss3(byte, out),
            State::Csi => self.take_csi(byte, out),
            State::LinuxFunction => self.take_linux_function(byte, out),
            State::OldMouse => self.take_old_mouse(byte, out),
            State::Text(kind) => self.take_text(kind, byte, out),
            State::TextEscape(kind) => self.take_text_escape(kind, byte, out),
            State::Paste if self.paste.ends_with(byte) => self.finish_paste(out),
            State::Paste => {}
        }
    }

    /// Returns whether `byte` may belong to the rest of a sequence dropped at a timeout, and counts
    /// it if so.
    fn continues_late_sequence(&mut self, byte: u8) -> bool {
        let Some(left @ 1..) = self.late else {
            return false;
        };
        // Counted, so that a terminal cannot keep the parser in this state for ever.
        self.late = Some(left - 1);
        match self.state {
            // Any other byte after ESC would be Alt with a key, and is more likely a key typed later.
            State::Escape => matches!(byte, b'[' | b'O' | b']' | b'P' | b'_'),
            // The first byte decides: typed letters do not begin a reply.
            State::Text(kind) if self.text.is_empty() => kind.begins_with(byte),
            State::Text(_) => byte >= 0x20 || byte == BEL || byte == ESC,
            State::TextEscape(_) => byte == b'\\',
            _ => byte >= 0x20,
        }
    }

    /// Returns to the ground state and drops everything incomplete.
    fn reset(&mut self) {
        self.tokeniser = Tokeniser::default();
        self.forget_sequence();
    }

    /// Returns to the ground state after a complete sequence.
    fn forget_sequence(&mut self) {
        self.state = State::Ground;
        self.escaped = false;
        self.alt = false;
        self.overflow = false;
        self.late = None;
        self.text.clear();
    }

    /// Drops everything incomplete and parses `byte` in the ground state.
    fn drop_and_parse(&mut self, byte: u8, out: &mut Vec<Input>) {
        self.release_escape(out);
        self.reset();
        self.take_plain(byte, out);
    }

    /// Reports the ESC before the current sequence as the Escape key, if it has been held back.
    fn release_escape(&mut self, out: &mut Vec<Input>) {
        if std::mem::take(&mut self.escaped) {
            out.push(key::escape().into());
        }
    }

    /// Appends a byte to the current sequence or string, unless it has reached `limit`.
    fn keep(&mut self, byte: u8, limit: usize) {
        if self.text.len() < limit {
            self.text.push(byte);
        } else {
            self.overflow = true;
        }
    }

    fn take_plain(&mut self, byte: u8, out: &mut Vec<Input>) {
        // Kept from the tokeniser, which would continue over it.
        if byte == ESC {
            // An incomplete character is dropped.
            self.reset();
            self.state = State::Escape;
            return;
        }
        let tokens = self.tokeniser.take(byte, &[]);
        // A leading byte never completes a character; a continuation byte does if the tokeniser returns a token.
        let unfinished = match byte {
            0xc2..=0xf4 => true,
            0x80..=0xbf => tokens.is_empty(),
            _ => false,
        };
        self.state = if unfinished { State::Character } else { State::Ground };
        for token in tokens {
            let alt = std::mem::take(&mut self.alt);
            self.report_plain(&token, alt, out);
        }
    }

    fn take_after_escape(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            // Alt with a key in rxvt, PuTTY and Terminal.app. With keys as sequences no terminal sends it for a key.
            ESC => {
                self.release_escape(out);
                self.escaped = self.key_encoding == KeyEncoding::Legacy;
            }
            b'[' => {
                self.tokeniser.begin_csi();
                self.state = State::Csi;
            }
            b'O' => self.state = State::Ss3,
            b']' => self.state = State::Text(Text::Osc),
            b'P' => self.state = State::Text(Text::Dcs),
            b'_' => self.state = State::Text(Text::Apc),
            // Never replies, but their text must not be taken for keys.
            b'X' | b'^' => self.state = State::Text(Text::Other),
            _ => {
                self.release_escape(out);
                self.alt = true;
                self.take_plain(byte, out);
            }
        }
    }

    fn take_ss3(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            b'0'..=b'9' | b';' => self.keep(byte, MAX_SEQUENCE_BYTES),
            0x20..=0x7e => {
                let meaning = key::from_ss3(&self.text, byte).map_or(Meaning::Nothing, Meaning::Key);
                self.finish(meaning, out);
            }
            _ => self.drop_and_parse(byte, out),
        }
    }

    fn take_csi(&mut self, byte: u8, out: &mut Vec<Input>) {
        if matches!(byte, ESC | CAN | SUB) {
            return self.drop_and_parse(byte, out);
        }
        if (0x20..=0x7e).contains(&byte) {
            self.keep(byte, MAX_SEQUENCE_BYTES);
        }
        let mut meaning = None;
        for token in self.tokeniser.take(byte, &self.text) {
            match token {
                Token::Csi(csi) => meaning = Some(csi),
                other => self.report_plain(&other, false, out),
            }
        }
        if (0x40..=0x7e).contains(&byte) {
            // The tokeniser returns no token for a malformed sequence, which must end nevertheless.
            self.finish(meaning.unwrap_or(Meaning::Nothing), out);
        }
    }

    fn take_linux_function(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            b'A'..=b'E' => self.finish(Meaning::Key(key::function(byte - b'A' + 1)), out),
            0x20..=0x7e => self.finish(Meaning::Nothing, out),
            _ => self.drop_and_parse(byte, out),
        }
    }

    fn take_old_mouse(&mut self, byte: u8, out: &mut Vec<Input>) {
        // Coordinates start at 32: a control character means that the report was cut off.
        if byte < 0x20 {
            return self.drop_and_parse(byte, out);
        }
        self.keep(byte, MAX_SEQUENCE_BYTES);
        if let [button, column, row] = self.text[..] {
            let event = mouse::from_bytes(button, column, row);
            self.finish(event.map_or(Meaning::Nothing, Meaning::Event), out);
        }
    }

    fn take_text(&mut self, kind: Text, byte: u8, out: &mut Vec<Input>) {
        match byte {
            ESC => {
                self.late = None;
                self.state = State::TextEscape(kind);
            }
            // xterm's own terminator of OSC, used by most terminals in replies to queries that were ended by it.
            BEL if kind == Text::Osc => self.finish_text(kind, out),
            CAN | SUB => self.drop_and_parse(byte, out),
            // Strings from terminals contain no control characters.
            0..0x20 => {}
            _ => self.keep(byte, MAX_STRING_BYTES),
        }
    }

    fn take_text_escape(&mut self, kind: Text, byte: u8, out: &mut Vec<Input>) {
        if byte == b'\\' {
            return self.finish_text(kind, out);
        }
        // The string was aborted; the ESC starts something else.
        self.release_escape(out);
        self.reset();
        self.state = State::Escape;
        self.take_after_escape(byte, out);
    }

    fn finish_text(&mut self, kind: Text, out: &mut Vec<Input>) {
        let text = std::mem::take(&mut self.text);
        let meaning = match kind {
            // Part of a reply may be wrong: a colour without its last digits is another colour.
            _ if self.overflow => Meaning::Nothing,
            Text::Osc => Meaning::Reply(Reply::Osc(text)),
            Text::Dcs => Meaning::Reply(Reply::Dcs(text)),
            Text::Apc => Meaning::Reply(Reply::Apc(text)),
            Text::Other => Meaning::Nothing,
        };
        self.finish(meaning, out);
    }

    fn finish_paste(&mut self, out: &mut Vec<Input>) {
        out.push(Input::Event(self.paste.finish()));
        self.forget_sequence();
    }

    /// Reports the meaning of a complete sequence and enters the state that follows it.
    fn finish(&mut self, meaning: Meaning, out: &mut Vec<Input>) {
        let late = self.late.is_some();
        if let Meaning::Key(mut key) = meaning {
            // Only keys can carry Alt. Before anything else the first ESC was the Escape key.
            if self.escaped {
                key.modifiers |= KeyModifiers::ALT;
            }
            self.forget_sequence();
            if !late || key.kind == KeyEventKind::Release {
                out.push(key.into());
            }
            return;
        }
        if meaning != Meaning::LinuxFunction {
            self.release_escape(out);
        }
        let escaped = self.escaped;
        self.forget_sequence();
        match meaning {
            Meaning::Reply(reply) => out.push(Input::Reply(reply)),
            // The rest of a mouse report that was given up may be of a click seconds ago.
            Meaning::Event(event) if !late => out.push(Input::Event(event)),
            Meaning::PasteStart => self.state = State::Paste,
            Meaning::OldMouse => self.state = State::OldMouse,
            Meaning::LinuxFunction => {
                self.escaped = escaped;
                self.state = State::LinuxFunction;
            }
            Meaning::Event(_) | Meaning::Key(_) | Meaning::Nothing => {}
        }
    }

    fn report_plain(&self, token: &Token, alt: bool, out: &mut Vec<Input>) {
        let Some(mut key) = plain_key(token) else { return };
        if alt {
            key.modifiers |= KeyModifiers::ALT;
        }
        out.push(key.into());
        // Typed text has no release of its own: the key would be held for ever.
        if self.key_encoding == KeyEncoding::Sequences {
            key.kind = KeyEventKind::Release;
            out.push(key.into());
        }
    }
}

/// Returns the key of a character or control character, if there is one.
fn plain_key(token: &Token) -> Option<KeyEvent> {
    match *token {
        Token::Print(c) => key::from_char(c),
        Token::Control(byte) => key::from_control(byte),
        Token::Csi(_) => None,
    }
}
