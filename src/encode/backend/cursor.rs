//! What is said of the cursor.

use crate::encode::moves::{CellPosition, Move};
use ratatui_core::layout::Position;

/// Where the cursor is and whether it is seen; `None`: that is unknown, or nothing is wanted of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cursor {
    pub(super) position: Option<Position>,
    pub(super) visible: Option<bool>,
}

impl Cursor {
    /// Appends what differs from the wanted one.
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
