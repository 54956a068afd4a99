//! The encoder as a backend of ratatui.
//!
//! `draw` records changed cells in a wanted grid, and `flush` sends, in one write, the bytes that make the terminal
//! show it.

mod calls;
mod cursor;
mod limits;
#[cfg(feature = "scrolling-regions")]
mod regions;

use super::moves::CellPosition;
use super::{Encoder, Quality};
use crate::framebuffer::ResolutionError;
use crate::grid::{self, Cell, Grid};
use crate::overlay;
use cursor::Cursor;
use limits::Limits;
use ratatui_core::backend::WindowSize;
use ratatui_core::layout::{Position, Size};
use std::fmt;
use std::io::{self, Write};
use std::ops::Range;
use std::time::Duration;

/// A [`Backend`](ratatui_core::backend::Backend) on any [`Write`], in place of `CrosstermBackend`.
///
/// ```
/// use ratatui::{Terminal, widgets::Gauge};
/// use termtrace::EncoderBackend;
///
/// let mut bytes = Vec::new();
/// let mut terminal = Terminal::new(EncoderBackend::new(&mut bytes, (80, 24)))?;
/// terminal.draw(|frame| frame.render_widget(Gauge::default().percent(42), frame.area()))?;
/// drop(terminal);
/// assert!(bytes.starts_with(b"\x1b["));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// The terminal has to be in raw mode. Cells that the program has not drawn are left alone until it clears them.
/// Clearing writes blanks even over known blanks, which repairs a screen on which another program has written.
///
/// # The size of the window and the position of the cursor
///
/// By itself the backend sends no queries. The size is the one given to [`new`](Self::new), and the cursor is where the
/// backend last left it. With [`sized_by`](Self::sized_by) it calls a function for the size, so that
/// [`Terminal::autoresize`](ratatui_core::terminal::Terminal::autoresize), which each `draw` calls, follows the window.
/// With [`located_by`](Self::located_by) it calls a function for the cursor's position when that is unknown, which an
/// inline viewport needs at its start and after a resize; without it, the program calls `set_cursor_position` then.
///
/// ```no_run
/// use termtrace::EncoderBackend;
///
/// let backend = EncoderBackend::new(std::io::stdout(), crossterm::terminal::size()?)
///     .sized_by(|| Ok(crossterm::terminal::size()?.into()))
///     .located_by(|| Ok(crossterm::cursor::position()?.into()));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Other bytes
///
/// The backend is itself a [`Write`], so `execute!(terminal.backend_mut(), EnterAlternateScreen)` works: the bytes are
/// sent unchanged, after everything drawn before them. As they may do anything, the screen, the colours and the cursor
/// are unknown afterwards, and the backend does not redraw on its own. After `LeaveAlternateScreen`, which brings back
/// the shell's screen, this is correct. Bytes that change the contents of the screen have to be followed by
/// [`Terminal::clear`](ratatui_core::terminal::Terminal::clear), as with any other backend. Bytes that leave a mode
/// changed in which the terminal writes differently (origin mode, insert mode, no wrapping, a character set, a
/// scrolling region) have to be followed by those that reset it before anything is drawn.
///
/// # Scrolling regions
///
/// ratatui's feature `scrolling-regions` adds two methods to the trait of backends, so this backend only compiles if it
/// has them too. As cargo unifies features, one dependency that turns ratatui's feature on is enough to miss them ("not
/// all trait items implemented, missing: `scroll_region_up`, `scroll_region_down`"). Then this crate's feature of the
/// same name has to be on as well:
///
/// ```toml
/// [dependencies]
/// ratatui = { version = "0.30", features = ["scrolling-regions"] }
/// termtrace = { version = "0.1", features = ["scrolling-regions"] }
/// ```
///
/// With it `insert_before` scrolls the rows above an inline viewport, and the viewport is not drawn again.
pub struct EncoderBackend<W> {
    writer: W,
    encoder: Encoder,
    limits: Option<Limits>,
    wanted: Grid,
    window: WindowSize,
    ask_size: Option<SizeOrCursorQuery<Size>>,
    ask_position: Option<SizeOrCursorQuery<Position>>,
    /// The last position of the cursor that was requested or reported.
    position: Position,
    /// The wanted state of the cursor.
    cursor: Cursor,
    /// The cursor's state in the terminal, as far as it is known.
    shown_cursor: Cursor,
    /// Whether a frame is open: between `draw` and `flush`.
    // While a frame is open, changes of the cursor are not sent at once, but in the same write as the frame.
    is_frame_open: bool,
    /// Whether the last bytes sent were written by the program itself.
    wrote_foreign_bytes: bool,
}

