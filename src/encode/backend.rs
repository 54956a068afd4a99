//! The encoder as a backend of ratatui: any ratatui program sends its bytes.
//!
//! ratatui names the cells that change; here they change a wanted grid, and `flush` sends what the terminal does not
//! show yet, in one write.

mod calls;
mod cursor;
mod limits;
#[cfg(feature = "scrolling-regions")]
mod regions;

use super::moves::CellPosition;
use super::{Encoder, Quality};
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

/// A [`Backend`](ratatui_core::backend::Backend) on any [`Write`], in place of `CrosstermBackend` and its like.
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
/// The terminal has to be in raw mode. What the program has not drawn is left as it is until the program clears it.
/// Clearing writes blanks, even where there should be some already, which mends a screen on which something else has
/// written.
///
/// # The size of the window and the place of the cursor
///
/// By itself the backend asks the terminal nothing. Its size is the one given to [`new`](Self::new), and the cursor is
/// where it was last put: by `set_cursor_position`, behind the last cell that was drawn, or down by the lines appended.
/// With [`sized_by`](Self::sized_by) it asks for the size, so that
/// [`Terminal::autoresize`](ratatui_core::terminal::Terminal::autoresize), which each `draw` calls, follows the window.
/// With [`located_by`](Self::located_by) it asks where the cursor is when that is unknown, which an inline viewport
/// needs at its beginning and after a resize; without it, the program calls `set_cursor_position` there.
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
/// The backend is itself a [`Write`], so `execute!(terminal.backend_mut(), EnterAlternateScreen)` works: the bytes go
/// out as they are, after everything that was drawn before them. As they may have done anything, nothing is assumed
/// about the screen, the colours or the cursor afterwards, and nothing is drawn again by itself: neither what stood on
/// the screen before, nor the cursor in its place. That is right behind `LeaveAlternateScreen`, where the screen is the
/// shell's again. Bytes that change what the screen shows have to be followed by
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
/// With it `insert_before` scrolls what stands above an inline viewport, and the viewport is not drawn again.
pub struct EncoderBackend<W> {
    writer: W,
    encoder: Encoder,
    limits: Option<Limits>,
    wanted: Grid,
    window: WindowSize,
    ask_size: Option<Query<Size>>,
    ask_position: Option<Query<Position>>,
    /// Where the cursor was last put.
    position: Position,
    /// The cursor as it is to be.
    cursor: Cursor,
    /// The cursor as the terminal has it, as far as that is known.
    shown_cursor: Cursor,
    /// Between `draw` and `flush`: what is said of the cursor goes out with the frame.
    is_frame_open: bool,
    /// The last bytes that went out were not ours.
    wrote_foreign_bytes: bool,
}

/// A question to the terminal.
type Query<T> = Box<dyn Fn() -> io::Result<T> + Send + Sync>;

impl<W> EncoderBackend<W> {
    /// Creates a backend for a terminal of that size of which nothing else is known.
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

    /// Sets the encoder, for instance one with another order.
    pub fn with_encoder(mut self, encoder: Encoder) -> Self {
        self.encoder = encoder;
        self.forget();
        self
    }

    /// Lets frames differ from what was drawn, as [`Encoder::encode_within`] does: text is always exact, pictures of
    /// half blocks are within `quality` while they change and exact half a second later. `clock` gives the time from
    /// any fixed start.
    ///
    /// A program that only draws when something happens has to draw once more, half a second or later after a picture
    /// has changed; one that draws many times a second need not care.
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
    /// assert_eq!(terminal.size()?.height, 24);
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn with_quality(mut self, quality: Quality, clock: impl FnMut() -> Duration + Send + Sync + 'static) -> Self {
        self.limits = Some(Limits::new(quality, Box::new(clock)));
        self
    }

    /// Limits the bytes a second that frames take, where [`with_quality`](Self::with_quality) was given
    /// [`Quality::Equal`] or [`Quality::Fast`]: what does not fit, the least errors of pictures, waits for a later
    /// frame. Text never waits, nor what replaces text or an unknown screen. Without a quality it does nothing.
    pub fn with_max_rate(mut self, bytes_per_second: u32) -> Self {
        self.limits = self.limits.map(|limits| limits.with_max_rate(bytes_per_second));
        self
    }

