//! The state of the cursor, and the sequences that change it.

use crate::encode::moves::{CellPosition, Move};
use ratatui_core::layout::Position;

/// The cursor's position and visibility; `None` means unknown, or in a wanted state, unchanged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cursor {
    pub(super) position: Option<Position>,
    pub(super) visible: Option<bool>,
}

impl Cursor {
    /// Appends the sequences that change the cursor to the state `wanted`.
    pub(super) fn switch_to(&mut self, wanted: Self, bytes: &mut Vec<u8>) {
        if let Some(Position { x, y }) = wanted.position
            && self.position != wanted.position
        {
            Move::To(CellPosition { column: x, row: y }).write(bytes);
            self.position = wanted.position;
        }
        if let Some(visible) = wanted.visible
            && self.visible != wanted.visible
        {
            bytes.extend_from_slice(if visible { b"\x1b[?25h" } else { b"\x1b[?25l" });
            self.visible = wanted.visible;
        }
    }
}
