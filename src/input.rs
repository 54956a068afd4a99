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
//! parser.time_out(&mut out);
//! assert_eq!(out[2], Input::Event(Event::Key(KeyCode::Esc.into())));
//! ```
//!
//! # Ambiguities and how they are resolved
//! - **A lone Escape** is undecided until [`Parser::time_out`] is called. While a reply is outstanding the
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
use state::{ControlString, ParserState};
use token::{InputToken, Tokeniser};

/// Limit on the bytes of an OSC, DCS or APC string. A longer string is dropped as a whole.
// Longer strings are not truncated, because a truncated reply could have another meaning. The longest reply in use has
// about 40 bytes; the limit bounds the memory that a hostile terminal can make the parser use.
const MAX_STRING_BYTES: usize = 4096;

/// Limit on the bytes of a CSI or SS3 sequence that are kept.
// The longest useful sequences, DA1 replies with all their parameters, have about 40 bytes.
const MAX_SEQUENCE_BYTES: usize = 256;

/// Limit on the bytes that are dropped as the late rest of a sequence that was incomplete at a
/// timeout.
// Without this limit, a lone `ESC [` would swallow everything typed after it.
const MAX_LATE_BYTES: usize = 256;

const ESC: u8 = 0x1b;
const BEL: u8 = 0x07;
// Control characters that abort a sequence or a string, as in the VT100.
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
/// The inputs do not depend on how the bytes are split into calls of [`feed`](Self::feed).
#[derive(Default)]
pub struct Parser {
    tokeniser: Tokeniser,
    state: ParserState,
    /// Whether an additional ESC precedes the current sequence.
    ///
    /// The additional ESC means Alt if the sequence is a key; otherwise it is reported as the Escape key.
    escaped: bool,
    /// Whether an ESC precedes the current character, which means that Alt was held.
    alt: bool,
    /// The bytes of the current sequence or string, up to its limit.
    text: Vec<u8>,
    /// Whether the current string exceeds its limit.
    overflow: bool,
    paste: Paste,
    /// The number of bytes that may still be dropped as the rest of a timed-out sequence.
    ///
    /// `None` if no sequence has timed out.
    late: Option<usize>,
    key_encoding: KeyEncoding,
}

