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
    let encoder = Encoder::new().with_order(Order::Color);
    // Where there was CrosstermBackend::new(io::stdout()).
    let backend = EncoderBackend::new(io::stdout(), terminal::size()?)
        .with_encoder(encoder)
        .sized_by(|| Ok(terminal::size()?.into()));
    let mut terminal = Terminal::new(backend)?;
    execute!(terminal.backend_mut(), EnterAlternateScreen)?;
    let result = run(&mut terminal);
    execute!(terminal.backend_mut(), LeaveAlternateScreen)?;
    terminal::disable_raw_mode()?;
    result
}

fn run(terminal: &mut Terminal<EncoderBackend<io::Stdout>>) -> io::Result<()> {
    let start = Instant::now();
    loop {
        terminal.draw(|frame| draw(frame, start.elapsed().as_secs_f64()))?;
        if !event::poll(Duration::from_millis(40))? {
            continue;
        }
        if let Event::Key(_) = event::read()? {
            return Ok(());
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