    /// Asks that function for the size of the window, in columns and rows, each time that it matters.
    ///
    /// A window that becomes smaller and large again between two frames goes unnoticed, as with any backend.
    pub fn sized_by(mut self, ask: impl Fn() -> io::Result<Size> + Send + Sync + 'static) -> Self {
        self.ask_size = Some(Box::new(ask));
        self
    }

    /// Asks that function for the cursor's column and row, counted from 0, where they are not known otherwise.
    pub fn located_by(mut self, ask: impl Fn() -> io::Result<Position> + Send + Sync + 'static) -> Self {
        self.ask_position = Some(Box::new(ask));
        self
    }

    /// Sets the size of the window, of which nothing else is known from here on, not even its size in pixels.
    #[doc(hidden)]
    pub fn resize(&mut self, size: impl Into<Size>) {
        let Size { width, height } = size.into();
        self.window = WindowSize { columns_rows: Size { width, height }, pixels: Size::ZERO };
        self.position = self.clamped_to_screen(self.position);
        self.forget_screen();
    }

    /// Sets the size of the window in pixels, for [`window_size`](ratatui_core::backend::Backend::window_size); 0 by 0
    /// until then.
    #[doc(hidden)]
    pub fn set_pixels(&mut self, pixels: impl Into<Size>) {
        self.window.pixels = pixels.into();
    }

    /// Returns when, by the clock of [`with_quality`](Self::with_quality), the next frame is due if nothing else is
    /// drawn until then; `None` if the screen shows exactly what was drawn.
    #[doc(hidden)]
    pub fn due(&self) -> Option<Duration> {
        let limits = self.limits.as_ref()?;
        self.encoder.due().map(|due| limits.due(due))
    }

    /// Returns the writer.
    #[doc(hidden)]
    pub fn writer(&self) -> &W {
        &self.writer
    }

    /// Returns the writer, for bytes that leave the screen, the colours and the cursor as they are (a title, the
    /// clipboard). Others are written to the backend itself.
    #[doc(hidden)]
    pub fn writer_mut(&mut self) -> &mut W {
        &mut self.writer
    }

    /// Nothing is known of the screen.
    fn forget(&mut self) {
        self.encoder.forget();
        self.shown_cursor = Cursor::default();
    }

    /// Nothing is known of the screen, and nothing is wanted on it but what is drawn from here on.
    fn forget_screen(&mut self) {
        let Size { width, height } = self.window.columns_rows;
        self.wanted = Grid::foreign(grid::Size::new(width, height));
        self.cursor.position = None;
        self.is_frame_open = false;
        self.forget();
    }

    /// The place on the screen that is nearest.
    fn clamped_to_screen(&self, Position { x, y }: Position) -> Position {
        let Size { width, height } = self.window.columns_rows;
        Position::new(x.min(width.saturating_sub(1)), y.min(height.saturating_sub(1)))
    }

    /// Wants the cursor there, or as near as the screen has a place.
    fn put_cursor(&mut self, to: Position) {
        self.position = self.clamped_to_screen(to);
        self.cursor.position = Some(self.position);
    }

    /// Wants a cell; how many columns it takes. ratatui draws what has changed: where nothing has, it must know of
    /// something else that was drawn there, and the cell is sent again.
    fn draw_cell(&mut self, place: Position, cell: &ratatui_core::buffer::Cell) -> u16 {
        let before = self.wanted.cell(place.x, place.y).clone();
        let columns = overlay::put_cell(&mut self.wanted, place, cell, self.window.columns_rows.width - place.x);
        if *self.wanted.cell(place.x, place.y) == before {
            self.encoder.forget_cell(CellPosition { column: place.x, row: place.y });
        }
        columns
    }

    /// What is said of the cursor goes out with the next frame.
    fn begin_frame(&mut self) {
        self.is_frame_open = true;
    }

    /// Wants blanks in these cells, counted row by row from the top, whatever they show.
    fn blank(&mut self, cells: Range<usize>) {
        let columns = usize::from(self.window.columns_rows.width);
        for at in cells.start..cells.end.min(self.wanted.cells().len()) {
            let (column, row) = ((at % columns) as u16, (at / columns) as u16);
            self.wanted.put(column, row, &Cell::BLANK, 1);
            self.encoder.forget_cell(CellPosition { column, row });
        }
    }
}

