//! The encoder as ratatui's backend, against ratatui's own.
//!
//! On two emulators any program has the same screen, cursor and scrollback with either.

use super::screens::{Clusters, Screens, glyph_of, seen_by_avt, seen_by_vt100};
use super::{config, panel};
use proptest::collection::vec;
use proptest::prelude::*;
use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::{Buffer, CellWidth};
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::{Color, Modifier, Style, Stylize};
use ratatui::widgets::{Paragraph, Widget};
use ratatui::{Frame, Terminal, TerminalOptions, Viewport, text};
use ratatui_crossterm::CrosstermBackend;
use std::cell::RefCell;
use std::io::{self, Write};
use std::num::NonZeroU16;
use std::rc::Rc;
use termtrace::internals::{grid, overlay};
use termtrace::{Cell, Encoder, EncoderBackend, Grid, Ink, Order};

/// Two emulators that receive the same bytes, and the bytes of each write.
#[derive(Clone)]
pub(crate) struct Wire(Rc<RefCell<Emulators>>);

struct Emulators {
    avt: avt::Terminal,
    vt100: vt100::Parser,
    /// The text of each write.
    writes: Vec<String>,
}

const SCROLLBACK: usize = 100;

fn side(length: u16) -> NonZeroU16 {
    NonZeroU16::new(length).expect("a screen has cells")
}

impl Wire {
    pub(crate) fn new(Size { width, height }: Size) -> Self {
        let avt = avt::Terminal::new(width.into(), height.into()).expect("a screen has cells");
        let vt100 = vt100::Parser::new(side(height), side(width), SCROLLBACK);
        Self(Rc::new(RefCell::new(Emulators { avt, vt100, writes: Vec::new() })))
    }

    pub(crate) fn feed(&self, text: &str) {
        let emulators = &mut *self.0.borrow_mut();
        emulators.avt.feed(text);
        emulators.vt100.process(text.as_bytes());
    }

    pub(crate) fn resize(&self, Size { width, height }: Size) {
        let emulators = &mut *self.0.borrow_mut();
        emulators.avt.resize(width.into(), height.into());
        emulators.vt100.screen_mut().set_size(side(height), side(width));
    }

    fn size(&self) -> Size {
        let (rows, columns) = self.0.borrow().vt100.screen().size();
        Size::new(columns.into(), rows.into())
    }

    pub(crate) fn cursor(&self) -> Position {
        let (y, x) = self.0.borrow().vt100.screen().cursor_position();
        Position::new(x.min(self.size().width - 1), y)
    }

    pub(crate) fn is_cursor_visible(&self) -> bool {
        let emulators = self.0.borrow();
        let visible = !emulators.vt100.screen().hide_cursor();
        assert_eq!(emulators.avt.cursor().visible, visible, "the emulators agree");
        visible
    }

    pub(crate) fn cells(&self, column: u16, row: u16) -> [Cell; 2] {
        let emulators = self.0.borrow();
        let cells = [seen_by_avt(&emulators.avt, column, row), seen_by_vt100(&emulators.vt100, column, row)];
        // What has been erased is blank.
        cells.map(|cell| if cell.glyph == glyph_of("") { Cell { glyph: ' '.into(), ..cell } } else { cell })
    }

    pub(crate) fn text(&self) -> String {
        self.0.borrow().vt100.screen().contents()
    }

    /// Returns the lines that were scrolled off the top, and those on the screen. Erased and blank
    /// are equal.
    pub(crate) fn scrollback(&self) -> Vec<String> {
        let screen = &mut self.0.borrow_mut().vt100;
        let screen = screen.screen_mut();
        screen.set_scrollback(SCROLLBACK);
        let lines = (0..=screen.scrollback()).rev().map(|above| {
            screen.set_scrollback(above);
            screen.rows(0, u16::MAX).map(|row| row.trim_end().to_owned() + "\n").collect()
        });
        lines.collect()
    }

    /// Returns the writes since the last call.
    pub(crate) fn take_writes(&self) -> Vec<String> {
        std::mem::take(&mut self.0.borrow_mut().writes)
    }
}

impl Write for Wire {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = std::str::from_utf8(bytes).expect("whole characters");
        self.feed(text);
        self.0.borrow_mut().writes.push(text.to_owned());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// ratatui's own backend, whose queries the emulator answers.
pub(crate) struct Theirs(pub(crate) CrosstermBackend<Wire>, Wire);

impl Backend for Theirs {
    type Error = io::Error;

