//! The queries sent to a terminal at the start, as one batch, and their replies.
//!
//! The batch ends with the query that every terminal replies to (DA1). Terminals reply in order: once that reply is
//! here, no other reply to the batch follows. The first picture is drawn without waiting for the replies.

use crate::capabilities::{Hints, Replies, SafeQueries, TEST_COLOR};
use crate::input::Reply;

use super::query::{FENCE, Tag};

/// A batch of queries, and the replies that have arrived.
#[derive(Clone, Debug, Default)]
pub struct InitialQueries {
    bytes: Vec<u8>,
    replies: Replies,
    /// Whether replies to the batch may still arrive.
    open: bool,
}

/// A fact that is not always queried.
#[derive(Clone, Copy, PartialEq)]
enum Fact {
    BlockWidth,
    Name,
    Truecolor,
    Palette,
}

impl InitialQueries {
    /// Returns the queries for facts that affect the picture and that `hints` leave unknown.
    pub fn needed(hints: &Hints) -> Self {
        let truecolor = hints.needs_truecolor_reply();
        Self::batch(hints.safe_queries(), |fact| match fact {
            Fact::BlockWidth => hints.needs_block_width_reply(),
            Fact::Name => truecolor || hints.needs_name_reply() || hints.may_shift(),
            Fact::Truecolor => truecolor,
            Fact::Palette => hints.needs_palette_reply(),
        })
    }

    /// Returns all queries that the terminal is known to tolerate.
    pub fn all_safe(hints: &Hints) -> Self {
        Self::batch(hints.safe_queries(), |fact| fact != Fact::Truecolor || hints.allows_color())
    }

    fn batch(safe_queries: SafeQueries, is_needed: impl Fn(Fact) -> bool) -> Self {
        let mut bytes = Vec::new();
        if safe_queries == SafeQueries::None {
            return Self::default();
        }
        // The half block is printed first, while nothing else is on the screen; the fence (DA1) is last. GNU screen is
        // only queried for the cursor position, because it passes device control strings on to the outer terminal,
        // which may print them.
        if is_needed(Fact::BlockWidth) {
            bytes.extend_from_slice(BLOCK_WIDTH.as_bytes());
        }
        if safe_queries == SafeQueries::Tmux || safe_queries == SafeQueries::All {
            bytes.extend_from_slice(BACKGROUND);
            bytes.extend_from_slice(SYNCHRONIZED);
            bytes.extend_from_slice(&Tag::FIRST.query());
        }
        if safe_queries == SafeQueries::All {
            if is_needed(Fact::Name) {
                bytes.extend_from_slice(IDENTITY);
            }
            bytes.extend_from_slice(MOUSE_AND_KEYBOARD);
            bytes.extend_from_slice(CELL_PIXELS);
            if is_needed(Fact::Truecolor) {
                bytes.extend(truecolor_query());
            }
            if is_needed(Fact::Palette) {
                bytes.extend((0..16).flat_map(palette_query));
            }
        }
        bytes.extend_from_slice(FENCE);
        Self { bytes, replies: Replies::default(), open: true }
    }

    /// Returns the bytes of the batch, which end with [`FENCE`]; empty if there are no queries.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns the replies that have arrived so far.
    pub fn replies(&self) -> &Replies {
        &self.replies
    }

    /// Returns whether the reply to the fence is outstanding.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Ends the wait for replies to the batch, and returns whether any were still expected.
    ///
    /// To be called when a later query has been answered, which shows that the reply to the fence is lost.
    pub fn close(&mut self) -> bool {
        std::mem::take(&mut self.open)
    }

    /// Records a reply, and returns whether it ends the batch. Later replies are ignored.
    pub fn take_and_check_end(&mut self, reply: &Reply) -> bool {
        // A reply after that of the fence belongs to a later query, or is forged.
        if !self.open {
            return false;
        }
        let replies = &mut self.replies;
        match reply {
            Reply::DeviceAttributes(_) => return self.close(),
            // The cursor's position is queried only to measure the width of a half block. Shift+F3 is encoded like the
            // reply, but here that key is harmless.
            Reply::CursorPosition { column, .. } => replies.take_cursor(*column),
            &Reply::Mode { mode, state } => replies.take_mode(mode, state),
            &Reply::CellPixels { width, height } => replies.cell_pixels = Some((width, height)),
            Reply::KeyboardFlags(_) => replies.kitty_keyboard = Some(true),
            Reply::Osc(text) => replies.take_osc(text),
            Reply::Dcs(text) => replies.take_dcs(text),
            Reply::SecondaryAttributes(attributes) => replies.take_secondary_attributes(attributes),
            _ => {}
        }
        false
    }
}

/// Prints a half block in the corner, requests the cursor position (CPR), and erases the row: the
/// column in the reply gives the block's width.
const BLOCK_WIDTH: &str = "\x1b[H▄\x1b[6n\r\x1b[K";
const BACKGROUND: &[u8] = b"\x1b]11;?\x1b\\";
const SYNCHRONIZED: &[u8] = b"\x1b[?2026$p";
const MOUSE_AND_KEYBOARD: &[u8] = b"\x1b[?1006$p\x1b[?1016$p\x1b[?u";
const CELL_PIXELS: &[u8] = b"\x1b[16t";
/// The queries for the terminal's name and version (XTVERSION), and its type and version (DA2).
const IDENTITY: &[u8] = b"\x1b[>q\x1b[>c";

/// Returns the bytes that set a 24-bit background, query the current SGR attributes (DECRQSS), and
/// reset them.
fn truecolor_query() -> Vec<u8> {
    let crate::color::Srgb8 { r, g, b } = TEST_COLOR;
    format!("\x1b[48;2;{r};{g};{b}m\x1bP$qm\x1b\\\x1b[0m").into_bytes()
}

fn palette_query(index: u8) -> Vec<u8> {
    format!("\x1b]4;{index};?\x1b\\").into_bytes()
}

#[cfg(all(test, unit_tests))]
mod tests;