impl<W: Write> EncoderBackend<W> {
    /// Takes over the size of the window, if it has another one now.
    fn follow_window(&mut self) -> io::Result<()> {
        if let Some(ask) = &self.ask_size {
            let size = ask()?;
            if size != self.window.columns_rows {
                self.resize(size);
            }
        }
        Ok(())
    }

    /// Where the cursor is, or is to be.
    fn locate(&mut self) -> io::Result<Position> {
        if self.cursor.position.or(self.shown_cursor.position).is_none()
            && let Some(ask) = &self.ask_position
        {
            self.position = self.clamped_to_screen(ask()?);
            self.shown_cursor.position = Some(self.position);
        }
        Ok(self.position)
    }

    /// Returns what the terminal does not show yet, the cursor included; `limits` may hold some of it back.
    fn frame(&mut self, limits: Option<&mut Limits>) -> Vec<u8> {
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
        // What the program writes itself has no colours then, nor has the shell's prompt after it.
        self.encoder.reset_pen(&mut bytes);
        self.shown_cursor.position = end.map(|CellPosition { column, row }| Position::new(column, row));
        self.shown_cursor.switch_to(self.cursor, &mut bytes);
        self.encoder.bracket(0, &mut bytes);
        bytes
    }

    /// Returns what is not sent yet, with the pen down: what stands before bytes that act on the screen as it is.
    fn unsent_bytes(&mut self) -> Vec<u8> {
        if self.is_frame_open || !self.encoder.knows_screen() { self.frame(None) } else { Vec::new() }
    }

    fn send_frame(&mut self) -> io::Result<()> {
        let mut limits = self.limits.take();
        let bytes = self.frame(limits.as_mut());
        if let Some(limits) = &mut limits {
            limits.record_sent(bytes.len());
        }
        self.limits = limits;
        self.send(&bytes)
    }

    /// Sends everything that was drawn, exactly.
    fn send_exactly(&mut self) -> io::Result<()> {
        let bytes = self.frame(None);
        self.send(&bytes)
    }

    /// Sends what is new of the cursor, unless it goes out with a frame.
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
            // Something else may have moved it.
            self.shown_cursor.position = None;
        }
        self.put_cursor(position);
        self.send_cursor()
    }

    /// Line feeds from where the cursor is; the rows that go out at the top go into the scrollback.
    fn feed_lines(&mut self, lines: u16) -> io::Result<()> {
        let Position { x, y } = self.locate()?;
        self.put_cursor(Position::new(x, y));
        let mut bytes = self.unsent_bytes();
        self.shown_cursor.switch_to(self.cursor, &mut bytes);
        let height = self.window.columns_rows.height;
        let scrolled = lines.saturating_sub(height.saturating_sub(1).saturating_sub(y));
        bytes.extend(std::iter::repeat_n(b'\n', lines.into()));
        self.encoder.scroll_up(0..height, scrolled);
        self.wanted.scroll_up(0..height, scrolled);
        self.put_cursor(Position::new(x, y.saturating_add(lines)));
        self.shown_cursor.position = self.cursor.position;
        self.send(&bytes)
    }

    /// The rows have been scrolled, and the cursor is at the top left.
    #[cfg(feature = "scrolling-regions")]
    fn record_scrolled(&mut self, region: Range<u16>, by: u16, direction: regions::ScrollDirection) {
        match direction {
            regions::ScrollDirection::Up => {
                self.encoder.scroll_up(region.clone(), by);
                self.wanted.scroll_up(region, by);
            }
            regions::ScrollDirection::Down => {
                self.encoder.scroll_down(region.clone(), by);
                self.wanted.scroll_down(region, by);
            }
        }
        self.position = Position::ORIGIN;
        self.cursor.position = None;
        self.shown_cursor.position = Some(Position::ORIGIN);
    }

    /// Before bytes of the program's own: what was drawn is on the screen, and nothing is known of it afterwards.
    fn prepare_foreign_bytes(&mut self) -> io::Result<()> {
        // Not between the pieces of one escape sequence.
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

/// For the program's own escape sequences (see [above](Self#other-bytes)).
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