    fn draw<'a, I: Iterator<Item = (u16, u16, &'a ratatui::buffer::Cell)>>(&mut self, content: I) -> io::Result<()> {
        self.0.draw(content)
    }

    fn append_lines(&mut self, lines: u16) -> io::Result<()> {
        self.0.append_lines(lines)
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        self.0.hide_cursor()
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        self.0.show_cursor()
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(self.1.cursor())
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, position: P) -> io::Result<()> {
        self.0.set_cursor_position(position)
    }

    fn clear(&mut self) -> io::Result<()> {
        self.0.clear()
    }

    fn clear_region(&mut self, clear_type: ClearType) -> io::Result<()> {
        self.0.clear_region(clear_type)
    }

    fn size(&self) -> io::Result<Size> {
        Ok(self.1.size())
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize { columns_rows: self.1.size(), pixels: Size::ZERO })
    }

    fn flush(&mut self) -> io::Result<()> {
        Backend::flush(&mut self.0)
    }

    #[cfg(feature = "scrolling-regions")]
    fn scroll_region_up(&mut self, region: std::ops::Range<u16>, line_count: u16) -> io::Result<()> {
        self.0.scroll_region_up(region, line_count)
    }

    #[cfg(feature = "scrolling-regions")]
    fn scroll_region_down(&mut self, region: std::ops::Range<u16>, line_count: u16) -> io::Result<()> {
        self.0.scroll_region_down(region, line_count)
    }
}

/// One program on two backends.
pub(crate) struct Pair {
    pub(crate) ours: Terminal<EncoderBackend<Wire>>,
    pub(crate) theirs: Terminal<Theirs>,
    pub(crate) line: Wire,
    pub(crate) other_line: Wire,
}

pub(crate) const SIZE: Size = Size::new(12, 6);

/// Returns the output of a shell that leaves the cursor in the row below.
pub(crate) fn shell(rows: u16) -> String {
    let lines: Vec<String> = (0..rows).map(|row| format!("$ \x1b[3{}mls -l {row}\x1b[m\r\n", row % 8)).collect();
    lines.concat()
}

impl Pair {
    pub(crate) fn new(size: Size, encoder: Encoder, viewport: &Viewport, before: &str) -> Self {
        let [line, other_line] = [Wire::new(size), Wire::new(size)];
        line.feed(before);
        other_line.feed(before);
        let mut backend = EncoderBackend::new(line.clone(), size).with_encoder(encoder);
        backend.set_cursor_position(line.cursor()).expect("it can be written");
        Self::with_backend(backend, [line, other_line], viewport)
    }

    /// Makes a pair whose backend of ours has drawn the first of two equal lines.
    pub(crate) fn with_backend(
        backend: EncoderBackend<Wire>,
        [line, other_line]: [Wire; 2],
        viewport: &Viewport,
    ) -> Self {
        let options = || TerminalOptions { viewport: viewport.clone() };
        let ours = Terminal::with_options(backend, options()).expect("it can be written");
        let backend = Theirs(CrosstermBackend::new(other_line.clone()), other_line.clone());
        let theirs = Terminal::with_options(backend, options()).expect("it can be written");
        Self { ours, theirs, line, other_line }
    }

    fn inline(rows_before: u16, height: u16) -> Self {
        Self::new(SIZE, Encoder::new(), &Viewport::Inline(height), &shell(rows_before))
    }

    fn fullscreen() -> Self {
        Self::new(SIZE, Encoder::new(), &Viewport::Fullscreen, "")
    }

