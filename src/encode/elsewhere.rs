//! Changes of the screen that do not come from the encoder.

use super::Encoder;
use super::moves::Place;
use super::pen::Pen;
use crate::grid::Cell;

impl Encoder {
    /// Marks a cell as unknown.
    pub(super) fn forget_cell(&mut self, Place { column, row }: Place) {
        if let Some(known) = &mut self.known {
            *known.shown.cell_mut(column, row) = Cell::FOREIGN;
        }
    }

    /// Resets the pen, so that foreign output does not get its colours.
    pub(super) fn reset_pen(&mut self, bytes: &mut Vec<u8>) {
        if let Some(known) = &mut self.known
            && known.pen != Pen::default()
        {
            known.pen.reset(bytes);
        }
    }

    /// Records that the screen's contents have moved up by this many rows. (Many terminals fill the new rows with the
    /// pen's colour, so the pen must have been reset.)
    pub(super) fn scroll_up(&mut self, rows: u16) {
        if let Some(known) = &mut self.known {
            known.shown.scroll_up(rows);
        }
    }
}
