//! Scrolling some rows of the screen: DECSTBM, SU, SD, and what is within their reach.
//!
//! A region has two rows at least: many terminals pass over the sequence for a region of one, and what comes behind it
//! would scroll the whole screen. ratatui asks for it all the same: to bring the first row of a screen that it fills
//! into the scrollback.

use super::EncoderBackend;
use crate::encode::moves::{CellPosition, Move};
use crate::encode::numbers::write_number;
use std::io::{self, Write};
use std::iter;
use std::ops::Range;

/// Which way the content goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ScrollDirection {
    Up,
    Down,
}

impl<W: Write> EncoderBackend<W> {
    /// Scrolls these rows by so many; blank ones come in. What goes out at the screen's top goes into the scrollback.
    /// The cursor is at the top left afterwards.
    pub(super) fn scroll(&mut self, region: Range<u16>, by: u16, direction: ScrollDirection) -> io::Result<()> {
        let height = self.window.columns_rows.height;
        let end = region.end.min(height);
        let region = region.start.min(end)..end;
        let by = by.min(end - region.start);
        if by == 0 {
            return Ok(());
        }
        let is_first_row_going_out = region == (0..1) && direction == ScrollDirection::Up;
        if region.len() == 1 && height > 1 && !is_first_row_going_out {
            let columns = usize::from(self.window.columns_rows.width);
            self.blank(usize::from(region.start) * columns..usize::from(region.end) * columns);
            return self.send_exactly();
        }
        let mut bytes = self.unsent_bytes();
        if region == (0..height) {
            scroll_screen(height, by, direction, &mut bytes);
        } else if is_first_row_going_out {
            // Down again, without the row that went out.
            scroll_screen(height, 1, ScrollDirection::Up, &mut bytes);
            scroll_screen(height, 1, ScrollDirection::Down, &mut bytes);
        } else {
            scroll_rows(&region, by, direction, &mut bytes);
        }
        self.record_scrolled(region, by, direction);
        self.send(&bytes)
    }
}

/// The whole screen; the cursor ends at the top left. Upwards by line feeds, of which every terminal keeps what goes
/// out.
fn scroll_screen(height: u16, by: u16, direction: ScrollDirection, bytes: &mut Vec<u8>) {
    match direction {
        ScrollDirection::Up => {
            Move::To(CellPosition { column: 0, row: height - 1 }).write(bytes);
            bytes.extend(iter::repeat_n(b'\n', by.into()));
        }
        ScrollDirection::Down => sequence(&[by], b'T', bytes),
    }
    Move::To(CellPosition { column: 0, row: 0 }).write(bytes);
}

/// A part of it; setting and resetting a region both take the cursor to the top left.
fn scroll_rows(region: &Range<u16>, by: u16, direction: ScrollDirection, bytes: &mut Vec<u8>) {
    sequence(&[region.start + 1, region.end], b'r', bytes);
    sequence(&[by], if direction == ScrollDirection::Up { b'S' } else { b'T' }, bytes);
    bytes.extend_from_slice(b"\x1b[r");
}

/// CSI with these numbers.
fn sequence(numbers: &[u16], last: u8, bytes: &mut Vec<u8>) {
    let mut lead: &[u8] = b"\x1b[";
    for &number in numbers {
        bytes.extend_from_slice(lead);
        write_number(number, bytes);
        lead = b";";
    }
    bytes.push(last);
}
