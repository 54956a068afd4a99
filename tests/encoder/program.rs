//! Uses of the backend besides drawing: own escape sequences, resizes, quality, rate, scrolling.

use super::backend::{Pair, SIZE, Wire, full, shell};
use ratatui::backend::Backend;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::{Color, Stylize};
use ratatui::widgets::Paragraph;
use ratatui::{Frame, Terminal, Viewport};
use ratatui_crossterm::crossterm::event::{DisableMouseCapture, EnableMouseCapture};
use ratatui_crossterm::crossterm::execute;
use ratatui_crossterm::crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen, SetTitle};
use std::io::Write;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use termtrace::{Cell, Encoder, EncoderBackend, Ink, Quality};

/// Sends the same bytes through both backends.
macro_rules! execute_both {
    ($pair:expr, $($command:expr),+) => {{
        execute!($pair.ours.backend_mut(), $($command),+).expect("it can be written");
        execute!($pair.theirs.backend_mut().0, $($command),+).expect("it can be written");
        $pair.assert_screens_equal();
    }};
}

/// The shell's screen and its cursor are restored, as by ratatui's own backend.
#[test]
fn the_alternate_screen_is_entered_and_left() {
    for rows in [0, 3, 6] {
        let mut pair = Pair::new(SIZE, Encoder::new(), &Viewport::Fullscreen, &shell(rows));
        let (before, cursor) = (pair.line.text(), pair.line.cursor());
        execute_both!(pair, EnterAlternateScreen, EnableMouseCapture);
        clear(&mut pair);
        pair.draw(full);
        assert_ne!(pair.line.text(), before);
        execute_both!(pair, LeaveAlternateScreen, DisableMouseCapture);
        pair.ours.show_cursor().expect("it can be written");
        pair.theirs.show_cursor().expect("it can be written");
        pair.assert_screens_equal();
        assert_eq!((pair.line.text(), pair.line.cursor()), (before, cursor));
        // And again, as behind an editor.
        execute_both!(pair, EnterAlternateScreen);
        clear(&mut pair);
        pair.draw(full);
    }
}

/// Clears both screens. The cursor's position is then unknown without a query.
fn clear(pair: &mut Pair) {
    pair.ours.clear().expect("it can be written");
    pair.theirs.clear().expect("it can be written");
}

/// An escape sequence stays in one piece even if it is written in several, and earlier cells stay.
#[test]
fn sequences_between_frames() {
    let mut pair = Pair::new(SIZE, Encoder::new(), &Viewport::Fullscreen, "");
    for x in 0..4 {
        pair.draw(|frame| {
            frame.render_widget(Paragraph::new("a").bold().red().on_blue(), Rect::new(x, 1, 2, 2));
            frame.set_cursor_position((0, 4));
        });
        pair.line.take_writes();
        execute_both!(pair, SetTitle(format!("frame {x}")));
        assert_eq!(pair.line.take_writes().concat(), format!("\x1b]0;frame {x}\x07"));
    }
    // The program's own text has no colour of ours, and stays where no cell is drawn.
    pair.ours.backend_mut().write_all(b"own").expect("it can be written");
    pair.theirs.backend_mut().0.write_all(b"own").expect("it can be written");
    pair.assert_screens_equal();
    pair.draw(|frame| frame.render_widget("b", frame.area()));
    assert!(pair.line.text().contains("own"));
}

/// Drawn cells that were not flushed are sent before the program's own bytes.
#[test]
fn bytes_keep_their_order() {
    let mut backend = EncoderBackend::new(Vec::new(), (4, 1));
    let cell = ratatui::buffer::Cell::new("x");
    backend.draw([(0, 0, &cell)].into_iter()).expect("a Vec");
    backend.write_all(b"\x1b[?1049l").expect("a Vec");
    let text = String::from_utf8(backend.writer().clone()).expect("text");
    assert!(text.find('x') < text.find("1049"), "{text:?}");
    Backend::flush(&mut backend).expect("a Vec");
    assert_eq!(&backend.writer()[text.len()..], b"\x1b[0m", "nothing is drawn again by itself");
}