/// A function of the program that queries the terminal's size or cursor position.
type SizeOrCursorQuery<T> = Box<dyn Fn() -> io::Result<T> + Send + Sync>;

/// Returns the error for a window with too many cells.
fn invalid_size(error: ResolutionError) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, error)
}

impl<W> EncoderBackend<W> {
    /// Creates a backend for a terminal of this size, about which nothing else is known.
    ///
    /// # Panics
    /// If the terminal has more than 16,777,216 cells.
    pub fn new(writer: W, size: impl Into<Size>) -> Self {
        let mut backend = Self {
            writer,
            encoder: Encoder::new(),
            limits: None,
            wanted: Grid::new(grid::Size::new(0, 0)),
            window: WindowSize { columns_rows: Size::ZERO, pixels: Size::ZERO },
            ask_size: None,
            ask_position: None,
            position: Position::ORIGIN,
            cursor: Cursor::default(),
            shown_cursor: Cursor::default(),
            is_frame_open: false,
            wrote_foreign_bytes: false,
        };
        backend.resize(size);
        backend
    }

    /// Sets the encoder, for instance one that writes the cells in another order.
    ///
    /// ```
    /// use termtrace::{Encoder, EncoderBackend, Order};
    ///
    /// let encoder = Encoder::new().with_order(Order::Color);
    /// let backend = EncoderBackend::new(std::io::stdout(), (80, 24)).with_encoder(encoder);
    /// # drop(backend);
    /// ```
    pub fn with_encoder(mut self, encoder: Encoder) -> Self {
        self.encoder = encoder;
        self.forget_screen_and_cursor();
        self
    }

    /// Sets the quality of pictures of half blocks while they change.
    ///
    /// `clock` returns the time from any fixed start. Text is always exact. From half a second after the last change
    /// on, each frame that is drawn makes a part of the picture exact, so that no single frame is large. A program
    /// that only draws on events also draws when [`due`](Self::due) says so, until that is `None`.
    ///
    /// ```
    /// use ratatui::{Terminal, widgets::Paragraph};
    /// use std::time::Instant;
    /// use termtrace::{EncoderBackend, Quality};
    ///
    /// let start = Instant::now();
    /// let backend = EncoderBackend::new(Vec::new(), (80, 24)).with_quality(Quality::Equal, move || start.elapsed());
    /// let mut terminal = Terminal::new(backend)?;
    /// terminal.draw(|frame| frame.render_widget(Paragraph::new("text is exact"), frame.area()))?;
    /// assert_eq!(terminal.backend().due(), None, "the screen is exact");
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn with_quality(mut self, quality: Quality, clock: impl FnMut() -> Duration + Send + Sync + 'static) -> Self {
        self.limits = Some(Limits::new(quality, Box::new(clock)));
        self
    }

    /// Limits the bytes per second of frames with [`Quality::Equal`] or [`Quality::Fast`].
    ///
    /// Above the limit, the picture cells with the smallest errors wait for a later frame. Text never waits, nor do
    /// cells that replace text or unknown contents. Without [`with_quality`](Self::with_quality) the limit has no
    /// effect.
    ///
    /// ```
    /// use std::time::Instant;
    /// use termtrace::{EncoderBackend, Quality};
    ///
    /// let start = Instant::now();
    /// let backend = EncoderBackend::new(std::io::stdout(), (80, 24));
    /// let backend = backend.with_quality(Quality::Fast, move || start.elapsed()).with_max_rate(50_000);
    /// # drop(backend);
    /// ```
    pub fn with_max_rate(mut self, bytes_per_second: u32) -> Self {
        self.limits = self.limits.map(|limits| limits.with_max_rate(bytes_per_second));
        self
    }