    #[track_caller]
    pub(crate) fn draw(&mut self, render: impl Fn(&mut Frame<'_>)) {
        self.ours.draw(&render).expect("it can be written");
        self.theirs.draw(&render).expect("it can be written");
        self.assert_equal();
    }

    #[track_caller]
    pub(crate) fn insert_before(&mut self, height: u16, draw: impl Fn(&mut Buffer)) {
        self.ours.insert_before(height, &draw).expect("it can be written");
        self.theirs.insert_before(height, &draw).expect("it can be written");
        self.assert_equal();
    }

    #[track_caller]
    pub(crate) fn clear(&mut self) {
        self.ours.clear().expect("it can be written");
        self.theirs.clear().expect("it can be written");
        self.assert_equal();
    }

    /// Resizes the window, and tells our backend so as its owner does.
    fn resize(&mut self, size: Size) {
        self.line.resize(size);
        self.other_line.resize(size);
        let cursor = self.line.cursor();
        let backend = self.ours.backend_mut();
        backend.resize(size);
        backend.set_cursor_position(cursor).expect("it can be written");
    }

    /// Makes the same call of both backends.
    #[track_caller]
    fn call(&mut self, call: impl Fn(&mut dyn Calls) -> io::Result<()>) {
        call(self.ours.backend_mut()).expect("it can be written");
        call(self.theirs.backend_mut()).expect("it can be written");
        self.assert_equal();
    }

    /// Writes on both screens behind the backends' back.
    fn disturb(&self, text: &str) {
        self.line.feed(text);
        self.other_line.feed(text);
    }

    #[track_caller]
    pub(crate) fn assert_equal(&mut self) {
        self.assert_screens_equal();
        assert_eq!(
            self.ours.get_cursor_position().expect("it is known"),
            self.line.cursor(),
            "what our cursor is said to be"
        );
    }

    #[track_caller]
    pub(crate) fn assert_screens_equal(&self) {
        let Size { width, height } = self.line.size();
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            let shown = self.line.cells(column, row);
            assert_eq!(shown, self.other_line.cells(column, row), "({column}, {row}) of\n{}", self.line.text());
        }
        assert_eq!(self.line.scrollback(), self.other_line.scrollback());
        let is_visible = self.other_line.is_cursor_visible();
        assert_eq!(self.line.is_cursor_visible(), is_visible);
        assert_eq!(self.line.cursor(), self.other_line.cursor(), "cursor");
    }
}

/// The calls of a backend that a program makes past its `Terminal`.
trait Calls {
    fn append(&mut self, lines: u16) -> io::Result<()>;
    fn put_cursor(&mut self, x: u16, y: u16) -> io::Result<()>;
    fn wipe(&mut self, region: ClearType) -> io::Result<()>;
}

impl<B: Backend<Error = io::Error>> Calls for B {
    fn append(&mut self, lines: u16) -> io::Result<()> {
        self.append_lines(lines)
    }

    fn put_cursor(&mut self, x: u16, y: u16) -> io::Result<()> {
        self.set_cursor_position((x, y))
    }

    fn wipe(&mut self, region: ClearType) -> io::Result<()> {
        self.clear_region(region)
    }
}

const REGIONS: [ClearType; 5] =
    [ClearType::All, ClearType::AfterCursor, ClearType::BeforeCursor, ClearType::CurrentLine, ClearType::UntilNewLine];

/// Draws letters and colours in every cell.
pub(crate) fn full(frame: &mut Frame<'_>) {
    for (at, cell) in (0_u8..).zip(&mut frame.buffer_mut().content) {
        cell.set_char(char::from(b'a' + at % 26)).set_bg(Color::Indexed(at % 7));
    }
}

#[test]
fn each_region_is_cleared() {
    for region in REGIONS {
        for (x, y) in (0..SIZE.height).flat_map(|y| [0, 5, SIZE.width - 1].map(|x| (x, y))) {
            let mut pair = Pair::fullscreen();
            pair.draw(full);
            pair.call(|backend| backend.put_cursor(x, y));
            pair.call(|backend| backend.wipe(region));
            // Nor is anything of it taken for shown.
            pair.draw(|frame| frame.render_widget(Paragraph::new("new"), frame.area()));
            pair.clear();
            pair.draw(full);
        }
    }
}

/// Clearing mends what another program has written there, and only there.
#[test]
fn clearing_mends_what_another_program_wrote() {
    for region in REGIONS {
        let mut pair = Pair::fullscreen();
        pair.clear();
        pair.disturb(&format!("\x1b[H{}\x1b[H", "?".repeat(SIZE.area() as usize)));
        pair.call(|backend| backend.put_cursor(4, 2));
        pair.call(|backend| backend.wipe(region));
    }
}

/// Clearing the screen resets the pen that another program has left, and hides the cursor again.
#[test]
fn clearing_the_screen_resets_pen_and_cursor() {
    let line = Wire::new(SIZE);
    let mut terminal = Terminal::new(EncoderBackend::new(line.clone(), SIZE)).expect("it can be written");
    terminal.draw(full).expect("it can be written");
    line.feed("\x1b[1;4;31;44m\x1b[?25h\x1b[3;3H?");
    terminal.clear().expect("it can be written");
    assert_eq!([line.cells(0, 0), line.cells(2, 2)], [const { [const { Cell::BLANK }; 2] }; 2]);
    assert!(!line.is_cursor_visible());
}

