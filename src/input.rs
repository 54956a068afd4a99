//! Bytes from a terminal -> events and replies. Pure: no input or output, no clock.
//!
//! Every source of bytes (a terminal, an SSH channel, a test) goes through one [`Parser`]. What a person did comes out
//! as crossterm's [`Event`]; what the terminal answered comes out as a [`Reply`], and a reply is never a key.
//! crossterm's own reader is not used: it swallows replies, and it spins when the terminal disappears.
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
//! // The Escape key, or the first byte of an arrow key? Only time can tell.
//! assert!(parser.is_waiting());
//! parser.give_up_waiting(&mut out);
//! assert_eq!(out[2], Input::Event(Event::Key(KeyCode::Esc.into())));
//! ```
//!
//! # What is ambiguous, and what was chosen
//! - **Escape alone** waits for [`Parser::give_up_waiting`]. The owner of the clock does well to wait longer (a round
//!   trip) while a reply is outstanding, because the reply's first byte may come alone.
//! - **`ESC ESC [ A`** is Alt+Up (rxvt, `PuTTY`, Terminal.app). `ESC ESC [ ? 62 c` is the Escape key and a reply.
//! - **`CSI row ; column R`** is a cursor report, although some terminals send Shift+F3 as `CSI 1 ; 2 R`. F3 itself is
//!   `SS3 R`, `CSI R` or `CSI 13 ~`, and under the kitty protocol only the last.
//! - **Half a sequence** (`ESC [`, `ESC O`, `ESC ] 1 1`) is dropped when the wait is given up, and so is its rest if it
//!   comes after all, unless it completes a reply, which is then reported. So Alt+`[` and Alt+O, which look like
//!   such halves, are not understood. A control letter always gets through: Ctrl-C is never swallowed for long.
//! - **Invalid UTF-8, U+FFFD and the C1 controls** are no keys.
//! - **With the kitty keyboard protocol** ([`Parser::set_keys_are_sequences`]) none of that is ambiguous: every key is a
//!   sequence, Escape too. A lone `ESC` is the beginning of something, and a character that comes as itself is typed
//!   text: pressed and let go at once, for nobody will tell of its release.
//! - **A release** counts however late the end of its sequence comes: it only ever ends something.
//! - **A paste** ends with its closing bracket. Without one it ends after [`PASTE_PATIENCE`] waits in a row given up.
//!   Past [`PASTE_LIMIT`] bytes the rest of it is thrown away.

use crossterm::event::{Event, KeyEvent, KeyEventKind, KeyModifiers};

mod csi;
mod key;
mod mouse;
mod paste;
mod place;
mod reply;
#[cfg(test)]
mod tests;
mod token;

use csi::Meaning;
use paste::Paste;
pub use paste::{PASTE_LIMIT, PASTE_PATIENCE};
use place::{Place, Text};
pub use reply::Reply;
use token::{Token, Tokeniser};

/// The most bytes of one operating-system, device-control or application string that are kept. A longer one is thrown
/// away whole: half an answer would be a wrong answer.
const STRING_LIMIT: usize = 4096;

/// The most bytes of one CSI or SS3 sequence that are kept.
const SEQUENCE_LIMIT: usize = 256;

/// How many bytes may still be swallowed as the rest of a sequence that was given up.
const REST_LIMIT: usize = 256;

const ESC: u8 = 0x1b;
const BEL: u8 = 0x07;
const CAN: u8 = 0x18;
const SUB: u8 = 0x1a;

/// One thing that the bytes said.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// What a person did: a key, the mouse, a paste, the window's focus.
    Event(Event),
    /// What the terminal answered.
    Reply(Reply),
}

impl From<KeyEvent> for Input {
    fn from(key: KeyEvent) -> Self {
        Self::Event(Event::Key(key))
    }
}

/// Turns bytes into [`Input`], however they are split.
#[derive(Default)]
pub struct Parser {
    tokeniser: Tokeniser,
    place: Place,
    /// A second ESC stood before this sequence: Alt, or the Escape key if the sequence turns out to be no key.
    escaped: bool,
    /// ESC came before the character at hand, which is pressed with Alt.
    alt: bool,
    /// The bytes of the sequence or string at hand, up to the limit of each.
    text: Vec<u8>,
    /// The string at hand outgrew its limit.
    overflow: bool,
    /// The paste at hand.
    paste: Paste,
    /// The wait for the end of this sequence was given up: so many bytes of its rest may still be swallowed.
    rest: Option<usize>,
    keys: Keys,
}

/// How the terminal writes keys.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Keys {
    /// Characters as themselves, Escape as `ESC`, others as sequences.
    #[default]
    Plain,
    /// All as sequences.
    Sequences,
}

impl Parser {
    /// A parser at the start of a stream.
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether the terminal writes every key as a sequence: with the flags 2 and 8 of the kitty keyboard protocol, which
    /// tells of releases, too.
    pub fn set_keys_are_sequences(&mut self, keys_are_sequences: bool) {
        self.keys = if keys_are_sequences { Keys::Sequences } else { Keys::Plain };
    }

