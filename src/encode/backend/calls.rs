//! The implementation of ratatui's `Backend`.

use super::EncoderBackend;
use ratatui_core::backend::{Backend, ClearType, WindowSize};
use ratatui_core::buffer::Cell;
use ratatui_core::layout::{Position, Rect, Size};
use std::io::{self, Write};

impl<W: Write> Backend for EncoderBackend<W> {
    type Error = io::Error;

    /// Records the drawn cells, except those that a wide glyph covers. `flush` sends them.
    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        self.follow_window()?;
        let Size { width, height } = self.window.columns_rows;
        let mut covered = Rect::ZERO;
        for (x, y, cell) in content {
            if x >= width || y >= height || covered.contains(Position::new(x, y)) {
                continue;
            }
            let end = x + self.draw_cell(Position::new(x, y), cell);
            covered = Rect::new(x + 1, y, end - x - 1, 1);
            self.set_wanted_position(Position::new(end, y));
        }
        self.open_frame();
        Ok(())
    }

    fn append_lines(&mut self, lines: u16) -> io::Result<()> {
        self.follow_window()?;
        self.feed_lines(lines)
    }

    /// Hides the cursor: at once, or if a frame is open, with that frame.
    fn hide_cursor(&mut self) -> io::Result<()> {
        self.set_visible(false)
    }

    /// Shows the cursor: at once, or if a frame is open, with that frame.
    fn show_cursor(&mut self) -> io::Result<()> {
        self.set_visible(true)
    }

    /// Returns the cursor's last position; if it is unknown, the one that the terminal reports.
    fn get_cursor_position(&mut self) -> io::Result<Position> {
        self.follow_window()?;
        self.known_or_queried_position()
    }

    /// Moves the cursor: at once, or if a frame is open, with that frame.
    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        self.set_position(position.into())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, clear_type: ClearType) -> io::Result<()> {
        self.follow_window()?;
        let Position { x, y } = self.known_or_queried_position()?;
        if clear_type == ClearType::All {
            self.forget_screen_and_cursor();
        }
        // Clearing writes blanks over the region, after which the cursor has to return to its position.
        self.set_wanted_position(Position::new(x, y));
        let columns = usize::from(self.window.columns_rows.width);
        let (line, next_line) = (usize::from(y) * columns, (usize::from(y) + 1) * columns);
        let at = line + usize::from(x);
        self.blank_cells(match clear_type {
            ClearType::All => 0..usize::MAX,
            ClearType::AfterCursor => at..usize::MAX,
            ClearType::BeforeCursor => 0..at + 1,
            ClearType::CurrentLine => line..next_line,
            ClearType::UntilNewLine => at..next_line,
        });
        self.send_exactly()
    }

    fn size(&self) -> io::Result<Size> {
        self.ask_size.as_ref().map_or(Ok(self.window.columns_rows), |ask| ask())
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        self.follow_window()?;
        Ok(self.window)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.send_frame()?;
        // Flushed even if the frame was empty, because the program may have written to the writer directly.
        self.writer.flush()
    }

    #[cfg(feature = "scrolling-regions")]
    fn scroll_region_up(&mut self, region: std::ops::Range<u16>, line_count: u16) -> io::Result<()> {
        self.follow_window()?;
        self.scroll(region, line_count, super::regions::ScrollDirection::Up)
    }

    #[cfg(feature = "scrolling-regions")]
    fn scroll_region_down(&mut self, region: std::ops::Range<u16>, line_count: u16) -> io::Result<()> {
        self.follow_window()?;
        self.scroll(region, line_count, super::regions::ScrollDirection::Down)
    }
}
