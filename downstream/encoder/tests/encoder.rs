//! The encoder in place of `CrosstermBackend`: the same screens, in fewer bytes.

use encoder::monitor;
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen};
use ratatui::crossterm::{cursor, execute};
use ratatui::layout::{Position, Rect};
use ratatui::style::Color;
use ratatui::widgets::{Block, Gauge, Widget};
use ratatui::{Terminal, TerminalOptions, Viewport};
use std::cell::RefCell;
use std::error::Error;
use std::io::{self, Write};
use std::num::{NonZero, TryFromIntError};
use std::rc::Rc;
use termtrace::{Encoder, EncoderBackend, Order};

type Outcome = Result<(), Box<dyn Error>>;

/// The bytes written by a backend, for a terminal to read.
#[derive(Clone, Debug, Default)]
struct Pipe(Rc<RefCell<Vec<u8>>>);

impl Pipe {
    fn drain(&self) -> Vec<u8> {
        self.0.take()
    }
}

impl Write for Pipe {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Returns a terminal of that size without a scrollback.
fn terminal_of(columns: u16, rows: u16) -> Result<vt100::Parser, TryFromIntError> {
    Ok(vt100::Parser::new(NonZero::try_from(rows)?, NonZero::try_from(columns)?, 0))
}

/// Returns the visible state of each cell; the foreground colour of a blank is invisible.
fn screen(parser: &vt100::Parser) -> Vec<String> {
    let (rows, columns) = parser.screen().size();
    let (rows, columns) = (rows.get(), columns.get());
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let looks = places.map(|(row, column)| {
        let Some(cell) = parser.screen().cell(row, column) else { return String::new() };
        let text = if cell.contents() == " " { "" } else { cell.contents() };
        let fg = (!text.is_empty() || cell.inverse()).then_some((cell.fgcolor(), cell.bold(), cell.italic()));
        format!("{row},{column} {text:?} {fg:?} on {:?} {} {}", cell.bgcolor(), cell.inverse(), cell.underline())
    });
    looks.collect()
}

/// Draws `frames` frames of the monitor; returns the number of bytes, and the screen after every tenth frame.
fn played<B: Backend>(
    backend: B,
    pipe: &Pipe,
    size: (u16, u16),
    frames: u16,
) -> Result<(usize, Vec<Vec<String>>), Box<dyn Error>>
where
    B::Error: 'static,
{
    let viewport = Viewport::Fixed(Rect::new(0, 0, size.0, size.1));
    let mut terminal = Terminal::with_options(backend, TerminalOptions { viewport })?;
    let mut parser = terminal_of(size.0, size.1)?;
    let (mut bytes, mut screens) = (0, Vec::new());
    for time in 0..frames {
        terminal.draw(|frame| monitor(frame, time))?;
        let sent = pipe.drain();
        bytes += sent.len();
        parser.process(&sent);
        if time % 10 == 9 {
            screens.push(screen(&parser));
        }
    }
    Ok((bytes, screens))
}

#[test]
fn the_same_screens_take_seven_tenths_of_the_bytes() -> Outcome {
    for size in [(80, 24), (120, 40)] {
        let pipe = Pipe::default();
        let (usual, wanted) = played(CrosstermBackend::new(pipe.clone()), &pipe, size, 100)?;
        for order in [Order::Raster, Order::Color] {
            let backend = EncoderBackend::new(pipe.clone(), size).with_encoder(Encoder::new().with_order(order));
            let (bytes, found) = played(backend, &pipe, size, 100)?;
            let differs = wanted.concat().into_iter().zip(found.concat()).find(|(wanted, found)| wanted != found);
            assert_eq!(differs, None, "{size:?} {order:?}");
            println!("{size:?} {order:?}: {bytes} bytes, CrosstermBackend {usual}, {:.2}", bytes as f64 / usual as f64);
            assert!(bytes * 10 <= usual * 7, "{size:?} {order:?}: {bytes} of {usual} bytes");
        }
    }
    Ok(())
}

/// Most programs enter and leave the alternate screen like this.
#[test]
fn commands_of_crossterm_go_through_it() -> Outcome {
    let pipe = Pipe::default();
    let mut terminal = Terminal::new(EncoderBackend::new(pipe.clone(), (40, 10)))?;
    execute!(terminal.backend_mut(), EnterAlternateScreen, cursor::Hide)?;
    terminal.draw(|frame| frame.render_widget("within", frame.area()))?;
    let mut parser = terminal_of(40, 10)?;
    parser.process(&pipe.drain());
    assert!(parser.screen().alternate_screen() && parser.screen().hide_cursor());
    assert_eq!(parser.screen().contents(), "within");
    execute!(terminal.backend_mut(), cursor::Show, LeaveAlternateScreen)?;
    parser.process(&pipe.drain());
    assert!(!parser.screen().alternate_screen() && !parser.screen().hide_cursor());
    Ok(())
}

/// With `scrolling-regions`, ratatui scrolls the rows above an inline viewport as a region of the screen.
#[test]
fn lines_are_inserted_before_an_inline_viewport() -> Outcome {
    let pipe = Pipe::default();
    let mut backend = EncoderBackend::new(pipe.clone(), (40, 12));
    backend.set_cursor_position(Position::new(0, 2))?;
    let mut terminal = Terminal::with_options(backend, TerminalOptions { viewport: Viewport::Inline(3) })?;
    for time in 0..20 {
        if time % 3 == 0 {
            let line = format!("done: 漢字 {time}");
            terminal.insert_before(1, |buffer| {
                buffer.set_string(0, 0, &line, Color::Red);
            })?;
        }
        terminal.draw(|frame| {
            Gauge::default().percent(time * 5).block(Block::bordered()).render(frame.area(), frame.buffer_mut());
        })?;
    }
    let mut parser = terminal_of(40, 12)?;
    parser.process(b"shell 1\r\nshell 2\r\n");
    parser.process(&pipe.drain());
    let shown = parser.screen().contents();
    let rows: Vec<_> = shown.lines().collect();
    let wanted =
        ["shell 1", "shell 2", "done: 漢字 0", "done: 漢字 3", "done: 漢字 6", "done: 漢字 9", "done: 漢字 12"];
    assert_eq!(rows[..7], wanted, "{shown}");
    assert_eq!(rows[7..9], ["done: 漢字 15", "done: 漢字 18"], "{shown}");
    assert!(rows[10].contains("95%"), "{shown}");
    Ok(())
}
