//! Bracketed pastes: `CSI 200 ~`, any bytes, `CSI 201 ~`.

use crossterm::event::Event;

/// The most bytes of one paste that are kept; what comes after them is thrown away.
pub const PASTE_LIMIT: usize = 1 << 20;

/// How many waits in a row, with no byte between them, an unfinished paste outlives: on a slow link a paste comes in
/// pieces, and a piece taken for keys would do harm.
pub const PASTE_PATIENCE: u32 = 20;

/// What closes a paste.
const END: &[u8] = b"\x1b[201~";

/// A paste on its way.
#[derive(Default)]
pub(super) struct Paste {
    text: Vec<u8>,
    /// How many bytes of [`END`] have come.
    matched: usize,
    /// How many waits in a row were given up.
    waits: u32,
}

impl Paste {
    /// Takes a byte; whether it ends the paste.
    pub(super) fn ends_with(&mut self, byte: u8) -> bool {
        self.waits = 0;
        if byte != END[self.matched] {
            // END holds one ESC, its first byte: a new match can only begin here.
            self.keep(&END[..self.matched]);
            self.matched = 0;
        }
        if byte == END[self.matched] {
            self.matched += 1;
        } else {
            self.keep(&[byte]);
        }
        self.matched == END.len()
    }

    /// No byte came in time; whether the paste is still waited for.
    pub(super) fn outlives_a_wait(&mut self) -> bool {
        self.waits += 1;
        self.waits < PASTE_PATIENCE
    }

    /// The paste as an event; ready for the next.
    pub(super) fn finish(&mut self) -> Event {
        let paste = std::mem::take(self);
        Event::Paste(String::from_utf8_lossy(&paste.text).into_owned())
    }

    fn keep(&mut self, bytes: &[u8]) {
        let room = PASTE_LIMIT - self.text.len();
        self.text.extend_from_slice(&bytes[..bytes.len().min(room)]);
    }
}