    /// Sets the function that returns the window's size in columns and rows.
    ///
    /// While the window has more than 16,777,216 cells, methods such as `draw` and `clear` return an error. A window
    /// that becomes smaller and large again between two frames goes unnoticed, as with any backend.
    pub fn sized_by(mut self, ask: impl Fn() -> io::Result<Size> + Send + Sync + 'static) -> Self {
        self.ask_size = Some(Box::new(ask));
        self
    }

    /// Sets the function that returns the cursor's column and row, from 0.
    ///
    /// The backend calls it when the position is unknown.
    pub fn located_by(mut self, ask: impl Fn() -> io::Result<Position> + Send + Sync + 'static) -> Self {
        self.ask_position = Some(Box::new(ask));
        self
    }

    /// Sets the size of the window; its contents and its size in pixels are then unknown.
    ///
    /// # Panics
    /// If the window has more than 16,777,216 cells.
    #[doc(hidden)]
    pub fn resize(&mut self, size: impl Into<Size>) {
        let Size { width, height } = size.into();
        self.window = WindowSize { columns_rows: Size { width, height }, pixels: Size::ZERO };
        self.position = self.clamped_to_screen(self.position);
        self.forget_screen();
    }

    /// Sets the size of the window in pixels, which is initially 0 by 0.
    ///
    /// See [`window_size`](ratatui_core::backend::Backend::window_size).
    #[doc(hidden)]
    pub fn set_pixels(&mut self, pixels: impl Into<Size>) {
        self.window.pixels = pixels.into();
    }

    /// Returns the time at which the next frame is due, if nothing else is drawn until then.
    ///
    /// The time is on the clock passed to [`with_quality`](Self::with_quality). `None` means that the screen shows
    /// exactly the drawn cells.
    pub fn due(&self) -> Option<Duration> {
        let limits = self.limits.as_ref()?;
        self.encoder.due().map(|due| limits.due_within_rate(due))
    }

    /// Returns the writer.
    #[doc(hidden)]
    pub fn writer(&self) -> &W {
        &self.writer
    }

    /// Returns the writer, for bytes that change neither the screen nor the colours nor the cursor.
    ///
    /// Examples are bytes that set the title or the clipboard. All others have to be written to the backend itself.
    #[doc(hidden)]
    pub fn writer_mut(&mut self) -> &mut W {
        &mut self.writer
    }

    /// Forgets the state of the screen and of the cursor.
    fn forget_screen_and_cursor(&mut self) {
        self.encoder.forget();
        self.shown_cursor = Cursor::default();
    }

    /// Forgets the screen and all drawn cells, so that the next frame contains only cells drawn
    /// after this call.
    fn forget_screen(&mut self) {
        let Size { width, height } = self.window.columns_rows;
        self.wanted = Grid::foreign(grid::Size::new(width, height));
        self.cursor.position = None;
        self.is_frame_open = false;
        self.forget_screen_and_cursor();
    }

    /// Returns the position on the screen that is nearest to the given one.
    fn clamped_to_screen(&self, Position { x, y }: Position) -> Position {
        let Size { width, height } = self.window.columns_rows;
        Position::new(x.min(width.saturating_sub(1)), y.min(height.saturating_sub(1)))
    }

    /// Sets the wanted position of the cursor, clamped to the screen.
    fn set_wanted_position(&mut self, to: Position) {
        self.position = self.clamped_to_screen(to);
        self.cursor.position = Some(self.position);
    }

