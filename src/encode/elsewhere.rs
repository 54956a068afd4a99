//! What becomes of the screen by other hands than the encoder's.

use super::Encoder;
use super::moves::Place;
use super::pen::Pen;
use crate::grid::Cell;

impl Encoder {
    /// From here on nothing is known of that cell.
    pub(super) fn forget_cell(&mut self, Place { column, row }: Place) {
        if let Some(known) = &mut self.known {
            *known.shown.cell_mut(column, row) = Cell::FOREIGN;
        }
    }

    /// Whatever comes from elsewhere is not to be in our colours.
    pub(super) fn lay_down_pen(&mut self, bytes: &mut Vec<u8>) {
        if let Some(known) = &mut self.known
            && known.pen != Pen::default()
        {
            known.pen.reset(bytes);
        }
    }

    /// The content of the screen moves up by so many rows. (Many terminals fill the rows that come in with the pen's
    /// colour: it has to be laid down.)
    pub(super) fn scroll_up(&mut self, rows: u16) {
        if let Some(known) = &mut self.known {
            known.shown.scroll_up(rows);
        }
    }
}