/// The encoder may have drawn on another screen before: nothing is taken as shown.
#[test]
fn an_encoder_that_drew_elsewhere_draws_all() {
    let mut grid = Grid::new(grid::Size::new(SIZE.width, SIZE.height));
    *grid.cell_mut(2, 1) = Cell::new('x', Ink::Default, Ink::Default);
    let mut encoder = Encoder::new();
    encoder.encode(&grid, &mut Vec::new());
    let mut pair = Pair::new(SIZE, encoder, &Viewport::Fullscreen, &shell(3));
    pair.draw(|frame| frame.buffer_mut().set_string(2, 1, "x", Style::new()));
}

/// Another program may have changed the cursor: its state is sent even if it was sent before.
#[test]
fn the_cursor_is_sent_even_if_unchanged() {
    let mut pair = Pair::fullscreen();
    let render = |frame: &mut Frame<'_>| frame.set_cursor_position((4, 4));
    pair.draw(render);
    pair.disturb("\x1b[H");
    pair.call(|backend| backend.put_cursor(4, 4));
    pair.disturb("\x1b[?25l");
    pair.ours.show_cursor().expect("it can be written");
    pair.theirs.show_cursor().expect("it can be written");
    pair.assert_equal();
    // A resize to the same size means that the screen's contents are unknown.
    pair.disturb("\x1b[H\x1b[?25l");
    pair.ours.backend_mut().resize(SIZE);
    pair.draw(render);
}

/// A terminal that splits a cluster writes over the cells behind it, which are sent again.
///
/// Cells that are not the program's are left alone.
#[test]
fn cells_behind_a_split_cluster_are_sent_again() {
    let line = Wire::new(SIZE);
    line.feed("$ shell tex");
    let mut backend = EncoderBackend::new(line.clone(), SIZE);
    let cell = ratatui::buffer::Cell::new("e\u{301}");
    backend.draw([(3, 0, &cell)].into_iter()).expect("it can be written");
    Backend::flush(&mut backend).expect("it can be written");
    assert_eq!(line.text(), "$ se\u{301}ell tex");
}

#[test]
fn lines_are_appended() {
    for y in 0..SIZE.height {
        for lines in 0..=SIZE.height + 3 {
            let mut pair = Pair::new(SIZE, Encoder::new(), &Viewport::Fullscreen, &shell(4));
            pair.draw(|frame| frame.render_widget(Paragraph::new("a\n\nb").on_blue(), Rect::new(2, 1, 3, 5)));
            pair.call(|backend| backend.put_cursor(3, y));
            pair.call(|backend| backend.append(lines));
            pair.call(|backend| backend.append(1));
            pair.draw(|frame| frame.render_widget(Paragraph::new("c").on_red(), frame.area()));
        }
    }
}

/// An inline viewport keeps the shell's lines above it, and inserted lines come in between.
#[test]
fn an_inline_viewport_keeps_the_lines_above_it() {
    // Where the viewport fills the screen, or all but a row of it, ratatui's own backend with scrolling regions uses a
    // region of one row, which terminals do not know.
    let heights: &[u16] = if cfg!(feature = "scrolling-regions") { &[1, 2, 3] } else { &[1, 2, 3, 5, 6, 9] };
    for (rows_before, &height) in (0..=7).flat_map(|rows| heights.iter().map(move |height| (rows, height))) {
        let mut pair = Pair::inline(rows_before, height);
        let status = |step: u16| {
            move |frame: &mut Frame<'_>| {
                frame.render_widget(Paragraph::new(format!("step {step}")).on_dark_gray(), frame.area());
            }
        };
        pair.draw(status(0));
        for (step, inserted) in (1_u16..).zip([1, 0, 2, 5, 6, 13]) {
            pair.insert_before(inserted, |buffer| {
                let lines: Vec<_> = (0..inserted).map(|line| text::Line::from(format!("{line} of {step}"))).collect();
                Paragraph::new(lines).green().render(buffer.area, buffer);
            });
            pair.draw(status(step));
        }
        pair.clear();
        pair.draw(status(99));
    }
}

