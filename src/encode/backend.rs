//! The encoder as a backend of ratatui: any ratatui program sends its bytes.
//!
//! ratatui says what changes, cell by cell; here that changes a wanted grid, and `flush` sends what the terminal does
//! not show yet, in one write.

use super::Encoder;
use super::moves::{Move, Place};
use crate::grid::{Cell, Grid};
use crate::overlay;
use ratatui_core::backend::{Backend, ClearType, WindowSize};
use ratatui_core::layout::{Position, Rect, Size};
use std::io::{self, Write};
use std::iter;
use std::ops::Range;

/// A [`ratatui_core::backend::Backend`] on any [`Write`], for programs that read their keys elsewhere.
///
/// ```
/// use ratatui::{Terminal, widgets::Gauge};
/// use termtrace::EncoderBackend;
///
/// let mut terminal = Terminal::new(EncoderBackend::new(Vec::new(), (80, 24)))?;
/// terminal.draw(|frame| frame.render_widget(Gauge::default().percent(42), frame.area()))?;
/// assert!(terminal.backend().writer().starts_with(b"\x1b["));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// It never asks the terminal anything. The size is what its owner says ([`new`](Self::new) and
/// [`resize`](Self::resize)); the cursor is where it was last put: by `set_cursor_position`, behind the last cell that
/// was drawn, or down by the lines appended. A program with an inline viewport calls `set_cursor_position` with where
/// the cursor is, before it begins and after a resize.
///
/// What the program has not drawn is left as it is until the program clears it. Clearing is writing blanks, even where
/// they should be already: it mends a screen on which something else has written. The terminal has to be in raw mode.
#[derive(Debug)]
pub struct EncoderBackend<W> {
    writer: W,
    encoder: Encoder,
    wanted: Grid,
    window: WindowSize,
    cursor: Cursor,
    /// The cursor as the terminal has it, as far as that is known.
    shown_cursor: Cursor,
    /// Between `draw` and `flush`: what is said of the cursor goes out with the frame.
    drawing: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Cursor {
    position: Option<Position>,
    visible: Option<bool>,
}

impl<W: Write> EncoderBackend<W> {
    /// For a terminal of that size of which nothing else is known, with the cursor at the top left.
    pub fn new(writer: W, size: impl Into<Size>) -> Self {
        let mut backend = Self {
            writer,
            encoder: Encoder::new(),
            wanted: Grid::new(crate::grid::Size::new(0, 0)),
            window: WindowSize { columns_rows: Size::ZERO, pixels: Size::ZERO },
            cursor: Cursor::default(),
            shown_cursor: Cursor::default(),
            drawing: false,
        };
        backend.resize(size);
        backend
    }

    /// With another encoder, say in another order.
    pub fn with_encoder(mut self, encoder: Encoder) -> Self {
        self.encoder = encoder;
        self.forget();
        self
    }

    /// The terminal has that size now, and may show anything. Its size in pixels is not known any more.
    pub fn resize(&mut self, size: impl Into<Size>) {
        let Size { width, height } = size.into();
        self.window = WindowSize { columns_rows: Size { width, height }, pixels: Size::ZERO };
        self.wanted = Grid::foreign(crate::grid::Size::new(width, height));
        self.move_cursor(self.position());
        self.forget();
    }

    /// The size of the window in pixels, for [`window_size`](Backend::window_size); 0 by 0 until it is said.
    #[doc(hidden)]
    pub fn set_pixels(&mut self, pixels: impl Into<Size>) {
        self.window.pixels = pixels.into();
    }

    /// Where the bytes go.
    #[doc(hidden)]
    pub fn writer(&self) -> &W {
        &self.writer
    }

    /// Where the bytes go, to write something else in between. What changes the screen has to be followed by
    /// [`Terminal::clear`](ratatui_core::terminal::Terminal::clear).
    #[doc(hidden)]
    pub fn writer_mut(&mut self) -> &mut W {
        &mut self.writer
    }

    /// Nothing is known of the screen, and the next flush says it all.
    fn forget(&mut self) {
        self.encoder.forget();
        self.shown_cursor = Cursor::default();
    }

    fn position(&self) -> Position {
        self.cursor.position.unwrap_or_default()
    }

    /// The cursor is on the screen, wherever it is put.
    fn move_cursor(&mut self, to: Position) {
        let Size { width, height } = self.window.columns_rows;
        let inside = Position::new(to.x.min(width.saturating_sub(1)), to.y.min(height.saturating_sub(1)));
        self.cursor.position = Some(inside);
    }

    /// Wants a cell; how many columns it takes. ratatui draws what has changed: where nothing has, it must know of
    /// something else that was drawn there, and the cell is sent again.
    fn draw_cell(&mut self, place: Position, cell: &ratatui_core::buffer::Cell) -> u16 {
        let before = self.wanted.cell(place.x, place.y).clone();
        let columns = overlay::put(&mut self.wanted, place, cell, self.window.columns_rows.width - place.x);
        if *self.wanted.cell(place.x, place.y) == before {
            self.encoder.forget_cell(Place { column: place.x, row: place.y });
        }
        columns
    }

