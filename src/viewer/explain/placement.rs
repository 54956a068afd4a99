//! The areas of the explanation's cursor and panel on the screen. Neither covers the explained
//! pixel.

use super::ExplainPanel;
use crate::capabilities::CellMode;
use crate::explain::MAX_LINE_WIDTH;
use crate::viewer::theme::Theme;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;

/// Width of the panel, with its border and a blank on each side.
const PANEL_WIDTH: u16 = MAX_LINE_WIDTH as u16 + 4;

/// Rows at the bottom of the screen that stay free, for notes and legends.
const RESERVED_ROWS: u16 = 1;

/// Least and greatest height of the inset within the panel, in rows.
// With fewer rows the letters o, q and p of the drawing overlap; more rows would show nothing more and leave the text
// less room. The last row is the legend.
const INSET_HEIGHT: [u16; 2] = [7, 17];

/// Returns the panel's area, on the half of the screen that does not contain the cell at this
/// column and row.
pub(super) fn panel_area(screen: Rect, [column, row]: [u16; 2]) -> Rect {
    let (middle, height) = (screen.width / 2, screen.height.saturating_sub(RESERVED_ROWS));
    // Half the screen must be wider than the panel by a column, for the cursor's mark beside the cell.
    if middle > PANEL_WIDTH {
        let x = if column < middle { screen.width - PANEL_WIDTH } else { 0 };
        return Rect::new(x, 0, PANEL_WIDTH, height);
    }
    // On a narrow screen the panel lies above or below the cell.
    let (half, width) = (screen.height / 2, PANEL_WIDTH.min(screen.width));
    let x = (screen.width - width) / 2;
    if row < half { Rect::new(x, half + 1, width, height - half - 1) } else { Rect::new(x, 0, width, half - 1) }
}

/// Splits the panel's inside into the areas of the text, of `lines` lines, and of the inset below
/// the text.
///
/// The inset's area is empty if there is no room for it.
pub(super) fn split_panel(inside: Rect, lines: u16) -> [Rect; 2] {
    let [least, most] = INSET_HEIGHT;
    // The inset is left out if the whole text fits into the panel without the inset, but not with it. A text that fits
    // in neither case has to be scrolled anyway, and gets an inset.
    let fits_alone = (lines..=lines + least).contains(&inside.height);
    let inset = if inside.height < 2 * least || fits_alone {
        0
    } else {
        inside.height.saturating_sub(lines + 1).clamp(least, most)
    };
    let text = Rect { height: inside.height - inset - u16::from(inset > 0), ..inside };
    [text, Rect { y: inside.bottom() - inset, height: inset, ..inside }]
}

/// Returns the cursor as one-cell buffers beside, above and below the explained cell, which itself
/// stays uncovered.
pub(super) fn cursor_marks(explaining: &ExplainPanel, theme: Theme, mode: CellMode, screen: Rect) -> Vec<Buffer> {
    let [column, row] = explaining.cell(mode);
    let [beside, above] = match explaining.row_in_cell(mode) {
        _ if !mode.glyphs.has_blocks() => [[">", "<"], ["v", "^"]],
        // A half block marks the half of the cell in which the pixel is.
        (row, rows) if 2 * row < rows => [["▀", "▀"], ["│", "│"]],
        _ => [["▄", "▄"], ["│", "│"]],
    };
    let mut marks = Vec::new();
    let mut mark = |x: Option<u16>, y: Option<u16>, symbol: &str| {
        if let (Some(x), Some(y)) = (x, y)
            && screen.contains((x, y).into())
        {
            let mut buffer = Buffer::empty(Rect::new(x, y, 1, 1));
            buffer.set_string(x, y, symbol, theme.mark());
            marks.push(buffer);
        }
    };
    mark(column.checked_sub(1), Some(row), beside[0]);
    mark(column.checked_add(1), Some(row), beside[1]);
    mark(Some(column), row.checked_sub(1), above[0]);
    mark(Some(column), row.checked_add(1), above[1]);
    marks
}

#[cfg(all(test, unit_tests))]
mod tests;
