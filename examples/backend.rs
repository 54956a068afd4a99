//! The encoder as the backend of a ratatui program. Any key leaves.

use crossterm::event::{self, Event};
use crossterm::execute;
use crossterm::terminal::{self, EnterAlternateScreen, LeaveAlternateScreen};
use ratatui::layout::{Constraint, Layout};
use ratatui::style::{Color, Stylize};
use ratatui::widgets::{Block, Gauge, Paragraph};
use ratatui::{Frame, Terminal};
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};
use termtrace::{Encoder, EncoderBackend, Order};

fn main() -> io::Result<()> {
    if !io::stdout().is_terminal() {
        eprintln!("this is for a terminal");
        return Ok(());
    }
    terminal::enable_raw_mode()?;
    execute!(io::stdout(), EnterAlternateScreen)?;
    let result = run();
    execute!(io::stdout(), LeaveAlternateScreen)?;
    terminal::disable_raw_mode()?;
    result
}

fn run() -> io::Result<()> {
    let encoder = Encoder::new().with_order(Order::Color).with_synchronized_output(true);
    // Where there was CrosstermBackend::new(io::stdout()).
    let backend = EncoderBackend::new(io::stdout(), terminal::size()?).with_encoder(encoder);
    let mut terminal = Terminal::new(backend)?;
    let start = Instant::now();
    loop {
        terminal.draw(|frame| draw(frame, start.elapsed().as_secs_f64()))?;
        if !event::poll(Duration::from_millis(40))? {
            continue;
        }
        match event::read()? {
            // The backend never asks the terminal for its size.
            Event::Resize(columns, rows) => terminal.backend_mut().resize((columns, rows)),
            Event::Key(_) => return Ok(()),
            _ => {}
        }
    }
}

fn draw(frame: &mut Frame<'_>, seconds: f64) {
    let [top, bottom] = Layout::vertical([Constraint::Length(3), Constraint::Fill(1)]).areas(frame.area());
    let gauge = Gauge::default().ratio(seconds / 10.0 % 1.0).use_unicode(true).gauge_style(Color::Cyan);
    frame.render_widget(gauge.block(Block::bordered().title(" a ratatui program ")), top);
    let text = format!("{seconds:.1} s at {} cells. Any key leaves.", frame.area().area());
    frame.render_widget(Paragraph::new(text).italic(), bottom);
}
