//! Bracketed pastes: `CSI 200 ~`, any bytes, `CSI 201 ~`.

use crossterm::event::Event;

/// Limit on the bytes of a paste that are kept; the rest is dropped.
// Pastes are not used for anything; they are parsed only so that their text is not read as keys.
pub const MAX_PASTE_BYTES: usize = 1 << 20;

/// Number of timeouts in a row after which an unfinished paste ends: one second, with timeouts of
/// 50 ms.
// More than one, because a slow link delivers a paste with pauses, and the part after a pause, parsed as keys, would
// run commands.
pub const MAX_PASTE_WAITS: u32 = 20;

/// The sequence that ends a paste.
const END: &[u8] = b"\x1b[201~";

/// An unfinished paste.
#[derive(Default)]
pub(super) struct Paste {
    text: Vec<u8>,
    /// Number of bytes of [`END`] that the last bytes have matched.
    matched: usize,
    /// Number of timeouts since the last byte.
    waits: u32,
}

impl Paste {
    /// Appends a byte to the paste. Returns whether the byte completes [`END`], and so the paste.
    pub(super) fn append_and_check_end(&mut self, byte: u8) -> bool {
        // Every byte resets the number of timeouts, because only timeouts in a row end a paste.
        self.waits = 0;
        if byte != END[self.matched] {
            // The partly matched bytes belong to the paste. A new match can begin only at this byte, because ESC occurs
            // in END only at the start.
            self.keep_bytes(&END[..self.matched]);
            self.matched = 0;
        }
        if byte == END[self.matched] {
            self.matched += 1;
        } else {
            self.keep_bytes(&[byte]);
        }
        self.matched == END.len()
    }

    /// Counts a timeout, and returns whether to continue waiting for the end of the paste.
    pub(super) fn survives_timeout(&mut self) -> bool {
        self.waits += 1;
        self.waits < MAX_PASTE_WAITS
    }

    /// Returns the paste as an event and starts a new one.
    pub(super) fn finish(&mut self) -> Event {
        let paste = std::mem::take(self);
        // The conversion is lossy, because the limit on bytes may cut a character in two.
        Event::Paste(String::from_utf8_lossy(&paste.text).into_owned())
    }

    fn keep_bytes(&mut self, bytes: &[u8]) {
        let room = MAX_PASTE_BYTES - self.text.len();
        self.text.extend_from_slice(&bytes[..bytes.len().min(room)]);
    }
}