    /// Takes the next bytes of the stream and appends to `out` what they say.
    pub fn feed(&mut self, bytes: &[u8], out: &mut Vec<Input>) {
        for &byte in bytes {
            self.take(byte, out);
        }
    }

    /// Whether something is begun that more bytes may finish: a lone `ESC`, half a sequence, half a character, a paste.
    ///
    /// The owner of the clock then waits for more bytes only a short time (some 50 ms), and calls
    /// [`Parser::give_up_waiting`] when none came.
    pub fn is_waiting(&self) -> bool {
        self.place != Place::Ground && self.rest.is_none()
    }

    /// Says that no more bytes came in time: a lone `ESC` is the Escape key, and half a sequence is dropped.
    ///
    /// Nothing is waited for afterwards, but for a paste, which outlives [`PASTE_PATIENCE`] such calls.
    pub fn give_up_waiting(&mut self, out: &mut Vec<Input>) {
        if !self.is_waiting() {
            return;
        }
        self.release_escape(out);
        match self.place {
            Place::Escape if self.keys == Keys::Plain => {
                out.push(key::escape().into());
                self.reset();
            }
            Place::Escape | Place::Ss3 | Place::Csi | Place::Text(_) | Place::TextEscape(_) => {
                self.rest = Some(REST_LIMIT);
            }
            Place::Paste if self.paste.outlives_a_wait() => {}
            Place::Paste => self.finish_paste(out),
            _ => self.reset(),
        }
    }

    fn take(&mut self, byte: u8, out: &mut Vec<Input>) {
        if self.rest.is_some() && !self.belongs_to_rest(byte) {
            self.reset();
        }
        match self.place {
            Place::Ground | Place::Character => self.take_plain(byte, out),
            Place::Escape => self.take_after_escape(byte, out),
            Place::Ss3 => self.take_ss3(byte, out),
            Place::Csi => self.take_csi(byte, out),
            Place::LinuxFunction => self.take_linux_function(byte, out),
            Place::OldMouse => self.take_old_mouse(byte, out),
            Place::Text(kind) => self.take_text(kind, byte, out),
            Place::TextEscape(kind) => self.take_text_escape(kind, byte, out),
            Place::Paste if self.paste.ends_with(byte) => self.finish_paste(out),
            Place::Paste => {}
        }
    }

    /// Whether `byte` can be the rest of the sequence that was given up; counts it if so.
    fn belongs_to_rest(&mut self, byte: u8) -> bool {
        let Some(left @ 1..) = self.rest else {
            return false;
        };
        self.rest = Some(left - 1);
        match self.place {
            Place::Escape => matches!(byte, b'[' | b'O' | b']' | b'P' | b'_'),
            Place::Text(kind) if self.text.is_empty() => kind.begins_with(byte),
            Place::Text(_) => byte >= 0x20 || byte == BEL || byte == ESC,
            Place::TextEscape(_) => byte == b'\\',
            _ => byte >= 0x20,
        }
    }

    /// Back to the ground from anywhere, with nothing begun.
    fn reset(&mut self) {
        self.tokeniser = Tokeniser::default();
        self.forget_sequence();
    }

    /// Back to the ground after a whole sequence.
    fn forget_sequence(&mut self) {
        self.place = Place::Ground;
        self.escaped = false;
        self.alt = false;
        self.overflow = false;
        self.rest = None;
        self.text.clear();
    }

    /// What was begun is dropped, and `byte` is taken as if it had not been.
    fn drop_and_take(&mut self, byte: u8, out: &mut Vec<Input>) {
        self.release_escape(out);
        self.reset();
        self.take_plain(byte, out);
    }

    /// The ESC held back before this sequence was the Escape key.
    fn release_escape(&mut self, out: &mut Vec<Input>) {
        if std::mem::take(&mut self.escaped) {
            out.push(key::escape().into());
        }
    }

    /// Keeps a byte of the sequence or string at hand.
    fn keep(&mut self, byte: u8, limit: usize) {
        if self.text.len() < limit {
            self.text.push(byte);
        } else {
            self.overflow = true;
        }
    }

    fn take_plain(&mut self, byte: u8, out: &mut Vec<Input>) {
        if byte == ESC {
            // A half character goes.
            self.reset();
            self.place = Place::Escape;
            return;
        }
        let tokens = self.tokeniser.take(byte, &[]);
        // A leading byte never ends a character; one that follows does when the tokeniser says so.
        let unfinished = match byte {
            0xc2..=0xf4 => true,
            0x80..=0xbf => tokens.is_empty(),
            _ => false,
        };
        self.place = if unfinished { Place::Character } else { Place::Ground };
        for token in tokens {
            let alt = std::mem::take(&mut self.alt);
            self.say_plain(&token, alt, out);
        }
    }