#[test]
fn windows_are_resized() {
    for (viewport, before) in [(Viewport::Fullscreen, 0), (Viewport::Inline(3), 2), (Viewport::Inline(2), 5)] {
        let mut pair = Pair::new(SIZE, Encoder::new(), &viewport, &shell(before));
        pair.draw(full);
        for size in [(20, 6), (20, 9), (9, 9), (9, 2), (12, 6)] {
            pair.resize(size.into());
            pair.draw(|frame| frame.render_widget(Paragraph::new("after").on_red(), frame.area()));
            pair.draw(full);
        }
    }
}

/// Cells that a viewport does not draw keep another program's text, in gaps and beside it.
#[test]
fn cells_that_are_not_drawn_are_left_alone() {
    for order in [Order::Raster, Order::Color] {
        let viewport = Viewport::Fixed(Rect::new(2, 1, 8, 4));
        let mut pair = Pair::new(SIZE, Encoder::new().with_order(order), &viewport, &shell(6));
        for text in ["a b  c", "a b  d 世", "    d", "a b  d"] {
            pair.draw(|frame| frame.render_widget(Paragraph::new(text), frame.area()));
            pair.draw(|frame| frame.render_widget(Paragraph::new(text).on_blue(), Rect::new(3, 2, 5, 2)));
        }
    }
}

#[test]
fn the_cursor_is_where_the_program_wants_it() {
    let mut pair = Pair::fullscreen();
    for step in 0..12 {
        pair.draw(|frame| {
            frame.render_widget(Paragraph::new(format!("{step}")), frame.area());
            if step % 4 != 3 {
                frame.set_cursor_position((step % 3, step % 5));
            }
        });
        assert_eq!(pair.line.is_cursor_visible(), step % 4 != 3);
    }
}

/// A frame that changes nothing sends nothing, and no cursor that is where the frame ends.
#[test]
fn a_frame_without_changes_sends_nothing() {
    for synchronized in [false, true] {
        let encoder = Encoder::new().with_synchronized_output(synchronized);
        let mut pair = Pair::new(SIZE, encoder, &Viewport::Fullscreen, "");
        for with_cursor in [false, true] {
            let render = |frame: &mut Frame<'_>| {
                full(frame);
                if with_cursor {
                    frame.set_cursor_position((4, 4));
                }
            };
            pair.draw(render);
            pair.line.take_writes();
            pair.draw(render);
            assert_eq!(pair.line.take_writes(), Vec::<String>::new());
        }
    }
}

/// A frame and its cursor are one write, in one pair of brackets.
#[test]
fn a_frame_is_one_write() {
    for synchronized in [false, true] {
        let encoder = Encoder::new().with_synchronized_output(synchronized);
        let mut pair = Pair::new(SIZE, encoder, &Viewport::Fullscreen, "");
        for step in 0..6 {
            pair.line.take_writes();
            pair.draw(|frame| {
                frame.render_widget(Paragraph::new(format!("{step}")).on_green(), frame.area());
                if step % 2 == 0 {
                    frame.set_cursor_position((7, 3));
                }
            });
            let writes = pair.line.take_writes();
            assert_eq!(writes.len(), 1, "{writes:?}");
            assert_bracketed(&writes[0], synchronized);
        }
    }
}

/// Asserts that a frame is in brackets, or that it has none.
#[track_caller]
pub(crate) fn assert_bracketed(frame: &str, synchronized: bool) {
    let inside = frame.strip_prefix("\x1b[?2026h").and_then(|frame| frame.strip_suffix("\x1b[?2026l"));
    assert_eq!(inside.is_some(), synchronized, "{frame:?}");
    assert!(!inside.unwrap_or(frame).contains("2026"), "{frame:?}");
}

/// Bytes that the program writes itself have no colour of ours, and the next frame is right.
#[test]
fn the_programs_own_bytes_get_no_colour_of_ours() {
    let mut pair = Pair::fullscreen();
    for x in 3..6 {
        let look = |frame: &mut Frame<'_>| {
            let text = Paragraph::new(format!("{x}")).bold().underlined().red().on_blue();
            frame.render_widget(text, Rect::new(x, 0, 2, 2));
            frame.set_cursor_position((0, 4));
        };
        pair.draw(look);
        let (ours, theirs) = (pair.ours.backend_mut(), pair.theirs.backend_mut());
        ours.writer_mut().write_all(b"own\r").expect("it can be written");
        theirs.0.write_all(b"own\r").expect("it can be written");
        pair.assert_equal();
        assert_eq!(pair.line.cells(0, 4), [const { Cell::new('o', Ink::Default, Ink::Default) }; 2]);
    }
}

