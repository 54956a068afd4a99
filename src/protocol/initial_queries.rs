//! The queries sent to a terminal at the start, as one batch, and their replies.
//!
//! The batch ends with the query that every terminal replies to (DA1). Terminals reply in order: once that reply is
//! here, no other reply to the batch follows. The first picture does not wait for it.

use crate::capabilities::{Hints, Replies, SafeQueries, TEST_COLOR};
use crate::input::Reply;

use super::query::{FENCE, Tag};

/// A batch of queries and the answers to it.
#[derive(Clone, Debug, Default)]
pub struct InitialQueries {
    bytes: Vec<u8>,
    replies: Replies,
    /// Whether replies may still arrive.
    open: bool,
}

impl InitialQueries {
    /// Returns the queries for the facts that the picture depends on and the environment leaves
    /// open.
    pub fn needed(hints: &Hints) -> Self {
        let needed = [hints.needs_truecolor_reply(), hints.needs_palette_reply(), hints.needs_block_width_reply()];
        Self::of(hints.safe_queries(), needed)
    }

    /// Returns all queries that the terminal is known to tolerate.
    pub fn all(hints: &Hints) -> Self {
        Self::of(hints.safe_queries(), [hints.allows_color(), true, true])
    }

    fn of(safe_queries: SafeQueries, [truecolor, palette, blocks]: [bool; 3]) -> Self {
        let mut bytes = Vec::new();
        if safe_queries == SafeQueries::None {
            return Self::default();
        }
        // The block first, while nothing else is on the screen; the fence last. Of GNU screen only the cursor position
        // is requested, because it passes device control strings on to the outer terminal, which may print them.
        if blocks {
            bytes.extend_from_slice(BLOCK_WIDTH.as_bytes());
        }
        if safe_queries == SafeQueries::Tmux || safe_queries == SafeQueries::All {
            bytes.extend_from_slice(BACKGROUND);
            bytes.extend_from_slice(SYNCHRONIZED);
            bytes.extend_from_slice(&Tag::FIRST.query());
        }
        if safe_queries == SafeQueries::All {
            bytes.extend_from_slice(MOUSE_AND_KEYBOARD);
            bytes.extend_from_slice(CELL_PIXELS);
            if truecolor {
                bytes.extend(truecolor_query());
            }
            if palette {
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

    /// Returns the answers so far.
    pub fn replies(&self) -> &Replies {
        &self.replies
    }

    /// Returns whether the reply to the fence is outstanding.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Closes the batch and returns whether it was open.
    ///
    /// Called when a later query has been answered, which shows that the reply to the fence is lost.
    pub fn close(&mut self) -> bool {
        std::mem::take(&mut self.open)
    }

    /// Records a reply, and returns whether it ends the batch. Later replies are ignored.
    pub fn take(&mut self, reply: &Reply) -> bool {
        // A reply after the fence belongs to a later query, or is forged.
        if !self.open {
            return false;
        }
        let replies = &mut self.replies;
        match reply {
            Reply::DeviceAttributes(_) => return self.close(),
            // Only the block's query asks for the position; a user's Shift+F3 looks the same and is harmless here.
            Reply::CursorPosition { column, .. } => replies.take_cursor(*column),
            &Reply::Mode { mode, state } => replies.take_mode(mode, state),
            &Reply::CellPixels { width, height } => replies.cell_pixels = Some((width, height)),
            Reply::KeyboardFlags(_) => replies.kitty_keyboard = Some(true),
            Reply::Osc(text) => replies.take_osc(text),
            Reply::Dcs(text) => replies.take_dcs(text),
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

/// Returns the bytes that set a 24-bit background, query the current rendition (DECRQSS of SGR) and
/// reset it.
fn truecolor_query() -> Vec<u8> {
    let crate::color::Srgb8 { r, g, b } = TEST_COLOR;
    format!("\x1b[48;2;{r};{g};{b}m\x1bP$qm\x1b\\\x1b[0m").into_bytes()
}

fn palette_query(index: u8) -> Vec<u8> {
    format!("\x1b]4;{index};?\x1b\\").into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hints(term: &str, colorterm: &str) -> Hints {
        let variable = |name: &str| match name {
            "TERM" => Some(term.to_owned()),
            "COLORTERM" => Some(colorterm.to_owned()),
            _ => None,
        };
        Hints::gather(&variable, &|_| None)
    }

    fn has(queries: &InitialQueries, part: &[u8]) -> bool {
        queries.bytes().windows(part.len()).any(|bytes| bytes == part)
    }

    #[test]
    fn a_batch_ends_with_its_fence_and_holds_one() {
        for term in ["xterm", "tmux-256color", "screen", "linux"] {
            let queries = InitialQueries::all(&hints(term, ""));
            assert!(queries.bytes().ends_with(FENCE) && queries.is_open(), "{term}");
            assert_eq!(queries.bytes().windows(3).filter(|bytes| *bytes == FENCE).count(), 1, "{term}");
        }
    }

    #[test]
    fn each_terminal_gets_the_queries_that_it_understands() {
        let parts: [&[u8]; 7] =
            [b"\x1b[6n", b"\x1b]11;?", b"?2026$p", b"?1006$p", b"\x1b[16t", b"\x1bP$qm", b"\x1b]4;15;?"];
        for (term, expected) in [
            ("xterm", [true; 7]),
            ("tmux-256color", [true, true, true, false, false, false, false]),
            ("screen", [true, false, false, false, false, false, false]),
            ("linux", [true, false, false, false, false, false, false]),
            ("dumb", [false; 7]),
        ] {
            let queries = InitialQueries::all(&hints(term, ""));
            assert_eq!(parts.map(|part| has(&queries, part)), expected, "{term}");
        }
        assert!(InitialQueries::all(&hints("dumb", "")).bytes().is_empty());
    }

    #[test]
    fn known_facts_are_not_queried() {
        let queries = InitialQueries::needed(&hints("xterm", "truecolor"));
        assert!(!has(&queries, b"$qm") && !has(&queries, b"\x1b]4;"));
        assert!(has(&InitialQueries::needed(&hints("xterm", "")), b"$qm"));
        assert!(has(&InitialQueries::needed(&hints("xterm-16color", "")), b"\x1b]4;0;?"));
    }

    #[test]
    fn replies_count_up_to_the_fence() {
        let mut queries = InitialQueries::all(&hints("xterm", ""));
        let replies = [
            Reply::CursorPosition { row: 1, column: 2 },
            Reply::Mode { mode: 2026, state: 2 },
            Reply::KeyboardFlags(0),
            Reply::CellPixels { width: 10, height: 20 },
            Reply::Osc(b"11;rgb:ffff/ffff/ffff".to_vec()),
            Reply::Dcs(b"1$r48;2;1;2;3m".to_vec()),
            Reply::Status(0),
        ];
        for reply in &replies {
            assert!(!queries.take(reply), "{reply:?}");
        }
        assert!(queries.take(&Reply::DeviceAttributes(vec![62])));
        let replies = queries.replies().clone();
        assert_eq!((replies.block_width, replies.synchronized_output), (Some(1), Some(true)));
        assert_eq!((replies.kitty_keyboard, replies.cell_pixels), (Some(true), Some((10, 20))));
        assert_eq!((replies.truecolor, replies.light_background()), (Some(true), Some(true)));
        // Forged, or a reply to another program.
        assert!(!queries.take(&Reply::CursorPosition { row: 1, column: 3 }));
        assert!(!queries.take(&Reply::DeviceAttributes(vec![62])));
        assert_eq!(queries.replies(), &replies);
    }

    #[test]
    fn a_batch_with_a_lost_fence_is_closed_once() {
        let mut queries = InitialQueries::all(&hints("xterm", ""));
        queries.take(&Reply::Mode { mode: 2026, state: 2 });
        assert!(queries.close() && !queries.close() && !queries.is_open());
        assert_eq!(queries.replies().synchronized_output, Some(true));
    }

    #[test]
    fn tags_are_tried_where_modes_are_queried() {
        for (term, expected) in [("xterm", true), ("tmux-256color", true), ("screen", false), ("linux", false)] {
            assert_eq!(has(&InitialQueries::needed(&hints(term, "")), &Tag::FIRST.query()), expected, "{term}");
        }
    }

    #[test]
    fn replies_without_queries_are_ignored() {
        let mut queries = InitialQueries::all(&hints("dumb", ""));
        assert!(!queries.take(&Reply::DeviceAttributes(vec![62])));
        assert!(!queries.take(&Reply::CursorPosition { row: 1, column: 3 }));
        assert_eq!(queries.replies(), &Replies::default());
    }
}
