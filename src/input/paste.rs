//! Bracketed pastes: `CSI 200 ~`, any bytes, `CSI 201 ~`.

use crossterm::event::Event;

/// Limit on the bytes of a paste that are kept; the rest is dropped.
// No paste has a meaning here; it is parsed only so that its text is not taken for keys.
pub const MAX_PASTE_BYTES: usize = 1 << 20;

/// Number of timeouts in a row after which an unfinished paste ends: one second of 50 ms each.
// A slow link delivers a paste in pieces, and a piece parsed as keys would run commands.
pub const MAX_PASTE_WAITS: u32 = 20;

/// The sequence that ends a paste.
const END: &[u8] = b"\x1b[201~";

/// An unfinished paste.
#[derive(Default)]
pub(super) struct Paste {
    text: Vec<u8>,
    /// Number of bytes of [`END`] that have matched.
    matched: usize,
    /// Number of timeouts since the last byte.
    waits: u32,
}

impl Paste {
    /// Takes a byte and returns whether it completes the paste.
    pub(super) fn ends_with(&mut self, byte: u8) -> bool {
        // Only consecutive timeouts count: a slow paste makes progress.
        self.waits = 0;
        if byte != END[self.matched] {
            // ESC occurs only as the first byte of END, so a new match can only begin with this byte.
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

    /// Counts a timeout and returns whether to go on waiting for the end.
    pub(super) fn survives_timeout(&mut self) -> bool {
        self.waits += 1;
        self.waits < MAX_PASTE_WAITS
    }

    /// Returns the paste as an event and starts a new one.
    pub(super) fn finish(&mut self) -> Event {
        let paste = std::mem::take(self);
        // Lossy, because the limit may cut a character in two.
        Event::Paste(String::from_utf8_lossy(&paste.text).into_owned())
    }

    fn keep(&mut self, bytes: &[u8]) {
        let room = MAX_PASTE_BYTES - self.text.len();
        self.text.extend_from_slice(&bytes[..bytes.len().min(room)]);
    }
}
