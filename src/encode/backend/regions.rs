//! Scrolling of a region of rows: DECSTBM, SU and SD.
//!
//! A region has at least two rows: many terminals ignore DECSTBM for a single row, and the scrolling sequence after it
//! would then scroll the whole screen. ratatui requests a single row nevertheless, to move the first row of a full
//! screen into the scrollback, which is done without a region.

use super::EncoderBackend;
use crate::encode::moves::{CellPosition, Move};
use crate::encode::numbers::write_number;
use std::io::{self, Write};
use std::iter;
use std::ops::Range;

/// The direction in which the contents of a region move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ScrollDirection {
    Up,
    Down,
}

impl<W: Write> EncoderBackend<W> {
    /// Scrolls the rows of a region by `line_count` rows; blank rows are inserted at the other end.
    ///
    /// Rows that leave the screen at its top enter the scrollback. Afterwards the cursor is at the top left, unless the
    /// region is a single row that is only blanked.
    pub(super) fn scroll(&mut self, region: Range<u16>, line_count: u16, direction: ScrollDirection) -> io::Result<()> {
        let height = self.window.columns_rows.height;
        let end = region.end.min(height);
        let region = region.start.min(end)..end;
        let line_count = line_count.min(end - region.start);
        if line_count == 0 {
            return Ok(());
        }
        let is_first_row_going_out = region == (0..1) && direction == ScrollDirection::Up;
        if region.len() == 1 && height > 1 && !is_first_row_going_out {
            let columns = usize::from(self.window.columns_rows.width);
            self.blank_cells(usize::from(region.start) * columns..usize::from(region.end) * columns);
            return self.send_exactly();
        }
        let mut bytes = self.unsent_bytes();
        if region == (0..height) {
            scroll_screen(height, line_count, direction, &mut bytes);
        } else if is_first_row_going_out {
            // Scrolling the screen up moves its first row into the scrollback; scrolling it down again moves the other
            // rows back to their places.
            scroll_screen(height, 1, ScrollDirection::Up, &mut bytes);
            scroll_screen(height, 1, ScrollDirection::Down, &mut bytes);
        } else {
            scroll_rows(&region, line_count, direction, &mut bytes);
        }
        self.record_scrolled(region, line_count, direction);
        self.send(&bytes)
    }
}

/// Appends sequences that scroll the screen by `line_count` rows, and move the cursor to the top
/// left.
// Upwards by line feeds, not by SU: every terminal then moves the rows that leave the screen into the scrollback.
fn scroll_screen(height: u16, line_count: u16, direction: ScrollDirection, bytes: &mut Vec<u8>) {
    match direction {
        ScrollDirection::Up => {
            Move::To(CellPosition { column: 0, row: height - 1 }).write(bytes);
            bytes.extend(iter::repeat_n(b'\n', line_count.into()));
        }
        ScrollDirection::Down => write_sequence(&[line_count], b'T', bytes),
    }
    Move::To(CellPosition { column: 0, row: 0 }).write(bytes);
}

/// Appends sequences that set a region, scroll it by `line_count` rows, and reset the region.
// The cursor ends at the top left, because setting or resetting a region moves it there.
fn scroll_rows(region: &Range<u16>, line_count: u16, direction: ScrollDirection, bytes: &mut Vec<u8>) {
    write_sequence(&[region.start + 1, region.end], b'r', bytes);
    write_sequence(&[line_count], if direction == ScrollDirection::Up { b'S' } else { b'T' }, bytes);
    bytes.extend_from_slice(b"\x1b[r");
}

/// Appends a CSI sequence with the parameters `numbers` and the final byte `last`.
fn write_sequence(numbers: &[u16], last: u8, bytes: &mut Vec<u8>) {
    let mut lead: &[u8] = b"\x1b[";
    for &number in numbers {
        bytes.extend_from_slice(lead);
        write_number(number, bytes);
        lead = b";";
    }
    bytes.push(last);
}