/// The encoding in which the terminal sends keys.
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
        // One byte at a time, so that the result cannot depend on how the bytes are split. Speed does not matter: input
        // is rare and short.
        for &byte in bytes {
            self.take_byte(byte, out);
        }
    }

    /// Returns whether an input is incomplete: after a lone `ESC`, or within a sequence, character
    /// or paste.
    ///
    /// The caller then waits a short time (some 50 ms) for more bytes, and calls [`Parser::time_out`] if none
    /// arrive.
    pub fn is_waiting(&self) -> bool {
        self.state != ParserState::Ground && self.late.is_none()
    }

    /// Reports a timeout: a lone `ESC` becomes the Escape key, and an incomplete sequence is
    /// dropped.
    ///
    /// Afterwards the parser no longer waits, except for a paste, which ends after [`MAX_PASTE_WAITS`] such calls.
    pub fn time_out(&mut self, out: &mut Vec<Input>) {
        // If the caller was late, bytes may have completed the sequence in the meantime.
        if !self.is_waiting() {
            return;
        }
        self.release_escape(out);
        match self.state {
            ParserState::Escape if self.key_encoding == KeyEncoding::Legacy => {
                out.push(key::escape_key().into());
                self.reset();
            }
            ParserState::Escape
            | ParserState::Ss3
            | ParserState::Csi
            | ParserState::ControlString(_)
            | ParserState::ControlStringEscape(_) => {
                self.late = Some(MAX_LATE_BYTES);
            }
            // A paste ends only after several timeouts in a row, whereas a sequence ends at the first.
            ParserState::Paste if self.paste.survives_timeout() => {}
            ParserState::Paste => self.finish_paste(out),
            _ => self.reset(),
        }
    }

    fn take_byte(&mut self, byte: u8, out: &mut Vec<Input>) {
        if self.late.is_some() && !self.continues_late_sequence(byte) {
            self.reset();
        }
        match self.state {
            ParserState::Ground | ParserState::Character => self.take_plain(byte, out),
            ParserState::Escape => self.take_after_escape(byte, out),
            ParserState::Ss3 => self.take_ss3(byte, out),
            ParserState::Csi => self.take_csi(byte, out),
            ParserState::LinuxFunction => self.take_linux_function(byte, out),
            ParserState::OldMouse => self.take_old_mouse(byte, out),
            ParserState::ControlString(kind) => self.take_control_string(kind, byte, out),
            ParserState::ControlStringEscape(kind) => self.take_control_string_escape(kind, byte, out),
            ParserState::Paste if self.paste.append_and_check_end(byte) => self.finish_paste(out),
            ParserState::Paste => {}
        }
    }

    /// Returns whether `byte` may belong to the rest of a sequence dropped at a timeout, and counts
    /// it if so.
    fn continues_late_sequence(&mut self, byte: u8) -> bool {
        let Some(left @ 1..) = self.late else {
            return false;
        };
        // Dropped bytes are counted, so that a terminal cannot make the parser drop its input for ever.
        self.late = Some(left - 1);
        match self.state {
            // Only a byte that begins a sequence continues a late ESC. Any other byte is more likely a key typed later
            // than one pressed with Alt.
            ParserState::Escape => matches!(byte, b'[' | b'O' | b']' | b'P' | b'_'),
            // The first byte of a string tells a reply from most typed text: an OSC reply begins with a digit, a DCS
            // reply with a byte from 0x20 to 0x3f, and an APC reply with `G`.
            ParserState::ControlString(kind) if self.text.is_empty() => kind.may_begin_with(byte),
            ParserState::ControlString(_) => byte >= 0x20 || byte == BEL || byte == ESC,
            ParserState::ControlStringEscape(_) => byte == b'\\',
            _ => byte >= 0x20,
        }
    }

    /// Drops an incomplete character, sequence or string, and returns to the ground state.
    fn reset(&mut self) {
        self.tokeniser = Tokeniser::default();
        self.forget_sequence();
    }

    /// Returns to the ground state after a complete sequence.
    fn forget_sequence(&mut self) {
        self.state = ParserState::Ground;
        self.escaped = false;
        self.alt = false;
        self.overflow = false;
        self.late = None;
        self.text.clear();
    }

    /// Drops an incomplete sequence or string, and parses `byte` in the ground state.
    fn drop_and_parse(&mut self, byte: u8, out: &mut Vec<Input>) {
        self.release_escape(out);
        self.reset();
        self.take_plain(byte, out);
    }

    /// Reports an additional ESC before the current sequence, if there is one, as the Escape key.
    fn release_escape(&mut self, out: &mut Vec<Input>) {
        if std::mem::take(&mut self.escaped) {
            out.push(key::escape_key().into());
        }
    }

    /// Appends a byte to the current sequence or string, unless that has `limit` bytes already.
    fn keep_byte(&mut self, byte: u8, limit: usize) {
        if self.text.len() < limit {
            self.text.push(byte);
        } else {
            self.overflow = true;
        }
    }

    fn take_plain(&mut self, byte: u8, out: &mut Vec<Input>) {
        // ESC is not passed to the tokeniser, which would continue the sequence after it.
        if byte == ESC {
            // Drops an incomplete UTF-8 character before the ESC.
            self.reset();
            self.state = ParserState::Escape;
            return;
        }
        let tokens = self.tokeniser.advance(byte, &[]);
        // A character of several bytes goes on after its leading byte, and after a continuation byte for which the
        // tokeniser has returned no token.
        let unfinished = match byte {
            0xc2..=0xf4 => true,
            0x80..=0xbf => tokens.is_empty(),
            _ => false,
        };
        self.state = if unfinished { ParserState::Character } else { ParserState::Ground };
        for token in tokens {
            let alt = std::mem::take(&mut self.alt);
            self.report_plain(&token, alt, out);
        }
    }

    fn take_after_escape(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            // `ESC ESC` begins Alt with a key in rxvt, PuTTY and Terminal.app. If all keys are sequences, it never
            // begins a key.
            ESC => {
                self.release_escape(out);
                self.escaped = self.key_encoding == KeyEncoding::Legacy;
            }
            b'[' => {
                self.tokeniser.begin_csi();
                self.state = ParserState::Csi;
            }
            b'O' => self.state = ParserState::Ss3,
            b']' => self.state = ParserState::ControlString(ControlString::Osc),
            b'P' => self.state = ParserState::ControlString(ControlString::Dcs),
            b'_' => self.state = ParserState::ControlString(ControlString::Apc),
            // SOS and PM strings are never replies, but their contents must not be parsed as keys.
            b'X' | b'^' => self.state = ParserState::ControlString(ControlString::Other),
            _ => {
                self.release_escape(out);
                self.alt = true;
                self.take_plain(byte, out);
            }
        }
    }

    fn take_ss3(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            b'0'..=b'9' | b';' => self.keep_byte(byte, MAX_SEQUENCE_BYTES),
            0x20..=0x7e => {
                let meaning = key::from_ss3(&self.text, byte).map_or(Meaning::Nothing, Meaning::Key);
                self.finish_sequence(meaning, out);
            }
            _ => self.drop_and_parse(byte, out),
        }
    }

    fn take_csi(&mut self, byte: u8, out: &mut Vec<Input>) {
        if matches!(byte, ESC | CAN | SUB) {
            return self.drop_and_parse(byte, out);
        }
        if (0x20..=0x7e).contains(&byte) {
            self.keep_byte(byte, MAX_SEQUENCE_BYTES);
        }
        let mut meaning = None;
        for token in self.tokeniser.advance(byte, &self.text) {
            match token {
                InputToken::Csi(csi) => meaning = Some(csi),
                other => self.report_plain(&other, false, out),
            }
        }
        if (0x40..=0x7e).contains(&byte) {
            // The tokeniser returns no token for a malformed sequence, which ends here nevertheless.
            self.finish_sequence(meaning.unwrap_or(Meaning::Nothing), out);
        }
    }

    fn take_linux_function(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            b'A'..=b'E' => self.finish_sequence(Meaning::Key(key::function_key(byte - b'A' + 1)), out),
            0x20..=0x7e => self.finish_sequence(Meaning::Nothing, out),
            _ => self.drop_and_parse(byte, out),
        }
    }

    fn take_old_mouse(&mut self, byte: u8, out: &mut Vec<Input>) {
        // Coordinates start at 32: a control character means that the report was cut off.
        if byte < 0x20 {
            return self.drop_and_parse(byte, out);
        }
        self.keep_byte(byte, MAX_SEQUENCE_BYTES);
        if let [button, column, row] = self.text[..] {
            let event = mouse::from_bytes(button, column, row);
            self.finish_sequence(event.map_or(Meaning::Nothing, Meaning::Event), out);
        }
    }

    fn take_control_string(&mut self, kind: ControlString, byte: u8, out: &mut Vec<Input>) {
        match byte {
            ESC => {
                self.late = None;
                self.state = ParserState::ControlStringEscape(kind);
            }
            // BEL ends an OSC string in xterm, and in most terminals if the query ended with it too.
            BEL if kind == ControlString::Osc => self.finish_text(kind, out),
            CAN | SUB => self.drop_and_parse(byte, out),
            // Control characters do not occur in strings from terminals, and are ignored.
            0..0x20 => {}
            _ => self.keep_byte(byte, MAX_STRING_BYTES),
        }
    }

    fn take_control_string_escape(&mut self, kind: ControlString, byte: u8, out: &mut Vec<Input>) {
        if byte == b'\\' {
            return self.finish_text(kind, out);
        }
        // An ESC without `\` aborts the string and starts another sequence.
        self.release_escape(out);
        self.reset();
        self.state = ParserState::Escape;
        self.take_after_escape(byte, out);
    }

    fn finish_text(&mut self, kind: ControlString, out: &mut Vec<Input>) {
        let text = std::mem::take(&mut self.text);
        let meaning = match kind {
            // A truncated reply is not reported: a colour without its last digits is another colour.
            _ if self.overflow => Meaning::Nothing,
            ControlString::Osc => Meaning::Reply(Reply::Osc(text)),
            ControlString::Dcs => Meaning::Reply(Reply::Dcs(text)),
            ControlString::Apc => Meaning::Reply(Reply::Apc(text)),
            ControlString::Other => Meaning::Nothing,
        };
        self.finish_sequence(meaning, out);
    }

    fn finish_paste(&mut self, out: &mut Vec<Input>) {
        out.push(Input::Event(self.paste.finish()));
        self.forget_sequence();
    }

    /// Reports the meaning of a complete sequence, and enters the next state: usually the ground
    /// state.
    fn finish_sequence(&mut self, meaning: Meaning, out: &mut Vec<Input>) {
        let late = self.late.is_some();
        if let Meaning::Key(mut key) = meaning {
            // An additional ESC before a key means Alt. Before any other sequence it was the Escape key.
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
            // A mouse report that was completed after a timeout is dropped: its click may be seconds old.
            Meaning::Event(event) if !late => out.push(Input::Event(event)),
            Meaning::PasteStart => self.state = ParserState::Paste,
            Meaning::OldMouse => self.state = ParserState::OldMouse,
            Meaning::LinuxFunction => {
                self.escaped = escaped;
                self.state = ParserState::LinuxFunction;
            }
            Meaning::Event(_) | Meaning::Key(_) | Meaning::Nothing => {}
        }
    }

    fn report_plain(&self, token: &InputToken, alt: bool, out: &mut Vec<Input>) {
        let Some(mut key) = plain_key(token) else { return };
        if alt {
            key.modifiers |= KeyModifiers::ALT;
        }
        out.push(key.into());
        // No release follows a plain character, so one is reported at once; otherwise the key would be held for ever.
        if self.key_encoding == KeyEncoding::Sequences {
            key.kind = KeyEventKind::Release;
            out.push(key.into());
        }
    }
}

/// Returns the key of a character or control character; `None` if no key types it.
fn plain_key(token: &InputToken) -> Option<KeyEvent> {
    match *token {
        InputToken::Print(c) => key::from_char(c),
        InputToken::Control(byte) => key::from_control(byte),
        InputToken::Csi(_) => None,
    }
}