    /// Sets a cell of the wanted grid, and returns its width in columns.
    // ratatui draws changed cells only. If it draws a cell that is already wanted, it assumes other contents on the
    // screen, so the cell is sent again.
    fn draw_cell(&mut self, place: Position, cell: &ratatui_core::buffer::Cell) -> u16 {
        let before = self.wanted.cell(place.x, place.y);
        let columns = overlay::put_cell(&mut self.wanted, place, cell, self.window.columns_rows.width - place.x);
        if self.wanted.cell(place.x, place.y) == before {
            self.encoder.forget_cell(CellPosition { column: place.x, row: place.y });
        }
        columns
    }

    /// Opens a frame: changes of the cursor are sent with it.
    fn open_frame(&mut self) {
        self.is_frame_open = true;
    }

    /// Sets the cells at these indices, row by row, to blanks that the next frame sends even over
    /// known blanks.
    fn blank_cells(&mut self, cells: Range<usize>) {
        let columns = usize::from(self.window.columns_rows.width);
        for at in cells.start..cells.end.min(self.wanted.cells().len()) {
            let (column, row) = ((at % columns) as u16, (at / columns) as u16);
            self.wanted.put(column, row, &Cell::BLANK, 1);
            self.encoder.forget_cell(CellPosition { column, row });
        }
    }
}

impl<W: Write> EncoderBackend<W> {
    /// Queries the size of the window, and adopts it if it has changed.
    fn follow_window(&mut self) -> io::Result<()> {
        if let Some(ask) = &self.ask_size {
            let size = ask()?;
            if size != self.window.columns_rows {
                grid::Size::new(size.width, size.height).checked_cell_count().map_err(invalid_size)?;
                self.resize(size);
            }
        }
        Ok(())
    }

    /// Returns the cursor's wanted or shown position; if both are unknown, queries it.
    fn known_or_queried_position(&mut self) -> io::Result<Position> {
        if self.cursor.position.or(self.shown_cursor.position).is_none()
            && let Some(ask) = &self.ask_position
        {
            self.position = self.clamped_to_screen(ask()?);
            self.shown_cursor.position = Some(self.position);
        }
        Ok(self.position)
    }

    /// Returns the bytes that make the terminal show the wanted grid and cursor; exactly, if
    /// `limits` is `None`.
    fn encode_frame(&mut self, limits: Option<&mut Limits>) -> Vec<u8> {
        self.is_frame_open = false;
        let mut bytes = Vec::new();
        let end = match limits {
            Some(limits) => self.encoder.draw_within(&self.wanted, limits.allowance(), &mut bytes),
            None => self.encoder.draw(&self.wanted, &mut bytes),
        };
        if bytes.is_empty() {
            self.shown_cursor.switch_to(self.cursor, &mut bytes);
            return bytes;
        }
        // Reset, so that bytes that the program writes itself, and the shell's prompt later, do not get the pen's
        // colours.
        self.encoder.reset_pen(&mut bytes);
        self.shown_cursor.position = end.position().map(|CellPosition { column, row }| Position::new(column, row));
        self.shown_cursor.switch_to(self.cursor, &mut bytes);
        self.encoder.enclose_in_synchronized(0, &mut bytes);
        bytes
    }

    /// Returns the bytes of an open frame, or of the whole grid if the screen's state is unknown.
    ///
    /// After these bytes the pen has the default colours.
    // Sequences such as scrolling have to come after these bytes, because they fill blank rows with the pen's
    // background, which must be the default one.
    fn unsent_bytes(&mut self) -> Vec<u8> {
        if self.is_frame_open || !self.encoder.knows_screen() { self.encode_frame(None) } else { Vec::new() }
    }

    fn send_frame(&mut self) -> io::Result<()> {
        let mut limits = self.limits.take();
        let bytes = self.encode_frame(limits.as_mut());
        if let Some(limits) = &mut limits {
            limits.record_sent(bytes.len());
        }
        self.limits = limits;
        self.send(&bytes)
    }

