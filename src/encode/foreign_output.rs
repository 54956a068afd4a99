//! Updates of the encoder's state for output of the backend or the program that the encoder did not
//! write.

use super::Encoder;
use super::moves::CellPosition;
use crate::grid::Cell;
use std::ops::Range;

impl Encoder {
    /// Marks a shown cell as unknown, so that the next frame writes it.
    pub(super) fn forget_cell(&mut self, CellPosition { column, row }: CellPosition) {
        if let Some(known) = &mut self.known {
            known.shown.set(column, row, &Cell::FOREIGN);
        }
    }

    /// Returns whether the terminal's state is known to the encoder.
    pub(super) fn knows_screen(&self) -> bool {
        self.known.is_some()
    }

    /// Returns whether the terminal shows an approximation of the last wanted grid.
    pub(super) fn is_inexact(&self) -> bool {
        self.known.is_some() && self.due.is_some()
    }

    /// Records that the contents of `region` have moved up by `line_count` rows.
    // The pen must be reset before the scrolling, because many terminals fill the new rows with its background colour.
    pub(super) fn scroll_up(&mut self, region: Range<u16>, line_count: u16) {
        if let Some(known) = &mut self.known {
            known.shown.scroll_up(region, line_count);
        }
    }

    /// Records that the contents of `region` have moved down by `line_count` rows.
    #[cfg(feature = "scrolling-regions")]
    pub(super) fn scroll_down(&mut self, region: Range<u16>, line_count: u16) {
        if let Some(known) = &mut self.known {
            known.shown.scroll_down(region, line_count);
        }
    }
}