    /// Blanks in these cells, counted row by row from the top.
    fn blank(&mut self, cells: Range<usize>) {
        let columns = usize::from(self.window.columns_rows.width);
        for at in cells.start..cells.end.min(self.wanted.cells().len()) {
            let (column, row) = ((at % columns) as u16, (at / columns) as u16);
            self.wanted.put(column, row, &Cell::BLANK, 1);
            self.encoder.forget_cell(Place { column, row });
        }
    }

    /// What the terminal does not show yet, the cursor included.
    fn unsent(&mut self) -> Vec<u8> {
        self.drawing = false;
        let mut bytes = Vec::new();
        let end = self.encoder.draw(&self.wanted, &mut bytes);
        if bytes.is_empty() {
            self.shown_cursor.become_cursor(self.cursor, &mut bytes);
            return bytes;
        }
        // What the program writes itself has no colours then, nor has the shell's prompt after it.
        self.encoder.reset_pen(&mut bytes);
        self.shown_cursor.position = end.map(|Place { column, row }| Position::new(column, row));
        self.shown_cursor.become_cursor(self.cursor, &mut bytes);
        self.encoder.bracket(0, &mut bytes);
        bytes
    }

    fn send(&mut self) -> io::Result<()> {
        let bytes = self.unsent();
        self.write(&bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.encoder.send(bytes, &mut self.writer).inspect_err(|_| self.shown_cursor = Cursor::default())
    }

    fn set_visible(&mut self, visible: bool) -> io::Result<()> {
        self.cursor.visible = Some(visible);
        if self.drawing {
            return Ok(());
        }
        self.shown_cursor.visible = None;
        self.send()
    }
}

impl Cursor {
    /// Says what differs.
    fn become_cursor(&mut self, wanted: Self, bytes: &mut Vec<u8>) {
        if let Some(Position { x, y }) = wanted.position
            && self.position != wanted.position
        {
            Move::To(Place { column: x, row: y }).write(bytes);
        }
        if let Some(visible) = wanted.visible
            && self.visible != wanted.visible
        {
            bytes.extend_from_slice(if visible { b"\x1b[?25h" } else { b"\x1b[?25l" });
        }
        *self = wanted;
    }
}

impl<W: Write> Backend for EncoderBackend<W> {
    type Error = io::Error;

    /// Sends nothing yet. What a wide character covers is not drawn, even if it is in `content`.
    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a ratatui_core::buffer::Cell)>,
    {
        self.drawing = true;
        let Size { width, height } = self.window.columns_rows;
        let mut covered = Rect::ZERO;
        for (x, y, cell) in content {
            if x >= width || y >= height || covered.contains(Position::new(x, y)) {
                continue;
            }
            let end = x + self.draw_cell(Position::new(x, y), cell);
            covered = Rect::new(x + 1, y, end - x - 1, 1);
            self.move_cursor(Position::new(end, y));
        }
        Ok(())
    }

    fn append_lines(&mut self, lines: u16) -> io::Result<()> {
        // Line feeds depend on where the cursor is.
        self.shown_cursor.position = None;
        let mut bytes = self.unsent();
        let Position { x, y } = self.position();
        let below = self.window.columns_rows.height.saturating_sub(1).saturating_sub(y);
        let scrolled = lines.saturating_sub(below);
        bytes.extend(iter::repeat_n(b'\n', lines.into()));
        self.encoder.scroll_up(scrolled);
        self.wanted.scroll_up(scrolled);
        self.move_cursor(Position::new(x, y.saturating_add(lines)));
        self.shown_cursor.position = self.cursor.position;
        self.write(&bytes)
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        self.set_visible(false)
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        self.set_visible(true)
    }

    /// Where it was last put.
    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.position())
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        if !self.drawing {
            // Something else may have moved it.
            self.shown_cursor.position = None;
        }
        self.move_cursor(position.into());
        self.send()
    }

    fn clear(&mut self) -> io::Result<()> {
        self.clear_region(ClearType::All)
    }

    fn clear_region(&mut self, clear_type: ClearType) -> io::Result<()> {
        if clear_type == ClearType::All {
            self.forget();
        }
        let columns = usize::from(self.window.columns_rows.width);
        let Position { x, y } = self.position();
        let (line, next_line) = (usize::from(y) * columns, (usize::from(y) + 1) * columns);
        let at = line + usize::from(x);
        self.blank(match clear_type {
            ClearType::All => 0..usize::MAX,
            ClearType::AfterCursor => at..usize::MAX,
            ClearType::BeforeCursor => 0..at + 1,
            ClearType::CurrentLine => line..next_line,
            ClearType::UntilNewLine => at..next_line,
        });
        self.send()
    }

    fn size(&self) -> io::Result<Size> {
        Ok(self.window.columns_rows)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(self.window)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.send()?;
        // There may be more than ours in it.
        self.writer.flush()
    }
}