/// The size and the cursor that a closure returns to the backend.
#[derive(Clone)]
struct Asked(Arc<Mutex<(Size, Position)>>);

impl Asked {
    fn pair(viewport: &Viewport, before: &str) -> (Self, Pair) {
        let lines = [Wire::new(SIZE), Wire::new(SIZE)];
        for line in &lines {
            line.feed(before);
        }
        let asked = Self(Arc::new(Mutex::new((SIZE, lines[0].cursor()))));
        let (window, cursor) = (asked.clone(), asked.clone());
        let backend = EncoderBackend::new(lines[0].clone(), (80, 24))
            .sized_by(move || Ok(window.0.lock().expect("no panic").0))
            .located_by(move || Ok(cursor.0.lock().expect("no panic").1));
        (asked, Pair::with_backend(backend, lines, viewport))
    }

    fn resize(&self, pair: &Pair, size: Size) {
        pair.line.resize(size);
        pair.other_line.resize(size);
        *self.0.lock().expect("no panic") = (size, pair.line.cursor());
    }
}

/// A resize is noticed although neither backend nor terminal is told of it.
#[test]
fn resizes_are_noticed() {
    for (viewport, before) in [(Viewport::Fullscreen, 0), (Viewport::Inline(3), 2), (Viewport::Inline(2), 5)] {
        let (asked, mut pair) = Asked::pair(&viewport, &shell(before));
        pair.draw(full);
        for size in [(20, 6), (20, 9), (9, 9), (9, 2), (12, 6)].map(Size::from) {
            asked.resize(&pair, size);
            pair.draw(|frame| {
                assert_eq!(frame.area().width, size.width);
                frame.render_widget(Paragraph::new("after").on_red(), frame.area());
            });
            pair.draw(full);
        }
    }
}

#[test]
fn a_window_that_cannot_be_asked_is_an_error() {
    let backend = EncoderBackend::new(Vec::new(), (8, 2)).sized_by(|| Err(std::io::Error::other("no window")));
    assert_eq!(Terminal::new(backend).expect_err("it has no size").to_string(), "no window");
}

/// Draws a picture of half blocks that moves, with a line of text.
fn moving(frame: &mut Frame<'_>, step: u16) {
    let area = frame.area();
    for (x, y) in area.positions().map(|at| (at.x, at.y)) {
        let half = |row: u16| {
            let light = 128.0 + 90.0 * libm::sinf(f32::from(x + step) * 0.21) * libm::cosf(f32::from(row) * 0.13);
            Color::Rgb(light as u8, (light * 0.8) as u8, 255 - light as u8)
        };
        frame.buffer_mut()[(x, y)].set_symbol("▄").set_bg(half(2 * y)).set_fg(half(2 * y + 1));
    }
    frame.render_widget(Paragraph::new(format!("step {step}")), Rect::new(0, 0, area.width, 1));
}

const PANE: Size = Size::new(40, 12);

/// A terminal with a clock that the test sets.
struct Timed {
    terminal: Terminal<EncoderBackend<Wire>>,
    line: Wire,
    now: Arc<Mutex<Duration>>,
}

impl Timed {
    fn new(quality: Quality, max_rate: Option<u32>) -> Self {
        let (line, now) = (Wire::new(PANE), Arc::new(Mutex::new(Duration::ZERO)));
        let clock = Arc::clone(&now);
        let backend =
            EncoderBackend::new(line.clone(), PANE).with_quality(quality, move || *clock.lock().expect("no panic"));
        let backend = max_rate.into_iter().fold(backend, EncoderBackend::with_max_rate);
        Self { terminal: Terminal::new(backend).expect("it can be written"), line, now }
    }

    fn set(&self, now: Duration) {
        *self.now.lock().expect("no panic") = now;
    }

    /// Draws a step at its time, and returns the number of bytes.
    fn draw(&mut self, step: u16) -> usize {
        self.set(u32::from(step) * Duration::from_millis(33));
        self.terminal.draw(|frame| moving(frame, step)).expect("it can be written");
        self.sent()
    }

    fn sent(&self) -> usize {
        self.line.take_writes().iter().map(String::len).sum()
    }