/// The program knows that the screen was lost: what it draws or clears is sent, even if nothing
/// changed.
#[test]
fn cells_that_are_drawn_again_are_sent_again() {
    let mut pair = Pair::fullscreen();
    pair.draw(full);
    pair.disturb("\x1b[2J");
    let cell = ratatui::buffer::Cell::new("a");
    for _ in 0..2 {
        pair.disturb("\x1b[1;1H?\x1b[1;1H");
        pair.ours.backend_mut().draw([(0, 0, &cell)].into_iter()).expect("it can be written");
        Backend::flush(pair.ours.backend_mut()).expect("it can be written");
        assert_eq!(pair.line.cells(0, 0)[0].glyph, 'a');
    }
}

/// After a failed write the state of the terminal is unknown: all is drawn again, with the cursor's
/// state.
#[test]
fn after_a_failed_write_all_is_drawn_again() {
    struct Failing(Wire, bool);
    impl Write for Failing {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.1 { Err(io::Error::other("cut")) } else { self.0.write(bytes) }
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let line = Wire::new(SIZE);
    let mut terminal =
        Terminal::new(EncoderBackend::new(Failing(line.clone(), false), SIZE)).expect("it can be written");
    terminal.draw(full).expect("it can be written");
    let shown = line.text();
    line.feed("\x1b[2J\x1b[?25h\x1b[31m");
    terminal.backend_mut().writer_mut().1 = true;
    let render = |frame: &mut Frame<'_>| {
        full(frame);
        frame.buffer_mut()[(0, 0)].set_char('!');
    };
    terminal.draw(render).expect_err("the line is cut");
    terminal.backend_mut().writer_mut().1 = false;
    terminal.draw(render).expect("it can be written");
    assert_eq!(line.text(), shown.replacen('a', "!", 1));
    assert!(!line.is_cursor_visible());
}

/// An empty screen is no error, nor is a cell outside of it.
#[test]
fn empty_screens_and_cells_outside_are_no_error() {
    let cell = ratatui::buffer::Cell::new("世");
    for size in [(0, 0), (0, 5), (5, 0), (1, 1), (3, 2)] {
        let mut backend = EncoderBackend::new(Vec::new(), size);
        for (x, y) in [(0, 0), (2, 1), (u16::MAX, u16::MAX)] {
            backend.draw([(x, y, &cell)].into_iter()).expect("a Vec");
            backend.set_cursor_position((x, y)).expect("a Vec");
            for region in REGIONS {
                backend.clear_region(region).expect("a Vec");
            }
            backend.append_lines(x).expect("a Vec");
            Backend::flush(&mut backend).expect("a Vec");
        }
        backend.resize((2, 2));
        assert_eq!(backend.size().expect("it is known"), Size::new(2, 2));
    }
}

#[test]
fn the_size_is_the_one_that_was_set() {
    let mut backend = EncoderBackend::new(Vec::new(), (80, 24));
    backend.set_pixels((800, 480));
    let window = |width, height, pixels| WindowSize { columns_rows: Size::new(width, height), pixels };
    assert_eq!(backend.window_size().expect("it is known"), window(80, 24, Size::new(800, 480)));
    backend.resize((100, 30));
    assert_eq!(backend.window_size().expect("it is known"), window(100, 30, Size::ZERO));
}

/// Returns the bytes without the modes that the strict model does not know.
fn without_modes(bytes: &str) -> String {
    ["\x1b[?25h", "\x1b[?25l", "\x1b[?2026h", "\x1b[?2026l"]
        .iter()
        .fold(bytes.to_owned(), |bytes, mode| bytes.replace(mode, ""))
}

/// A ratatui program on the strict model of a terminal.
///
/// The screen is what the program has drawn: underlines in their colours, wide characters, and clusters.
pub(crate) struct Strict {
    terminal: Terminal<EncoderBackend<Vec<u8>>>,
    screens: Screens,
    read: usize,
}

impl Strict {
    pub(crate) fn new(size: Size, encoder: Encoder, clusters: Clusters) -> Self {
        let backend = EncoderBackend::new(Vec::new(), size).with_encoder(encoder);
        let terminal = Terminal::new(backend).expect("a Vec");
        let screens = Screens::disturbed(grid::Size::new(size.width, size.height), clusters);
        let mut strict = Self { terminal, screens, read: 0 };
        strict.terminal.clear().expect("a Vec");
        strict
    }