    fn take_after_escape(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            ESC => {
                self.release_escape(out);
                self.escaped = self.keys == Keys::Plain;
            }
            b'[' => {
                self.tokeniser.begin_csi();
                self.place = Place::Csi;
            }
            b'O' => self.place = Place::Ss3,
            b']' => self.place = Place::Text(Text::Osc),
            b'P' => self.place = Place::Text(Text::Dcs),
            b'_' => self.place = Place::Text(Text::Apc),
            b'X' | b'^' => self.place = Place::Text(Text::Other),
            _ => {
                self.release_escape(out);
                self.alt = true;
                self.take_plain(byte, out);
            }
        }
    }

    fn take_ss3(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            b'0'..=b'9' | b';' => self.keep(byte, SEQUENCE_LIMIT),
            0x20..=0x7e => {
                let meaning = key::from_ss3(&self.text, byte).map_or(Meaning::Nothing, Meaning::Key);
                self.finish(meaning, out);
            }
            _ => self.drop_and_take(byte, out),
        }
    }

    fn take_csi(&mut self, byte: u8, out: &mut Vec<Input>) {
        if matches!(byte, ESC | CAN | SUB) {
            return self.drop_and_take(byte, out);
        }
        if (0x20..=0x7e).contains(&byte) {
            self.keep(byte, SEQUENCE_LIMIT);
        }
        let mut meaning = None;
        for token in self.tokeniser.take(byte, &self.text) {
            match token {
                Token::Csi(said) => meaning = Some(said),
                other => self.say_plain(&other, false, out),
            }
        }
        if (0x40..=0x7e).contains(&byte) {
            // The tokeniser keeps silent about a sequence that breaks the grammar.
            self.finish(meaning.unwrap_or(Meaning::Nothing), out);
        }
    }

    fn take_linux_function(&mut self, byte: u8, out: &mut Vec<Input>) {
        match byte {
            b'A'..=b'E' => self.finish(Meaning::Key(key::function(byte - b'A' + 1)), out),
            0x20..=0x7e => self.finish(Meaning::Nothing, out),
            _ => self.drop_and_take(byte, out),
        }
    }

    fn take_old_mouse(&mut self, byte: u8, out: &mut Vec<Input>) {
        if byte < 0x20 {
            return self.drop_and_take(byte, out);
        }
        self.keep(byte, SEQUENCE_LIMIT);
        if let [button, column, row] = self.text[..] {
            let event = mouse::from_bytes(button, column, row);
            self.finish(event.map_or(Meaning::Nothing, Meaning::Event), out);
        }
    }

    fn take_text(&mut self, kind: Text, byte: u8, out: &mut Vec<Input>) {
        match byte {
            ESC => {
                self.rest = None;
                self.place = Place::TextEscape(kind);
            }
            BEL if kind == Text::Osc => self.finish_text(kind, out),
            CAN | SUB => self.drop_and_take(byte, out),
            // No string of a terminal holds a control letter.
            0..0x20 => {}
            _ => self.keep(byte, STRING_LIMIT),
        }
    }

    fn take_text_escape(&mut self, kind: Text, byte: u8, out: &mut Vec<Input>) {
        if byte == b'\\' {
            return self.finish_text(kind, out);
        }
        // The string broke off, and the ESC begins something else.
        self.release_escape(out);
        self.reset();
        self.place = Place::Escape;
        self.take_after_escape(byte, out);
    }

    fn finish_text(&mut self, kind: Text, out: &mut Vec<Input>) {
        let text = std::mem::take(&mut self.text);
        let meaning = match kind {
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

    /// A sequence is whole: says what it means, and goes on from there.
    fn finish(&mut self, meaning: Meaning, out: &mut Vec<Input>) {
        let late = self.rest.is_some();
        if let Meaning::Key(mut key) = meaning {
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
            Meaning::Event(event) if !late => out.push(Input::Event(event)),
            Meaning::PasteStart => self.place = Place::Paste,
            Meaning::OldMouse => self.place = Place::OldMouse,
            Meaning::LinuxFunction => {
                self.escaped = escaped;
                self.place = Place::LinuxFunction;
            }
            Meaning::Event(_) | Meaning::Key(_) | Meaning::Nothing => {}
        }
    }

    fn say_plain(&self, token: &Token, alt: bool, out: &mut Vec<Input>) {
        let Some(mut key) = plain_key(token) else { return };
        if alt {
            key.modifiers |= KeyModifiers::ALT;
        }
        out.push(key.into());
        if self.keys == Keys::Sequences {
            key.kind = KeyEventKind::Release;
            out.push(key.into());
        }
    }
}

/// The key, if any, that a character or a control letter stands for.
fn plain_key(token: &Token) -> Option<KeyEvent> {
    match *token {
        Token::Print(c) => key::from_char(c),
        Token::Control(byte) => key::from_control(byte),
        Token::Csi(_) => None,
    }
}