    /// Sends all drawn cells that are not sent yet, with exact colours and without a limit.
    fn send_exactly(&mut self) -> io::Result<()> {
        let bytes = self.encode_frame(None);
        self.send(&bytes)
    }

    /// Sends changes of the cursor, unless a frame is open.
    fn send_cursor(&mut self) -> io::Result<()> {
        if self.is_frame_open {
            return Ok(());
        }
        let mut bytes = Vec::new();
        self.shown_cursor.switch_to(self.cursor, &mut bytes);
        self.send(&bytes)
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.wrote_foreign_bytes &= bytes.is_empty();
        self.encoder.send(bytes, &mut self.writer).inspect_err(|_| self.shown_cursor = Cursor::default())
    }

    fn set_visible(&mut self, visible: bool) -> io::Result<()> {
        self.cursor.visible = Some(visible);
        if !self.is_frame_open {
            self.shown_cursor.visible = None;
        }
        self.send_cursor()
    }

    fn set_position(&mut self, position: Position) -> io::Result<()> {
        if !self.is_frame_open {
            // The shown position is forgotten, because other output may have moved the cursor.
            self.shown_cursor.position = None;
        }
        self.set_wanted_position(position);
        self.send_cursor()
    }

    /// Sends `lines` line feeds at the cursor's position.
    ///
    /// Rows that leave the screen at the top enter the scrollback.
    fn feed_lines(&mut self, lines: u16) -> io::Result<()> {
        let Position { x, y } = self.known_or_queried_position()?;
        self.set_wanted_position(Position::new(x, y));
        let mut bytes = self.unsent_bytes();
        self.shown_cursor.switch_to(self.cursor, &mut bytes);
        let height = self.window.columns_rows.height;
        let scrolled = lines.saturating_sub(height.saturating_sub(1).saturating_sub(y));
        bytes.extend(std::iter::repeat_n(b'\n', lines.into()));
        self.encoder.scroll_up(0..height, scrolled);
        self.wanted.scroll_up(0..height, scrolled);
        self.set_wanted_position(Position::new(x, y.saturating_add(lines)));
        self.shown_cursor.position = self.cursor.position;
        self.send(&bytes)
    }

    /// Records that rows `region` were scrolled by `line_count` rows; the cursor is at the top
    /// left.
    #[cfg(feature = "scrolling-regions")]
    fn record_scrolled(&mut self, region: Range<u16>, line_count: u16, direction: regions::ScrollDirection) {
        match direction {
            regions::ScrollDirection::Up => {
                self.encoder.scroll_up(region.clone(), line_count);
                self.wanted.scroll_up(region, line_count);
            }
            regions::ScrollDirection::Down => {
                self.encoder.scroll_down(region.clone(), line_count);
                self.wanted.scroll_down(region, line_count);
            }
        }
        self.position = Position::ORIGIN;
        self.cursor.position = None;
        self.shown_cursor.position = Some(Position::ORIGIN);
    }

    /// Prepares for bytes that the program writes itself: sends all drawn cells, and forgets the
    /// screen.
    fn prepare_foreign_bytes(&mut self) -> io::Result<()> {
        // Cells are sent only before the first of several writes in a row: a program may write an escape sequence in
        // pieces, between which no bytes may come.
        if !self.wrote_foreign_bytes {
            if self.is_frame_open || self.encoder.is_inexact() {
                self.send_exactly()?;
            }
            self.forget_screen();
            self.wrote_foreign_bytes = true;
        }
        Ok(())
    }
}

/// Sends bytes that the program writes itself (see [Other bytes](Self#other-bytes)).
impl<W: Write> Write for EncoderBackend<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.prepare_foreign_bytes()?;
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl<W: fmt::Debug> fmt::Debug for EncoderBackend<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("EncoderBackend")
            .field("writer", &self.writer)
            .field("size", &self.window.columns_rows)
            .field("position", &self.position)
            .finish_non_exhaustive()
    }
}