    #[track_caller]
    pub(crate) fn draw(&mut self, render: impl FnOnce(&mut Frame<'_>)) {
        let drawn = self.terminal.draw(render).expect("a Vec").buffer.clone();
        let mut wanted = Grid::new(grid::Size::new(drawn.area.width, drawn.area.height));
        overlay::lay_over(&mut wanted, &drawn);
        let bytes = self.terminal.backend().writer();
        let text = without_modes(std::str::from_utf8(&bytes[self.read..]).expect("whole characters"));
        self.read = bytes.len();
        self.screens.feed(text.as_bytes());
        self.screens.assert_show(&wanted);
    }
}

/// Returns buffers of some texts in some styles.
fn panels(clusters: Clusters) -> impl Strategy<Value = Vec<Vec<Buffer>>> {
    let frame = vec(panel(clusters).prop_map(|panel| panel.buffer()), 0..4);
    vec(frame, 1..6)
}

fn render(buffers: &[Buffer], frame: &mut Frame<'_>) {
    for buffer in buffers {
        let target = frame.buffer_mut();
        let area = buffer.area.intersection(target.area);
        for place in area.positions() {
            target[place] = buffer[place].clone();
        }
        // The second half of a wide character is no cell of its own.
        for y in area.rows().map(|row| row.y) {
            halve(target, y);
        }
    }
}

/// Removes wide characters that overlap another one or the edge, and gives both halves one style.
///
/// Otherwise ratatui would not say what is to be there once only the first half is gone.
fn halve(buffer: &mut Buffer, y: u16) {
    let right = buffer.area.right();
    let mut x = buffer.area.left();
    while x < right {
        let width = buffer[(x, y)].cell_width().max(1);
        let fits = x + width <= right && (x + 1..x + width).all(|x| buffer[(x, y)].symbol() == " ");
        if !fits {
            buffer[(x, y)].set_symbol(" ");
        } else if width == 2 {
            buffer[(x + 1, y)] = buffer[(x, y)].clone();
            buffer[(x + 1, y)].set_symbol(" ");
        }
        x += if fits { width } else { 1 };
    }
}

fn encoder() -> impl Strategy<Value = Encoder> {
    (prop::sample::select(vec![Order::Raster, Order::Color]), any::<bool>())
        .prop_map(|(order, synchronized)| Encoder::new().with_order(order).with_synchronized_output(synchronized))
}

/// Reduces a buffer to what the emulators show alike for both backends.
///
/// To them bold and dim are one scale, either speed of blinking is switched off with the other, an underline's colour
/// means something else, and half a wide character is shown in any way.
pub(crate) fn commonly_known(mut buffer: Buffer) -> Buffer {
    for cell in &mut buffer.content {
        if cell.cell_width() != 1 {
            cell.set_symbol("w");
        }
        if cell.modifier.contains(Modifier::BOLD) {
            cell.modifier.remove(Modifier::DIM);
        }
        cell.modifier.remove(Modifier::RAPID_BLINK);
        cell.underline_color = Color::Reset;
    }
    buffer
}

fn assert_strict(frames: &[Vec<Buffer>], encoder: Encoder, clusters: Clusters) {
    let mut strict = Strict::new(SIZE, encoder, clusters);
    for buffers in frames {
        strict.draw(|frame| render(buffers, frame));
    }
}

proptest! {
    #![proptest_config(config(500))]

    #[test]
    fn any_frames_are_shown(frames in panels(Clusters::None), encoder in encoder()) {
        assert_strict(&frames, encoder, Clusters::None);
    }

    #[test]
    fn any_frames_with_marks_are_shown(frames in panels(Clusters::Marks), encoder in encoder()) {
        assert_strict(&frames, encoder, Clusters::Marks);
    }

    #[test]
    fn any_frames_with_families_are_shown(frames in panels(Clusters::Joined), encoder in encoder()) {
        assert_strict(&frames, encoder, Clusters::Joined);
    }

    #[test]
    fn any_frames_are_those_of_ratatui(frames in panels(Clusters::None), encoder in encoder()) {
        let mut pair = Pair::new(SIZE, encoder, &Viewport::Fullscreen, "");
        for buffers in &frames {
            let buffers: Vec<Buffer> = buffers.iter().cloned().map(commonly_known).collect();
            pair.draw(|frame| render(&buffers, frame));
        }
    }
}