    /// Flushes at each time that is due, until nothing is; how many bytes that took.
    fn rest(&mut self) -> usize {
        let mut sent = 0;
        for _ in 0..100 {
            let Some(due) = self.terminal.backend().due() else { return sent };
            let now = (*self.now.lock().expect("no panic")).max(due);
            self.set(now);
            Backend::flush(self.terminal.backend_mut()).expect("it can be written");
            sent += self.sent();
        }
        panic!("it is never at rest")
    }

    /// Asserts that every cell is that of an exact terminal.
    #[track_caller]
    fn assert_exact(&self, step: u16) {
        let mut exact = Self::new(Quality::Exact, None);
        exact.draw(step);
        for (x, y) in Rect::from((Position::ORIGIN, PANE)).positions().map(|at| (at.x, at.y)) {
            assert_eq!(self.line.cells(x, y).map(flat), exact.line.cells(x, y).map(flat), "({x}, {y})");
        }
    }
}

/// A half block of one colour is a space.
fn flat(cell: Cell) -> Cell {
    if cell.glyph == '▄' && cell.fg == cell.bg { Cell::new(' ', Ink::Default, cell.bg) } else { cell }
}

#[test]
fn a_quality_saves_bytes_and_becomes_exact() {
    let sum = |quality| {
        let mut timed = Timed::new(quality, None);
        timed.draw(0);
        let sum: usize = (1..30).map(|step| timed.draw(step)).sum();
        assert!(timed.line.text().starts_with("step 29"), "text is exact");
        let rest = timed.rest();
        timed.assert_exact(29);
        sum + rest
    };
    let [exact, equal, fast] = [Quality::Exact, Quality::Equal, Quality::Fast].map(sum);
    assert!(10 * equal < 8 * exact && fast < equal, "{exact}, {equal}, {fast}");
}

/// The picture is exact before and after the program's own bytes.
#[test]
fn a_picture_is_exact_before_other_bytes() {
    let mut timed = Timed::new(Quality::Fast, None);
    for step in 0..5 {
        timed.draw(step);
    }
    assert!(timed.terminal.backend().due().is_some(), "it is not exact yet");
    execute!(timed.terminal.backend_mut(), SetTitle("title")).expect("it can be written");
    timed.assert_exact(4);
}

#[test]
fn a_rate_is_kept() {
    for rate in [10_000_u32, 30_000] {
        let mut timed = Timed::new(Quality::Fast, Some(rate));
        timed.draw(0);
        // What the first frame took beyond the rate is paid back before the clock counts.
        let mut sent = 0;
        for step in 1..=150 {
            let bytes = timed.draw(step);
            if step > 60 {
                sent += bytes;
            }
        }
        let (rate, seconds) = (f64::from(rate), 90.0 * 0.033);
        let share = sent as f64 / (rate * seconds);
        assert!((0.5..1.1).contains(&share), "{share} of {rate} bytes a second");
        timed.rest();
        timed.assert_exact(150);
    }
}

/// Text goes out at any rate.
#[test]
fn text_does_not_wait() {
    let mut timed = Timed::new(Quality::Fast, Some(1));
    for step in 0..20 {
        timed.draw(step);
        assert!(timed.line.text().starts_with(&format!("step {step}")), "{}", timed.line.text());
    }
}

/// The viewport is not drawn again, and what was inserted stands above it or in the scrollback.
#[cfg(feature = "scrolling-regions")]
#[test]
fn lines_are_inserted_above_any_viewport() {
    use ratatui::{text::Line, widgets::Widget};
    for (rows_before, height) in (0..=6).flat_map(|rows| [1, 2, 3, 5, 6, 9].map(|height| (rows, height))) {
        let mut pair = Pair::new(SIZE, Encoder::new(), &Viewport::Inline(height), &shell(rows_before));
        let status = |frame: &mut Frame<'_>| frame.render_widget(Paragraph::new("status").on_dark_gray(), frame.area());
        pair.ours.draw(status).expect("it can be written");
        pair.line.take_writes();
        let mut said = Vec::new();
        for lines in [1_u16, 3, 7] {
            let from = said.len();
            said.extend((0..lines).map(|line| format!("line {}", from + usize::from(line))));
            let inserted = said[from..].to_vec();
            let insert = |buffer: &mut ratatui::buffer::Buffer| {
                let lines: Vec<_> = inserted.iter().map(|line| Line::from(line.clone())).collect();
                Paragraph::new(lines).green().render(buffer.area, buffer);
            };
            pair.ours.insert_before(lines, insert).expect("it can be written");
            let drawn_again = pair.line.take_writes().concat().matches("status").count();
            // The first row of a viewport that fills the screen makes way for each line.
            assert!(drawn_again <= usize::from(height >= SIZE.height), "{drawn_again}");
            pair.ours.draw(status).expect("it can be written");
            assert_eq!(pair.line.take_writes().concat().matches("status").count(), 0);
        }
        let text = pair.line.text();
        let top = usize::from(SIZE.height.saturating_sub(height));
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!(rows[..top], said[said.len() - top..], "{text}");
        assert_eq!(rows[top].trim_end(), "status", "{text}");
        if height >= SIZE.height {
            // This emulator keeps what leaves the whole screen only.
            let kept = pair.line.scrollback();
            let kept: Vec<&str> = kept.iter().flat_map(|page| page.lines()).map(str::trim_end).collect();
            assert!(said.iter().all(|line| kept.contains(&line.as_str())), "{kept:?}");
        }
    }
}

/// Scrolling any region by any number of rows gives the screen of ratatui's own model, and the next
/// frame is right.
#[cfg(feature = "scrolling-regions")]
#[test]
fn any_region_is_scrolled() {
    use ratatui::backend::TestBackend;
    let regions = (0..=SIZE.height + 1).flat_map(|start| (start..=SIZE.height + 1).map(move |end| start..end));
    for (region, by, up) in regions.flat_map(|region| {
        [0, 1, 2, 7].into_iter().flat_map(move |by| [true, false].map(|up| (region.clone(), by, up)))
    }) {
        let line = Wire::new(SIZE);
        let mut ours = Terminal::new(EncoderBackend::new(line.clone(), SIZE)).expect("it can be written");
        let mut model = Terminal::new(TestBackend::new(SIZE.width, SIZE.height)).expect("it cannot fail");
        ours.draw(full).expect("it can be written");
        model.draw(full).expect("it cannot fail");
        let (backend, other) = (ours.backend_mut(), model.backend_mut());
        if up {
            backend.scroll_region_up(region.clone(), by).expect("it can be written");
            other.scroll_region_up(region.clone(), by).expect("it cannot fail");
        } else {
            backend.scroll_region_down(region.clone(), by).expect("it can be written");
            other.scroll_region_down(region.clone(), by).expect("it cannot fail");
        }
        assert_eq!(backend.get_cursor_position().expect("it is known"), line.cursor());
        assert_like_model(&line, model.backend().buffer(), &format!("{region:?} by {by}, up: {up}"));
        // The encoder knows what is there.
        let next = |frame: &mut Frame<'_>| {
            full(frame);
            frame.render_widget(Paragraph::new("next").on_green(), Rect::new(1, 1, 9, 4));
        };
        for clears in [false, true] {
            if clears {
                ours.clear().expect("it can be written");
                model.clear().expect("it cannot fail");
            }
            ours.draw(next).expect("it can be written");
            model.draw(next).expect("it cannot fail");
            assert_like_model(&line, model.backend().buffer(), "the next frame");
        }
    }
}

#[cfg(feature = "scrolling-regions")]
#[track_caller]
fn assert_like_model(line: &Wire, buffer: &ratatui::buffer::Buffer, what: &str) {
    let mut grid = termtrace::Grid::new(termtrace::Size::new(SIZE.width, SIZE.height));
    termtrace::lay_over(&mut grid, buffer);
    for at in Rect::from((Position::ORIGIN, SIZE)).positions() {
        for cell in line.cells(at.x, at.y) {
            assert_eq!(cell, grid.cell(at.x, at.y), "{at} after {what}\n{}", line.text());
        }
    }
}
